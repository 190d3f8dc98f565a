//! Where on a surface a texture is evaluated: the same point in each space that a mapping can start from.

use snell_math::{Normal3, Point3, Transform, Vector3};

/// How far inside a surface its pattern is read, relative to the magnitude of the coordinates: about 4000 times the
/// rounding error of a coordinate, and far below anything that can be seen.
pub const RELATIVE_INSET: f64 = 1.0 / (1_u64 << 40) as f64;

/// A point of a surface, as textures see it.
///
/// The two `inside` displacements carry the point from the surface to a place surely inside the solid, by a little more
/// than the point's error. Patterns in object and world space are read there, so that a face which lies exactly on the
/// border of two cells of a checker is not speckled by rounding: it shows the cell on its inner side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureCoordinates {
    /// The point in the space of the object that has the material.
    pub object_point: Point3,
    /// A short displacement into the solid, object space; zero where there is no inside.
    pub object_inside: Vector3,
    /// The point in the world.
    pub world_point: Point3,
    /// The same displacement, world space.
    pub world_inside: Vector3,
    /// The surface's own coordinates, see [`snell_scene::scene::Shape`].
    pub uv: [f64; 2],
    /// How much of the surface is seen at once.
    pub footprint: Footprint,
}

/// The part of a surface that one sample of the picture stands for, in each space: a parallelogram around the point, by two
/// of its sides, which are the steps to the neighbouring samples ([`crate::differential`]). Pictures are averaged over it;
/// the other patterns are evaluated at the point itself. Zero is sharp; NaN is taken as zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// In object space.
    pub object: [Vector3; 2],
    /// In the world.
    pub world: [Vector3; 2],
    /// In u and v.
    pub uv: [[f64; 2]; 2],
}

impl Footprint {
    /// Evaluates at the point itself.
    pub const SHARP: Self = Self { object: [Vector3::ZERO; 2], world: [Vector3::ZERO; 2], uv: [[0.0; 2]; 2] };
}

impl TextureCoordinates {
    /// From a point in the world, the unit geometric normal there (outward), how far at most the point is from the true
    /// surface (world units), its surface coordinates, and the map from the object that has the material. Sharp.
    #[must_use]
    pub fn new(
        world_point: Point3,
        geometric_normal: Normal3,
        error: f64,
        uv: [f64; 2],
        world_from_object: &Transform,
    ) -> Self {
        // Several times the error, because the normal may have been computed at a point that is off by as much.
        let depth = 8.0 * error + RELATIVE_INSET * world_point.max_abs();
        let world_inside = geometric_normal.as_vector() * -depth;
        Self {
            object_point: world_from_object.inverse_point(world_point),
            object_inside: world_from_object.inverse_vector(world_inside),
            world_point,
            world_inside,
            uv,
            footprint: Footprint::SHARP,
        }
    }
}
