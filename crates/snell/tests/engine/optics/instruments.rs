//! A ball, lenses and a prism in real scenes, traced ray by ray: Hecht, *Optics*, chapters 5 and 6.

use snell::math::{Dispersion, Point3, Ray, Vector3, portable};
use snell::scene::catalogue;
use snell_testkit::must_fail;

use crate::stage::{Stage, refracted_path};

/// The index of a catalogue glass at the sodium D line, where light goes that does not split.
fn index(name: &str) -> f64 {
    let dispersion: Dispersion = catalogue::lookup(name).expect("a glass of the catalogue").dispersion();
    dispersion.index(589.3)
}

/// The ray that leaves a body after two refractions; where it starts is where it leaves.
fn behind(stage: &Stage, origin: Point3, direction: Vector3) -> Ray {
    let (tree, _) = stage.shoot(Ray::new(origin, direction));
    let path = refracted_path(&tree);
    assert_eq!(path.len(), 3, "two refractions from {origin:?}");
    path[2].task.ray
}

/// The focal length and where the focus is on the z axis, for a ray along it at a height.
fn focus(stage: &Stage, height: f64) -> [f64; 2] {
    let out = behind(stage, Point3::new(0.0, height, -20.0), Vector3::Z);
    let slope = out.direction.y() / out.direction.z();
    [-height / slope, out.origin.z() - out.origin.y() / slope]
}

/// The same near the axis: spherical aberration grows with the square of the height, so two heights cancel it.
fn paraxial_focus(stage: &Stage) -> [f64; 2] {
    let (one, half) = (focus(stage, 4e-3), focus(stage, 2e-3));
    [0, 1].map(|i| (4.0 * half[i] - one[i]) / 3.0)
}

fn lens(radius1: f64, radius2: f64, thickness: f64, ior: &str) -> Stage {
    Stage::new(&format!(
        "[render]\nbands = 1\n[[object]]\nlens = {{ radius1 = {radius1:?}, radius2 = {radius2:?}, thickness = {thickness:?}, \
         diameter = 1 }}\nmaterial = {{ dielectric = {{ ior = {ior} }} }}\n"
    ))
}

/// Asserts a lens's focal length and focus by the lensmaker's equation with thickness.
#[track_caller]
fn focuses_as_its_maker_said(stage: &Stage, n: f64, first: f64, second: f64, thickness: f64) {
    let power = (n - 1.0) * (1.0 / first - 1.0 / second + (n - 1.0) * thickness / (n * first * second));
    let behind_the_vertex = (1.0 - (n - 1.0) * thickness / (n * first)) / power;
    let [focal_length, at] = paraxial_focus(stage);
    assert!((focal_length * power - 1.0).abs() < 1e-8, "focal length {focal_length}, power {power}");
    assert!((at - 0.5 * thickness - behind_the_vertex).abs() < 1e-8 / power.abs(), "{at} {behind_the_vertex}");
}

#[test]
fn lenses_focus_as_the_lensmaker_says() {
    let crown = index("N-BK7");
    assert!((crown - 1.5167).abs() < 1e-4);
    for (first, second, thickness) in [(3.0, -5.0, 0.4), (2.0, 4.0, 0.3), (-2.0, 3.0, 0.2), (2.0, -2.0, 1.0)] {
        let stage = lens(first, second, thickness, "\"N-BK7\"");
        focuses_as_its_maker_said(&stage, crown, first, second, thickness);
        must_fail("the thickness of the equation is wrong", || {
            focuses_as_its_maker_said(&stage, crown, first, second, thickness * 1.01);
        });
    }
    focuses_as_its_maker_said(&lens(3.0, -4.0, 0.5, "1.7"), 1.7, 3.0, -4.0, 0.5);
}

#[test]
fn a_ball_lens_has_its_focal_length() {
    for n in [1.333, 1.5, 1.9] {
        let stage = Stage::new(&format!("[[object]]\nsphere = {{}}\nmaterial = {{ dielectric = {{ ior = {n} }} }}"));
        let [focal_length, at] = paraxial_focus(&stage);
        let expected = n * 2.0 / (4.0 * (n - 1.0));
        assert!((focal_length / expected - 1.0).abs() < 1e-8 && (at / expected - 1.0).abs() < 1e-8, "{n}: {at}");
    }
}

#[test]
fn a_ball_turns_the_board_behind_it_upside_down() {
    let scene = |ior: &str| {
        Stage::new(&format!(
            "[[object]]\nsphere = {{}}\nmaterial = {{ dielectric = {{ ior = {ior} }} }}\n[[object]]\n\
             plane = {{ z = -6 }}\nmaterial = {{ diffuse = {{ checker = {{ size = 0.5 }} }} }}\n"
        ))
    };
    let turned = |stage: &Stage| {
        for (x, y) in [(0.3, 0.2), (-0.4, 0.1), (0.1, -0.5), (-0.2, -0.35), (0.6, 0.0)] {
            let (tree, _) = stage.shoot(Ray::new(Point3::new(x, y, 5.0), -Vector3::Z));
            let path = refracted_path(&tree);
            let on_board = path[2].hit.flatten().expect("it meets the board").point;
            // By the angles at the ball: the whole deviation is 2 (θ_i − θ_t), towards the axis.
            let height = (x * x + y * y).sqrt();
            let (incident, inside) = (portable::asin(height), portable::asin(height / 1.5));
            let deviation = 2.0 * (incident - inside);
            // It leaves the ball at the polar angle π − (θ_i − deviation) from +z.
            let polar = incident - deviation;
            let expected = portable::sin(polar) - (6.0 - portable::cos(polar)) * portable::tan(deviation);
            let seen = (on_board.x() * x + on_board.y() * y) / height;
            assert!((seen - expected).abs() < 1e-9, "{seen} instead of {expected}");
            assert!(expected < 0.0 && (on_board.x() * y - on_board.y() * x).abs() < 1e-9);
        }
    };
    turned(&scene("1.5"));
    must_fail("another glass", || turned(&scene("1.49")));
    must_fail("no glass", || turned(&scene("1.0")));
}

#[test]
fn a_prism_deviates_least_by_the_known_angle() {
    // Apex angle 60° but for the rounding of the mesh's f32, edges along z.
    let s = f64::from(3.0_f32.sqrt());
    let apex = 2.0 * portable::atan2(1.0, s);
    let prism = |name: &str| {
        Stage::new(&format!(
            "[render]\nbands = 1\n[[object]]\nmaterial = {{ dielectric = {{ ior = \"{name}\" }} }}\nmesh = {{ \
             vertices = [[-1, 0, 2], [1, 0, 2], [0, {s:?}, 2], [-1, 0, -2], [1, 0, -2], [0, {s:?}, -2]], \
             faces = [[0, 1, 2], [5, 4, 3], [0, 3, 4, 1], [1, 4, 5, 2], [2, 5, 3, 0]] }}"
        ))
    };
    // A ray in the plane z = 0 meets the middle of the left face at an angle of incidence.
    let deviation = |stage: &Stage, incidence: f64| -> f64 {
        let angle = portable::radians(-30.0) + incidence;
        let direction = Vector3::new(portable::cos(angle), portable::sin(angle), 0.0);
        let (tree, _) = stage.shoot(Ray::new(Point3::new(-0.5, 0.5 * s, 0.0) - direction * 3.0, direction));
        // Too steep a ray is totally reflected at the other face.
        let out = refracted_path(&tree).get(2).map(|ray| ray.task.ray.direction);
        out.map_or(f64::INFINITY, |out| portable::acos(direction.dot(out.normalize())))
    };
    let least = |stage: &Stage| {
        let (mut low, mut high) = (portable::radians(35.0), portable::radians(80.0));
        for _ in 0..80 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if deviation(stage, a) < deviation(stage, b) { high = b } else { low = a }
        }
        deviation(stage, low)
    };
    // n sin(A/2) = sin((A + D)/2).
    let known = |n: f64| 2.0 * portable::asin(n * portable::sin(0.5 * apex)) - apex;
    for name in ["N-BK7", "N-SF11"] {
        let stage = prism(name);
        assert!((least(&stage) - known(index(name))).abs() < 1e-9, "{name}");
        let check = |n: f64| assert!((least(&stage) - known(n)).abs() < 1e-9);
        must_fail("an index that is wrong in the fifth digit", || check(index(name) + 1e-5));
    }
}
