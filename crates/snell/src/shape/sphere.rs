//! The sphere. Units and space of its ray, as all shapes.
//!
//! Intersection follows Haines, Günther, Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection", Ray
//! Tracing Gems (2019), chapter 7: the discriminant from the line's perpendicular distance to the centre, so that far
//! and small spheres keep their shape, and the root that would cancel from the product of both, so that rays starting
//! near huge ones do. The original form: Glassner (ed.), An Introduction to Ray Tracing (1989), section 2.2.

use snell_math::lanes::{Bits, LaneVector, Lanes};
use snell_math::{Bounds3, Point3, Ray, Transform, portable};

use super::frame::turn;
use super::rounding::gamma;
use super::span::{Passage, Span};
use super::{Crossing, LaneRay, ShapeHit, SurfacePoint};

/// How much further than its radius a line must be from a sphere's centre to miss it for sure, in squares and relative to the
/// distance of the origin: 512 u, while the rounding errors of that test and of [`LaneSpheres::span`] are less than 100 u.
pub(super) const MISS_MARGIN: f64 = 1.0 / (1_u64 << 44) as f64;
/// Smaller numbers than this may lose digits, and the test says nothing.
pub(super) const MISS_REACH: f64 = 1e-280;

/// All points at a distance from a centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// The centre.
    pub center: Point3,
    /// The radius, positive.
    pub radius: f64,
}

impl Sphere {
    /// From its centre and radius.
    pub const fn new(center: Point3, radius: f64) -> Self {
        Self { center, radius }
    }

    #[inline]
    fn span(&self, ray: &Ray) -> Option<Span> {
        let (met, [enter, leave]) = LaneSpheres::<f64>::from(self).span(&LaneRay::from(ray));
        met.any().then_some(Span { enter: ShapeHit { t: enter, part: 0 }, leave: ShapeHit { t: leave, part: 0 } })
    }

    /// See [`super::Shape::intersect`].
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        if t_min >= 0.0 && self.is_surely_missed(ray) { None } else { self.intersect_likely(ray, t_min, t_max) }
    }

    /// As [`Sphere::intersect`], for a sphere that is not one of the many that are surely missed.
    #[inline]
    pub(crate) fn intersect_likely(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        self.span(ray)?.first_between(t_min, t_max)
    }

    /// Both places where a ray passes through the surface with 0 < t < `t_max`, the nearer one first.
    #[inline]
    pub(crate) fn hits_before(&self, ray: &Ray, t_max: f64) -> [Option<ShapeHit>; 2] {
        if self.is_surely_missed(ray) {
            return [None; 2];
        }
        let Some(Span { enter, leave }) = self.span(ray) else { return [None; 2] };
        [enter, leave].map(|hit| (hit.t > 0.0 && hit.t < t_max).then_some(hit))
    }

    #[inline]
    fn is_surely_missed(&self, ray: &Ray) -> bool {
        LaneSpheres::<f64>::from(self).surely_missed(&LaneRay::from(ray)).any()
    }

    pub(super) fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        if let Some(span) = self.span(ray) {
            span.push_to(out);
        }
    }

    /// See [`LaneSpheres::surface`].
    #[inline]
    pub(crate) fn surface_geometry(&self, ray: &Ray, hit: ShapeHit) -> SurfacePoint {
        let (point, normal, error) = LaneSpheres::<f64>::from(self).surface(&LaneRay::from(ray), hit.t);
        SurfacePoint::flat(point.into(), normal.into(), error)
    }

    pub(super) fn uv(&self, p: Point3) -> [f64; 2] {
        let v = p - self.center;
        let equator = (v.x() * v.x() + v.z() * v.z()).sqrt();
        let latitude = portable::atan2(v.y(), equator);
        [turn(v.x(), -v.z()), 0.5 + latitude * std::f64::consts::FRAC_1_PI]
    }

    pub(super) fn contains(&self, p: Point3) -> bool {
        (p - self.center).length_squared() < self.radius * self.radius
    }

    pub(super) fn bounds(&self) -> Bounds3 {
        Bounds3::new(self.center, self.center).grown(self.radius)
    }

    pub(super) fn transformed(&self, map: &Transform) -> Option<Self> {
        Some(Self::new(map.point(self.center), self.radius * map.uniform_scale()?))
    }
}

/// Spheres side by side: one in each lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LaneSpheres<L> {
    pub(crate) center: LaneVector<L>,
    pub(crate) radius: L,
}

impl<L: Lanes> From<&Sphere> for LaneSpheres<L> {
    /// The same one in all lanes.
    #[inline(always)]
    fn from(sphere: &Sphere) -> Self {
        Self { center: LaneVector::splat(sphere.center.to_array()), radius: L::splat(sphere.radius) }
    }
}

impl<L: Lanes> LaneSpheres<L> {
    /// Where the lines of rays enter and leave; the lanes that do both.
    #[inline(always)]
    fn span(&self, ray: &LaneRay<L>) -> (Bits, [L; 2]) {
        let zero = L::splat(0.0);
        let (f, d) = (self.center - ray.origin, ray.direction);
        let a = d.length_squared();
        let b = f.dot(d);
        let squared = self.radius * self.radius;
        let perpendicular = f - d * (b / a);
        let discriminant = squared - perpendicular.length_squared();
        // So written, NaN from a broken ray ends here too; a line that just touches does not hit.
        let met = discriminant.gt(zero) & a.gt(zero);
        if met.is_empty() {
            return (met, [zero; 2]);
        }
        let q = b + (a * discriminant).sqrt().copysign(b);
        let (far, near) = (q / a, (f.length_squared() - squared) / q);
        let backward = q.lt(zero);
        let (enter, leave) = (far.or_where_not(backward, near), near.or_where_not(backward, far));
        (met & enter.lt(leave), [enter, leave])
    }

    /// Whether [`LaneSpheres::span`], without a division or a root, can be known to have no end with t > 0: most spheres that
    /// a ray is tested with end here. Never true where it has one, not even by its own rounding.
    #[inline(always)]
    fn surely_missed(&self, ray: &LaneRay<L>) -> Bits {
        let (f, d) = (self.center - ray.origin, ray.direction);
        let (a, b, c) = (d.length_squared(), f.dot(d), f.length_squared());
        let squared = self.radius * self.radius;
        // From outside and away from it: the numerator and the sum that give both ends are what `span` computes.
        let is_behind = b.lt(L::splat(0.0)) & c.ge(squared);
        // The line's squared distance from the centre against the squared radius, both times a.
        let (distance, reach) = (c * a - b * b, a * (squared + L::splat(MISS_MARGIN) * c));
        let is_beside = distance.gt(reach) & reach.gt(L::splat(MISS_REACH)) & distance.lt(L::splat(f64::INFINITY));
        is_behind | is_beside
    }

    /// The nearest hit with 0 < t < `t_max`, of the lanes that have one.
    #[inline(always)]
    pub(crate) fn intersect(&self, ray: &LaneRay<L>, t_max: L) -> (Bits, L) {
        if self.surely_missed(ray) & L::all() == L::all() {
            return (Bits::NONE, t_max);
        }
        self.intersect_likely(ray, t_max)
    }

    /// As [`LaneSpheres::intersect`], for spheres that are not among the many that are surely missed.
    #[inline(always)]
    pub(crate) fn intersect_likely(&self, ray: &LaneRay<L>, t_max: L) -> (Bits, L) {
        let (met, [enter, leave]) = self.span(ray);
        let zero = L::splat(0.0);
        let t = enter.or_where_not(enter.gt(zero), leave);
        (met & t.gt(zero) & t.lt(t_max), t)
    }

    /// Where lines pass through them.
    #[inline(always)]
    pub(super) fn passages(&self, ray: &LaneRay<L>) -> [Passage<L>; 2] {
        let (met, [enter, leave]) = self.span(ray);
        let part = L::splat(0.0);
        [Passage { met, t: enter, part }, Passage { met, t: leave, part }]
    }

    /// As [`Sphere::hits_before`]: for each of both places, the lanes that pass there and where.
    #[inline(always)]
    pub(crate) fn hits_before(&self, ray: &LaneRay<L>, t_max: L) -> [(Bits, L); 2] {
        if self.surely_missed(ray) & L::all() == L::all() {
            return [(Bits::NONE, t_max); 2];
        }
        let (met, [enter, leave]) = self.span(ray);
        let zero = L::splat(0.0);
        [(met & enter.gt(zero) & enter.lt(t_max), enter), (met & leave.gt(zero) & leave.lt(t_max), leave)]
    }

    /// The point, the outward normal and the error of the point of hits at `t`.
    ///
    /// The direction of the hit from the centre is all that is taken from the ray, so errors of t only move the point
    /// along the surface. The error is counted in `rounding.rs`: the frame's roundings do not occur here.
    #[inline(always)]
    pub(crate) fn surface(&self, ray: &LaneRay<L>, t: L) -> (LaneVector<L>, LaneVector<L>, L) {
        let local = (ray.origin - self.center) + ray.direction * t;
        let normal = local.try_normalize_or_y();
        let error = L::splat(gamma(32)) * (self.center.max_abs() + self.radius);
        (self.center + normal * self.radius, normal, error)
    }
}
