//! Light by its spectrum: of lights, and of materials that give off light.

use snell_math::Rgb;
use snell_math::spectrum::{Daylight, MeasuredSpectrum, MeasuredSpectrumError, Spectrum, VISIBLE_NM};

use super::Resolver;
use super::texture::placements;
use crate::diagnostic::Diagnostic;
use crate::document::model::{Either, Illuminant, LightColor, LightSpectrum, Located, MeasuredValues, Paint, Texture};
use crate::scene;
use crate::table::Id;

impl Resolver<'_> {
    /// The colour of a light, and its spectrum where it has one, both times its strength.
    pub(super) fn light_color(&mut self, color: &LightColor, intensity: f32) -> (Rgb, Option<Spectrum>) {
        match color {
            Either::A(color) => (color.0 * intensity, None),
            Either::B(given) => {
                let LightSpectrum { blackbody, illuminant, measured, luminance } = given;
                let spectrum =
                    self.spectrum(*blackbody, *illuminant, measured.as_ref(), luminance * f64::from(intensity));
                (spectrum.to_rgb(), Some(spectrum))
            }
        }
    }

    /// What a material gives off: a texture, and its spectrum where it has one.
    pub(super) fn emission(&mut self, paint: &Located<Paint>) -> (Id<scene::Texture>, Option<Spectrum>) {
        let given = match &paint.value {
            Either::B(texture) if is_light(texture) => texture,
            _ => return (self.term(paint), None),
        };
        for (key, span) in placements(given) {
            let message = format!("`{key}` has no effect on light that is the same everywhere");
            self.error(span, message, "not possible here");
        }
        let luminance = given.luminance.as_ref().map_or(1.0, |luminance| luminance.value);
        let blackbody = given.blackbody.as_ref().map(|blackbody| blackbody.value);
        let illuminant = given.illuminant.as_ref().map(|illuminant| illuminant.value);
        let spectrum = self.spectrum(blackbody, illuminant, given.measured.as_ref(), luminance);
        (self.constant(spectrum.to_rgb()), Some(spectrum))
    }

    /// Light is nothing that a surface could reflect.
    pub(super) fn refuse_light(&mut self, texture: &Texture) {
        let keys = [
            ("blackbody", texture.blackbody.as_ref().map(|blackbody| &blackbody.span)),
            ("illuminant", texture.illuminant.as_ref().map(|illuminant| &illuminant.span)),
            ("measured", texture.measured.as_ref().map(|measured| &measured.span)),
        ];
        let light = keys.into_iter().find_map(|(key, span)| Some((key, span?)));
        if let Some((key, span)) = light {
            let message =
                format!("`{key}` is light, which a material gives off, and no colour of a surface or pattern");
            let diagnostic = Diagnostic::error(message).at_optional(span.clone(), "only `emission` and lights take it");
            self.diagnostics.push(diagnostic.help("for example `emission = { blackbody = 2700, luminance = 4 }`"));
        } else if let Some(luminance) = &texture.luminance {
            let diagnostic = Diagnostic::error("`luminance` is for light of a spectrum")
                .at_optional(luminance.span.clone(), "has no effect on a pattern");
            self.diagnostics.push(diagnostic.help("make the colours of the pattern brighter"));
        }
    }

    fn spectrum(
        &mut self,
        blackbody: Option<f64>,
        illuminant: Option<Illuminant>,
        measured: Option<&Located<MeasuredValues>>,
        luminance: f64,
    ) -> Spectrum {
        let spectrum = match (blackbody, illuminant, measured) {
            (Some(kelvin), ..) => Spectrum::blackbody(kelvin),
            (None, Some(illuminant), _) => match illuminant {
                Illuminant::A => Spectrum::illuminant_a(),
                Illuminant::D50 => Spectrum::Daylight(Daylight::new(5003.0), 1.0),
                Illuminant::D55 => Spectrum::Daylight(Daylight::new(5503.0), 1.0),
                Illuminant::D65 => Spectrum::Daylight(Daylight::D65, 1.0),
                Illuminant::D75 => Spectrum::Daylight(Daylight::new(7504.0), 1.0),
                Illuminant::E => Spectrum::Constant(1.0),
            },
            (None, None, Some(measured)) => self.measured(measured),
            (None, None, None) => Spectrum::Constant(1.0),
        };
        spectrum.scaled(luminance)
    }

    fn measured(&mut self, measured: &Located<MeasuredValues>) -> Spectrum {
        let (pairs, measured_span) = (&measured.value.0, measured.span.clone());
        let (nm, values) = pairs.iter().map(|[nm, value]| (*nm, *value)).unzip();
        // It stays what it is beyond its ends; but one that is known nowhere in what eyes see is in other units.
        let is_seen = |measured: &MeasuredSpectrum| {
            let [low, high] = measured.range_nm();
            low < VISIBLE_NM[1] && high > VISIBLE_NM[0]
        };
        match MeasuredSpectrum::new(nm, values) {
            Ok(measured) if is_seen(&measured) => {
                if let Some(spectrum) = Spectrum::light(measured) {
                    return spectrum;
                }
                let message = "the measured spectrum has no light that eyes see";
                self.error(&measured_span, message, "all that is seen of it is dark");
            }
            Ok(_) => {
                let message = "the measured spectrum is known nowhere in the light that eyes see, from 360 to 830 nm";
                let diagnostic = Diagnostic::error(message).at_optional(measured_span, "is outside");
                self.diagnostics.push(diagnostic.help("wavelengths are in nanometres"));
            }
            Err(MeasuredSpectrumError::Order { index }) => {
                let message = format!(
                    "wavelengths of a spectrum must ascend: {} comes after {}",
                    pairs[index][0],
                    pairs[index - 1][0]
                );
                self.error(&measured.span, message, format!("pair {} is out of order", index + 1));
            }
            Err(error) => self.error(&measured.span, error.to_string(), "here"),
        }
        Spectrum::Constant(1.0)
    }
}

/// True where a table is light by its spectrum, and no pattern.
fn is_light(texture: &Texture) -> bool {
    texture.blackbody.is_some() || texture.illuminant.is_some() || texture.measured.is_some()
}
