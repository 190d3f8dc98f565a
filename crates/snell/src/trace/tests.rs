//! The loop over generations: samples do not know of each other, and watchers see everything.

use snell_math::lanes::InstructionSet;
use snell_math::{Point3, Ray, Rgb, Vector3};
use snell_scene::scene::{
    Background, Camera, Dielectric, Falloff, Light, LightKind, Material, Medium, Object, PixelGrid, Scene, Shadows,
    Shape, Texture,
};
use snell_testkit::{TestRng, must_fail};

use super::{Scratch, Tracer};
use crate::compile::CompiledScene;
use crate::geometry::Hit;
use crate::integrator::{Rules, Whitted};
use crate::observe::{NoObserver, RayTree};
use crate::statistics::Statistics;
use crate::task::RayKind;

/// Balls of glass, and matt and mirroring ones, under a light over a floor.
fn scene() -> CompiledScene {
    let mut scene = Scene { background: Background::Color(Rgb::new(0.2, 0.4, 0.8)), ..Scene::default() };
    scene.ambient = Rgb::gray(0.1);
    let [white, half] = [1.0, 0.5].map(|value| scene.textures.push(Texture::constant(Rgb::gray(value))));
    let ior = snell_math::Dispersion::Constant(1.5);
    let medium = Medium { absorption: Rgb::new(0.1, 0.5, 0.9), ..Medium::default() };
    let glass = Dielectric {
        ior,
        fresnel: true,
        reflect: white,
        transmit: white,
        roughness: 0.0,
        film: None,
        medium,
        measured_ior: None,
        extinction: None,
        priority: 0,
    };
    let kinds = [
        Material { dielectric: Some(glass), specular: Some(half), shininess: 20.0, ..Material::default() },
        Material { diffuse: Some(half), ..Material::default() },
        Material { diffuse: Some(half), mirror: Some(half), ..Material::default() },
    ];
    let kinds = kinds.map(|material| scene.materials.push(material));
    for (i, &material) in kinds.iter().cycle().take(9).enumerate() {
        let center = Point3::new((i % 3) as f64 - 1.0, (i / 3) as f64, (i % 2) as f64);
        scene
            .objects
            .push(Object { material: Some(material), ..Object::shape(Shape::Sphere { center, radius: 0.45 }) });
    }
    scene.objects.push(Object::shape(Shape::Plane { point: Point3::new(0.0, -0.5, 0.0), normal: Vector3::Y }));
    let position = Point3::new(3.0, 5.0, 4.0);
    let kind = LightKind::Point { position };
    scene.lights.push(Light { name: None, kind, intensity: Rgb::WHITE, spectrum: None, falloff: Falloff::None });
    CompiledScene::build(&scene).expect("it compiles")
}

fn integrator(scene: &CompiledScene) -> Whitted {
    let camera = crate::camera::Camera::new(&Camera::default(), 8, 8, PixelGrid::Centers).expect("a camera");
    Whitted::new(scene, &camera, 4)
}

const RULES: Rules = Rules { depth: 6, min_weight: 0.0, weightless_rays: false, shadows: Shadows::Filtered };

fn rays() -> Vec<(Ray, u32)> {
    let mut rng = TestRng::new(23);
    let mut ray = || Ray::new(Point3::new(0.0, 1.0, 6.0), (Vector3::new(0.0, 0.0, -1.0) + rng.vector(0.3)).normalize());
    (0..40).map(|_| (ray(), 0)).collect()
}

#[test]
fn samples_do_not_know_of_each_other() {
    let scene = scene();
    let integrator = integrator(&scene);
    let tracer = Tracer { scene: &scene, integrator: &integrator, rules: RULES, instructions: InstructionSet::best() };
    let rays = rays();
    let (mut scratch, mut together) = (Scratch::default(), Statistics::default());
    let all = tracer.trace(rays.as_slice(), &mut scratch, &mut together, &mut NoObserver, None).to_vec();
    let (mut each, mut alone) = (Vec::new(), Statistics::default());
    // With queues that others have used, in the other order.
    for &ray in rays.iter().rev() {
        each.extend_from_slice(tracer.trace([ray].as_slice(), &mut scratch, &mut alone, &mut NoObserver, None));
    }
    each.reverse();
    assert_eq!(all, each);
    assert_eq!(together, alone);
    let bits = |colors: &[Rgb]| colors.iter().map(|c| c.to_array().map(f32::to_bits)).collect::<Vec<_>>();
    assert_eq!(bits(&all), bits(&each));
    must_fail("two samples are exchanged", || {
        let mut exchanged = each.clone();
        exchanged.swap(3, 17);
        assert_eq!(all, exchanged);
    });
}

#[test]
fn all_instructions_give_the_same_bits() {
    let scene = scene();
    let integrator = integrator(&scene);
    let rays = rays();
    let trace = |instructions: InstructionSet| {
        let tracer = Tracer { scene: &scene, integrator: &integrator, rules: RULES, instructions };
        let (mut scratch, mut statistics) = (Scratch::default(), Statistics::default());
        let colors = tracer.trace(rays.as_slice(), &mut scratch, &mut statistics, &mut NoObserver, None);
        (colors.iter().map(|color| color.to_array().map(f32::to_bits)).collect::<Vec<_>>(), statistics)
    };
    let alone = trace(InstructionSet::Scalar);
    for instructions in InstructionSet::available() {
        assert_eq!(trace(instructions), alone, "{instructions:?}");
    }
    must_fail("the last bit of one sample is another", || {
        let mut other = trace(InstructionSet::best());
        other.0[11][1] ^= 1;
        assert_eq!(other, alone);
    });
}

#[test]
fn watchers_change_nothing_and_see_every_ray() {
    let scene = scene();
    let integrator = integrator(&scene);
    let tracer = Tracer { scene: &scene, integrator: &integrator, rules: RULES, instructions: InstructionSet::best() };
    let mut scratch = Scratch::default();
    for ray in rays() {
        let (mut plain, mut watched) = (Statistics::default(), Statistics::default());
        let color = tracer.trace([ray].as_slice(), &mut scratch, &mut plain, &mut NoObserver, None)[0];
        let mut tree = RayTree::default();
        let seen = tracer.trace([ray].as_slice(), &mut scratch, &mut watched, &mut tree, None)[0];
        assert_eq!((color, plain), (seen, watched));
        assert_eq!(tree.sum(), color);
        let of_kind =
            |kind| tree.rays.iter().filter(|ray| ray.task.kind == kind && ray.task.passes == 0).count() as u64;
        assert_eq!(of_kind(RayKind::Reflected), plain.reflected_rays);
        assert_eq!(of_kind(RayKind::Refracted), plain.refracted_rays);
        assert_eq!(tree.rays.iter().map(|ray| ray.shadows.len() as u64).sum::<u64>(), plain.shadow_rays);
        let totals = tree.rays.iter().filter(|ray| ray.total_internal_reflection).count() as u64;
        assert_eq!(totals, plain.total_internal_reflections);
        for (number, ray) in tree.rays.iter().enumerate() {
            assert_eq!(ray.task.id as usize, number, "in the order in which they were spawned");
            assert!(ray.hit.is_some(), "each was followed");
            let parent = &tree.rays[ray.task.parent as usize].task;
            assert!(number == 0 || ray.task.parent < ray.task.id && ray.task.depth <= parent.depth + 1);
        }
    }
}

#[test]
fn what_is_taken_from_a_camera_ray_is_not_there() {
    let scene = scene();
    let integrator = integrator(&scene);
    let tracer = Tracer { scene: &scene, integrator: &integrator, rules: RULES, instructions: InstructionSet::best() };
    let (mut scratch, mut statistics) = (Scratch::default(), Statistics::default());
    let mut take = |number: usize, _: &Ray, hit: &mut Option<Hit>| {
        if number.is_multiple_of(2) {
            *hit = None;
        }
    };
    let colors = tracer.trace(rays().as_slice(), &mut scratch, &mut statistics, &mut NoObserver, Some(&mut take));
    assert!(colors.iter().step_by(2).all(|color| *color == Rgb::new(0.2, 0.4, 0.8)));
    assert!(colors.iter().skip(1).step_by(2).any(|color| *color != Rgb::new(0.2, 0.4, 0.8)));
    // No rays, no samples.
    let mut none = Statistics::default();
    assert!(tracer.trace([].as_slice(), &mut scratch, &mut none, &mut NoObserver, None).is_empty());
    assert_eq!(none, Statistics::default());
}

#[test]
fn rules_of_shadows_and_depth_hold() {
    let scene = scene();
    let integrator = integrator(&scene);
    let counts = |rules: Rules| {
        let tracer = Tracer { scene: &scene, integrator: &integrator, rules, instructions: InstructionSet::best() };
        let (mut scratch, mut statistics) = (Scratch::default(), Statistics::default());
        let colors = tracer.trace(rays().as_slice(), &mut scratch, &mut statistics, &mut NoObserver, None);
        (colors.iter().fold(0.0, |sum, color| sum + color.g), statistics)
    };
    let (filtered, all) = counts(RULES);
    let (opaque, _) = counts(Rules { shadows: Shadows::Opaque, ..RULES });
    let (unshadowed, none) = counts(Rules { shadows: Shadows::None, ..RULES });
    assert!(opaque < filtered && filtered < unshadowed, "{opaque} {filtered} {unshadowed}");
    assert_eq!((none.shadow_rays, none.reflected_rays), (0, all.reflected_rays));
    let (_, flat) = counts(Rules { depth: 1, ..RULES });
    assert_eq!((flat.reflected_rays, flat.refracted_rays, flat.max_depth), (0, 0, 1));
    assert!(flat.cut_weight() > 0.1 && all.max_depth == 6 && all.cut_weight() < flat.cut_weight());
}
