//! Agreement with Mitsuba: means over regions of converged pictures of the same scenes.
//!
//! For each subject a scene of ours and its twin (benches/agreement, benches/mitsuba/agreement.py) are rendered under several seeds. Each
//! picture is cut into a grid of regions; compared are the means over all seeds, and how far those of the seeds are apart gives their standard
//! errors. All scenes are grey, so each of our three channels must be what Mitsuba has. `--bless` keeps Mitsuba's means for the tests of the engine.

use std::fmt::Write;
use std::process::Command;

use super::Bench;
use super::report::{Bar, Section, Verdict};
use crate::process;

const SUBJECTS: &[&str] = &["diffuse", "smooth-glass", "rough-glass", "medium", "area-light", "environment"];
/// Regions in a row of the grid, and rows.
const GRID: [usize; 2] = [4, 3];
const REGIONS: usize = GRID[0] * GRID[1];
/// Pictures of each renderer, each under a seed of its own.
const SEEDS: u32 = 16;
/// Samples in each pixel of such a picture: ours, and Mitsuba's, which have more noise and take less time.
const SAMPLES: u32 = 256;
const THEIR_SAMPLES: u32 = 1024;
/// Mitsuba's paths end by chance alone, and so must ours: the greatest depth there is.
const DEPTH: &str = "1000";
/// Where Mitsuba's means are kept.
const KEPT: &str = "crates/snell/tests/data/mitsuba_means.csv";

/// The mean of every region, with its standard error.
type Means = Vec<[f64; 2]>;

/// Measures and compares.
pub fn run(bench: &Bench) -> Result<Section, String> {
    let benches = process::root().join("benches");
    let script = benches.join("mitsuba").join("agreement.py");
    let python = || {
        let mut command = process::program("python3");
        command.arg(&script);
        command
    };
    let mut section = Section::default();
    let Ok(version) = process::output(python().arg("version")) else {
        section.text = "Skipped: Mitsuba is not installed (`pip install mitsuba numpy`).\n".to_owned();
        return Ok(section);
    };
    let version = version.trim();
    let _ = writeln!(
        section.text,
        "96 x 72 pixels in {} x {} regions; {SEEDS} pictures of each, ours with {SAMPLES} samples in each pixel, those of Mitsuba {version} with \
         {THEIR_SAMPLES}. Deviations are of each of our channels, in percent of Mitsuba's mean.\n\n\
         | subject | largest deviation, % | in column, row | its standard error, % | largest standard error, % |\n|---|---|---|---|---|",
        GRID[0], GRID[1]
    );
    let mut kept = kept_head(version);
    let mut largest_error = 0.0_f64;
    for subject in SUBJECTS {
        if !bench.wants(subject) {
            continue;
        }
        let mut render = python();
        render.args(["render", subject, &THEIR_SAMPLES.to_string()]).args((1..=SEEDS).map(|seed| seed.to_string()));
        let theirs = means(&rows(&process::output(&mut render)?)?);

        let mut read = python();
        read.arg("means");
        for seed in 1..=SEEDS {
            let picture = bench.scratch.join(format!("agreement-{seed}.exr"));
            let mut snell = Command::new(&bench.programs.snell);
            snell.args(["render", "--quiet", "--depth", DEPTH, "--samples", &SAMPLES.to_string()]);
            snell.args(["--seed", &seed.to_string()]);
            snell.arg(benches.join("agreement").join(format!("{subject}.toml"))).arg("-o").arg(&picture);
            process::run(&mut snell)?;
            read.arg(picture);
        }
        let printed = rows(&process::output(&mut read)?)?;
        // Red, green and blue of the first picture, then those of the second, and so on.
        let ours: Vec<Means> = (0..3).map(|channel| means(&every_third(&printed, channel))).collect();

        let compared = Comparison::of(&theirs, &ours);
        let _ = writeln!(
            section.text,
            "| {subject} | {:.3} | {}, {} | {:.3} | {:.3} |",
            compared.deviation,
            compared.region % GRID[0] + 1,
            compared.region / GRID[0] + 1,
            compared.error_there,
            compared.largest_error
        );
        section.verdicts.push(Verdict {
            what: format!("agreement, {subject}: the largest deviation of a region's mean from Mitsuba's"),
            measured: compared.deviation,
            bar: Bar::AtMost(0.5),
            unit: " %",
        });
        largest_error = largest_error.max(compared.largest_error);
        for (region, [mean, error]) in theirs.iter().enumerate() {
            let _ = writeln!(kept, "{subject},{},{},{mean:.8},{error:.8}", region % GRID[0], region / GRID[0]);
        }
    }
    section.verdicts.push(Verdict {
        what: "agreement: the largest standard error of a deviation".to_owned(),
        measured: largest_error,
        bar: Bar::AtMost(0.2),
        unit: " %",
    });
    if bench.bless {
        if bench.only.is_some() {
            return Err("--bless keeps the means of all subjects: leave --only out".to_owned());
        }
        std::fs::write(process::root().join(KEPT), kept).map_err(|error| format!("cannot write {KEPT}: {error}"))?;
    }
    Ok(section)
}

/// What stands above the kept means.
fn kept_head(version: &str) -> String {
    format!(
        "# Means over the regions of converged pictures by Mitsuba {version}, {SEEDS} pictures of {THEIR_SAMPLES} samples in each pixel,\n\
         # with their standard errors; written by `cargo xtask bench agreement --bless`. The scenes are those of benches/agreement.\n\
         subject,column,row,mean,standard_error\n"
    )
}

/// The numbers of every line that the script printed; each has one for every region.
fn rows(printed: &str) -> Result<Vec<Vec<f64>>, String> {
    let row = |line: &str| {
        let numbers: Vec<f64> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        if numbers.len() == REGIONS {
            Ok(numbers)
        } else {
            Err(format!("{REGIONS} means were asked for, not `{line}`"))
        }
    };
    printed.lines().map(row).collect()
}

fn every_third(rows: &[Vec<f64>], first: usize) -> Vec<Vec<f64>> {
    rows.iter().skip(first).step_by(3).cloned().collect()
}

/// The means of pictures' means, with their standard errors by how far those are apart.
fn means(pictures: &[Vec<f64>]) -> Means {
    let count = pictures.len() as f64;
    let of_region = |region: usize| {
        let mean = pictures.iter().map(|picture| picture[region]).sum::<f64>() / count;
        let squares: f64 = pictures.iter().map(|picture| square(picture[region] - mean)).sum();
        [mean, (squares / (count * (count - 1.0))).sqrt()]
    };
    (0..REGIONS).map(of_region).collect()
}

fn square(x: f64) -> f64 {
    x * x
}

/// How far our means are from theirs; all in percent of theirs.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Comparison {
    /// The largest deviation of a channel in a region, where that is, and its standard error.
    deviation: f64,
    region: usize,
    error_there: f64,
    /// The largest standard error of a deviation anywhere.
    largest_error: f64,
}

impl Comparison {
    fn of(theirs: &Means, channels: &[Means]) -> Self {
        let mut found = Self { deviation: 0.0, region: 0, error_there: 0.0, largest_error: 0.0 };
        for ours in channels {
            for (region, ([our_mean, our_error], [mean, error])) in ours.iter().zip(theirs).enumerate() {
                let deviation = 100.0 * ((our_mean - mean) / mean).abs();
                let error = 100.0 * (square(*our_error) + square(*error)).sqrt() / mean;
                found.largest_error = found.largest_error.max(error);
                // What is no number counts as the largest there is.
                if deviation.is_nan() || deviation > found.deviation {
                    found = Self { deviation, region, error_there: error, ..found };
                }
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_channel_of_the_worst_region_is_told() {
        let theirs: Means = vec![[2.0, 0.003]; REGIONS];
        let mut channels = vec![vec![[2.0, 0.004]; REGIONS]; 3];
        assert_eq!(Comparison::of(&theirs, &channels).deviation, 0.0);
        channels[1][6][0] = 1.96;
        channels[2][3][0] = 2.02;
        let found = Comparison::of(&theirs, &channels);
        assert!((found.deviation - 2.0).abs() < 1e-9 && found.region == 6, "{found:?}");
        assert!((found.largest_error - 0.25).abs() < 1e-9, "{found:?}");
        channels[0][1][0] = f64::NAN;
        assert!(Comparison::of(&theirs, &channels).deviation.is_nan());
    }

    #[test]
    fn standard_errors_are_those_of_means() {
        let pictures: Vec<Vec<f64>> = [1.0, 2.0, 3.0].iter().map(|&mean| vec![mean; REGIONS]).collect();
        let [mean, error] = means(&pictures)[5];
        assert!((mean - 2.0).abs() < 1e-12 && (error - (1.0_f64 / 3.0).sqrt()).abs() < 1e-12, "{mean} {error}");
    }

    #[test]
    fn lines_without_a_mean_for_every_region_are_refused() {
        assert!(rows("1 2 3").is_err());
        assert_eq!(rows(&"1 ".repeat(REGIONS)).map(|rows| rows.len()), Ok(1));
    }
}
