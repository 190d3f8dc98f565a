//! Beer and Lambert's law along known chords.

use snell::math::{Rgb, portable};
use snell::task::Term;
use snell_testkit::must_fail;

use crate::stage::{Stage, assert_near, reflectance, refracted_path, share};

/// The colour after one unit of length.
const COLOR: [f64; 3] = [0.2, 0.7, 0.95];

fn body(shape: &str, ior: f64) -> Stage {
    Stage::new(&format!(
        "[background]\ncolor = [1, 0.5, 0.25]\n[[object]]\n{shape}\nmaterial = {{ dielectric = {{ ior = {ior:?}, \
         absorption = {{ color = {COLOR:?} }} }} }}\n"
    ))
}

/// The background's colour after a length inside, times a factor.
fn expected(length: f64, factor: f64) -> Rgb {
    let [r, g, b] = COLOR.map(|color| (portable::exp(portable::ln(color) * length) * factor) as f32);
    Rgb::new(r, 0.5 * g, 0.25 * b)
}

#[test]
fn a_chord_absorbs_exponentially() {
    let ball = body("sphere = { radius = 2 }", 1.0);
    for height in [0.0, 0.5, 1.2, 1.9, 1.999] {
        let chord = 2.0 * (4.0_f64 - height * height).sqrt();
        let seen = ball.color([0.0, height, 9.0], [0.0, 0.0, -1.0]);
        assert_near(seen, expected(chord, 1.0), 2e-6, &format!("chord {chord}"));
        must_fail("a chord that is 1 % longer", || assert_near(seen, expected(1.01 * chord, 1.0), 2e-6, "the twin"));
    }
    // Not at normal incidence, through a box: by the slope of the ray.
    let slab = body("box = { min = [-9, -9, 0], max = [9, 9, 0.5] }", 1.0);
    let slope = (1.0_f64 + 0.36 + 0.04).sqrt();
    assert_near(slab.color([0.0, 0.0, 5.0], [0.6, 0.2, -1.0]), expected(0.5 * slope, 1.0), 2e-6, "a slanted ray");
    // Beginning inside, and transformed: lengths are the world's.
    let stretched = body("sphere = {}\nscale = [1, 1, 3]\ntranslate = [0, 0, 7]", 1.0);
    assert_near(stretched.color([0.0, 0.0, 6.0], [0.0, 0.0, 1.0]), expected(4.0, 1.0), 2e-6, "from inside");
    // What never ends is black.
    let ocean = body("plane = {}", 1.0);
    assert_eq!(ocean.color([0.0, 1.0, 0.0], [0.0, -1.0, 0.0]), Rgb::BLACK);
}

#[test]
fn refraction_and_absorption_multiply() {
    let n = 1.5;
    let ball = body("sphere = {}", n);
    for height in [0.0, 0.3, 0.8] {
        let tree = ball.ray([0.0, height, 9.0], [0.0, 0.0, -1.0]);
        let path = refracted_path(&tree);
        let seen = share(&tree, path[2].task.id, |term| term == Term::Background);
        let cosine = (1.0_f64 - height * height).sqrt();
        let cosine_inside = (1.0 - height * height / (n * n)).sqrt();
        let through = (1.0 - reflectance(cosine, 1.0, n)) * (1.0 - reflectance(cosine_inside, n, 1.0));
        assert_near(seen, expected(2.0 * cosine_inside, through), 2e-6, &format!("at {height}"));
    }
}
