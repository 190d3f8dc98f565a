//! How long reading a mesh takes: a million triangles of binary PLY and of OBJ, in a program that does nothing else, the example `load` of
//! `snell-scene`. CPU time of all threads, since reading may use several.

use std::fmt::Write;

use super::report::{Bar, Section, Verdict};
use super::statistics::alternate;
use super::{Bench, models};
use crate::process;

const TRIANGLES: u32 = 1_000_000;
/// CPU seconds, at most.
const BARS: [(&str, f64); 2] = [("PLY", 0.3), ("OBJ", 1.5)];

/// Measures both formats.
pub fn run(bench: &Bench) -> Result<Section, String> {
    process::run(process::cargo().args(["build", "--release", "--quiet", "-p", "snell-scene", "--example", "load"]))?;
    let load = process::target().join("release/examples").join(format!("load{}", std::env::consts::EXE_SUFFIX));
    let mesh = models::blob(models::rings_for(TRIANGLES));
    let files = [bench.scratch.join("loading.ply"), bench.scratch.join("loading.obj")];
    mesh.write_ply(&files[0])?;
    mesh.write_obj(&files[1])?;
    let command = |file: &std::path::Path| {
        let mut command = process::program(&load.to_string_lossy());
        command.arg(file);
        command
    };
    let commands = BARS.iter().zip(&files).map(|((format, _), file)| (*format, command(file))).collect();
    let mut section = Section::default();
    let _ = write!(
        section.text,
        "Whole process that reads {} triangles; medians of {} alternating runs.\n\n\
         | format | CPU s (smallest to largest) | wall s | MiB |\n|---|---|---|---|\n",
        mesh.triangles.len(),
        bench.runs
    );
    for (series, (format, bar)) in alternate(commands, bench.runs)?.iter().zip(BARS) {
        let median = |of| series.median(of).unwrap_or(f64::NAN);
        let _ = writeln!(
            section.text,
            "| {format} | {} | {:.3} | {:.0} |",
            series.spread(|cost| cost.cpu),
            median(|cost| cost.wall),
            median(|cost| cost.memory)
        );
        let what = format!("reading a million triangles of {format}: CPU time");
        section.verdicts.push(Verdict { what, measured: median(|cost| cost.cpu), bar: Bar::AtMost(bar), unit: " s" });
    }
    Ok(section)
}
