//! The axis-aligned box, called cuboid because `Box` is Rust's own word.
//!
//! The slab method: Kay and Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986; Williams et al., "An Efficient and Robust
//! Ray-Box Intersection Algorithm", JGT 10(1), 2005, for directions with zero components.

use snell_math::lanes::{LaneVector, Lanes};
use snell_math::{Bounds3, Point3, Ray, Transform, Vector3};

use super::rounding::gamma;
use super::span::{Passage, Span, ends};
use super::{Crossing, LaneRay, ShapeHit, SurfacePoint};

/// All points between two corners. Part `2 axis` is the face of smallest coordinate on that axis, `2 axis + 1` the
/// opposite one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    min: Point3,
    max: Point3,
}

impl Cuboid {
    /// From its corners of smallest and largest coordinates.
    pub const fn new(min: Point3, max: Point3) -> Self {
        Self { min, max }
    }

    /// The corners of smallest and of largest coordinates.
    pub(crate) fn corners(&self) -> (Point3, Point3) {
        (self.min, self.max)
    }

    /// Where lines enter and leave. A ray within a face is inside at the smaller coordinate and outside at the larger: of two boxes
    /// that share a face, exactly one has it.
    #[inline(always)]
    pub(super) fn ends<L: Lanes>(&self, ray: &LaneRay<L>) -> [Passage<L>; 2] {
        let (o, d) = (ray.origin, ray.direction);
        let (zero, infinity) = (L::splat(0.0), L::splat(f64::INFINITY));
        // A ray with NaN or without a direction compares false everywhere below, so it has to be stopped here.
        let mut met = d.length_squared().gt(zero) & (o * zero).sum().same(zero);
        let (mut enter, mut enter_part) = (-infinity, zero);
        let (mut leave, mut leave_part) = (infinity, zero);
        let axes = [(o.x, d.x), (o.y, d.y), (o.z, d.z)];
        for (axis, (o, d)) in axes.into_iter().enumerate() {
            let (min, max) = (L::splat(self.min[axis]), L::splat(self.max[axis]));
            let (low_part, high_part) = (L::splat(2.0 * axis as f64), L::splat(2.0 * axis as f64 + 1.0));
            let flat = d.same(zero);
            if flat.any() {
                met = met.without(flat.without(min.le(o) & o.lt(max)));
            }
            // Divided, not multiplied by a reciprocal that could be infinite: the quotient is never NaN but where `flat`.
            let (low, high) = ((min - o) / d, (max - o) / d);
            let up = d.gt(zero);
            let (near, far) = (low.or_where_not(up, high), high.or_where_not(up, low));
            let (near_part, far_part) = (low_part.or_where_not(up, high_part), high_part.or_where_not(up, low_part));
            let (later, sooner) = (near.gt(enter).without(flat), far.lt(leave).without(flat));
            (enter, enter_part) = (near.or_where_not(later, enter), near_part.or_where_not(later, enter_part));
            (leave, leave_part) = (far.or_where_not(sooner, leave), far_part.or_where_not(sooner, leave_part));
        }
        ends(met, (enter, enter_part), (leave, leave_part))
    }

    #[inline]
    fn span(&self, ray: &Ray) -> Option<Span> {
        Span::of_ends(self.ends::<f64>(&LaneRay::from(ray)))
    }

    /// See [`super::Shape::intersect`].
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        self.span(ray)?.first_between(t_min, t_max)
    }

    pub(super) fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        if let Some(span) = self.span(ray) {
            span.push_to(out);
        }
    }

    /// The points, the outward normals and the error of the points of hits at `t` with some parts.
    ///
    /// A point is put exactly onto its face. The error only has to be large enough that adding it changes the coordinate of the face;
    /// the difference to the face is then exact in sign.
    #[inline(always)]
    pub(super) fn surfaces<L: Lanes>(&self, ray: &LaneRay<L>, t: L, part: L) -> (LaneVector<L>, LaneVector<L>, L) {
        let raw = ray.origin + ray.direction * t;
        let (x, normal_x) = self.coordinate(0, raw.x, part);
        let (y, normal_y) = self.coordinate(1, raw.y, part);
        let (z, normal_z) = self.coordinate(2, raw.z, part);
        let error = L::splat(gamma(4) * (self.min.max_abs() + self.max.max_abs()));
        (LaneVector { x, y, z }, LaneVector { x: normal_x, y: normal_y, z: normal_z }, error)
    }

    /// One coordinate of points, and of the normals there.
    #[inline(always)]
    fn coordinate<L: Lanes>(&self, axis: usize, raw: L, part: L) -> (L, L) {
        let (min, max) = (L::splat(self.min[axis]), L::splat(self.max[axis]));
        let low = part.same(L::splat(2.0 * axis as f64));
        let high = part.same(L::splat(2.0 * axis as f64 + 1.0));
        let point = min.or_where_not(low, max.or_where_not(high, raw.larger(min).smaller(max)));
        (point, L::splat(-1.0).or_where_not(low, L::splat(1.0).or_where_not(high, L::splat(0.0))))
    }

    /// See [`Cuboid::surfaces`].
    #[inline]
    pub(super) fn surface_geometry(&self, ray: &Ray, hit: ShapeHit) -> SurfacePoint {
        let (point, normal, error) = self.surfaces::<f64>(&LaneRay::from(ray), hit.t, f64::from(hit.part));
        SurfacePoint::flat(point.into(), normal.into(), error)
    }

    /// From the corner at the lower left of the face, seen from outside with y up (top and bottom: seen with −z and +z
    /// up), so that v is up and u to the right.
    pub(super) fn uv(&self, p: Point3, part: u32) -> [f64; 2] {
        let (low, high) = (p - self.min, self.max - p);
        match part {
            0 => [low.z(), low.y()],
            1 => [high.z(), low.y()],
            2 => [low.x(), low.z()],
            3 => [low.x(), high.z()],
            4 => [high.x(), low.y()],
            _ => [low.x(), low.y()],
        }
    }

    pub(super) fn contains(&self, p: Point3) -> bool {
        self.min.0.cmplt(p.0).all() && p.0.cmplt(self.max.0).all()
    }

    pub(super) fn bounds(&self) -> Bounds3 {
        Bounds3::new(self.min, self.max)
    }

    /// Only under a map that moves and stretches along the axes: turned or mirrored, the faces would change their parts.
    pub(super) fn transformed(&self, map: &Transform) -> Option<Self> {
        let stretch = Vector3::new(map.vector(Vector3::X).x(), map.vector(Vector3::Y).y(), map.vector(Vector3::Z).z());
        let axes = [(Vector3::X, 0), (Vector3::Y, 1), (Vector3::Z, 2)];
        let along = axes.iter().all(|&(v, axis)| map.vector(v) == v * stretch[axis] && stretch[axis] > 0.0);
        along.then(|| Self { min: map.point(self.min), max: map.point(self.max) })
    }
}
