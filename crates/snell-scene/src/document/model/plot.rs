//! Plots as the author writes them: world coordinates of the plot; mm are millimetres of the page.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::drawing::{beside, middle, whole_page, yes};
use super::formula::{Formula, Quantity};
use super::value::{Color, Either, Form, Forms, Located};

/// A two-dimensional picture of functions and data: what its `window` shows of the world appears in its `viewport` of the page.
/// Several plots may share a page. A scene of plots needs no objects.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-example" = "[[plot]]\nwindow = [0, \"2*pi\", -1, 1]\nviewport = [0.1, 0.9, 0.2, 0.8]\nx = { label = \"*x*\", pi = true }\ny = { label = \"*y*\" }\n\n[[plot.curve]]\nfunction = { y = \"cos(x)\" }\nlabel = \"*y* = cos *x*\"\n"))]
pub struct Plot {
    /// What it is called, for `--set` and messages.
    pub name: Option<Located<String>>,
    /// What is written above it, with the markup of labels.
    pub title: Option<String>,
    /// What of the world is seen: left, right, bottom and top, the lecture's [l, r] × [b, t].
    pub window: [Located<Quantity>; 4],
    /// Where on the page: left, right, bottom and top, from 0 to 1, y up.
    #[serde(default = "whole_page")]
    #[schemars(inner(range(min = 0, max = 1)))]
    pub viewport: Located<[f64; 4]>,
    /// What happens where window and viewport have different proportions.
    #[serde(default = "stretch")]
    pub fit: PlotFit,
    /// The axis along which x increases.
    #[serde(default)]
    #[schemars(extend("default" = {}))]
    pub x: Axis,
    /// The axis along which y increases.
    #[serde(default)]
    #[schemars(extend("default" = {}))]
    pub y: Axis,
    /// Draws light lines through the ticks.
    #[serde(default)]
    pub grid: bool,
    /// Draws a thin rectangle around what the window shows.
    #[serde(default)]
    pub frame: bool,
    /// The curves, each as `[[plot.curve]]`.
    #[serde(default)]
    pub curve: Vec<PlotCurve>,
    /// Texts, each as `[[plot.label]]`.
    #[serde(default)]
    pub label: Vec<PlotLabel>,
}

/// What happens where a window and its viewport have different proportions.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum PlotFit {
    /// The window fills the viewport; circles become ellipses.
    Stretch,
    /// The window keeps its proportions, as large as fits, in the middle of the viewport.
    Keep,
}

fn stretch() -> PlotFit {
    PlotFit::Stretch
}

/// An axis of a plot, with ticks at round numbers unless the author says where.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(
    extend("x-at-most-one" = [["ticks", "every"]]),
    extend("x-example" = "[[plot]]\nwindow = [0, 4, 0, 3]\nx = { label = \"*z*\", ticks = [{ at = 1, label = \"*n*\" }, { at = 4, label = \"*f*\" }] }\ny = { every = 0.5, at = \"border\" }\n"),
)]
pub struct Axis {
    /// Draws it, with its ticks.
    pub show: bool,
    /// What is written at its end, with the markup of labels.
    pub label: Option<String>,
    /// Where it has ticks: a word, or a list of places.
    #[schemars(extend("default" = "auto"))]
    pub ticks: Either<TicksWord, Vec<Located<Either<Tick, Quantity>>>>,
    /// The distance from tick to tick, in place of `ticks`.
    pub every: Option<Located<Quantity>>,
    /// Ticks are at multiples of π, and labelled so.
    pub pi: bool,
    /// Where it lies: the value of the other coordinate there, or a word. Outside of the window it lies at the nearest side.
    #[schemars(extend("default" = 0))]
    pub at: Either<AxisWord, f64>,
    /// It ends with an arrowhead, a little beyond the window.
    pub arrow: bool,
}

impl Default for Axis {
    fn default() -> Self {
        Self {
            show: true,
            label: None,
            ticks: Either::A(TicksWord::Auto),
            every: None,
            pi: false,
            at: Either::B(0.0),
            arrow: false,
        }
    }
}

/// Where an axis has ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum TicksWord {
    /// At round numbers, as many as fit.
    Auto,
    /// Nowhere.
    None,
}

impl Forms for TicksWord {
    const FORMS: &'static [Form] = &[Form::Text];
}

/// Where an axis lies.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum AxisWord {
    /// At the lower or left side of the window.
    Border,
}

impl Forms for AxisWord {
    const FORMS: &'static [Form] = &[Form::Text];
}

/// A tick with a label of its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tick {
    /// Where on the axis.
    pub at: Located<Quantity>,
    /// What is written there, with the markup of labels. Without it, the number.
    pub label: Option<String>,
}

impl Forms for Tick {
    const FORMS: &'static [Form] = &[Form::Table];
}

/// A curve of a plot: what it runs through, and how it is drawn. It is clipped to the window.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{"required": ["function"]}, {"required": ["parametric"]}, {"required": ["data"]}]))]
pub struct PlotCurve {
    /// y as a function of x.
    pub function: Option<Located<PlotFunction>>,
    /// x and y as functions of t.
    pub parametric: Option<Located<PlotParametric>>,
    /// Points.
    pub data: Option<PlotData>,
    /// What it is called, with the markup of labels.
    pub label: Option<String>,
    /// Where along it the label is.
    #[serde(default = "middle")]
    #[schemars(range(min = 0, max = 1))]
    pub label_at: f64,
    /// From there to the label on the page: x to the right, y up.
    #[serde(default = "beside")]
    #[schemars(extend("x-unit" = "mm"))]
    pub offset: [f64; 2],
    /// Its colour and that of its label.
    #[serde(default)]
    #[schemars(extend("default" = "black"))]
    pub color: Color,
    /// How wide the line is.
    #[serde(default = "half_millimetre")]
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100, "x-unit" = "mm"))]
    pub width: f64,
    /// It is dashed.
    #[serde(default)]
    pub dashed: bool,
    /// Fills the area between a function and y = 0, or the inside of any other curve.
    pub fill: Option<Color>,
    /// It ends with an arrowhead.
    #[serde(default)]
    pub arrow: bool,
}

/// y as a function of x. A formula has numbers, `x` (or `t`), pi, tau, e, the operations + − * / ^, parentheses, and the functions
/// sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, exp, ln, log2, log10, sqrt, cbrt, abs, sign, floor, ceil, round, min, max,
/// atan2 and mod, with angles in radians. Where its value is not finite, the curve has a gap.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-example" = "[[plot]]\nwindow = [\"-2*pi\", \"2*pi\", -3, 3]\nx = { pi = true }\n\n[[plot.curve]]\nfunction = { y = \"tan(x)\" }\ncolor = \"firebrick\"\n"))]
pub struct PlotFunction {
    /// The formula of x.
    pub y: Located<Formula>,
    /// Where it begins. The default is the left side of the window.
    pub from: Option<Located<Quantity>>,
    /// Where it ends, above `from`. The default is the right side of the window.
    pub to: Option<Located<Quantity>>,
}

/// x and y as functions of t.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-example" = "[[plot]]\nwindow = [-2, 2, -1.5, 1.5]\nfit = \"keep\"\n\n[[plot.curve]]\nparametric = { x = \"cos(t)\", y = \"sin(t)\", to = \"2*pi\" }\n"))]
pub struct PlotParametric {
    /// The formula of t for x.
    pub x: Located<Formula>,
    /// The formula of t for y.
    pub y: Located<Formula>,
    /// The smallest t.
    #[serde(default = "zero")]
    pub from: Located<Quantity>,
    /// The largest t, above `from`.
    #[serde(default = "one")]
    pub to: Located<Quantity>,
}

/// Points, joined by lines or marked by dots.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-example" = "[[plot]]\nwindow = [0, 3, 0, 2]\n\n[[plot.curve]]\ndata = { points = [[0, 0.5], [1, 1.5], [2, 1], [3, 1.8]], marks = true }\n"))]
pub struct PlotData {
    /// The points [x, y].
    #[schemars(length(min = 1))]
    pub points: Vec<[Located<Quantity>; 2]>,
    /// Joins the last point with the first.
    #[serde(default)]
    pub closed: bool,
    /// Joins the points by lines.
    #[serde(default = "yes")]
    pub line: bool,
    /// Draws a dot at each point.
    #[serde(default)]
    pub marks: bool,
}

/// A text in a plot. It may lie outside of the window.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-example" = "[[plot]]\nwindow = [0, 1, 0, 1]\n\n[[plot.label]]\nat = [0.5, 0.5]\ntext = \"*M* = *M*_o*M*_v\"\n"))]
pub struct PlotLabel {
    /// Where, in world coordinates of the plot.
    pub at: [Located<Quantity>; 2],
    /// What, with the markup of labels.
    pub text: String,
    /// How large the letters are.
    #[serde(default = "letters")]
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100, "x-unit" = "mm"))]
    pub size: f64,
    /// From there to the text on the page: x to the right, y up.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm"))]
    pub offset: [f64; 2],
    /// Which point of its width is there.
    #[serde(default = "center")]
    pub align: Align,
    /// Its colour.
    #[serde(default)]
    #[schemars(extend("default" = "black"))]
    pub color: Color,
}

/// A place in a text's width.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Align {
    /// Its beginning.
    Left,
    /// Its middle.
    Center,
    /// Its end.
    Right,
}

fn center() -> Align {
    Align::Center
}

fn letters() -> f64 {
    3.2
}

fn half_millimetre() -> f64 {
    0.5
}

fn zero() -> Located<Quantity> {
    Quantity::from(0.0).into()
}

fn one() -> Located<Quantity> {
    Quantity::from(1.0).into()
}
