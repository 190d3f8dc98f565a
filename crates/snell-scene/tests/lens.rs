//! Lenses against closed forms: which points are inside, by the surfaces of the optician.

use snell_math::{Point3, Vector3};
use snell_scene::assets::MemoryAssets;
use snell_scene::document::read_scene;
use snell_scene::scene::{CsgOperation, ObjectKind, Shape};

/// Whether a point is inside a solid, straight from the definitions.
fn inside(kind: &ObjectKind, p: Point3) -> bool {
    match kind {
        ObjectKind::Csg { operation, parts } => {
            let mut of_parts = parts.iter().map(|part| inside(&part.kind, p));
            match operation {
                CsgOperation::Union => of_parts.any(|inside| inside),
                CsgOperation::Intersection => of_parts.all(|inside| inside),
                CsgOperation::Difference => of_parts.next().unwrap() && !of_parts.any(|inside| inside),
            }
        }
        ObjectKind::Shape(Shape::Sphere { center, radius }) => p.distance(*center) < *radius,
        ObjectKind::Shape(Shape::Plane { point, normal }) => (p - *point).dot(*normal) < 0.0,
        ObjectKind::Shape(Shape::Cylinder { base, top, radius, .. }) => {
            let axis = *top - *base;
            let along = (p - *base).dot(axis) / axis.length_squared();
            let across = (p - *base) - axis * along;
            (0.0..1.0).contains(&along) && across.length() < *radius
        }
        other => panic!("a lens has no {other:?}"),
    }
}

/// Where a surface of radius `r` through the axis at `z` lies at the distance `d` from the axis.
fn surface(z: f64, r: Option<f64>, d: f64) -> f64 {
    r.map_or(z, |r| z + r - r.signum() * (r * r - d * d).max(0.0).sqrt())
}

fn lens(r1: Option<f64>, r2: Option<f64>, thickness: f64, diameter: f64) -> ObjectKind {
    let radius = |key: &str, r: Option<f64>| r.map_or(String::new(), |r| format!("{key} = {r}, "));
    let text = format!(
        "[[object]]\nlens = {{ {}{}thickness = {thickness}, diameter = {diameter} }}\n",
        radius("radius1", r1),
        radius("radius2", r2)
    );
    let (scene, diagnostics) = read_scene("lens.toml", text.as_bytes(), &MemoryAssets::default(), &[]);
    scene.unwrap_or_else(|| panic!("{text}: {:?}", diagnostics.list)).objects.remove(0).kind
}

/// Points on a fine grid that are inside where they should not be or the other way round; those within 1e-9 of a surface
/// aside.
fn differences(kind: &ObjectKind, r1: Option<f64>, r2: Option<f64>, thickness: f64, diameter: f64) -> usize {
    let (rim, reach) = (0.5 * diameter, 2.0 * (thickness + diameter));
    let mut count = 0;
    for i in 0..=40 {
        let d = 1.2 * rim * f64::from(i) / 40.0;
        let front = surface(-0.5 * thickness, r1, d.min(rim));
        let back = surface(0.5 * thickness, r2, d.min(rim));
        for j in 0..=400 {
            let z = reach * (f64::from(j) / 200.0 - 1.0);
            if (d - rim).abs() < 1e-9 || (z - front).abs() < 1e-9 || (z - back).abs() < 1e-9 {
                continue;
            }
            let expected = d < rim && front < z && z < back;
            let angle = f64::from(i * 7 + j);
            let p = Point3::new(d * angle.cos(), d * angle.sin(), z);
            count += usize::from(inside(kind, p) != expected);
        }
    }
    count
}

const LENSES: [(Option<f64>, Option<f64>, f64, f64); 16] = [
    (Some(4.0), Some(-4.0), 0.6, 2.0),
    (Some(2.0), None, 0.5, 2.0),
    (None, Some(-2.0), 0.5, 2.0),
    (Some(-3.0), Some(3.0), 0.2, 2.0),
    (None, Some(3.0), 0.2, 2.0),
    (Some(-3.0), None, 0.2, 2.0),
    (Some(2.0), Some(4.0), 0.4, 2.0),
    (Some(4.0), Some(2.0), 0.4, 2.0),
    (Some(-4.0), Some(-2.0), 0.4, 2.0),
    (Some(-2.0), Some(-4.0), 0.4, 2.0),
    (None, None, 0.4, 2.0),
    // A ball, a ball with its rim ground off, a half ball, a rod with round ends, a rod with hollow ends.
    (Some(1.0), Some(-1.0), 2.0, 2.0),
    (Some(1.0), Some(-1.0), 2.0, 1.0),
    (Some(1.0), None, 1.0, 2.0),
    (Some(1.0), Some(-1.0), 7.0, 2.0),
    (Some(-1.0), Some(1.0), 7.0, 2.0),
];

#[test]
fn all_kinds_of_lenses_fill_the_space_between_their_surfaces() {
    for (r1, r2, thickness, diameter) in LENSES {
        let kind = lens(r1, r2, thickness, diameter);
        assert_eq!(differences(&kind, r1, r2, thickness, diameter), 0, "{r1:?} {r2:?} {thickness} {diameter}");
    }
}

/// The twin: a lens of slightly other radius must be told apart.
#[test]
fn another_lens_is_noticed() {
    let kind = lens(Some(4.0), Some(-4.0), 0.6, 2.0);
    assert!(differences(&kind, Some(3.5), Some(-4.0), 0.6, 2.0) > 0);
    assert!(differences(&kind, Some(4.0), Some(-4.0), 0.7, 2.0) > 0);
}

#[test]
fn thickness_on_the_axis_and_at_the_rim_is_as_computed() {
    // Biconvex: the sag of radius 4 at 1 is 4 − √15.
    let kind = lens(Some(4.0), Some(-4.0), 0.6, 2.0);
    let edge = 0.6 - 2.0 * (4.0 - 15.0_f64.sqrt());
    let extent = |d: f64| {
        let steps = 200_000;
        let count = (0..steps)
            .filter(|i| inside(&kind, Point3::new(d, 0.0, 2.0 * (f64::from(*i) + 0.5) / f64::from(steps) - 1.0)))
            .count();
        count as f64 * 2.0 / f64::from(steps)
    };
    assert!((extent(0.0) - 0.6).abs() < 2e-5);
    assert!((extent(1.0 - 1e-9) - edge).abs() < 2e-5, "{} {edge}", extent(1.0 - 1e-9));
}

#[test]
fn a_lens_turns_with_its_axis() {
    let text = b"[[object]]\nlens = { radius1 = 2, thickness = 0.5, diameter = 2, axis = [0, -3, 0] }\n";
    let (scene, _) = read_scene("lens.toml", text, &MemoryAssets::default(), &[]);
    let kind = &scene.unwrap().objects[0].kind;
    // The convex side is the first that light along −y meets: it is above.
    let (axis, side) = (Vector3::Y, Vector3::X);
    let at = |up: f64, out: f64| inside(kind, Point3::ORIGIN + axis * up + side * out);
    assert!(at(0.249, 0.0) && !at(0.251, 0.0) && at(-0.249, 0.9) && !at(0.2, 0.9) && !at(-0.251, 0.0));
}
