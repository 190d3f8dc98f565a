//! The plane, as a surface, and as the half-space below it.

use snell_math::lanes::{Bits, LaneVector, Lanes};
use snell_math::{Bounds3, Normal3, Point3, Ray, Transform, Vector3};

use super::frame::Frame;
use super::rounding::gamma;
use super::{Crossing, LaneRay, ShapeHit, SurfacePoint};

/// All points p with (p − point) · normal = 0; solid where the product is negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    point: Point3,
    normal: Vector3,
}

impl Plane {
    /// Through a point; the normal is brought to unit length.
    pub fn new(point: Point3, normal: Vector3) -> Self {
        Self { point, normal: normal.try_normalize().unwrap_or(Vector3::ZERO) }
    }

    /// A point of it and its unit normal.
    pub(crate) fn point_and_normal(&self) -> (Point3, Vector3) {
        (self.point, self.normal)
    }

    /// Where a ray meets the plane; infinite or NaN where they are parallel, which no comparison lets pass.
    #[inline]
    pub(super) fn parameter(&self, ray: &Ray) -> f64 {
        LanePlanes::<f64>::from(self).parameter(&LaneRay::from(ray))
    }

    /// See [`super::Shape::intersect`].
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        let t = self.parameter(ray);
        (t > t_min && t < t_max).then_some(ShapeHit { t, part: 0 })
    }

    pub(super) fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        let t = self.parameter(ray);
        if t.is_finite() {
            out.push(Crossing { t, entering: ray.direction.dot(self.normal) < 0.0, part: 0 });
        }
    }

    /// See [`LanePlanes::surface`].
    #[inline]
    pub(crate) fn surface_geometry(&self, ray: &Ray, hit: ShapeHit) -> SurfacePoint {
        let (point, error) = LanePlanes::<f64>::from(self).surface(&LaneRay::from(ray), hit.t);
        SurfacePoint::flat(point.into(), Normal3::from(self.normal), error)
    }

    /// The points, the normals and the error of the points of hits at `t`.
    #[inline(always)]
    pub(super) fn surfaces<L: Lanes>(&self, ray: &LaneRay<L>, t: L) -> (LaneVector<L>, LaneVector<L>, L) {
        let planes = LanePlanes::from(self);
        let (point, error) = planes.surface(ray, t);
        (point, planes.normal, error)
    }

    pub(super) fn uv(&self, p: Point3) -> [f64; 2] {
        let local = Frame::around(self.point, self.normal).point(p);
        [local.x(), local.y()]
    }

    pub(super) fn contains(&self, p: Point3) -> bool {
        (p - self.point).dot(self.normal) < 0.0
    }

    /// Everything; bounded on one side where the normal is along an axis.
    pub(super) fn bounds(&self) -> Bounds3 {
        let mut bounds = Bounds3::EVERYTHING;
        for axis in 0..3 {
            if self.normal[axis] == 1.0 {
                bounds.max.0[axis] = self.point[axis];
            } else if self.normal[axis] == -1.0 {
                bounds.min.0[axis] = self.point[axis];
            }
        }
        bounds
    }

    /// A plane stays one under any affine map.
    pub(super) fn transformed(&self, map: &Transform) -> Option<Self> {
        Some(Self::new(map.point(self.point), map.normal(Normal3::from(self.normal)).as_vector()))
    }
}

/// Planes side by side: one in each lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LanePlanes<L> {
    pub(crate) point: LaneVector<L>,
    pub(crate) normal: LaneVector<L>,
}

impl<L: Lanes> From<&Plane> for LanePlanes<L> {
    /// The same one in all lanes.
    #[inline(always)]
    fn from(plane: &Plane) -> Self {
        Self { point: LaneVector::splat(plane.point.to_array()), normal: LaneVector::splat(plane.normal.to_array()) }
    }
}

impl<L: Lanes> LanePlanes<L> {
    /// Where rays meet the planes; infinite or NaN where they are parallel, which no comparison lets pass.
    #[inline(always)]
    pub(super) fn parameter(&self, ray: &LaneRay<L>) -> L {
        (self.point - ray.origin).dot(self.normal) / ray.direction.dot(self.normal)
    }

    /// The hit with 0 < t < `t_max`, of the lanes that have one.
    #[inline(always)]
    pub(crate) fn intersect(&self, ray: &LaneRay<L>, t_max: L) -> (Bits, L) {
        let t = self.parameter(ray);
        (t.gt(L::splat(0.0)) & t.lt(t_max), t)
    }

    /// The point, and its error, of hits at `t`.
    ///
    /// The point is moved onto the plane along the normal. What remains is the rounding of its height over the plane
    /// (differences 1, products and sums 3, the normal's own length 3, each for the point and for the spawned ray that
    /// is tested next) and of its coordinates. Directions are above the plane or not by the very product with the normal
    /// that intersection divides by, so they add nothing.
    #[inline(always)]
    pub(crate) fn surface(&self, ray: &LaneRay<L>, t: L) -> (LaneVector<L>, L) {
        let raw = ray.origin + ray.direction * t;
        let height = (raw - self.point).dot(self.normal);
        let point = raw - self.normal * height;
        let across = point - self.point;
        let reach = across.x.abs() + across.y.abs() + across.z.abs();
        (point, L::splat(gamma(20)) * (point.max_abs() + reach + height.abs()))
    }
}
