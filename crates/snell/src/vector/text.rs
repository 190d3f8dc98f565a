//! Text as outlines of the letters of a font that is a part of the program, so that every machine and every viewer shows the same.
//!
//! Millimetres on the page, y down. The fonts: `crates/snell/assets/fonts/README.md`.

use snell_math::portable;
use ttf_parser::{Face, GlyphId, OutlineBuilder};

use super::{Horizontal, Path, Piece, Subpath, Text, Vertical};

const REGULAR: &[u8] = include_bytes!("../../assets/fonts/libertinus-serif-regular.otf");
const ITALIC: &[u8] = include_bytes!("../../assets/fonts/libertinus-serif-italic.otf");

/// The size of raised and lowered letters.
const SCRIPT: f64 = 0.7;
/// How far they are raised and lowered, in heights of the font.
const RAISED: f64 = 0.36;
const LOWERED: f64 = 0.17;
/// The height of capital letters, in heights of the font.
const CAPITAL: f64 = 0.645;
/// How deep letters such as p go.
const DESCENT: f64 = 0.24;
/// The margin around the letters of a text with a ground of its own, in heights of the font.
const HALO: f64 = 0.1;
/// More letters than this are not drawn: no line of a drawing has so many.
const MOST_LETTERS: usize = 10_000;

/// How large a text is, in millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// From its beginning to its end.
    pub width: f64,
    /// From the line that letters stand on to the top of capital letters.
    pub ascent: f64,
    /// From that line to the lowest point of letters such as p.
    pub descent: f64,
}

/// Letters that look alike.
#[derive(Debug, PartialEq)]
struct Run {
    letters: String,
    italic: bool,
    script: Script,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Script {
    None,
    Raised,
    Lowered,
}

/// How large a text will be; for the markup see [`Text`].
///
/// ```
/// use snell::vector::measure;
/// let plain = measure("M", 4.0);
/// let with_index = measure("M_v", 4.0);
/// assert!(plain.width > 2.0 && with_index.width > plain.width);
/// assert_eq!(measure("", 4.0).width, 0.0);
/// ```
pub fn measure(markup: &str, size: f64) -> Measured {
    let faces = Faces::new();
    let mut width = 0.0;
    for run in runs(markup) {
        let scale = run.size(size);
        width += run.letters.chars().take(MOST_LETTERS).map(|letter| faces.advance(&run, letter) * scale).sum::<f64>();
    }
    Measured { width, ascent: CAPITAL * size, descent: DESCENT * size }
}

/// What a text says, without its markup.
pub(super) fn plain(markup: &str) -> String {
    runs(markup).into_iter().map(|run| run.letters).collect()
}

/// The filled outlines of a text, after the ground that keeps other lines from it.
pub(super) fn outlines(text: &Text) -> Vec<Path> {
    let faces = Faces::new();
    let width = measure(&text.markup, text.size).width;
    let left = match text.horizontal {
        Horizontal::Left => 0.0,
        Horizontal::Center => -0.5 * width,
        Horizontal::Right => -width,
    };
    let base = match text.vertical {
        Vertical::Baseline => 0.0,
        Vertical::Middle => 0.5 * CAPITAL * text.size,
        Vertical::Top => CAPITAL * text.size,
        Vertical::Bottom => -DESCENT * text.size,
    };
    // Counter-clockwise as seen, on a page whose y runs down.
    let (cos, sin) = (portable::cos(text.rotation), portable::sin(text.rotation));
    let mut letters = Letters { subpaths: Vec::new(), scale: 0.0, origin: [0.0; 2], turn: [cos, sin], at: text.at };
    let mut x = left;
    for run in runs(&text.markup) {
        let scale = run.size(text.size);
        letters.scale = scale;
        let lift = match run.script {
            Script::None => 0.0,
            Script::Raised => -RAISED * text.size,
            Script::Lowered => LOWERED * text.size,
        };
        for letter in run.letters.chars().take(MOST_LETTERS) {
            letters.origin = [x, base + lift];
            faces.outline(&run, letter, &mut letters);
            x += faces.advance(&run, letter) * scale;
        }
    }
    let subpaths = letters.subpaths;
    let mut paths = Vec::new();
    if text.halo && !subpaths.is_empty() {
        let margin = HALO * text.size;
        let (x0, x1) = (left - margin, left + width + margin);
        let (y0, y1) = (base - CAPITAL * text.size - margin, base + DESCENT * text.size + 0.5 * margin);
        let place = |[x, y]: [f64; 2]| [text.at[0] + cos * x + sin * y, text.at[1] - sin * x + cos * y];
        let mut ground = Subpath::polyline(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(place));
        ground.closed = true;
        paths.push(Path { subpaths: vec![ground], stroke: None, fill: Some([255; 3]) });
    }
    paths.push(Path { subpaths, stroke: None, fill: Some(text.color) });
    paths
}

impl Run {
    /// The height of its letters in a text of that size.
    fn size(&self, size: f64) -> f64 {
        if self.script == Script::None { size } else { SCRIPT * size }
    }
}

/// Divides markup into runs.
fn runs(markup: &str) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    let mut italic = false;
    let mut put = |letter: char, italic: bool, script: Script| match runs.last_mut() {
        Some(run) if run.italic == italic && run.script == script => run.letters.push(letter),
        _ => runs.push(Run { letters: letter.to_string(), italic, script }),
    };
    let mut letters = markup.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '\\' => put(letters.next().unwrap_or('\\'), italic, Script::None),
            '*' => italic = !italic,
            '_' | '^' => {
                let script = if letter == '_' { Script::Lowered } else { Script::Raised };
                if letters.next_if_eq(&'{').is_some() {
                    while let Some(inner) = letters.next().filter(|inner| *inner != '}') {
                        match inner {
                            '*' => italic = !italic,
                            '\\' => put(letters.next().unwrap_or('\\'), italic, script),
                            inner => put(inner, italic, script),
                        }
                    }
                } else if let Some(only) = letters.next() {
                    put(only, italic, script);
                }
            }
            letter => put(letter, italic, Script::None),
        }
    }
    runs
}

/// Both fonts. Their bytes are in the program; were they broken, no letter would be drawn.
struct Faces {
    regular: Option<Face<'static>>,
    italic: Option<Face<'static>>,
}

impl Faces {
    fn new() -> Self {
        Self { regular: Face::parse(REGULAR, 0).ok(), italic: Face::parse(ITALIC, 0).ok() }
    }

    /// The glyph of a letter and the font it is in; the box for what is missing in both.
    fn glyph(&self, run: &Run, letter: char) -> Option<(&Face<'static>, GlyphId)> {
        let (first, second) = if run.italic { (&self.italic, &self.regular) } else { (&self.regular, &self.italic) };
        let of = |face: &'_ Option<Face<'static>>| face.as_ref().and_then(|face| face.glyph_index(letter));
        if let (Some(face), Some(glyph)) = (first, of(first)) {
            return Some((face, glyph));
        }
        if let (Some(face), Some(glyph)) = (second, of(second)) {
            return Some((face, glyph));
        }
        first.as_ref().map(|face| (face, GlyphId(0)))
    }

    /// How far the next letter is, in heights of the font.
    fn advance(&self, run: &Run, letter: char) -> f64 {
        let Some((face, glyph)) = self.glyph(run, letter) else { return 0.0 };
        f64::from(face.glyph_hor_advance(glyph).unwrap_or(0)) / f64::from(face.units_per_em())
    }

    fn outline(&self, run: &Run, letter: char, letters: &mut Letters) {
        let Some((face, glyph)) = self.glyph(run, letter) else { return };
        let scale = letters.scale;
        letters.scale = scale / f64::from(face.units_per_em());
        face.outline_glyph(glyph, letters);
        letters.scale = scale;
    }
}

/// Gathers outlines, brought to the page.
struct Letters {
    subpaths: Vec<Subpath>,
    /// Millimetres for one unit of the font.
    scale: f64,
    /// The letter's own origin, before the turn.
    origin: [f64; 2],
    turn: [f64; 2],
    at: [f64; 2],
}

impl Letters {
    fn place(&self, x: f32, y: f32) -> [f64; 2] {
        let (x, y) = (self.origin[0] + f64::from(x) * self.scale, self.origin[1] - f64::from(y) * self.scale);
        let [cos, sin] = self.turn;
        [self.at[0] + cos * x + sin * y, self.at[1] - sin * x + cos * y]
    }

    fn put(&mut self, piece: Piece) {
        if let Some(subpath) = self.subpaths.last_mut() {
            subpath.pieces.push(piece);
        }
    }
}

impl OutlineBuilder for Letters {
    fn move_to(&mut self, x: f32, y: f32) {
        let start = self.place(x, y);
        self.subpaths.push(Subpath { start, pieces: Vec::new(), closed: true });
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let to = self.place(x, y);
        self.put(Piece::Line { to });
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let (control, to) = (self.place(x1, y1), self.place(x, y));
        let from = self.subpaths.last().map_or(to, Subpath::end);
        let towards = |p: [f64; 2]| [0, 1].map(|k| p[k] + (control[k] - p[k]) * (2.0 / 3.0));
        self.put(Piece::Cubic { first: towards(from), second: towards(to), to });
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let (first, second, to) = (self.place(x1, y1), self.place(x2, y2), self.place(x, y));
        self.put(Piece::Cubic { first, second, to });
    }

    fn close(&mut self) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_is_understood_and_never_refused() {
        let run = |letters: &str, italic, script| Run { letters: letters.to_owned(), italic, script };
        assert_eq!(
            runs("*M*_v = a^{2*x*}\\*_"),
            [
                run("M", true, Script::None),
                run("v", false, Script::Lowered),
                run(" = a", false, Script::None),
                run("2", false, Script::Raised),
                run("x", true, Script::Raised),
                run("*", false, Script::None),
            ]
        );
        for odd in ["", "*", "_", "^{", "_{a", "\\", "***", "^*", "a}b"] {
            let _ = runs(odd);
        }
        assert_eq!(plain("*p*_1 ∈ ℝ"), "p1 ∈ ℝ");
    }

    #[test]
    fn letters_stand_where_they_are_told() {
        let text = |horizontal, vertical, rotation| Text {
            markup: "H".to_owned(),
            at: [10.0, 20.0],
            size: 10.0,
            color: [0; 3],
            horizontal,
            vertical,
            rotation,
            halo: false,
        };
        let extent = |text: &Text| {
            let points = outlines(text).into_iter().flat_map(|path| path.subpaths).flat_map(|subpath| {
                let ends: Vec<[f64; 2]> = subpath.pieces.iter().map(Piece::end).collect();
                ends.into_iter().chain([subpath.start])
            });
            points.fold([f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY], |e, [x, y]| {
                [e[0].min(x), e[1].max(x), e[2].min(y), e[3].max(y)]
            })
        };
        let [left, right, top, bottom] = extent(&text(Horizontal::Left, Vertical::Baseline, 0.0));
        assert!((10.0..11.0).contains(&left) && (16.0..19.0).contains(&right), "{left} {right}");
        assert!((bottom - 20.0).abs() < 0.1 && (20.0 - top - 10.0 * CAPITAL).abs() < 0.2, "{top} {bottom}");
        let [left, right, top, bottom] = extent(&text(Horizontal::Center, Vertical::Middle, 0.0));
        assert!((0.5 * (left + right) - 10.0).abs() < 0.1 && (0.5 * (top + bottom) - 20.0).abs() < 0.1);
        let [left, right, ..] = extent(&text(Horizontal::Right, Vertical::Top, 0.0));
        assert!(right <= 10.0 && left > 2.0);
        // A quarter turn counter-clockwise: it runs upwards.
        let [left, right, top, bottom] =
            extent(&text(Horizontal::Left, Vertical::Baseline, std::f64::consts::FRAC_PI_2));
        assert!(
            bottom <= 20.0 && top > 11.0 && top < 14.0 && right <= 10.1 && left < 4.0,
            "{left} {right} {top} {bottom}"
        );
    }

    #[test]
    fn what_the_font_has_not_is_a_box() {
        let faces = Faces::new();
        let run = Run { letters: String::new(), italic: false, script: Script::None };
        assert!(faces.advance(&run, '漢') > 0.0);
        for letter in "aZ09äöüß−×·±≤≥≠∞√∈→°′½πθφλΔ".chars() {
            let (_, glyph) = faces.glyph(&run, letter).expect("both fonts are there");
            assert_ne!(glyph, GlyphId(0), "{letter}");
        }
    }
}
