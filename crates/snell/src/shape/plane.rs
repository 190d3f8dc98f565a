//! The plane, as a surface, and as the half-space below it.

use snell_math::{Bounds3, Normal3, Point3, Ray, Transform, Vector3};

use super::frame::Frame;
use super::rounding::gamma;
use super::{Crossing, ShapeHit, SurfacePoint};

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
        (self.point - ray.origin).dot(self.normal) / ray.direction.dot(self.normal)
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

    /// The point is moved onto the plane along the normal. What remains is the rounding of its height over the plane
    /// (differences 1, products and sums 3, the normal's own length 3, each for the point and for the spawned ray that
    /// is tested next) and of its coordinates. Directions are above the plane or not by the very product with the normal
    /// that intersection divides by, so they add nothing.
    #[inline]
    pub(crate) fn surface_geometry(&self, ray: &Ray, hit: ShapeHit) -> SurfacePoint {
        let raw = ray.at(hit.t);
        let height = (raw - self.point).dot(self.normal);
        let point = raw - self.normal * height;
        let reach = (point - self.point).0.abs().element_sum();
        let error = gamma(20) * (point.max_abs() + reach + height.abs());
        SurfacePoint::flat(point, Normal3::from(self.normal), error)
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
