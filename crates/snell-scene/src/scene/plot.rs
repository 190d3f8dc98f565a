//! Two-dimensional pictures of functions and data: world coordinates → window → viewport → device.
//!
//! Lengths named mm are millimetres of the page; viewports are in normalized device coordinates [0, 1]², y up.

use snell_math::Rgb;

use super::{Expression, Extent};

/// A picture of functions and data.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// What it is called in messages and in the groups of a drawing.
    pub name: Option<String>,
    /// What is written above it, with the markup of labels.
    pub title: Option<String>,
    /// What of the world is seen: the lecture's [l, r] × [b, t].
    pub window: Extent,
    /// Where on the page.
    pub viewport: Extent,
    /// What happens where window and viewport have different proportions.
    pub fit: PlotFit,
    /// The axis along which x increases.
    pub x: Axis,
    /// The axis along which y increases.
    pub y: Axis,
    /// Light lines through the ticks.
    pub grid: bool,
    /// A thin rectangle around what the window shows.
    pub frame: bool,
    /// The curves, from the back to the front.
    pub curves: Vec<PlotCurve>,
    /// Texts; those outside of the window are drawn too.
    pub labels: Vec<PlotLabel>,
}

/// What happens where a window and its viewport have different proportions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PlotFit {
    /// The window fills the viewport.
    #[default]
    Stretch,
    /// The window keeps its proportions, as large as fits, in the middle of the viewport.
    Keep,
}

/// An axis of a plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// It is drawn; else neither it nor its ticks.
    pub show: bool,
    /// What is written at its end, with the markup of labels.
    pub label: Option<String>,
    /// Where it has ticks.
    pub ticks: Ticks,
    /// Ticks and their labels are multiples of π.
    pub pi: bool,
    /// Where it lies.
    pub at: AxisPlace,
    /// It goes a little beyond the window and ends with an arrowhead.
    pub arrow: bool,
}

impl Default for Axis {
    fn default() -> Self {
        Self { show: true, label: None, ticks: Ticks::Auto, pi: false, at: AxisPlace::At(0.0), arrow: false }
    }
}

/// Where an axis has ticks.
#[derive(Clone, Debug, PartialEq)]
pub enum Ticks {
    /// At round numbers, as many as fit.
    Auto,
    /// Nowhere.
    None,
    /// At all multiples of a number above 0.
    Every(f64),
    /// At these places, with what is written there in place of the number.
    At(Vec<(f64, Option<String>)>),
}

/// Where an axis lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AxisPlace {
    /// Where the other coordinate has this value, or at the side of the window that is nearest to it.
    At(f64),
    /// At the lower or left side of the window.
    Border,
}

/// A curve of a plot.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotCurve {
    /// What it runs through.
    pub kind: CurveKind,
    /// What it is called, with the markup of labels.
    pub label: Option<String>,
    /// Where along what is seen of it the label is, from 0 to 1.
    pub label_at: f64,
    /// From there to the label on the page, mm, x to the right, y up.
    pub offset: [f64; 2],
    /// Scene-linear.
    pub color: Rgb,
    /// mm.
    pub width: f64,
    /// Drawn dashed.
    pub dashed: bool,
    /// Fills the area between a function and y = 0, or the inside of any other curve. Scene-linear.
    pub fill: Option<Rgb>,
    /// It ends with an arrowhead.
    pub arrow: bool,
}

/// What a curve runs through.
#[derive(Clone, Debug, PartialEq)]
pub enum CurveKind {
    /// y as a function of x, `from` < `to`. Gaps where the value is not finite.
    Function {
        /// Of x.
        y: Expression,
        /// The smallest x; that of the window where it is not given in the file.
        from: f64,
        /// The largest x.
        to: f64,
    },
    /// x and y as functions of t, `from` < `to`.
    Parametric {
        /// Of t.
        x: Expression,
        /// Of t.
        y: Expression,
        /// The smallest t.
        from: f64,
        /// The largest t.
        to: f64,
    },
    /// Points.
    Data {
        /// In world coordinates.
        points: Vec<[f64; 2]>,
        /// The last is joined with the first.
        closed: bool,
        /// They are joined by lines.
        line: bool,
        /// A dot is drawn at each.
        marks: bool,
    },
}

/// A text in a plot.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotLabel {
    /// Where, in world coordinates.
    pub at: [f64; 2],
    /// What, with the markup of labels.
    pub text: String,
    /// Height of the font, mm.
    pub size: f64,
    /// From `at` to the text on the page, mm, x to the right, y up.
    pub offset: [f64; 2],
    /// Which point of its width is there.
    pub align: Align,
    /// Scene-linear.
    pub color: Rgb,
}

/// A place in a text's width.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Align {
    /// Its beginning.
    Left,
    /// Its middle.
    #[default]
    Center,
    /// Its end.
    Right,
}
