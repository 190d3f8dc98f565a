//! The own coordinates of a shape with an axis: its centre, and three perpendicular unit vectors, the last along the axis.

use std::f64::consts::TAU;

use snell_math::lanes::{LaneVector, Lanes};
use snell_math::{Point3, Ray, Transform, Vector3, portable};

use super::LaneRay;

/// Orthonormal axes at an origin. They may be left-handed after a mirroring: the shapes that use them are symmetric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    pub(crate) origin: Point3,
    pub(crate) x: Vector3,
    pub(crate) y: Vector3,
    pub(crate) z: Vector3,
}

impl Frame {
    /// With z along `axis`. For an axis +y, x is +x and y is −z, so that angles go around as on the sphere.
    pub(crate) fn around(origin: Point3, axis: Vector3) -> Self {
        let z = axis.try_normalize().unwrap_or(Vector3::ZERO);
        let (x, y) = z.orthonormal_basis();
        Self { origin, x, y, z }
    }

    /// The same ray in these coordinates; t keeps its meaning.
    #[inline]
    pub(super) fn ray(&self, ray: &Ray) -> (Vector3, Vector3) {
        (self.vector(ray.origin - self.origin), self.vector(ray.direction))
    }

    /// As [`Frame::ray`], side by side.
    #[inline(always)]
    pub(super) fn lanes<L: Lanes>(&self, ray: &LaneRay<L>) -> (LaneVector<L>, LaneVector<L>) {
        let origin = LaneVector::splat(self.origin.to_array());
        (self.lane_vectors(ray.origin - origin), self.lane_vectors(ray.direction))
    }

    /// As [`Frame::ray_point`], side by side.
    #[inline(always)]
    pub(super) fn lane_points<L: Lanes>(&self, ray: &LaneRay<L>, t: L) -> LaneVector<L> {
        let origin = LaneVector::splat(self.origin.to_array());
        self.lane_vectors((ray.origin - origin) + ray.direction * t)
    }

    /// As [`Frame::vector_out`], side by side.
    #[inline(always)]
    pub(super) fn lanes_out<L: Lanes>(&self, v: LaneVector<L>) -> LaneVector<L> {
        let (x, y, z) = (self.x.to_array(), self.y.to_array(), self.z.to_array());
        LaneVector::splat(x) * v.x + LaneVector::splat(y) * v.y + LaneVector::splat(z) * v.z
    }

    #[inline(always)]
    fn lane_vectors<L: Lanes>(&self, v: LaneVector<L>) -> LaneVector<L> {
        let (x, y, z) = (self.x.to_array(), self.y.to_array(), self.z.to_array());
        LaneVector { x: v.dot(LaneVector::splat(x)), y: v.dot(LaneVector::splat(y)), z: v.dot(LaneVector::splat(z)) }
    }

    /// The coordinates of the point at `t` on a ray.
    #[inline]
    pub(super) fn ray_point(&self, ray: &Ray, t: f64) -> Vector3 {
        self.vector((ray.origin - self.origin) + ray.direction * t)
    }

    /// The coordinates of a point.
    #[inline]
    pub(super) fn point(&self, p: Point3) -> Vector3 {
        self.vector(p - self.origin)
    }

    #[inline]
    fn vector(&self, v: Vector3) -> Vector3 {
        Vector3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }

    /// The vector with these coordinates.
    #[inline]
    pub(super) fn vector_out(&self, v: Vector3) -> Vector3 {
        self.x * v.x() + self.y * v.y() + self.z * v.z()
    }

    /// The point with these coordinates.
    #[inline]
    pub(super) fn point_out(&self, v: Vector3) -> Point3 {
        self.origin + self.vector_out(v)
    }

    /// Carried along by a rotation, mirroring and uniform scale, made orthonormal again.
    pub(super) fn transformed(&self, map: &Transform) -> Self {
        let z = map.vector(self.z).normalize();
        let x = map.vector(self.x);
        let x = (x - z * x.dot(z)).normalize();
        let image = map.vector(self.y);
        let y = z.cross(x);
        Self { origin: map.point(self.origin), x, y: if y.dot(image) < 0.0 { -y } else { y }, z }
    }

    /// By how much a circle of radius 1 across the axis reaches along x, y and z of space.
    pub(super) fn circle_extent(&self) -> Vector3 {
        let reach = |axis: usize| {
            let (x, y) = (self.x[axis], self.y[axis]);
            (x * x + y * y).sqrt()
        };
        Vector3::new(reach(0), reach(1), reach(2))
    }
}

/// The angle of (x, y) as a fraction of a full turn, in [0, 1]; 0 along x.
pub(super) fn turn(x: f64, y: f64) -> f64 {
    let fraction = portable::atan2(y, x) / TAU;
    if fraction < 0.0 { fraction + 1.0 } else { fraction }
}
