//! Objects: what they are, where they stand, of what they are made.

use snell_math::{Transform, Vector3};

use super::Resolver;
use super::size::Size;
use crate::diagnostic::Span;
use crate::document::model::{self, Either, Located, Named, Step};
use crate::scene::{CsgOperation, Grid, Object, ObjectKind, Prototype, Shape};
use crate::table::Id;

/// What an object stands in.
#[derive(Clone, Copy)]
struct Surroundings {
    /// Whether what it is part of will give it a material.
    has_material: bool,
    world_from_parent: Transform,
    /// That map cannot be computed with.
    is_out_of_range: bool,
}

impl Surroundings {
    /// Nothing around.
    fn none(has_material: bool) -> Self {
        Self { has_material, world_from_parent: Transform::IDENTITY, is_out_of_range: false }
    }
}

impl Resolver<'_> {
    /// All prototypes, each after those that it places.
    pub(super) fn named_prototypes(&mut self, mut named: Named<model::Object>) {
        let (_, order) = self.in_order(&named, "prototype", "contains itself", references);
        let mut sizes = Vec::new();
        for i in order {
            let (name, object) = &mut named.0[i];
            let object = std::mem::take(object);
            // Whatever it is placed as gives the material and the place.
            let object = self.object(object, Surroundings::none(true));
            let size = Size::of(&object, &sizes);
            self.check_size(size, &name.span, || format!("the prototype {:?}", name.value));
            sizes.push(size);
            let prototype = Prototype { name: name.value.clone(), objects: vec![object] };
            let id = self.scene.prototypes.push(prototype);
            self.prototypes.insert(name.value.clone(), id);
        }
    }

    /// The objects in the scene.
    pub(super) fn world(&mut self, objects: Vec<Located<model::Object>>) {
        let mut sizes = Vec::new();
        for (_, prototype) in self.scene.prototypes.enumerate() {
            let size = Size::of_all(&prototype.objects, &sizes);
            sizes.push(size);
        }
        let mut total = Size::default();
        for located in objects {
            let object = self.object(located, Surroundings::none(false));
            let size = Size::of(&object, &sizes);
            let name = || object.name.as_ref().map_or("this object".to_owned(), |name| format!("the object {name:?}"));
            if !self.check_size(size, &object.span, name) {
                continue;
            }
            total = total.and(size);
            self.scene.objects.push(object);
        }
        self.check_size(total, &None, || "the scene".to_owned());
    }

    fn check_size(&mut self, size: Size, span: &Option<Span>, what: impl FnOnce() -> String) -> bool {
        match size.excess() {
            Some(excess) => {
                self.error(span, format!("{} {excess}", what()), "too much");
                false
            }
            None => true,
        }
    }

    fn object(&mut self, located: Located<model::Object>, around: Surroundings) -> Object {
        let Located { value: mut object, span } = located;
        let mut parent_from_object =
            self.placement(object.scale.as_deref(), object.rotate.as_deref(), object.translate);
        let Surroundings { mut world_from_parent, mut is_out_of_range, .. } = around;
        if !parent_from_object.is_identity() {
            world_from_parent = world_from_parent * parent_from_object;
            is_out_of_range = Transform::from_affine(*world_from_parent.affine()).is_none();
        }
        if is_out_of_range {
            let message = "all the scales around this object together make it too large or too small";
            self.error(&span, message, "placed here");
        }
        let mut material = object.material.as_ref().map(|choice| self.chosen_material(choice));
        let inner = Surroundings {
            has_material: around.has_material || material.is_some(),
            world_from_parent,
            is_out_of_range,
        };
        let kind = if let Some(parts) = object.union.take() {
            self.solid(CsgOperation::Union, *parts, inner)
        } else if let Some(parts) = object.intersection.take() {
            self.solid(CsgOperation::Intersection, *parts, inner)
        } else if let Some(parts) = object.difference.take() {
            self.solid(CsgOperation::Difference, *parts, inner)
        } else if let Some(parts) = object.group.take() {
            ObjectKind::Group(parts.into_iter().map(|part| self.object(part, inner)).collect())
        } else if let Some(name) = &object.instance {
            // A name that is missing here was left out for its own mistakes.
            ObjectKind::Instance(self.prototypes.get(&name.value.0).copied().unwrap_or(Id::from_index(0)))
        } else if let Some(grid) = object.grid.take() {
            self.grid(*grid, inner)
        } else if let Some(mesh) = &object.mesh {
            let name = object.name.as_ref().map(|name| &*name.value);
            let (mesh, fit) = self.mesh(mesh, name);
            parent_from_object = parent_from_object * fit;
            ObjectKind::Shape(Shape::Mesh(mesh))
        } else if let Some(lens) = &object.lens {
            self.lens(lens)
        } else {
            ObjectKind::Shape(self.shape(&object, &span))
        };
        if !inner.has_material && self.needs_material(&kind) {
            material = Some(self.default_material());
        }
        Object { name: object.name.map(|name| name.value), material, parent_from_object, kind, span }
    }

    /// True for what has a surface itself: the parts of groups and grids have been given their own.
    fn needs_material(&self, kind: &ObjectKind) -> bool {
        match kind {
            ObjectKind::Group(_) | ObjectKind::Grid(_) => false,
            ObjectKind::Shape(Shape::Mesh(mesh)) => {
                self.scene.meshes.iter().nth(mesh.index()).is_none_or(|mesh| mesh.materials.is_empty())
            }
            ObjectKind::Shape(_) | ObjectKind::Csg { .. } | ObjectKind::Instance(_) => true,
        }
    }

    fn grid(&mut self, grid: Located<model::Grid>, inner: Surroundings) -> ObjectKind {
        let model::Grid { count, step, of } = grid.value;
        let step: [Vector3; 3] = match step {
            Step::A([x, y, z]) => [Vector3::X * x, Vector3::Y * y, Vector3::Z * z],
            Either::B(vectors) => [vectors.x.into(), vectors.y.into(), vectors.z.into()],
        };
        for i in 0..3 {
            if count.value[i] > 1 && step[i] == Vector3::ZERO {
                let message = format!("the grid's {} copies {} stand in the same place", count.value[i], AXES[i]);
                self.error(&count.span, message, "with a step of 0");
            }
        }
        ObjectKind::Grid(Grid { count: count.value, step, of: Box::new(self.object(of, inner)) })
    }

    fn solid(
        &mut self,
        operation: CsgOperation,
        parts: Located<Vec<Located<model::Object>>>,
        inner: Surroundings,
    ) -> ObjectKind {
        if parts.value.is_empty() {
            let word = match operation {
                CsgOperation::Union => "union",
                CsgOperation::Intersection => "intersection",
                CsgOperation::Difference => "difference",
            };
            self.error(&parts.span, format!("the {word} has no parts"), "at least one is needed");
        }
        // The whole has a material for the surfaces of those parts that have none.
        let inner = Surroundings { has_material: true, ..inner };
        let mut solids = Vec::with_capacity(parts.value.len());
        for part in parts.value {
            let object = self.object(part, inner);
            if let Err(why) = is_solid(&object) {
                self.error(&object.span, format!("{why} has no inside and cannot be a part of a solid"), "not solid");
            }
            solids.push(object);
        }
        ObjectKind::Csg { operation, parts: solids }
    }
}

const AXES: [&str; 3] = ["in the first direction", "in the second direction", "in the third direction"];

/// Whether an object has an inside; if not, what has none.
fn is_solid(object: &Object) -> Result<(), &'static str> {
    match &object.kind {
        ObjectKind::Csg { .. } => Ok(()),
        ObjectKind::Group(parts) => match parts.as_slice() {
            [only] => is_solid(only),
            [] => Err("an empty group"),
            _ => Err("a group of several objects (write `union`)"),
        },
        ObjectKind::Instance(_) => Err("an instance"),
        ObjectKind::Grid(_) => Err("a grid"),
        ObjectKind::Shape(shape) => match shape {
            Shape::Sphere { .. } | Shape::Plane { .. } | Shape::Box { .. } | Shape::Torus { .. } => Ok(()),
            Shape::Cylinder { capped: true, .. } | Shape::Cone { capped: true, .. } => Ok(()),
            Shape::Cylinder { .. } => Err("a cylinder that is not `capped`"),
            Shape::Cone { .. } => Err("a cone that is not `capped`"),
            Shape::Disk { .. } => Err("a disk"),
            Shape::Rectangle { .. } => Err("a rectangle"),
            Shape::Mesh(_) => Err("a mesh"),
        },
    }
}

/// The names of the prototypes that an object places.
fn references<'a>(object: &'a model::Object, names: &mut Vec<&'a str>) {
    names.extend(object.instance.iter().map(|name| &*name.value.0));
    let solids = [&object.union, &object.intersection, &object.difference];
    for part in solids.into_iter().flatten().flat_map(|parts| &parts.value).chain(object.group.iter().flatten()) {
        references(&part.value, names);
    }
    if let Some(grid) = &object.grid {
        references(&grid.value.of.value, names);
    }
}
