//! How many primitives a scene asks for, before any of them is made: grids in grids and prototypes in prototypes can ask
//! for any number in a few lines.

use snell_scene::Diagnostic;
use snell_scene::scene::{Object, ObjectKind, Scene};

/// A prototype of no more primitives than this is copied where it stands: finding them in a hierarchy of their own would
/// cost more than the copies.
pub const COPIED_PROTOTYPE: u64 = 4;
/// More primitives than this are refused.
const MAX_PRIMITIVES: u64 = 20_000_000;

/// The error of a scene that asks for too many.
pub fn refuse_too_many(scene: &Scene) -> Option<Diagnostic> {
    let mut total: u64 = 0;
    let mut prototypes = Vec::with_capacity(scene.prototypes.len());
    for prototype in scene.prototypes.iter() {
        // Two levels and no more: within a prototype, instances are copied.
        let whole = |id: usize| prototypes.get(id).copied().unwrap_or(0);
        let before = total;
        for object in &prototype.objects {
            total = total.saturating_add(count(object, &whole));
            if total > MAX_PRIMITIVES {
                return Some(error(object));
            }
        }
        prototypes.push(total - before);
    }
    let one = |id: usize| prototypes.get(id).map_or(0, |&size| if size <= COPIED_PROTOTYPE { size } else { 1 });
    for object in &scene.objects {
        total = total.saturating_add(count(object, &one));
        if total > MAX_PRIMITIVES {
            return Some(error(object));
        }
    }
    None
}

fn error(object: &Object) -> Diagnostic {
    Diagnostic::error(format!("the scene has more than {MAX_PRIMITIVES} objects, counting copies"))
        .at_optional(object.span.clone(), "reached here")
}

/// The primitives of an object, where an instance of a prototype has as many as `instance` says.
fn count(object: &Object, instance: &impl Fn(usize) -> u64) -> u64 {
    match &object.kind {
        ObjectKind::Shape(_) | ObjectKind::Csg { .. } => 1,
        ObjectKind::Group(members) => {
            members.iter().fold(0, |sum: u64, member| sum.saturating_add(count(member, instance)))
        }
        ObjectKind::Grid(grid) => {
            grid.count.into_iter().fold(count(&grid.of, instance), |product, n| product.saturating_mul(n.into()))
        }
        ObjectKind::Instance(prototype) => instance(prototype.index()),
    }
}
