//! Bounds on what rounding does to points and rays.
//!
//! Every error bound of this folder is counted in units of `gamma(n)`, the relative error that n roundings in a row can
//! make at most (Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., section 3.1; Pharr, Jakob, Humphreys,
//! Physically Based Rendering, 4th ed., section 6.8).
//!
//! The counts follow one pattern, here for a shape whose coordinates and sizes are at most `s` in absolute value:
//! - bringing the hit point back onto the surface and out of the shape's frame: at most `gamma(20) s`;
//! - rounding the origin of a ray spawned from there: `gamma(3) s`;
//! - what intersection then computes is exact for a ray moved by at most `gamma(30) s`: subtracting the centre (1), three
//!   dot products with axes that are themselves right to a few roundings (3 + 6 each), moving the origin along the ray
//!   (10), the coefficients and the discriminant (10).
//!
//! Together `gamma(53) s`, so `gamma(64) s` is what the round shapes report; the simpler ones count less. A ray that
//! starts outside a convex shape by this much above the tangent plane, and does not go below it, is therefore found to
//! miss the shape, whatever its direction.

/// Half the distance from 1 to the next number: the largest relative error of one rounding.
const UNIT_ROUNDOFF: f64 = 0.5 * f64::EPSILON;

/// The largest relative error of `n` roundings in a row.
pub(crate) const fn gamma(n: u32) -> f64 {
    let sum = n as f64 * UNIT_ROUNDOFF;
    sum / (1.0 - sum)
}
