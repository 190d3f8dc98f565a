//! Free paths in a medium: how far light goes until it meets something.
//!
//! Follows: the law of Beer and Lambert, by inversion of its distribution function 1 − exp(−coefficient · distance).
//! Coefficients are per unit of the length in which distances are measured.

use crate::portable;

/// −ln(1 − u) without the loss of small numbers: the distribution function of the unit exponential, inverted.
#[inline]
fn optical_depth(u: f64) -> f64 {
    -portable::ln(1.0 - u)
}

/// A distance by the density coefficient · exp(−coefficient · distance); infinite where the coefficient is 0 or less.
///
/// ```
/// use snell_math::warp::{exponential, exponential_density};
/// assert_eq!(exponential(0.0, 2.0), 0.0);
/// assert_eq!(exponential(0.5, 0.0), f64::INFINITY);
/// assert!((exponential_density(exponential(0.75, 2.0), 2.0) - 0.5).abs() < 1e-15);
/// ```
#[inline]
#[must_use]
pub fn exponential(u: f64, coefficient: f64) -> f64 {
    if coefficient > 0.0 { optical_depth(u) / coefficient } else { f64::INFINITY }
}

/// The density of [`exponential`] per unit of length; 0 for negative distances.
#[inline]
#[must_use]
pub fn exponential_density(distance: f64, coefficient: f64) -> f64 {
    if distance >= 0.0 && coefficient > 0.0 { coefficient * portable::exp(-coefficient * distance) } else { 0.0 }
}

/// A distance in [0, `end`] by the same density, cut off at `end` and scaled up: for a medium in which something must
/// happen. Uniform where the coefficient is 0.
///
/// ```
/// use snell_math::warp::truncated_exponential;
/// assert!(truncated_exponential(0.999, 0.1, 3.0) <= 3.0);
/// assert_eq!(truncated_exponential(0.5, 0.0, 3.0), 1.5);
/// ```
#[inline]
#[must_use]
pub fn truncated_exponential(u: f64, coefficient: f64, end: f64) -> f64 {
    let depth = coefficient * end;
    // Thin media are uniform to rounding; exp would have lost the difference.
    if depth < 1e-6 {
        return u * end;
    }
    (optical_depth(u * (1.0 - portable::exp(-depth))) / coefficient).min(end)
}

/// The density of [`truncated_exponential`] per unit of length; 0 outside [0, `end`].
#[inline]
#[must_use]
pub fn truncated_exponential_density(distance: f64, coefficient: f64, end: f64) -> f64 {
    if !(0.0..=end).contains(&distance) {
        return 0.0;
    }
    let depth = coefficient * end;
    if depth < 1e-6 { 1.0 / end } else { exponential_density(distance, coefficient) / (1.0 - portable::exp(-depth)) }
}
