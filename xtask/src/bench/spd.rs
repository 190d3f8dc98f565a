//! The Standard Procedural Databases at 513 x 513, by their rules: ours reads the NFF file, POV-Ray the same scene written anew.
//!
//! The files are looked for in `assets/spd-nff` of the folder that SNELL_ASSETS names, or of `../shared` beside the checkout; where
//! they are absent, the benchmark says so and measures nothing.

use std::fmt::Write;
use std::path::PathBuf;

use super::flip::Flip;
use super::nff::Nff;
use super::programs::{PLAIN, Picture};
use super::report::{Bar, COSTS, Section, Verdict, ratio, rows};
use super::statistics::alternate;
use super::{Bench, nff_povray};
use crate::process;

const SCENES: &[&str] = &["balls", "gears", "mount", "rings", "teapot", "tetra", "tree"];
/// POV-Ray's CPU seconds over ours, at least.
const BAR: f64 = 10.0;

/// Measures all scenes.
pub fn run(bench: &Bench) -> Result<Section, String> {
    let mut section = Section::default();
    let folder = folder();
    if !folder.is_dir() {
        section.text = format!("Skipped: there is no folder {}.\n", folder.display());
        return Ok(section);
    }
    let flip = Flip::build()?;
    let picture = Picture { width: 513, height: 513, ..PLAIN };
    let _ = write!(
        section.text,
        "Whole process, reading included, 513 x 513, {} threads, `--preset spd`; medians of {} alternating runs.\n\n{COSTS}",
        PLAIN.threads, bench.runs
    );
    let mut alike = Vec::new();
    for name in SCENES.iter().filter(|name| bench.wants(name)) {
        let file = folder.join(format!("{name}-default.nff"));
        let text =
            std::fs::read_to_string(&file).map_err(|error| format!("cannot read {}: {error}", file.display()))?;
        let nff = Nff::parse(&text).map_err(|reason| format!("{}: {reason}", file.display()))?;
        let povray = bench.write(&format!("spd-{name}.pov"), nff_povray::scene(&nff).as_bytes())?;
        let output = |renderer: &str| bench.scratch.join(format!("spd-{name}-{renderer}.png"));
        let mut ours = bench.programs.snell(&file, &output("snell"), picture);
        ours.args(["--preset", "spd"]);
        let mut commands = vec![("Snell", ours)];
        commands.extend(bench.programs.povray(&povray, &output("povray"), picture).map(|command| ("POV-Ray", command)));
        let series = alternate(commands, bench.runs)?;
        section.text += &rows(name, &series);
        if let Some(measured) = ratio(&series, "POV-Ray", |cost| cost.cpu) {
            let what = format!("SPD {name}: POV-Ray's CPU seconds over ours");
            section.verdicts.push(Verdict { what, measured, bar: Bar::AtLeast(BAR), unit: "" });
            alike.push(format!("{name} {:.3}", flip.between(&output("povray"), &output("snell"))?));
        }
    }
    if !alike.is_empty() {
        let _ = writeln!(section.text, "\nꟻLIP between POV-Ray's picture and ours: {}.", alike.join(", "));
    }
    Ok(section)
}

/// Where the files are, or would be.
fn folder() -> PathBuf {
    let assets = std::env::var_os("SNELL_ASSETS").map(PathBuf::from);
    assets.unwrap_or_else(|| process::root().join("../shared/assets")).join("spd-nff")
}
