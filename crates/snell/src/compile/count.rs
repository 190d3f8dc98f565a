//! How many primitives a scene asks for, before any of them is made, and which of its prototypes are made once and shared:
//! grids in grids and prototypes in prototypes can ask for any number in a few lines.

use snell_scene::scene::{Object, ObjectKind, Prototype, Scene, Shape};
use snell_scene::{Diagnostic, Id};

/// A prototype of no more primitives than this is copied where it stands: finding them in a hierarchy of their own would
/// cost more than the copies.
const COPIED_PROTOTYPE: u64 = 4;
/// More primitives than this are refused.
const MAX_PRIMITIVES: u64 = 20_000_000;

/// What becomes of a scene's prototypes.
#[derive(Debug)]
pub struct Plan {
    prototypes: Vec<Use>,
    /// Primitives in the world, a shared prototype counted as one.
    pub in_world: usize,
}

/// What there is to know of a prototype.
#[derive(Clone, Copy, Debug)]
struct Use {
    /// Its primitives, those of prototypes within it counted.
    size: u64,
    /// How often it stands in the world itself, not within another prototype.
    placed: u64,
    has_mesh: bool,
    /// Other prototypes stand in it.
    is_nest: bool,
}

impl Use {
    /// True where it is made once, with a hierarchy of its own, for all its places in the world. A nest of others that stands
    /// in one place only is no more than a part of the world, unless it has meshes: to these, the material of an instance is
    /// less than that of a group.
    fn is_shared(&self) -> bool {
        let is_part = self.placed == 1 && self.is_nest && !self.has_mesh;
        self.size > COPIED_PROTOTYPE && self.placed > 0 && !is_part
    }
}

impl Plan {
    /// For a scene; or the error of one that asks for too many primitives.
    pub fn new(scene: &Scene) -> Result<Self, Box<Diagnostic>> {
        let mut plan = Self { prototypes: Vec::with_capacity(scene.prototypes.len()), in_world: 0 };
        for prototype in scene.prototypes.iter() {
            // Two levels and no more: within a prototype, instances are copied.
            let prototypes = &plan.prototypes;
            let part = |id: Id<Prototype>| prototypes.get(id.index());
            let size = |id| part(id).map_or(0, |part| part.size);
            let own = Use {
                size: prototype.objects.iter().fold(0, |sum: u64, object| sum.saturating_add(count(object, &size))),
                placed: 0,
                has_mesh: any(&prototype.objects, &|object| match &object.kind {
                    ObjectKind::Shape(shape) => matches!(shape, Shape::Mesh(_)),
                    ObjectKind::Instance(id) => part(*id).is_some_and(|part| part.has_mesh),
                    _ => false,
                }),
                is_nest: any(&prototype.objects, &|object| matches!(object.kind, ObjectKind::Instance(_))),
            };
            plan.prototypes.push(own);
        }
        for object in &scene.objects {
            count_places(object, 1, &mut plan.prototypes);
        }

        let mut total: u64 = 0;
        let mut add = |count: u64, object: &Object| {
            total = total.saturating_add(count);
            if total > MAX_PRIMITIVES { Err(error(object)) } else { Ok(total) }
        };
        for (prototype, plan) in scene.prototypes.iter().zip(&plan.prototypes) {
            if let (true, Some(first)) = (plan.is_shared(), prototype.objects.first()) {
                add(plan.size, first)?;
            }
        }
        let mut in_world: u64 = 0;
        for object in &scene.objects {
            let size = |id: Id<Prototype>| {
                plan.prototypes.get(id.index()).map_or(0, |part| if part.is_shared() { 1 } else { part.size })
            };
            let count = count(object, &size);
            add(count, object)?;
            in_world = in_world.saturating_add(count);
        }
        plan.in_world = in_world as usize;
        Ok(plan)
    }

    /// True where a prototype is made once for all its places in the world.
    pub fn is_shared(&self, prototype: Id<Prototype>) -> bool {
        self.prototypes.get(prototype.index()).is_some_and(Use::is_shared)
    }

    /// How many primitives a prototype has, those within it counted.
    pub fn size(&self, prototype: Id<Prototype>) -> usize {
        self.prototypes.get(prototype.index()).map_or(0, |part| part.size as usize)
    }
}

fn error(object: &Object) -> Box<Diagnostic> {
    let message = format!("the scene has more than {MAX_PRIMITIVES} objects, counting copies");
    Box::new(Diagnostic::error(message).at_optional(object.span.clone(), "reached here"))
}

/// The primitives of an object, where an instance of a prototype has as many as `instance` says.
fn count(object: &Object, instance: &impl Fn(Id<Prototype>) -> u64) -> u64 {
    match &object.kind {
        ObjectKind::Shape(_) | ObjectKind::Csg { .. } => 1,
        ObjectKind::Group(members) => {
            members.iter().fold(0, |sum: u64, member| sum.saturating_add(count(member, instance)))
        }
        ObjectKind::Grid(grid) => copies(grid.count, count(&grid.of, instance)),
        ObjectKind::Instance(prototype) => instance(*prototype),
    }
}

/// Adds to each prototype how often an object that stands in `times` places itself places it.
fn count_places(object: &Object, times: u64, prototypes: &mut [Use]) {
    match &object.kind {
        ObjectKind::Shape(_) | ObjectKind::Csg { .. } => {}
        ObjectKind::Group(members) => members.iter().for_each(|member| count_places(member, times, prototypes)),
        ObjectKind::Grid(grid) => count_places(&grid.of, copies(grid.count, times), prototypes),
        ObjectKind::Instance(id) => {
            if let Some(prototype) = prototypes.get_mut(id.index()) {
                prototype.placed = prototype.placed.saturating_add(times);
            }
        }
    }
}

fn copies(count: [u32; 3], of: u64) -> u64 {
    count.into_iter().fold(of, |product, n| product.saturating_mul(n.into()))
}

/// Whether something is true of any of these objects or of what is in them; solids and instances are one object.
fn any(objects: &[Object], is: &impl Fn(&Object) -> bool) -> bool {
    objects.iter().any(|object| {
        is(object)
            || match &object.kind {
                ObjectKind::Group(members) => any(members, is),
                ObjectKind::Grid(grid) => any(std::slice::from_ref(&grid.of), is),
                ObjectKind::Shape(_) | ObjectKind::Csg { .. } | ObjectKind::Instance(_) => false,
            }
    })
}
