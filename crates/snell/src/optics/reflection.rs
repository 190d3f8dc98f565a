//! The mirrored direction.
//!
//! Follows: CS5310, lecture 3, "Reflection"; Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6),
//! 1980.

use snell_math::lanes::{LaneVector, Lanes};
use snell_math::{Normal3, Vector3};

/// The direction in which a mirror sends the light that it sends towards `wo`, and the other way round:
/// R = 2 (V·N) N − V. Both leave the surface; unit vectors give a unit vector, made so again after rounding.
///
/// ```
/// use snell::optics::reflect;
/// use snell_math::{Normal3, Vector3};
/// assert_eq!(reflect(Vector3::new(0.6, 0.8, 0.0), Normal3::new(0.0, 1.0, 0.0)), Vector3::new(-0.6, 0.8, 0.0));
/// ```
#[inline]
#[must_use]
pub fn reflect(wo: Vector3, normal: Normal3) -> Vector3 {
    reflect_lanes::<f64>(wo.into(), normal.into()).into()
}

/// As [`reflect`], side by side.
#[inline(always)]
#[must_use]
pub fn reflect_lanes<L: Lanes>(wo: LaneVector<L>, normal: LaneVector<L>) -> LaneVector<L> {
    (normal * (L::splat(2.0) * normal.dot(wo)) - wo).normalize()
}
