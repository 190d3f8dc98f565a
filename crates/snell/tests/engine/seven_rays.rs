//! The seven rays of Watt's figure, each found in a picture of `scenes/seven-rays.toml` and told by its tree.
//!
//! Alan Watt, *3D Computer Graphics*, as in the lecture: one picture of a transparent ball, an opaque one, a checkerboard and
//! a background in which every kind of ray of recursive ray tracing can be pointed at.

use snell::interaction::SurfaceInteraction;
use snell::math::{Ray, Rgb};
use snell::observe::{AnsweredShadow, RayTree, TracedRay};
use snell::scene::scene::{Pattern, Shadows};
use snell::scene::{Id, Scene};
use snell::task::{RayKind, Term};
use snell_testkit::must_fail;

use crate::files::scene_of_file;
use crate::stage::{Stage, children, share};

/// What a ray can meet in this scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Thing {
    Glass,
    Ball,
    Board,
    Background,
}

struct Scan<'a> {
    scene: &'a Scene,
    stage: &'a Stage,
    tree: RayTree,
}

const KINDS: [&str; 7] = [
    "specular highlight on the outside of the transparent sphere",
    "specular highlight on its inside",
    "the checkerboard, reflected and refracted",
    "refraction that hits the background",
    "local diffuse and a reflection of the checkerboard",
    "local diffuse in complete shadow",
    "local diffuse in the shadow of the transparent sphere",
];

impl Scan<'_> {
    fn thing_at(&self, surface: &SurfaceInteraction) -> Thing {
        let material = &self.scene.materials[Id::from_index(surface.material)];
        let is_pattern = |texture| !matches!(self.scene.textures[texture].pattern, Pattern::Constant(_));
        if material.dielectric.is_some() {
            Thing::Glass
        } else if material.diffuse.is_some_and(is_pattern) {
            Thing::Board
        } else {
            Thing::Ball
        }
    }

    fn thing(&self, ray: &TracedRay) -> Thing {
        surface(ray).map_or(Thing::Background, |surface| self.thing_at(surface))
    }

    /// All rays below one, it included, all of which go through the transparent sphere.
    fn through_glass<'t>(&'t self, ray: &'t TracedRay, found: &mut Vec<&'t TracedRay>) {
        found.push(ray);
        if self.thing(ray) == Thing::Glass {
            for child in children(&self.tree, ray.task.id).filter(|child| child.task.kind == RayKind::Refracted) {
                self.through_glass(child, found);
            }
        }
    }

    /// What a shadow ray meets first.
    fn blocker(&self, shadow: &AnsweredShadow) -> Option<Thing> {
        let ray: Ray = shadow.question.ray;
        let hit = self.stage.scene.geometry.intersect(&ray, shadow.question.distance, &mut Default::default())?;
        Some(self.thing_at(&self.stage.scene.interaction(&ray, &hit)))
    }

    /// Which of the seven this pixel's camera ray is.
    fn kinds(&self) -> [bool; 7] {
        let camera = &self.tree.rays[0];
        let Some(surface) = surface(camera) else { return [false; 7] };
        let id = camera.task.id;
        let lit = |ray: &TracedRay, wanted: fn(Term) -> bool| !share(&self.tree, ray.task.id, wanted).is_black();
        let is_specular = |term| matches!(term, Term::Specular(_));
        let is_diffuse = |term| matches!(term, Term::Diffuse(_));
        let reflected =
            |thing| children(&self.tree, id).any(|ray| ray.task.kind == RayKind::Reflected && self.thing(ray) == thing);
        // A light that this point faces, and how much of it comes.
        let shadow = |accept: &dyn Fn(&AnsweredShadow) -> bool| {
            camera.shadows.iter().any(|shadow| !shadow.question.terms[0].1.is_black() && accept(shadow))
        };
        let mut kinds = [false; 7];
        match self.thing_at(surface) {
            Thing::Glass => {
                let outside = surface.is_outward(-camera.task.ray.direction);
                let mut through = Vec::new();
                self.through_glass(camera, &mut through);
                let inside = |ray: &&TracedRay| {
                    let leaving = self::surface(ray).is_some_and(|wall| wall.is_outward(ray.task.ray.direction));
                    ray.task.kind == RayKind::Refracted && self.thing(ray) == Thing::Glass && leaving
                };
                kinds[0] = outside && lit(camera, is_specular);
                kinds[1] = through.iter().any(|ray| inside(ray) && lit(ray, is_specular));
                kinds[2] = reflected(Thing::Board)
                    && through.iter().any(|ray| self.thing(ray) == Thing::Board && lit(ray, is_diffuse));
                kinds[3] = through
                    .iter()
                    .any(|ray| self.thing(ray) == Thing::Background && lit(ray, |term| term == Term::Background));
            }
            Thing::Ball => kinds[4] = lit(camera, is_diffuse) && reflected(Thing::Board),
            Thing::Board => {
                kinds[5] =
                    shadow(&|shadow| shadow.transmittance == Rgb::BLACK && self.blocker(shadow) == Some(Thing::Ball))
                        && !lit(camera, is_diffuse);
                kinds[6] = shadow(&|shadow| {
                    let part = |share: f32| share > 0.0 && share < 1.0;
                    let partly = shadow.transmittance.to_array().into_iter().all(part);
                    partly && self.blocker(shadow) == Some(Thing::Glass)
                }) && lit(camera, is_diffuse);
            }
            Thing::Background => {}
        }
        kinds
    }
}

fn surface(ray: &TracedRay) -> Option<&SurfaceInteraction> {
    ray.hit.as_ref()?.as_ref()
}

/// Asserts that each of the seven is somewhere in the picture.
fn all_seven_are_in(scene: &Scene) {
    let stage = Stage::of(scene).sized(192, 144);
    let mut found: [Option<[u32; 2]>; 7] = [None; 7];
    for ([x, y], tree) in stage.trees() {
        let scan = Scan { scene, stage: &stage, tree };
        for (found, is) in found.iter_mut().zip(scan.kinds()) {
            if is {
                found.get_or_insert([x, y]);
            }
        }
    }
    let missing: Vec<&str> =
        KINDS.into_iter().zip(found).filter(|(_, at)| at.is_none()).map(|(kind, _)| kind).collect();
    assert!(missing.is_empty(), "not found: {missing:?}");
}

#[test]
fn each_of_the_seven_rays_is_found() {
    all_seven_are_in(&scene_of_file("scenes/seven-rays.toml"));
}

#[test]
fn a_ray_that_is_not_there_is_missed() {
    let told = |change: &dyn Fn(&mut Scene)| {
        let mut scene = scene_of_file("scenes/seven-rays.toml");
        change(&mut scene);
        must_fail("a ray is missing", || all_seven_are_in(&scene))
    };
    let no_filter = told(&|scene| scene.settings.shadows = Shadows::Opaque);
    assert!(no_filter.contains(KINDS[6]) && !no_filter.contains(KINDS[5]), "{no_filter}");
    let no_recursion = told(&|scene| scene.settings.depth = 1);
    assert!(no_recursion.contains(KINDS[2]) && !no_recursion.contains(KINDS[0]), "{no_recursion}");
    let no_light = told(&|scene| scene.lights.clear());
    assert!(no_light.contains(KINDS[0]) && !no_light.contains(KINDS[3]), "{no_light}");
}
