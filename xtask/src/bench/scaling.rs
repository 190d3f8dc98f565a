//! How time and memory grow with the scene: sphereflakes from ten balls to 600 thousand, as NFF has them, a line each; blobs from a
//! thousand triangles to ten million; one and two threads.

use std::fmt::Write;
use std::path::Path;

use super::programs::{PLAIN, Picture};
use super::report::{Section, cell};
use super::statistics::alternate;
use super::{Bench, meshes, models, sphereflake};

/// Triangles of the blobs, about.
const TRIANGLES: &[u32] = &[1_000, 10_000, 100_000, 1_000_000, 10_000_000];
/// Depths of the sphereflakes and their balls.
const FLAKES: &[(u32, u32)] = &[(1, 10), (2, 91), (3, 820), (4, 7_381), (5, 66_430), (6, 597_871)];

/// With fewer objects the picture and the program take most of the memory, and bytes an object say nothing.
const MANY: u32 = 50_000;

/// Measures both curves.
pub fn run(bench: &Bench) -> Result<Section, String> {
    let mut section = Section::default();
    let _ = write!(
        section.text,
        "Whole process, reading included, 1024 x 768, no antialiasing; medians of {} alternating runs.\n\n\
         | scene | objects | wall s, 1 thread | wall s, 2 threads | CPU s, 1 thread | CPU s, 2 threads | MiB | bytes an object |\n\
         |---|---|---|---|---|---|---|---|\n",
        bench.runs
    );
    for &(depth, balls) in FLAKES {
        if bench.wants(&format!("sphereflake-{balls}")) {
            let scene = bench.write("scaling.nff", sphereflake::nff(depth).as_bytes())?;
            section.text += &row(bench, "sphereflake", balls, &scene)?;
        }
    }
    for &triangles in TRIANGLES {
        if bench.wants(&format!("blob-{triangles}")) {
            let mesh = models::blob(models::rings_for(triangles));
            mesh.write_ply(&bench.scratch.join("scaling.ply"))?;
            let scene = bench.write("scaling.toml", meshes::one_mirror("scaling").as_bytes())?;
            section.text += &row(bench, "mirror blob", mesh.triangles.len() as u32, &scene)?;
        }
    }
    Ok(section)
}

/// One scene's row.
fn row(bench: &Bench, name: &str, objects: u32, scene: &Path) -> Result<String, String> {
    let output = bench.scratch.join("scaling.png");
    let command = |threads| bench.programs.snell(scene, &output, Picture { threads, ..PLAIN });
    let series = alternate(vec![("1", command(1)), ("2", command(2))], bench.runs)?;
    let [one, two] = series.as_slice() else { return Ok(String::new()) };
    let memory = one.median(|cost| cost.memory);
    let cells = [
        cell(one.median(|cost| cost.wall), 3),
        cell(two.median(|cost| cost.wall), 3),
        cell(one.median(|cost| cost.cpu), 3),
        cell(two.median(|cost| cost.cpu), 3),
        cell(memory, 0),
        cell(memory.filter(|_| objects > MANY).map(|mebibytes| mebibytes * f64::from(1 << 20) / f64::from(objects)), 0),
    ];
    Ok(format!("| {name} | {objects} | {} |\n", cells.join(" | ")))
}
