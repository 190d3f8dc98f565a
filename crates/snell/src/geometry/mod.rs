//! Everything that rays can meet, and the questions that can be asked of it.
//!
//! Primitives stand in a *space*: the world, or that of a prototype, which instances place into the world: two levels. Each
//! space has its hierarchy. Shapes that keep their kind under their transform are brought into their space when the scene is
//! compiled, so most rays are never transformed.

mod blocked;
mod blockers;
mod emitting;
mod lane_surfaces;
mod lanes;
mod packets;
mod placed;
mod space;
mod surfaces;
mod surroundings;
#[cfg(test)]
mod tests;

use snell_math::{Point3, Ray, Rgb, Vector3};

pub(crate) use crate::shape::RayRow;
pub use emitting::EmittingSurface;
pub(crate) use lanes::Blockers;
pub use lanes::HitRows;
pub(crate) use placed::Placement;
pub(crate) use space::{Attributes, NONE, ObjectPlace, ObjectSpace, Primitive, Space};
pub use surfaces::{Form, WorldSurface};

use crate::accel::Candidate;
use crate::csg::{CsgHit, CsgScratch, CsgSolid};
use crate::interaction::{SolidId, SurfaceInteraction};
use crate::shape::triangle_mesh::{MeshHit, TriangleMesh};
use crate::shape::{ShapeHit, SurfacePoint};
use crate::texture::Spaces;

/// All geometry of a compiled scene; never written to after it was built.
#[derive(Debug)]
pub struct Geometry {
    pub(crate) world: Space,
    pub(crate) prototypes: Vec<Space>,
    pub(crate) meshes: Vec<TriangleMesh>,
    /// For each mesh, the materials of its file, as places in the scene's list.
    pub(crate) mesh_materials: Vec<Vec<u32>>,
    pub(crate) solids: Vec<CsgSolid>,
    /// For each material, whether light goes through it.
    pub(crate) transparent: Vec<bool>,
    /// For each material, which coordinates of a hit it looks at.
    pub(crate) spaces: Vec<Spaces>,
    /// What objects without a material have.
    pub(crate) default_material: u32,
}

/// The nearest meeting of a ray with the scene.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// The ray parameter, a distance in world units.
    pub t: f64,
    /// The primitive of the world.
    primitive: u32,
    /// The primitive of the prototype, where that of the world is an instance; else [`NONE`].
    inner: u32,
    place: LocalPlace,
}

/// Where on its primitive a hit is: no more than it takes to work out the rest, since very many are found and few are kept.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalPlace {
    /// The part of a shape, also where that is a solid's leaf; of a mesh the triangle.
    part: u32,
    /// Of a solid what [`CsgHit`] says; else 0 and false.
    leaf: u32,
    flipped: bool,
    entering: bool,
}

impl LocalPlace {
    #[inline]
    fn of_part(part: u32) -> Self {
        Self { part, leaf: 0, flipped: false, entering: false }
    }
}

/// A hit within one primitive.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalHit {
    t: f64,
    place: LocalPlace,
}

/// A hit within one primitive of the world.
#[derive(Clone, Copy)]
struct InnerHit {
    /// What hits are compared by, see [`Touching`].
    key: f64,
    inner: u32,
    local: LocalHit,
}

impl Candidate for InnerHit {
    #[inline]
    fn t(&self) -> f64 {
        self.key
    }
}

/// Surfaces nearer to each other along a ray than this, relative to the coordinates of where that is, touch: rounding alone puts
/// one before the other or behind it.
const TOUCHING: f64 = 1.0 / (1_u64 << 44) as f64;

/// How far apart along one ray surfaces are that touch.
///
/// Where a transparent surface touches an opaque one, as a glass block touches the table that it stands on, a ray meets the
/// opaque one: there is no gap between them to look through. So transparent surfaces count as that much farther away.
#[derive(Clone, Copy, Debug)]
struct Touching(f64);

impl Touching {
    #[inline]
    fn along(ray: &Ray) -> Self {
        Self(TOUCHING * ray.origin.max_abs())
    }

    /// What hits are compared by.
    #[inline]
    fn key(self, t: f64, is_opaque: bool) -> f64 {
        if is_opaque { t } else { t + (TOUCHING * t + self.0) }
    }

    /// A hit to be compared with others.
    #[inline]
    fn candidate(self, local: LocalHit, is_opaque: bool) -> InnerHit {
        InnerHit { key: self.key(local.t, is_opaque), inner: NONE, local }
    }
}

impl From<ShapeHit> for LocalHit {
    #[inline]
    fn from(ShapeHit { t, part }: ShapeHit) -> Self {
        Self { t, place: LocalPlace::of_part(part) }
    }
}

impl From<MeshHit> for LocalHit {
    #[inline]
    fn from(MeshHit { t, triangle, .. }: MeshHit) -> Self {
        Self { t, place: LocalPlace::of_part(triangle) }
    }
}

impl From<CsgHit> for LocalHit {
    #[inline]
    fn from(CsgHit { t, leaf, part, flipped, entering }: CsgHit) -> Self {
        Self { t, place: LocalPlace { part, leaf, flipped, entering } }
    }
}

impl Hit {
    /// An order among hits at the same distance, the same on every machine.
    pub fn order(&self) -> (u32, u32) {
        (self.primitive, self.inner)
    }
}

/// Buffers that queries reuse.
#[derive(Debug, Default)]
pub struct QueryScratch {
    csg: CsgScratch,
}

impl Geometry {
    /// The nearest hit with 0 < t ≤ `t_max`. Of several at the same distance, the one of the lowest primitive; but an opaque
    /// one before any transparent one that touches it.
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_max: f64, scratch: &mut QueryScratch) -> Option<Hit> {
        let touching = Touching::along(ray);
        let found = self.world.nearest(ray, touching, t_max, |primitive, is_opaque, t_max| {
            self.meet_in(&self.world, primitive, is_opaque, ray, touching, t_max, scratch)
        });
        found.map(|(primitive, InnerHit { inner, local, .. })| Hit { t: local.t, primitive, inner, place: local.place })
    }

    /// The nearest hit with one primitive of a space, those at `t_max` included.
    #[expect(clippy::too_many_arguments, reason = "a private step of the function above")]
    #[inline]
    fn meet_in(
        &self,
        space: &Space,
        primitive: &Primitive,
        is_opaque: bool,
        ray: &Ray,
        touching: Touching,
        t_max: f64,
        scratch: &mut QueryScratch,
    ) -> Option<InnerHit> {
        if let Primitive::Instance { prototype, placement, .. } = primitive {
            return self.intersect_instance(*prototype, *placement, ray, touching, t_max, scratch);
        }
        let local = self.intersect_primitive(space, primitive, ray, 0.0, t_max.next_up(), scratch)?;
        Some(touching.candidate(local, is_opaque))
    }

    /// True where a hit is where its ray begins, but for rounding: with a surface that touches the one the ray was spawned at.
    #[inline]
    pub fn is_at_origin(ray: &Ray, t: f64) -> bool {
        t <= Touching::along(ray).0
    }

    /// The nearest hit of a world ray with an instance.
    #[inline(never)]
    fn intersect_instance(
        &self,
        prototype: u32,
        placement: u32,
        ray: &Ray,
        touching: Touching,
        t_max: f64,
        scratch: &mut QueryScratch,
    ) -> Option<InnerHit> {
        let ray = self.world.placements[placement as usize].to_local(ray);
        let space = &self.prototypes[prototype as usize];
        let found = space.nearest(&ray, touching, t_max, |primitive, is_opaque, t_max| {
            self.meet_in(space, primitive, is_opaque, &ray, touching, t_max, scratch)
        });
        found.map(|(inner, hit)| InnerHit { inner, ..hit })
    }

    /// The nearest hit with `t_min < t < t_max`, or a little above, of a ray, given in the primitive's space, with one
    /// primitive that is no instance.
    #[inline(never)]
    fn intersect_primitive(
        &self,
        space: &Space,
        primitive: &Primitive,
        ray: &Ray,
        t_min: f64,
        t_max: f64,
        scratch: &mut QueryScratch,
    ) -> Option<LocalHit> {
        let carried;
        let ray = match space.placement(primitive) {
            None => ray,
            Some(placement) => {
                carried = placement.to_local(ray);
                &carried
            }
        };
        match primitive {
            Primitive::Sphere(sphere) => sphere.intersect(ray, t_min, t_max).map(LocalHit::from),
            Primitive::Plane(plane) => plane.intersect(ray, t_min, t_max).map(LocalHit::from),
            Primitive::Shape { shape, .. } => {
                space.shapes[*shape as usize].intersect(ray, t_min, t_max).map(LocalHit::from)
            }
            Primitive::Mesh { mesh, .. } => {
                self.meshes[*mesh as usize].intersect(ray, t_min, t_max).map(LocalHit::from)
            }
            Primitive::Solid { solid, .. } => {
                self.solids[*solid as usize].intersect(ray, t_min, t_max, &mut scratch.csg).map(LocalHit::from)
            }
            // Prototypes are built flat.
            Primitive::Instance { .. } => None,
        }
    }

    /// Everything about a hit of a world ray that shading needs.
    #[inline]
    pub fn interaction(&self, ray: &Ray, hit: &Hit) -> SurfaceInteraction {
        if hit.inner == NONE {
            return self.interaction_in(&self.world, ray, hit, hit.primitive, NONE, false);
        }
        self.interaction_of_instance(ray, hit, false)
    }

    #[inline(never)]
    fn interaction_of_instance(&self, ray: &Ray, hit: &Hit, is_beside: bool) -> SurfaceInteraction {
        let Primitive::Instance { prototype, placement, material } = &self.world.primitives[hit.primitive as usize]
        else {
            unreachable!("only hits of instances have an inner primitive");
        };
        let placement = &self.world.placements[*placement as usize];
        let space = &self.prototypes[*prototype as usize];
        let mut interaction =
            self.interaction_in(space, &placement.to_local(ray), hit, hit.inner, *material, is_beside);
        let carried = placement.carry_out(&SurfacePoint {
            point: interaction.point,
            error: interaction.error,
            geometric_normal: interaction.geometric_normal,
            shading_normal: interaction.shading_normal,
            uv: interaction.uv,
        });
        interaction.point = carried.point;
        interaction.error = carried.error;
        interaction.geometric_normal = carried.geometric_normal;
        interaction.shading_normal = carried.shading_normal;
        interaction
    }

    /// The interaction in the space that the primitive and the ray are in. Inlined, since it is too large to be moved. Where it
    /// `is_beside` a hit, the ray need not meet the very triangle.
    #[inline(always)]
    fn interaction_in(
        &self,
        space: &Space,
        ray: &Ray,
        hit: &Hit,
        index: u32,
        inherited_material: u32,
        is_beside: bool,
    ) -> SurfaceInteraction {
        let primitive = &space.primitives[index as usize];
        let attributes = &space.attributes[index as usize];
        let placement = space.placement(primitive);
        let carried;
        let local_ray = match placement {
            None => ray,
            Some(placement) => {
                carried = placement.to_local(ray);
                &carried
            }
        };
        let mut vertex_color = None;
        let surface = match primitive {
            Primitive::Sphere(sphere) => sphere.surface_geometry(local_ray, ShapeHit { t: hit.t, part: 0 }),
            Primitive::Plane(plane) => plane.surface_geometry(local_ray, ShapeHit { t: hit.t, part: 0 }),
            Primitive::Shape { shape, .. } => {
                space.shapes[*shape as usize].surface_geometry(local_ray, ShapeHit { t: hit.t, part: hit.place.part })
            }
            Primitive::Mesh { mesh, .. } => {
                let mesh = &self.meshes[*mesh as usize];
                let local = if is_beside {
                    mesh.beside(hit.place.part, local_ray.at(hit.t))
                } else {
                    mesh.hit(local_ray, hit.place.part, hit.t)
                };
                vertex_color = mesh.color(&local);
                mesh.surface(local_ray, &local)
            }
            Primitive::Solid { solid, .. } => {
                let LocalPlace { part, leaf, flipped, entering } = hit.place;
                self.solids[*solid as usize].surface(local_ray, CsgHit { t: hit.t, leaf, part, flipped, entering })
            }
            Primitive::Instance { .. } => unreachable!("an instance is no surface"),
        };
        let material = self.material_of(primitive, attributes, inherited_material, hit.place);
        self.complete(space, hit, index, placement, surface, vertex_color, material)
    }

    /// The interaction at a surface that is known, given in the primitive's own space.
    #[expect(clippy::too_many_arguments, reason = "the last step of the function above, which others take as well")]
    #[inline(always)]
    fn complete(
        &self,
        space: &Space,
        hit: &Hit,
        index: u32,
        placement: Option<&Placement>,
        surface: SurfacePoint,
        vertex_color: Option<Rgb>,
        material: u32,
    ) -> SurfaceInteraction {
        let (primitive, attributes) = (&space.primitives[index as usize], &space.attributes[index as usize]);
        let Spaces { object, uv, .. } = self.spaces[material as usize];
        let place = if object || uv {
            space.locate_on_object(primitive, attributes, uv.then_some(hit.place.part), &surface)
        } else {
            ObjectPlace { point: surface.point, inside: Vector3::ZERO, uv: surface.uv }
        };
        let surface = match placement {
            None => surface,
            Some(placement) => placement.carry_out(&surface),
        };
        SurfaceInteraction {
            t: hit.t,
            point: surface.point,
            error: surface.error,
            geometric_normal: surface.geometric_normal,
            shading_normal: surface.shading_normal,
            uv: place.uv,
            object_point: place.point,
            object_inside: place.inside,
            vertex_color,
            material,
            object: attributes.object,
            solid: SolidId(u64::from(hit.primitive) << 32 | u64::from(hit.inner)),
        }
    }

    /// Which material a hit has: its part's own, the object's, the mesh file's, that of the instance, or the one for all others.
    #[inline]
    fn material_of(&self, primitive: &Primitive, attributes: &Attributes, inherited: u32, place: LocalPlace) -> u32 {
        if let Primitive::Sphere(_) | Primitive::Plane(_) = primitive
            && attributes.material != NONE
        {
            return attributes.material;
        }
        self.material_of_others(primitive, attributes, inherited, place)
    }

    fn material_of_others(
        &self,
        primitive: &Primitive,
        attributes: &Attributes,
        inherited: u32,
        place: LocalPlace,
    ) -> u32 {
        if let Primitive::Solid { solid, .. } = primitive {
            let of_part = self.solids[*solid as usize].tag(place.leaf);
            if of_part != NONE {
                return of_part;
            }
        }
        if attributes.material != NONE {
            return attributes.material;
        }
        if let Primitive::Mesh { mesh, .. } = primitive {
            let number = self.meshes[*mesh as usize].material_index(place.part);
            let materials = &self.mesh_materials[*mesh as usize];
            if let Some(&of_file) = materials.get(usize::from(number)).filter(|&&of_file| of_file != NONE) {
                return of_file;
            }
        }
        if inherited != NONE { inherited } else { self.default_material }
    }

    /// The transparent bodies that a world point is in, the outermost first, each with its material.
    pub(crate) fn bodies_around(&self, point: Point3, scratch: &mut QueryScratch) -> Vec<(SolidId, u32)> {
        let mut found: Vec<(f64, SolidId, u32)> = Vec::new();
        for (index, primitive) in self.world.primitives.iter().enumerate() {
            let index = index as u32;
            if let Primitive::Instance { prototype, placement, material } = primitive {
                let space = &self.prototypes[*prototype as usize];
                let local = self.world.placements[*placement as usize].point_to_local(point);
                for inner in 0..space.primitives.len() as u32 {
                    if let Some((size, body)) = self.body_around(space, inner, *material, local, scratch) {
                        found.push((size, SolidId(u64::from(index) << 32 | u64::from(inner)), body));
                    }
                }
            } else if let Some((size, body)) = self.body_around(&self.world, index, NONE, point, scratch) {
                found.push((size, SolidId(u64::from(index) << 32 | u64::from(NONE)), body));
            }
        }
        // A body inside another is smaller; so the larger was entered first.
        found.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        found.into_iter().map(|(_, solid, material)| (solid, material)).collect()
    }

    /// Where a primitive is a transparent body around a point of its space: its size and material.
    fn body_around(
        &self,
        space: &Space,
        index: u32,
        inherited: u32,
        point: Point3,
        scratch: &mut QueryScratch,
    ) -> Option<(f64, u32)> {
        let primitive = &space.primitives[index as usize];
        if space.attributes[index as usize].is_opaque {
            return None;
        }
        let bounds = space.bounds_of(index);
        if !bounds.contains(point) {
            return None;
        }
        let local = space.placement(primitive).map_or(point, |placement| placement.point_to_local(point));
        let contains = match primitive {
            Primitive::Sphere(_) | Primitive::Plane(_) | Primitive::Shape { .. } => {
                space.shape(primitive).is_some_and(|shape| shape.is_solid() && shape.contains(local))
            }
            Primitive::Mesh { mesh, .. } => self.meshes[*mesh as usize].contains(local),
            Primitive::Solid { solid, .. } => self.solids[*solid as usize].contains(local),
            Primitive::Instance { .. } => false,
        };
        if !contains {
            return None;
        }
        // Its material is the one of the boundary that is met on the way out.
        let ray = Ray::new(point, Vector3::new(0.48, 0.6, 0.64));
        let local = self.intersect_primitive(space, primitive, &ray, 0.0, f64::INFINITY, scratch)?;
        let material = self.material_of(primitive, &space.attributes[index as usize], inherited, local.place);
        self.transparent[material as usize].then_some((bounds.half_area(), material))
    }
}
