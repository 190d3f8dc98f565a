//! Everything that rays can meet, and the questions that can be asked of it.
//!
//! Primitives stand in a *space*: the world, or that of a prototype, which instances place into the world: two levels. Each
//! space has its hierarchy. Shapes that keep their kind under their transform are brought into their space when the scene is
//! compiled, so most rays are never transformed.

mod blockers;
mod placed;
mod space;

use snell_math::{Point3, Ray, Vector3};

pub(crate) use placed::Placement;
pub(crate) use space::{Attributes, NONE, ObjectSpace, Primitive, Space};

use crate::accel::Candidate;
use crate::csg::{CsgHit, CsgScratch, CsgSolid};
use crate::interaction::{SolidId, SurfaceInteraction};
use crate::shape::ShapeHit;
use crate::shape::triangle_mesh::{MeshHit, TriangleMesh};
use crate::task::RayTask;

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
    /// For each material, whether it asks where on its object it is.
    pub(crate) textured: Vec<bool>,
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
    local: LocalHit,
}

/// Where on its primitive a hit is.
#[derive(Clone, Copy, Debug)]
pub(crate) enum LocalHit {
    Shape(ShapeHit),
    Mesh(MeshHit),
    Solid(CsgHit),
}

/// A hit within one primitive of the world.
struct InnerHit {
    inner: u32,
    local: LocalHit,
}

impl Candidate for InnerHit {
    fn t(&self) -> f64 {
        self.local.t()
    }
}

impl Candidate for LocalHit {
    fn t(&self) -> f64 {
        match self {
            Self::Shape(hit) => hit.t,
            Self::Mesh(hit) => hit.t,
            Self::Solid(hit) => hit.t,
        }
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
    /// The nearest hit of every ray of a queue, in its order. How a queue is answered is this room's own business.
    pub fn intersect_queue(&self, tasks: &[RayTask], hits: &mut Vec<Option<Hit>>, scratch: &mut QueryScratch) {
        hits.clear();
        hits.extend(tasks.iter().map(|task| self.intersect(&task.ray, f64::INFINITY, scratch)));
    }

    /// The nearest hit with 0 < t ≤ `t_max`. Of several at the same distance, the one of the lowest primitive.
    pub fn intersect(&self, ray: &Ray, t_max: f64, scratch: &mut QueryScratch) -> Option<Hit> {
        let found = self.world.nearest(ray, t_max, |_, primitive, t_max| match primitive {
            Primitive::Instance { prototype, placement, .. } => {
                let local_ray = self.world.placements[*placement as usize].to_local(ray);
                let space = &self.prototypes[*prototype as usize];
                let test = |_, primitive: &Primitive, t_max| {
                    self.intersect_primitive(space, primitive, &local_ray, 0.0, t_max, scratch)
                };
                let (inner, local) = space.nearest(&local_ray, t_max, test)?;
                Some(InnerHit { inner, local })
            }
            primitive => {
                let local = self.intersect_primitive(&self.world, primitive, ray, 0.0, t_max, scratch)?;
                Some(InnerHit { inner: NONE, local })
            }
        });
        found.map(|(primitive, InnerHit { inner, local })| Hit { t: local.t(), primitive, inner, local })
    }

    /// The nearest hit of a ray, given in the primitive's space, with one primitive that is no instance.
    #[inline]
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
            Primitive::Shape { shape, .. } => shape.intersect(ray, t_min, t_max).map(LocalHit::Shape),
            Primitive::Mesh { mesh, .. } => {
                self.meshes[*mesh as usize].intersect(ray, t_min, t_max).map(LocalHit::Mesh)
            }
            Primitive::Solid { solid, .. } => {
                self.solids[*solid as usize].intersect(ray, t_min, t_max, &mut scratch.csg).map(LocalHit::Solid)
            }
            // Prototypes are built flat.
            Primitive::Instance { .. } => None,
        }
    }

    /// Everything about a hit of a world ray that shading needs.
    pub fn interaction(&self, ray: &Ray, hit: &Hit) -> SurfaceInteraction {
        if hit.inner == NONE {
            return self.interaction_in(&self.world, ray, hit, hit.primitive, NONE);
        }
        let Primitive::Instance { prototype, placement, material } = &self.world.primitives[hit.primitive as usize]
        else {
            unreachable!("only hits of instances have an inner primitive");
        };
        let placement = &self.world.placements[*placement as usize];
        let space = &self.prototypes[*prototype as usize];
        let mut interaction = self.interaction_in(space, &placement.to_local(ray), hit, hit.inner, *material);
        placement.carry_out(&mut interaction);
        interaction
    }

    /// The interaction in the space that the primitive and the ray are in.
    fn interaction_in(
        &self,
        space: &Space,
        ray: &Ray,
        hit: &Hit,
        index: u32,
        inherited_material: u32,
    ) -> SurfaceInteraction {
        let primitive = &space.primitives[index as usize];
        let attributes = &space.attributes[index as usize];
        let placement = space.placement(primitive);
        let local_ray = placement.map_or(*ray, |placement| placement.to_local(ray));
        let mut vertex_color = None;
        let surface = match (primitive, &hit.local) {
            (Primitive::Shape { shape, .. }, LocalHit::Shape(local)) => shape.surface_geometry(&local_ray, *local),
            (Primitive::Mesh { mesh, .. }, LocalHit::Mesh(local)) => {
                let mesh = &self.meshes[*mesh as usize];
                vertex_color = mesh.color(local);
                mesh.surface(&local_ray, local)
            }
            (Primitive::Solid { solid, .. }, LocalHit::Solid(local)) => {
                self.solids[*solid as usize].surface(&local_ray, *local)
            }
            _ => unreachable!("a hit is of its primitive's kind"),
        };
        let material = self.material_of(primitive, attributes, inherited_material, &hit.local);
        let mut interaction = SurfaceInteraction {
            t: hit.t,
            point: surface.point,
            error: surface.error,
            geometric_normal: surface.geometric_normal,
            shading_normal: surface.shading_normal,
            uv: surface.uv,
            object_point: surface.point,
            object_inside: Vector3::ZERO,
            vertex_color,
            material,
            object: attributes.object,
            solid: SolidId(u64::from(hit.primitive) << 32 | u64::from(hit.inner)),
        };
        if self.textured[material as usize] {
            space.locate_on_object(primitive, attributes, &hit.local, &mut interaction);
        }
        if let Some(placement) = placement {
            placement.carry_out(&mut interaction);
        }
        interaction
    }

    /// Which material a hit has: its part's own, the object's, the mesh file's, that of the instance, or the one for all others.
    fn material_of(&self, primitive: &Primitive, attributes: &Attributes, inherited: u32, local: &LocalHit) -> u32 {
        let of_part = match (primitive, local) {
            (Primitive::Solid { solid, .. }, LocalHit::Solid(hit)) => self.solids[*solid as usize].tag(hit.leaf),
            _ => NONE,
        };
        let of_file = match (primitive, local) {
            (Primitive::Mesh { mesh, .. }, LocalHit::Mesh(hit)) if attributes.material == NONE => {
                let number = self.meshes[*mesh as usize].material_index(hit.triangle);
                self.mesh_materials[*mesh as usize].get(usize::from(number)).copied().unwrap_or(NONE)
            }
            _ => NONE,
        };
        [of_part, attributes.material, of_file, inherited]
            .into_iter()
            .find(|&material| material != NONE)
            .unwrap_or(self.default_material)
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
            Primitive::Shape { shape, .. } => shape.is_solid() && shape.contains(local),
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
        let material = self.material_of(primitive, &space.attributes[index as usize], inherited, &local);
        self.transparent[material as usize].then_some((bounds.half_area(), material))
    }
}
