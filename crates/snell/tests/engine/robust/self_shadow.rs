//! No surface shadows itself: under a light at the camera whatever is seen is lit, with just the cosine that geometry gives,
//! for every shape, from a thousandth to a million units large, a million units away, stretched, turned and instanced.

use std::fmt::Write;

use snell::math::Rgb;
use snell_testkit::must_fail;

use crate::stage::Stage;

/// Shapes of about unit size around the origin.
const SHAPES: [(&str, &str); 11] = [
    ("sphere", "sphere = {}"),
    ("box", "box = { size = 1.4 }"),
    ("cylinder", "cylinder = { base = [0, -0.8, 0], top = [0, 0.8, 0], radius = 0.7 }"),
    ("cone", "cone = { base = [0, -0.8, 0], top = [0, 0.8, 0], base_radius = 0.9 }"),
    ("truncated cone", "cone = { base = [0, -0.8, 0], top = [0.3, 0.8, 0], base_radius = 0.9, top_radius = 0.3 }"),
    ("torus", "torus = { major_radius = 0.8, minor_radius = 0.3, axis = [1, 2, 3] }"),
    ("disk", "disk = { normal = [0.3, 0.5, 1], inner_radius = 0.2 }"),
    ("rectangle", "rectangle = { corner = [-0.7, -0.7, 0], edge_u = [1.4, 0, 0], edge_v = [0, 1.4, 0.0] }"),
    (
        "mesh",
        "mesh = { vertices = [[0, 1.1, 0], [-0.9, -0.6, 0.7], [0.9, -0.6, 0.7], [0, -0.6, -1]], faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]] }",
    ),
    ("shell", "difference = [{ sphere = {} }, { sphere = { center = [0.2, 0.3, 0.9], radius = 0.8 } }]"),
    (
        "solid of coincident faces",
        "union = [{ box = { min = [-0.7, -0.7, -0.7], max = [0, 0.7, 0.7] } }, { box = { min = [0, -0.7, -0.7], max = [0.7, 0.7, 0.7] } }, \
         { cylinder = { base = [0, 0.7, 0], top = [0, 0.9, 0], radius = 0.4 } }]",
    ),
];

/// How an object is placed besides its size: as it is, turned, stretched and turned, as an instance.
const PLACEMENTS: [(&str, [f64; 3], [f64; 3], bool); 4] = [
    ("straight", [1.0; 3], [0.0; 3], false),
    ("turned", [1.0; 3], [25.0, 40.0, -10.0], false),
    ("stretched", [1.0, 0.4, 1.3], [10.0, -25.0, 30.0], false),
    ("instanced", [1.2, 0.8, -1.0], [20.0, 50.0, 5.0], true),
];

/// A shape of that size somewhere, seen by a camera near it under a light at the camera.
fn scene(shape: &str, size: f64, away: [f64; 3], stretch: [f64; 3], turn: [f64; 3], instanced: bool) -> Stage {
    let eye = [0, 1, 2].map(|axis| away[axis] + size * [1.1, 1.7, 3.2][axis]);
    let scale = stretch.map(|factor| factor * size);
    let mut text = format!(
        "[camera]\neye = {eye:?}\nlook_at = {away:?}\nfov = 36\n[[light]]\npoint = {{ position = {eye:?} }}\n[material.white]\n\
         diffuse = 1\nambient = 0\n"
    );
    let placed = format!("material = \"white\"\nscale = {scale:?}\nrotate = {turn:?}\ntranslate = {away:?}\n");
    if instanced {
        // Enough of them that they are not copied to where they stand; the others are out of sight.
        let others = "{ grid = { count = [9, 1, 1], of = { sphere = { center = [0, 20, -30], radius = 0.1 } } } }";
        let _ =
            writeln!(text, "[prototype.p]\ngroup = [{{ {shape} }}, {others}]\n[[object]]\ninstance = \"p\"\n{placed}");
    } else {
        let _ = writeln!(text, "[[object]]\n{shape}\n{placed}");
    }
    Stage::new(&text).sized(12, 12)
}

/// Asserts that everything seen is lit by exactly the cosine; how many pixels that were.
fn is_fully_lit(stage: &Stage, what: &str) -> usize {
    let picture = stage.picture();
    let mut lit = 0;
    for ([x, y], tree) in stage.trees() {
        let Some(surface) = tree.rays[0].hit.flatten() else { continue };
        let cosine = surface.shading_normal.dot(tree.rays[0].task.ray.direction).abs();
        // At the silhouette the rounding of the point decides what is seen at all.
        if cosine < 1e-3 {
            continue;
        }
        let color = picture.get(x, y).expect("a pixel");
        let difference = (*color - Rgb::gray(cosine as f32)).max_abs();
        assert!(difference < 1e-4, "{what}: {color:?} at {x}, {y}, where the cosine is {cosine}");
        lit += 1;
    }
    lit
}

#[test]
fn nothing_shadows_itself() {
    for (name, shape) in SHAPES {
        for (placement, stretch, turn, instanced) in PLACEMENTS {
            for size in [1e-3, 1.0, 1e3, 1e6] {
                for away in [[0.0; 3], [1e6, -7e5, 3e5]] {
                    let what = format!("{name}, {placement}, of size {size}, at {away:?}");
                    let lit = is_fully_lit(&scene(shape, size, away, stretch, turn, instanced), &what);
                    assert!(lit > 3, "{what}: {lit} pixels");
                }
            }
        }
    }
}

#[test]
fn a_shadow_is_told() {
    // A speck between the camera and the sphere.
    let shape = "union = [{ sphere = {} }, { sphere = { center = [0.4, 0.6, 1.2], radius = 0.2 } }]";
    let mut stage = scene(shape, 1.0, [0.0; 3], [1.0; 3], [0.0; 3], false);
    // The light is at the camera, so the speck's shadow is behind it, until the camera moves.
    stage.scene.camera.eye = snell::math::Point3::new(3.2, 1.0, 2.0);
    stage.scene.camera.gaze = snell::math::Vector3::new(-3.2, -1.0, -2.0);
    must_fail("a shadow", || is_fully_lit(&stage, "the twin"));
}
