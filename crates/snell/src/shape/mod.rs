//! The shapes: one file each, with intersection, crossings, surface and bounds. Plain `f64` geometry that knows nothing of
//! materials, scenes or hierarchies.

pub mod triangle_mesh;

use snell_math::{Normal3, Point3};

/// Where a ray meets a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeHit {
    /// The ray parameter.
    pub t: f64,
    /// Which part of the shape: a face of a box, a cap, a triangle; 0 where there is only one.
    pub part: u32,
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
    /// How far, at most, `point` is from the true surface, in units of length: what spawned rays must be offset by.
    pub error: f64,
    /// The geometric normal: unit length, outward.
    pub geometric_normal: Normal3,
    /// The shading normal: unit length, outward; the geometric one but on smooth meshes.
    pub shading_normal: Normal3,
    /// The surface coordinates, see [`snell_scene::scene::Shape`] for what they mean on each shape.
    pub uv: [f64; 2],
}
