//! Maps and searches against trees: what is told of whole pictures is what the trees of their pixels say.

use snell::explain::{Found, MapError, Phenomenon, Property, SEVEN_RAYS, find, map};
use snell::math::Rgb;
use snell::observe::RayTree;
use snell::render::{NoProgress, Watch, explain};
use snell::scene::scene::Antialiasing;
use snell::task::{RayKind, Term};
use snell_testkit::must_fail;

use super::stage;
use crate::stage::Stage;

fn tree(stage: &Stage, pixel: [u32; 2]) -> RayTree {
    explain(&stage.scene, &stage.settings, pixel, 0).expect("a camera")
}

fn watch(stage: &Stage) -> Watch<'_> {
    Watch::new(&stage.scene, &stage.settings).expect("a camera")
}

/// Asserts that a map is what a function says of each pixel's tree.
fn maps(stage: &Stage, name: &str, expected: impl Fn(&RayTree) -> f32) {
    let property: Property = name.parse().expect("a name");
    let values = map(&mut watch(stage), &property, &NoProgress).expect("a map");
    for [x, y] in stage.pixels() {
        let (value, expected) = (*values.get(x, y).expect("a pixel"), expected(&tree(stage, [x, y])));
        assert!((value - expected).abs() <= 1e-5, "{name} at {x}, {y}: {value}, expected {expected}");
    }
}

/// The share of the luminance of those terms that are wanted.
fn portion(tree: &RayTree, wanted: impl Fn(usize, Term, Option<u32>) -> bool) -> f32 {
    let sum = |wanted: &dyn Fn(usize, Term, Option<u32>) -> bool| -> f32 {
        let shares = tree.shares.iter().filter(|share| wanted(share.task as usize, share.term, share.shadow));
        shares.map(|share| share.value.luminance()).sum()
    };
    let all = sum(&|_, _, _| true);
    if all > 0.0 { (sum(&wanted) / all).clamp(0.0, 1.0) } else { 0.0 }
}

/// Whether a ray or one that it follows from is of a kind.
fn came_by(tree: &RayTree, mut ray: usize, kind: RayKind) -> bool {
    loop {
        let task = &tree.rays[ray].task;
        if task.kind == kind {
            return true;
        }
        if task.parent == task.id {
            return false;
        }
        ray = task.parent as usize;
    }
}

#[test]
fn maps_are_what_trees_say() {
    for name in ["seven-rays", "lens"] {
        let stage = stage(name, Antialiasing::None);
        let deepest = |tree: &RayTree| tree.rays.iter().map(|ray| f32::from(ray.task.depth)).fold(0.0, f32::max);
        maps(&stage, "depth", deepest);
        maps(&stage, "rays", |tree| tree.rays.iter().map(|ray| 1.0 + ray.shadows.len() as f32).sum());
        maps(&stage, "tir", |tree| tree.rays.iter().filter(|ray| ray.total_internal_reflection).count() as f32);
        maps(&stage, "share:reflected", |tree| portion(tree, |ray, _, _| came_by(tree, ray, RayKind::Reflected)));
        maps(&stage, "share:refracted", |tree| portion(tree, |ray, _, _| came_by(tree, ray, RayKind::Refracted)));
        maps(&stage, "share:background", |tree| portion(tree, |_, term, _| term == Term::Background));
        maps(&stage, "caustic", |tree| {
            portion(tree, |ray, _, shadow| {
                shadow.is_some_and(|number| {
                    tree.rays[ray].shadows[number as usize].steps.iter().any(|step| step.surface.is_some())
                })
            })
        });
        must_fail("a ray is not counted", || maps(&stage, "depth", |tree| deepest(tree) - 1.0));
    }
    let stage = stage("seven-rays", Antialiasing::None);
    maps(&stage, "share:object=board", |tree| {
        portion(tree, |ray, _, _| {
            let surface = tree.rays[ray].hit.as_ref().and_then(Option::as_ref);
            surface.is_some_and(|s| stage.scene.object_names.get(s.object).as_deref() == Some("board"))
        })
    });
    maps(&stage, "share:light=key", |tree| {
        portion(tree, |_, term, _| matches!(term, Term::Diffuse(0) | Term::Specular(0)))
    });
}

#[test]
fn maps_do_not_depend_on_threads() {
    let stage = stage("lens", Antialiasing::Samples(3));
    let values = |threads: usize| {
        let pool = rayon_pool(threads);
        pool.install(|| map(&mut watch(&stage), &Property::Rays, &NoProgress).expect("a map"))
    };
    assert_eq!(values(1).pixels(), values(3).pixels());
}

fn rayon_pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads")
}

#[test]
fn names_that_mean_nothing_are_told() {
    for name in ["", "dept", "share:", "share:object=", "share:nothing"] {
        assert_eq!(name.parse::<Property>(), Err(MapError::Unknown(name.to_owned())));
    }
    for name in ["", "depth", "depth=0", "depth=x", "object=", "sevenrays"] {
        assert!(name.parse::<Phenomenon>().is_err(), "{name}");
    }
    let stage = stage("seven-rays", Antialiasing::None);
    let property = "share:object=bord".parse().expect("a name");
    let error = map(&mut watch(&stage), &property, &NoProgress).expect_err("no such object");
    assert_eq!(error, MapError::NoObject("bord".to_owned()));
}

/// Asserts that what was found shows what it is to show.
fn shows(stage: &Stage, phenomenon: &Phenomenon, found: &[Found], is_shown: impl Fn(&RayTree) -> bool) {
    assert!(!found.is_empty(), "{phenomenon:?} is not found");
    for pair in found.windows(2) {
        assert!(pair[0].clearness >= pair[1].clearness, "the clearest first");
    }
    for one in found {
        assert!(one.clearness > 0.0 && is_shown(&tree(stage, one.pixel)), "{phenomenon:?} at {:?}", one.pixel);
    }
}

#[test]
fn what_is_found_is_there() {
    let look = |stage: &Stage, phenomenon: &Phenomenon| find(&mut watch(stage), phenomenon, 4);
    let seven = Stage::of(&crate::files::scene_of_file("scenes/seven-rays.toml")).sized(160, 120);
    for phenomenon in &SEVEN_RAYS {
        shows(&seven, phenomenon, &look(&seven, phenomenon), |_| true);
    }
    let total = Phenomenon::TotalInternalReflection;
    let board = Stage::of(&crate::files::scene_of_file("scenes/total-internal-reflection.toml")).sized(64, 48);
    shows(&board, &total, &look(&board, &total), |tree| tree.rays.iter().any(|ray| ray.total_internal_reflection));
    let deep = Phenomenon::Depth(3);
    shows(&seven, &deep, &look(&seven, &deep), |tree| tree.rays.iter().any(|ray| ray.task.depth == 3));
    let blocked = &Phenomenon::CompleteShadow;
    let is_dark = |tree: &RayTree| tree.rays[0].shadows.iter().any(|shadow| shadow.transmittance == Rgb::BLACK);
    shows(&seven, blocked, &look(&seven, blocked), is_dark);
    // What is not there is not found.
    assert!(look(&seven, &Phenomenon::Dispersion).is_empty());
    must_fail("another phenomenon is shown", || {
        let lit = &Phenomenon::OutsideHighlight;
        shows(&seven, lit, &look(&seven, lit), is_dark);
    });
}

#[test]
fn large_pictures_are_searched_on_a_grid_first() {
    let stage = Stage::of(&crate::files::scene_of_file("scenes/seven-rays.toml")).sized(700, 525);
    let found = find(&mut watch(&stage), &Phenomenon::InsideHighlight, 2);
    shows(&stage, &Phenomenon::InsideHighlight, &found, |_| true);
}
