//! `cargo xtask bench`: how fast we are, against the best that are installed, and where the time goes.
//!
//! Each kind of benchmark is a file and a row of [`GROUPS`]. What is counted of whole pictures is CPU seconds (user + system) of
//! the process as the operating system counted them, and wall time beside: POV-Ray waits half a second at its start that would
//! flatter us. Every report is printed and kept as `target/bench/NAME.md`; `--write-docs` puts it into docs/performance.md too.

mod agreement;
mod antialiasing;
mod docs;
mod drawings;
mod embree;
mod flip;
mod instructions;
mod kernels;
mod loading;
mod measure;
mod mesh_file;
mod meshes;
mod models;
mod nff;
mod nff_povray;
mod paths;
mod pictures;
mod programs;
mod report;
mod roofline;
mod roofline_loops;
mod scaling;
mod spd;
mod sphereflake;
mod start;
mod statistics;
mod threads;
mod vectors;

use std::path::PathBuf;

use crate::Outcome;
use crate::arguments::Arguments;
use crate::process;
use programs::Programs;
use report::{Section, describe_machine};

/// Counted runs of each program unless told.
const RUNS: usize = 5;

/// A kind of benchmark.
struct Group {
    name: &'static str,
    /// One line for the list.
    summary: &'static str,
    /// Whether it runs where no names are given: those that take a few minutes together.
    usual: bool,
    run: fn(&Bench) -> Result<Section, String>,
}

const GROUPS: &[Group] = &[
    Group {
        name: "pictures",
        summary: "whole pictures without antialiasing, against POV-Ray and Tachyon",
        usual: true,
        run: pictures::run,
    },
    Group {
        name: "antialiasing",
        summary: "the same with antialiasing, at equal quality",
        usual: true,
        run: antialiasing::run,
    },
    Group {
        name: "meshes",
        summary: "a mirror and a glass blob of 100 thousand and of a million triangles each",
        usual: true,
        run: meshes::run,
    },
    Group { name: "spd", summary: "the Standard Procedural Databases at 513 x 513", usual: true, run: spd::run },
    Group { name: "start", summary: "a picture of 4 x 3 pixels", usual: true, run: start::run },
    Group { name: "loading", summary: "reading a mesh of a million triangles", usual: true, run: loading::run },
    Group { name: "threads", summary: "two threads against one", usual: true, run: threads::run },
    Group {
        name: "kernels",
        summary: "rays a second, build rate and bytes a triangle, against Embree",
        usual: false,
        run: kernels::run,
    },
    Group {
        name: "instructions",
        summary: "instructions of small pictures against those stored; --bless stores them",
        usual: false,
        run: instructions::run,
    },
    Group {
        name: "scaling",
        summary: "from ten spheres and a thousand triangles to a million and ten",
        usual: false,
        run: scaling::run,
    },
    Group { name: "roofline", summary: "what the machine could do at best", usual: false, run: roofline::run },
    Group { name: "drawings", summary: "what line drawings cost", usual: false, run: drawings::run },
    Group {
        name: "paths",
        summary: "the error of path tracing after the same CPU time, against Mitsuba, LuxCore and Cycles",
        usual: false,
        run: paths::run,
    },
    Group {
        name: "agreement",
        summary: "means over regions of converged pictures, against Mitsuba; --bless stores Mitsuba's",
        usual: false,
        run: agreement::run,
    },
];

/// What every benchmark is given.
struct Bench {
    programs: Programs,
    /// Counted runs of each program.
    runs: usize,
    /// Only rows whose name contains this.
    only: Option<String>,
    /// Stores what was measured as what is expected.
    bless: bool,
    /// Where files are written.
    scratch: PathBuf,
}

impl Bench {
    /// Whether a row is wanted; says that it begins.
    fn wants(&self, name: &str) -> bool {
        let wanted = self.only.as_ref().is_none_or(|only| name.contains(only.as_str()));
        if wanted {
            println!("{name} ...");
        }
        wanted
    }

    /// Writes a file among the products and says where it is.
    fn write(&self, name: &str, content: &[u8]) -> Result<PathBuf, String> {
        let file = self.scratch.join(name);
        std::fs::write(&file, content).map_err(|error| format!("cannot write {}: {error}", file.display()))?;
        Ok(file)
    }
}

/// Runs the command line `cargo xtask bench ...`.
pub fn run(mut arguments: Arguments) -> Outcome {
    if let Some(words) = arguments.rest_after(measure::MEASURE) {
        return measure::print(&words);
    }
    let runs = arguments.option("--runs")?.unwrap_or(RUNS).max(1);
    let only = arguments.option("--only")?;
    let write_docs = arguments.flag("--write-docs");
    let bless = arguments.flag("--bless");
    let features = arguments.flag("--features");
    let wanted = arguments.names()?;
    if features {
        println!("{}", instructions::features());
        return Ok(());
    }
    if let Some(unknown) = wanted.iter().find(|name| !GROUPS.iter().any(|group| group.name == name.as_str())) {
        return Err(format!("there is no benchmark `{unknown}`; there are:\n{}", list()));
    }
    let scratch = process::target().join("bench");
    std::fs::create_dir_all(&scratch).map_err(|error| format!("cannot make {}: {error}", scratch.display()))?;
    let bench = Bench { programs: Programs::find()?, runs, only, bless, scratch };

    let mut bars: Vec<(&str, String)> = Vec::new();
    let mut failures = Vec::new();
    for group in GROUPS {
        let asked = if wanted.is_empty() { group.usual } else { wanted.iter().any(|name| name == group.name) };
        if !asked {
            continue;
        }
        println!("\n== {}: {}", group.name, group.summary);
        // One that fails does not take the others' results with it.
        match (group.run)(&bench) {
            Ok(section) => {
                keep(&bench, group.name, &section, write_docs)?;
                bars.push((group.name, report::bars(group.name, &section.verdicts)));
            }
            Err(reason) => failures.push(format!("{}: {reason}", group.name)),
        }
    }
    let rows: String = bars.iter().map(|(_, rows)| rows.as_str()).collect();
    if !rows.is_empty() {
        println!("{}{rows}", report::BARS_HEAD);
    }
    println!("Reports are in {}", bench.scratch.display());
    if write_docs {
        let names: Vec<&str> = GROUPS.iter().map(|group| group.name).collect();
        docs::write_bars(&names, &bars, bench.only.is_some())?;
    }
    if failures.is_empty() { Ok(()) } else { Err(failures.join("\n")) }
}

/// Prints a section with what it was measured on, keeps it, and puts it into the documentation.
fn keep(bench: &Bench, name: &str, section: &Section, write_docs: bool) -> Outcome {
    let mut command = format!("cargo xtask bench {name} --runs {}", bench.runs);
    if let Some(only) = &bench.only {
        command += &format!(" --only {only}");
    }
    let text = format!(
        "{}\nMeasured on {} by `{command}` on {}; {}.\n",
        section.text,
        report::today(),
        describe_machine(),
        bench.programs.versions()?.join(", ")
    );
    println!("\n{text}");
    bench.write(&format!("{name}.md"), text.as_bytes())?;
    if write_docs { docs::write(name, &text) } else { Ok(()) }
}

/// The groups, one a line.
fn list() -> String {
    GROUPS.iter().map(|group| format!("  {:<13} {}\n", group.name, group.summary)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_benchmark_is_refused_with_the_list() {
        let error = run(Arguments::new(vec!["no-such".to_owned()])).expect_err("it is unknown");
        assert!(GROUPS.iter().all(|group| error.contains(group.name)), "{error}");
    }
}
