//! Transparent bodies that cross each other, and none of which has priority: what `snell check` tells of.
//!
//! Where such bodies overlap, a ray is in the one that it entered last, so that the same place is glass to one ray and water to
//! another. Bodies of which one is wholly within the other, as a bubble is in glass, are meant to be so, and so are bodies that only
//! touch. Which it is, is found by lines through the box that both share: the stretches of a line in one body, in the other and in both
//! are exact; if all three exist, the surfaces cross. What no line meets, such as a sliver at one edge, is not found.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use snell_math::sampler::Sampler;
use snell_math::warp::uniform_sphere;
use snell_math::{Bounds3, Ray, Vector3};
use snell_scene::Diagnostic;

use super::CompiledScene;
use crate::csg::CsgScratch;
use crate::geometry::{Form, WorldSurface};

/// Lines for each pair of bodies.
const LINES: u32 = 256;
/// Stretches shorter than this share of the shared box are taken for rounding.
const SHORTEST: f64 = 1e-6;
/// So many bodies are compared with each other at most, and so many pairs are told.
const MOST_BODIES: usize = 4096;
const MOST_TOLD: usize = 20;

/// A place where a line passes into a body or out of it.
#[derive(Clone, Copy, Debug)]
struct Passage {
    t: f64,
    body: usize,
    entering: bool,
}

/// Warnings of transparent bodies that cross without one having priority over the other.
///
/// ```
/// use snell::compile::{CompiledScene, overlapping_bodies};
/// use snell::scene::{assets::MemoryAssets, document::read_scene};
/// let scene = |x: f64| {
///     let text = format!(
///         "[material.a]\ndielectric = {{}}\n[material.b]\ndielectric = {{ ior = 1.33 }}\n\
///          [[object]]\nsphere = {{}}\nmaterial = 'a'\n\
///          [[object]]\nsphere = {{ center = [{x}, 0, 0], radius = 0.5 }}\nmaterial = 'b'\n"
///     );
///     let scene = read_scene("a.toml", text.as_bytes(), &MemoryAssets::default(), &[]).0.unwrap();
///     CompiledScene::build(&scene).unwrap()
/// };
/// assert_eq!(overlapping_bodies(&scene(1.0)).len(), 1);
/// // A bubble in the ball, one beside it, and one that touches it.
/// assert!([0.2, 1.7, 1.5].iter().all(|x| overlapping_bodies(&scene(*x)).is_empty()));
/// ```
pub fn overlapping_bodies(scene: &CompiledScene) -> Vec<Diagnostic> {
    let mut bodies: Vec<WorldSurface<'_>> = scene.geometry.world_surfaces();
    bodies.retain(|surface| {
        scene.materials[surface.material as usize].body.is_some()
            && match surface.form {
                Form::Shape(shape) => shape.is_solid(),
                Form::Solid(_) => true,
                // Of an open one it is not known what is inside, which is told elsewhere.
                Form::Mesh(mesh, _) => mesh.is_closed(),
            }
    });
    bodies.truncate(MOST_BODIES);
    // From left to right, so that each is compared with those alone that begin before it ends.
    bodies.sort_by(|a, b| a.bounds.min.x().total_cmp(&b.bounds.min.x()));
    let (mut told, mut pairs) = (Vec::new(), BTreeSet::new());
    for (number, first) in bodies.iter().enumerate() {
        for second in &bodies[number + 1..] {
            if second.bounds.min.x() > first.bounds.max.x() || told.len() >= MOST_TOLD {
                break;
            }
            // Copies of a grid are one object, and what an instance consists of is.
            let pair = [first.object.min(second.object), first.object.max(second.object)];
            if may_differ(scene, first, second) && !pairs.contains(&pair) && cross(first, second) {
                pairs.insert(pair);
                told.push(warning(scene, pair));
            }
        }
    }
    told
}

/// True where it matters which of two bodies is there: they are of different materials and the same priority.
fn may_differ(scene: &CompiledScene, first: &WorldSurface<'_>, second: &WorldSurface<'_>) -> bool {
    let priority = |surface: &WorldSurface<'_>| {
        scene.materials[surface.material as usize].body.as_ref().map_or(0, |body| body.priority)
    };
    first.material != second.material && priority(first) == priority(second)
}

fn warning(scene: &CompiledScene, pair: [u32; 2]) -> Diagnostic {
    let [first, second] = pair.map(|object| scene.object_names.get(object).unwrap_or_default());
    let message = format!("the transparent bodies \"{first}\" and \"{second}\" cross, and neither has priority");
    let mut warning = Diagnostic::warning(message).help(
        "a ray is in the one that it entered last, so that the same place is of one for some rays and of the other for others; give \
         the one that is there a higher `priority` in its `dielectric`",
    );
    let mut places = pair.into_iter().filter_map(|object| scene.body_spans.get(&object));
    if let Some(place) = places.next() {
        warning = warning.at(place.clone(), "this one");
    }
    if let Some(other) = places.next() {
        warning = warning.related(other.clone(), "crosses this one");
    }
    warning
}

/// True where the surfaces of two bodies are seen to cross.
fn cross(first: &WorldSurface<'_>, second: &WorldSurface<'_>) -> bool {
    let shared = first.bounds.intersection(&second.bounds);
    if shared.is_empty() || !shared.is_finite() {
        return false;
    }
    let shortest = SHORTEST * shared.diagonal().length();
    let mut scratch = CsgScratch::default();
    let mut passages = Vec::new();
    // Lengths in the first alone, in the second alone, and in both.
    let mut longest = [0.0_f64; 3];
    for line in 0..LINES {
        let ray = line_through(&shared, line);
        passages.clear();
        add_passages(first, 0, &ray, &mut scratch, &mut passages);
        add_passages(second, 1, &ray, &mut scratch, &mut passages);
        passages.sort_by(|a, b| a.t.total_cmp(&b.t));
        // Below a plane, a line is inside before its first passage, which leaves.
        let mut inside = [0, 1]
            .map(|body| passages.iter().find(|passage| passage.body == body).is_some_and(|passage| !passage.entering));
        let mut from = f64::NEG_INFINITY;
        for passage in &passages {
            let kind = match inside {
                [true, false] => Some(0),
                [false, true] => Some(1),
                [true, true] => Some(2),
                [false, false] => None,
            };
            if let Some(kind) = kind {
                longest[kind] = longest[kind].max(passage.t - from);
            }
            from = passage.t;
            inside[passage.body] = passage.entering;
        }
        if longest.iter().all(|length| *length > shortest) {
            return true;
        }
    }
    false
}

/// A line through a place of a box, in some direction.
fn line_through(bounds: &Bounds3, number: u32) -> Ray {
    let [[x, y, z, _], [u, v, ..]] = [0, 1].map(|set| Sampler::new(0, [0, 0], number).set(set));
    let size = bounds.diagonal();
    let place = bounds.min + Vector3::new(size.x() * x, size.y() * y, size.z() * z);
    let direction = uniform_sphere([u, v]);
    Ray::new(place, direction)
}

fn add_passages(
    surface: &WorldSurface<'_>,
    body: usize,
    ray: &Ray,
    scratch: &mut CsgScratch,
    passages: &mut Vec<Passage>,
) {
    let own = surface.world_from_own.map_or(*ray, |world_from_own| world_from_own.inverse_ray(ray));
    match surface.form {
        Form::Shape(shape) => {
            let mut crossings = Vec::new();
            shape.crossings(&own, &mut crossings);
            passages.extend(crossings.iter().map(|found| Passage { t: found.t, body, entering: found.entering }));
        }
        Form::Solid(solid) => {
            let found = solid.crossings(&own, scratch).iter();
            passages.extend(found.map(|found| Passage { t: found.t, body, entering: found.entering }));
        }
        Form::Mesh(mesh, _) => {
            // It is met from the ray's beginning on, which so must be before all of it.
            let bounds = mesh.bounds();
            let reach = (own.origin - bounds.center()).length() + bounds.diagonal().length();
            let back = reach / own.direction.length();
            let before = Ray::new(own.origin - own.direction * back, own.direction);
            // It never breaks, so there is nothing to know from its end.
            let _ = mesh.for_each_hit(&before, 0.0, f64::INFINITY, |hit| {
                passages.push(Passage { t: hit.t - back, body, entering: hit.front });
                ControlFlow::Continue(())
            });
        }
    }
}
