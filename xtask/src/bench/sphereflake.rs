//! The twins of `benches/povray/sphereflake.pov` and `sphereflake-nested.pov`: flat, a line for each ball, in Snell's format and in
//! Tachyon's, which measures reading too; and nested, of prototypes in prototypes, as a person would write it.
//!
//! After Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11), 1987: a ball with nine smaller ones on it,
//! six round its equator and three above, and so on. Lengths in the scene's units, z up. In the flat one the balls' first
//! directions are taken from the world's axes, as the macro does; in the nested one they turn with the ball beneath.

use std::fmt::Write;

use super::vectors::{Vector, cross, normalized};

/// What is not balls: the same camera, lights, colours, depth and limits.
const STAGE: &str = "\
[image]
width = 1024
height = 768

[render]
depth = 6
min_weight = 0.003921569
antialiasing = \"none\"

[camera]
eye = [2.1, 1.3, 1.7]
look_at = [0, 0, 0]
up = [0, 0, 1]
fov = 57.8

[background]
color = [0.078, 0.361, 0.753]

[[light]]
point = { position = [4, 3, 2], intensity = 0.57 }

[[light]]
point = { position = [1, -4, 4], intensity = 0.57 }

[[light]]
point = { position = [-3, 1, 5], intensity = 0.57 }

[material.floor]
diffuse = [0.8, 0.6, 0.264]

# Phong's exponent is a quarter of the one of POV-Ray's highlight, which is Blinn's.
[material.ball]
diffuse = [0.5, 0.45, 0.35]
specular = 0.3
shininess = 5
mirror = 0.5

[[object]]
plane = { point = [0, 0, -0.5], normal = [0, 0, 1] }
material = \"floor\"
";

/// The scene with balls upon balls, `depth` times, each ball a line.
pub fn flat(depth: u32) -> String {
    let mut text = format!("{STAGE}\n[[object]]\nmaterial = \"ball\"\ngroup = [\n");
    for_each_ball([0.0; 3], 0.5, depth, [0.0, 0.0, 1.0], &mut |[x, y, z], radius| {
        // Writing into a String cannot fail.
        let _ = writeln!(text, "  {{ sphere = {{ center = [{x}, {y}, {z}], radius = {radius} }} }},");
    });
    text += "]\n";
    text
}

/// The scene with balls upon balls, `depth` times, as prototypes of which each holds nine of the one before.
pub fn nested(depth: u32) -> String {
    let mut text = format!("{STAGE}\n[prototype.flake0]\nsphere = {{ radius = 0.5 }}\n");
    for level in 1..=depth {
        let _ = writeln!(text, "\n[prototype.flake{level}]\ngroup = [\n  {{ sphere = {{ radius = 0.5 }} }},");
        for ((tilt, turn), direction) in turns().zip(directions()) {
            let [x, y, z] = direction.map(|component| component * 2.0 / 3.0);
            let _ = writeln!(
                text,
                "  {{ instance = \"flake{}\", scale = 0.3333333333333333, rotate = [0, {tilt}, {turn}], translate = [{x}, {y}, {z}] }},",
                level - 1
            );
        }
        text += "]\n";
    }
    let _ = writeln!(text, "\n[[object]]\nmaterial = \"ball\"\ninstance = \"flake{depth}\"");
    text
}

/// The flat scene for Tachyon. It is left-handed, so every x is negated; its picture is 1 / ZOOM high at distance 1.
pub fn tachyon(depth: u32) -> String {
    let mut text = "BEGIN_SCENE\nRESOLUTION 1024 768\n\
        CAMERA PROJECTION PERSPECTIVE ZOOM 1.20767 ASPECTRATIO 1.0 ANTIALIASING 0 RAYDEPTH 6\n\
        CENTER -2.1 1.3 1.7 VIEWDIR 2.1 -1.3 -1.7 UPDIR 0 0 1\nEND_CAMERA\n\
        BACKGROUND 0.078 0.361 0.753\n\
        LIGHT CENTER -4 3 2 RAD 0.01 COLOR 0.57 0.57 0.57\n\
        LIGHT CENTER -1 -4 4 RAD 0.01 COLOR 0.57 0.57 0.57\n\
        LIGHT CENTER 3 1 5 RAD 0.01 COLOR 0.57 0.57 0.57\n\
        TEXDEF floor AMBIENT 0 DIFFUSE 0.8 SPECULAR 0 OPACITY 1 COLOR 1 0.75 0.33 TEXFUNC 0\n\
        TEXDEF ball AMBIENT 0 DIFFUSE 0.5 SPECULAR 0.5 OPACITY 1 PHONG PLASTIC 0.3 PHONG_SIZE 5 COLOR 1 0.9 0.7 TEXFUNC 0\n\
        PLANE CENTER 0 0 -0.5 NORMAL 0 0 1 floor\n"
        .to_owned();
    for_each_ball([0.0; 3], 0.5, depth, [0.0, 0.0, 1.0], &mut |[x, y, z], radius| {
        let _ = writeln!(text, "SPHERE CENTER {} {y} {z} RAD {radius} ball", -x);
    });
    text += "END_SCENE\n";
    text
}

/// The flat scene as NFF.
pub fn nff(depth: u32) -> String {
    let mut text =
        "b 0.078 0.361 0.753\nv\nfrom 2.1 1.3 1.7\nat 0 0 0\nup 0 0 1\nangle 45\nhither 0.01\nresolution 768 768\n\
        l 4 3 2\nl 1 -4 4\nl -3 1 5\nf 1 0.75 0.33 0.8 0 100000 0 1\n\
        p 4\n12 12 -0.5\n-12 12 -0.5\n-12 -12 -0.5\n12 -12 -0.5\nf 1 0.9 0.7 0.5 0.5 3.0827 0 1\n"
            .to_owned();
    for_each_ball([0.0; 3], 0.5, depth, [0.0, 0.0, 1.0], &mut |[x, y, z], radius| {
        let _ = writeln!(text, "s {x} {y} {z} {radius}");
    });
    text
}

/// A ball, and those on it; `up` is a unit vector.
fn for_each_ball([x, y, z]: Vector, radius: f64, depth: u32, up: Vector, ball: &mut impl FnMut(Vector, f64)) {
    ball([x, y, z], radius);
    if depth == 0 {
        return;
    }
    let side = normalized(cross(up, if up[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] }));
    let ahead = cross(up, side);
    for [across, along, above] in directions() {
        let direction = [0, 1, 2].map(|axis| across * side[axis] + along * ahead[axis] + above * up[axis]);
        let [dx, dy, dz] = direction.map(|component| component * radius * 4.0 / 3.0);
        for_each_ball([x + dx, y + dy, z + dz], radius / 3.0, depth - 1, direction, ball);
    }
}

/// How the nine are turned away from the one's upward axis and then about it, in degrees: as [`directions`].
fn turns() -> impl Iterator<Item = (f64, f64)> {
    let flat = (0..6).map(|step| (90.0, 60.0 * f64::from(step)));
    // The angle whose tangent is 1 / sqrt 2, of a cube's corner from its axis.
    flat.chain((0..3).map(|step| (35.264_389_682_754_654, 120.0 * f64::from(step) + 30.0)))
}

/// Where the nine stand on the one, as unit vectors: six at 0, 60, ... degrees, three as high as a cube's corners.
fn directions() -> [Vector; 9] {
    let (half, root) = (0.5, 0.75_f64.sqrt());
    let (flat, high) = ((1.0 / 3.0_f64).sqrt(), (2.0 / 3.0_f64).sqrt());
    [
        [1.0, 0.0, 0.0],
        [half, root, 0.0],
        [-half, root, 0.0],
        [-1.0, 0.0, 0.0],
        [-half, -root, 0.0],
        [half, -root, 0.0],
        [flat * root, flat * half, high],
        [-flat * root, flat * half, high],
        [0.0, -flat, high],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_nine_on_each_and_all_touch_the_one_they_stand_on() {
        for (depth, balls) in [(0, 1), (1, 10), (2, 91), (4, 7381)] {
            assert_eq!(flat(depth).matches("sphere").count(), balls);
            assert_eq!(nff(depth).lines().filter(|line| line.starts_with("s ")).count(), balls);
            assert_eq!(tachyon(depth).matches("SPHERE").count(), balls);
        }
        for direction in directions() {
            let length: f64 = direction.iter().map(|x| x * x).sum();
            assert!((length - 1.0).abs() < 1e-15, "{direction:?}");
        }
    }

    #[test]
    fn the_nested_one_is_short_and_has_nine_instances_a_level() {
        let text = nested(5);
        assert_eq!(text.matches("instance").count(), 9 * 5 + 1);
        assert!(text.lines().count() < 120, "a person could have written it");
    }

    #[test]
    #[expect(clippy::disallowed_methods, reason = "compared within a tolerance")]
    fn turning_gives_the_same_directions() {
        for ((tilt, turn), [x, y, z]) in turns().zip(directions()) {
            let (tilt, turn) = (tilt.to_radians(), turn.to_radians());
            let turned = [tilt.sin() * turn.cos(), tilt.sin() * turn.sin(), tilt.cos()];
            assert!([x, y, z].iter().zip(turned).all(|(a, b)| (a - b).abs() < 1e-12), "{turned:?}");
        }
    }
}
