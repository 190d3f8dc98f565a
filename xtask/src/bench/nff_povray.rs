//! A scene of the Standard Procedural Databases as POV-Ray reads it, by the rules that ours is rendered by (see the first lines of
//! `crates/snell-scene/src/reader/nff/mod.rs`): 513 x 513 rays, depth 5, no ray cut off.
//!
//! What is fastest for POV-Ray is chosen: triangles and quadrangles of one fill are one mesh, and a fill's shapes are one union, which
//! POV-Ray takes apart again and which gives transparent bodies one inside.

use std::fmt::Write;

use super::nff::{Nff, Part, Shape};
use super::vectors::Vector;

/// The scene file's text.
pub fn scene(nff: &Nff) -> String {
    let mut text = "#version 3.7;\nglobal_settings { max_trace_level 5 adc_bailout 0 assumed_gamma 1 }\n".to_owned();
    let Nff { from, at, up, angle, rows, .. } = nff;
    // 513 rows as far apart as those of the file.
    let _ = writeln!(
        text,
        "camera {{ perspective location {} right -x up y sky {} angle degrees(2*atan2(tan(radians({angle}/2))*513/{}, 1)) look_at {} }}",
        vector(*from),
        vector(*up),
        rows - 1.0,
        vector(*at)
    );
    let _ = writeln!(text, "background {{ srgb {} }}", vector(nff.background));
    let count = nff.lights.len().max(1) as f64;
    let intensity = count.sqrt() / (2.0 * count);
    for light in &nff.lights {
        let _ = writeln!(text, "light_source {{ {} rgb {intensity} }}", vector(*light));
    }
    for part in nff.parts.iter().filter(|part| !part.shapes.is_empty()) {
        write_part(&mut text, part, intensity);
    }
    text
}

fn write_part(text: &mut String, part: &Part, ambient: f64) {
    *text += "union {\n";
    let mut mesh = String::new();
    for shape in &part.shapes {
        write_shape(text, &mut mesh, shape);
    }
    if !mesh.is_empty() {
        let _ = write!(text, "mesh {{\n{mesh}}}\n");
    }
    let Part { color, diffuse, specular, shininess, transmittance, index, .. } = *part;
    // POV-Ray weights what is scattered by the opaque share, which NFF does not.
    let diffuse = diffuse / (1.0 - transmittance).max(1e-3);
    let _ = write!(
        text,
        "pigment {{ srgb {} filter {transmittance} }}\nfinish {{ ambient {} diffuse {diffuse}",
        vector(color),
        ambient * diffuse
    );
    if specular > 0.0 {
        let _ = write!(text, " phong {specular} phong_size {shininess} reflection {specular}");
    }
    *text += " }\n";
    if transmittance > 0.0 {
        let _ = writeln!(text, "interior {{ ior {index} }}");
    }
    *text += "}\n";
}

/// Writes a shape into the union, or its triangles into the mesh.
fn write_shape(text: &mut String, mesh: &mut String, shape: &Shape) {
    match shape {
        Shape::Sphere { center, radius } => {
            let _ = writeln!(text, "sphere {{ {}, {radius} }}", vector(*center));
        }
        Shape::Cone { base, base_radius, apex, apex_radius } if base_radius == apex_radius => {
            let _ = writeln!(text, "cylinder {{ {}, {}, {base_radius} open }}", vector(*base), vector(*apex));
        }
        Shape::Cone { base, base_radius, apex, apex_radius } => {
            let (base, apex) = (vector(*base), vector(*apex));
            let _ = writeln!(text, "cone {{ {base}, {base_radius}, {apex}, {apex_radius} open }}");
        }
        Shape::Polygon(corners) if corners.len() <= 4 => {
            for at in 2..corners.len() {
                let [a, b, c] = [corners[0], corners[at - 1], corners[at]].map(vector);
                let _ = writeln!(mesh, "triangle {{ {a}, {b}, {c} }}");
            }
        }
        Shape::Polygon(corners) => {
            let closed: Vec<String> = corners.iter().chain(corners.first()).map(|corner| vector(*corner)).collect();
            let _ = writeln!(text, "polygon {{ {}, {} }}", closed.len(), closed.join(", "));
        }
        Shape::Patch(corners) => {
            for at in 2..corners.len() {
                let [a, b, c] = [corners[0], corners[at - 1], corners[at]]
                    .map(|(corner, normal)| format!("{}, {}", vector(corner), vector(normal)));
                let _ = writeln!(mesh, "smooth_triangle {{ {a}, {b}, {c} }}");
            }
        }
    }
}

fn vector([x, y, z]: Vector) -> String {
    format!("<{x},{y},{z}>")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shape_is_written() {
        let nff = Nff::parse(super::super::nff::tests::EXAMPLE).expect("it is good");
        let text = scene(&nff);
        for expected in [
            "sphere { <0,0,0>, 1 }",
            "cylinder { <0,0,0>, <0,1,0>, 1 open }",
            "mesh {\ntriangle { <0,0,0>, <1,0,0>, <0,1,0> }\n}",
            "polygon { 6, <0,0,0>, <1,0,0>, <1,1,0>, <0.5,0.5,0>, <0,1,0>, <0,0,0> }",
            "smooth_triangle { <0,0,0>, <0,0,1>, <1,0,0>, <0,0,1>, <0,1,0>, <0,0,1> }",
            "filter 0.8 }",
            "interior { ior 1.1 }",
            "phong 0.2 phong_size 10 reflection 0.2",
        ] {
            assert!(text.contains(expected), "{expected} is not in\n{text}");
        }
        assert_eq!(text.matches("union").count(), 2);
    }
}
