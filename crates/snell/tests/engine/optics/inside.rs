//! Rays that begin inside bodies: the engine knows what is around the camera.

use snell::math::{Point3, Ray, Vector3};
use snell_testkit::{TestRng, must_fail};

use crate::stage::{Stage, assert_near, refracted_path, snell};

/// Asserts that rays from around a point leave a stack of spheres around the origin, radius and the index inside each from the
/// innermost out, as Snell's law says. A ray that is totally reflected must be in the engine, too.
fn leaves(stage: &Stage, spheres: &[(f64, f64)], place: Point3) {
    let mut rng = TestRng::new(11);
    let mut out = 0;
    for _ in 0..100 {
        let start = Ray::new(place, rng.direction());
        let (tree, statistics) = stage.shoot(start);
        let path = refracted_path(&tree);
        let mut ray = start;
        let mut crossed = 0;
        for (number, &(radius, index)) in spheres.iter().enumerate() {
            let beyond = spheres.get(number + 1).map_or(1.0, |sphere| sphere.1);
            let b = ray.origin.to_vector().dot(ray.direction);
            let root = b * b - ray.origin.to_vector().length_squared() + radius * radius;
            let at = ray.at(-b + root.sqrt());
            let inward = (Point3::ORIGIN - at) * (1.0 / radius);
            let Some(direction) = snell(ray.direction, inward, index, beyond) else { break };
            ray = Ray::new(at, direction.normalize());
            crossed += 1;
        }
        assert_eq!(path.len(), crossed + 1, "boundaries crossed by {start:?}");
        let last = path[crossed].task.ray;
        assert!((last.direction - ray.direction).length() < 1e-9, "{last:?} instead of {ray:?}");
        if crossed < spheres.len() {
            assert!(statistics.total_internal_reflections > 0);
        } else {
            assert_eq!(path[crossed].task.media, Default::default(), "it is outside of all");
            out += 1;
        }
    }
    assert!(out > 20, "{out} rays came out");
}

fn glass(n: f64) -> String {
    format!("material = {{ dielectric = {{ ior = {n:?} }} }}\n")
}

#[test]
fn a_camera_in_a_ball_of_glass_sees_out_of_it() {
    let stage = Stage::new(&format!("[[object]]\nsphere = {{}}\n{}", glass(1.5)));
    for place in [Point3::ORIGIN, Point3::new(0.6, 0.0, 0.0), Point3::new(0.1, -0.5, 0.7)] {
        leaves(&stage, &[(1.0, 1.5)], place);
    }
    must_fail("another index", || leaves(&stage, &[(1.0, 1.49)], Point3::new(0.6, 0.0, 0.0)));
    // Through an instance, a transform and a solid made of solids it is the same.
    let moved = Stage::new(&format!(
        "[prototype.p]\ngroup = [{{ sphere = {{ radius = 0.5 }} }}, {{ grid = {{ count = [9, 1, 1], step = [3, 0, 0], of = {{ \
         sphere = {{ center = [0, 90, 0] }} }} }} }}]\n[[object]]\ninstance = \"p\"\nscale = 2\nrotate = [10, 20, 30]\n{}",
        glass(1.5)
    ));
    leaves(&moved, &[(1.0, 1.5)], Point3::new(0.6, 0.0, 0.0));
    let solid = Stage::new(&format!(
        "[[object]]\nintersection = [{{ sphere = {{}} }}, {{ box = {{ size = 4 }} }}]\n{}",
        glass(1.5)
    ));
    leaves(&solid, &[(1.0, 1.5)], Point3::new(0.1, -0.5, 0.7));
}

#[test]
fn a_camera_in_water_in_glass_knows_both() {
    let ball = |radius: f64, n: f64| format!("[[object]]\nsphere = {{ radius = {radius:?} }}\n{}", glass(n));
    let place = Point3::new(0.2, 0.1, -0.3);
    // In either order of the file: what is smaller was entered later.
    for text in [ball(1.0, 1.5) + &ball(0.8, 1.333), ball(0.8, 1.333) + &ball(1.0, 1.5)] {
        leaves(&Stage::new(&text), &[(0.8, 1.333), (1.0, 1.5)], place);
    }
    // In the glass between water and air, going outwards only.
    let stage = Stage::new(&(ball(1.0, 1.5) + &ball(0.3, 1.333)));
    let (tree, _) = stage.shoot(Ray::new(Point3::new(0.0, 0.5, 0.0), Vector3::new(0.6, 0.8, 0.0)));
    let path = refracted_path(&tree);
    let at = tree.rays[0].hit.flatten().expect("the glass's wall").point;
    let expected = snell(Vector3::new(0.6, 0.8, 0.0), Point3::ORIGIN - at, 1.5, 1.0).expect("it leaves");
    assert!((path[1].task.ray.direction - expected.normalize()).length() < 1e-9);
    // A bubble of air around the camera, inside glass.
    let bubble = Stage::new(&(ball(1.0, 1.5) + &ball(0.5, 1.0)));
    leaves(&bubble, &[(0.5, 1.0), (1.0, 1.5)], Point3::new(0.1, 0.0, 0.2));
}

#[test]
fn a_camera_in_a_box_of_water_sees_the_room_shifted() {
    let stage = Stage::new(&format!(
        "[[object]]\nbox = {{ min = [-5, -1, -5], max = [5, 1, 5] }}\n{}[background]\ncolor = 1\n",
        glass(1.333)
    ));
    for (x, y, z) in [(0.0, 1.0, 0.0), (0.5, 1.0, 0.2), (0.1, -1.0, -0.7)] {
        let direction = Vector3::new(x, y, z).normalize();
        let (tree, _) = stage.shoot(Ray::new(Point3::new(0.0, 0.3, 0.0), direction));
        let expected = snell(direction, Vector3::Y * -y.signum(), 1.333, 1.0).expect("it leaves");
        assert!((refracted_path(&tree)[1].task.ray.direction - expected).length() < 1e-12);
    }
    // Its picture is as bright as the room but for what is reflected back and lost after many bounces.
    let statistics = stage.shoot(Ray::new(Point3::new(0.0, 0.3, 0.0), Vector3::Y)).1;
    let seen = stage.color([0.0, 0.3, 0.0], [0.0, 1.0, 0.0]);
    let lost = statistics.cut_weight() as f32;
    assert_near(seen + snell::math::Rgb::gray(lost), snell::math::Rgb::WHITE, 1e-5, "straight up");
}
