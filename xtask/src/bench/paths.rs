//! Path tracing against Mitsuba's: the error that is left after the same CPU time.
//!
//! The picture is a glass ball over a checkerboard under a small lamp, whose caustic is what such a comparison is about. Both are compared with a picture of
//! ours of many samples under another seed. Mitsuba is asked for as many samples as its whole process takes the CPU seconds of ours for, start included
//! on both sides: what its samples and its start take is measured first.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

use super::Bench;
use super::measure::{Cost, measure};
use super::report::{Bar, Section, Verdict};
use crate::process;

/// Our samples in each pixel, and those of what both are compared with.
const SAMPLES: u32 = 64;
const REFERENCE_SAMPLES: u32 = 1024;
/// Samples from which Mitsuba's pace is measured.
const PROBES: [u32; 2] = [32, 288];

/// Measures and compares.
pub fn run(bench: &Bench) -> Result<Section, String> {
    let root = process::root().join("benches");
    let script = root.join("mitsuba").join("caustic.py");
    let python = |words: &[&str]| {
        let mut command = process::program("python3");
        command.arg(&script).args(words);
        command
    };
    let snell = |samples: u32, seed: u32, output: &Path| {
        let mut command = Command::new(&bench.programs.snell);
        command.args(["render", "--quiet", "--integrator", "path", "--threads", "1"]).arg(root.join("caustic.toml"));
        command.args(["--samples", &samples.to_string(), "--seed", &seed.to_string(), "-o"]).arg(output);
        command
    };
    let mut section = Section::default();
    let version = process::output(&mut python(&["version"]));
    let ours = bench.scratch.join("paths-ours.exr");
    let cost = measure(&mut snell(SAMPLES, 1, &ours))?;
    let _ = writeln!(
        section.text,
        "320 x 240; ours with {SAMPLES} samples in each pixel, one thread.\n\n\
         | renderer | samples | CPU s | RMS error, whole picture | in the caustic |\n|---|---|---|---|---|"
    );
    let Ok(version) = version else {
        let _ = writeln!(
            section.text,
            "| Snell | {SAMPLES} | {:.2} | - | - |\n\nMitsuba is not installed (`pip install mitsuba numpy`).",
            cost.cpu
        );
        return Ok(section);
    };
    let reference = bench.scratch.join("paths-reference.exr");
    process::run(&mut snell(REFERENCE_SAMPLES, 99, &reference))?;

    let theirs = bench.scratch.join("paths-mitsuba.npy");
    let name = |path: &Path| path.to_string_lossy().into_owned();
    let render = |samples: u32| python(&["render", &samples.to_string(), &name(&theirs)]);
    let [few, many] = PROBES.map(|samples| measure(&mut render(samples)));
    let (few, many): (Cost, Cost) = (few?, many?);
    let pace = (many.cpu - few.cpu).max(1e-3) / f64::from(PROBES[1] - PROBES[0]);
    let start = few.cpu - pace * f64::from(PROBES[0]);
    let samples = (((cost.cpu - start) / pace) as u32).max(1);
    let their_cost = measure(&mut render(samples))?;

    let printed = process::output(&mut python(&["compare", &name(&reference), &name(&ours), &name(&theirs)]))?;
    let numbers: Vec<f64> = printed.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let &[whole, caustic, their_whole, their_caustic] = numbers.as_slice() else {
        return Err(format!("the comparison printed `{}`", printed.trim()));
    };
    let _ = writeln!(section.text, "| Snell | {SAMPLES} | {:.2} | {whole:.5} | {caustic:.5} |", cost.cpu);
    let _ = writeln!(
        section.text,
        "| Mitsuba {} `path` | {samples} | {:.2} | {their_whole:.5} | {their_caustic:.5} |",
        version.trim(),
        their_cost.cpu
    );
    let _ = writeln!(
        section.text,
        "\nMitsuba takes {:.2} s to start and {:.1} ms for a sample of every pixel, Snell {:.1} ms with all that belongs to it.",
        start.max(0.0),
        1e3 * pace,
        1e3 * cost.cpu / f64::from(SAMPLES)
    );
    for (what, measured) in [("whole picture", whole / their_whole), ("caustic", caustic / their_caustic)] {
        let what = format!("paths, {what}: our RMS error over Mitsuba's at equal CPU time");
        section.verdicts.push(Verdict { what, measured, bar: Bar::AtMost(0.5), unit: "" });
    }
    Ok(section)
}
