//! A mirror and a glass blob of as many triangles over a checkerboard, ours from binary PLY against POV-Ray's from its `mesh2`.
//!
//! Both are flat-shaded and have the same corners in the same precision; how far apart the pictures look stands below the table.

use std::fmt::Write;
use std::path::PathBuf;

use super::flip::Flip;
use super::mesh_file::Mesh;
use super::programs::PLAIN;
use super::report::{Bar, COSTS, Section, Verdict, ratio, rows};
use super::statistics::alternate;
use super::{Bench, models};
use crate::process;

/// Triangles of each blob, about.
const SIZES: &[(&str, u32)] = &[("meshes-2x100k", 100_000), ("meshes-2x1M", 1_000_000)];
/// POV-Ray's CPU seconds over ours, at least.
const BAR: f64 = 10.0;

/// Measures both sizes.
pub fn run(bench: &Bench) -> Result<Section, String> {
    let flip = Flip::build()?;
    let mut section = Section::default();
    let _ = write!(
        section.text,
        "Whole process, reading included, 1024 x 768, {} threads, no antialiasing; medians of {} alternating runs.\n\n{COSTS}",
        PLAIN.threads, bench.runs
    );
    let mut alike = String::new();
    for &(name, triangles) in SIZES.iter().filter(|(name, _)| bench.wants(name)) {
        let mesh = models::blob(models::rings_for(triangles));
        let (twin, povray) = scene(bench, name, &mesh)?;
        let output = |renderer: &str| bench.scratch.join(format!("{name}-{renderer}.png"));
        let mut commands = vec![("Snell", bench.programs.snell(&twin, &output("snell"), PLAIN))];
        commands.extend(bench.programs.povray(&povray, &output("povray"), PLAIN).map(|command| ("POV-Ray", command)));
        let series = alternate(commands, bench.runs)?;
        section.text += &rows(name, &series);
        if let Some(measured) = ratio(&series, "POV-Ray", |cost| cost.cpu) {
            let what = format!("{name}: POV-Ray's CPU seconds over ours");
            section.verdicts.push(Verdict { what, measured, bar: Bar::AtLeast(BAR), unit: "" });
            let _ = writeln!(
                alike,
                "ꟻLIP between POV-Ray's picture of {name} and ours: {:.4}.",
                flip.between(&output("povray"), &output("snell"))?
            );
        }
        if let Some(measured) = ratio(&series, "POV-Ray", |cost| cost.memory) {
            let what = format!("{name}: POV-Ray's memory over ours");
            section.verdicts.push(Verdict { what, measured, bar: Bar::AtLeast(1.0), unit: "" });
        }
    }
    if !alike.is_empty() {
        let _ = write!(section.text, "\n{alike}");
    }
    Ok(section)
}

/// Writes the mesh and both scenes; where ours and POV-Ray's are.
fn scene(bench: &Bench, name: &str, mesh: &Mesh) -> Result<(PathBuf, PathBuf), String> {
    mesh.write_ply(&bench.scratch.join(format!("{name}.ply")))?;
    mesh.write_povray(&bench.scratch.join(format!("{name}.inc")), "Blob")?;
    let common = std::fs::read(process::root().join("benches/povray/common.inc"))
        .map_err(|error| format!("cannot read benches/povray/common.inc: {error}"))?;
    bench.write("common.inc", &common)?;
    let twin = bench.write(&format!("{name}.toml"), twin(name).as_bytes())?;
    let povray = bench.write(&format!("{name}.pov"), povray(name).as_bytes())?;
    Ok((twin, povray))
}

/// The mirror of the two alone, in Snell's format.
pub fn one_mirror(name: &str) -> String {
    let both = twin(name);
    // The glass comes last.
    both.rsplit_once("\n[[object]]").map_or(String::new(), |(text, _)| text.to_owned())
}

/// In Snell's format.
fn twin(name: &str) -> String {
    format!(
        "\
ambient = 0.05555556

[render]
depth = 9
min_weight = 0.003921569
antialiasing = \"none\"

[camera]
eye = [0, 2.5, 6.5]
look_at = [0, 0.9, 0]
fov = 50

[background]
color = [0.5, 0.7, 1.0]

[[light]]
point = {{ position = [4, 8, 6] }}

[material.floor]
diffuse = {{ checker = {{ colors = [0.135, 0.72] }} }}

[material.glass]
specular = 0.4
shininess = 83
dielectric = {{ ior = 1.5 }}

[material.mirror]
ambient = 0
diffuse = [0.27, 0.24, 0.18]
mirror = 0.7

[prototype.blob]
mesh = {{ file = \"{name}.ply\" }}

[[object]]
plane = {{ y = 0 }}
material = \"floor\"

[[object]]
instance = \"blob\"
material = \"mirror\"
translate = [-1.4, 1.2, -0.5]

[[object]]
instance = \"blob\"
material = \"glass\"
translate = [1.4, 1.2, 0.5]
"
    )
}

/// In POV-Ray's.
fn povray(name: &str) -> String {
    format!(
        "\
#include \"common.inc\"
global_settings {{ max_trace_level 9 assumed_gamma 1 }}
background {{ Sky }}
Cam(<0,2.5,6.5>, <0,0.9,0>)
light_source {{ <4,8,6> rgb 1 }}
Checker()
#include \"{name}.inc\"
object {{ Blob translate <-1.4,1.2,-0.5>
  pigment {{ rgb <0.9,0.8,0.6> }} finish {{ ambient 0 diffuse 0.3 reflection 0.7 }} }}
object {{ Blob translate <1.4,1.2,0.5> texture {{ GlassTex }} interior {{ GlassInt }} }}
"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_scenes_name_the_mesh_and_stand_at_the_same_places() {
        let (ours, theirs) = (twin("x"), povray("x"));
        assert!(ours.contains("\"x.ply\"") && theirs.contains("\"x.inc\""));
        assert!(one_mirror("x").ends_with("translate = [-1.4, 1.2, -0.5]\n"));
        for place in ["-1.4, 1.2, -0.5", "1.4, 1.2, 0.5", "0, 2.5, 6.5", "4, 8, 6"] {
            assert!(ours.contains(place), "{place}");
            assert!(theirs.contains(&place.replace(' ', "")), "{place}");
        }
    }
}
