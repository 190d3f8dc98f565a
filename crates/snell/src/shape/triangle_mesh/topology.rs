//! Which edges of a mesh are open.
//!
//! Corners are taken for one where their positions are equal, whatever their indices: a mesh whose faces have corners of
//! their own, for the sake of normals or texture coordinates, is closed if it looks closed.

use rayon::prelude::*;

/// How many directed edges have no opposite edge to match: 0 for a closed surface, however many parts it has. A border
/// edge counts 1, and an edge that two triangles run along in the same direction 2.
pub(super) fn boundary_edges(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> usize {
    let welded = weld(positions);
    let mut edges: Vec<(u32, u32, bool)> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
        .map(|(from, to)| (welded[from as usize], welded[to as usize]))
        .filter(|(from, to)| from != to)
        .map(|(from, to)| (from.min(to), from.max(to), from < to))
        .collect();
    edges.par_sort_unstable();
    edges
        .chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))
        .map(|same| {
            let upward = same.iter().filter(|edge| edge.2).count();
            upward.abs_diff(same.len() - upward)
        })
        .sum()
}

/// For every vertex the lowest vertex of the same position.
fn weld(positions: &[[f32; 3]]) -> Vec<u32> {
    // Adding 0 makes one of 0 and −0.
    let key = |vertex: u32| positions[vertex as usize].map(|x| (x + 0.0).to_bits());
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.par_sort_unstable_by_key(|&vertex| (key(vertex), vertex));
    let mut welded = vec![0; positions.len()];
    for same in order.chunk_by(|&a, &b| key(a) == key(b)) {
        for &vertex in same {
            welded[vertex as usize] = same[0];
        }
    }
    welded
}
