//! Where a ray met the scene: what shading needs to know of it. World space.

use crate::texture::RELATIVE_INSET;
use snell_math::{Normal3, Point3, Ray, Rgb, Vector3};

/// A body that has an inside: which one a ray enters or leaves. Two placements of one prototype are two bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SolidId(pub(crate) u64);

/// A hit, worked out.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceInteraction {
    /// The ray parameter, a distance in world units.
    pub t: f64,
    /// The point on the surface.
    pub point: Point3,
    /// How far `point` is from the true surface, at most.
    pub error: f64,
    /// Unit length, outward.
    pub geometric_normal: Normal3,
    /// Unit length, outward; the geometric one but on smooth meshes.
    pub shading_normal: Normal3,
    /// The surface's own coordinates.
    pub uv: [f64; 2],
    /// The point in the space of the object that has the material: where patterns are.
    pub object_point: Point3,
    /// A short way from there into the solid, in the same space; zero where the material asks for no such thing.
    pub object_inside: Vector3,
    /// The mesh's own colour here: a factor on the diffuse colour.
    pub vertex_color: Option<Rgb>,
    /// Which material, as a place in the compiled scene's list.
    pub material: u32,
    /// Which object, as a place in the compiled scene's list of names.
    pub object: u32,
    /// The body whose boundary this is.
    pub solid: SolidId,
}

impl SurfaceInteraction {
    /// A ray that leaves this point: its origin is moved off the surface, to the side the direction points to, by as much
    /// as the point may be wrong, so that the surface is not met again by rounding. No length of the scene enters.
    #[inline]
    pub fn spawn_ray(&self, direction: Vector3) -> Ray {
        let outward = self.geometric_normal.as_vector();
        let side = if outward.dot(direction) < 0.0 { -self.error } else { self.error };
        let origin = self.point + outward * side;
        Ray::new(origin, direction)
    }

    /// A short way into the solid, world space: where patterns of the world are read.
    #[inline]
    pub fn inside(&self) -> Vector3 {
        self.geometric_normal.as_vector() * -(8.0 * self.error + RELATIVE_INSET * self.point.max_abs())
    }

    /// True where a direction that leaves the surface goes to its outward side.
    #[inline]
    pub fn is_outward(&self, direction: Vector3) -> bool {
        self.geometric_normal.dot(direction) >= 0.0
    }
}
