//! The entities of an NFF file, from words to numbers. An entity may spread over lines, so words count, not lines; after a
//! mistake, reading goes on at the next line that begins with an entity.

use std::ops::{Range, RangeInclusive};

use snell_math::{Point3, Rgb, Vector3, portable};

use super::builder::{Builder, Fill};
use crate::Scene;
use crate::diagnostic::{Diagnostic, did_you_mean};
use crate::reader::report::{Report, quoted};
use crate::reader::text::{Lines, Word, Words, parse_float};
use crate::scene::{Camera, Frame};

/// Reads all entities.
pub(super) fn parse(report: &mut Report<'_>, start: usize) -> Option<Scene> {
    let words = Words::new(report.bytes, start..start);
    let mut parser = Parser {
        lines: Lines::new(report.bytes, start, false),
        words,
        last: start..start,
        report,
        builder: Builder::default(),
        seen_view: false,
    };
    while let Some(keyword) = parser.word() {
        if parser.entity(keyword).is_none() {
            parser.words = Words::new(parser.report.bytes, 0..0);
        }
        if parser.builder.too_complex {
            return None;
        }
    }
    parser.finish()
}

/// A mistake was told; go on with the next line.
type Told<T> = Option<T>;

struct Parser<'r, 'a> {
    report: &'r mut Report<'a>,
    lines: Lines<'a>,
    words: Words<'a>,
    /// The last word's place.
    last: Range<usize>,
    builder: Builder,
    seen_view: bool,
}

/// Numbers that a coordinate may have: what f32 can hold, with room to compute.
const COORDINATE: RangeInclusive<f64> = -1e30..=1e30;
const SHARE: RangeInclusive<f64> = 0.0..=1e6;

impl<'a> Parser<'_, 'a> {
    /// The next word, wherever it is.
    fn word(&mut self) -> Option<Word<'a>> {
        loop {
            match self.words.next() {
                Some(word) if word.text[0] != b'#' => {
                    // A comment may follow a word without a blank.
                    let length = word.text.iter().position(|&b| b == b'#').unwrap_or(word.text.len());
                    if length < word.text.len() {
                        self.words = Words::new(self.report.bytes, 0..0);
                    }
                    let word = Word { text: &word.text[..length], ..word };
                    self.last = word.range();
                    return Some(word);
                }
                _ => self.words = Words::new(self.report.bytes, self.lines.next_line()?),
            }
        }
    }

    /// Goes back before a word, so that it is read again as an entity.
    fn back_to(&mut self, word: Word<'a>) {
        self.lines = Lines::new(self.report.bytes, word.start, false);
        self.words = Words::new(self.report.bytes, 0..0);
    }

    /// A finite number within a range.
    fn number(&mut self, what: &str, range: RangeInclusive<f64>) -> Told<f64> {
        let Some(word) = self.word() else {
            let last = self.last.clone();
            self.report.at(last, "entities", || Diagnostic::error(format!("the file ends before {what}")));
            return None;
        };
        let Some(value) = parse_float(word.text) else {
            self.report.at(word.range(), "words that are no numbers", || {
                Diagnostic::error(format!("{} is no number, but {what} should be here", quoted(word.text)))
            });
            if is_entity(word.text) {
                self.back_to(word);
            }
            return None;
        };
        if !range.contains(&value) {
            self.report.at(word.range(), "numbers out of range", || {
                let (low, high) = (range.start(), range.end());
                Diagnostic::error(format!("{what} is {value}")).help(format!("it must be from {low} to {high}"))
            });
            return None;
        }
        Some(value)
    }

    fn numbers<const N: usize>(&mut self, what: &str, range: RangeInclusive<f64>) -> Told<[f64; N]> {
        let mut values = [0.0; N];
        for value in &mut values {
            *value = self.number(what, range.clone())?;
        }
        Some(values)
    }

    fn color(&mut self, what: &str) -> Told<Rgb> {
        Some(Rgb::from(self.numbers::<3>(what, SHARE)?.map(|c| c as f32)))
    }

    /// A colour as its author saw it: the number that went to the screen.
    fn displayed_color(&mut self, what: &str) -> Told<Rgb> {
        Some(Rgb::from_srgb(self.color(what)?.to_array()))
    }

    fn entity(&mut self, keyword: Word<'a>) -> Told<()> {
        match keyword.text {
            b"v" => self.view(keyword)?,
            b"b" => self.builder.background = self.displayed_color("the background's colour")?,
            b"l" => self.light()?,
            b"f" => self.fill()?,
            b"s" => {
                let [x, y, z, radius] = self.numbers("a sphere's centre or radius", COORDINATE)?;
                if radius == 0.0 {
                    self.nothing(keyword, "a sphere of radius 0");
                } else {
                    self.builder.sphere(Point3::new(x, y, z), radius);
                }
            }
            b"c" => self.cone(keyword)?,
            b"p" => self.polygon(keyword, false)?,
            b"pp" => self.polygon(keyword, true)?,
            _ => {
                self.report.at(keyword.range(), "unknown entities", || {
                    let error = Diagnostic::error(format!("unknown entity {}", quoted(keyword.text)));
                    let near = std::str::from_utf8(keyword.text).ok().and_then(|w| did_you_mean(w, ENTITIES));
                    match near {
                        Some(near) => error.help(format!("did you mean `{near}`?")),
                        None => error.help("an entity is one of v, b, l, f, c, s, p and pp"),
                    }
                });
                return None;
            }
        }
        Some(())
    }

    /// The six lines of a viewpoint, in any order.
    fn view(&mut self, keyword: Word<'a>) -> Told<()> {
        const PARTS: [&str; 6] = ["from", "at", "up", "angle", "hither", "resolution"];
        if self.seen_view {
            self.report.at(keyword.range(), "viewpoints", || {
                Diagnostic::warning("a second viewpoint: it takes the place of the first")
            });
        }
        self.seen_view = true;
        let (mut from, mut at, mut up, mut angle, mut resolution) = (None, None, None, None, None);
        for _ in 0..PARTS.len() {
            let Some(part) = self.word() else { break };
            match part.text {
                b"from" => from = Some(Point3::from(self.numbers("the eye's place", COORDINATE)?)),
                b"at" => at = Some(Point3::from(self.numbers("the place looked at", COORDINATE)?)),
                b"up" => up = Some(Vector3::from(self.numbers("the direction up", COORDINATE)?)),
                b"angle" => angle = Some(self.number("the angle in degrees", 1e-3..=179.9)?),
                b"hither" => _ = self.number("the hither distance", COORDINATE)?,
                b"resolution" => resolution = Some(self.numbers::<2>("the resolution", 1.0..=65536.0)?),
                other => {
                    self.report.at(part.range(), "viewpoints", || {
                        let error = Diagnostic::error(format!("{} is no part of a viewpoint", quoted(other)));
                        match std::str::from_utf8(other).ok().and_then(|word| did_you_mean(word, PARTS)) {
                            Some(near) => error.help(format!("did you mean `{near}`?")),
                            None => error.help("its parts are from, at, up, angle, hither and resolution"),
                        }
                    });
                    if is_entity(other) {
                        self.back_to(part);
                    }
                    return None;
                }
            }
        }
        let (Some(from), Some(at), Some(up), Some(angle)) = (from, at, up, angle) else {
            self.report.at(keyword.range(), "viewpoints", || {
                Diagnostic::error("this viewpoint lacks one of from, at, up and angle")
            });
            return None;
        };
        let gaze = at - from;
        let across = gaze.try_normalize().zip(up.try_normalize()).map(|(gaze, up)| gaze.cross(up).length());
        if !across.is_some_and(|length| length > 1e-12) {
            self.report.at(keyword.range(), "viewpoints", || {
                Diagnostic::error("this viewpoint has no direction: `from` is `at`, or `up` points along the view")
            });
            return None;
        }
        if let Some([width, height]) = resolution {
            self.builder.resolution = Some([width as u32, height as u32]);
        }
        // From middle to middle of the outermost rows there is a row less than in the whole picture.
        let row_more = match resolution {
            Some([_, rows]) if rows >= 2.0 => rows.trunc() / (rows.trunc() - 1.0),
            _ => 1.0,
        };
        let half = portable::atan(portable::tan(0.5 * portable::radians(angle)) * row_more);
        self.builder.camera = Camera { eye: from, gaze, up, frame: Frame::VerticalFov(2.0 * half), lens: None };
        Some(())
    }

    /// A place, and a colour if three more numbers follow on the line.
    fn light(&mut self) -> Told<()> {
        let position = Point3::from(self.numbers("a light's place", COORDINATE)?);
        let more = self.words.clone().next().is_some_and(|w| w.text[0] != b'#');
        let color = if more { Some(self.color("a light's colour")?) } else { None };
        self.builder.lights.push((position, color));
        Some(())
    }

    fn fill(&mut self) -> Told<()> {
        let color = self.displayed_color("the fill's colour")?;
        let [diffuse, specular] = self.numbers("the fill's Kd or Ks", SHARE)?.map(|share| share as f32);
        let shininess = self.number("the fill's Shine", 0.0..=1e30)? as f32;
        let transmittance = self.number("the fill's T", SHARE)? as f32;
        let index = self.number("the fill's index of refraction", 0.0..=1e3)?;
        if transmittance > 0.0 && index < 0.1 {
            let last = self.last.clone();
            self.report.at(last, "indices of refraction", || {
                Diagnostic::warning(format!("a transparent fill with the index {index}: 1 is taken"))
            });
        }
        let index = if index < 0.1 { 1.0 } else { index };
        self.builder.fill(Fill { color, diffuse, specular, shininess, transmittance, index });
        Some(())
    }

    fn cone(&mut self, keyword: Word<'a>) -> Told<()> {
        let [x, y, z, base_radius] = self.numbers("a cone's base", COORDINATE)?;
        let base = Point3::new(x, y, z);
        let [x, y, z, apex_radius] = self.numbers("a cone's apex", COORDINATE)?;
        let apex = Point3::new(x, y, z);
        if base_radius * apex_radius < 0.0 {
            self.report.at(keyword.range(), "cones", || {
                Diagnostic::error("one radius of this cone is negative and the other is not")
            });
        } else if base == apex || base_radius == 0.0 && apex_radius == 0.0 {
            self.nothing(keyword, "a cone or cylinder of no length or no radius");
        } else {
            self.builder.cone(base, base_radius, apex, apex_radius);
        }
        Some(())
    }

    fn polygon(&mut self, keyword: Word<'a>, patch: bool) -> Told<()> {
        let count = self.number("the number of corners", 0.0..=u32::MAX.into())?;
        if count.fract() != 0.0 {
            let last = self.last.clone();
            self.report.at(last, "polygons", || Diagnostic::error("the number of corners must be whole"));
            return None;
        }
        self.builder.corners.clear();
        self.builder.normals.clear();
        for _ in 0..count as u32 {
            let corner = self.numbers::<3>("a corner", COORDINATE)?;
            self.builder.corners.push(corner.map(|c| c as f32));
            if patch {
                let normal = self.numbers::<3>("a corner's normal", COORDINATE)?;
                self.builder.normals.push(normal.map(|c| c as f32));
            }
        }
        match self.builder.polygon(patch) {
            Ok(0) => self.nothing(keyword, "a polygon without area"),
            Ok(_) => {}
            Err(error) => {
                self.report.at(keyword.range(), "polygons", || Diagnostic::error(error.to_string()));
            }
        }
        Some(())
    }

    /// Tells of something that has no size.
    fn nothing(&mut self, keyword: Word<'_>, what: &str) {
        self.report.at(keyword.range(), "things without size", || Diagnostic::warning(format!("{what} is left out")));
    }

    fn finish(self) -> Option<Scene> {
        if !self.seen_view && !self.report.failed() {
            let error = "this file has no viewpoint (entity `v`)";
            self.report.whole("viewpoints", || Diagnostic::error(error));
        }
        if self.builder.lights.is_empty() && !self.report.failed() {
            let warning = "there is no light: everything has its ambient colour";
            self.report.whole("lights", || Diagnostic::warning(warning));
        }
        let scene = self.builder.finish();
        if scene.objects.is_empty() && !self.report.failed() {
            self.report.whole("objects", || Diagnostic::error("there is nothing in this scene"));
        }
        Some(scene)
    }
}

const ENTITIES: [&str; 8] = ["v", "b", "l", "f", "c", "s", "p", "pp"];

fn is_entity(word: &[u8]) -> bool {
    ENTITIES.iter().any(|entity| entity.as_bytes() == word)
}
