//! The shortest picture, 4 x 3 pixels: what starting costs. Wall time of the process, since that is what one waits for.

use std::fmt::Write;

use super::Bench;
use super::pictures::Case;
use super::programs::{PLAIN, Picture};
use super::report::{Bar, COSTS, Section, Verdict, rows};
use super::statistics::alternate;

/// Wall milliseconds, at most.
const BAR: f64 = 20.0;

/// Measures ours and POV-Ray's.
pub fn run(bench: &Bench) -> Result<Section, String> {
    let mut section = Section::default();
    let picture = Picture { width: 4, height: 3, ..PLAIN };
    let name = "nine-red-balls";
    let case = Case::named(name).ok_or_else(|| format!("there is no picture `{name}`"))?;
    let output = |renderer: &str| bench.scratch.join(format!("start-{renderer}.png"));
    let mut commands = vec![("Snell", bench.programs.snell(&case.twin(bench)?, &output("snell"), picture))];
    let povray = bench.programs.povray(&case.povray(), &output("povray"), picture);
    commands.extend(povray.map(|command| ("POV-Ray", command)));
    let series = alternate(commands, bench.runs)?;
    let _ = write!(
        section.text,
        "Whole process, {name} at 4 x 3, {} threads; medians of {} alternating runs.\n\n{COSTS}{}",
        PLAIN.threads,
        bench.runs,
        rows("4 x 3", &series)
    );
    if let Some(wall) = series.first().and_then(|series| series.median(|cost| cost.wall)) {
        let what = "4 x 3: wall time of the process".to_owned();
        section.verdicts.push(Verdict { what, measured: wall * 1e3, bar: Bar::AtMost(BAR), unit: " ms" });
    }
    Ok(section)
}
