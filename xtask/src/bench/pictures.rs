//! Whole pictures without antialiasing: ours against POV-Ray's and Tachyon's, with the same cameras, sizes and depths.
//!
//! Beside each of POV-Ray's stands how far apart both pictures look, so that it is seen that they are of the same scene. Tachyon writes
//! its light without a display's encoding, so its pictures are compared by eye.

use std::fmt::Write;
use std::path::PathBuf;

use super::flip::Flip;
use super::programs::PLAIN;
use super::report::{Bar, COSTS, Section, Verdict, ratio, rows};
use super::statistics::alternate;
use super::{Bench, sphereflake};
use crate::process;

/// A picture that several renderers make.
pub struct Case {
    pub name: &'static str,
    /// What Snell reads.
    twin: Twin,
    /// `benches/povray/...`, and further words for POV-Ray.
    povray: &'static str,
    declare: &'static [&'static str],
    tachyon: Tachyon,
    /// POV-Ray's CPU seconds over ours, at least.
    bar: Option<f64>,
}

/// A picture's scene in Snell's format.
enum Twin {
    /// `benches/NAME.toml`.
    File,
    /// Written when it is needed, being long.
    Flat { depth: u32 },
    /// Written when it is needed: prototypes in prototypes.
    Nested { depth: u32 },
}

/// A picture's scene in Tachyon's format.
enum Tachyon {
    /// Tachyon has no glass, or would take minutes.
    Absent,
    /// `benches/tachyon/NAME.dat`.
    File,
    /// Written when it is needed.
    Sphereflake { depth: u32 },
}

pub const CASES: &[Case] = &[
    Case {
        name: "nine-red-balls",
        twin: Twin::File,
        povray: "nine-red-balls.pov",
        declare: &[],
        tachyon: Tachyon::File,
        bar: Some(12.0),
    },
    Case {
        name: "one-glass-sphere",
        twin: Twin::File,
        povray: "one-glass-sphere.pov",
        declare: &[],
        tachyon: Tachyon::Absent,
        bar: Some(12.0),
    },
    Case {
        name: "five-glass-balls",
        twin: Twin::File,
        povray: "five-glass-balls.pov",
        declare: &[],
        tachyon: Tachyon::Absent,
        bar: None,
    },
    Case {
        name: "sphereflake-7381",
        twin: Twin::Flat { depth: 4 },
        povray: "sphereflake.pov",
        declare: &["Declare=DEPTH=4"],
        tachyon: Tachyon::Sphereflake { depth: 4 },
        bar: None,
    },
    Case {
        name: "sphereflake-66430",
        twin: Twin::Flat { depth: 5 },
        povray: "sphereflake.pov",
        declare: &["Declare=DEPTH=5"],
        tachyon: Tachyon::Absent,
        bar: Some(9.0),
    },
    Case {
        name: "sphereflake-66430-nested",
        twin: Twin::Nested { depth: 5 },
        povray: "sphereflake-nested.pov",
        declare: &["Declare=DEPTH=5"],
        tachyon: Tachyon::Absent,
        bar: Some(9.0),
    },
];

/// Of Tachyon's CPU seconds on nine-red-balls ours are at most this part.
const TACHYON_BAR: f64 = 2.0;

/// Measures all pictures.
pub fn run(bench: &Bench) -> Result<Section, String> {
    let flip = Flip::build()?;
    let mut section = Section::default();
    let _ = write!(
        section.text,
        "Whole process, 1024 x 768, {} threads, no antialiasing; medians of {} alternating runs.\n\n{COSTS}",
        PLAIN.threads, bench.runs
    );
    let mut alike = String::new();
    for case in CASES.iter().filter(|case| bench.wants(case.name)) {
        let output = |renderer: &str| bench.scratch.join(format!("{}-{renderer}.png", case.name));
        let mut commands = vec![("Snell", bench.programs.snell(&case.twin(bench)?, &output("snell"), PLAIN))];
        if let Some(mut povray) = bench.programs.povray(&case.povray(), &output("povray"), PLAIN) {
            povray.args(case.declare);
            commands.push(("POV-Ray", povray));
        }
        let tachyon = case.tachyon(bench)?;
        commands.extend(
            tachyon.and_then(|scene| Some(("Tachyon", bench.programs.tachyon(&scene, &output("tachyon"), PLAIN)?))),
        );
        let series = alternate(commands, bench.runs)?;
        section.text += &rows(case.name, &series);
        if series.iter().any(|series| series.name == "POV-Ray") {
            let apart = flip.between(&output("povray"), &output("snell"))?;
            let _ = write!(alike, "{}{} {apart:.4}", if alike.is_empty() { "" } else { ", " }, case.name);
        }
        for (other, bar) in [("POV-Ray", case.bar), ("Tachyon", Some(TACHYON_BAR))] {
            if let (Some(measured), Some(bar)) = (ratio(&series, other, |cost| cost.cpu), bar) {
                let what = format!("{}: {other}'s CPU seconds over ours", case.name);
                section.verdicts.push(Verdict { what, measured, bar: Bar::AtLeast(bar), unit: "" });
            }
        }
    }
    if !alike.is_empty() {
        let _ = writeln!(section.text, "\nꟻLIP between POV-Ray's picture and ours: {alike}.");
    }
    Ok(section)
}

impl Case {
    /// The picture of that name.
    pub fn named(name: &str) -> Option<&'static Self> {
        CASES.iter().find(|case| case.name == name)
    }

    /// Where the scene in Snell's format is; written where it is not among the sources.
    pub fn twin(&self, bench: &Bench) -> Result<PathBuf, String> {
        let name = format!("{}.toml", self.name);
        match self.twin {
            Twin::File => Ok(process::root().join("benches").join(name)),
            Twin::Flat { depth } => bench.write(&name, sphereflake::flat(depth).as_bytes()),
            Twin::Nested { depth } => bench.write(&name, sphereflake::nested(depth).as_bytes()),
        }
    }

    /// POV-Ray's scene.
    pub fn povray(&self) -> PathBuf {
        process::root().join("benches").join("povray").join(self.povray)
    }

    /// Further words for POV-Ray.
    pub fn declare(&self) -> &'static [&'static str] {
        self.declare
    }

    /// Tachyon's scene, where there is one.
    fn tachyon(&self, bench: &Bench) -> Result<Option<PathBuf>, String> {
        let name = format!("{}.dat", self.name);
        match self.tachyon {
            Tachyon::Absent => Ok(None),
            Tachyon::File => Ok(Some(process::root().join("benches").join("tachyon").join(name))),
            Tachyon::Sphereflake { depth } => bench.write(&name, sphereflake::tachyon(depth).as_bytes()).map(Some),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_has_its_scenes() {
        for case in CASES {
            assert!(case.povray().is_file(), "{}", case.povray);
            for (folder, ending, wanted) in [
                ("benches", "toml", matches!(case.twin, Twin::File)),
                ("benches/tachyon", "dat", matches!(case.tachyon, Tachyon::File)),
            ] {
                let file = process::root().join(folder).join(format!("{}.{ending}", case.name));
                assert!(!wanted || file.is_file(), "{}", file.display());
            }
        }
    }
}
