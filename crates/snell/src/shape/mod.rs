//! The shapes: one file each, with intersection, crossings, surface and bounds. Plain `f64` geometry that knows nothing of
//! materials, scenes or hierarchies.
//!
//! A ray may have a direction of any length, and t is in units of it: a ray carried into a shape's space keeps its t. A
//! ray that only touches a shape does not hit it. Rays with NaN, infinite or zero directions hit nothing.
//!
//! Rays spawned on a surface start at `point + normal * error` on the outside, `point − normal * error` on the inside,
//! with the geometric normal and [`SurfacePoint::error`] as it is (once is enough, see `rounding.rs`), and are traced with
//! `t_min` 0: no other epsilon is needed. Which side a ray leaves to is told by the sign of `normal.dot(direction)`, with
//! the very direction it is traced with.

mod cuboid;
mod disk;
mod emitter;
pub(crate) mod frame;
mod frustum;
mod plane;
mod rectangle;
pub(crate) mod rounding;
mod span;
mod sphere;
mod sphere_pairs;
#[cfg(test)]
pub(crate) mod tests;
mod torus;
pub mod triangle_mesh;

use snell_math::lanes::{LaneVector, Lanes, WIDTH};
use snell_math::{Bounds3, Normal3, Point3, Ray, Transform, Vector3};

pub use cuboid::Cuboid;
pub use disk::Disk;
pub use emitter::{EmitterPoint, EmitterSurface};
pub use frustum::Frustum;
pub(crate) use plane::LanePlanes;
pub use plane::Plane;
pub use rectangle::Rectangle;
pub(crate) use span::Passage;
pub(crate) use sphere::LaneSpheres;
pub use sphere::Sphere;
pub use sphere_pairs::SpherePairs;
pub use torus::Torus;

use rounding::gamma;

/// Where a ray meets a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeHit {
    /// The ray parameter.
    pub t: f64,
    /// Which part of the shape: a face of a box, a cap, a triangle; 0 where there is only one.
    pub part: u32,
}

/// Rays side by side: one in each lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LaneRay<L> {
    pub(crate) origin: LaneVector<L>,
    pub(crate) direction: LaneVector<L>,
}

/// Rays side by side, in rows that stand elsewhere.
#[derive(Clone, Copy)]
pub(crate) struct RayRow<'a> {
    pub(crate) origin: &'a [[f64; WIDTH]; 3],
    pub(crate) direction: &'a [[f64; WIDTH]; 3],
}

impl RayRow<'_> {
    /// From place `at` on, see [`Lanes::load`].
    #[inline(always)]
    pub(crate) fn lanes<L: Lanes>(&self, at: usize) -> LaneRay<L> {
        LaneRay { origin: LaneVector::load(self.origin, at), direction: LaneVector::load(self.direction, at) }
    }

    /// One of them.
    #[inline(always)]
    pub(crate) fn ray(&self, lane: usize) -> Ray {
        let lane = lane & (WIDTH - 1);
        let [origin, direction] = [self.origin, self.direction].map(|rows| rows.map(|row| row[lane]));
        Ray::new(Point3::from(origin), Vector3::from(direction))
    }
}

impl<L: Lanes> From<&Ray> for LaneRay<L> {
    /// The same one in all lanes.
    #[inline(always)]
    fn from(ray: &Ray) -> Self {
        let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
        Self { origin: LaneVector::splat(origin), direction: LaneVector::splat(direction) }
    }
}

/// One place where a line passes through the boundary of a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The ray parameter; negative behind the origin.
    pub t: f64,
    /// The line goes from the outside to the inside here.
    pub entering: bool,
    /// Which part of the shape, as in [`ShapeHit`].
    pub part: u32,
}

/// The surface at a hit, in the same space as the ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, brought back onto the surface as well as rounding allows.
    pub point: Point3,
    /// How far, at most, `point` is from the true surface, in units of length, plus what intersection of a spawned ray
    /// can be wrong by: what spawned rays must be offset by.
    pub error: f64,
    /// The geometric normal: unit length, outward.
    pub geometric_normal: Normal3,
    /// The shading normal: unit length, outward; the geometric one but on smooth meshes.
    pub shading_normal: Normal3,
    /// The surface coordinates, see [`snell_scene::scene::Shape`] for what they mean on each shape.
    pub uv: [f64; 2],
}

impl SurfacePoint {
    /// On a surface whose shading normal is its geometric one, with (u, v) still 0.
    #[inline]
    pub(crate) fn flat(point: Point3, normal: Normal3, error: f64) -> Self {
        Self { point, error, geometric_normal: normal, shading_normal: normal, uv: [0.0, 0.0] }
    }

    /// The same surface in the space that `outer_from_inner` leads to, where rays are spawned that will be carried back
    /// by [`Transform::inverse_ray`] before they meet it again. The error grows by the rounding of both ways.
    ///
    /// An offset by e along the outer normal lifts the carried ray's origin by e h over the inner surface, h the length
    /// of the carried normal before it is normalised; so inner errors are divided by h. A point carried forth and back
    /// is wrong by the rounding of two affine maps, `gamma(4)` of the sum of the absolute values of all terms each, and
    /// by that of the inverse matrix itself, which is about as much again.
    #[must_use]
    pub fn carried(&self, outer_from_inner: &Transform) -> Self {
        let carried = outer_from_inner.normal(self.geometric_normal);
        let lift = carried.as_vector().length();
        let forth = outer_from_inner.affine();
        let back = outer_from_inner.inverse();
        let back = back.affine();
        let forth_terms = forth.matrix3.abs() * self.point.0.abs() + forth.translation.abs();
        let back_terms = back.matrix3.abs() * forth_terms + back.translation.abs();
        let rounding = gamma(16) * forth_terms.element_sum();
        let error = rounding + (self.error + gamma(32) * back_terms.element_sum()) / lift;
        Self {
            point: outer_from_inner.point(self.point),
            error,
            geometric_normal: carried.normalize(),
            shading_normal: outer_from_inner.normal(self.shading_normal).normalize(),
            uv: self.uv,
        }
    }
}

/// As [`SurfacePoint`], a point in each lane, without coordinates of its own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LaneSurfacePoint<L> {
    pub(crate) point: LaneVector<L>,
    pub(crate) error: L,
    pub(crate) geometric_normal: LaneVector<L>,
    pub(crate) shading_normal: LaneVector<L>,
}

impl<L: Lanes> LaneSurfacePoint<L> {
    /// As [`SurfacePoint::carried`], with the same bits.
    #[inline(always)]
    pub(crate) fn carried(&self, outer_from_inner: &Transform) -> Self {
        let carried = outer_from_inner.normals(self.geometric_normal);
        let lift = carried.length_squared().sqrt();
        let forth_terms = outer_from_inner.terms(self.point.abs());
        let back_terms = outer_from_inner.inverse().terms(forth_terms);
        let rounding = L::splat(gamma(16)) * forth_terms.sum();
        Self {
            point: outer_from_inner.points(self.point),
            error: rounding + (self.error + L::splat(gamma(32)) * back_terms.sum()) / lift,
            geometric_normal: carried.normalize(),
            shading_normal: outer_from_inner.normals(self.shading_normal).normalize(),
        }
    }
}

/// A shape ready to be traced, in its own space.
///
/// ```
/// use snell::math::{Point3, Ray, Vector3};
/// use snell::shape::{Shape, Sphere};
/// let shape = Shape::Sphere(Sphere::new(Point3::ORIGIN, 1.0));
/// let ray = Ray::new(Point3::new(0.0, 0.0, 5.0), Vector3::new(0.0, 0.0, -1.0));
/// let hit = shape.intersect(&ray, 0.0, f64::INFINITY).expect("the ray aims at the centre");
/// assert_eq!(hit.t, 4.0);
/// let surface = shape.surface(&ray, hit);
/// assert_eq!(surface.point, Point3::new(0.0, 0.0, 1.0));
/// // A shadow ray from there does not meet the sphere again.
/// let origin = surface.point + surface.geometric_normal.as_vector() * surface.error;
/// assert!(shape.intersect(&Ray::new(origin, Vector3::X), 0.0, f64::INFINITY).is_none());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// See [`Sphere`]. Solid.
    Sphere(Sphere),
    /// See [`Plane`]. Solid: the half-space below it.
    Plane(Plane),
    /// See [`Disk`].
    Disk(Disk),
    /// See [`Rectangle`].
    Rectangle(Rectangle),
    /// See [`Cuboid`]. Solid.
    Box(Cuboid),
    /// See [`Frustum`]. Solid where capped.
    Cylinder(Frustum),
    /// See [`Frustum`]. Solid where capped.
    Cone(Frustum),
    /// See [`Torus`]. Solid.
    Torus(Torus),
}

/// Runs the same expression on the shape within, matched once.
macro_rules! each {
    ($shape:expr, $inner:ident => $call:expr) => {
        match $shape {
            Shape::Sphere($inner) => $call,
            Shape::Plane($inner) => $call,
            Shape::Disk($inner) => $call,
            Shape::Rectangle($inner) => $call,
            Shape::Box($inner) => $call,
            Shape::Cylinder($inner) | Shape::Cone($inner) => $call,
            Shape::Torus($inner) => $call,
        }
    };
}

impl Shape {
    /// From the description; `None` for a mesh, which is not one shape but many triangles.
    pub fn new(description: &snell_scene::scene::Shape) -> Option<Self> {
        use snell_scene::scene::Shape as Description;
        Some(match *description {
            Description::Sphere { center, radius } => Self::Sphere(Sphere::new(center, radius)),
            Description::Plane { point, normal } => Self::Plane(Plane::new(point, normal)),
            Description::Disk { center, normal, radius, inner_radius } => {
                Self::Disk(Disk::new(center, normal, radius, inner_radius))
            }
            Description::Rectangle { corner, edges } => Self::Rectangle(Rectangle::new(corner, edges)),
            Description::Box { min, max } => Self::Box(Cuboid::new(min, max)),
            Description::Cylinder { base, top, radius, capped } => {
                Self::Cylinder(Frustum::new(base, radius, top, radius, capped))
            }
            Description::Cone { base, base_radius, top, top_radius, capped } => {
                Self::Cone(Frustum::new(base, base_radius, top, top_radius, capped))
            }
            Description::Torus { center, axis, major_radius, minor_radius } => {
                Self::Torus(Torus::new(center, axis, major_radius, minor_radius))
            }
            Description::Mesh(_) => return None,
        })
    }

    /// The nearest hit with `t_min < t < t_max`.
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        each!(self, shape => shape.intersect(ray, t_min, t_max))
    }

    /// True where [`Shape::passages`] knows the shape.
    #[inline]
    pub(crate) const fn has_lanes(&self) -> bool {
        !matches!(self, Self::Torus(_))
    }

    /// Where lines side by side pass through the surface, the nearer place first: what [`Shape::intersect`] finds for each alone.
    /// Nowhere where it is not [known](Shape::has_lanes).
    #[inline(always)]
    pub(crate) fn passages<L: Lanes>(&self, ray: &LaneRay<L>) -> [Passage<L>; 2] {
        match self {
            Self::Sphere(shape) => LaneSpheres::from(shape).passages(ray),
            Self::Plane(shape) => Passage::one(L::all(), LanePlanes::from(shape).parameter(ray)),
            Self::Disk(shape) => shape.passages(ray),
            Self::Rectangle(shape) => shape.passages(ray),
            Self::Box(shape) => shape.ends(ray),
            Self::Cylinder(shape) | Self::Cone(shape) => shape.passages(ray),
            Self::Torus(_) => [Passage::none(); 2],
        }
    }

    /// The points of hits at `t` with some parts, the outward normals there and the error of the points: as
    /// [`Shape::surface_geometry`]. Of no use where the shape is not [known](Shape::has_lanes).
    #[inline(always)]
    pub(crate) fn surfaces<L: Lanes>(&self, ray: &LaneRay<L>, t: L, part: L) -> (LaneVector<L>, LaneVector<L>, L) {
        match self {
            Self::Sphere(shape) => LaneSpheres::from(shape).surface(ray, t),
            Self::Plane(shape) => shape.surfaces(ray, t),
            Self::Disk(shape) => shape.surfaces(ray, t),
            Self::Rectangle(shape) => shape.surfaces(ray, t),
            Self::Box(shape) => shape.surfaces(ray, t, part),
            Self::Cylinder(shape) | Self::Cone(shape) => shape.surfaces(ray, t, part),
            Self::Torus(_) => (ray.origin, ray.direction, t),
        }
    }

    /// The surface at a hit of this ray.
    pub fn surface(&self, ray: &Ray, hit: ShapeHit) -> SurfacePoint {
        let surface = self.surface_geometry(ray, hit);
        SurfacePoint { uv: self.uv(surface.point, hit.part), ..surface }
    }

    /// As [`Shape::surface`], but with (u, v) left 0: for materials without textures, as the angles cost more than all
    /// the rest.
    #[inline]
    pub fn surface_geometry(&self, ray: &Ray, hit: ShapeHit) -> SurfacePoint {
        each!(self, shape => shape.surface_geometry(ray, hit))
    }

    /// The surface coordinates of a point on a part of the surface, in the shape's own space.
    pub fn uv(&self, point: Point3, part: u32) -> [f64; 2] {
        match self {
            Self::Sphere(shape) => shape.uv(point),
            Self::Plane(shape) => shape.uv(point),
            Self::Disk(shape) => shape.uv(point),
            Self::Rectangle(shape) => shape.uv(point),
            Self::Box(shape) => shape.uv(point, part),
            Self::Cylinder(shape) | Self::Cone(shape) => shape.uv(point),
            Self::Torus(shape) => shape.uv(point),
        }
    }

    /// True where it has an inside.
    pub fn is_solid(&self) -> bool {
        match self {
            Self::Sphere(_) | Self::Plane(_) | Self::Box(_) | Self::Torus(_) => true,
            Self::Disk(_) | Self::Rectangle(_) => false,
            Self::Cylinder(shape) | Self::Cone(shape) => shape.is_capped(),
        }
    }

    /// Appends every place where the ray's whole line, also behind its origin, passes through the boundary of this
    /// solid, in increasing order of t, by turns entering and leaving. Nothing where it is not solid. Before the first
    /// crossing the line is inside where that one leaves (only below a plane).
    pub fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        match self {
            Self::Sphere(shape) => shape.crossings(ray, out),
            Self::Plane(shape) => shape.crossings(ray, out),
            Self::Box(shape) => shape.crossings(ray, out),
            Self::Cylinder(shape) | Self::Cone(shape) if shape.is_capped() => shape.crossings(ray, out),
            Self::Torus(shape) => shape.crossings(ray, out),
            Self::Disk(_) | Self::Rectangle(_) | Self::Cylinder(_) | Self::Cone(_) => {}
        }
    }

    /// True where the point is inside this solid; on the surface it is not. Never where it is not solid.
    pub fn contains(&self, point: Point3) -> bool {
        match self {
            Self::Sphere(shape) => shape.contains(point),
            Self::Plane(shape) => shape.contains(point),
            Self::Box(shape) => shape.contains(point),
            Self::Cylinder(shape) | Self::Cone(shape) => shape.contains(point),
            Self::Torus(shape) => shape.contains(point),
            Self::Disk(_) | Self::Rectangle(_) => false,
        }
    }

    /// The smallest axis-aligned box around it, grown by the rounding of its own computation. A plane's is infinite,
    /// with one finite side where the plane is axis-aligned.
    pub fn bounds(&self) -> Bounds3 {
        let bounds = each!(self, shape => shape.bounds());
        let size = bounds.min.0.abs().max(bounds.max.0.abs());
        let largest = size.to_array().into_iter().filter(|s| s.is_finite()).fold(0.0, f64::max);
        bounds.grown(gamma(16) * largest)
    }

    /// The same solid or surface in another space, where the map lets the shape keep its kind: a rotation, mirroring and
    /// uniform scale for most, any affine map for a plane, moves and stretches along the axes for a box. Parts keep their
    /// numbers, but (u, v) may differ: take those from the original, at the point carried back.
    pub fn transformed(&self, map: &Transform) -> Option<Self> {
        Some(match self {
            Self::Sphere(shape) => Self::Sphere(shape.transformed(map)?),
            Self::Plane(shape) => Self::Plane(shape.transformed(map)?),
            Self::Disk(shape) => Self::Disk(shape.transformed(map)?),
            Self::Rectangle(shape) => Self::Rectangle(shape.transformed(map)?),
            Self::Box(shape) => Self::Box(shape.transformed(map)?),
            Self::Cylinder(shape) => Self::Cylinder(shape.transformed(map)?),
            Self::Cone(shape) => Self::Cone(shape.transformed(map)?),
            Self::Torus(shape) => Self::Torus(shape.transformed(map)?),
        })
    }
}
