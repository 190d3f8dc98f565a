//! The box test in `f64`, for the entry of a ray into the whole tree and for rays and trees that `f32` has no room for.
//!
//! It never turns away a ray whose exact line meets the box within the exact bounds on t. Ize ("Robust BVH Ray Traversal",
//! JCGT 2(2), 2013) widens the interval of t for that; here every box is grown by a margin instead, 32 u (|origin| + extent)
//! with u = 2⁻⁵³ and the largest absolute coordinates meant. With lo ≤ hi the planes of a box on one axis and d the
//! direction, the computed entry ((lo − (o + margin)) · (1 / d)) carries five roundings, so it errs by less than
//! 5 u (|lo| + |o|) / |d|, while the margin moves it by 32 u (|lo| + |o|) / |d| at least: the same holds for the exit, and
//! for negative t, where a factor would be wrong. What is left, 27 u, serves the primitive's own test, whose rounding may
//! put a hit just outside its box; [`crate::shape::triangle_mesh`] is watertight by it.

use snell_math::Ray;

use super::Box32;

/// A ray, prepared for box tests in `f64`.
pub struct Slabs {
    /// 1 / direction.
    inverse: [f64; 3],
    /// The origin, moved so that the plane met first is met a margin earlier.
    near_origin: [f64; 3],
    /// The origin, moved so that the plane met last is met a margin later.
    far_origin: [f64; 3],
    /// Which corner of a box has the plane met first: 0 or 1, the smallest or the largest.
    near_corner: [usize; 3],
}

impl Slabs {
    #[inline]
    pub(super) fn new(ray: &Ray, extent: f64) -> Self {
        // 2⁻⁴⁸ is 32 u. The smallest number keeps the margin above zero, so that a coordinate at distance zero from the
        // plane of a box at the origin is not multiplied by an infinite inverse.
        let margin = 1.0 / (1_u64 << 48) as f64 * (ray.origin.max_abs() + extent) + f64::MIN_POSITIVE;
        let mut slabs = Self { inverse: [0.0; 3], near_origin: [0.0; 3], far_origin: [0.0; 3], near_corner: [0; 3] };
        for axis in 0..3 {
            let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
            // A zero, of either sign, has an infinite inverse: the planes are then infinitely far in front or behind,
            // which is right. The inverse of a subnormal number may overflow, which would be wrong: NaN makes the test
            // pass over this axis.
            slabs.inverse[axis] = if direction.is_subnormal() { f64::NAN } else { 1.0 / direction };
            let margin = margin.copysign(direction);
            slabs.near_origin[axis] = origin + margin;
            slabs.far_origin[axis] = origin - margin;
            slabs.near_corner[axis] = usize::from(direction.is_sign_negative());
        }
        slabs
    }

    /// Where the ray enters the box, not before `t_min`; `None` where it is not in the box between `t_min` and `t_max`.
    #[inline]
    pub(super) fn enter(&self, bounds: &Box32, t_min: f64, t_max: f64) -> Option<f64> {
        let (mut enter, mut leave) = (t_min, t_max);
        for axis in 0..3 {
            // Masked only to show that the index is in range.
            let corner = self.near_corner[axis] & 1;
            let near = (f64::from(bounds.corners[corner][axis]) - self.near_origin[axis]) * self.inverse[axis];
            let far = (f64::from(bounds.corners[corner ^ 1][axis]) - self.far_origin[axis]) * self.inverse[axis];
            // So written, a NaN (a parallel ray in the very plane of a side, or see `new`) changes nothing.
            enter = if near > enter { near } else { enter };
            leave = if far < leave { far } else { leave };
        }
        (enter <= leave).then_some(enter)
    }
}
