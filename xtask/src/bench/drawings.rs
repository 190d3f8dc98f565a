//! What line drawings cost, hidden lines removed: every rendered scene of the gallery, and a mesh of a hundred thousand triangles.

use std::fmt::Write;
use std::path::Path;

use super::report::{Section, cell};
use super::statistics::alternate;
use super::{Bench, models};
use crate::process;

/// Triangles of the mesh, about.
const TRIANGLES: u32 = 100_000;

/// Draws everything.
pub fn run(bench: &Bench) -> Result<Section, String> {
    let snell = bench.programs.snell.to_string_lossy().into_owned();
    let listing = process::output(process::program(&snell).arg("scenes"))?;
    let mut scenes: Vec<String> =
        listing.lines().filter_map(|line| line.split_whitespace().next()).map(str::to_owned).collect();
    let mesh = bench.scratch.join("blob.ply");
    let blob = models::blob(models::rings_for(TRIANGLES));
    blob.write_ply(&mesh)?;
    scenes.push(mesh.to_string_lossy().into_owned());
    let mut section = Section::default();
    let _ = write!(
        section.text,
        "Whole process, reading and writing included; medians of {} runs. The blob has {} triangles.\n\n\
         | drawing | wall s | CPU s | MiB |\n|---|---|---|---|\n",
        bench.runs,
        blob.triangles.len()
    );
    for scene in &scenes {
        let name =
            Path::new(scene).file_stem().map_or_else(|| scene.clone(), |stem| stem.to_string_lossy().into_owned());
        if !bench.wants(&name) {
            continue;
        }
        let mut command = process::program(&snell);
        command.args(["draw", scene, "--quiet", "-o"]).arg(bench.scratch.join("drawing.svg"));
        let series = alternate(vec![("Snell", command)], bench.runs)?;
        for series in &series {
            let _ = writeln!(
                section.text,
                "| {name} | {} | {} | {} |",
                cell(series.median(|cost| cost.wall), 3),
                cell(series.median(|cost| cost.cpu), 3),
                cell(series.median(|cost| cost.memory), 0)
            );
        }
    }
    Ok(section)
}
