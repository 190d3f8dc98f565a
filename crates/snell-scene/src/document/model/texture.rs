//! Textures as the author writes them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::camera::GradientStop;
use super::spectrum::{Illuminant, MeasuredValues};
use super::value::{Color, Either, Form, Forms, Located, Rotation, Scale, TextureName, Triple, white};

/// A colour, or a texture: what every term of a material takes.
pub type Paint = Either<Color, Box<Texture>>;

/// A colour for every point of a surface: exactly one pattern, and how it lies on the surface. The pattern is scaled, then
/// rotated, then moved. In place of a pattern, `emission` takes light by its spectrum.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(
    extend("oneOf" = [{"required": ["checker"]}, {"required": ["image"]}, {"required": ["gradient"]}, {"required": ["noise"]}, {"required": ["texture"]}, {"required": ["blackbody"]}, {"required": ["illuminant"]}, {"required": ["measured"]}]),
    extend("x-example" = "[material.floor]\ndiffuse = { checker = { colors = [0.9, 0.1], size = 1 } }\n\n[texture.wood]\nnoise = { form = \"wood\", colors = [\"#5a3214\", \"#a5703a\"], octaves = 3 }\nscale = 0.2\n\n[material.table]\ndiffuse = { texture = \"wood\" }\n"),
)]
pub struct Texture {
    /// Cubes of two colours in turn.
    pub checker: Option<CheckerPattern>,
    /// A picture.
    pub image: Option<ImagePattern>,
    /// Colours that change in one direction.
    pub gradient: Option<GradientPattern>,
    /// Irregular patterns: clouds, marble, wood.
    pub noise: Option<NoisePattern>,
    /// A texture of the scene by its name.
    pub texture: Option<TextureName>,
    /// The coordinates in which the pattern is. The default is `uv` for an image, else `object`.
    pub space: Option<Located<TextureSpace>>,
    /// Moves the pattern.
    #[schemars(extend("x-unit" = "units of its space"))]
    pub translate: Option<Located<Triple>>,
    /// Turns the pattern: `[x, y, z]`, about x, then y, then z; or an axis and an angle.
    #[schemars(extend("x-unit" = "degrees"))]
    pub rotate: Option<Located<Rotation>>,
    /// Makes the pattern larger: one factor, or one along each axis, not 0.
    pub scale: Option<Located<Scale>>,
    /// Light of a black body of this temperature, for `emission` alone: see `LightSpectrum`.
    #[schemars(range(min = 500, max = 1000000), extend("x-unit" = "kelvin"))]
    pub blackbody: Option<Located<f64>>,
    /// Light of an illuminant of the CIE, for `emission` alone: see `LightSpectrum`.
    pub illuminant: Option<Located<Illuminant>>,
    /// Light of a measured spectrum, for `emission` alone: see `LightSpectrum`.
    pub measured: Option<Located<MeasuredValues>>,
    /// How bright light of a spectrum is: as white light of this value. The default is 1.
    #[schemars(range(min = 0))]
    pub luminance: Option<Located<f64>>,
}

impl Forms for Texture {
    const FORMS: &'static [Form] = &[Form::Table];
}

/// Coordinates in which a pattern is.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum TextureSpace {
    /// The object's own: the pattern moves with it.
    Object,
    /// The world's: objects move through the pattern.
    World,
    /// The surface's own (u, v), from 0 to 1 around and along most shapes.
    Uv,
}

/// Cubes (on a plane: squares) of two colours in turn.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CheckerPattern {
    /// The two colours, which may be textures themselves.
    #[schemars(extend("default" = [1, 0]))]
    pub colors: [Paint; 2],
    /// The edge of one cube.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "units of its space"))]
    pub size: f64,
}

impl Default for CheckerPattern {
    fn default() -> Self {
        Self { colors: [Either::A(Color::WHITE), Either::A(Color::default())], size: 1.0 }
    }
}

/// A picture over the unit square of its space, x to the right and y up.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImagePattern {
    /// The picture file, relative to the scene file: PNG, JPEG, HDR or EXR.
    pub file: Located<String>,
    /// Repeats it outside the unit square, or else continues its border.
    #[serde(default = "yes")]
    pub repeat: bool,
    /// Blends between pixels, or else shows them as squares.
    #[serde(default = "yes")]
    pub smooth: bool,
}

fn yes() -> bool {
    true
}

/// Colours that change along an axis.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("x-at-most-one" = [["colors", "stops"]]))]
pub struct GradientPattern {
    /// From position 0 to position 1: direction and length.
    #[schemars(extend("x-unit" = "units of its space"))]
    pub axis: Located<Triple>,
    /// The colours at positions 0 and 1. The default is black and white.
    pub colors: Option<[Color; 2]>,
    /// Colours at positions of one's own choice, in place of `colors`, at increasing `at`.
    #[schemars(length(min = 1))]
    pub stops: Option<Vec<Located<GradientStop>>>,
    /// Repeats the colours beyond the last position, or else continues the last colour.
    pub repeat: bool,
}

impl Default for GradientPattern {
    fn default() -> Self {
        Self { axis: [0.0, 1.0, 0.0].into(), colors: None, stops: None, repeat: false }
    }
}

/// Gradient noise: mixes two colours.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct NoisePattern {
    /// How noise becomes a pattern.
    pub form: NoiseForm,
    /// The colours at noise 0 and 1, which may be textures themselves.
    #[schemars(extend("default" = [0, 1]))]
    pub colors: [Paint; 2],
    /// How large its features are.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "units of its space"))]
    pub size: f64,
    /// How many layers of noise are added, each of half the size and strength of the one before.
    #[schemars(range(min = 1, max = 16))]
    pub octaves: u32,
    /// Chooses among patterns that look alike.
    pub seed: u32,
}

impl Default for NoisePattern {
    fn default() -> Self {
        let colors = [Either::A(Color::default()), Either::A(white())];
        Self { form: NoiseForm::Smooth, colors, size: 1.0, octaves: 4, seed: 0 }
    }
}

/// How noise becomes a pattern.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum NoiseForm {
    /// Clouds.
    Smooth,
    /// Billows and cracks.
    Turbulence,
    /// Stripes along x, disturbed.
    Marble,
    /// Rings around the y axis, disturbed.
    Wood,
}
