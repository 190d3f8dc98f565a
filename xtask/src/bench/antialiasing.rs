//! Pictures with antialiasing, ours adaptive against POV-Ray's usual `+A0.3 +AM1 +R3`, at equal quality: each renderer's picture is
//! compared by ꟻLIP with one of its own with 64 rays in every pixel, and ours may not be farther from it than POV-Ray's.

use std::fmt::Write;
use std::path::Path;

use super::Bench;
use super::flip::Flip;
use super::pictures::Case;
use super::programs::{Antialiasing, PLAIN, Picture};
use super::report::{Bar, COSTS, Section, Verdict, cell, ratio, rows};
use super::statistics::alternate;
use crate::process;

/// Pictures, and POV-Ray's CPU seconds over ours, at least.
const PICTURES: &[(&str, f64)] = &[("five-glass-balls", 12.0), ("sphereflake-66430", 11.0)];

const ADAPTIVE: Picture = Picture { antialiasing: Antialiasing::Adaptive, ..PLAIN };
/// What is compared is a quarter of what is timed: POV-Ray needs minutes for 64 rays in each of its pixels.
const COMPARED: Picture = Picture { width: 512, height: 384, ..ADAPTIVE };
const REFERENCE: Picture = Picture { antialiasing: Antialiasing::Reference, ..COMPARED };

/// Measures and compares both.
pub fn run(bench: &Bench) -> Result<Section, String> {
    let flip = Flip::build()?;
    let mut section = Section::default();
    let _ = write!(
        section.text,
        "Whole process, 1024 x 768, {} threads; ours `--aa adaptive`, POV-Ray `+A0.3 +AM1 +R3`; medians of {} alternating runs.\n\n{COSTS}",
        PLAIN.threads, bench.runs
    );
    let mut quality = "\nCompared at 512 x 384:\n\n| picture | ꟻLIP of ours to ours with 64 rays a pixel | of POV-Ray's to POV-Ray's | equal |\n|---|---|---|---|\n".to_owned();
    for (name, bar) in PICTURES.iter().filter(|(name, _)| bench.wants(name)) {
        let case = Case::named(name).ok_or_else(|| format!("there is no picture `{name}`"))?;
        let twin = case.twin(bench)?;
        let file = |what: &str| bench.scratch.join(format!("antialiasing-{name}-{what}.png"));
        let povray = |output: &Path, picture| {
            let mut command = bench.programs.povray(&case.povray(), output, picture)?;
            command.args(case.declare());
            Some(command)
        };
        let mut commands = vec![("Snell", bench.programs.snell(&twin, &file("snell-aa"), ADAPTIVE))];
        commands.extend(povray(&file("povray-aa"), ADAPTIVE).map(|command| ("POV-Ray", command)));
        let series = alternate(commands, bench.runs)?;
        section.text += &rows(name, &series);

        process::run(&mut bench.programs.snell(&twin, &file("snell-64"), REFERENCE))?;
        process::run(&mut bench.programs.snell(&twin, &file("snell-aa"), COMPARED))?;
        let ours = flip.between(&file("snell-64"), &file("snell-aa"))?;
        let mut theirs = None;
        if let Some((mut reference, mut compared)) =
            povray(&file("povray-64"), REFERENCE).zip(povray(&file("povray-aa"), COMPARED))
        {
            // Minutes of work that the engine's changes do not touch.
            if !is_newer(&file("povray-64"), &case.povray()) {
                process::run(&mut reference)?;
            }
            process::run(&mut compared)?;
            theirs = Some(flip.between(&file("povray-64"), &file("povray-aa"))?);
        }
        let equal = theirs.map_or("-", |theirs| if ours <= theirs { "yes" } else { "no" });
        let _ = writeln!(quality, "| {name} | {ours:.5} | {} | {equal} |", cell(theirs, 5));
        if let (Some(measured), Some(theirs)) = (ratio(&series, "POV-Ray", |cost| cost.cpu), theirs) {
            let what = format!("{name} with antialiasing: POV-Ray's CPU seconds over ours");
            section.verdicts.push(Verdict { what, measured, bar: Bar::AtLeast(*bar), unit: "" });
            let what = format!("{name} with antialiasing: our ꟻLIP over POV-Ray's");
            section.verdicts.push(Verdict { what, measured: ours / theirs, bar: Bar::AtMost(1.0), unit: "" });
        }
    }
    section.text += &quality;
    Ok(section)
}

/// Whether a file is there and was written after another.
fn is_newer(file: &Path, than: &Path) -> bool {
    let time = |path: &Path| std::fs::metadata(path).and_then(|metadata| metadata.modified()).ok();
    time(file).zip(time(than)).is_some_and(|(file, than)| file > than)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_pictures_are_among_the_pictures() {
        for (name, _) in PICTURES {
            assert!(Case::named(name).is_some(), "{name}");
        }
    }

    #[test]
    fn what_is_absent_is_not_newer() {
        let here = process::root().join("Cargo.toml");
        assert!(!is_newer(Path::new("no-such-file"), &here) && !is_newer(&here, &here));
    }
}
