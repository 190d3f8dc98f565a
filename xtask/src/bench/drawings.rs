//! `cargo xtask bench --drawings`: what line drawings cost, hidden lines removed: every rendered scene of the gallery, and a mesh of
//! a hundred thousand triangles.

use std::fmt::Write;
use std::path::Path;

use super::measure::{Cost, measure};
use super::report::describe_machine;
use crate::Outcome;
use crate::process;

/// Rings and meridians of the mesh: 2 · 224 · 224 triangles.
const DIVISIONS: u32 = 224;

/// Draws everything `runs` times and prints the medians.
pub fn run(runs: usize, scratch: &Path) -> Outcome {
    let snell = process::build_snell()?;
    let snell = snell.to_string_lossy().into_owned();
    let listing = process::output(process::program(&snell).arg("scenes"))?;
    let mut scenes: Vec<String> =
        listing.lines().filter_map(|line| line.split_whitespace().next()).map(str::to_owned).collect();
    let mesh = scratch.join("bumps.obj");
    std::fs::write(&mesh, bumps()).map_err(|error| format!("cannot write {}: {error}", mesh.display()))?;
    scenes.push(mesh.to_string_lossy().into_owned());
    let mut report =
        format!("{}\n\n| drawing | wall, s | CPU, s | memory, MiB |\n|---|---|---|---|\n", describe_machine());
    for scene in &scenes {
        let output = scratch.join("drawing.svg");
        let mut command = process::program(&snell);
        command.args(["draw", scene, "--quiet", "-o"]).arg(&output);
        let mut costs = Vec::new();
        for _ in 0..runs {
            costs.push(measure(&mut command)?);
        }
        let median = |of: fn(&Cost) -> f64| {
            let mut values: Vec<f64> = costs.iter().map(of).collect();
            values.sort_by(f64::total_cmp);
            values[values.len() / 2]
        };
        let name =
            Path::new(scene).file_stem().map_or_else(|| scene.clone(), |stem| stem.to_string_lossy().into_owned());
        let (wall, cpu, memory) = (median(|c| c.wall), median(|c| c.cpu), median(|c| c.memory));
        let _ = writeln!(report, "| {name} | {wall:.3} | {cpu:.3} | {memory:.0} |");
    }
    println!("{report}");
    Ok(())
}

/// A sphere with waves on it, as OBJ.
#[expect(clippy::disallowed_methods, reason = "what is timed need not have the same bits on every machine")]
fn bumps() -> String {
    let mut text = String::new();
    for ring in 0..=DIVISIONS {
        for meridian in 0..DIVISIONS {
            let down = std::f64::consts::PI * f64::from(ring) / f64::from(DIVISIONS);
            let around = std::f64::consts::TAU * f64::from(meridian) / f64::from(DIVISIONS);
            let radius =
                1.0 + 0.12 * (7.0 * down).sin() * (6.0 * around).sin() + 0.05 * (23.0 * down + 5.0 * around).sin();
            let (out, up) = (radius * down.sin(), radius * down.cos());
            let _ = writeln!(text, "v {:.6} {up:.6} {:.6}", out * around.cos(), out * around.sin());
        }
    }
    for ring in 0..DIVISIONS {
        for meridian in 0..DIVISIONS {
            let at = |ring: u32, meridian: u32| ring * DIVISIONS + meridian % DIVISIONS + 1;
            let (a, b) = (at(ring, meridian), at(ring, meridian + 1));
            let (c, d) = (at(ring + 1, meridian), at(ring + 1, meridian + 1));
            let _ = writeln!(text, "f {a} {b} {c}\nf {b} {d} {c}");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mesh_has_a_hundred_thousand_triangles() {
        let text = bumps();
        assert_eq!(text.lines().filter(|line| line.starts_with("f ")).count(), 100_352);
        assert_eq!(text.lines().filter(|line| line.starts_with("v ")).count(), 225 * 224);
    }
}
