//! Path tracing against other renderers': the error that is left after the same CPU time.
//!
//! The picture is a glass ball over a checkerboard under a small lamp, whose caustic is what such a comparison is about. All are compared with a picture of
//! ours of many samples under another seed. The others are asked for as many samples as their whole process takes the CPU seconds of ours for, start included
//! on both sides: what their samples and their start take is measured first. One that takes longer to start gets a single sample.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

use super::Bench;
use super::measure::{Cost, measure};
use super::report::{Bar, Section, Verdict};
use crate::process;

/// Our samples in each pixel, and those of what all are compared with.
const SAMPLES: u32 = 64;
const REFERENCE_SAMPLES: u32 = 1024;

/// A renderer to compare with, by its script benches/FOLDER/caustic.py.
struct Peer {
    folder: &'static str,
    name: &'static str,
    algorithm: &'static str,
    /// What its pictures are kept as.
    ending: &'static str,
    /// Samples from which its pace is measured.
    probes: [u32; 2],
    /// What installs it.
    packages: &'static str,
}

/// Mitsuba also reads the pictures that are compared, so it is the one that has to be there.
const MITSUBA: Peer = Peer {
    folder: "mitsuba",
    name: "Mitsuba",
    algorithm: "`path`",
    ending: "npy",
    probes: [32, 288],
    packages: "mitsuba numpy",
};

/// All, Mitsuba first.
const PEERS: [Peer; 3] = [
    MITSUBA,
    Peer {
        folder: "luxcore",
        name: "LuxCore",
        algorithm: "`BIDIRCPU`",
        ending: "npy",
        probes: [4, 20],
        packages: "pyluxcore numpy",
    },
    Peer {
        folder: "cycles",
        name: "Cycles of Blender",
        algorithm: "path tracing",
        ending: "exr",
        probes: [16, 80],
        packages: "bpy numpy",
    },
];

impl Peer {
    fn python(&self, words: &[&str]) -> Command {
        let mut command = process::program("python3");
        command.arg(process::root().join("benches").join(self.folder).join("caustic.py")).args(words);
        command
    }

    /// Its version; `None` where it is not installed.
    fn version(&self) -> Option<String> {
        let printed = process::output(&mut self.python(&["version"])).ok()?;
        // Some tell more about themselves before.
        printed.lines().rfind(|line| !line.trim().is_empty()).map(|line| line.trim().to_owned())
    }

    /// Renders for the CPU seconds that ours took.
    fn render(&self, file: &str, seconds: f64) -> Result<Run, String> {
        let render = |samples: u32| measure(&mut self.python(&["render", &samples.to_string(), file]));
        let [few, many] = self.probes.map(render);
        let (few, many): (Cost, Cost) = (few?, many?);
        let pace = (many.cpu - few.cpu).max(1e-3) / f64::from(self.probes[1] - self.probes[0]);
        let start = (few.cpu - pace * f64::from(self.probes[0])).max(0.0);
        let samples = samples_within(seconds, start, pace);
        Ok(Run { samples, start, pace, cpu: render(samples)?.cpu })
    }
}

/// What a peer took, in CPU seconds: to start, for a sample of every pixel, and for its picture of so many.
struct Run {
    samples: u32,
    start: f64,
    pace: f64,
    cpu: f64,
}

/// How many samples there is time for; one at least.
fn samples_within(seconds: f64, start: f64, pace: f64) -> u32 {
    (((seconds - start) / pace) as u32).max(1)
}

/// Measures and compares.
pub fn run(bench: &Bench) -> Result<Section, String> {
    let scene = process::root().join("benches").join("caustic.toml");
    let snell = |samples: u32, seed: u32, output: &Path| {
        let mut command = Command::new(&bench.programs.snell);
        command.args(["render", "--quiet", "--integrator", "path", "--threads", "1"]).arg(&scene);
        command.args(["--samples", &samples.to_string(), "--seed", &seed.to_string(), "-o"]).arg(output);
        command
    };
    let mut section = Section::default();
    let ours = bench.scratch.join("paths-ours.exr");
    let cost = measure(&mut snell(SAMPLES, 1, &ours))?;
    let _ = writeln!(
        section.text,
        "320 x 240; ours with {SAMPLES} samples in each pixel, one thread.\n\n\
         | renderer | samples | CPU s | RMS error, whole picture | in the caustic |\n|---|---|---|---|---|"
    );
    let versions = PEERS.each_ref().map(Peer::version);
    if versions[0].is_none() {
        let _ = writeln!(
            section.text,
            "| Snell | {SAMPLES} | {:.2} | - | - |\n\nMitsuba is not installed (`pip install {}`).",
            cost.cpu, MITSUBA.packages
        );
        return Ok(section);
    }
    let reference = bench.scratch.join("paths-reference.exr");
    process::run(&mut snell(REFERENCE_SAMPLES, 99, &reference))?;
    let name = |path: &Path| path.to_string_lossy().into_owned();
    let errors = |file: &str| {
        let printed = process::output(&mut MITSUBA.python(&["compare", &name(&reference), file]))?;
        let numbers: Vec<f64> = printed.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        match numbers.as_slice() {
            &[whole, caustic] => Ok([whole, caustic]),
            _ => Err(format!("the comparison printed `{}`", printed.trim())),
        }
    };
    let [whole, caustic] = errors(&name(&ours))?;
    let _ = writeln!(section.text, "| Snell | {SAMPLES} | {:.2} | {whole:.5} | {caustic:.5} |", cost.cpu);
    let mut notes = format!(
        "\nSnell takes {:.1} ms for a sample of every pixel, with all that belongs to it.\n",
        1e3 * cost.cpu / f64::from(SAMPLES)
    );
    for (peer, version) in PEERS.iter().zip(versions) {
        let Some(version) = version else {
            let _ = writeln!(notes, "{} is not installed (`pip install {}`).", peer.name, peer.packages);
            continue;
        };
        println!("{} {version} ...", peer.name);
        let file = name(&bench.scratch.join(format!("paths-{}.{}", peer.folder, peer.ending)));
        let Run { samples, start, pace, cpu } = peer.render(&file, cost.cpu)?;
        let [their_whole, their_caustic] = errors(&file)?;
        let _ = writeln!(
            section.text,
            "| {} {version}, {} | {samples} | {cpu:.2} | {their_whole:.5} | {their_caustic:.5} |",
            peer.name, peer.algorithm
        );
        let _ = writeln!(notes, "{} takes {start:.2} s to start and {:.1} ms for a sample.", peer.name, 1e3 * pace);
        for (what, measured) in [("whole picture", whole / their_whole), ("caustic", caustic / their_caustic)] {
            let what = format!("paths, {what}: our RMS error over that of {} at equal CPU time", peer.name);
            section.verdicts.push(Verdict { what, measured, bar: Bar::AtMost(0.5), unit: "" });
        }
    }
    section.text += &notes;
    Ok(section)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_that_is_left_after_the_start_is_for_samples() {
        assert_eq!(samples_within(5.0, 1.0, 0.5), 8);
        assert_eq!(samples_within(1.0, 5.0, 0.5), 1);
    }

    #[test]
    fn every_peer_has_its_script() {
        for peer in &PEERS {
            let script = process::root().join("benches").join(peer.folder).join("caustic.py");
            assert!(script.is_file(), "{}", script.display());
        }
    }
}
