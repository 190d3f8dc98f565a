//! Tone curves: from scene-linear light of any strength to display-linear light, to be clipped to [0, 1] and encoded.
//!
//! The sRGB encoding is not a tone curve; [`crate::DisplayImage::develop`] applies it after each of these, always.

use snell_math::{Rgb, portable};

/// How light brighter than the display can show is fitted into it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ToneCurve {
    /// The light as it is; brighter than one is clipped.
    #[default]
    None,
    /// Reinhard, Stark, Shirley and Ferwerda 2002, "Photographic Tone Reproduction for Digital Images", equation 4, on
    /// luminance with white at 4: `L (1 + L / 16) / (1 + L)`, hue and saturation kept.
    Reinhard,
    /// Narkowicz 2015, "ACES Filmic Tone Mapping Curve": `x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14)` per component.
    Filmic,
}

impl ToneCurve {
    /// The luminance that [`ToneCurve::Reinhard`] maps to one.
    pub const REINHARD_WHITE: f32 = 4.0;

    /// The light that the display shall give for one pixel's scene-linear light; may lie outside [0, 1].
    ///
    /// Infinite light stays bright; NaN stays NaN.
    ///
    /// ```
    /// use snell_image::ToneCurve;
    /// use snell_math::Rgb;
    /// assert_eq!(ToneCurve::Reinhard.apply(Rgb::gray(4.0)).g, 1.0);
    /// ```
    #[inline]
    #[must_use]
    pub fn apply(self, light: Rgb) -> Rgb {
        match self {
            Self::None => light,
            Self::Reinhard => {
                const WHITE_SQUARED: f32 = ToneCurve::REINHARD_WHITE * ToneCurve::REINHARD_WHITE;
                let luminance = light.luminance();
                // The limits of the scale: towards infinity, where the formula is ∞/∞; and at black, for sums below it.
                let scale = if luminance >= f32::MAX / 4.0 {
                    1.0 / WHITE_SQUARED
                } else if luminance <= 0.0 {
                    1.0
                } else {
                    (1.0 + luminance / WHITE_SQUARED) / (1.0 + luminance)
                };
                light * scale
            }
            Self::Filmic => light.map(|x| {
                // The fit passes one at 7.24 and has poles below zero; outside these bounds only clipping follows.
                let x = x.clamp(0.0, 16.0);
                x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)
            }),
        }
    }
}

/// The factor of an exposure in photographic stops: 2 to that power.
#[must_use]
pub fn exposure_scale(stops: f32) -> f32 {
    portable::pow(2.0, f64::from(stops)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    const CURVES: [ToneCurve; 3] = [ToneCurve::None, ToneCurve::Reinhard, ToneCurve::Filmic];

    #[test]
    fn black_stays_black_and_gray_stays_gray() {
        for curve in CURVES {
            assert_eq!(curve.apply(Rgb::BLACK), Rgb::BLACK, "{curve:?}");
            let gray = curve.apply(Rgb::gray(0.4));
            assert!((gray.r - gray.g).abs() < 1e-6 && (gray.g - gray.b).abs() < 1e-6, "{curve:?}: {gray:?}");
        }
    }

    #[test]
    fn more_light_never_looks_darker() {
        for curve in CURVES {
            let mut last = 0.0;
            for i in 0..4000 {
                let shown = curve.apply(Rgb::gray(i as f32 * 0.005)).g.min(1.0);
                assert!(shown >= last, "{curve:?} falls at {i}");
                last = shown;
            }
        }
    }

    #[test]
    fn the_curves_pass_through_their_published_points() {
        // Reinhard: L = 1 gives (1 + 1/16)/2; white gives one. Filmic: f(1) = 2.54/3.16.
        assert_eq!(ToneCurve::Reinhard.apply(Rgb::gray(1.0)).r, 0.53125);
        assert!((ToneCurve::Filmic.apply(Rgb::gray(1.0)).r - 2.54 / 3.16).abs() < 1e-6);
        let red = ToneCurve::Reinhard.apply(Rgb::new(1.0, 0.5, 0.0));
        assert_eq!(red.g / red.r, 0.5, "hue is kept");
    }

    #[test]
    fn light_without_end_is_bright_and_nan_is_not_hidden() {
        for curve in CURVES {
            for huge in [1e20, f32::MAX, f32::INFINITY] {
                assert!(curve.apply(Rgb::gray(huge)).r >= 1.0, "{curve:?} of {huge}");
            }
            assert!(curve.apply(Rgb::gray(f32::NAN)).r.is_nan(), "{curve:?}");
            for negative in [-0.5, -1.0, -2.0, f32::MIN, f32::NEG_INFINITY] {
                assert!(curve.apply(Rgb::gray(negative)).r <= 0.0, "{curve:?} of {negative}");
            }
        }
    }

    #[test]
    fn exposure_counts_in_stops() {
        assert_eq!(exposure_scale(0.0), 1.0);
        assert_eq!(exposure_scale(3.0), 8.0);
        assert_eq!(exposure_scale(-1.0), 0.5);
    }
}
