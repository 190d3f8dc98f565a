//! Flattening the objects of a scene into primitives, and building what they are found by.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;
use snell_math::{Bounds3, Transform};
use snell_scene::scene::{self, Object, ObjectKind, Scene};
use snell_scene::{Diagnostic, Id, Span};

use super::count::Plan;
use super::names::ObjectNames;
use crate::accel::{BuildError, BuildQuality};
use crate::csg::{CsgNode, CsgSolid};
use crate::geometry::{Attributes, Geometry, NONE, ObjectSpace, Placement, Primitive, Space};
use crate::material::Material;
use crate::shape::Shape;
use crate::shape::triangle_mesh::TriangleMesh;
use crate::texture::{Spaces, Textures};

/// What the objects of a scene become.
pub struct Compiled {
    /// What rays can meet.
    pub geometry: Geometry,
    /// What objects are called.
    pub names: ObjectNames,
    /// Where the scene says so, by the numbers of transparent ones.
    pub body_spans: BTreeMap<u32, Span>,
}

/// Compiles all objects of a scene, with their names. `materials` is the scene's list with the one for objects without
/// material at its end. `None` where there is an error among the diagnostics.
pub fn compile(
    scene: &Scene,
    materials: &[Material],
    textures: &Textures,
    quality: BuildQuality,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<Compiled> {
    let plan = Plan::new(scene).map_err(|error| diagnostics.push(*error)).ok()?;
    let descriptions: Vec<&scene::Mesh> = scene.meshes.iter().collect();
    let compiled: Vec<Result<TriangleMesh, _>> =
        descriptions.par_iter().map(|mesh| TriangleMesh::with_quality(mesh, quality)).collect();
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
    let spaces: Vec<Spaces> = materials.iter().map(|material| material.spaces(textures)).collect();
    let mut compiler = Compiler {
        scene,
        meshes: &meshes,
        transparent: &transparent,
        spaces: &spaces,
        quality,
        prototypes: Vec::new(),
        places: Vec::with_capacity(scene.prototypes.len()),
        solids: Vec::new(),
        names: ObjectNames::default(),
        body_spans: BTreeMap::new(),
        next_object: 0,
        warned: BTreeSet::new(),
        failed: false,
        diagnostics,
    };
    for (id, prototype) in scene.prototypes.enumerate() {
        if plan.is_shared(id) {
            let space = compiler.space(&prototype.objects, id.index(), plan.size(id))?;
            compiler.places.push(compiler.prototypes.len() as u32);
            compiler.prototypes.push(space);
        } else {
            // Told once and not with every copy, nor only where there is one.
            prototype.objects.iter().for_each(|object| compiler.check_solids(object));
            compiler.places.push(NONE);
        }
    }
    if compiler.failed {
        return None;
    }
    let world = compiler.space(&scene.objects, scene.prototypes.len(), plan.in_world)?;
    let Compiler { prototypes, solids, names, body_spans, .. } = compiler;
    let mesh_materials =
        scene.meshes.iter().map(|mesh| mesh.materials.iter().map(|id| id.index() as u32).collect()).collect();
    let default_material = materials.len() as u32 - 1;
    let geometry =
        Geometry { world, prototypes, meshes, mesh_materials, solids, transparent, spaces, default_material };
    Some(Compiled { geometry, names, body_spans })
}

struct Compiler<'a> {
    scene: &'a Scene,
    meshes: &'a [TriangleMesh],
    /// For each material, whether light goes through it.
    transparent: &'a [bool],
    /// For each material, which coordinates of a hit it looks at.
    spaces: &'a [Spaces],
    quality: BuildQuality,
    /// Those that are shared.
    prototypes: Vec<Space>,
    /// For each prototype of the scene its place among the shared ones, or [`NONE`].
    places: Vec<u32>,
    solids: Vec<CsgSolid>,
    names: ObjectNames,
    body_spans: BTreeMap<u32, Span>,
    next_object: u32,
    /// Objects of which a warning was told: one for all copies. By their places in memory, which do not change meanwhile.
    warned: BTreeSet<*const Object>,
    /// There is an error among the diagnostics.
    failed: bool,
    diagnostics: &'a mut Vec<Diagnostic>,
}

/// A space in the making. Attributes come first for those with bounds and then, once they are complete, for the others.
#[derive(Default)]
struct Parts {
    primitives: Vec<Primitive>,
    attributes: Vec<Attributes>,
    bounds: Vec<Bounds3>,
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
    /// Prototypes before this one may be placed here; in the world itself all.
    before: usize,
}

impl Compiler<'_> {
    /// Flattens `count` objects into a space of their own, with prototypes before the one given; `None` where there is an error
    /// among the diagnostics.
    fn space(&mut self, objects: &[Object], before: usize, count: usize) -> Option<Space> {
        let mut parts = Parts::with_capacity(count);
        let context = Context { space_from_parent: Transform::IDENTITY, material: NONE, before };
        for object in objects {
            self.add(object, context, &mut parts);
        }
        if self.failed {
            return None;
        }
        let space = parts.finish(self.quality);
        space.map_err(|error| self.fail(Diagnostic::error(error.to_string()))).ok()
    }

    fn fail(&mut self, error: Diagnostic) {
        self.failed = true;
        self.diagnostics.push(error);
    }

    fn add(&mut self, object: &Object, context: Context, parts: &mut Parts) {
        let space_from_object = context.space_from_parent * object.parent_from_object;
        let material = object.material.map_or(context.material, |id| id.index() as u32);
        let inner = Context { space_from_parent: space_from_object, material, ..context };
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
        let Context { space_from_parent: space_from_object, material, .. } = context;
        let is_opaque = self.is_opaque(material);
        let mut attributes = self.attributes(object, || description_name(description).into(), material, is_opaque);
        let (shape, placement) = if space_from_object.is_identity() {
            (shape, NONE)
        } else if let Some(moved) = shape.transformed(&space_from_object) {
            if self.looks_at_object(material) {
                attributes.object_space = parts.add_object_space(space_from_object, shape);
            }
            (moved, NONE)
        } else {
            (shape, parts.add_placement(space_from_object))
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
        let Context { space_from_parent: space_from_object, material, .. } = context;
        let compiled = &self.meshes[mesh.index()];
        let description = &self.scene.meshes[mesh];
        let is_opaque = if material == NONE {
            // A mesh without materials of its own takes those of its instances, which are not known here.
            !description.materials.is_empty() && description.materials.iter().all(|id| !self.transparent[id.index()])
        } else {
            self.is_opaque(material)
        };
        // Light does not go into what is opaque.
        let open_edges = if is_opaque { 0 } else { compiled.boundary_edges() };
        if !is_opaque && open_edges > 0 && self.warned.insert(std::ptr::from_ref(object)) {
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
        if !is_opaque
            && open_edges == 0
            && compiled.signed_volume() < 0.0
            && self.warned.insert(std::ptr::from_ref(object))
        {
            let name = object.name.as_deref().unwrap_or(&description.name);
            let message = format!("the transparent mesh \"{name}\" is inside out: its faces look inwards");
            self.diagnostics.push(Diagnostic::warning(message).at_optional(object.span.clone(), "this mesh").help(
                "a ray that goes into it is taken to leave it, and is in it where it has come out; list the corners of each face \
                 counter-clockwise as they are seen from outside",
            ));
        }
        let placement = if space_from_object.is_identity() {
            NONE
        } else {
            bounds = placed_bounds(&space_from_object, &bounds);
            parts.add_placement(space_from_object)
        };
        let attributes = self.attributes(object, || description.name.clone().into(), material, is_opaque);
        let primitive = Primitive::Mesh { mesh: mesh.index() as u32, placement };
        parts.push(bounds, primitive, attributes);
    }

    fn add_solid(&mut self, object: &Object, context: Context, parts: &mut Parts) {
        let Context { space_from_parent: space_from_object, material, .. } = context;
        let mut is_opaque = self.is_opaque(material);
        let Some(solid) = self.solid(object, &mut is_opaque) else { return };
        let bounds = solid.bounds();
        let (bounds, placement) = if space_from_object.is_identity() {
            (bounds, NONE)
        } else {
            (placed_bounds(&space_from_object, &bounds), parts.add_placement(space_from_object))
        };
        let attributes = self.attributes(object, || "solid".into(), material, is_opaque);
        let primitive = Primitive::Solid { solid: self.solids.len() as u32, placement };
        self.solids.push(solid);
        parts.push(bounds, primitive, attributes);
    }

    /// A solid in its own space; `None` where it cannot be made, which is told. Sets `is_opaque` to false where a part is not.
    fn solid(&mut self, object: &Object, is_opaque: &mut bool) -> Option<CsgSolid> {
        let mut nodes = Vec::new();
        let solid = match self.add_nodes(object, Transform::IDENTITY, NONE, &mut nodes, is_opaque) {
            Some(_) => CsgSolid::new(nodes).map_err(|error| error.to_string()),
            None => Err("one of its parts is neither a solid nor made of solids".to_owned()),
        };
        let error = |reason| {
            let error = Diagnostic::error(format!("this solid cannot be made: {reason}"));
            self.fail(error.at_optional(object.span.clone(), "this one"));
        };
        solid.map_err(error).ok()
    }

    /// Tells of solids in an object that cannot be made.
    fn check_solids(&mut self, object: &Object) {
        match &object.kind {
            ObjectKind::Csg { .. } => _ = self.solid(object, &mut true),
            ObjectKind::Group(members) => members.iter().for_each(|member| self.check_solids(member)),
            ObjectKind::Grid(grid) => self.check_solids(&grid.of),
            ObjectKind::Shape(_) | ObjectKind::Instance(_) => {}
        }
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
        // One only refers to those before it.
        if id.index() >= context.before {
            return;
        }
        let prototype = &self.scene.prototypes[id];
        let is_nested = context.before < self.scene.prototypes.len();
        let place = self.places.get(id.index()).copied().unwrap_or(NONE);
        let Some(space) = self.prototypes.get(place as usize).filter(|_| !is_nested) else {
            // Two levels and no more: within a prototype, instances are copied.
            let context = Context { before: id.index(), ..context };
            prototype.objects.iter().for_each(|member| self.add(member, context, parts));
            return;
        };
        let Context { space_from_parent: space_from_object, material, .. } = context;
        let bounds = placed_bounds(&space_from_object, &space.total_bounds());
        let is_opaque = space.attributes.iter().all(|attributes| attributes.is_opaque) && self.is_opaque(material);
        let attributes = self.attributes(object, || prototype.name.clone().into(), material, is_opaque);
        let placement = parts.add_placement(space_from_object);
        let primitive = Primitive::Instance { prototype: place, placement, material };
        parts.push(bounds, primitive, attributes);
    }

    fn add_grid(&mut self, grid: &scene::Grid, context: Context, parts: &mut Parts) {
        // All copies count as the one object that the author described.
        let first_object = self.next_object;
        let [columns, rows, layers] = grid.count;
        for k in 0..layers {
            for j in 0..rows {
                for i in 0..columns {
                    if self.failed {
                        return;
                    }
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

    /// True where what has a material must be found again in its object's own space. Without one, an instance may bring any.
    fn looks_at_object(&self, material: u32) -> bool {
        material == NONE || self.spaces.get(material as usize).is_none_or(|spaces| spaces.object || spaces.uv)
    }

    /// Of the next object, which is called after its kind and number unless it has a name.
    fn attributes(
        &mut self,
        object: &Object,
        kind: impl FnOnce() -> Cow<'static, str>,
        material: u32,
        is_opaque: bool,
    ) -> Attributes {
        let number = self.next_object;
        self.next_object += 1;
        if number as usize == self.names.len() {
            self.names.push(object.name.as_deref(), kind);
            if let Some(span) = object.span.clone().filter(|_| !is_opaque && material != NONE) {
                self.body_spans.insert(number, span);
            }
        }
        Attributes { object: number, material, object_space: NONE, is_opaque }
    }
}

impl Parts {
    fn with_capacity(count: usize) -> Self {
        Self {
            primitives: Vec::with_capacity(count),
            attributes: Vec::with_capacity(count),
            bounds: Vec::with_capacity(count),
            ..Self::default()
        }
    }

    fn push(&mut self, bounds: Bounds3, primitive: Primitive, attributes: Attributes) {
        if bounds.is_finite() {
            self.primitives.push(primitive);
            self.attributes.push(attributes);
            self.bounds.push(bounds);
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

    fn finish(mut self, quality: BuildQuality) -> Result<Space, BuildError> {
        for (primitive, attributes) in self.unbounded {
            self.primitives.push(primitive);
            self.attributes.push(attributes);
        }
        let Self { primitives, attributes, bounds, shapes, placements, object_spaces, .. } = self;
        Space::new(primitives, attributes, bounds, shapes, placements, object_spaces, quality)
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
