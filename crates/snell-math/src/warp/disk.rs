//! Places of the unit disk.
//!
//! Follows: Shirley and Chiu, "A Low Distortion Map Between Disk and Square", Journal of Graphics Tools 2(3), 1997.

use std::f64::consts::{FRAC_1_PI, FRAC_PI_2, FRAC_PI_4};

use crate::portable;

/// The density of [`uniform_disk`], per unit of area: 1/π.
pub const UNIFORM_DISK_DENSITY: f64 = FRAC_1_PI;

/// A place (x, y) of the disk of radius 1 about the origin, each as likely as the others: squares about the centre of
/// the unit square become circles.
///
/// ```
/// use snell_math::warp::uniform_disk;
/// assert_eq!(uniform_disk([0.5, 0.5]), [0.0, 0.0]);
/// let [x, y] = uniform_disk([0.9, 0.3]);
/// assert!(x * x + y * y < 1.0);
/// ```
#[inline]
#[must_use]
pub fn uniform_disk(u: [f64; 2]) -> [f64; 2] {
    let [x, y] = u.map(|u| 2.0 * u - 1.0);
    let (radius, angle) = if x.abs() > y.abs() {
        (x, FRAC_PI_4 * (y / x))
    } else if y == 0.0 {
        (0.0, 0.0)
    } else {
        (y, FRAC_PI_2 - FRAC_PI_4 * (x / y))
    };
    [radius * portable::cos(angle), radius * portable::sin(angle)]
}
