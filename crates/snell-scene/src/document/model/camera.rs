//! Camera and background as the author writes them: world units, degrees.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::lens::LensChoice;
use super::value::{Color, Located, Triple};

/// From where the scene is seen. What of the world is in the picture is said by `fov` or `vertical_fov` (perspective), by
/// `width` (orthographic), or by a `window` in eye space (either).
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(
    extend("x-at-most-one" = [["fov", "vertical_fov", "width", "window"], ["look_at", "gaze"]]),
    extend("x-example" = "[camera]\neye = [0, 2, 7]\nlook_at = [0, 1, 0]\nfov = 40\n"),
)]
pub struct Camera {
    /// The point from which it sees; for an orthographic camera the point behind the middle of the picture.
    #[schemars(extend("x-unit" = "world units"))]
    pub eye: Located<Triple>,
    /// The point in the middle of the picture. Without it and without `gaze`, the origin.
    #[schemars(extend("x-unit" = "world units"))]
    pub look_at: Option<Located<Triple>>,
    /// The direction in which it looks, in place of `look_at`.
    pub gaze: Option<Located<Triple>>,
    /// What is up in the picture: any direction but the gaze.
    pub up: Located<Triple>,
    /// Perspective or parallel projection.
    pub projection: Option<Located<Projection>>,
    /// Perspective: the angle between the left and the right border of the picture. The default is 40.
    #[schemars(range(min = 0.0001, max = 179.9), extend("x-unit" = "degrees"))]
    pub fov: Option<Located<f64>>,
    /// Perspective: the angle between the bottom and the top of the picture, in place of `fov`.
    #[schemars(range(min = 0.0001, max = 179.9), extend("x-unit" = "degrees"))]
    pub vertical_fov: Option<Located<f64>>,
    /// Orthographic: how much of the world the picture shows from left to right. The default is 4.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "world units"))]
    pub width: Option<Located<f64>>,
    /// The picture's window in eye space.
    pub window: Option<Located<Window>>,
    /// A lens, which is sharp at one distance alone: the name of a real lens, or a table. `path` shows it; `whitted` has a pinhole.
    pub lens: Option<Located<LensChoice>>,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            eye: [0.0, 0.0, 5.0].into(),
            look_at: None,
            gaze: None,
            up: [0.0, 1.0, 0.0].into(),
            projection: None,
            fov: None,
            vertical_fov: None,
            width: None,
            window: None,
            lens: None,
        }
    }
}

/// How points become points of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Projection {
    /// All rays begin in the eye; what is far is small.
    Perspective,
    /// All rays are parallel; size does not depend on distance.
    Orthographic,
}

/// The window l, r, b, t, n, f of the viewing pipeline, in eye space: x to the right, y up, and the camera looks along −z, so
/// that `near` and `far` are negative. Pixels are stretched as the window asks.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-example" = "[camera]\neye = [0, 0, 5]\nwindow = { left = -1, right = 1, bottom = -0.75, top = 0.75, near = -2, far = -100 }\n"))]
pub struct Window {
    /// The x of the left border (l).
    #[schemars(extend("x-unit" = "world units"))]
    pub left: Located<f64>,
    /// The x of the right border (r), above `left`.
    #[schemars(extend("x-unit" = "world units"))]
    pub right: Located<f64>,
    /// The y of the lower border (b).
    #[schemars(extend("x-unit" = "world units"))]
    pub bottom: Located<f64>,
    /// The y of the upper border (t), above `bottom`.
    #[schemars(extend("x-unit" = "world units"))]
    pub top: Located<f64>,
    /// The z of the plane on which the window is (n). Nothing nearer is seen. Negative for a perspective camera.
    #[schemars(extend("x-unit" = "world units"))]
    pub near: Located<f64>,
    /// The z of the far plane (f), below `near`. Nothing beyond is seen. Without it, there is no end.
    #[schemars(extend("x-unit" = "world units"))]
    pub far: Option<Located<f64>>,
}

/// What is seen where there is no object. It lights surfaces only through reflection and refraction.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(
    extend("oneOf" = [{"required": ["color"]}, {"required": ["gradient"]}, {"required": ["photograph"]}, {"required": ["panorama"]}]),
    extend("x-example" = "[background]\ngradient = { horizon = [0.8, 0.9, 1.0], zenith = [0.2, 0.4, 0.8] }\n"),
)]
pub struct Background {
    /// The same colour everywhere.
    pub color: Option<Color>,
    /// Colours by the height of the direction in which one looks.
    pub gradient: Option<Located<BackgroundGradient>>,
    /// A picture that fills the view exactly.
    pub photograph: Option<Photograph>,
    /// A picture all around the scene, most often HDR.
    pub panorama: Option<Panorama>,
}

/// Colours by height: by `horizon`, `zenith` and `nadir`, or by any number of `stops`.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("x-at-most-one" = [["stops", "horizon"], ["stops", "zenith"], ["stops", "nadir"]]))]
pub struct BackgroundGradient {
    /// The colour at the horizon. The default is white.
    pub horizon: Option<Color>,
    /// The colour straight above. The default is the colour of the horizon.
    pub zenith: Option<Color>,
    /// The colour straight below. The default is the colour of the horizon.
    pub nadir: Option<Color>,
    /// Colours at heights of one's own choice, at increasing `at`.
    #[schemars(length(min = 1))]
    pub stops: Option<Vec<Located<BackgroundStop>>>,
}

/// A colour at a height.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BackgroundStop {
    /// The height: the y of the direction, −1 straight down, 0 at the horizon, 1 straight up.
    #[schemars(range(min = -1, max = 1))]
    pub at: f64,
    /// The colour there.
    pub color: Color,
}

/// A colour at a position along a gradient.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GradientStop {
    /// The position: 0 at the gradient's start, 1 at its end.
    pub at: f64,
    /// The colour there.
    pub color: Color,
}

/// A picture that fills the camera's view exactly, as if it stood at infinity.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Photograph {
    /// The picture file, relative to the scene file: PNG, JPEG, HDR or EXR.
    pub file: Located<String>,
    /// Multiplies its colours.
    #[serde(default = "super::value::one")]
    #[schemars(range(min = 0))]
    pub intensity: f32,
}

/// A picture all around the scene, in equirectangular projection (twice as wide as high).
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Panorama {
    /// The picture file, relative to the scene file: PNG, JPEG, HDR or EXR.
    pub file: Located<String>,
    /// Multiplies its colours.
    #[serde(default = "super::value::one")]
    #[schemars(range(min = 0))]
    pub intensity: f32,
    /// Turns it about the vertical, counter-clockwise as seen from above. At 0 its middle is seen along −z.
    #[serde(default)]
    #[schemars(extend("x-unit" = "degrees"))]
    pub rotation: f64,
}
