//! The flat rectangle.

use snell_math::lanes::{LaneVector, Lanes};
use snell_math::{Bounds3, Point3, Ray, Transform, Vector3};

use super::plane::{LanePlanes, Plane};
use super::span::Passage;
use super::{LaneRay, ShapeHit, SurfacePoint};

/// The points `corner + u edges[0] + v edges[1]`, (u, v) in [0, 1]², for perpendicular edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    plane: Plane,
    corner: Point3,
    edges: [Vector3; 2],
    /// The edges over their squared lengths: products with these are u and v.
    coordinates: [Vector3; 2],
}

impl Rectangle {
    /// From a corner and the two edges from there; the normal is their vector product.
    pub fn new(corner: Point3, edges: [Vector3; 2]) -> Self {
        Self::with_plane(Plane::new(corner, edges[0].cross(edges[1])), corner, edges)
    }

    fn with_plane(plane: Plane, corner: Point3, edges: [Vector3; 2]) -> Self {
        let coordinates = edges.map(|edge| edge * (1.0 / edge.length_squared()));
        Self { plane, corner, edges, coordinates }
    }

    /// The corner and the edges from there.
    pub(crate) fn corner_and_edges(&self) -> (Point3, [Vector3; 2]) {
        (self.corner, self.edges)
    }

    /// The unit normal.
    pub(crate) fn normal(&self) -> Vector3 {
        self.plane.point_and_normal().1
    }

    #[inline]
    fn coordinates_of(&self, from_corner: Vector3) -> [f64; 2] {
        [from_corner.dot(self.coordinates[0]), from_corner.dot(self.coordinates[1])]
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
        let from_corner = (ray.origin - LaneVector::splat(self.corner.to_array())) + ray.direction * t;
        let u = from_corner.dot(LaneVector::splat(self.coordinates[0].to_array()));
        let v = from_corner.dot(LaneVector::splat(self.coordinates[1].to_array()));
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        Passage::one(zero.le(u) & u.le(one) & zero.le(v) & v.le(one), t)
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
        self.coordinates_of(p - self.corner).map(|c| c.clamp(0.0, 1.0))
    }

    pub(super) fn bounds(&self) -> Bounds3 {
        let [a, b] = self.edges;
        [a, b, a + b].into_iter().fold(Bounds3::new(self.corner, self.corner), |sum, v| sum.including(self.corner + v))
    }

    /// Under a mirroring the outward side stays outward, so the normal is carried by itself.
    pub(super) fn transformed(&self, map: &Transform) -> Option<Self> {
        map.uniform_scale()?;
        let edges = self.edges.map(|edge| map.vector(edge));
        Some(Self::with_plane(self.plane.transformed(map)?, map.point(self.corner), edges))
    }
}
