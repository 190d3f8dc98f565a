//! Fresnel's equations for a boundary to a medium that absorbs: metals.
//!
//! Follows: Born and Wolf, "Principles of Optics", 7th edition, section 14.2: the equations for transparent media with a complex index.
//! s is the polarisation perpendicular to the plane of incidence, p the parallel one. Indices are those at one wavelength.

use super::complex::{Complex, ComplexIndex};

/// The cosine of the angle in a medium of index `index`, of light whose index times sine is `tangential` outside.
#[inline]
pub(super) fn cosine_within(tangential: f64, index: Complex) -> Complex {
    let sine = Complex::real(tangential) / index;
    (Complex::ONE - sine * sine).sqrt()
}

/// The amplitudes reflected at a boundary, perpendicular and parallel, and those transmitted. Indices and cosines on the
/// side of the light, then on the other.
#[inline]
pub(super) fn amplitudes(
    eta_i: Complex,
    cos_i: Complex,
    eta_t: Complex,
    cos_t: Complex,
) -> ([Complex; 2], [Complex; 2]) {
    let sums = [eta_i * cos_i + eta_t * cos_t, eta_t * cos_i + eta_i * cos_t];
    let reflected = [(eta_i * cos_i - eta_t * cos_t) / sums[0], (eta_t * cos_i - eta_i * cos_t) / sums[1]];
    let sent = eta_i * cos_i * 2.0;
    (reflected, [sent / sums[0], sent / sums[1]])
}

/// The shares of power that a boundary to a medium of complex index reflects, perpendicular (s) and parallel (p) to the plane of
/// incidence, each in [0, 1]. Arguments as in [`fresnel_conductor`].
#[inline]
#[must_use]
pub fn fresnel_conductor_polarized(cos_i: f64, eta_i: f64, index_t: ComplexIndex) -> [f64; 2] {
    let cos_i = cos_i.clamp(0.0, 1.0);
    if cos_i == 0.0 {
        return [1.0; 2];
    }
    let tangential = eta_i * ((1.0 - cos_i) * (1.0 + cos_i)).sqrt();
    let cos_t = cosine_within(tangential, index_t.complex());
    let (reflected, _) = amplitudes(Complex::real(eta_i), Complex::real(cos_i), index_t.complex(), cos_t);
    reflected.map(|amplitude| {
        let share = amplitude.norm_squared();
        if share < 1.0 { share } else { 1.0 }
    })
}

/// The share of unpolarised light that a boundary to a medium of complex index reflects, in [0, 1], at one wavelength. What is not
/// reflected is absorbed in the end.
///
/// The light arrives in a transparent medium of index `eta_i`; `cos_i` is the cosine of its angle with the normal, in [0, 1] (values
/// outside count as the nearer end).
///
/// ```
/// use snell::optics::{ComplexIndex, fresnel_conductor};
/// // Silver at 653 nm reflects nearly everything (Johnson and Christy 1972).
/// assert!(fresnel_conductor(1.0, 1.0, ComplexIndex::new(0.14, 4.15)) > 0.96);
/// assert!((fresnel_conductor(1.0, 1.0, ComplexIndex::from(1.5)) - 0.04).abs() < 1e-15);
/// ```
#[inline]
#[must_use]
pub fn fresnel_conductor(cos_i: f64, eta_i: f64, index_t: ComplexIndex) -> f64 {
    let [s, p] = fresnel_conductor_polarized(cos_i, eta_i, index_t);
    0.5 * (s + p)
}

/// The share of light from everywhere that is reflected, 2 ∫ F(c) c dc: what light keeps at each further bounce on a rough
/// metal. To about 10⁻⁵.
///
/// ```
/// use snell::optics::{ComplexIndex, fresnel_conductor_average};
/// assert!((fresnel_conductor_average(1.0, ComplexIndex::from(1.5)) - 0.0918).abs() < 1e-4);
/// ```
#[must_use]
pub fn fresnel_conductor_average(eta_i: f64, index_t: ComplexIndex) -> f64 {
    const STEPS: u32 = 128;
    let mut sum = 0.0;
    for step in 0..STEPS {
        // Even in the root of the cosine: grazing light is reflected most unevenly.
        let root = (f64::from(step) + 0.5) / f64::from(STEPS);
        let cos = root * root;
        sum += 4.0 * root * cos * fresnel_conductor(cos, eta_i, index_t) / f64::from(STEPS);
    }
    sum
}
