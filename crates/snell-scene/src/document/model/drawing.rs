//! How the scene is drawn as lines, as the author writes it: degrees; mm are millimetres of the drawing.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::camera::Camera;
use super::value::{Color, Either, Located, Triple};

/// How the scene is drawn as lines, and what is drawn into it besides its objects: points, lines, ruled rectangles and cameras.
/// None of this changes a rendered picture.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("x-example" = "[drawing]\nhidden = \"dashed\"\nparameter_lines = 8\naxes = true\n\n[[drawing.point]]\nlabel = \"*P*\"\nposition = [1, 1, 0]\n\n[[object]]\nsphere = {}\n"))]
pub struct Drawing {
    /// What is written above the drawing, with the markup of labels.
    pub title: Option<String>,
    /// How wide the drawing is; its height follows from the proportions of the picture.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 10000, "x-unit" = "mm"))]
    pub width: f64,
    /// What becomes of lines that objects hide.
    pub hidden: HiddenLines,
    /// What lines are coloured by.
    pub stroke: StrokeBy,
    /// How wide lines are.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100, "x-unit" = "mm"))]
    pub line_width: f64,
    /// Edges of meshes are drawn where their two faces turn by more than this.
    #[schemars(range(min = 0, max = 180), extend("x-unit" = "degrees"))]
    pub crease_angle: f64,
    /// How many lines u = const, and how many v = const, are drawn on each curved shape.
    #[schemars(range(max = 1000))]
    pub parameter_lines: u32,
    /// Draws the axes of the world: `true`, or how long they are.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "world units", "default" = false))]
    pub axes: Either<bool, f64>,
    /// Draws a grid on the ground.
    pub ground_grid: Option<Located<GroundGrid>>,
    /// Draws a bar that says how long a world unit is.
    pub scale_bar: bool,
    /// Draws a thin rectangle around the picture.
    pub frame: bool,
    /// Where on the page the picture is: left, right, bottom and top, from 0 to 1, y up.
    #[schemars(inner(range(min = 0, max = 1)))]
    pub viewport: Located<[f64; 4]>,
    /// Points that are drawn, each as `[[drawing.point]]`.
    pub point: Vec<PointMark>,
    /// Lines that are drawn, each as `[[drawing.line]]`.
    pub line: Vec<LineMark>,
    /// Ruled rectangles that are drawn, each as `[[drawing.grid]]`.
    pub grid: Vec<GridMark>,
    /// Cameras that are drawn, each as `[[drawing.camera]]`.
    pub camera: Vec<Located<CameraMark>>,
}

impl Default for Drawing {
    fn default() -> Self {
        let of = crate::scene::Drawing::default();
        Self {
            title: None,
            width: of.width,
            hidden: HiddenLines::Removed,
            stroke: StrokeBy::Uniform,
            line_width: of.line_width,
            crease_angle: 30.0,
            parameter_lines: of.parameter_lines,
            axes: Either::A(false),
            ground_grid: None,
            scale_bar: false,
            frame: false,
            viewport: whole_page(),
            point: Vec::new(),
            line: Vec::new(),
            grid: Vec::new(),
            camera: Vec::new(),
        }
    }
}

/// The viewport that is all of the page.
pub(super) fn whole_page() -> Located<[f64; 4]> {
    [0.0, 1.0, 0.0, 1.0].into()
}

/// What becomes of lines that objects hide.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum HiddenLines {
    /// They are left out.
    Removed,
    /// They are dashed.
    Dashed,
    /// They are drawn like all others, as a wireframe.
    Kept,
}

/// What lines are coloured by.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum StrokeBy {
    /// All are black.
    Uniform,
    /// Each object has a colour of its own.
    Object,
    /// Each material has a colour of its own, which tells it from others.
    Material,
    /// The farther, the lighter.
    Depth,
}

/// A square grid parallel to y = 0.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("x-example" = "[drawing]\nground_grid = { spacing = 0.5, extent = 4 }\n"))]
pub struct GroundGrid {
    /// From line to line.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "world units"))]
    pub spacing: f64,
    /// From its middle to each side.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "world units"))]
    pub extent: f64,
    /// Its y.
    #[schemars(extend("x-unit" = "world units"))]
    pub height: f64,
    /// x and z of its middle.
    #[schemars(extend("x-unit" = "world units"))]
    pub center: [f64; 2],
}

impl Default for GroundGrid {
    fn default() -> Self {
        Self { spacing: 1.0, extent: 5.0, height: 0.0, center: [0.0; 2] }
    }
}

/// A point that is drawn as a dot.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointMark {
    /// What it is called, with the markup of labels.
    pub label: Option<String>,
    /// Where it is.
    #[schemars(extend("x-unit" = "world units"))]
    pub position: Triple,
    /// Its colour and that of its label.
    #[serde(default)]
    #[schemars(extend("default" = "black"))]
    pub color: Color,
    /// From the point to its label on the page: x to the right, y up.
    #[serde(default = "beside")]
    #[schemars(extend("x-unit" = "mm"))]
    pub offset: [f64; 2],
    /// Objects may hide it. Otherwise it is always drawn.
    #[serde(default)]
    pub can_be_hidden: bool,
    /// The diameter of the dot.
    #[serde(default = "dot")]
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100, "x-unit" = "mm"))]
    pub size: f64,
}

/// A line that is drawn: through two or more points.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-example" = "[[drawing.camera]]\nname = \"first\"\nview = { eye = [3, 1, 4] }\n\n[[drawing.line]]\nlabel = \"*ab*\"\npoints = [[-1, 0, 0], [1, 1, 0]]\nproject_to = \"first\"\n"))]
pub struct LineMark {
    /// What it is called, with the markup of labels.
    pub label: Option<String>,
    /// Its corners.
    #[schemars(length(min = 2), extend("x-unit" = "world units"))]
    pub points: Vec<Triple>,
    /// It ends with an arrowhead.
    #[serde(default)]
    pub arrow: bool,
    /// It is dashed.
    #[serde(default)]
    pub dashed: bool,
    /// Its colour and that of its label.
    #[serde(default)]
    #[schemars(extend("default" = "black"))]
    pub color: Color,
    /// How wide it is. The default is the drawing's `line_width`.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100, "x-unit" = "mm"))]
    pub width: Option<f64>,
    /// It is a line of the scene like those of objects: what hides it hides it. Otherwise it is always drawn in full.
    #[serde(default)]
    pub can_be_hidden: bool,
    /// Where along it the label is.
    #[serde(default = "middle")]
    #[schemars(range(min = 0, max = 1))]
    pub label_at: f64,
    /// From there to the label on the page: x to the right, y up.
    #[serde(default = "beside")]
    #[schemars(extend("x-unit" = "mm"))]
    pub offset: [f64; 2],
    /// The name of a `[[drawing.camera]]`: the line's image on its window is drawn too, with the projecting rays of its ends.
    pub project_to: Option<Located<String>>,
    /// Marks this many equal steps along it by points.
    #[serde(default)]
    #[schemars(range(max = 1000))]
    pub steps: u32,
}

/// A ruled rectangle that is drawn, such as the pixels of an image plane.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-example" = "[[drawing.grid]]\ncorner = [-2, 0, 0]\nedges = [[4, 0, 0], [0, 3, 0]]\ncount = [8, 6]\n"))]
pub struct GridMark {
    /// What it is called, with the markup of labels.
    pub label: Option<String>,
    /// The corner at which it begins.
    #[schemars(extend("x-unit" = "world units"))]
    pub corner: Triple,
    /// Its two edges from there.
    #[schemars(extend("x-unit" = "world units"))]
    pub edges: Located<[Triple; 2]>,
    /// How many cells lie along each edge.
    #[serde(default = "one_each")]
    #[schemars(inner(range(min = 1, max = 1000)))]
    pub count: [u32; 2],
    /// Its colour and that of its label.
    #[serde(default = "gray")]
    #[schemars(extend("default" = "gray"))]
    pub color: Color,
    /// How wide its lines are. The default is half the drawing's `line_width`.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100, "x-unit" = "mm"))]
    pub width: Option<f64>,
    /// Objects may hide it. Otherwise it is always drawn in full.
    #[serde(default)]
    pub can_be_hidden: bool,
}

/// A camera that is drawn: its eye, axes and view volume, as the scene's own camera sees them.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-example" = "[[drawing.camera]]\nname = \"inner\"\nview = { eye = [0, 1, 4], look_at = [0, 1, 0], fov = 30 }\nnear = -2\nfar = -6\npixels = [8, 6]\n"))]
pub struct CameraMark {
    /// By which lines refer to it; written at its eye.
    pub name: Option<Located<String>>,
    /// The camera, with the keys of `[camera]`.
    pub view: Located<Camera>,
    /// Width / height of its window. The default is that of the view's `window`, else of its `pixels`, else of the picture.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1000))]
    pub aspect: Option<Located<f64>>,
    /// The z in eye space of the plane on which its window is (n). The default is that of the view's `window`, else a quarter of the
    /// way to what it looks at, or −1 where it has a `gaze`.
    #[schemars(extend("exclusiveMaximum" = 0, "x-unit" = "world units"))]
    pub near: Option<Located<f64>>,
    /// The z in eye space of the far plane (f), below `near`. The default is that of the view's `window`, else half as far again as
    /// what it looks at (−6 where it has a `gaze`), and at least twice `near`.
    #[schemars(extend("exclusiveMaximum" = 0, "x-unit" = "world units"))]
    pub far: Option<Located<f64>>,
    /// Labels eye, axes, gaze and planes.
    #[serde(default = "yes")]
    pub labels: bool,
    /// Draws the axes u, v and w of the eye.
    #[serde(default = "yes")]
    pub axes: bool,
    /// Draws an arrow along the gaze.
    #[serde(default = "yes")]
    pub gaze: bool,
    /// Draws an arrow along the view-up vector.
    #[serde(default)]
    pub up: bool,
    /// Draws the view volume between the near and the far plane.
    #[serde(default = "yes")]
    pub frustum: bool,
    /// Draws the scene's lines, projected, on the near window.
    #[serde(default)]
    pub picture: bool,
    /// Rules the near window into this many pixels, in x and in y.
    #[schemars(inner(range(min = 1, max = 1000)))]
    pub pixels: Option<[u32; 2]>,
    /// The colour of its lines and labels.
    #[serde(default = "steel")]
    #[schemars(extend("default" = "steelblue"))]
    pub color: Color,
}

/// Where labels are unless the author says otherwise, mm.
pub(super) fn beside() -> [f64; 2] {
    [1.4, 1.4]
}

fn dot() -> f64 {
    1.2
}

pub(super) fn middle() -> f64 {
    0.5
}

fn one_each() -> [u32; 2] {
    [1; 2]
}

pub(super) fn yes() -> bool {
    true
}

fn named(name: &str) -> Color {
    Color(crate::document::color::parse(name).unwrap_or(snell_math::Rgb::BLACK))
}

fn gray() -> Color {
    named("gray")
}

fn steel() -> Color {
    named("steelblue")
}
