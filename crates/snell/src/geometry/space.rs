//! A space: primitives with their hierarchy and what is known of each.

use snell_math::{Bounds3, Normal3, Point3, Ray, Vector3};

use super::placed::Placement;
use crate::accel::{Bvh, Candidate};
use crate::interaction::SurfaceInteraction;
use crate::shape::{Shape, Sphere};
use crate::texture::RELATIVE_INSET;

/// No such place: no placement, no material, no inner primitive.
pub const NONE: u32 = u32::MAX;

/// Up to so many primitives of a space are tested one by one.
const HANDFUL: usize = 4;

/// Something that a ray can meet: a place in one of the lists of its space or of the geometry. `placement` is a place too, or
/// [`NONE`] where it stands in its space as it is.
///
/// Spheres that do so are kept here themselves: scenes of very many primitives are most often made of them.
#[derive(Debug)]
pub enum Primitive {
    Sphere(Sphere),
    Shape { shape: u32, placement: u32 },
    Mesh { mesh: u32, placement: u32 },
    Solid { solid: u32, placement: u32 },
    Instance { prototype: u32, placement: u32, material: u32 },
}

/// What is known of a primitive and not needed to meet it.
#[derive(Clone, Copy, Debug)]
pub struct Attributes {
    /// Its object, as a place in the scene's list of names.
    pub object: u32,
    /// Its object's material, or [`NONE`].
    pub material: u32,
    /// Where a shape was brought into the space, the place of its object's own space; else [`NONE`].
    pub object_space: u32,
    /// No light goes through any part of it.
    pub is_opaque: bool,
}

/// The object's space of a shape that was brought out of it.
#[derive(Debug)]
pub struct ObjectSpace {
    pub placement: Placement,
    pub shape: Shape,
}

/// A short way into the solid, surely longer than the point is wrong: where patterns are read.
fn inside(point: Point3, outward: Normal3, error: f64) -> Vector3 {
    outward.as_vector() * -(8.0 * error + RELATIVE_INSET * point.max_abs())
}

/// Primitives with their hierarchy: bounded ones first, then those without bounds, such as planes.
#[derive(Debug)]
pub struct Space {
    pub primitives: Vec<Primitive>,
    pub attributes: Vec<Attributes>,
    pub bounds: Vec<Bounds3>,
    /// The shapes that primitives refer to.
    pub shapes: Vec<Shape>,
    pub placements: Vec<Placement>,
    pub object_spaces: Vec<ObjectSpace>,
    /// Over the first primitives, as many as `bounds` has.
    pub bvh: Bvh,
}

impl Space {
    /// The placement of a primitive that has one.
    #[inline]
    pub fn placement(&self, primitive: &Primitive) -> Option<&Placement> {
        match primitive {
            Primitive::Sphere(_) => None,
            Primitive::Shape { placement, .. }
            | Primitive::Mesh { placement, .. }
            | Primitive::Solid { placement, .. }
            | Primitive::Instance { placement, .. } => self.placements.get(*placement as usize),
        }
    }

    /// The shape that a primitive is, in its own space.
    #[inline]
    pub fn shape(&self, primitive: &Primitive) -> Option<Shape> {
        match primitive {
            Primitive::Sphere(sphere) => Some(Shape::Sphere(*sphere)),
            Primitive::Shape { shape, .. } => Some(self.shapes[*shape as usize]),
            _ => None,
        }
    }

    /// Fills in where on its object an interaction is, and (u, v) where the part of the primitive is given: given in this space for shapes that were brought here, and else in the
    /// primitive's own, which is the object's.
    pub fn locate_on_object(
        &self,
        primitive: &Primitive,
        attributes: &Attributes,
        part: Option<u32>,
        interaction: &mut SurfaceInteraction,
    ) {
        let SurfaceInteraction { point, geometric_normal: normal, error, .. } = *interaction;
        let shape = match self.object_spaces.get(attributes.object_space as usize) {
            Some(ObjectSpace { placement, shape }) => {
                interaction.object_point = placement.point_to_local(point);
                let normal = placement.normal_to_local(normal);
                let error = placement.error_to_local(error);
                interaction.object_inside = inside(interaction.object_point, normal, error);
                part.map(|part| (*shape, part))
            }
            None => {
                interaction.object_inside = inside(point, normal, error);
                part.and_then(|part| Some((self.shape(primitive)?, part)))
            }
        };
        if let Some((shape, part)) = shape {
            interaction.uv = shape.uv(interaction.object_point, part);
        }
    }

    /// The box of a primitive; all of space for one without bounds.
    pub fn bounds_of(&self, index: u32) -> Bounds3 {
        self.bounds.get(index as usize).copied().unwrap_or(Bounds3::EVERYTHING)
    }

    /// The box of all primitives.
    pub fn total_bounds(&self) -> Bounds3 {
        if self.primitives.len() > self.bounds.len() {
            return Bounds3::EVERYTHING;
        }
        self.bounds.iter().fold(Bounds3::EMPTY, |sum, b| sum.union(b))
    }

    /// The nearest hit of a ray up to `t_max`, and its primitive; of several at the same distance, that of the lowest primitive.
    /// `test` is given a primitive and a distance beyond which hits do not count; it may still return them.
    #[inline]
    pub fn nearest<H: Candidate>(
        &self,
        ray: &Ray,
        t_max: f64,
        mut test: impl FnMut(u32, &Primitive, f64) -> Option<H>,
    ) -> Option<(u32, H)> {
        let mut nearest = None;
        let mut limit = t_max;
        let first_alone = self.first_alone();
        // The unbounded ones before the rest, since a floor shortens the way through it.
        for (primitive, index) in self.primitives[first_alone..].iter().zip(first_alone as u32..) {
            if let Some(hit) = test(index, primitive, limit)
                && (hit.t() < limit || hit.t() == limit && nearest.is_none())
            {
                limit = hit.t();
                nearest = Some((index, hit));
            }
        }
        if first_alone == 0 {
            return nearest;
        }
        let bounded = self.bvh.closest(ray, limit, |index, limit| test(index, &self.primitives[index as usize], limit));
        bounded.or(nearest)
    }

    /// From which primitive on they are tested one by one: those without bounds, or all where there is but a handful, which
    /// is tested faster than its boxes are.
    #[inline]
    fn first_alone(&self) -> usize {
        if self.bounds.len() <= HANDFUL { 0 } else { self.bounds.len() }
    }

    /// Visits every primitive whose box a ray passes before `t_max`, in no particular order, until `visit` says it is enough.
    /// True where it did.
    #[inline]
    pub fn any(&self, ray: &Ray, t_max: f64, mut visit: impl FnMut(u32, &Primitive) -> bool) -> bool {
        let first_alone = self.first_alone();
        for (index, primitive) in self.primitives.iter().enumerate().skip(first_alone) {
            if visit(index as u32, primitive) {
                return true;
            }
        }
        first_alone > 0 && self.bvh.any(ray, t_max, |index| visit(index, &self.primitives[index as usize]))
    }
}
