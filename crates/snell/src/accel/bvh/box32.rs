//! Boxes as the hierarchy stores them: six `f32`, rounded outward, in the space of the primitives.

use snell_math::{Bounds3, Point3};

/// A box in single precision. `corners[0]` is the smallest corner, `corners[1]` the largest: an array, so that the plane
/// a ray meets first is chosen by an index.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub(in crate::accel) struct Box32 {
    pub(in crate::accel) corners: [[f32; 3]; 2],
}

impl Box32 {
    /// Holds nothing: the neutral element of the union.
    pub(in crate::accel) const EMPTY: Self = Self { corners: [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]] };

    /// The smallest box of `f32` around a box of `f64`. A corner beyond the range of `f32` becomes infinite. No corner
    /// is −0 (adding 0 sees to it), so that equal boxes have equal bits.
    pub(in crate::accel) fn enclosing(bounds: &Bounds3) -> Self {
        let low = bounds.min.to_array().map(|x| round_down(x) + 0.0);
        let high = bounds.max.to_array().map(|x| 0.0 - round_down(-x));
        Self { corners: [low, high] }
    }

    /// The box around the corners of a triangle.
    #[inline]
    pub(super) fn around([a, b, c]: &[[f32; 3]; 3]) -> Self {
        // As in `enclosing`, no corner of the box is −0.
        let low = [0, 1, 2].map(|axis| smaller(smaller(a[axis], b[axis]), c[axis]) + 0.0);
        let high = [0, 1, 2].map(|axis| larger(larger(a[axis], b[axis]), c[axis]) + 0.0);
        Self { corners: [low, high] }
    }

    #[inline]
    pub(super) fn is_finite(&self) -> bool {
        self.corners.iter().flatten().all(|x| x.is_finite())
    }

    pub(in crate::accel) fn to_bounds(self) -> Bounds3 {
        let [min, max] = self.corners.map(|corner| Point3::from(corner.map(f64::from)));
        Bounds3::new(min, max)
    }

    /// The smallest box around both.
    pub(super) fn union(&self, other: &Self) -> Self {
        let [[low, high], [other_low, other_high]] = [self.corners, other.corners];
        let corners = [
            [0, 1, 2].map(|axis| smaller(low[axis], other_low[axis])),
            [0, 1, 2].map(|axis| larger(high[axis], other_high[axis])),
        ];
        Self { corners }
    }

    /// What is in both boxes.
    pub(super) fn common(&self, other: &Self) -> Self {
        let [[low, high], [other_low, other_high]] = [self.corners, other.corners];
        let corners = [
            [0, 1, 2].map(|axis| larger(low[axis], other_low[axis])),
            [0, 1, 2].map(|axis| smaller(high[axis], other_high[axis])),
        ];
        Self { corners }
    }

    #[inline]
    pub(in crate::accel) fn grow(&mut self, other: &Self) {
        for axis in 0..3 {
            self.corners[0][axis] = smaller(self.corners[0][axis], other.corners[0][axis]);
            self.corners[1][axis] = larger(self.corners[1][axis], other.corners[1][axis]);
        }
    }

    /// Half the surface area, in `f64` so that it does not overflow; 0 where empty.
    #[inline]
    pub(in crate::accel) fn half_area(&self) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(self.corners[1][axis]) - f64::from(self.corners[0][axis]));
        if x >= 0.0 { x * y + y * z + z * x } else { 0.0 }
    }

    /// The largest absolute coordinate.
    pub(in crate::accel) fn max_abs(&self) -> f64 {
        self.corners.iter().flatten().fold(0.0, |largest: f64, x| largest.max(f64::from(x.abs())))
    }

    /// True where the point lies inside or on the border.
    #[inline]
    pub(in crate::accel) fn contains_point(&self, p: Point3) -> bool {
        let ([low, high], p) = (self.corners, p.to_array());
        // All comparisons, since one is made faster than it is skipped.
        let mut is_inside = true;
        for axis in 0..3 {
            is_inside &= f64::from(low[axis]) <= p[axis] && p[axis] <= f64::from(high[axis]);
        }
        is_inside
    }

    /// True where every point of `inner` lies inside or on the border.
    pub(in crate::accel) fn contains_box(&self, inner: &Self) -> bool {
        (0..3).all(|axis| {
            self.corners[0][axis] <= inner.corners[0][axis] && inner.corners[1][axis] <= self.corners[1][axis]
        })
    }
}

/// The largest `f32` that is not above `x`.
fn round_down(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) > x { nearest.next_down() } else { nearest }
}

// `f32::min` and `f32::max` take care of NaN, which there is none of here, at the price of four instructions for one.

#[inline]
pub(in crate::accel) fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline]
pub(in crate::accel) fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_outward_and_not_too_far() {
        for x in [0.0, -0.0, 0.1, -0.1, 1.0 + 1e-12, 1e-46, -1e-46, 1e30, 3.5e38, -3.5e38, 1e300, -1e300] {
            let p = Point3::new(x, x, x);
            let b = Box32::enclosing(&Bounds3::new(p, p));
            let [low, high] = b.corners.map(|corner| corner[0]);
            assert!(f64::from(low) <= x && x <= f64::from(high), "{x}: {low} {high}");
            assert!(low == high || low.next_up() == high, "{x}: {low} {high}");
            assert!(b.contains_point(p));
            assert!(!(low == 0.0 && low.is_sign_negative() || high == 0.0 && high.is_sign_negative()), "{x}: −0");
        }
    }
}
