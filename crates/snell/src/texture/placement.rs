//! A compiled [`Mapping`]: carries a point of a surface into texture space, a little inside the solid.

use snell_math::{Point3, Vector3};
use snell_scene::scene::{Mapping, Space};

use super::coordinates::{RELATIVE_INSET, TextureCoordinates};

/// Where a pattern stands.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    space: Space,
    /// Nothing moves: skips the arithmetic.
    pub(super) is_identity: bool,
    /// The images of the unit vectors x, y and z.
    pub(super) columns: [Vector3; 3],
    /// The image of the origin.
    pub(super) origin: Point3,
    /// Bounds the largest coordinate of a vector's image by the vector's own largest (the matrix's maximum norm).
    pub(super) growth: f64,
}

impl Placement {
    pub fn new(mapping: &Mapping) -> Self {
        let columns = [Vector3::X, Vector3::Y, Vector3::Z].map(|axis| mapping.texture_from_space.vector(axis));
        let row = |i: usize| columns.iter().map(|column| column[i].abs()).sum::<f64>();
        Self {
            space: mapping.space,
            is_identity: mapping.texture_from_space.is_identity(),
            columns,
            origin: mapping.texture_from_space.point(Point3::ORIGIN),
            growth: row(0).max(row(1)).max(row(2)),
        }
    }

    /// Which coordinates it starts from.
    pub fn space(&self) -> Space {
        self.space
    }

    /// True where the coordinates are (u, v, 0), so that a pattern has two dimensions.
    pub fn is_flat(&self) -> bool {
        self.space == Space::Uv
    }

    /// The point in texture space to evaluate a pattern at; finite always.
    #[inline]
    pub fn locate(&self, at: &TextureCoordinates) -> Point3 {
        let (point, inside) = match self.space {
            Space::Object => (at.object_point, at.object_inside),
            Space::World => (at.world_point, at.world_inside),
            Space::Uv => (Point3::new(at.uv[0], at.uv[1], 0.0), Vector3::ZERO),
        };
        let placed = if self.is_identity { point } else { self.origin + self.linear(point.to_vector()) };
        let placed = if self.is_flat() { placed } else { self.inset(point, placed, inside) };
        if placed.is_finite() { placed } else { Point3::ORIGIN }
    }

    /// The sides of the footprint in texture space.
    #[inline]
    pub fn footprint(&self, at: &TextureCoordinates) -> [Vector3; 2] {
        let sides = match self.space {
            Space::Object => at.footprint.object,
            Space::World => at.footprint.world,
            Space::Uv => at.footprint.uv.map(|[u, v]| Vector3::new(u, v, 0.0)),
        };
        if self.is_identity { sides } else { sides.map(|side| self.linear(side)) }
    }

    #[inline]
    fn linear(&self, v: Vector3) -> Vector3 {
        self.columns[0] * v.x() + self.columns[1] * v.y() + self.columns[2] * v.z()
    }

    /// `placed`, the image of `point`, moved inwards: at least by the rounding error of mapping it.
    #[inline]
    fn inset(&self, point: Point3, placed: Point3, inside: Vector3) -> Point3 {
        let inside = if self.is_identity { inside } else { self.linear(inside) };
        let length = inside.max_abs();
        // No inside, or one that says nothing.
        if !(length > 0.0 && length.is_finite()) {
            return placed;
        }
        let rounding = RELATIVE_INSET * (self.growth * point.max_abs() + self.origin.max_abs());
        placed + inside * (rounding / length).max(1.0)
    }
}
