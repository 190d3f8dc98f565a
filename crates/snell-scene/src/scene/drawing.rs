//! How a scene is drawn as lines, and what is drawn into it besides its objects.
//!
//! Lengths named mm are millimetres of the drawing; all others are world units. Angles are in radians.

use snell_math::{Point3, Rgb, Vector3};

use super::Camera;

/// Left, right, bottom and top of an upright rectangle: the lecture's [l, r] × [b, t], with l < r and b < t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// l.
    pub left: f64,
    /// r.
    pub right: f64,
    /// b.
    pub bottom: f64,
    /// t.
    pub top: f64,
}

impl Extent {
    /// The whole page, in normalized device coordinates.
    pub const UNIT: Self = Self { left: 0.0, right: 1.0, bottom: 0.0, top: 1.0 };
}

impl Default for Extent {
    fn default() -> Self {
        Self::UNIT
    }
}

/// How the author wants the scene drawn; the command line may say otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// What is written above it.
    pub title: Option<String>,
    /// Width of the drawing, mm; its height follows from the picture's proportions.
    pub width: f64,
    /// What becomes of lines that objects hide.
    pub hidden: HiddenLines,
    /// What lines are coloured by.
    pub stroke: StrokeBy,
    /// mm.
    pub line_width: f64,
    /// Edges of meshes whose faces turn by more than this are drawn; in [0, π].
    pub crease_angle: f64,
    /// How many lines u = const and how many v = const are drawn on each curved shape.
    pub parameter_lines: u32,
    /// The axes of the world, if they are drawn.
    pub axes: Option<AxesLength>,
    /// A grid on the ground.
    pub ground_grid: Option<GroundGrid>,
    /// A bar that says how long a world unit is.
    pub scale_bar: bool,
    /// A thin rectangle around the picture.
    pub frame: bool,
    /// Where on the page the picture is, in normalized device coordinates, y up.
    pub viewport: Extent,
    /// Points.
    pub points: Vec<PointMark>,
    /// Lines.
    pub lines: Vec<LineMark>,
    /// Ruled rectangles.
    pub grids: Vec<GridMark>,
    /// Cameras that are drawn, with their view volumes.
    pub cameras: Vec<CameraMark>,
}

impl Default for Drawing {
    fn default() -> Self {
        Self {
            title: None,
            width: 160.0,
            hidden: HiddenLines::Removed,
            stroke: StrokeBy::Uniform,
            line_width: 0.35,
            crease_angle: snell_math::portable::radians(30.0),
            parameter_lines: 0,
            axes: None,
            ground_grid: None,
            scale_bar: false,
            frame: false,
            viewport: Extent::UNIT,
            points: Vec::new(),
            lines: Vec::new(),
            grids: Vec::new(),
            cameras: Vec::new(),
        }
    }
}

/// What becomes of lines that objects hide.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HiddenLines {
    /// They are left out.
    #[default]
    Removed,
    /// They are dashed.
    Dashed,
    /// They are drawn like all others: a wireframe.
    Kept,
}

/// What lines are coloured by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StrokeBy {
    /// All are black.
    #[default]
    Uniform,
    /// Each object has a colour of its own.
    Object,
    /// Each material has a colour of its own, which tells it from others.
    Material,
    /// The farther, the lighter.
    Depth,
}

/// How long the drawn axes of the world are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AxesLength {
    /// As long as looks well.
    Fitting,
    /// World units, above 0.
    Length(f64),
}

/// A square grid parallel to y = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundGrid {
    /// From line to line, above 0.
    pub spacing: f64,
    /// From the middle to each side, above 0.
    pub extent: f64,
    /// Its y.
    pub height: f64,
    /// x and z of its middle.
    pub center: [f64; 2],
}

/// A point that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct PointMark {
    /// What it is called, with the markup of labels.
    pub label: Option<String>,
    /// Where it is.
    pub position: Point3,
    /// Scene-linear.
    pub color: Rgb,
    /// From the point to the label on the page, mm, x to the right, y up.
    pub offset: [f64; 2],
    /// It is not drawn where objects hide it; else always.
    pub can_be_hidden: bool,
    /// Diameter of the dot, mm.
    pub size: f64,
}

/// A line that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct LineMark {
    /// What it is called, with the markup of labels.
    pub label: Option<String>,
    /// Its corners, two or more.
    pub points: Vec<Point3>,
    /// It ends with an arrowhead.
    pub arrow: bool,
    /// Drawn dashed.
    pub dashed: bool,
    /// Scene-linear.
    pub color: Rgb,
    /// mm; that of the drawing where it has none.
    pub width: Option<f64>,
    /// It is treated as a line of the scene, which objects hide; else always drawn in full.
    pub can_be_hidden: bool,
    /// Where along it the label is, from 0 to 1.
    pub label_at: f64,
    /// From there to the label on the page, mm, x to the right, y up.
    pub offset: [f64; 2],
    /// The index of a drawn camera: the line's image on its window is drawn too, with the projecting rays of its ends.
    pub project_to: Option<usize>,
    /// How many equal steps along it are marked by points; 0 marks none.
    pub steps: u32,
}

/// A ruled rectangle (or parallelogram), such as the pixels of an image plane.
#[derive(Clone, Debug, PartialEq)]
pub struct GridMark {
    /// What it is called, with the markup of labels.
    pub label: Option<String>,
    /// Where it begins.
    pub corner: Point3,
    /// Its two edges from there, of any length but 0 and not parallel.
    pub edges: [Vector3; 2],
    /// How many cells lie along each edge.
    pub count: [u32; 2],
    /// Scene-linear.
    pub color: Rgb,
    /// mm; half that of the drawing where it has none.
    pub width: Option<f64>,
    /// Objects hide it; else it is always drawn in full.
    pub can_be_hidden: bool,
}

/// A camera that is drawn: seen by the scene's own camera.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraMark {
    /// By which lines refer to it, and what is written at its eye.
    pub name: Option<String>,
    /// The camera.
    pub camera: Camera,
    /// Width / height of its window.
    pub aspect: f64,
    /// n: the z of the window in eye space; negative for a perspective camera.
    pub near: f64,
    /// f: the z of the far plane in eye space, below `near` and finite.
    pub far: f64,
    /// Eye, axes, gaze and planes are labelled.
    pub labels: bool,
    /// The axes u, v, w of the eye are drawn.
    pub axes: bool,
    /// An arrow along the gaze is drawn.
    pub gaze: bool,
    /// An arrow along the view-up vector is drawn.
    pub up: bool,
    /// The view volume between near and far is drawn.
    pub frustum: bool,
    /// The scene's own lines, projected, are drawn on the near window.
    pub picture: bool,
    /// The near window is ruled into this many pixels in x and in y.
    pub pixels: Option<[u32; 2]>,
    /// Scene-linear.
    pub color: Rgb,
}

impl CameraMark {
    /// A camera of a picture of that width / height, with its view volume between two planes, and nothing else.
    pub fn new(camera: Camera, aspect: f64, near: f64, far: f64) -> Self {
        Self {
            name: None,
            camera,
            aspect,
            near,
            far,
            labels: true,
            axes: false,
            gaze: false,
            up: false,
            frustum: true,
            picture: false,
            pixels: None,
            color: Rgb::new(0.02, 0.08, 0.4),
        }
    }
}
