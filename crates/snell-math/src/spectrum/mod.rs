//! Light as a function of wavelength, and the colour it has: from spectra to tristimulus values to scene-linear
//! [`Rgb`], and back to smooth spectra; the [`Bands`] into which a dispersive surface splits white light, and the
//! [`HeroWavelengths`] of a spectral path.
//!
//! Wavelengths are nanometres in vacuum. Tristimulus values (X, Y, Z) are those of the CIE 1931 standard observer,
//! scaled so that the equal-energy spectrum of radiance 1 has Y = 1.

mod bands;
mod daylight;
mod hero;
mod mix;
mod observer;
mod smooth;
mod solver;
mod spectra;

pub use bands::{Band, Bands};
pub use daylight::{Daylight, d65};
pub use hero::{HERO_WAVELENGTHS, HeroWavelengths};
pub use mix::{SmoothLattice, SmoothMixture};
pub use observer::{VISIBLE_NM, color_matching};
pub use smooth::{SmoothEmission, SmoothReflectance};
pub use spectra::{MeasuredSpectrum, MeasuredSpectrumError, Spectrum};

use crate::{Rgb, portable};

/// From tristimulus values to linear sRGB (IEC 61966-2-1:1999, equation 7), not clipped: a colour outside the gamut has
/// negative components.
#[inline]
#[must_use]
pub const fn xyz_to_linear_srgb([x, y, z]: [f64; 3]) -> [f64; 3] {
    [3.2406 * x - 1.5372 * y - 0.4986 * z, -0.9689 * x + 1.8758 * y + 0.0415 * z, 0.0557 * x - 0.2040 * y + 1.0570 * z]
}

/// [`xyz_to_linear_srgb`] as a colour.
#[inline]
#[must_use]
pub fn xyz_to_rgb(xyz: [f64; 3]) -> Rgb {
    Rgb::from(xyz_to_linear_srgb(xyz).map(|component| component as f32))
}

/// The tristimulus values of a spectrum, which is asked at every nanometre of the visible range.
#[must_use]
pub fn spectrum_to_xyz(mut radiance: impl FnMut(f64) -> f64) -> [f64; 3] {
    let (mut sum, mut luminous) = ([0.0; 3], 0.0);
    for nanometre in VISIBLE_NM[0] as u32..=VISIBLE_NM[1] as u32 {
        let wavelength_nm = f64::from(nanometre);
        let observer = color_matching(wavelength_nm);
        let value = radiance(wavelength_nm);
        for (total, response) in sum.iter_mut().zip(observer) {
            *total += response * value;
        }
        luminous += observer[1];
    }
    sum.map(|total| total / luminous)
}

/// The colour of a spectrum: [`spectrum_to_xyz`] in linear sRGB. The equal-energy spectrum is not white here (white is
/// daylight, D65) but a little reddish: (1.205, 0.948, 0.909).
///
/// ```
/// use snell_math::spectrum::{blackbody, spectrum_to_rgb};
/// let candle = spectrum_to_rgb(|nm| blackbody(1900.0, nm) / 1e12);
/// assert!(candle.r > candle.g && candle.g > candle.b);
/// ```
#[must_use]
pub fn spectrum_to_rgb(radiance: impl FnMut(f64) -> f64) -> Rgb {
    xyz_to_rgb(spectrum_to_xyz(radiance))
}

/// Planck's law: the spectral radiance of a black body, in watts per steradian, square metre and metre of wavelength; 0
/// where the temperature (kelvin) or the wavelength is not positive.
#[must_use]
pub fn blackbody(temperature_kelvin: f64, wavelength_nm: f64) -> f64 {
    // The constants of the SI of 2019, exact by definition.
    const PLANCK: f64 = 6.626_070_15e-34;
    const LIGHT: f64 = 299_792_458.0;
    const BOLTZMANN: f64 = 1.380_649e-23;
    if !(temperature_kelvin > 0.0 && wavelength_nm > 0.0) {
        return 0.0;
    }
    let metres = wavelength_nm * 1e-9;
    let squared = metres * metres;
    let exponent = PLANCK * LIGHT / (metres * BOLTZMANN * temperature_kelvin);
    let radiance = 2.0 * PLANCK * LIGHT * LIGHT / (squared * squared * metres) / (portable::exp(exponent) - 1.0);
    // Both ends of the spectrum fade to 0, but far out the quotient is 0 / 0 or ∞ / ∞.
    if radiance.is_nan() { 0.0 } else { radiance }
}

/// The colour of a black body, scaled to luminance Y = 1. Temperatures outside 500 to 10⁶ kelvin count as the nearer of
/// these.
#[must_use]
pub fn blackbody_rgb(temperature_kelvin: f64) -> Rgb {
    let temperature = if temperature_kelvin > 500.0 { temperature_kelvin.min(1e6) } else { 500.0 };
    let xyz = spectrum_to_xyz(|wavelength_nm| blackbody(temperature, wavelength_nm));
    xyz_to_rgb(xyz.map(|value| value / xyz[1]))
}

#[cfg(test)]
mod tests;
