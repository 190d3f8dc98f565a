//! Bodies in bodies: a bubble made in two ways, and water in a glass against a model of three boundaries.

use snell::math::{Point3, Ray, Vector3};
use snell::task::{RayKind, Term};
use snell_testkit::{TestRng, must_fail};

use crate::stage::{Stage, assert_near, assert_pictures, reflectance, refracted_path, share, snell};

fn scene(objects: &str) -> Stage {
    Stage::new(&format!(
        "[camera]\neye = [0.3, 1.4, 5]\nlook_at = [0, 0.9, 0]\n[background]\ngradient = {{ horizon = [0.8, 0.9, 1], \
         zenith = [0.2, 0.3, 0.7] }}\n[[light]]\npoint = {{ position = [4, 6, 5] }}\n\
         [material.glass]\nspecular = 0.5\ndielectric = {{ ior = 1.5 }}\n\
         [[object]]\nplane = {{}}\nmaterial = {{ diffuse = {{ checker = {{ colors = [0.9, 0.2] }} }} }}\n{objects}"
    ))
    .sized(40, 30)
}

#[test]
fn a_bubble_is_a_shell_or_a_ball_of_nothing_in_a_ball_of_glass() {
    let shell = scene(
        "[[object]]\ndifference = [{ sphere = { center = [0, 1, 0] } }, { sphere = { center = [0, 1, 0], radius = 0.8 } }]\n\
         material = \"glass\"\n",
    )
    .picture();
    let nested = |ior: &str| {
        scene(&format!(
            "[[object]]\nsphere = {{ center = [0, 1, 0] }}\nmaterial = \"glass\"\n[[object]]\nsphere = {{ center = [0, 1, 0], \
             radius = 0.8 }}\nmaterial = {{ specular = 0.5, dielectric = {{ ior = {ior} }} }}\n"
        ))
        .picture()
    };
    assert_pictures(&nested("1"), &shell, 1e-5);
    must_fail("a bubble of thin air", || assert_pictures(&nested("1.0003"), &shell, 1e-5));
}

const GLASS: f64 = 1.5;
const WATER: f64 = 1.333;

/// A glass shell from 0.8 to 1 and a ball of water that overlaps it, as modellers do; of lower priority. By `radius` the water
/// may be made to fit exactly instead.
fn water_in_glass(radius: f64, priority: i32) -> Stage {
    Stage::new(&format!(
        "[render]\nmin_weight = 0\n[background]\ncolor = 1\n[[object]]\ndifference = [{{ sphere = {{}} }}, {{ sphere = {{ \
         radius = 0.8 }} }}]\nmaterial = {{ dielectric = {{ ior = {GLASS}, priority = 1 }} }}\n[[object]]\nsphere = {{ \
         radius = {radius:?} }}\nmaterial = {{ dielectric = {{ ior = {WATER}, priority = {priority} }} }}\n"
    ))
}

/// Where a ray meets a sphere around the origin, from outside or from inside.
fn meet(ray: Ray, radius: f64, from_inside: bool) -> Option<Point3> {
    let b = ray.origin.to_vector().dot(ray.direction);
    let root = b * b - ray.origin.to_vector().length_squared() + radius * radius;
    (root >= 0.0).then(|| ray.at(if from_inside { -b + root.sqrt() } else { -b - root.sqrt() }))
}

/// The exact way through air, glass, water, glass and air again: the last ray and the share of light that comes through.
fn exact(mut ray: Ray) -> Option<(Ray, f64)> {
    let mut share = 1.0;
    let boundaries =
        [(1.0, 1.0, GLASS, false), (0.8, GLASS, WATER, false), (0.8, WATER, GLASS, true), (1.0, GLASS, 1.0, true)];
    for (radius, from, to, from_inside) in boundaries {
        let at = meet(ray, radius, from_inside)?;
        let outward = (at - Point3::ORIGIN) * (1.0 / radius);
        let normal = if from_inside { -outward } else { outward };
        share *= 1.0 - reflectance(-normal.dot(ray.direction), from, to);
        ray = Ray::new(at, snell(ray.direction, normal, from, to)?.normalize());
    }
    Some((ray, share))
}

fn is_exact(stage: &Stage) -> usize {
    let mut rng = TestRng::new(4);
    let mut through = 0;
    for _ in 0..100 {
        let origin = Point3::ORIGIN + rng.direction() * 4.0;
        let target = Point3::ORIGIN + rng.direction() * rng.range(0.0, 0.7);
        let ray = Ray::new(origin, (target - origin).normalize());
        let Some((expected, light)) = exact(ray) else { continue };
        let (tree, _) = stage.shoot(ray);
        // Rays that only pass a hidden boundary are refracted rays of the same depth.
        let path = refracted_path(&tree);
        let Some(last) = path.last().filter(|last| last.task.depth == 5) else {
            panic!("{} rays along the way", path.len());
        };
        assert_eq!(last.task.kind, RayKind::Refracted);
        let (direction, from) = (last.task.ray.direction, last.task.ray.origin);
        assert!((direction - expected.direction).length() < 1e-9, "{direction:?} instead of {:?}", expected.direction);
        assert!((from - expected.origin).length() < 1e-9, "{from:?} instead of {:?}", expected.origin);
        let seen = share(&tree, last.task.id, |term| term == Term::Background);
        assert!((f64::from(seen.g) - light).abs() < 1e-5, "{seen:?} instead of {light}");
        through += 1;
    }
    through
}

#[test]
fn water_in_a_glass_is_three_boundaries() {
    assert!(is_exact(&water_in_glass(0.9, 0)) > 60);
    must_fail("water goes before glass", || is_exact(&water_in_glass(0.9, 2)));
    must_fail("water ends before the glass begins", || is_exact(&water_in_glass(0.799, 0)));
}

#[test]
fn overlapping_bodies_look_like_fitted_ones() {
    let mut overlapping = water_in_glass(0.9, 0).sized(24, 18);
    // A ball of water alone in the glass, entered after it, without any overlap of walls.
    let mut fitted = Stage::new(&format!(
        "[background]\ncolor = 1\n[[object]]\nsphere = {{}}\nmaterial = {{ dielectric = {{ ior = {GLASS} }} }}\n[[object]]\n\
         sphere = {{ radius = 0.8 }}\nmaterial = {{ dielectric = {{ ior = {WATER} }} }}\n"
    ))
    .sized(24, 18);
    for stage in [&mut overlapping, &mut fitted] {
        (stage.settings.min_weight, stage.settings.depth) = (0.0, 7);
    }
    assert_pictures(&overlapping.picture(), &fitted.picture(), 1e-5);
    let ray = |stage: &Stage| stage.color([0.1, 0.2, 4.0], [0.0, 0.0, -1.0]);
    assert_near(ray(&overlapping), ray(&fitted), 1e-5, "a ray");
    let _: Vector3 = Vector3::Z;
}
