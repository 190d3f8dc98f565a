//! Materials as the author writes them: the lecture's terms, and transparent bodies.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::texture::Paint;
use super::value::{Color, Either, Form, Forms, Located, MaterialName};

/// What a surface does with light. Each term may be left out; what is left out is not there. An object without a material
/// is diffuse, 0.8.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("x-example" = "[material.red]\ndiffuse = \"crimson\"\nspecular = 0.6\nshininess = 80\nmirror = 0.1\n\n[material.glass]\ndielectric = { ior = \"N-BK7\" }\n"))]
pub struct Material {
    /// The factor on the scene's ambient light. The default is the diffuse colour.
    pub ambient: Option<Box<Located<Paint>>>,
    /// The share of light that is scattered evenly in all directions (Lambert).
    pub diffuse: Option<Box<Located<Paint>>>,
    /// Strength and colour of the highlights of lights (Phong).
    pub specular: Option<Box<Located<Paint>>>,
    /// How sharp highlights are: the exponent of Phong's cosine.
    #[schemars(range(min = 0, max = 1000000))]
    pub shininess: f32,
    /// The share of light that is reflected as by a mirror.
    pub mirror: Option<Box<Located<Paint>>>,
    /// Light that it gives off by itself. It lights nothing else but through reflection and refraction.
    pub emission: Option<Box<Located<Paint>>>,
    /// Makes it a transparent body.
    pub dielectric: Option<Box<Located<Dielectric>>>,
    /// Makes it a metal. `path` shows it as it is; `whitted` as a mirror of its colour.
    pub metal: Option<Box<Located<Metal>>>,
    /// Lit on its outward side alone.
    pub one_sided: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            ambient: None,
            diffuse: None,
            specular: None,
            shininess: 50.0,
            mirror: None,
            emission: None,
            dielectric: None,
            metal: None,
            one_sided: false,
        }
    }
}

impl Forms for Material {
    const FORMS: &'static [Form] = &[Form::Table];
}

/// The name of a material of the scene, or a material in place.
pub type MaterialChoice = Either<MaterialName, Box<Material>>;

/// A transparent body: its surface and its inside.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("x-example" = "[material.bottle]\ndielectric = { ior = 1.52, absorption = { color = [0.2, 0.7, 0.3], distance = 0.5 } }\n"))]
pub struct Dielectric {
    /// The index of refraction: a number, the name of a material or glass such as "water", "diamond" or "N-BK7", a glass of a
    /// file such as "hoya.agf#FCD1" or "page.yml", or a dispersion formula. For the lecture's water, rock salt, cubic zirconia and diamond
    /// `path` takes what was measured at each wavelength, `whitted` the one number that the lecture prints.
    #[schemars(extend("minimum" = 0.1, "maximum" = 100, "default" = 1.5))]
    pub ior: Located<Ior>,
    /// Reflection and refraction follow Fresnel's equations; `reflect` and `transmit` scale them. If false, `reflect` and
    /// `transmit` are the shares themselves.
    pub fresnel: bool,
    /// The coefficient of the reflected ray: 1 with `fresnel`, else to be given.
    pub reflect: Option<Located<Paint>>,
    /// The coefficient of the refracted ray: 1 with `fresnel`, else to be given.
    pub transmit: Option<Located<Paint>>,
    /// How rough the surface is: 0 is smooth, 1 as rough as can be. `path` shows it, `whitted` knows smooth surfaces alone.
    #[schemars(range(min = 0, max = 1))]
    pub roughness: f32,
    /// A thin film on the surface, whose colours `path` shows: a soap bubble's, oil's, a coating's.
    pub film: Option<Film>,
    /// How the inside absorbs light on its way: "catalogue" for what was measured of the glass that `ior` names, by the scene's `unit`; or a
    /// colour after a distance.
    pub absorption: Option<Located<AbsorptionChoice>>,
    /// How the inside scatters light, as milk does.
    pub scattering: Option<Scattering>,
    /// Where transparent bodies overlap, the one of higher priority is there.
    #[schemars(range(min = -1000000, max = 1000000))]
    pub priority: i32,
}

impl Default for Dielectric {
    fn default() -> Self {
        Self {
            ior: Either::A(1.5).into(),
            fresnel: true,
            reflect: None,
            transmit: None,
            roughness: 0.0,
            film: None,
            absorption: None,
            scattering: None,
            priority: 0,
        }
    }
}

/// A thin film on a surface.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-example" = "[material.soap]\ndielectric = { ior = 1, film = { thickness = 400, ior = 1.33 } }\n"))]
pub struct Film {
    /// Its thickness: the same everywhere, or between two by a texture.
    #[schemars(extend("minimum" = 0, "maximum" = 100000, "x-unit" = "nanometres"))]
    pub thickness: Either<f64, FilmThickness>,
    /// Its index of refraction, as that of a body.
    #[schemars(extend("minimum" = 0.1, "maximum" = 100))]
    pub ior: Located<Ior>,
}

/// A thickness that differs from place to place, as that of a soap bubble, which is thinner above, or of oil on water. Only `path` shows films.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-example" = "[material.soap.dielectric]\nior = 1\nfilm = { thickness = { from = 700, to = 150, by = { gradient = { axis = [0, 1, 0] } } }, ior = 1.33 }\n"))]
pub struct FilmThickness {
    /// Where the texture is black.
    #[schemars(range(min = 0, max = 100000), extend("x-unit" = "nanometres"))]
    pub from: f64,
    /// Where it is white.
    #[schemars(range(min = 0, max = 100000), extend("x-unit" = "nanometres"))]
    pub to: f64,
    /// The texture; of a colour counts the mean of its components.
    pub by: Box<Located<Paint>>,
}

/// A metal: what it is by exactly one of `of`, `index` and `color`.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(
    extend("oneOf" = [{"required": ["of"]}, {"required": ["index"]}, {"required": ["color"]}]),
    extend("x-example" = "[material.ring]\nmetal = { of = \"gold\", roughness = 0.2 }\n"),
)]
pub struct Metal {
    /// The name of a metal whose indices were measured, such as "gold", "silver", "copper" or "aluminium".
    pub of: Option<Located<String>>,
    /// The complex index of refraction, n and k, at all wavelengths.
    pub index: Option<Located<ComplexIndex>>,
    /// The colour of white light that falls on it straight.
    pub color: Option<Located<Color>>,
    /// How rough it is: 0 is a mirror, 1 as rough as can be.
    #[schemars(range(min = 0, max = 1))]
    pub roughness: f32,
    /// A thin film on it.
    pub film: Option<Film>,
}

/// n and k.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(transparent)]
#[schemars(inline, transparent)]
pub struct ComplexIndex(#[schemars(inner(range(min = 0, max = 100)))] pub [f64; 2]);

/// An index of refraction: a number, a name, or a formula.
pub type Ior = Either<f64, Either<String, IorFormula>>;

/// A dispersion formula: exactly one of these. λ is the wavelength in vacuum, in micrometres.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{"required": ["cauchy"]}, {"required": ["sellmeier"]}]))]
pub struct IorFormula {
    /// Cauchy's coefficients: n = c₀ + c₁ / λ² + c₂ / λ⁴ + …
    pub cauchy: Option<Cauchy>,
    /// Sellmeier's coefficients.
    pub sellmeier: Option<Sellmeier>,
}

/// The coefficients c₀, c₁, …
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(transparent)]
#[schemars(inline, transparent)]
pub struct Cauchy(#[schemars(length(min = 1, max = 8))] pub Vec<f64>);

/// Sellmeier's formula: n² = 1 + constant + Σ b λ² / (λ² − c).
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sellmeier {
    /// A further constant, most often 0.
    #[serde(default)]
    pub constant: f64,
    /// The numerators b.
    #[schemars(length(min = 1, max = 8))]
    pub b: Vec<f64>,
    /// The squares c of the resonant wavelengths, as many as there are b.
    #[schemars(length(min = 1, max = 8), extend("x-unit" = "µm²"))]
    pub c: Located<Vec<f64>>,
}

/// A word, or a colour after a distance.
pub type AbsorptionChoice = Either<AbsorptionWord, Absorption>;

/// Where absorption is known from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum AbsorptionWord {
    /// The glass's internal transmittance as it was measured: at each wavelength in `path`, its colour in `whitted`.
    Catalogue,
}

impl Forms for AbsorptionWord {
    const FORMS: &'static [Form] = &[Form::Text];
}

/// Absorption by distance (Beer and Lambert): white light has the colour `color` after `distance`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Absorption {
    /// The colour that white light has after that distance, above 0 and at most 1 in every component.
    pub color: Located<Color>,
    /// The distance.
    #[serde(default = "super::value::unit")]
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "world units"))]
    pub distance: f64,
}

/// Scattering inside a milky body.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("x-example" = "[material.milk]\ndielectric = { ior = 1.35, scattering = { distance = 0.1 } }\n"))]
pub struct Scattering {
    /// The mean distance that light goes between two scatterings.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "world units"))]
    pub distance: f64,
    /// How much of each component scatters: its scattering coefficient is this over the distance.
    #[schemars(extend("default" = 1))]
    pub color: Color,
    /// The mean cosine of the scattering angle: 0 scatters evenly, above 0 forward, below 0 backward.
    #[schemars(range(min = -0.99, max = 0.99))]
    pub anisotropy: f32,
}

impl Default for Scattering {
    fn default() -> Self {
        Self { distance: 1.0, color: Color::WHITE, anisotropy: 0.0 }
    }
}
