//! The twin of `benches/povray/sphereflake.pov` in Snell's own format, written by a program as that one is by a macro.
//!
//! After Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11), 1987: a ball with nine smaller ones on it,
//! six round its equator and three above, and so on. Lengths in the scene's units, z up.

use std::fmt::Write;

type Vector = [f64; 3];

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

[[object]]
material = \"ball\"
group = [
";

/// The scene with balls upon balls, `depth` times.
pub fn scene(depth: u32) -> String {
    let mut text = STAGE.to_owned();
    ball(&mut text, [0.0; 3], 0.5, depth, [0.0, 0.0, 1.0]);
    text += "]\n";
    text
}

/// A ball, and those on it; `up` is a unit vector.
fn ball(text: &mut String, [x, y, z]: Vector, radius: f64, depth: u32, up: Vector) {
    // Writing into a String cannot fail.
    let _ = writeln!(text, "  {{ sphere = {{ center = [{x}, {y}, {z}], radius = {radius} }} }},");
    if depth == 0 {
        return;
    }
    let side = normalized(cross(up, if up[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] }));
    let ahead = cross(up, side);
    for [across, along, above] in directions() {
        let direction = [0, 1, 2].map(|axis| across * side[axis] + along * ahead[axis] + above * up[axis]);
        let [dx, dy, dz] = direction.map(|component| component * radius * 4.0 / 3.0);
        ball(text, [x + dx, y + dy, z + dz], radius / 3.0, depth - 1, direction);
    }
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

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn normalized(v: Vector) -> Vector {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_nine_on_each_and_all_touch_the_one_they_stand_on() {
        for (depth, balls) in [(0, 1), (1, 10), (2, 91), (4, 7381)] {
            assert_eq!(scene(depth).matches("sphere").count(), balls);
        }
        for direction in directions() {
            let length: f64 = direction.iter().map(|x| x * x).sum();
            assert!((length - 1.0).abs() < 1e-15, "{direction:?}");
        }
    }
}
