//! The surfaces of the scene that give off light and can be sampled, listed for those who send light from them.

use snell_math::{Point3, Transform};

use super::{Attributes, Geometry, LocalPlace, NONE, Primitive, Space};
use crate::interaction::SolidId;
use crate::shape::EmitterSurface;

/// A surface of one material that gives off light. World space.
#[derive(Clone, Debug)]
pub struct EmittingSurface {
    /// Where it is.
    pub surface: EmitterSurface,
    /// The body whose boundary it is, or part of it.
    pub solid: SolidId,
    /// Its material, as a place in the scene's list.
    pub material: u32,
    /// Its object, as a place in the scene's list of names.
    pub object: u32,
}

/// A primitive, and what it stands in.
struct Placed<'a> {
    space: &'a Space,
    index: u32,
    inherited: u32,
    world_from_space: Option<&'a Transform>,
    solid: SolidId,
}

impl Geometry {
    /// The surfaces whose material is one of those, as far as they can be sampled: spheres, disks, rectangles, and triangles of meshes,
    /// in the scene's order. Light of others is found by rays that meet them.
    pub fn emitting_surfaces(&self, emits: impl Fn(u32) -> bool) -> Vec<EmittingSurface> {
        let mut all = Vec::new();
        for (index, primitive) in (0..).zip(&self.world.primitives) {
            let solid = |inner: u32| SolidId(u64::from(index) << 32 | u64::from(inner));
            if let Primitive::Instance { prototype, placement, material } = primitive {
                let space = &self.prototypes[*prototype as usize];
                let world_from_space = Some(self.world.placements[*placement as usize].outer_from_local());
                for inner in 0..space.primitives.len() as u32 {
                    let placed =
                        Placed { space, index: inner, inherited: *material, world_from_space, solid: solid(inner) };
                    self.list_emitting(&placed, &emits, &mut all);
                }
            } else {
                let space = &self.world;
                let placed = Placed { space, index, inherited: NONE, world_from_space: None, solid: solid(NONE) };
                self.list_emitting(&placed, &emits, &mut all);
            }
        }
        all
    }

    fn list_emitting(&self, placed: &Placed<'_>, emits: &impl Fn(u32) -> bool, all: &mut Vec<EmittingSurface>) {
        let Placed { space, index, inherited, world_from_space, solid } = *placed;
        let primitive = &space.primitives[index as usize];
        let attributes: &Attributes = &space.attributes[index as usize];
        let placement = space.placement(primitive).map(|placement| placement.outer_from_local());
        let to_world = |point: Point3| {
            let point = placement.map_or(point, |map| map.point(point));
            world_from_space.map_or(point, |map| map.point(point))
        };
        let object = attributes.object;
        let mut list = |material: u32, surface: Option<EmitterSurface>| {
            all.extend(surface.map(|surface| EmittingSurface { surface, solid, material, object }));
        };
        if let Primitive::Mesh { mesh, .. } = primitive {
            let mesh = &self.meshes[*mesh as usize];
            // The materials of its triangles, each once, in the order in which they come up.
            let material =
                |triangle: u32| self.material_of(primitive, attributes, inherited, LocalPlace::of_part(triangle));
            let mut listed: Vec<u32> = Vec::new();
            for first in 0..mesh.triangle_count() as u32 {
                let wanted = material(first);
                if !emits(wanted) || listed.contains(&wanted) {
                    continue;
                }
                listed.push(wanted);
                let triangles = (first..mesh.triangle_count() as u32).filter(|&other| material(other) == wanted);
                let triangles = triangles.map(|triangle| mesh.triangle(triangle).map(to_world)).collect();
                list(wanted, EmitterSurface::from_triangles(triangles));
            }
            return;
        }
        let material = self.material_of(primitive, attributes, inherited, LocalPlace::of_part(0));
        if matches!(primitive, Primitive::Solid { .. } | Primitive::Instance { .. }) || !emits(material) {
            return;
        }
        let Some(mut shape) = space.shape(primitive) else { return };
        for map in [placement, world_from_space].into_iter().flatten() {
            match shape.transformed(map) {
                Some(carried) => shape = carried,
                // A sphere that became an ellipsoid, say.
                None => return,
            }
        }
        list(material, EmitterSurface::from_shape(&shape));
    }
}
