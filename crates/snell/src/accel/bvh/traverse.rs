//! Asking the hierarchy: rays, segments of rays and points.
//!
//! The box test is conservative: it never turns away a ray whose exact line meets the box within the exact bounds on t.
//! Ize ("Robust BVH Ray Traversal", JCGT 2(2), 2013) widens the interval of t for that; here every box is grown by a
//! margin instead, 32 u (|origin| + extent) with u = 2⁻⁵³ and the largest absolute coordinates meant. With lo ≤ hi the
//! planes of a box on one axis and d the direction, the computed entry ((lo − (o + margin)) · (1 / d)) carries five
//! roundings, so it errs by less than 5 u (|lo| + |o|) / |d|, while the margin moves it by 32 u (|lo| + |o|) / |d| at
//! least: the same holds for the exit, and for negative t, where a factor would be wrong. What is left, 27 u, serves
//! the primitive's own test, whose rounding may put a hit just outside its box; [`crate::shape::triangle_mesh`] is
//! watertight by it. The margin costs nothing per box, being part of the ray's origin.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use snell_math::{Point3, Ray};

use super::box32::Box32;
use super::{Bvh, MAX_DEPTH};

/// What a primitive's test finds: something with a ray parameter. `f64` is the ray parameter alone, `(f64, T)` has
/// anything the caller wants to keep of the closest hit with it.
pub trait Candidate {
    /// The ray parameter.
    fn t(&self) -> f64;
}

impl Candidate for f64 {
    #[inline]
    fn t(&self) -> f64 {
        *self
    }
}

impl<T> Candidate for (f64, T) {
    #[inline]
    fn t(&self) -> f64 {
        self.0
    }
}

/// A ray, prepared for box tests.
struct Slabs {
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
    fn new(ray: &Ray, extent: f64) -> Self {
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
    fn enter(&self, bounds: &Box32, t_min: f64, t_max: f64) -> Option<f64> {
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

impl Bvh {
    /// The closest primitive on a ray from its origin to `t_max`, both included, and what its test returned.
    ///
    /// `test` is given a primitive and the largest t that still matters, which falls as hits are found. It returns its
    /// hit of smallest t in [0, that t], or `None`; a hit beyond is taken for none. Of hits at the same t the one of
    /// the lowest primitive wins, whatever the order of the tests. A ray that is not finite meets nothing for certain.
    #[inline]
    pub fn closest<H: Candidate>(
        &self,
        ray: &Ray,
        t_max: f64,
        test: impl FnMut(u32, f64) -> Option<H>,
    ) -> Option<(u32, H)> {
        self.closest_between(ray, 0.0, t_max, test)
    }

    /// As [`Bvh::closest`], from `t_min`, which may be negative or −∞, to `t_max`; closest means of smallest t.
    #[inline]
    pub fn closest_between<H: Candidate>(
        &self,
        ray: &Ray,
        t_min: f64,
        mut t_max: f64,
        mut test: impl FnMut(u32, f64) -> Option<H>,
    ) -> Option<(u32, H)> {
        let slabs = Slabs::new(ray, self.extent);
        slabs.enter(&self.nodes.first()?.bounds, t_min, t_max)?;
        let mut best: Option<(u32, H)> = None;
        // Nodes to visit later, with the t of entry. A level of the tree adds one at most.
        let mut stack = [(0_u32, 0.0_f64); MAX_DEPTH];
        let mut height = 0;
        let mut index = 0_usize;
        loop {
            let node = &self.nodes[index];
            if node.is_leaf() {
                for &primitive in &self.primitives[node.range()] {
                    let Some(hit) = test(primitive, t_max) else { continue };
                    let t = hit.t();
                    let wins_tie = || t == t_max && best.as_ref().is_none_or(|(other, _)| primitive < *other);
                    if t < t_max || wins_tie() {
                        t_max = t;
                        best = Some((primitive, hit));
                    }
                }
            } else {
                let (first, second) = (index + 1, index + node.link as usize);
                let first_enter = slabs.enter(&self.nodes[first].bounds, t_min, t_max);
                let second_enter = slabs.enter(&self.nodes[second].bounds, t_min, t_max);
                match (first_enter, second_enter) {
                    (Some(a), Some(b)) => {
                        let (near, far, far_enter) = if a <= b { (first, second, b) } else { (second, first, a) };
                        stack[height] = (far as u32, far_enter);
                        height += 1;
                        index = near;
                        continue;
                    }
                    (Some(_), None) => {
                        index = first;
                        continue;
                    }
                    (None, Some(_)) => {
                        index = second;
                        continue;
                    }
                    (None, None) => {}
                }
            }
            // Take the next node that does not begin beyond what was found since. Not `<`: a tie is still to be seen.
            loop {
                if height == 0 {
                    return best;
                }
                height -= 1;
                let (next, enter) = stack[height];
                if enter <= t_max {
                    index = next as usize;
                    break;
                }
            }
        }
    }

    /// True where `test` holds for some primitive on the ray from its origin to `t_max`; stops at the first. Every
    /// primitive that is met there may be tested, in no particular order, and some that are not met.
    #[inline]
    pub fn any(&self, ray: &Ray, t_max: f64, mut test: impl FnMut(u32) -> bool) -> bool {
        let stop_if = |found| if found { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
        self.visit_between(ray, 0.0, t_max, |primitive| stop_if(test(primitive))).is_break()
    }

    /// Visits every primitive that the ray may meet from its origin to `t_max`, once, in no particular order.
    #[inline]
    pub fn all(&self, ray: &Ray, t_max: f64, mut visit: impl FnMut(u32)) {
        // It never breaks, so there is nothing to know from its end.
        let _ = self.visit_between(ray, 0.0, t_max, |primitive| {
            visit(primitive);
            ControlFlow::Continue(())
        });
    }

    /// Visits every primitive that the line of the ray may meet between `t_min`, which may be negative or −∞, and
    /// `t_max`, once, in no particular order, until `visit` breaks; returns whether it did.
    #[inline]
    pub fn visit_between(
        &self,
        ray: &Ray,
        t_min: f64,
        t_max: f64,
        visit: impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let slabs = Slabs::new(ray, self.extent);
        self.visit_where(|bounds| slabs.enter(bounds, t_min, t_max).is_some(), visit)
    }

    /// Visits every primitive whose box, rounded outward to `f32` and together with its neighbours in the tree, has the
    /// point inside or on its border: all whose exact box has it, and perhaps more.
    #[inline]
    pub fn point(&self, p: Point3, mut visit: impl FnMut(u32)) {
        // As in `all`.
        let _ = self.visit_where(
            |bounds| bounds.contains_point(p),
            |primitive| {
                visit(primitive);
                ControlFlow::Continue(())
            },
        );
    }

    /// Visits the primitives of all leaves whose box, and whose ancestors' boxes, `enters` accepts, each once.
    #[inline]
    fn visit_where(
        &self,
        enters: impl Fn(&Box32) -> bool,
        mut visit: impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if !self.nodes.first().is_some_and(|root| enters(&root.bounds)) {
            return ControlFlow::Continue(());
        }
        // Those in several leaves that were visited already.
        let mut visited = BTreeSet::new();
        let mut stack = [0_u32; MAX_DEPTH];
        let mut height = 0;
        let mut index = 0_usize;
        loop {
            let node = &self.nodes[index];
            if node.is_leaf() {
                for &primitive in &self.primitives[node.range()] {
                    if !self.repeated.contains(primitive) || visited.insert(primitive) {
                        visit(primitive)?;
                    }
                }
            } else {
                let (first, second) = (index + 1, index + node.link as usize);
                match (enters(&self.nodes[first].bounds), enters(&self.nodes[second].bounds)) {
                    (true, both) => {
                        if both {
                            stack[height] = second as u32;
                            height += 1;
                        }
                        index = first;
                        continue;
                    }
                    (false, true) => {
                        index = second;
                        continue;
                    }
                    (false, false) => {}
                }
            }
            if height == 0 {
                return ControlFlow::Continue(());
            }
            height -= 1;
            index = stack[height] as usize;
        }
    }
}
