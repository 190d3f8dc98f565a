//! `cargo xtask bench`: whole pictures against POV-Ray, by the cost of the whole process.
//!
//! Both render the same scene at the same size with the same number of threads, without antialiasing, and write a PNG.
//! Runs alternate, so that a machine that slows down slows both; a warm-up run of each is not counted. What is compared
//! is CPU seconds (user + system) of the process as the operating system counted them, not wall time: POV-Ray waits
//! half a second at its start that would flatter us. Medians and ratios are quoted, with the spread beside them.

mod drawings;
mod measure;
mod report;
mod sphereflake;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::Outcome;
use crate::arguments::Arguments;
use crate::process;
use measure::{Cost, measure};
use report::{Row, describe_machine};

/// Counted runs of each renderer unless told.
const RUNS: usize = 5;
/// The size of the pictures, in pixels.
const WIDTH: &str = "1024";
const HEIGHT: &str = "768";
/// Threads of either renderer.
const THREADS: &str = "2";

/// One picture that both renderers make: `benches/povray/POV` and its twin.
struct Case {
    name: &'static str,
    pov: &'static str,
    /// Further words for POV-Ray.
    declare: &'static [&'static str],
    twin: Twin,
}

/// A picture's scene in Snell's format.
enum Twin {
    /// `benches/NAME.toml`.
    File,
    /// Written when it is needed, being long.
    Sphereflake { depth: u32 },
}

const CASES: &[Case] = &[
    Case { name: "nine-red-balls", pov: "nine-red-balls.pov", declare: &[], twin: Twin::File },
    Case { name: "one-glass-sphere", pov: "one-glass-sphere.pov", declare: &[], twin: Twin::File },
    Case { name: "five-glass-balls", pov: "five-glass-balls.pov", declare: &[], twin: Twin::File },
    Case {
        name: "sphereflake-7381",
        pov: "sphereflake.pov",
        declare: &["Declare=DEPTH=4"],
        twin: Twin::Sphereflake { depth: 4 },
    },
    Case {
        name: "sphereflake-66430",
        pov: "sphereflake.pov",
        declare: &["Declare=DEPTH=5"],
        twin: Twin::Sphereflake { depth: 5 },
    },
];

/// Runs the command line `cargo xtask bench ...`.
pub fn run(mut arguments: Arguments) -> Outcome {
    let runs = arguments.option("--runs")?.unwrap_or(RUNS).max(1);
    let drawings = arguments.flag("--drawings");
    let wanted = arguments.names()?;
    if let Some(unknown) = wanted.iter().find(|name| !CASES.iter().any(|case| case.name == name.as_str())) {
        let all: Vec<&str> = CASES.iter().map(|case| case.name).collect();
        return Err(format!("there is no benchmark `{unknown}`; there are: {}", all.join(", ")));
    }
    let scratch = process::target().join("bench");
    std::fs::create_dir_all(&scratch).map_err(|error| format!("cannot make {}: {error}", scratch.display()))?;
    if drawings {
        return drawings::run(runs, &scratch);
    }
    let povray = povray_version();
    if povray.is_none() {
        println!("POV-Ray is not installed, so there is nothing to compare with (`apt-get install povray`).");
    }
    let snell = process::build_snell()?;

    let mut rows = Vec::new();
    for case in CASES.iter().filter(|case| wanted.is_empty() || wanted.iter().any(|name| name == case.name)) {
        let twin = case.twin(&scratch)?;
        let ours = Some(snell_command(&snell, &twin, &scratch.join(format!("{}.png", case.name))));
        let theirs = povray.is_some().then(|| povray_command(case, &scratch.join(format!("{}-povray.png", case.name))));
        println!("{} ...", case.name);
        let [ours, theirs] = alternate([ours, theirs], runs)?;
        rows.push(Row { name: case.name, ours, theirs });
    }

    let mut versions = vec![process::output(process::program(&snell.to_string_lossy()).arg("--version"))?];
    versions.extend(povray);
    versions.push(process::output(Command::new("rustc").arg("--version"))?);
    let report = report::text(&rows, runs, &describe_machine(), &versions);
    let file = scratch.join("report.md");
    std::fs::write(&file, &report).map_err(|error| format!("cannot write {}: {error}", file.display()))?;
    println!("\n{report}\nalso in {}", file.display());
    Ok(())
}

impl Case {
    /// Where the scene in Snell's format is; written into `scratch` where it is not among the sources.
    fn twin(&self, scratch: &Path) -> Result<PathBuf, String> {
        match self.twin {
            Twin::File => Ok(process::root().join("benches").join(format!("{}.toml", self.name))),
            Twin::Sphereflake { depth } => {
                let file = scratch.join(format!("{}.toml", self.name));
                std::fs::write(&file, sphereflake::scene(depth))
                    .map_err(|error| format!("cannot write {}: {error}", file.display()))?;
                Ok(file)
            }
        }
    }
}

/// Runs the commands that there are in turn, once to warm up and `runs` times to count.
fn alternate(mut commands: [Option<Command>; 2], runs: usize) -> Result<[Vec<Cost>; 2], String> {
    let mut costs = [Vec::new(), Vec::new()];
    for round in 0..=runs {
        for (command, costs) in commands.iter_mut().zip(&mut costs) {
            let Some(command) = command else { continue };
            let cost = measure(command)?;
            if round > 0 {
                costs.push(cost);
            }
        }
    }
    Ok(costs)
}

/// The command that renders a twin scene; threads are set, the rest is what a user gets.
fn snell_command(snell: &Path, scene: &Path, picture: &Path) -> Command {
    let mut command = process::program(&snell.to_string_lossy());
    command.arg("render").arg(scene).arg("-o").arg(picture);
    command.args(["--width", WIDTH, "--height", HEIGHT, "--threads", THREADS, "--aa", "none", "--quiet"]);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// The command that renders a scene with POV-Ray: no window, no messages, no antialiasing.
fn povray_command(case: &Case, picture: &Path) -> Command {
    let folder: PathBuf = process::root().join("benches").join("povray");
    let mut command = Command::new("povray");
    command.current_dir(folder);
    command.arg(format!("+I{}", case.pov)).arg(format!("+O{}", picture.display())).args(case.declare);
    command.args([format!("+W{WIDTH}"), format!("+H{HEIGHT}"), format!("+WT{THREADS}")]);
    command.args(["-D", "-GA", "-A"]).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// The first line in which POV-Ray names itself, where it is installed.
fn povray_version() -> Option<String> {
    let output = Command::new("povray").arg("--version").output().ok()?;
    // It prints its version among other messages, on standard error.
    let text = [output.stdout, output.stderr].concat();
    let text = String::from_utf8_lossy(&text);
    text.lines().find(|line| line.starts_with("POV-Ray")).map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_has_both_its_scenes() {
        for case in CASES {
            assert!(process::root().join("benches/povray").join(case.pov).is_file(), "{}", case.pov);
            if matches!(case.twin, Twin::File) {
                let twin = case.twin(Path::new("")).expect("it is a path");
                assert!(twin.is_file(), "{}", twin.display());
            }
        }
    }

    #[cfg(unix)]
    #[test]
    fn runs_alternate_and_the_warm_up_is_not_counted() {
        let [ours, theirs] = alternate([Some(Command::new("true")), None], 3).expect("`true` runs");
        assert_eq!((ours.len(), theirs.len()), (3, 0));
        assert!(alternate([None, Some(Command::new("false"))], 1).is_err());
    }
}
