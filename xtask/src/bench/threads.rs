//! Two threads against one, in wall time, on scenes that are heavy enough to have something to share. It says little on a machine that
//! others use too: the CPU seconds beside it show what the second thread costs, whatever the machine does.

use std::fmt::Write;

use super::pictures::Case;
use super::programs::{Antialiasing, PLAIN, Picture};
use super::report::{Bar, Section, Verdict};
use super::statistics::alternate;
use super::{Bench, sphereflake};

/// Wall time of one thread over that of two, at least.
const BAR: f64 = 1.9;

/// Measures ours with one and with two threads.
pub fn run(bench: &Bench) -> Result<Section, String> {
    let mut section = Section::default();
    let _ = write!(
        section.text,
        "Whole process, 1024 x 768, `--aa adaptive`; medians of {} alternating runs.\n\n\
         | picture | wall s, 1 thread | wall s, 2 threads | wall, 1 over 2 | CPU, 2 over 1 |\n|---|---|---|---|---|\n",
        bench.runs
    );
    let balls = Case::named("five-glass-balls").ok_or("there is no picture `five-glass-balls`")?.twin(bench)?;
    let flake = bench.write("threads-sphereflake.toml", sphereflake::nested(5).as_bytes())?;
    let output = bench.scratch.join("threads.png");
    for (name, scene) in [("five-glass-balls", balls), ("sphereflake-66430-nested", flake)] {
        if !bench.wants(name) {
            continue;
        }
        let command = |threads| {
            let picture = Picture { threads, antialiasing: Antialiasing::Adaptive, ..PLAIN };
            bench.programs.snell(&scene, &output, picture)
        };
        let series = alternate(vec![("1", command(1)), ("2", command(2))], bench.runs)?;
        let [one, two] = series.as_slice() else { continue };
        let (Some(wall), Some(cpu)) = (
            one.median(|cost| cost.wall).zip(two.median(|cost| cost.wall)),
            one.median(|cost| cost.cpu).zip(two.median(|cost| cost.cpu)),
        ) else {
            continue;
        };
        let _ = writeln!(
            section.text,
            "| {name} | {:.3} | {:.3} | {:.2} | {:.2} |",
            wall.0,
            wall.1,
            wall.0 / wall.1,
            cpu.1 / cpu.0
        );
        let what = format!("{name}: wall time of one thread over two");
        section.verdicts.push(Verdict { what, measured: wall.0 / wall.1, bar: Bar::AtLeast(BAR), unit: "" });
    }
    Ok(section)
}
