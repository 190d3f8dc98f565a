//! OBJ, Wavefront's text format for meshes, with the material libraries (MTL) that it names.
//!
//! After Wavefront's "Advanced Visualizer Manual", appendix B1 (1995): `v` with an optional weight (ignored) or colour, `vt`,
//! `vn`, `f` with all forms of corners and negative (relative) numbers, polygons of any shape, `usemtl` and `mtllib`
//! (names may hold spaces), lines continued by a backslash. Groups, smoothing groups, points and lines are passed over; curves
//! and surfaces are told and left out. Vertex colours are sRGB-encoded numbers in [0, 1], as MeshLab and Blender write them.
//! Coordinates are taken as they are; v of texture coordinates points up.
//!
//! A position, a texture coordinate and a normal make one vertex; equal triples share it, numbered by first use. Our own
//! reader and not a library's: `tobj` gives no places for errors and reads numbers line by line through `String`s.

mod assemble;
mod chunk;
mod material;
mod mtl;
mod parallel;

use std::collections::HashMap;

use super::mesh_file::MeshFile;
use super::polygon::{TooComplex, Triangulator};
use super::report::{Report, quoted};
use super::text::{Lines, Word, Words, parse_float, parse_integer, text_start};
use crate::assets::Assets;
use crate::diagnostic::{Diagnostic, did_you_mean};

/// No texture coordinate, no normal, no material.
const NONE: u32 = u32::MAX;

/// Files of fewer bytes are read line by line at once; …
const LEAST_PARALLEL: usize = 1 << 16;
/// … others first in stretches of about so many.
const STRETCH: usize = 1 << 20;

/// Numbers of a corner's position, texture coordinate and normal, from 0.
type Corner = [u32; 3];

/// Reads an OBJ file and its libraries; problems go to the report.
pub(super) fn read(report: &mut Report<'_>, assets: &dyn Assets) -> Option<MeshFile> {
    let start = match text_start(report.bytes) {
        Ok(start) => start,
        Err(encoding) => {
            let help = "save it as UTF-8 or plain ASCII";
            report.whole("encodings", || Diagnostic::error(format!("this file is text in {encoding}")).help(help));
            return None;
        }
    };
    let is_large = report.bytes.len() >= LEAST_PARALLEL;
    let plain = if is_large { parallel::read(report.bytes, start, STRETCH) } else { None };
    let parser = match plain {
        Some(parser) => parser,
        None => line_by_line(report, start)?,
    };
    if report.failed() {
        return None;
    }
    let materials = material::read(&parser, report, assets);
    let mut file = assemble::assemble(parser, report)?;
    (file.materials, file.images) = materials;
    Some(file)
}

/// Reads one line after the other and tells all that is wrong; `None` where that takes too long.
fn line_by_line<'a>(report: &mut Report<'a>, start: usize) -> Option<Parser<'a>> {
    let mut parser = Parser::default();
    let mut lines = Lines::new(report.bytes, start, true);
    while let Some(line) = lines.next_line() {
        parser.line(report, Words::new(report.bytes, line));
        if parser.too_complex {
            return None;
        }
    }
    Some(parser)
}

/// What the lines so far gave.
#[derive(Default)]
struct Parser<'a> {
    positions: Vec<[f32; 3]>,
    /// Empty until the first vertex with a colour; white before it.
    colors: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    normals: Vec<[f32; 3]>,
    triangles: Vec<[Corner; 3]>,
    /// For each triangle a place in `material_names`, or [`NONE`]; empty until the first `usemtl`.
    triangle_materials: Vec<u32>,
    /// Names of `usemtl`, in the order of first use by a face, with the first place of each.
    material_names: Vec<Word<'a>>,
    material_numbers: HashMap<&'a [u8], u32>,
    /// The last `usemtl`, and its number once a face has used it.
    current: Option<Word<'a>>,
    current_number: Option<u32>,
    /// All `mtllib` lines.
    libraries: Vec<Word<'a>>,
    /// Points and lines passed over.
    loose: usize,
    face: Vec<Corner>,
    cut: Vec<[u32; 3]>,
    triangulator: Triangulator,
    too_complex: bool,
}

const KNOWN: [&str; 10] = ["v", "vt", "vn", "f", "g", "o", "s", "usemtl", "mtllib", "l"];

impl<'a> Parser<'a> {
    #[inline]
    fn line(&mut self, report: &mut Report<'a>, mut words: Words<'a>) {
        let Some(keyword) = words.next() else { return };
        match keyword.text {
            b"v" => self.vertex(report, keyword, words),
            b"vt" => {
                let mut uv = [0.0; 2];
                if numbers(report, keyword, words, &mut uv, 1) {
                    self.uvs.push(uv.map(|c| c as f32));
                }
            }
            b"vn" => {
                let mut normal = [0.0; 3];
                if numbers(report, keyword, words, &mut normal, 3) {
                    self.normals.push(normal.map(|c| c as f32));
                }
            }
            b"f" | b"fo" => self.face(report, keyword, words),
            b"usemtl" => {
                self.current = Some(words.rest());
                self.current_number = None;
            }
            b"mtllib" => self.libraries.push(words.rest()),
            b"p" | b"l" => self.loose += 1,
            b"g" | b"o" | b"s" | b"mg" | b"lod" | b"bevel" | b"c_interp" | b"d_interp" | b"shadow_obj"
            | b"trace_obj" | b"usemap" | b"maplib" | b"vw" => {}
            b"vp" | b"deg" | b"bmat" | b"step" | b"cstype" | b"curv" | b"curv2" | b"surf" | b"parm" | b"trim"
            | b"hole" | b"scrv" | b"sp" | b"end" | b"con" | b"ctech" | b"stech" | b"bzp" | b"bsp" | b"cdc" | b"cdp"
            | b"res" => {
                report.at(keyword.range(), "lines of curves and surfaces", || {
                    Diagnostic::warning("curves and surfaces are not read: this line is left out")
                });
            }
            text if text[0] == b'#' => {}
            text => report.at(keyword.range(), "unknown lines", || {
                let warning = Diagnostic::warning(format!("unknown word {}: this line is left out", quoted(text)));
                match std::str::from_utf8(text).ok().and_then(|word| did_you_mean(word, KNOWN)) {
                    Some(near) => warning.help(format!("did you mean `{near}`?")),
                    None => warning,
                }
            }),
        }
    }

    fn vertex(&mut self, report: &mut Report<'_>, keyword: Word<'_>, words: Words<'_>) {
        // x y z, then nothing, a weight, or a colour (with an alpha value at most).
        let mut values = [0.0; 7];
        let count = words.clone().take(8).take_while(|w| w.text[0] != b'#').count();
        if !numbers(report, keyword, words, &mut values[..count.clamp(3, 7)], 3) {
            return;
        }
        let [x, y, z, r, g, b, _] = values.map(|v| v as f32);
        if count >= 6 {
            self.colors.resize(self.positions.len(), [1.0; 3]);
            self.colors.push([r, g, b].map(|c| snell_math::color::srgb_to_linear(c.clamp(0.0, 1.0))));
            if values[3..6].iter().any(|c| !(0.0..=1.0).contains(c)) {
                report.at(keyword.range(), "vertex colours", || {
                    Diagnostic::warning("a vertex colour should be three numbers from 0 to 1: it is clamped")
                });
            }
        } else if !self.colors.is_empty() {
            self.colors.push([1.0; 3]);
        }
        self.positions.push([x, y, z]);
    }

    #[inline]
    fn face(&mut self, report: &mut Report<'a>, keyword: Word<'a>, words: Words<'a>) {
        self.face.clear();
        let mut broken = false;
        for word in words {
            if word.text[0] == b'#' {
                break;
            }
            match self.corner(report, word) {
                Some(corner) => self.face.push(corner),
                None => broken = true,
            }
        }
        if broken {
            return;
        }
        if self.face.len() < 3 {
            let count = self.face.len();
            return report.at(keyword.range(), "faces with too few corners", || {
                Diagnostic::warning(format!("this face has {count} corners: it is left out"))
                    .help("a face needs at least three")
            });
        }
        let before = self.triangles.len();
        if let &[a, b, c] = self.face.as_slice() {
            self.triangles.push([a, b, c]);
        } else {
            self.cut.clear();
            let points = self.face.iter().map(|c| self.positions[c[0] as usize].map(f64::from));
            if let Err(error @ TooComplex) = self.triangulator.triangulate(points, &mut self.cut) {
                self.too_complex = true;
                return report.at(keyword.range(), "faces", || Diagnostic::error(error.to_string()));
            }
            self.triangles.extend(self.cut.iter().map(|t| t.map(|i| self.face[i as usize])));
        }
        self.set_material(before);
    }

    /// Gives the triangles from one on the material of the last `usemtl`.
    fn set_material(&mut self, first: usize) {
        if let Some(name) = self.current {
            let number = *self.current_number.get_or_insert_with(|| {
                *self.material_numbers.entry(name.text).or_insert_with(|| {
                    self.material_names.push(name);
                    self.material_names.len() as u32 - 1
                })
            });
            self.triangle_materials.resize(first, NONE);
            self.triangle_materials.resize(self.triangles.len(), number);
        }
    }

    /// One corner of a face: `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    #[inline]
    fn corner(&self, report: &mut Report<'_>, word: Word<'_>) -> Option<Corner> {
        let mut corner = [NONE; 3];
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        let (mut start, text) = (0, word.text);
        for kind in 0..3 {
            let length = text[start..].iter().position(|&b| b == b'/').unwrap_or(text.len() - start);
            let part = &text[start..start + length];
            let range = word.start + start..word.start + start + length;
            if kind == 0 || !part.is_empty() {
                corner[kind] = resolve(report, part, range, counts[kind], kind)?;
            }
            start += length + 1;
            if start > text.len() {
                return Some(corner);
            }
        }
        report.at(word.range(), "corners of faces", || {
            Diagnostic::error(format!("{} is no corner of a face", quoted(text)))
                .help("a corner is written `v`, `v/vt`, `v//vn` or `v/vt/vn`")
        });
        None
    }
}

/// A number of a position, texture coordinate or normal as it stands in a face, from 0.
#[inline]
fn resolve(
    report: &mut Report<'_>,
    text: &[u8],
    range: std::ops::Range<usize>,
    count: usize,
    kind: usize,
) -> Option<u32> {
    const NAMES: [&str; 3] = ["vertex", "texture coordinate", "normal"];
    let Some(number) = parse_integer(text) else {
        report.at(range, "corners of faces", || {
            Diagnostic::error(format!("{} is no number of a {}", quoted(text), NAMES[kind]))
                .help("a corner is written `v`, `v/vt`, `v//vn` or `v/vt/vn`")
        });
        return None;
    };
    let place = if number > 0 { number - 1 } else { number + count as i64 };
    if number != 0 && (0..count as i64).contains(&place) && place < i64::from(NONE) {
        return Some(place as u32);
    }
    let message = format!("there is no {} {number}: there are {count} up to this line", NAMES[kind]);
    if kind > 0 {
        // Exporters often name normals that they leave out; the face is good without.
        report.at(range, "names of what is not there", || Diagnostic::warning(message).help(FROM_ONE));
        return Some(NONE);
    }
    report.at(range, "faces that name what is not there", || Diagnostic::error(message).help(FROM_ONE));
    None
}

const FROM_ONE: &str = "they count from 1; −1 is the last one before the face";

/// Reads numbers of a line into `values`, at least `least` of them; all must be finite in f32. Says what is wrong.
#[inline]
fn numbers(report: &mut Report<'_>, keyword: Word<'_>, words: Words<'_>, values: &mut [f64], least: usize) -> bool {
    let mut read = 0;
    for (value, word) in values.iter_mut().zip(words) {
        if word.text[0] == b'#' {
            break;
        }
        match parse_float(word.text) {
            Some(number) if (number as f32).is_finite() => *value = number,
            Some(_) => {
                report.at(word.range(), "numbers that are not finite", || {
                    Diagnostic::error(format!("{} is not finite or too large", quoted(word.text)))
                });
                return false;
            }
            None => {
                report.at(word.range(), "words that are no numbers", || {
                    Diagnostic::error(format!("{} is no number", quoted(word.text)))
                });
                return false;
            }
        }
        read += 1;
    }
    if read < least {
        report.at(keyword.range(), "lines with too few numbers", || {
            let name = quoted(keyword.text);
            Diagnostic::error(format!("{name} needs at least {least} numbers, but here are {read}"))
        });
    }
    read >= least
}

#[cfg(test)]
mod tests;
