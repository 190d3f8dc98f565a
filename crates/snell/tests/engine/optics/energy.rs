//! The furnace: where light is the same everywhere and nothing absorbs, nothing can be seen. Every pixel is white, but for
//! exactly the weight of the rays that were not followed.

use snell::math::Rgb;
use snell::statistics::Statistics;
use snell_testkit::must_fail;

use crate::stage::{Stage, assert_near};

/// Asserts that the shares and what was cut off add up to white, in every pixel; gives the counts.
fn is_white(stage: &Stage, tolerance: f32) -> Statistics {
    every_pixel_is_white(stage, 1, tolerance);
    stage.render().statistics
}

/// The same in every `step`th column and row.
fn every_pixel_is_white(stage: &Stage, step: u32, tolerance: f32) {
    for ([x, y], tree) in stage.trees_every(step) {
        let cut = tree.rays.iter().flat_map(|ray| &ray.cuts).fold(Rgb::BLACK, |sum, cut| sum + cut.weight);
        assert_near(tree.sum() + cut, Rgb::WHITE, tolerance, &format!("pixel {x}, {y}"));
    }
}

fn furnace(objects: &str, depth: u32) -> Stage {
    Stage::new(&format!(
        "[render]\ndepth = {depth}\n[background]\ncolor = 1\n[camera]\neye = [0.2, 0.6, 5]\nlook_at = [0, 0, 0]\n\
         [material.glass]\ndielectric = {{ ior = 1.5 }}\n[material.flint]\ndielectric = {{ ior = \"N-SF11\" }}\n\
         [material.water]\ndielectric = {{ ior = \"water\", priority = -1 }}\n{objects}"
    ))
    .sized(20, 15)
}

const BALL: &str = "[[object]]\nsphere = {}\nmaterial = \"glass\"\n";

#[test]
fn nothing_is_lost_or_won() {
    let solids = [
        "box = { size = 1.6 }\nrotate = [20, 30, 0]",
        "torus = { minor_radius = 0.4 }\nrotate = [60, 0, 0]",
        "cylinder = { base = [0, -1, 0], top = [0, 1, 0], radius = 0.8 }\nrotate = [0, 0, 40]",
        "cone = { base = [0, -1, 0], top = [0, 1, 0] }",
        "lens = { radius1 = 2, radius2 = -2, thickness = 0.7, diameter = 2 }",
        "difference = [{ sphere = {} }, { sphere = { radius = 0.9 } }]",
        "difference = [{ box = { size = 1.6 } }, { sphere = { radius = 0.95 } }]\nrotate = [10, 20, 30]",
        "sphere = {}\nscale = [1, 0.5, 2]\nrotate = [0, 45, 0]",
        "mesh = { vertices = [[0, 1.4, 0], [-1, -0.7, 0.7], [1, -0.7, 0.7], [0, -0.7, -1]], faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]] }",
    ];
    for solid in solids {
        let stage = furnace(&format!("[[object]]\n{solid}\nmaterial = \"glass\"\n"), 7);
        let statistics = is_white(&stage, 2e-5);
        assert!(statistics.refracted_rays > 0, "{solid}");
    }
    // Nested: water in a glass shell, and a bubble in the water.
    let nested = furnace(
        "[[object]]\ndifference = [{ sphere = {} }, { sphere = { radius = 0.8 } }]\nmaterial = \"glass\"\n\
         [[object]]\nsphere = { radius = 0.9 }\nmaterial = \"water\"\n\
         [[object]]\nsphere = { radius = 0.3, center = [0.2, 0, 0] }\nmaterial = { dielectric = { ior = 1 } }\n",
        8,
    );
    is_white(&nested, 2e-5);
    // Dispersion: many bands, some of them of negative weight; as many as the pixels of a large picture can show.
    let mut flint = furnace(&BALL.replace("glass", "flint"), 6).sized(2000, 1500);
    flint.settings.bands = 16;
    let split = flint.trees_every(250).map(|(_, tree)| tree.rays.iter().filter(|ray| ray.task.band.is_some()).count());
    assert!(split.max() > Some(16));
    every_pixel_is_white(&flint, 125, 5e-5);
}

#[test]
fn a_furnace_that_leaks_is_told() {
    let tinted = BALL.replace("\"glass\"", "{ dielectric = { transmit = 0.999 } }");
    must_fail("a boundary that keeps a thousandth", || is_white(&furnace(&tinted, 6), 2e-5));
}

#[test]
fn a_ball_that_is_followed_to_the_end_is_white() {
    let mut stage = furnace(BALL, 60);
    stage.settings.min_weight = 0.0;
    let rendering = stage.render();
    let lost = rendering.statistics.cut_weight();
    assert!(lost < 1e-6, "{lost}");
    for color in rendering.image.pixels() {
        assert_near(*color, Rgb::WHITE, 1e-4, "a pixel");
    }
}

#[test]
fn mirrors_lose_what_they_should() {
    let mut stage = furnace("[[object]]\nsphere = {}\nmaterial = { mirror = 0.5 }\n", 5);
    assert_eq!(stage.color([0.0, 0.0, 5.0], [0.0, 0.0, -1.0]), Rgb::gray(0.5));
    // A glowing, mirroring room: 1 + 1/2 + 1/4 ... over as many rays as are followed.
    stage = furnace("[[object]]\nbox = { size = 20 }\nmaterial = { mirror = 0.5, emission = 1 }\n", 5);
    stage.settings.min_weight = 0.0;
    for depth in [1_u16, 2, 5, 12] {
        stage.settings.depth = depth;
        let expected = 2.0 - 2.0 / f32::from(1_u16 << depth);
        for color in stage.picture().pixels() {
            assert_eq!(*color, Rgb::gray(expected), "depth {depth}");
        }
        must_fail("a bounce more", || {
            assert_eq!(stage.color([0.0; 3], [1.0, 0.3, 0.2]).r, 2.0 - 1.0 / f32::from(1_u16 << depth))
        });
    }
}
