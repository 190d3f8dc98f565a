//! Everything that rays can meet, listed: for those who draw it.

use snell_math::{Bounds3, Transform};

use super::{Geometry, NONE, Primitive, Space};
use crate::csg::CsgSolid;
use crate::shape::Shape;
use crate::shape::triangle_mesh::TriangleMesh;

/// What a primitive is made of, in its own space.
#[derive(Clone, Copy, Debug)]
pub enum Form<'a> {
    /// A shape.
    Shape(Shape),
    /// A solid made of shapes.
    Solid(&'a CsgSolid),
    /// Triangles, with the mesh's place in the scene's list.
    Mesh(&'a TriangleMesh, u32),
}

/// A primitive in the world.
#[derive(Clone, Debug)]
pub struct WorldSurface<'a> {
    /// What it is.
    pub form: Form<'a>,
    /// Where it stands; the world's own space where absent.
    pub world_from_own: Option<Transform>,
    /// Its object, as a place in the scene's list of names.
    pub object: u32,
    /// The material that it has on the whole, as a place in the scene's list; parts of it may have others.
    pub material: u32,
    /// Its box in the world.
    pub bounds: Bounds3,
}

impl Geometry {
    /// Every primitive of the world, those of instances included, in the scene's order.
    pub fn world_surfaces(&self) -> Vec<WorldSurface<'_>> {
        let mut all = Vec::new();
        for index in 0..self.world.primitives.len() as u32 {
            match &self.world.primitives[index as usize] {
                Primitive::Instance { prototype, placement, material } => {
                    let space = &self.prototypes[*prototype as usize];
                    let world_from_space = self.world.placements[*placement as usize].outer_from_local();
                    let of_instance = self.world.attributes[index as usize].object;
                    for inner in 0..space.primitives.len() as u32 {
                        let surface = self.surface_of(space, inner, Some(world_from_space), *material);
                        // An instance is one object, by the name that the author gave to it.
                        all.extend(surface.map(|surface| WorldSurface { object: of_instance, ..surface }));
                    }
                }
                _ => all.extend(self.surface_of(&self.world, index, None, NONE)),
            }
        }
        all
    }

    fn surface_of<'a>(
        &'a self,
        space: &'a Space,
        index: u32,
        world_from_space: Option<&Transform>,
        inherited: u32,
    ) -> Option<WorldSurface<'a>> {
        let primitive = &space.primitives[index as usize];
        let attributes = &space.attributes[index as usize];
        let form = match primitive {
            Primitive::Sphere(_) | Primitive::Plane(_) | Primitive::Shape { .. } => {
                Form::Shape(space.shape(primitive)?)
            }
            Primitive::Mesh { mesh, .. } => Form::Mesh(&self.meshes[*mesh as usize], *mesh),
            Primitive::Solid { solid, .. } => Form::Solid(&self.solids[*solid as usize]),
            Primitive::Instance { .. } => return None,
        };
        let placement = space.placement(primitive).map(|placement| placement.outer_from_local());
        let world_from_own = match (world_from_space, placement) {
            (Some(outer), Some(inner)) => Some(*outer * *inner),
            (Some(only), None) | (None, Some(only)) => Some(*only),
            (None, None) => None,
        };
        let own = space.bounds_of(index);
        let bounds = match world_from_space {
            Some(map) if own.is_finite() => map.bounds(&own),
            Some(_) => Bounds3::EVERYTHING,
            None => own,
        };
        let material = [attributes.material, inherited].into_iter().find(|&material| material != NONE);
        let material = material.unwrap_or(self.default_material);
        Some(WorldSurface { form, world_from_own, object: attributes.object, material, bounds })
    }
}
