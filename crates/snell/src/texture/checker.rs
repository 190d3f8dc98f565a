//! The checker: unit cubes, or unit squares, of two kinds in turn. Coordinates in texture space, one cell a unit.

use snell_math::Point3;

/// Which of the two kinds the cell of a point is: the sum of the coordinates' floors modulo 2. A flat checker has no z.
///
/// The sum itself would lose its last bit far from the origin, so the coordinates' parities are added instead. Beyond 2⁵³
/// every coordinate is even: there is no finer `f64`.
#[inline]
pub(super) fn parity(point: Point3, is_flat: bool) -> usize {
    let flat = is_odd(point.x()) ^ is_odd(point.y());
    usize::from(if is_flat { flat } else { flat ^ is_odd(point.z()) })
}

/// By way of whole numbers: rounding down has no instruction of its own on every machine, cutting off has.
#[inline]
fn is_odd(coordinate: f64) -> bool {
    const FIRST_ALL_EVEN: f64 = (1_u64 << f64::MANTISSA_DIGITS) as f64;
    if coordinate.abs() < FIRST_ALL_EVEN {
        let towards_zero = coordinate as i64;
        let floor = towards_zero - i64::from(towards_zero as f64 > coordinate);
        floor & 1 == 1
    } else {
        false
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// Against the definition in integers, and one step along any axis changes the kind.
        #[test]
        fn kinds_alternate(x in -1e6..1e6f64, y in -1e6..1e6f64, z in -1e6..1e6f64) {
            let sum = x.floor() as i64 + y.floor() as i64 + z.floor() as i64;
            let kind = parity(Point3::new(x, y, z), false);
            prop_assert_eq!(kind as i64, sum.rem_euclid(2));
            // 1 is added exactly at this magnitude but for a rounding that could cross a border: test at cell middles.
            let [x, y, z] = [x, y, z].map(|c| c.floor() + 0.5);
            let kind = parity(Point3::new(x, y, z), false);
            for neighbour in [Point3::new(x + 1.0, y, z), Point3::new(x, y - 1.0, z), Point3::new(x, y, z + 1.0)] {
                prop_assert_ne!(parity(neighbour, false), kind);
            }
            prop_assert_eq!(parity(Point3::new(x + 1.0, y, z - 1.0), false), kind);
            prop_assert_eq!(parity(Point3::new(x, y, z), true), parity(Point3::new(x, y, z + 1.0), true));
        }
    }

    #[test]
    fn cells_are_half_open_and_huge_numbers_are_even() {
        assert_eq!(parity(Point3::new(0.0, 0.0, 0.0), false), 0);
        assert_eq!(parity(Point3::new(-0.0, 0.0, 0.0), false), 0);
        assert_eq!(parity(Point3::new(-5e-324, 0.0, 0.0), false), 1);
        assert_eq!(parity(Point3::new(1.0, 0.0, 0.0), false), 1);
        let huge = 9_007_199_254_740_991.0; // 2^53 - 1, the last odd number
        assert_eq!(parity(Point3::new(huge, 0.0, 0.0), false), 1);
        for even in [huge + 1.0, 1e300, -1e300, f64::INFINITY, f64::NAN] {
            assert_eq!(parity(Point3::new(even, 0.0, 0.0), false), 0, "{even}");
        }
    }
}
