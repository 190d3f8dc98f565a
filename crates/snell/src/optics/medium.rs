//! Light inside a body: what absorption leaves, and where scattering sends it.
//!
//! Follows: Beer and Lambert's law. Henyey and Greenstein's phase function is its own sampling density and stands beside the
//! routine that samples it, in `snell_math::warp`. Coefficients are per unit of length of the space in which distances are measured (world units).

pub use snell_math::warp::henyey_greenstein_density as henyey_greenstein;
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
