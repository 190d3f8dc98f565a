//! Places of a triangle.
//!
//! Follows: Heitz, "A Low-Distortion Map Between Triangle and Square", 2019 (hal-02073696): the half of the square above
//! its diagonal and the one below are each sheared into the triangle.

use crate::{Point3, Vector3};

/// Barycentric coordinates (of the first and the second vertex; the third has the rest) of a place of any triangle, each
/// as likely as the others. The density is [`triangle_density`].
///
/// ```
/// use snell_math::warp::triangle;
/// let [first, second] = triangle([0.7, 0.2]);
/// assert!(first >= 0.0 && second >= 0.0 && first + second <= 1.0);
/// ```
#[inline]
#[must_use]
pub fn triangle([u, v]: [f64; 2]) -> [f64; 2] {
    if v > u { [0.5 * u, v - 0.5 * u] } else { [u - 0.5 * v, 0.5 * v] }
}

/// The density of [`triangle`] over the triangle with these vertices, per unit of area: one over its area, infinite where
/// it has none.
///
/// ```
/// use snell_math::{Point3, warp::triangle_density};
/// let corners = [Point3::ORIGIN, Point3::new(2.0, 0.0, 0.0), Point3::new(0.0, 2.0, 0.0)];
/// assert_eq!(triangle_density(corners), 0.5);
/// ```
#[inline]
#[must_use]
pub fn triangle_density([a, b, c]: [Point3; 3]) -> f64 {
    let normal: Vector3 = (b - a).cross(c - a);
    2.0 / normal.length()
}
