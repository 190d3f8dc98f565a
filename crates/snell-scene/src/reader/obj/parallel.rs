//! An OBJ file in stretches of lines that are read at the same time, and then put together in the order of the file.
//!
//! Whatever the stretches and threads, this gives exactly what reading line by line gives, or nothing: a file that is not plain
//! from end to end is read line by line, which tells what is wrong with it and where.

use rayon::prelude::*;

use super::chunk::{Change, Chunk};
use super::{NONE, Parser};
use crate::reader::text::Word;

/// Reads the lines from `start` on in stretches of at least `size` bytes; `None` where the file is not plain.
pub(super) fn read(bytes: &[u8], start: usize, size: usize) -> Option<Parser<'_>> {
    let mut ranges = Vec::with_capacity((bytes.len() - start) / size + 1);
    let mut at = start;
    while at < bytes.len() {
        let least = (at + size).min(bytes.len());
        let end = bytes[least..].iter().position(|&b| b == b'\n').map_or(bytes.len(), |length| least + length + 1);
        ranges.push(at..end);
        at = end;
    }
    let chunks: Option<Vec<Chunk>> = ranges.into_par_iter().map(|range| Chunk::read(bytes, range)).collect();
    join(chunks?)
}

fn join<'a>(mut chunks: Vec<Chunk<'a>>) -> Option<Parser<'a>> {
    // How many positions, texture coordinates and normals stand before each stretch.
    let mut count = [0; 3];
    let mut before = Vec::with_capacity(chunks.len());
    for chunk in &chunks {
        if (0..3).any(|kind| chunk.needs[kind] > count[kind] as i64) {
            return None;
        }
        before.push(count);
        let own = [chunk.positions.len(), chunk.uvs.len(), chunk.normals.len()];
        count = [0, 1, 2].map(|kind| count[kind] + own[kind]);
    }
    if count.iter().any(|&count| count >= NONE as usize) {
        return None;
    }

    let mut parser = Parser::default();
    parser.positions.reserve_exact(count[0]);
    parser.uvs.reserve_exact(count[1]);
    parser.normals.reserve_exact(count[2]);
    for chunk in &mut chunks {
        if !chunk.colors.is_empty() {
            parser.colors.resize(parser.positions.len(), [1.0; 3]);
            parser.colors.append(&mut chunk.colors);
        }
        parser.positions.extend(std::mem::take(&mut chunk.positions));
        parser.uvs.extend(std::mem::take(&mut chunk.uvs));
        parser.normals.extend(std::mem::take(&mut chunk.normals));
    }
    let (positions, stretches) = (&parser.positions, chunks.len());
    let complete = |(chunk, before): (&mut Chunk, [usize; 3])| chunk.complete(before, positions, stretches);
    chunks.par_iter_mut().zip(before).map(complete).collect::<Option<()>>()?;

    parser.triangles.reserve_exact(chunks.iter().map(|chunk| chunk.corners.len() / 3).sum());
    for chunk in chunks {
        let (triangles, _) = chunk.corners.as_chunks::<3>();
        let last = Change { name: Word { text: b"", start: 0 }, faces: chunk.faces(), triangles: triangles.len() };
        let (mut faces, mut done) = (0, 0);
        for (i, change) in chunk.materials.iter().chain([&last]).enumerate() {
            let first = parser.triangles.len();
            parser.triangles.extend_from_slice(&triangles[done..change.triangles]);
            // Also faces of no triangles make a material one that is used.
            if change.faces > faces {
                parser.set_material(first);
            }
            (faces, done) = (change.faces, change.triangles);
            if i < chunk.materials.len() {
                (parser.current, parser.current_number) = (Some(change.name), None);
            }
        }
        parser.libraries.extend(chunk.libraries);
        parser.loose += chunk.loose;
    }
    Some(parser)
}
