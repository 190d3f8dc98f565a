//! Light inside a body: what absorption leaves, and where scattering sends it.
//!
//! Follows: Beer and Lambert's law; Henyey and Greenstein, "Diffuse radiation in the galaxy", Astrophysical Journal 93,
//! 1941. Coefficients are per unit of length of the space in which distances are measured (world units).

use std::f64::consts::PI;

use snell_math::{Rgb, portable};

/// The share of light that is left after `distance` in a medium of this coefficient (absorption, or absorption plus
/// scattering): exp(−coefficient · distance), per channel.
///
/// Exactly 1 in a channel whose coefficient is 0, over any distance, and at no cost. Negative products count as 0.
///
/// ```
/// use snell::optics::beer_lambert;
/// use snell_math::Rgb;
/// let left = beer_lambert(Rgb::new(0.0, 1.0, 2.0), 0.5);
/// assert_eq!(left.r, 1.0);
/// assert!((left.g * left.g - left.b).abs() < 1e-7);
/// ```
#[inline]
#[must_use]
pub fn beer_lambert(coefficient: Rgb, distance: f64) -> Rgb {
    coefficient.map(|per_length| {
        let depth = f64::from(per_length) * distance;
        // False for NaN too: 0 · ∞ is no absorption.
        if depth > 0.0 { portable::exp(-depth) as f32 } else { 1.0 }
    })
}

/// Henyey and Greenstein's phase function: the density per steradian, over directions, of light scattered by an angle
/// whose cosine is `cos_scatter`, 1 straight on and −1 straight back.
///
/// With both directions leaving the point, `wo` against the arriving ray, `cos_scatter` is −(wo · wi). `anisotropy` is
/// g, the mean of that cosine, in (−1, 1); values beyond ±0.999999 count as that.
///
/// Normalisation: the function integrates to 1 over the sphere (books after Chandrasekhar have 4π or the albedo there),
/// so it is its own sampling density, and the radiance scattered along a stretch of unit length is the scattering
/// coefficient times the integral of this times the arriving radiance.
///
/// ```
/// use snell::optics::henyey_greenstein;
/// assert!((henyey_greenstein(0.3, 0.0) * 4.0 * std::f64::consts::PI - 1.0).abs() < 1e-15);
/// assert!(henyey_greenstein(1.0, 0.5) > henyey_greenstein(-1.0, 0.5));
/// ```
#[inline]
#[must_use]
pub fn henyey_greenstein(cos_scatter: f64, anisotropy: f64) -> f64 {
    const LIMIT: f64 = 0.999_999;
    let g = anisotropy.clamp(-LIMIT, LIMIT);
    let cos = cos_scatter.clamp(-1.0, 1.0);
    // 1 + g² − 2 g cos, as a sum of numbers that are not negative.
    let magnitude = g.abs();
    let denominator = (1.0 - magnitude) * (1.0 - magnitude) + 2.0 * magnitude * (1.0 - g.signum() * cos);
    (1.0 - g) * (1.0 + g) / (4.0 * PI * denominator * denominator.sqrt())
}
