//! Closed meshes let no light through: not between triangles, not through vertices, however they are placed.

use std::fmt::Write;

use snell::math::{Point3, Ray, Rgb, Vector3};
use snell::scene::Scene;
use snell::scene::scene::{Object, ObjectKind, Shape};
use snell_testkit::{TestRng, must_fail};

use crate::files::scene_of_text;
use crate::stage::Stage;

/// An octahedron whose faces are divided, its vertices moved onto the unit sphere and then a little off it.
fn rough_ball(divisions: u32) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut rng = TestRng::new(3);
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    let corners = [Vector3::X, Vector3::Z, -Vector3::X, -Vector3::Z];
    let mut place = |v: Vector3| {
        // f32, so that equal corners are equal bits.
        let on_sphere = v.normalize().to_array().map(|c| f64::from(c as f32));
        let found = vertices.iter().position(|known: &(Vector3, [f64; 3])| known.0 == Vector3::from(on_sphere));
        found.unwrap_or_else(|| {
            let rough = rng.range(0.9, 1.1);
            vertices.push((Vector3::from(on_sphere), on_sphere.map(|c| c * rough)));
            vertices.len() - 1
        }) as u32
    };
    for pole in [Vector3::Y, -Vector3::Y] {
        for side in 0..4 {
            let [a, b] = [corners[side], corners[(side + 1) % 4]];
            let at = |i: u32, j: u32| {
                let [u, v] = [i, j].map(|k| f64::from(k) / f64::from(divisions));
                pole * (1.0 - u - v) + a * u + b * v
            };
            let mut face = |triangle: [Vector3; 3]| {
                let [p, q, r] = triangle.map(&mut place);
                faces.push(if pole.y() > 0.0 { [p, r, q] } else { [p, q, r] });
            };
            for i in 0..divisions {
                for j in 0..divisions - i {
                    face([at(i, j), at(i + 1, j), at(i, j + 1)]);
                    if i + j + 1 < divisions {
                        face([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                    }
                }
            }
        }
    }
    (vertices.into_iter().map(|(_, place)| place).collect(), faces)
}

/// The ball as a scene; `leave_out` of its last faces are missing.
fn ball(placement: &str, leave_out: usize) -> Scene {
    let (vertices, mut faces) = rough_ball(5);
    faces.truncate(faces.len() - leave_out);
    let mut text = String::from("[[light]]\npoint = { position = [0, 0, 0] }\n[[object]]\n");
    let _ = write!(text, "mesh = {{ vertices = {vertices:?}, faces = {faces:?} }}\n{placement}\n");
    scene_of_text("ball.toml", text.as_bytes())
}

/// Points of the placed mesh that rays like to slip through: its vertices, points on its edges, points within faces.
fn targets(scene: &Scene) -> Vec<Point3> {
    let Object { kind: ObjectKind::Shape(Shape::Mesh(id)), parent_from_object: place, .. } = &scene.objects[0] else {
        panic!("the first object is a mesh");
    };
    let mesh = &scene.meshes[*id];
    let corner = |index: u32| place.point(Point3::from(mesh.positions[index as usize].map(f64::from)));
    let mut targets: Vec<Point3> = (0..mesh.positions.len() as u32).map(corner).collect();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(corner);
        targets.extend([a.lerp(b, 0.5), b.lerp(c, 0.25), c.lerp(a, 0.9), a.lerp(b.lerp(c, 0.5), 0.667)]);
    }
    targets
}

/// Asserts that no light from the middle reaches the outside through any of the points, by shadow rays and by others.
fn lets_nothing_through(scene: &Scene) {
    let stage = Stage::of(scene);
    let middle = Point3::ORIGIN;
    let mut scratch = Default::default();
    for target in targets(scene) {
        for far in [1.5, 40.0] {
            let outside = middle + (target - middle) * far;
            let ray = Ray::new(outside, (middle - outside).normalize());
            let distance = middle.distance(outside);
            assert!(stage.scene.geometry.is_blocked(&ray, distance, &mut scratch), "a leak at {target:?} from {far}");
            let out = Ray::new(middle, (target - middle).normalize());
            assert!(stage.scene.geometry.intersect(&out, f64::INFINITY, &mut scratch).is_some(), "out at {target:?}");
        }
    }
}

const PLACEMENTS: [&str; 3] = ["", "rotate = [10, 20, 30]", "scale = [0.3, 2, 1]\nrotate = [40, -20, 0]"];

#[test]
fn closed_meshes_are_closed() {
    for placement in PLACEMENTS {
        lets_nothing_through(&ball(placement, 0));
    }
    must_fail("a missing triangle", || lets_nothing_through(&ball("", 1)));
}

#[test]
fn a_room_around_a_lamp_in_a_closed_ball_is_dark() {
    // A pixel for every shadow ray: a wide floor around the ball, in whose middle the only light is.
    let room = |leave_out: usize| {
        let mut scene = ball("rotate = [3, 7, 1]", leave_out);
        let mut floor = Object::shape(Shape::Plane { point: Point3::new(0.0, -1.2, 0.0), normal: Vector3::Y });
        floor.name = Some("floor".to_owned());
        scene.objects.push(floor);
        scene.camera.eye = Point3::new(0.0, 3.0, 9.0);
        scene.camera.gaze = Vector3::new(0.0, -3.2, -9.0);
        scene
    };
    let dark = |scene: &Scene| {
        let stage = Stage::of(scene).sized(120, 90);
        assert!(stage.picture().pixels().iter().all(|color| *color == Rgb::BLACK), "some light gets out");
    };
    dark(&room(0));
    must_fail("a missing triangle at the bottom", || dark(&room(1)));
}
