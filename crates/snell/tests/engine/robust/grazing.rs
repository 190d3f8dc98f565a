//! Light and views that graze, and cameras that stand on what they see.

use snell::math::{Point3, Ray, Rgb, Vector3, portable};
use snell_testkit::must_fail;

use crate::stage::{Stage, assert_near};

#[test]
fn light_that_grazes_a_face_still_arrives() {
    for (face, normal_side) in [
        ("plane = {}", 0.0),
        ("box = { min = [-1e4, -1, -1e4], max = [1e4, 0, 1e4] }", 0.0),
        ("rectangle = { corner = [-1e4, 0, 1e4], edge_u = [2e4, 0, 0], edge_v = [0, 0, -2e4] }", 0.0),
        (
            "mesh = { vertices = [[-1e4, 0, 1e4], [1e4, 0, 1e4], [1e4, 0, -1e4], [-1e4, 0, -1e4]], faces = [[0, 1, 2, 3]] }",
            0.0,
        ),
        ("plane = { y = 1e6 }", 1e6),
        ("cylinder = { base = [0, -1, 0], top = [0, 0, 0], radius = 1e4 }", 0.0),
    ] {
        for elevation in [1e-2, 1e-4, 1e-6] {
            let sine = portable::sin(elevation);
            let stage = Stage::new(&format!(
                "[[light]]\ndirectional = {{ direction = [{:?}, {:?}, 0] }}\n[[object]]\n{face}\nmaterial = {{ diffuse = 1, ambient = 0 }}\n",
                -portable::cos(elevation),
                -sine
            ));
            let check = |factor: f64| {
                for x in [0.0, 0.37, -12.3, 517.25] {
                    let seen = stage.color([x, normal_side + 2.0, 0.21], [0.0, -1.0, 0.0]);
                    let error = (f64::from(seen.r) / sine - factor).abs();
                    assert!(error < 1e-3, "{face} at {x}, elevation {elevation}: {seen:?}");
                }
            };
            check(1.0);
            must_fail("no light", || check(0.0));
        }
    }
}

#[test]
fn spheres_are_lit_up_to_the_terminator() {
    for size in [1e-3, 1.0, 1e5] {
        let stage = Stage::new(&format!(
            "[[light]]\ndirectional = {{ direction = [-1, 0, 0] }}\n[[object]]\nsphere = {{ radius = {size:?} }}\nmaterial = {{ \
             diffuse = 1, ambient = 0 }}\n"
        ));
        for x in [-0.5, -1e-3, -1e-6, 1e-6, 1e-4, 1e-2, 0.3, 0.9] {
            let seen = stage.color([x * size, 0.0, 3.0 * size], [0.0, 0.0, -1.0]);
            assert_near(seen, Rgb::gray(x.max(0.0) as f32), 1e-6, &format!("at {x} of a ball of {size}"));
        }
    }
}

/// A body at whose surface a camera stands, and where: exactly on it, also after rounding.
const STANDS: [(&str, [f64; 3], [f64; 3]); 4] = [
    ("plane = {}", [0.3, 0.0, 0.2], [0.0, 1.0, 0.0]),
    ("sphere = {}", [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]),
    ("box = { size = 2 }", [0.25, 1.0, 0.5], [0.0, 1.0, 0.0]),
    (
        "mesh = { vertices = [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], faces = [[0, 1, 2, 3]] }",
        [0.1, 0.0, 0.3],
        [0.0, 1.0, 0.0],
    ),
];

#[test]
fn a_camera_on_a_surface_sees_out() {
    for (body, eye, outward) in STANDS {
        for material in ["diffuse = 1", "dielectric = { ior = 1.5 }"] {
            let stage = Stage::new(&format!(
                "ambient = 0.5\n[background]\ncolor = [0, 1, 0]\n[[object]]\n{body}\nmaterial = {{ {material} }}\n"
            ));
            let outward = Vector3::from(outward);
            let (u, v) = outward.orthonormal_basis();
            for (a, b) in [(0.0, 0.0), (1.0, 0.0), (-0.3, 0.7), (4.0, -5.0)] {
                let ray = Ray::new(Point3::from(eye), (outward + u * a + v * b).normalize());
                let seen = stage.shoot(ray).0.sum();
                assert_eq!(seen, Rgb::new(0.0, 1.0, 0.0), "{body}, {material}, along {:?}", ray.direction);
            }
        }
    }
}

#[test]
fn a_camera_on_a_surface_sees_in() {
    // Into the body, it sees what is inside or behind it, and in any case a finite colour.
    for (body, eye, outward) in STANDS {
        let stage = Stage::new(&format!(
            "[background]\ncolor = 1\n[[object]]\n{body}\nmaterial = {{ dielectric = {{ ior = 1.5 }} }}\n"
        ));
        for side in [[0.0, 0.0, 0.0], [0.3, 0.1, 0.2], [2.0, -1.0, 0.5]] {
            let direction = Vector3::from(side) - Vector3::from(outward) * 0.7;
            let seen = stage.shoot(Ray::new(Point3::from(eye), direction.normalize())).0.sum();
            assert!(seen.is_finite() && seen.max_abs() <= 1.001, "{body} along {direction:?}: {seen:?}");
        }
    }
}
