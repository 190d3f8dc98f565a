//! Colours as smooth spectra: what a path does with a colour that a scene gives by red, green and blue.
//!
//! Follows: Jakob and Hanika, "A Low-Dimensional Function Space for Efficient Spectral Upsampling", Computer Graphics Forum 38(2)
//! (Eurographics), 2019: s(x) = ½ + x / (2 √(1 + x²)) of a polynomial of second degree in the wavelength, which is between 0 and
//! 1 everywhere. The coefficients are found for each colour by the code of [`solver`](super::solver), in 9 µs (measured over a
//! lattice of 4913), and not from a table: a colour comes back to 0.0003 in its linear components, and grey exactly. For the
//! many colours of textures there is [`SmoothLattice`](super::SmoothLattice). Light is a
//! reflectance times a scale times D65, so that the light of an RGB colour has that colour.
//!
//! Wavelengths are nanometres. Colours are linear sRGB with white D65.

use super::daylight::d65;
use super::solver::{coordinate, solve};
use crate::Rgb;

/// A reflectance or transmittance as a function of wavelength, in [0, 1], that has a given colour under D65.
///
/// ```
/// use snell_math::{Rgb, spectrum::{SmoothReflectance, d65, spectrum_to_rgb}};
/// let leaf = SmoothReflectance::new(Rgb::new(0.08, 0.25, 0.04));
/// let seen = spectrum_to_rgb(|nm| leaf.at(nm) * d65(nm));
/// assert!((seen.g - 0.25).abs() < 1e-3 && (seen.b - 0.04).abs() < 1e-3);
/// assert_eq!(SmoothReflectance::new(Rgb::WHITE).at(500.0), 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothReflectance {
    /// Of t⁰, t¹ and t², t = (λ − 595) / 235. In single precision: textures hold many.
    coefficients: [f32; 3],
}

impl SmoothReflectance {
    /// The smooth spectrum of a colour. Components below 0 or above 1 count as that, NaN as 0.
    #[must_use]
    pub fn new(color: Rgb) -> Self {
        let color = color.to_array().map(|c| if c > 0.0 { f64::from(c.min(1.0)) } else { 0.0 });
        Self { coefficients: solve(color).map(|c| c as f32) }
    }

    /// Its value at a wavelength.
    #[inline]
    #[must_use]
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        let [first, second, third] = self.coefficients.map(f64::from);
        let t = coordinate(wavelength_nm);
        let x = (third * t + second) * t + first;
        0.5 + 0.5 * (x / (1.0 + x * x).sqrt())
    }
}

/// Light that has a given colour: a scale, a reflectance, and D65.
///
/// ```
/// use snell_math::{Rgb, spectrum::{SmoothEmission, d65}};
/// assert_eq!(SmoothEmission::new(Rgb::gray(2.0)).at(550.0), 2.0 * d65(550.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothEmission {
    scale: f64,
    reflectance: SmoothReflectance,
}

impl SmoothEmission {
    /// The smooth spectrum of light of a colour, of any brightness. Negative components, and NaN, count as 0.
    #[must_use]
    pub fn new(color: Rgb) -> Self {
        let positive = color.map(|c| if c > 0.0 { c } else { 0.0 });
        // Grey light is D65 itself; other colours are taken half as bright as a reflectance can be, where spectra are smooth.
        let is_grey = positive.r == positive.g && positive.g == positive.b;
        let largest = f64::from(positive.max_abs());
        let scale = if is_grey { largest } else { 2.0 * largest };
        let relative = if largest > 0.0 && largest.is_finite() {
            positive.map(|c| (f64::from(c) / scale) as f32)
        } else {
            Rgb::WHITE
        };
        Self { scale, reflectance: SmoothReflectance::new(relative) }
    }

    /// Its radiance at a wavelength, in the units of the colour.
    #[inline]
    #[must_use]
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        self.scale * self.reflectance.at(wavelength_nm) * d65(wavelength_nm)
    }

    /// This light times a factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self { scale: self.scale * factor, ..self }
    }

    /// What the colour was divided by; the radiance is at most this times D65.
    #[inline]
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.scale
    }
}
