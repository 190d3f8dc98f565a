//! Flattening the objects of a scene into primitives, and building what they are found by.

use rayon::prelude::*;
use snell_math::{Bounds3, Transform};
use snell_scene::scene::{self, Object, ObjectKind, Scene};
use snell_scene::{Diagnostic, Id, Severity};

use super::count::{COPIED_PROTOTYPE, refuse_too_many};
use crate::accel::BuildError;
use crate::csg::{CsgNode, CsgSolid};
use crate::geometry::{Attributes, Geometry, NONE, ObjectSpace, Placement, Primitive, Space};
use crate::material::Material;
use crate::shape::Shape;
use crate::shape::triangle_mesh::TriangleMesh;
use crate::texture::Textures;

/// Compiles all objects of a scene, with their names. `materials` is the scene's list with the one for objects without
/// material at its end. `None` where there is an error among the diagnostics.
pub fn compile(
    scene: &Scene,
    materials: &[Material],
    textures: &Textures,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<(Geometry, Vec<String>)> {
    if let Some(error) = refuse_too_many(scene) {
        diagnostics.push(error);
        return None;
    }
    let descriptions: Vec<&scene::Mesh> = scene.meshes.iter().collect();
    let compiled: Vec<Result<TriangleMesh, _>> = descriptions.par_iter().map(|mesh| TriangleMesh::new(mesh)).collect();
    let mut meshes = Vec::with_capacity(compiled.len());
    for (compiled, mesh) in compiled.into_iter().zip(scene.meshes.iter()) {
        match compiled {
            Ok(mesh) => meshes.push(mesh),
            Err(error) => {
                diagnostics.push(Diagnostic::error(format!("the mesh \"{}\" cannot be used: {error}", mesh.name)));
            }
        }
    }
    if meshes.len() < scene.meshes.len() {
        return None;
    }
    let transparent: Vec<bool> = materials.iter().map(|material| material.body.is_some()).collect();
    let mut compiler = Compiler {
        scene,
        meshes: &meshes,
        transparent: &transparent,
        prototypes: Vec::new(),
        solids: Vec::new(),
        names: Vec::new(),
        next_object: 0,
        diagnostics,
    };
    for prototype in scene.prototypes.iter() {
        let space = compiler.space(&prototype.objects)?;
        compiler.prototypes.push(space);
    }
    let world = compiler.space(&scene.objects)?;
    let Compiler { prototypes, solids, names, .. } = compiler;
    let mesh_materials =
        scene.meshes.iter().map(|mesh| mesh.materials.iter().map(|id| id.index() as u32).collect()).collect();
    let spaces = materials.iter().map(|material| material.spaces(textures)).collect();
    let default_material = materials.len() as u32 - 1;
    let geometry =
        Geometry { world, prototypes, meshes, mesh_materials, solids, transparent, spaces, default_material };
    Some((geometry, names))
}

struct Compiler<'a> {
    scene: &'a Scene,
    meshes: &'a [TriangleMesh],
    transparent: &'a [bool],
    prototypes: Vec<Space>,
    solids: Vec<CsgSolid>,
    names: Vec<String>,
    next_object: u32,
    diagnostics: &'a mut Vec<Diagnostic>,
}

/// A space in the making.
#[derive(Default)]
struct Parts {
    bounded: Vec<(Bounds3, Primitive, Attributes)>,
    unbounded: Vec<(Primitive, Attributes)>,
    shapes: Vec<Shape>,
    placements: Vec<Placement>,
    object_spaces: Vec<ObjectSpace>,
}

/// Where an object stands: what it inherits from those it is part of.
#[derive(Clone, Copy)]
struct Context {
    space_from_parent: Transform,
    material: u32,
}

impl Compiler<'_> {
    /// Flattens objects into a space of their own; `None` where there is an error among the diagnostics.
    fn space(&mut self, objects: &[Object]) -> Option<Space> {
        let mut parts = Parts::default();
        let context = Context { space_from_parent: Transform::IDENTITY, material: NONE };
        for object in objects {
            self.add(object, context, &mut parts);
        }
        let is_error = |diagnostic: &Diagnostic| diagnostic.severity == Severity::Error;
        if self.diagnostics.iter().any(is_error) {
            return None;
        }
        let space = parts.finish();
        space.map_err(|error| self.diagnostics.push(Diagnostic::error(error.to_string()))).ok()
    }

    fn add(&mut self, object: &Object, context: Context, parts: &mut Parts) {
        let space_from_object = context.space_from_parent * object.parent_from_object;
        let material = object.material.map_or(context.material, |id| id.index() as u32);
        let inner = Context { space_from_parent: space_from_object, material };
        match &object.kind {
            ObjectKind::Group(members) => members.iter().for_each(|member| self.add(member, inner, parts)),
            ObjectKind::Grid(grid) => self.add_grid(grid, inner, parts),
            ObjectKind::Instance(prototype) => self.add_instance(object, *prototype, inner, parts),
            ObjectKind::Shape(scene::Shape::Mesh(mesh)) => self.add_mesh(object, *mesh, inner, parts),
            ObjectKind::Shape(shape) => self.add_shape(object, shape, inner, parts),
            ObjectKind::Csg { .. } => self.add_solid(object, inner, parts),
        }
    }

    fn add_shape(&mut self, object: &Object, description: &scene::Shape, context: Context, parts: &mut Parts) {
        let Some(shape) = Shape::new(description) else { return };
        let Context { space_from_parent: space_from_object, material } = context;
        let mut attributes = self.attributes(object, description_name(description), material, self.is_opaque(material));
        let (shape, placement) = match shape.transformed(&space_from_object) {
            _ if space_from_object.is_identity() => (shape, NONE),
            Some(moved) => {
                attributes.object_space = parts.add_object_space(space_from_object, shape);
                (moved, NONE)
            }
            None => (shape, parts.add_placement(space_from_object)),
        };
        let bounds = shape.bounds();
        let bounds = if placement == NONE { bounds } else { placed_bounds(&space_from_object, &bounds) };
        let primitive = match shape {
            Shape::Sphere(sphere) if placement == NONE => Primitive::Sphere(sphere),
            Shape::Plane(plane) if placement == NONE => Primitive::Plane(plane),
            shape => Primitive::Shape { shape: parts.add_shape(shape), placement },
        };
        parts.push(bounds, primitive, attributes);
    }

    fn add_mesh(&mut self, object: &Object, mesh: Id<scene::Mesh>, context: Context, parts: &mut Parts) {
        let Context { space_from_parent: space_from_object, material } = context;
        let compiled = &self.meshes[mesh.index()];
        let description = &self.scene.meshes[mesh];
        let is_opaque = if material == NONE {
            // A mesh without materials of its own takes those of its instances, which are not known here.
            !description.materials.is_empty() && description.materials.iter().all(|id| !self.transparent[id.index()])
        } else {
            self.is_opaque(material)
        };
        let open_edges = compiled.boundary_edges();
        if !is_opaque && open_edges > 0 {
            let name = object.name.as_deref().unwrap_or(&description.name);
            let message =
                format!("the transparent mesh \"{name}\" is not closed: {open_edges} of its edges have one side only");
            self.diagnostics.push(
                Diagnostic::warning(message)
                    .at_optional(object.span.clone(), "this mesh")
                    .help("light that goes in through a front face stays inside until it leaves through a back face"),
            );
        }
        let mut bounds = compiled.bounds();
        let placement = if space_from_object.is_identity() {
            NONE
        } else {
            bounds = placed_bounds(&space_from_object, &bounds);
            parts.add_placement(space_from_object)
        };
        let attributes = self.attributes(object, &description.name, material, is_opaque);
        let primitive = Primitive::Mesh { mesh: mesh.index() as u32, placement };
        parts.push(bounds, primitive, attributes);
    }

    fn add_solid(&mut self, object: &Object, context: Context, parts: &mut Parts) {
        let Context { space_from_parent: space_from_object, material } = context;
        let mut is_opaque = self.is_opaque(material);
        let mut nodes = Vec::new();
        let solid = match self.add_nodes(object, Transform::IDENTITY, NONE, &mut nodes, &mut is_opaque) {
            Some(_) => CsgSolid::new(nodes).map_err(|error| error.to_string()),
            None => Err("one of its parts is neither a solid nor made of solids".to_owned()),
        };
        let solid = match solid {
            Ok(solid) => solid,
            Err(reason) => {
                let error = Diagnostic::error(format!("this solid cannot be made: {reason}"));
                self.diagnostics.push(error.at_optional(object.span.clone(), "this one"));
                return;
            }
        };
        let bounds = solid.bounds();
        let (bounds, placement) = if space_from_object.is_identity() {
            (bounds, NONE)
        } else {
            (placed_bounds(&space_from_object, &bounds), parts.add_placement(space_from_object))
        };
        let attributes = self.attributes(object, "solid", material, is_opaque);
        let primitive = Primitive::Solid { solid: self.solids.len() as u32, placement };
        self.solids.push(solid);
        parts.push(bounds, primitive, attributes);
    }

    /// Appends the nodes of a solid or of a part of one, children before their parents, and returns the place of the last.
    /// `None` where a part is no solid, which readers refuse. The whole's own transform is left to its primitive.
    fn add_nodes(
        &self,
        object: &Object,
        solid_from_object: Transform,
        inherited_tag: u32,
        nodes: &mut Vec<CsgNode>,
        is_opaque: &mut bool,
    ) -> Option<u32> {
        let mut add_part = |part: &Object, nodes: &mut Vec<CsgNode>| {
            let tag = part.material.map_or(inherited_tag, |id| id.index() as u32);
            self.add_nodes(part, solid_from_object * part.parent_from_object, tag, nodes, is_opaque)
        };
        let node = match &object.kind {
            ObjectKind::Shape(shape) => {
                let shape = Shape::new(shape)?;
                if inherited_tag != NONE {
                    *is_opaque &= !self.transparent[inherited_tag as usize];
                }
                let (shape, solid_from_leaf) = match shape.transformed(&solid_from_object) {
                    Some(moved) => (moved, None),
                    None => (shape, Some(solid_from_object)),
                };
                CsgNode::Leaf { shape, solid_from_leaf, tag: inherited_tag }
            }
            ObjectKind::Csg { operation, parts } => {
                let children = parts.iter().map(|part| add_part(part, nodes)).collect::<Option<_>>()?;
                CsgNode::Operation { operation: *operation, children }
            }
            ObjectKind::Group(members) => match members.as_slice() {
                [member] => return add_part(member, nodes),
                _ => return None,
            },
            ObjectKind::Instance(_) | ObjectKind::Grid(_) => return None,
        };
        nodes.push(node);
        Some(nodes.len() as u32 - 1)
    }

    fn add_instance(&mut self, object: &Object, id: Id<scene::Prototype>, context: Context, parts: &mut Parts) {
        let prototype = &self.scene.prototypes[id];
        // A prototype that is still being compiled, and so is not in the list yet, cannot be referred to.
        let Some(space) = self.prototypes.get(id.index()) else { return };
        let has_instances = space.primitives.iter().any(|p| matches!(p, Primitive::Instance { .. }));
        let is_nested = self.prototypes.len() < self.scene.prototypes.len();
        if has_instances || is_nested || space.primitives.len() as u64 <= COPIED_PROTOTYPE {
            // Two levels and no more: within a prototype, instances are copied.
            prototype.objects.iter().for_each(|member| self.add(member, context, parts));
            return;
        }
        let Context { space_from_parent: space_from_object, material } = context;
        let bounds = placed_bounds(&space_from_object, &space.total_bounds());
        let is_opaque = space.attributes.iter().all(|attributes| attributes.is_opaque) && self.is_opaque(material);
        let attributes = self.attributes(object, &prototype.name, material, is_opaque);
        let placement = parts.add_placement(space_from_object);
        let primitive = Primitive::Instance { prototype: id.index() as u32, placement, material };
        parts.push(bounds, primitive, attributes);
    }

    fn add_grid(&mut self, grid: &scene::Grid, context: Context, parts: &mut Parts) {
        // All copies count as the one object that the author described.
        let first_object = self.next_object;
        let [columns, rows, layers] = grid.count;
        for k in 0..layers {
            for j in 0..rows {
                for i in 0..columns {
                    self.next_object = first_object;
                    let offset =
                        grid.step[0] * f64::from(i) + grid.step[1] * f64::from(j) + grid.step[2] * f64::from(k);
                    let space_from_parent = context.space_from_parent * Transform::translate(offset);
                    self.add(&grid.of, Context { space_from_parent, ..context }, parts);
                }
            }
        }
    }

    fn is_opaque(&self, material: u32) -> bool {
        // Without a material it is the plain one, unless an instance brings another: then the instance's flag tells.
        material != NONE && !self.transparent[material as usize]
    }

    fn attributes(&mut self, object: &Object, kind: &str, material: u32, is_opaque: bool) -> Attributes {
        let number = self.next_object;
        self.next_object += 1;
        if number as usize == self.names.len() {
            self.names.push(object.name.clone().unwrap_or_else(|| format!("{kind} {}", number + 1)));
        }
        Attributes { object: number, material, object_space: NONE, is_opaque }
    }
}

impl Parts {
    fn push(&mut self, bounds: Bounds3, primitive: Primitive, attributes: Attributes) {
        if bounds.is_finite() {
            self.bounded.push((bounds, primitive, attributes));
        } else if !bounds.is_empty() {
            self.unbounded.push((primitive, attributes));
        }
    }

    fn add_shape(&mut self, shape: Shape) -> u32 {
        self.shapes.push(shape);
        self.shapes.len() as u32 - 1
    }

    fn add_placement(&mut self, space_from_object: Transform) -> u32 {
        self.placements.push(Placement::new(space_from_object));
        self.placements.len() as u32 - 1
    }

    fn add_object_space(&mut self, space_from_object: Transform, shape: Shape) -> u32 {
        self.object_spaces.push(ObjectSpace { placement: Placement::new(space_from_object), shape });
        self.object_spaces.len() as u32 - 1
    }

    fn finish(self) -> Result<Space, BuildError> {
        let count = self.bounded.len() + self.unbounded.len();
        let (mut primitives, mut attributes) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let mut bounds = Vec::with_capacity(self.bounded.len());
        for (b, primitive, attribute) in self.bounded {
            bounds.push(b);
            primitives.push(primitive);
            attributes.push(attribute);
        }
        for (primitive, attribute) in self.unbounded {
            primitives.push(primitive);
            attributes.push(attribute);
        }
        let Self { shapes, placements, object_spaces, .. } = self;
        Space::new(primitives, attributes, bounds, shapes, placements, object_spaces)
    }
}

/// The box of a placed box, grown by what rounding may have moved.
fn placed_bounds(space_from_object: &Transform, bounds: &Bounds3) -> Bounds3 {
    if !bounds.is_finite() {
        return if bounds.is_empty() { Bounds3::EMPTY } else { Bounds3::EVERYTHING };
    }
    let placed = space_from_object.bounds(bounds);
    placed.grown(1e-14 * placed.min.max_abs().max(placed.max.max_abs()))
}

fn description_name(shape: &scene::Shape) -> &'static str {
    match shape {
        scene::Shape::Sphere { .. } => "sphere",
        scene::Shape::Plane { .. } => "plane",
        scene::Shape::Disk { .. } => "disk",
        scene::Shape::Rectangle { .. } => "rectangle",
        scene::Shape::Box { .. } => "box",
        scene::Shape::Cylinder { .. } => "cylinder",
        scene::Shape::Cone { .. } => "cone",
        scene::Shape::Torus { .. } => "torus",
        scene::Shape::Mesh(_) => "mesh",
    }
}
