//! Daylight: the spectra of the CIE's D series, D65 first of all, which is white here.
//!
//! Follows: Judd, MacAdam and Wyszecki, "Spectral Distribution of Typical Daylight as a Function of Correlated Color
//! Temperature", JOSA 54(8), 1964, for the three components of daylight every 10 nm, between which it is linear; CIE 015:2018,
//! section 4.1.2, for their weights by temperature. D65 is its 6504 K with weights rounded to three decimals, −0.295 and
//! −0.689, which gives the CIE's table of D65 to its last printed digit.
//!
//! Spectra are scaled to Y = 1: relative to the equal-energy spectrum of radiance 1. Wavelengths are nanometres.

use super::observer::{VISIBLE_NM, color_matching};
use super::xyz_to_linear_srgb;

const STEP_NM: f64 = 10.0;

const D65: Daylight = Daylight::D65;

/// ∫ ȳ dλ in nanometres, of the functions as they are interpolated.
pub(super) const LUMINOUS_NM: f64 = integral(&Daylight { weights: [0.0; 3] })[3];

/// What makes the components of D65 in linear sRGB exactly 1: the published matrix gives 1.000006, 1.000075 and 0.999833.
pub(super) const SRGB_SCALE: [f64; 3] = {
    let [red, green, blue, _] = integral(&D65);
    [LUMINOUS_NM / red, LUMINOUS_NM / green, LUMINOUS_NM / blue]
};

/// The spectrum of daylight at one colour temperature.
///
/// ```
/// use snell_math::spectrum::{Daylight, spectrum_to_xyz};
/// let [x, y, z] = spectrum_to_xyz(|nm| Daylight::new(5003.0).radiance(nm));
/// assert!((y - 1.0).abs() < 1e-5, "it is scaled to Y = 1");
/// assert!((x / (x + y + z) - 0.3457).abs() < 1e-4, "D50");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Daylight {
    /// What the three components are multiplied by.
    weights: [f64; 3],
}

impl Daylight {
    /// The CIE's D65, which is white here.
    pub const D65: Self = Self::scaled(-0.295, -0.689);

    /// Daylight of a correlated colour temperature in kelvin, between 4000 and 25000; others count as the nearer end.
    #[must_use]
    pub fn new(temperature_kelvin: f64) -> Self {
        let temperature = if temperature_kelvin > 4000.0 { temperature_kelvin.min(25_000.0) } else { 4000.0 };
        // CIE 015:2018, equations 4.2 to 4.5: by the inverse temperature in units of 1/1000 K.
        let t = 1000.0 / temperature;
        let x = if temperature <= 7000.0 {
            ((-4.6070 * t + 2.9678) * t + 0.099_11) * t + 0.244_063
        } else {
            ((-2.0064 * t + 1.9018) * t + 0.247_48) * t + 0.237_040
        };
        let y = (-3.0 * x + 2.870) * x - 0.275;
        let m = 0.0241 + 0.2562 * x - 0.7341 * y;
        Self::scaled((-1.3515 - 1.7703 * x + 5.9114 * y) / m, (0.0300 - 31.4424 * x + 30.0717 * y) / m)
    }

    /// With Y = 1.
    const fn scaled(second: f64, third: f64) -> Self {
        let luminance = integral(&Self { weights: [1.0, second, third] })[3];
        let scale = LUMINOUS_NM / luminance;
        Self { weights: [scale, scale * second, scale * third] }
    }

    /// Its radiance at a wavelength, relative to the equal-energy spectrum of the same Y. Outside the visible range it is that of
    /// the nearer end.
    #[inline]
    #[must_use]
    pub const fn radiance(&self, wavelength_nm: f64) -> f64 {
        let position = (wavelength_nm - VISIBLE_NM[0]) / STEP_NM;
        // A NaN becomes 0.
        let position = if position > 0.0 { position } else { 0.0 };
        let (index, fraction) = if position < (COMPONENTS.len() - 1) as f64 {
            (position as usize, position - (position as usize) as f64)
        } else {
            (COMPONENTS.len() - 2, 1.0)
        };
        self.at(index) * (1.0 - fraction) + self.at(index + 1) * fraction
    }

    /// The radiance at a row of the table.
    const fn at(&self, row: usize) -> f64 {
        let [first, second, third] = COMPONENTS[row];
        self.weights[0] * first + self.weights[1] * second + self.weights[2] * third
    }
}

/// The radiance of D65 at a wavelength in nanometres, scaled to Y = 1: the light that is white, [`crate::Rgb::WHITE`].
///
/// ```
/// use snell_math::spectrum::{d65, spectrum_to_rgb};
/// let white = spectrum_to_rgb(d65);
/// assert!(white.to_array().iter().all(|c| (c - 1.0).abs() < 2e-4));
/// ```
#[inline]
#[must_use]
pub const fn d65(wavelength_nm: f64) -> f64 {
    D65.radiance(wavelength_nm)
}

/// The integrals of a spectrum against the observer, as linear sRGB and Y, times nanometres; without any weight, of the
/// equal-energy spectrum of radiance 1.
const fn integral(light: &Daylight) -> [f64; 4] {
    // The functions are of third degree between the observer's rows, the spectrum of first: Gauss and Legendre's three points
    // are exact.
    const NODES: [(f64, f64); 3] =
        [(-0.774_596_669_241_483_4, 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.774_596_669_241_483_4, 5.0 / 18.0)];
    const PIECE_NM: f64 = 5.0;
    let is_equal_energy = light.weights[0] == 0.0;
    let pieces = ((VISIBLE_NM[1] - VISIBLE_NM[0]) / PIECE_NM) as usize;
    let mut sum = [0.0; 4];
    let mut piece = 0;
    while piece < pieces {
        let mut node = 0;
        while node < NODES.len() {
            let (place, weight) = NODES[node];
            let wavelength_nm = VISIBLE_NM[0] + PIECE_NM * (piece as f64 + 0.5 + 0.5 * place);
            let radiance = if is_equal_energy { 1.0 } else { light.radiance(wavelength_nm) };
            let xyz = color_matching(wavelength_nm);
            let [red, green, blue] = xyz_to_linear_srgb(xyz);
            let values = [red, green, blue, xyz[1]];
            let mut i = 0;
            while i < 4 {
                sum[i] += values[i] * radiance * weight * PIECE_NM;
                i += 1;
            }
            node += 1;
        }
        piece += 1;
    }
    sum
}

/// The mean of daylight and its first two characteristic vectors, from 360 to 830 nm.
#[rustfmt::skip]
const COMPONENTS: [[f64; 3]; 48] = [
    [61.5, 38.0, 5.3], [68.8, 42.4, 6.1], [63.4, 38.5, 3.0], [65.8, 35.0, 1.2], [94.8, 43.4, -1.1],
    [104.8, 46.3, -0.5], [105.9, 43.9, -0.7], [96.8, 37.1, -1.2], [113.9, 36.7, -2.6], [125.6, 35.9, -2.9],
    [125.5, 32.6, -2.8], [121.3, 27.9, -2.6], [121.3, 24.3, -2.6], [113.5, 20.1, -1.8], [113.1, 16.2, -1.5],
    [110.8, 13.2, -1.3], [106.5, 8.6, -1.2], [108.8, 6.1, -1.0], [105.3, 4.2, -0.5], [104.4, 1.9, -0.3],
    [100.0, 0.0, 0.0], [96.0, -1.6, 0.2], [95.1, -3.5, 0.5], [89.1, -3.5, 2.1], [90.5, -5.8, 3.2],
    [90.3, -7.2, 4.1], [88.4, -8.6, 4.7], [84.0, -9.5, 5.1], [85.1, -10.9, 6.7], [81.9, -10.7, 7.3],
    [82.6, -12.0, 8.6], [84.9, -14.0, 9.8], [81.3, -13.6, 10.2], [71.9, -12.0, 8.3], [74.3, -13.3, 9.6],
    [76.4, -12.9, 8.5], [63.3, -10.6, 7.0], [71.7, -11.6, 7.6], [77.0, -12.2, 8.0], [65.2, -10.2, 6.7],
    [47.7, -7.8, 5.2], [68.6, -11.2, 7.4], [65.0, -10.4, 6.8], [66.0, -10.6, 7.0], [61.0, -9.7, 6.4],
    [53.3, -8.3, 5.5], [58.9, -9.3, 6.1], [61.9, -9.8, 6.5],
];
