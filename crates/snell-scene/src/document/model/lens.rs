//! Lenses of cameras as the author writes them: millimetres, as opticians do.

use schemars::JsonSchema;
use serde::Deserialize;

use super::material::Ior;
use super::value::{Either, Form, Forms, Located, Triple};

/// A lens of a camera: the name of a real one, or a table.
pub type LensChoice = Either<String, Box<CameraLens>>;

/// A lens in front of the camera: a thin one by the `radius` of its aperture, or a real one by what it is made `of`. Where it is sharp is
/// said by `focus` or `focus_at`.
///
/// A thin lens has no faults. A real one is a stack of spherical surfaces through which `path` follows every ray, each wavelength by
/// the index of each glass there: so it bends straight lines, darkens towards the corners, fringes edges with colour, and cuts the discs of
/// blurred lamps to cat's eyes, as its prescription says. It is measured in millimetres, so the scene needs a `unit`, and the width of
/// its `film` decides how much it sees, in place of `fov`. The camera's eye is the middle of its entrance pupil. The picture is as bright as
/// with a thin lens in its middle, whatever the `f_number`; what surfaces reflect, which coatings prevent, is left out.
///
/// `whitted` and drawings have a pinhole in the same place, with the same field of view.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(
    extend("oneOf" = [{"required": ["radius"]}, {"required": ["of"]}]),
    extend("x-at-most-one" = [["focus", "focus_at"], ["radius", "f_number"], ["radius", "film"]]),
    extend("x-example" = "unit = \"cm\"\n\n[camera]\neye = [0, 20, 70]\nlook_at = [0, 10, 0]\nlens = { of = \"double-gauss\", f_number = 2.8 }\n"),
)]
pub struct CameraLens {
    /// A thin lens: the radius of its aperture.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "world units"))]
    pub radius: Option<f64>,
    /// A real lens: a built-in one, which are "achromat" (100 mm, f/4), "cooke-triplet" (50 mm, f/4), "double-gauss" (50 mm, f/2) and
    /// "singlet" (50 mm, f/5.6); a file such as "my-lens.toml", which has the keys of the table; or that table.
    pub of: Option<Located<PrescriptionChoice>>,
    /// The focal length over the diameter of the entrance pupil: how far the stop is closed. The default is wide open.
    #[schemars(range(min = 0.1, max = 128))]
    pub f_number: Option<Located<f64>>,
    /// The width of the film. The default is 36.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "mm"))]
    pub film: Option<Located<f64>>,
    /// The distance along the gaze at which it is sharp. Without it and without `focus_at`, that of `look_at`.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "world units"))]
    pub focus: Option<Located<f64>>,
    /// A point at whose distance it is sharp.
    #[schemars(extend("x-unit" = "world units"))]
    pub focus_at: Option<Located<Triple>>,
    /// How many blades the aperture has, whose edges show in what is blurred; 0 for a round one.
    #[serde(default)]
    #[schemars(range(min = 0, max = 32))]
    pub blades: u32,
}

/// The name or file of a lens, or its table.
pub type PrescriptionChoice = Either<String, LensPrescription>;

/// A lens as opticians write it down: its surfaces from the front, where light comes in, to the film. A lens file has these keys.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-example" = "unit = \"cm\"\n\n[camera]\neye = [0, 20, 70]\nlook_at = [0, 10, 0]\n\n[camera.lens.of]\nname = \"plano-convex\"\nsurfaces = [\n  { stop = true, thickness = 3, diameter = 8 },\n  { thickness = 4, glass = \"N-BK7\", diameter = 20 },\n  { radius = -26, diameter = 20 },\n]\n"))]
pub struct LensPrescription {
    /// What it is called.
    pub name: Option<String>,
    /// Where its numbers are from.
    pub source: Option<String>,
    /// Its surfaces. One of them is the `stop`.
    #[schemars(length(min = 1, max = 100))]
    pub surfaces: Vec<Located<LensSurface>>,
}

/// A surface of a lens.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LensSurface {
    /// The radius of curvature: positive where the centre lies behind the surface, towards the film. Without it, the surface is flat.
    #[schemars(extend("x-unit" = "mm"))]
    pub radius: Option<Located<f64>>,
    /// How far the next surface is behind it, on the axis. That of the last one, to the film, follows from the focus.
    #[serde(default)]
    #[schemars(range(min = 0), extend("x-unit" = "mm"))]
    pub thickness: f64,
    /// What is behind it: an index, a glass, a formula, as `ior` of a dielectric has them, or [index at the d line, Abbe number]. Without it, air.
    #[schemars(extend("minimum" = 0.1, "maximum" = 100))]
    pub glass: Option<Located<LensGlass>>,
    /// The diameter of what lets light pass; of the stop, wide open.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "mm"))]
    pub diameter: Located<f64>,
    /// It is the aperture stop, which `f_number` closes.
    #[serde(default)]
    pub stop: bool,
}

/// The glass of a lens.
pub type LensGlass = Either<IndexAndAbbeNumber, Ior>;

/// The index at the helium d line, and the Abbe number.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(transparent)]
#[schemars(inline, transparent)]
pub struct IndexAndAbbeNumber(#[schemars(inner(range(min = 1, max = 1000)))] pub [f64; 2]);

impl Forms for IndexAndAbbeNumber {
    const FORMS: &'static [Form] = &[Form::List];
}
