//! Directions of scattered light, by the phase function of Henyey and Greenstein.
//!
//! Follows: Henyey and Greenstein, "Diffuse radiation in the galaxy", Astrophysical Journal 93, 1941; inverted as in Witt,
//! "Multiple scattering in reflection nebulae", Astrophysical Journal Supplement 35, 1977.

use std::f64::consts::PI;

use crate::{Vector3, portable};

/// Anisotropies beyond this count as this.
const LIMIT: f64 = 0.999_999;

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
/// use snell_math::warp::henyey_greenstein_density;
/// assert!((henyey_greenstein_density(0.3, 0.0) * 4.0 * std::f64::consts::PI - 1.0).abs() < 1e-15);
/// assert!(henyey_greenstein_density(1.0, 0.5) > henyey_greenstein_density(-1.0, 0.5));
/// ```
#[inline]
#[must_use]
pub fn henyey_greenstein_density(cos_scatter: f64, anisotropy: f64) -> f64 {
    let g = anisotropy.clamp(-LIMIT, LIMIT);
    let cos = cos_scatter.clamp(-1.0, 1.0);
    // 1 + g² − 2 g cos, as a sum of numbers that are not negative.
    let magnitude = g.abs();
    let denominator = (1.0 - magnitude) * (1.0 - magnitude) + 2.0 * magnitude * (1.0 - g.signum() * cos);
    (1.0 - g) * (1.0 + g) / (4.0 * PI * denominator * denominator.sqrt())
}

/// A direction about +z, the direction in which the light was going, by [`henyey_greenstein_density`], which is its density per
/// steradian with `cos_scatter` = z.
///
/// ```
/// use snell_math::warp::henyey_greenstein;
/// // Strongly forward: nearly all go on nearly as before.
/// assert!(henyey_greenstein([0.5, 0.3], 0.99).z() > 0.99);
/// ```
#[inline]
#[must_use]
pub fn henyey_greenstein([u, v]: [f64; 2], anisotropy: f64) -> Vector3 {
    let g = anisotropy.clamp(-LIMIT, LIMIT);
    // How far the cosine is from 1, as a quotient in which nothing cancels: also right for g → 0, where it is 2 (1 − u), and
    // for |g| → 1, where it is tiny.
    let root = 1.0 + g * (2.0 * u - 1.0);
    let one_minus_cos = 2.0 * (1.0 - u) * (1.0 - g) * (1.0 - g) * (1.0 + g * u) / (root * root);
    let one_minus_cos = one_minus_cos.clamp(0.0, 2.0);
    let sin = (one_minus_cos * (2.0 - one_minus_cos)).sqrt();
    let angle = 2.0 * PI * v;
    Vector3::new(sin * portable::cos(angle), sin * portable::sin(angle), 1.0 - one_minus_cos)
}
