//! Air: its index, and wavelengths in it.
//!
//! Follows: Ciddor, "Refractive index of air: new equations for the visible and near infrared", Applied Optics 35(9), 1996, its
//! equation 1: dry air at 15 °C and 101 325 Pa with 450 ppm of carbon dioxide, from 230 to 1690 nm. Data sheets of glass
//! give wavelengths in air, and indices relative to it.

/// From where to where the formula was fitted, in nanometres.
const RANGE_NM: [f64; 2] = [230.0, 1690.0];

/// The index of refraction of standard air at a vacuum wavelength in nanometres, clamped to 230 to 1690.
///
/// ```
/// use snell_math::dispersion::air_index;
/// assert!((air_index(589.0) - 1.000_277).abs() < 1e-6);
/// ```
#[must_use]
pub fn air_index(vacuum_nm: f64) -> f64 {
    let micrometres = 1e-3 * vacuum_nm.clamp(RANGE_NM[0], RANGE_NM[1]);
    let squared = 1.0 / (micrometres * micrometres);
    1.0 + 0.057_921_05 / (238.0185 - squared) + 0.001_679_17 / (57.362 - squared)
}

/// The wavelength in air of light whose wavelength in vacuum is this; both in nanometres.
///
/// ```
/// use snell_math::dispersion::air_wavelength;
/// // The yellow line of helium.
/// assert!((air_wavelength(587.7249) - 587.5618).abs() < 1e-3);
/// ```
#[must_use]
pub fn air_wavelength(vacuum_nm: f64) -> f64 {
    vacuum_nm / air_index(vacuum_nm)
}

/// The wavelength in vacuum of light whose wavelength in air is this; both in nanometres.
///
/// ```
/// use snell_math::dispersion::{air_wavelength, vacuum_wavelength};
/// assert!((air_wavelength(vacuum_wavelength(546.074)) - 546.074).abs() < 1e-9);
/// ```
#[must_use]
pub fn vacuum_wavelength(air_nm: f64) -> f64 {
    // The index hardly depends on the wavelength: each step gains six digits.
    (0..3).fold(air_nm, |vacuum_nm, _| air_nm * air_index(vacuum_nm))
}
