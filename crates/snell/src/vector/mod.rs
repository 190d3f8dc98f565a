//! Vector pictures: pages of strokes, fills and text in millimetres, to be written as SVG, PDF or PNG.
//!
//! Page coordinates are millimetres from the upper left corner, x to the right, y down.

mod join;
mod lines;
mod pdf;
mod raster;
mod svg;
mod text;

use std::f64::consts::TAU;

pub use join::join;
pub use lines::arrow_head;
pub use pdf::encode_pdf;
pub use raster::rasterize;
pub use svg::encode_svg;
pub use text::{Measured, measure};

/// Why a page cannot be written.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum VectorError {
    /// A coordinate is NaN or infinite.
    #[error("the group \"{group}\" of the drawing has a coordinate that is no finite number")]
    NotFinite {
        /// The group's name.
        group: String,
    },
    /// A page without extent, or one that is not finite.
    #[error("a page of {width} x {height} mm cannot be written")]
    Page {
        /// Millimetres.
        width: f64,
        /// Millimetres.
        height: f64,
    },
    /// Too many pixels.
    #[error("a drawing of {width} x {height} pixels is too large: at most {} million are possible", raster::MOST_PIXELS / 1_000_000)]
    TooLarge {
        /// Pixels.
        width: u64,
        /// Pixels.
        height: u64,
    },
    /// The picture below the drawing cannot be read.
    #[error("the picture under the drawing cannot be read: {0}")]
    Backdrop(String),
    /// The library that writes PDF refuses.
    #[error("the PDF cannot be written: {0}")]
    Pdf(String),
}

/// A page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    /// Its width in millimetres.
    pub width: f64,
    /// Its height in millimetres.
    pub height: f64,
    /// What it is called: for the file's own title, not drawn.
    pub title: Option<String>,
    /// What lies under everything, if anything.
    pub backdrop: Option<Backdrop>,
    /// What is on it, from the back to the front.
    pub groups: Vec<Group>,
}

/// A picture under a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Backdrop {
    /// The picture, an encoded PNG.
    pub png: Vec<u8>,
    /// Where it lies on the page: left, top, width, height in millimetres.
    pub place: [f64; 4],
}

/// Things on a page that belong together and have a name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Group {
    /// What they are; becomes the id in an SVG.
    pub name: String,
    /// From the back to the front.
    pub items: Vec<Item>,
}

/// A thing on a page.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// Lines and curves.
    Path(Path),
    /// A line of text.
    Text(Text),
}

/// Lines and curves that are drawn alike.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Path {
    /// Each drawn without lifting the pen.
    pub subpaths: Vec<Subpath>,
    /// How its line is drawn, if at all.
    pub stroke: Option<Stroke>,
    /// The colour of its inside, if any (nonzero rule).
    pub fill: Option<[u8; 3]>,
}

/// A connected line. An ellipse that is alone in it and runs a full turn is closed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Subpath {
    /// Where it starts, millimetres.
    pub start: [f64; 2],
    /// How it goes on; each piece begins where the last one ended.
    pub pieces: Vec<Piece>,
    /// It ends where it starts.
    pub closed: bool,
}

/// A piece of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Piece {
    /// Straight.
    Line {
        /// The end.
        to: [f64; 2],
    },
    /// A part of an ellipse.
    Arc(Arc),
    /// A cubic Bézier curve.
    Cubic {
        /// The control point after the start.
        first: [f64; 2],
        /// The control point before the end.
        second: [f64; 2],
        /// The end.
        to: [f64; 2],
    },
}

/// The part of an ellipse from one angle to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// The middle, millimetres.
    pub center: [f64; 2],
    /// Both semi-axes, positive.
    pub radii: [f64; 2],
    /// The angle of the first semi-axis against the page's x axis, in radians, turning from x to y.
    pub rotation: f64,
    /// The eccentric angle at which it begins, in radians.
    pub start: f64,
    /// That at which it ends: at most a full turn away, in either direction.
    pub end: f64,
}

impl Arc {
    /// The point at an eccentric angle.
    pub fn point(&self, angle: f64) -> [f64; 2] {
        use snell_math::portable::{cos, sin};
        let (x, y) = (self.radii[0] * cos(angle), self.radii[1] * sin(angle));
        let (c, s) = (cos(self.rotation), sin(self.rotation));
        [self.center[0] + c * x - s * y, self.center[1] + s * x + c * y]
    }

    /// True where it is the whole ellipse.
    pub fn is_full(&self) -> bool {
        (self.end - self.start).abs() >= TAU * (1.0 - 1e-12)
    }
}

/// How a line is drawn: with round ends and corners.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// sRGB.
    pub color: [u8; 3],
    /// Millimetres.
    pub width: f64,
    /// Lengths of dashes and gaps by turns, millimetres; empty for a full line.
    pub dashes: Vec<f64>,
}

/// A line of text.
///
/// `*letters*` are italic, `_x` or `_{several}` is lowered, `^x` or `^{several}` raised, and a backslash before one of these marks
/// makes it a letter: `*M*_v` is M with index v.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    /// What it says.
    pub markup: String,
    /// Where, millimetres; which point of the text that is, `horizontal` and `vertical` say.
    pub at: [f64; 2],
    /// Height of the font (em), millimetres.
    pub size: f64,
    /// sRGB.
    pub color: [u8; 3],
    /// Which point of the text's width is at `at`.
    pub horizontal: Horizontal,
    /// Which point of the text's height is at `at`.
    pub vertical: Vertical,
    /// Turned by this angle about `at`, in radians, counter-clockwise as seen.
    pub rotation: f64,
    /// Stands on a patch of the page's white, so that lines below do not disturb it.
    pub halo: bool,
}

/// A place in a text's width.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Horizontal {
    /// Its beginning.
    #[default]
    Left,
    /// Its middle.
    Center,
    /// Its end.
    Right,
}

/// A place in a text's height.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Vertical {
    /// The line that letters stand on.
    #[default]
    Baseline,
    /// Half the height of capital letters.
    Middle,
    /// The top of capital letters.
    Top,
    /// The lowest point of letters such as p.
    Bottom,
}
