//! The flat disk, with or without a hole. Glassner (ed.), An Introduction to Ray Tracing (1989), section 2.3.

use snell_math::lanes::{LaneVector, Lanes};
use snell_math::{Bounds3, Point3, Ray, Transform, Vector3};

use super::frame::{Frame, turn};
use super::plane::{LanePlanes, Plane};
use super::span::Passage;
use super::{LaneRay, ShapeHit, SurfacePoint};

/// The points of a plane between two distances from a centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    plane: Plane,
    frame: Frame,
    radius: f64,
    inner_radius: f64,
}

impl Disk {
    /// From its centre, normal and radii; `inner_radius` 0 for no hole.
    pub fn new(center: Point3, normal: Vector3, radius: f64, inner_radius: f64) -> Self {
        Self { plane: Plane::new(center, normal), frame: Frame::around(center, normal), radius, inner_radius }
    }

    /// Its frame, at the centre and with z along the normal, its inner radius and its radius.
    pub(crate) fn frame_and_radii(&self) -> (Frame, f64, f64) {
        (self.frame, self.inner_radius, self.radius)
    }

    /// See [`super::Shape::intersect`].
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        Passage::first_between(self.passages(&LaneRay::from(ray)), t_min, t_max)
    }

    /// Where lines pass through it.
    #[inline(always)]
    pub(super) fn passages<L: Lanes>(&self, ray: &LaneRay<L>) -> [Passage<L>; 2] {
        let t = LanePlanes::from(&self.plane).parameter(ray);
        let center = LaneVector::splat(self.frame.origin.to_array());
        let squared = ((ray.origin - center) + ray.direction * t).length_squared();
        let (inner, outer) = (self.inner_radius * self.inner_radius, self.radius * self.radius);
        Passage::one(L::splat(inner).le(squared) & squared.le(L::splat(outer)), t)
    }

    /// The points, the normals and the error of the points of hits at `t`.
    #[inline(always)]
    pub(super) fn surfaces<L: Lanes>(&self, ray: &LaneRay<L>, t: L) -> (LaneVector<L>, LaneVector<L>, L) {
        self.plane.surfaces(ray, t)
    }

    #[inline]
    pub(super) fn surface_geometry(&self, ray: &Ray, hit: ShapeHit) -> SurfacePoint {
        self.plane.surface_geometry(ray, hit)
    }

    pub(super) fn uv(&self, p: Point3) -> [f64; 2] {
        let local = self.frame.point(p);
        let distance = (local.x() * local.x() + local.y() * local.y()).sqrt();
        let v = (distance - self.inner_radius) / (self.radius - self.inner_radius);
        [turn(local.x(), local.y()), v.clamp(0.0, 1.0)]
    }

    pub(super) fn bounds(&self) -> Bounds3 {
        let reach = self.frame.circle_extent() * self.radius;
        Bounds3::new(self.frame.origin - reach, self.frame.origin + reach)
    }

    pub(super) fn transformed(&self, map: &Transform) -> Option<Self> {
        let scale = map.uniform_scale()?;
        Some(Self {
            plane: self.plane.transformed(map)?,
            frame: self.frame.transformed(map),
            radius: self.radius * scale,
            inner_radius: self.inner_radius * scale,
        })
    }
}
