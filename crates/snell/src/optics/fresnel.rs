//! Fresnel's equations: how much light a smooth boundary between two transparent media reflects.
//!
//! Follows: Born and Wolf, "Principles of Optics", 7th edition, section 1.5.2. s is the polarisation perpendicular to
//! the plane of incidence, p the parallel one; r_p is positive at normal incidence into the denser medium, r_s
//! negative.
//!
//! The numerators of the textbook's r_s = (η_i c_i − η_t c_t) / (η_i c_i + η_t c_t) and r_p = (η_t c_i − η_i c_t) /
//! (η_t c_i + η_i c_t) cancel where the indices are nearly equal (air: 1.0002926). Multiplied by their sums and with
//! Snell's law put in, both become η_i² − η_t² times something harmless, which keeps all digits.

use snell_math::lanes::{Bits, Lanes};
use snell_math::portable;

use super::refraction::cos_transmitted_squared;

/// Amplitudes of the electric field over that of the incident wave, for either polarisation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FresnelAmplitudes {
    /// The cosine of the transmitted ray with the normal.
    pub cos_t: f64,
    /// Reflected, perpendicular to the plane of incidence.
    pub r_s: f64,
    /// Reflected, parallel to the plane of incidence.
    pub r_p: f64,
    /// Transmitted, perpendicular to the plane of incidence.
    pub t_s: f64,
    /// Transmitted, parallel to the plane of incidence.
    pub t_p: f64,
}

/// Fresnel's amplitudes for light that arrives from the side of index `eta_i` with `cos_i` in [0, 1] (values outside
/// count as the nearer end); `None` under total internal reflection and at the critical angle itself.
///
/// Power follows from them: r² is reflected and t² · η_t cos θ_t / (η_i cos θ_i) is transmitted.
#[inline]
#[must_use]
pub fn fresnel_amplitudes(cos_i: f64, eta_i: f64, eta_t: f64) -> Option<FresnelAmplitudes> {
    let (exist, Amplitudes { cos_i, cos_t, r_s, r_p, sum_s, sum_p }) = amplitudes(cos_i, eta_i, eta_t);
    if eta_i == eta_t {
        // No boundary, even at grazing incidence, where the quotients are 0 / 0.
        return Some(FresnelAmplitudes { cos_t: cos_i, r_s, r_p, t_s: 1.0, t_p: 1.0 });
    }
    let [t_s, t_p] = [sum_s, sum_p].map(|sum| 2.0 * eta_i * cos_i / sum);
    exist.any().then_some(FresnelAmplitudes { cos_t, r_s, r_p, t_s, t_p })
}

/// What all of Fresnel's quantities are made from, side by side.
struct Amplitudes<L> {
    /// In [0, 1].
    cos_i: L,
    cos_t: L,
    r_s: L,
    r_p: L,
    /// The denominators of the perpendicular and the parallel amplitudes.
    sum_s: L,
    sum_p: L,
}

/// See [`fresnel_amplitudes`]; the lanes that have them.
#[inline(always)]
fn amplitudes<L: Lanes>(cos_i: L, eta_i: L, eta_t: L) -> (Bits, Amplitudes<L>) {
    let (zero, one) = (L::splat(0.0), L::splat(1.0));
    let cos_i = cos_i.larger(zero).smaller(one);
    let eta = eta_i / eta_t;
    let cos_t_squared = cos_transmitted_squared(cos_i, eta);
    let total = cos_t_squared.le(zero);
    let cos_t = cos_t_squared.sqrt();
    let sum_s = eta_i * cos_i + eta_t * cos_t;
    let sum_p = eta_t * cos_i + eta_i * cos_t;
    let contrast = (eta_i - eta_t) * (eta_i + eta_t);
    let sin_i_squared = (one - cos_i) * (one + cos_i);
    // Zero at Brewster's angle, where tan θ_i = η_t / η_i.
    let brewster = cos_i * cos_i - eta * eta * sin_i_squared;
    let none = eta_i.same(eta_t);
    let r_s = zero.or_where_not(none, contrast / (sum_s * sum_s));
    let r_p = zero.or_where_not(none, -contrast * brewster / (sum_p * sum_p));
    (L::all().without(total) | none, Amplitudes { cos_i, cos_t, r_s, r_p, sum_s, sum_p })
}

/// The shares of power that a smooth boundary reflects, perpendicular (s) and parallel (p) to the plane of incidence,
/// each in [0, 1]. Arguments as in [`fresnel_dielectric`].
#[inline]
#[must_use]
pub fn fresnel_dielectric_polarized(cos_i: f64, eta_i: f64, eta_t: f64) -> [f64; 2] {
    polarized(cos_i, eta_i, eta_t)
}

#[inline(always)]
fn polarized<L: Lanes>(cos_i: L, eta_i: L, eta_t: L) -> [L; 2] {
    let (exist, Amplitudes { r_s, r_p, .. }) = amplitudes(cos_i, eta_i, eta_t);
    // Grazing light is all reflected, which rounding must not spoil.
    let partly = exist.without(cos_i.le(L::splat(0.0)).without(eta_i.same(eta_t)));
    let one = L::splat(1.0);
    let (s, p) = (r_s * r_s, r_p * r_p);
    [s.or_where_not(partly & s.lt(one), one), p.or_where_not(partly & p.lt(one), one)]
}

/// The share of unpolarised light that a smooth boundary reflects, in [0, 1]: exactly 1 under total internal reflection
/// and at grazing incidence, exactly 0 where the indices are equal. What is not reflected is transmitted.
///
/// The light arrives from the side of index `eta_i`; `cos_i` is the cosine of its angle with the normal, in [0, 1]
/// (values outside count as the nearer end).
///
/// ```
/// use snell::optics::fresnel_dielectric;
/// assert!((fresnel_dielectric(1.0, 1.0, 1.5) - 0.04).abs() < 1e-15);
/// assert_eq!(fresnel_dielectric(0.5, 1.5, 1.0), 1.0);
/// ```
#[inline]
#[must_use]
pub fn fresnel_dielectric(cos_i: f64, eta_i: f64, eta_t: f64) -> f64 {
    fresnel_dielectric_lanes(cos_i, eta_i, eta_t)
}

/// As [`fresnel_dielectric`], side by side.
#[inline(always)]
#[must_use]
pub fn fresnel_dielectric_lanes<L: Lanes>(cos_i: L, eta_i: L, eta_t: L) -> L {
    let [s, p] = polarized(cos_i, eta_i, eta_t);
    L::splat(0.5) * (s + p)
}

/// Brewster's angle in radians: light that arrives under it from `eta_i` towards `eta_t` is reflected without any
/// parallel polarisation.
#[inline]
#[must_use]
pub fn brewster_angle(eta_i: f64, eta_t: f64) -> f64 {
    portable::atan2(eta_t, eta_i)
}
