//! STL, the stereolithography format: ascii and binary.
//!
//! After 3D Systems' "StereoLithography Interface Specification" (1989). Triangles only; corners at exactly the same place
//! become one vertex, so that a closed body in the file is a closed mesh. Normals in the file repeat what the corners' order
//! says and are not read; the two attribute bytes of binary triangles neither. All solids of a file make one mesh.
//! Coordinates are taken as they are; by custom they are millimetres with +z up.
//!
//! A file that is exactly as long as a binary one of its count is binary, even where its header begins with `solid`.

use std::collections::HashMap;

use foldhash::fast::RandomState;

use super::mesh_file::MeshFile;
use super::normals::position_key;
use super::report::{Report, quoted};
use super::text::{Lines, Word, Words, parse_float, text_start};
use crate::diagnostic::{Diagnostic, did_you_mean};
use crate::scene::Mesh;

const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Reads an STL file; problems go to the report.
pub(super) fn read(report: &mut Report<'_>) -> Option<MeshFile> {
    let mesh = if is_binary(report.bytes) { binary(report)? } else { ascii(report)? };
    Some(MeshFile { mesh, ..MeshFile::default() })
}

/// How many triangles a binary file says it has.
fn binary_count(bytes: &[u8]) -> Option<u64> {
    Some(u64::from(u32::from_le_bytes(*bytes.get(HEADER - 4..)?.first_chunk()?)))
}

/// True where the length is exactly that of a binary file.
pub(super) fn has_binary_length(bytes: &[u8]) -> bool {
    binary_count(bytes).is_some_and(|count| HEADER as u64 + count * TRIANGLE as u64 == bytes.len() as u64)
}

/// True where a text begins as an ascii file does.
pub(super) fn begins_as_ascii(bytes: &[u8]) -> bool {
    let start = bytes.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(bytes.len());
    bytes[start..].get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
        && bytes.get(start + 5).is_none_or(u8::is_ascii_whitespace)
}

fn is_binary(bytes: &[u8]) -> bool {
    if has_binary_length(bytes) {
        return true;
    }
    // Otherwise the header's 80 bytes tell: text has no control characters but blanks.
    let head = &bytes[..bytes.len().min(HEADER)];
    let control = |&b: &u8| b < 0x20 && !b.is_ascii_whitespace();
    text_start(bytes) == Ok(0) && head.iter().any(control)
}

/// Vertices by place.
#[derive(Default)]
struct Weld {
    mesh: Mesh,
    vertices: HashMap<[u32; 3], u32, RandomState>,
}

impl Weld {
    fn triangle(&mut self, corners: [[f32; 3]; 3]) {
        let triangle = corners.map(|corner| {
            *self.vertices.entry(position_key(corner)).or_insert_with(|| {
                self.mesh.positions.push(corner);
                self.mesh.positions.len() as u32 - 1
            })
        });
        self.mesh.triangles.push(triangle);
    }
}

fn binary(report: &mut Report<'_>) -> Option<Mesh> {
    report.binary_from(0);
    let bytes = report.bytes;
    let Some(count) = binary_count(bytes) else {
        let message = "this is no STL file: it is too short for a binary one and does not begin with `solid`";
        report.whole("headers", || Diagnostic::error(message));
        return None;
    };
    let body = &bytes[HEADER..];
    let there = body.len() / TRIANGLE;
    if count > there as u64 {
        report.at(HEADER - 4..HEADER, "headers", || {
            Diagnostic::error(format!("the header promises {count} triangles, but the file has bytes for {there}"))
                .help("the file is cut off, or it is no STL file")
        });
        return None;
    }
    if count < there as u64 {
        report.at(HEADER - 4..HEADER, "headers", || {
            Diagnostic::warning(format!("the header promises {count} triangles, but the file has bytes for {there}"))
        });
    }
    let mut weld = Weld::default();
    weld.mesh.triangles.reserve(count as usize);
    weld.vertices.reserve(count as usize / 2);
    for (i, record) in body.chunks_exact(TRIANGLE).take(count as usize).enumerate() {
        let (numbers, _) = record.as_chunks::<4>();
        let corner = |c: usize| [0, 1, 2].map(|axis| f32::from_le_bytes(numbers[3 + 3 * c + axis]));
        let corners = [0, 1, 2].map(corner);
        if !corners.iter().flatten().all(|c| c.is_finite()) {
            let start = HEADER + i * TRIANGLE;
            report.at(start..start + TRIANGLE, "corners that are not finite", || {
                Diagnostic::error(format!("triangle {i} has a corner that is not finite"))
            });
        }
        weld.triangle(corners);
    }
    (!report.failed()).then_some(weld.mesh)
}

/// Words that begin a line of an ascii file.
const KEYWORDS: [&str; 7] = ["solid", "facet", "outer", "vertex", "endloop", "endfacet", "endsolid"];

fn ascii(report: &mut Report<'_>) -> Option<Mesh> {
    let bytes = report.bytes;
    match text_start(bytes) {
        Ok(_) if begins_as_ascii(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)) => {}
        encoding => {
            report.whole("encodings", || match encoding {
                Err(encoding) => Diagnostic::error(format!("this file is text in {encoding}"))
                    .help("save it as UTF-8 or plain ASCII"),
                Ok(_) => Diagnostic::error("this is no STL file: it does not begin with `solid` and is not binary"),
            });
            return None;
        }
    }
    let mut weld = Weld::default();
    let mut facet = Facet::default();
    let mut lines = Lines::new(bytes, text_start(bytes).unwrap_or(0), false);
    while let Some(line) = lines.next_line() {
        let mut words = Words::new(bytes, line);
        let Some(keyword) = words.next() else { continue };
        let text = keyword.text;
        if text.eq_ignore_ascii_case(b"vertex") {
            facet.vertex(report, keyword, words);
        } else if text.eq_ignore_ascii_case(b"facet") {
            facet.end(report, &mut weld);
            facet.place = Some(keyword);
        } else if text.eq_ignore_ascii_case(b"endfacet") {
            facet.end(report, &mut weld);
        } else if !KEYWORDS.iter().any(|k| text.eq_ignore_ascii_case(k.as_bytes())) {
            report.at(keyword.range(), "unknown lines", || {
                let error = Diagnostic::error(format!("unknown word {}", quoted(text)));
                match std::str::from_utf8(text).ok().and_then(|word| did_you_mean(word, KEYWORDS)) {
                    Some(near) => error.help(format!("did you mean `{near}`?")),
                    None => error.help(format!("a line begins with one of {}", KEYWORDS.join(", "))),
                }
            });
        }
    }
    if let Some(open) = facet.place {
        report.at(open.range(), "facets", || Diagnostic::error("the file ends within this facet"));
    }
    (!report.failed()).then_some(weld.mesh)
}

/// The facet that is being read.
#[derive(Default)]
struct Facet<'a> {
    place: Option<Word<'a>>,
    corners: [[f32; 3]; 3],
    count: usize,
}

impl Facet<'_> {
    fn vertex(&mut self, report: &mut Report<'_>, keyword: Word<'_>, mut words: Words<'_>) {
        if self.place.is_none() {
            return report.at(keyword.range(), "vertices", || Diagnostic::error("a vertex outside of any facet"));
        }
        let mut corner = [0.0; 3];
        for value in &mut corner {
            let word = words.next();
            let Some(number) = word.and_then(|w| parse_float(w.text)).filter(|&v| (v as f32).is_finite()) else {
                let range = word.map_or(keyword.range(), |w| w.range());
                report.at(range, "vertices", || match word {
                    Some(word) => Diagnostic::error(format!("{} is no finite number", quoted(word.text))),
                    None => Diagnostic::error("a vertex needs three numbers"),
                });
                break;
            };
            *value = number as f32;
        }
        if let Some(place) = self.corners.get_mut(self.count) {
            *place = corner;
        }
        self.count += 1;
    }

    fn end(&mut self, report: &mut Report<'_>, weld: &mut Weld) {
        if let Some(place) = self.place.take() {
            if self.count == 3 {
                weld.triangle(self.corners);
            } else {
                let count = self.count;
                report.at(place.range(), "facets", || {
                    Diagnostic::error(format!("this facet has {count} vertices instead of three"))
                });
            }
        }
        self.count = 0;
    }
}

#[cfg(test)]
#[path = "stl_tests.rs"]
mod tests;
