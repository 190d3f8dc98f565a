//! Bodies that touch: a glass block on a table, a label on a bottle, a mirror at the back of a pane. Between such surfaces there
//! is nothing, whichever of them rounding puts first.

use snell::light::Light;
use snell::math::{Point3, Ray, Rgb, Transform, Vector3, portable};
use snell::scene::scene;
use snell_testkit::must_fail;

use crate::stage::{Stage, assert_near, children, reflectance, refracted_path};

/// Bodies that stand on y = 0, about two wide and one high.
const BODIES: [&str; 6] = [
    "box = { min = [-1, 0, -1], max = [1, 1, 1] }",
    "cylinder = { base = [0, 0, 0], top = [0, 1, 0] }",
    "cone = { base = [0, 0, 0], top = [0, 1, 0], top_radius = 0.7 }",
    "mesh = { vertices = [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1], [0, 1.3, 0]], faces = [[3, 2, 1, 0], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]] }",
    "intersection = [{ sphere = {} }, { box = { min = [-2, 0, -2], max = [2, 0.8, 2] } }]",
    "sphere = { center = [0, 1, 0] }",
];

const TABLES: [&str; 4] = [
    "plane = {}",
    "box = { min = [-5, -1, -5], max = [5, 0, 5] }",
    "rectangle = { corner = [-5, 0, 5], edge_u = [10, 0, 0], edge_v = [0, 0, -10] }",
    "mesh = { vertices = [[-5, 0, 5], [5, 0, 5], [5, 0, -5], [-5, 0, -5]], faces = [[0, 1, 2, 3]] }",
];

/// A glass body on a white table, both of them placed in the same way, before a blue background.
fn scene(body: &str, table: &str, table_first: bool, placement: &str) -> Stage {
    let body = format!("[[object]]\n{body}\nmaterial = {{ dielectric = {{ ior = 1.5 }} }}\n{placement}\n");
    let table = format!("[[object]]\n{table}\nmaterial = {{ diffuse = 1 }}\n{placement}\n");
    let objects = if table_first { table + &body } else { body + &table };
    Stage::new(&format!("[background]\ncolor = [0, 0, 1]\n{objects}"))
}

/// Looks down on the body in many places; asserts that the table is seen through it, from above.
#[track_caller]
fn table_is_seen(stage: &Stage, place: impl Fn(Point3) -> Point3, what: &str) {
    for x in -4..4 {
        for z in -4..4 {
            let from = Point3::new(f64::from(x) / 7.0 + 0.013, 3.0, f64::from(z) / 7.0 - 0.017);
            let [from, to] = [from, from + Vector3::new(0.05, -3.0, 0.03)].map(&place);
            let (tree, _) = stage.shoot(Ray::new(from, (to - from).normalize()));
            let path = refracted_path(&tree);
            let last = path[path.len() - 1];
            let Some(seen) = last.hit.flatten() else { panic!("{what}: nothing is seen from {from:?}") };
            let material = &stage.scene.materials[seen.material as usize];
            assert!(material.body.is_none(), "{what}: no table is seen from {from:?}");
            assert!(seen.is_outward(-last.task.ray.direction), "{what}: the table from below, from {from:?}");
        }
    }
}

#[test]
fn a_table_is_seen_through_the_glass_that_stands_on_it() {
    let away = Vector3::new(1e4, -300.0, 77.7);
    let moves = format!("translate = {:?}", away.to_array());
    let turn = Transform::rotate(Vector3::X, portable::radians(-30.0));
    for body in BODIES {
        for table in TABLES {
            for table_first in [true, false] {
                let what = format!("{body} on {table}, which is first: {table_first}");
                table_is_seen(&scene(body, table, table_first, ""), |p| p, &what);
                table_is_seen(&scene(body, table, table_first, &moves), |p| p + away, &format!("{what}, far away"));
                let turned = scene(body, table, table_first, "rotate = [-30, 0, 0]");
                table_is_seen(&turned, |p| turn.point(p), &format!("{what}, turned"));
            }
        }
    }
    must_fail("no table there", || {
        table_is_seen(&scene(BODIES[0], "sphere = { center = [0, -9, 0], radius = 0.1 }", true, ""), |p| p, "the twin");
    });
    must_fail("a gap below the glass", || {
        let stage = scene(BODIES[0], "plane = { y = -1e-6 }", true, "");
        let path = stage.ray([0.0, 3.0, 0.0], [0.1, -1.0, 0.0]);
        assert_eq!(refracted_path(&path).len(), 2, "the table is seen from within the glass");
    });
}

#[test]
fn light_reaches_the_table_below_the_glass() {
    // Straight down through the upper face; the lower one touches the table.
    let once = 1.0 - reflectance(1.0, 1.0, 1.5) as f32;
    for body in [BODIES[0], BODIES[1], BODIES[4]] {
        for table in TABLES {
            for table_first in [true, false] {
                let mut stage = scene(body, table, table_first, "");
                stage.scene.lights.push(Light::new(&scene::Light {
                    name: None,
                    kind: scene::LightKind::Directional { direction: -Vector3::Y, angle: 0.0 },
                    intensity: Rgb::WHITE,
                    spectrum: None,
                    falloff: scene::Falloff::None,
                }));
                for (x, z) in [(0.1, 0.2), (-0.33, 0.021), (0.4, -0.1)] {
                    let tree = stage.ray([x, 3.0, z], [0.0, -1.0, 0.0]);
                    let path = refracted_path(&tree);
                    let shadows = &path[path.len() - 1].shadows;
                    assert_eq!(shadows.len(), 1, "{body} on {table}");
                    let arriving = shadows[0].transmittance;
                    assert_near(arriving, Rgb::gray(once), 1e-6, &format!("{body} on {table}, first {table_first}"));
                    must_fail("two boundaries", || assert_near(arriving, Rgb::gray(once * once), 1e-6, "the twin"));
                }
            }
        }
    }
}

#[test]
fn a_mirror_at_the_back_of_a_pane_reflects_within_the_glass() {
    let pane =
        "[[object]]\nbox = { min = [-5, -5, 0], max = [5, 5, 0.1] }\nmaterial = { dielectric = { ior = 1.5 } }\n";
    let silver = "[[object]]\nrectangle = { corner = [-5, -5, 0], edge_u = [10, 0, 0], edge_v = [0, 10, 0] }\nmaterial = { mirror = 0.9 }\n";
    for objects in [pane.to_owned() + silver, silver.to_owned() + pane] {
        let stage = Stage::new(&format!("[background]\ncolor = 1\n{objects}"));
        let direction = Vector3::new(0.3, 0.2, -1.0).normalize();
        let (tree, _) = stage.shoot(Ray::new(Point3::new(0.0, 0.0, 2.0), direction));
        // Into the glass, back at the silver, and out again in the mirrored direction.
        let is_inside = |ray: &&snell::observe::TracedRay| ray.task.media != Default::default();
        let inside = children(&tree, tree.rays[0].task.id).find(is_inside).expect("a refracted ray");
        let back = children(&tree, inside.task.id).next().expect("a mirrored ray");
        assert!(is_inside(&back), "it is in the glass");
        let out = children(&tree, back.task.id).find(|ray| !is_inside(ray)).expect("out again");
        let mirrored = Vector3::new(direction.x(), direction.y(), -direction.z());
        assert!((out.task.ray.direction - mirrored).length() < 1e-12);
        let once = 1.0 - reflectance(-direction.z(), 1.0, 1.5);
        assert!((f64::from(out.task.throughput.g) - 0.9 * once * once).abs() < 1e-6);
    }
}

#[test]
fn a_label_on_a_bottle_is_seen_from_outside() {
    let light = "[[light]]\npoint = { position = [0, 0, 9] }\n";
    let bottle = "[[object]]\nbox = { size = 2 }\nmaterial = { dielectric = { ior = 1.5 } }\n";
    let label = "[[object]]\nrectangle = { corner = [-0.5, -0.5, 1], edge_u = [1, 0, 0], edge_v = [0, 1, 0] }\nmaterial = { diffuse = [1, 0, 0], ambient = 0 }\n";
    for objects in [bottle.to_owned() + label, label.to_owned() + bottle] {
        let stage = Stage::new(&format!("{light}{objects}"));
        for (x, y) in [(0.0, 0.0), (0.31, -0.2), (-0.44, 0.43)] {
            let cosine = 8.0 / (64.0_f64 + x * x + y * y).sqrt();
            let seen = stage.color([x, y, 4.0], [0.0, 0.0, -1.0]);
            assert_near(seen, Rgb::new(cosine as f32, 0.0, 0.0), 1e-6, "the label");
            must_fail("glass without a label", || assert_near(seen, Rgb::BLACK, 1e-6, "the twin"));
        }
    }
}
