//! Lights as the author writes them: world units, degrees.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::spectrum::LightColor;
use super::value::{Color, Either, Form, Forms, Located, Triple, one};

/// A light: exactly one of `point`, `directional` and `spot`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(
    extend("oneOf" = [{"required": ["point"]}, {"required": ["directional"]}, {"required": ["spot"]}]),
    extend("x-example" = "[[light]]\nname = \"key\"\npoint = { position = [6, 9, 5], intensity = 0.8 }\n\n[[light]]\nname = \"sun\"\ndirectional = { direction = [-1, -2, -1], color = \"moccasin\" }\n"),
)]
pub struct Light {
    /// Its name, for `--set` and for messages.
    pub name: Option<Located<String>>,
    /// Shines in all directions from one point.
    pub point: Option<PointLight>,
    /// Shines from infinitely far away, like the sun.
    pub directional: Option<DirectionalLight>,
    /// Shines as a cone from one point.
    pub spot: Option<SpotLight>,
}

/// A light that shines in all directions from one point.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointLight {
    /// Where it is.
    #[schemars(extend("x-unit" = "world units"))]
    pub position: Triple,
    /// Its colour, or a spectrum.
    #[serde(default = "white")]
    #[schemars(extend("default" = 1))]
    pub color: LightColor,
    /// Multiplies its colour. A white surface that faces a light of intensity 1 without falloff has the colour 1.
    #[serde(default = "one")]
    #[schemars(range(min = 0))]
    pub intensity: f32,
    /// How the light decreases with distance: a word, or a polynomial's coefficients.
    #[serde(default)]
    #[schemars(extend("default" = "none"))]
    pub falloff: Located<Falloff>,
}

/// A light from infinitely far away.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DirectionalLight {
    /// The way the light travels, of any length but 0.
    pub direction: Located<Triple>,
    /// Its colour, or a spectrum.
    #[serde(default = "white")]
    #[schemars(extend("default" = 1))]
    pub color: LightColor,
    /// Multiplies its colour.
    #[serde(default = "one")]
    #[schemars(range(min = 0))]
    pub intensity: f32,
    /// The angle that it is seen under: the sun's is 0.53. `path` shows soft shadows for it.
    #[serde(default)]
    #[schemars(range(min = 0, max = 90), extend("x-unit" = "degrees"))]
    pub angle: f64,
}

/// A cone of light from one point.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(
    extend("oneOf" = [{"required": ["look_at"]}, {"required": ["direction"]}]),
    extend("x-example" = "[[light]]\nspot = { position = [0, 6, 0], look_at = [0, 0, 0], cone_angle = 20, falloff = \"inverse-square\", intensity = 40 }\n"),
)]
pub struct SpotLight {
    /// Where it is.
    #[schemars(extend("x-unit" = "world units"))]
    pub position: Triple,
    /// A point in the middle of its cone.
    #[schemars(extend("x-unit" = "world units"))]
    pub look_at: Option<Located<Triple>>,
    /// The way the middle of its light travels, of any length but 0, in place of `look_at`.
    pub direction: Option<Located<Triple>>,
    /// From the middle of the cone to its border: half the opening angle. It is dark outside.
    #[serde(default = "default_cone_angle")]
    #[schemars(range(min = 0.01, max = 90), extend("x-unit" = "degrees"))]
    pub cone_angle: Located<f64>,
    /// From the middle to where the light begins to fade, at most `cone_angle`. The default is 0.8 times that.
    #[schemars(range(min = 0, max = 90), extend("x-unit" = "degrees"))]
    pub full_angle: Option<Located<f64>>,
    /// Its colour, or a spectrum.
    #[serde(default = "white")]
    #[schemars(extend("default" = 1))]
    pub color: LightColor,
    /// Multiplies its colour.
    #[serde(default = "one")]
    #[schemars(range(min = 0))]
    pub intensity: f32,
    /// How the light decreases with distance: a word, or a polynomial's coefficients.
    #[serde(default)]
    #[schemars(extend("default" = "none"))]
    pub falloff: Located<Falloff>,
}

fn white() -> LightColor {
    Either::A(Color::WHITE)
}

fn default_cone_angle() -> Located<f64> {
    30.0.into()
}

/// How light decreases with distance d.
pub type Falloff = Either<FalloffLaw, PolynomialFalloff>;

impl Default for Falloff {
    fn default() -> Self {
        Self::A(FalloffLaw::None)
    }
}

/// How light decreases with distance d.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FalloffLaw {
    /// Not at all.
    None,
    /// By 1 / d.
    Linear,
    /// By 1 / d², as real light does.
    InverseSquare,
}

impl Forms for FalloffLaw {
    const FORMS: &'static [Form] = &[Form::Text];
}

/// A falloff by 1 / (constant + linear d + quadratic d²), at most 1.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PolynomialFalloff {
    /// The constant term.
    #[schemars(range(min = 0))]
    pub constant: f64,
    /// The factor of d.
    #[schemars(range(min = 0), extend("x-unit" = "1 / world unit"))]
    pub linear: f64,
    /// The factor of d².
    #[schemars(range(min = 0), extend("x-unit" = "1 / world unit²"))]
    pub quadratic: f64,
}

impl Default for PolynomialFalloff {
    fn default() -> Self {
        Self { constant: 1.0, linear: 0.0, quadratic: 0.0 }
    }
}
