//! A space: primitives with their hierarchy and what is known of each.

use snell_math::{Bounds3, Normal3, Point3, Ray, Vector3};

use super::placed::Placement;
use super::{InnerHit, Touching};
use crate::accel::{BuildError, BuildQuality, Candidate, Hull, WideBvh};
use crate::shape::{Plane, Shape, Sphere, SpherePairs, SurfacePoint};
use crate::texture::RELATIVE_INSET;

/// No such place: no placement, no material, no inner primitive.
pub const NONE: u32 = u32::MAX;

/// Up to so many primitives of a space are tested one by one.
const HANDFUL: usize = 4;
/// Up to so many, where all are plain spheres, which are tested faster than boxes.
const HANDFUL_OF_SPHERES: usize = 24;

/// Something that a ray can meet: a place in one of the lists of its space or of the geometry. `placement` is a place too, or
/// [`NONE`] where it stands in its space as it is.
///
/// Spheres and planes that do so are kept here themselves: scenes of very many primitives are most often made of the ones,
/// and nearly every ray is tested with one of the others.
#[derive(Debug)]
pub enum Primitive {
    Sphere(Sphere),
    Plane(Plane),
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

/// A point of a surface as its object sees it.
#[derive(Clone, Copy, Debug)]
pub struct ObjectPlace {
    pub point: Point3,
    /// A short way into the solid.
    pub inside: Vector3,
    pub uv: [f64; 2],
}

/// A short way into the solid, surely longer than the point is wrong: where patterns are read.
fn inside(point: Point3, outward: Normal3, error: f64) -> Vector3 {
    outward.as_vector() * -(8.0 * error + RELATIVE_INSET * point.max_abs())
}

/// The nearest hit of a ray with one primitive, by `test` unless it is one of those that stand in their space as they are.
///
/// Inlined where it is used, which is in the loops over primitives.
#[inline(always)]
fn meet(
    primitive: &Primitive,
    is_opaque: impl FnOnce() -> bool,
    ray: &Ray,
    touching: Touching,
    limit: f64,
    test: &mut impl FnMut(&Primitive, bool, f64) -> Option<InnerHit>,
) -> Option<InnerHit> {
    let hit = match primitive {
        Primitive::Sphere(sphere) => sphere.intersect(ray, 0.0, f64::INFINITY),
        Primitive::Plane(plane) => plane.intersect(ray, 0.0, f64::INFINITY),
        primitive => return test(primitive, is_opaque(), limit),
    };
    hit.map(|hit| touching.candidate(hit.into(), is_opaque()))
}

/// What a primitive lies in, where it is round and stands in its space as it is.
pub fn hull_of(primitive: &Primitive, shapes: &[Shape]) -> Hull {
    match primitive {
        Primitive::Sphere(Sphere { center, radius }) => Hull::Ball { center: *center, radius: *radius },
        Primitive::Shape { shape, placement: NONE } => match &shapes[*shape as usize] {
            Shape::Cylinder(frustum) | Shape::Cone(frustum) => {
                let (frame, length) = frustum.frame_and_length();
                let (thin, slope) = frustum.radius_and_slope();
                let half_axis = frame.z * (0.5 * length);
                Hull::Tube { center: frame.origin + half_axis, half_axis, radius: thin + slope * length }
            }
            _ => Hull::Unknown,
        },
        _ => Hull::Unknown,
    }
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
    pub bvh: WideBvh,
    /// In place of the hierarchy, where those are a handful of plain spheres; else empty.
    pub handful: SpherePairs,
    /// From which primitive on they are tested one by one.
    pub first_alone: usize,
    /// Whether there are several meshes in the hierarchy that stand in the space as they are.
    pub has_meshes: bool,
}

impl Space {
    /// From its lists, and builds what finds the primitives; `bounds` are those of the first of them.
    pub fn new(
        primitives: Vec<Primitive>,
        attributes: Vec<Attributes>,
        bounds: Vec<Bounds3>,
        shapes: Vec<Shape>,
        placements: Vec<Placement>,
        object_spaces: Vec<ObjectSpace>,
        quality: BuildQuality,
    ) -> Result<Self, BuildError> {
        let bounded = bounds.len();
        let hulls: Vec<Hull> = primitives[..bounded].iter().map(|primitive| hull_of(primitive, &shapes)).collect();
        let bvh = WideBvh::with_quality(&bounds, quality)?.with_hulls(&hulls);
        // All of them, if they all are plain spheres.
        let spheres: Vec<Sphere> = primitives[..bounded]
            .iter()
            .map_while(|primitive| if let Primitive::Sphere(sphere) = primitive { Some(*sphere) } else { None })
            .collect();
        let are_spheres = spheres.len() == bounded && bounded <= HANDFUL_OF_SPHERES;
        let handful = if are_spheres { SpherePairs::new(&spheres) } else { SpherePairs::default() };
        let first_alone = if !are_spheres && bounded <= HANDFUL { 0 } else { bounded };
        let stands = |primitive: &Primitive| matches!(primitive, Primitive::Mesh { placement: NONE, .. });
        let has_meshes =
            primitives[..first_alone.min(bounded)].iter().filter(|primitive| stands(primitive)).count() > 1;
        Ok(Self {
            has_meshes,
            primitives,
            attributes,
            bounds,
            shapes,
            placements,
            object_spaces,
            bvh,
            handful,
            first_alone,
        })
    }
}

impl Space {
    /// The placement of a primitive that has one.
    #[inline]
    pub fn placement(&self, primitive: &Primitive) -> Option<&Placement> {
        match primitive {
            Primitive::Sphere(_) | Primitive::Plane(_) => None,
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
            Primitive::Plane(plane) => Some(Shape::Plane(*plane)),
            Primitive::Shape { shape, .. } => Some(self.shapes[*shape as usize]),
            _ => None,
        }
    }

    /// Where on its object a point of a primitive's surface is, with (u, v) where the part of the primitive is given. The surface
    /// is in this space for shapes that were brought here, and else in the primitive's own, which is the object's.
    #[inline(never)]
    pub fn locate_on_object(
        &self,
        primitive: &Primitive,
        attributes: &Attributes,
        part: Option<u32>,
        surface: &SurfacePoint,
    ) -> ObjectPlace {
        let SurfacePoint { point, geometric_normal: normal, error, uv, .. } = *surface;
        let (mut place, shape) = match self.object_spaces.get(attributes.object_space as usize) {
            Some(ObjectSpace { placement, shape }) => {
                let point = placement.point_to_local(point);
                let normal = placement.normal_to_local(normal);
                let inside = inside(point, normal, placement.error_to_local(error));
                (ObjectPlace { point, inside, uv }, part.map(|part| (*shape, part)))
            }
            None => {
                let inside = inside(point, normal, error);
                (ObjectPlace { point, inside, uv }, part.and_then(|part| Some((self.shape(primitive)?, part))))
            }
        };
        if let Some((shape, part)) = shape {
            place.uv = shape.uv(place.point, part);
        }
        place
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
    /// `test` is given a primitive that is not tested here, whether it is opaque, and a distance beyond which hits do not
    /// count; it may still return them.
    #[inline]
    pub(super) fn nearest(
        &self,
        ray: &Ray,
        touching: Touching,
        t_max: f64,
        mut test: impl FnMut(&Primitive, bool, f64) -> Option<InnerHit>,
    ) -> Option<(u32, InnerHit)> {
        let mut nearest: Option<(u32, InnerHit)> = None;
        let mut limit = t_max;
        // The unbounded ones before the rest, since a floor shortens the way through it.
        for (primitive, index) in self.primitives[self.first_alone..].iter().zip(self.first_alone as u32..) {
            let is_opaque = || self.attributes[index as usize].is_opaque;
            if let Some(hit) = meet(primitive, is_opaque, ray, touching, limit, &mut test)
                && (hit.t() < limit || hit.t() == limit && nearest.is_none())
            {
                limit = hit.t();
                nearest = Some((index, hit));
            }
        }
        if !self.handful.is_empty() {
            self.handful.any(ray, |index| {
                if let Primitive::Sphere(sphere) = &self.primitives[index as usize]
                    && let Some(hit) = sphere.intersect_likely(ray, 0.0, f64::INFINITY)
                {
                    let hit = touching.candidate(hit.into(), self.attributes[index as usize].is_opaque);
                    // Of equals the lowest, which is not the one without bounds that was found before.
                    if hit.t() < limit || hit.t() == limit && nearest.as_ref().is_none_or(|(other, _)| index < *other) {
                        limit = hit.t();
                        nearest = Some((index, hit));
                    }
                }
                false
            });
            return nearest;
        }
        if self.first_alone == 0 {
            return nearest;
        }
        self.nearest_bounded(ray, touching, limit, test).or(nearest)
    }

    /// As [`Space::nearest`], of the primitives in the hierarchy alone; hits at `limit` count.
    #[inline]
    pub(super) fn nearest_bounded(
        &self,
        ray: &Ray,
        touching: Touching,
        limit: f64,
        mut test: impl FnMut(&Primitive, bool, f64) -> Option<InnerHit>,
    ) -> Option<(u32, InnerHit)> {
        self.bvh.closest(ray, limit, |index, limit| {
            let is_opaque = || self.attributes[index as usize].is_opaque;
            meet(&self.primitives[index as usize], is_opaque, ray, touching, limit, &mut test)
        })
    }

    /// Visits every primitive whose box a ray passes before `t_max`, in no particular order, until `visit` says it is enough.
    /// True where it did.
    #[inline]
    pub fn any(&self, ray: &Ray, t_max: f64, mut visit: impl FnMut(u32, &Primitive) -> bool) -> bool {
        for (primitive, index) in self.primitives[self.first_alone..].iter().zip(self.first_alone as u32..) {
            if visit(index, primitive) {
                return true;
            }
        }
        if !self.handful.is_empty() {
            return self.handful.any(ray, |index| visit(index, &self.primitives[index as usize]));
        }
        self.first_alone > 0 && self.bvh.any(ray, t_max, |index| visit(index, &self.primitives[index as usize]))
    }
}
