//! Spectra of light as the author writes them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::value::{Color, Either, Form, Forms, Located};

/// The colour of a light: a colour, or a spectrum.
pub type LightColor = Either<Color, LightSpectrum>;

/// Light by its spectrum: exactly one of `blackbody`, `illuminant` and `measured`. It is as bright as white of the value `luminance`,
/// whatever its colour. `path` has it at each wavelength, `whitted` its colour in red, green and blue.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(
    extend("oneOf" = [{"required": ["blackbody"]}, {"required": ["illuminant"]}, {"required": ["measured"]}]),
    extend("x-example" = "[[light]]\nname = \"candle\"\npoint = { position = [0, 3, 1], color = { blackbody = 1900 }, intensity = 0.8 }\n\n[material.sodium]\nemission = { measured = [[588, 0], [589.3, 1], [590.6, 0]], luminance = 6 }\n"),
)]
pub struct LightSpectrum {
    /// The temperature of a black body, by Planck's law: 1900 a candle, 2700 a warm lamp, 5800 the sun.
    #[schemars(range(min = 500, max = 1000000), extend("x-unit" = "kelvin"))]
    pub blackbody: Option<f64>,
    /// An illuminant of the CIE.
    pub illuminant: Option<Illuminant>,
    /// Pairs of a wavelength in nanometres and a value, by ascending wavelength, joined by straight lines. Beyond the first and the last it stays
    /// what it is there. Values are relative: `luminance` says how bright it is.
    pub measured: Option<Located<MeasuredValues>>,
    /// How bright it is: as white light of this value.
    #[serde(default = "super::value::unit")]
    #[schemars(range(min = 0))]
    pub luminance: f64,
}

/// Pairs of a wavelength in nanometres and a value.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(transparent)]
#[schemars(inline, transparent)]
pub struct MeasuredValues(#[schemars(length(min = 2, max = 10000), inner(inner(range(min = 0))))] pub Vec<[f64; 2]>);

/// An illuminant of the CIE.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Illuminant {
    /// A filament lamp.
    A,
    /// Daylight of 5003 K, at the horizon; white for print.
    D50,
    /// Daylight of 5503 K.
    D55,
    /// Daylight of 6504 K, which is white here.
    D65,
    /// Daylight of 7504 K, of the northern sky.
    D75,
    /// Equal energy at all wavelengths.
    E,
}

impl Forms for LightSpectrum {
    const FORMS: &'static [Form] = &[Form::Table];
}
