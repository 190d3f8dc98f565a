//! Instructions that small pictures take, counted by callgrind and compared with those stored in benches/instructions.toml: a
//! regression shows whatever the machine's mood.
//!
//! Counts depend on the compiler and on the instructions that the processor has as valgrind imitates it (it knows no AVX-512, so
//! what is counted is the way of AVX2 or older), so both are stored beside them and looked at first: under others, only `--bless`
//! makes sense. One thread, since waiting threads execute what the scheduler wants.

use std::fmt::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use toml::de::{DeTable, DeValue};

use super::report::Section;
use super::{Bench, models, sphereflake};
use crate::process;

/// Relative to the root.
const FILE: &str = "benches/instructions.toml";
/// Counts may differ by this part: addresses and hash seeds are not the same in every run.
const TOLERANCE: f64 = 0.02;

/// What is counted: a name, the command and its scene. Pictures are 96 x 72 unless a command says otherwise.
const PICTURES: &[(&str, Scene, &[&str])] = &[
    ("nine-red-balls", Scene::BuiltIn("nine-red-balls"), &["--aa", "none"]),
    ("glass", Scene::BuiltIn("five-glass-balls"), &["--aa", "none"]),
    ("adaptive", Scene::BuiltIn("five-glass-balls"), &["--aa", "adaptive"]),
    ("solids", Scene::BuiltIn("lens"), &["--aa", "none"]),
    ("textures", Scene::BuiltIn("kitchen-window"), &["--aa", "none"]),
    ("dispersion", Scene::BuiltIn("refraction-and-wavelength"), &["--aa", "none"]),
    ("mesh", Scene::Blob(10_000), &["--aa", "none"]),
    ("instances", Scene::Nested(3), &["--aa", "none"]),
    ("sphereflake-820", Scene::Flat(3), &["--aa", "none"]),
    ("loading", Scene::Blob(100_000), &["--aa", "none", "--width", "4", "--height", "3"]),
    ("drawing", Scene::BuiltIn("kitchen-window"), &["draw"]),
];

/// Where a scene comes from.
#[derive(Clone, Copy)]
enum Scene {
    BuiltIn(&'static str),
    /// A mesh of about so many triangles.
    Blob(u32),
    /// Sphereflakes of so many levels.
    Flat(u32),
    Nested(u32),
}

/// What is stored, or was counted.
#[derive(Clone, Debug, Default, PartialEq)]
struct Counts {
    rustc: String,
    features: String,
    counts: Vec<(String, u64)>,
}

/// Counts, and compares or stores.
pub fn run(bench: &Bench) -> Result<Section, String> {
    let mut section = Section::default();
    if process::output(Command::new("valgrind").arg("--version")).is_err() {
        section.text = "Skipped: valgrind is not installed (`apt-get install valgrind`).\n".to_owned();
        return Ok(section);
    }
    let mut counted = Counts {
        rustc: process::output(Command::new("rustc").arg("--version"))?.trim().to_owned(),
        features: features_under_valgrind()?,
        counts: Vec::new(),
    };
    for (name, scene, options) in PICTURES.iter().filter(|(name, ..)| bench.wants(name)) {
        counted.counts.push(((*name).to_owned(), count(bench, *scene, options)?));
    }
    let path = process::root().join(FILE);
    if bench.bless {
        std::fs::write(&path, written(&counted)).map_err(|error| format!("cannot write {FILE}: {error}"))?;
        println!("{FILE} is written anew.");
    }
    let text = std::fs::read_to_string(&path).map_err(|error| format!("cannot read {FILE}: {error}"))?;
    let (table, more) = compared(&read(&text)?, &counted);
    section.text = table;
    if more.is_empty() {
        Ok(section)
    } else {
        println!("{}", section.text);
        Err(format!("{}; if that is as it should be, `cargo xtask bench instructions --bless`", more.join(", ")))
    }
}

/// The counts beside those stored, and what takes more than it may.
fn compared(stored: &Counts, counted: &Counts) -> (String, Vec<String>) {
    let same = stored.rustc == counted.rustc && stored.features == counted.features;
    let mut text = format!("Instructions by callgrind, one thread, {}, {}.", counted.rustc, counted.features);
    if !same {
        let _ = write!(
            text,
            " The stored ones are of {}, {}, so that nothing follows from differences.",
            stored.rustc, stored.features
        );
    }
    text += "\n\n| picture | million instructions | stored | change |\n|---|---|---|---|\n";
    let mut more = Vec::new();
    for (name, count) in &counted.counts {
        let before = stored.counts.iter().find(|(stored, _)| stored == name).map(|(_, before)| *before);
        let change = before.map(|before| *count as f64 / before as f64 - 1.0);
        let _ = writeln!(
            text,
            "| {name} | {:.2} | {} | {} |",
            *count as f64 * 1e-6,
            before.map_or("-".to_owned(), |before| format!("{:.2}", before as f64 * 1e-6)),
            change.map_or("-".to_owned(), |change| format!("{:+.2} %", 100.0 * change))
        );
        if let Some(change) = change.filter(|change| same && *change > TOLERANCE) {
            more.push(format!("{name} takes {:.1} % more instructions", 100.0 * change));
        }
    }
    (text, more)
}

/// Runs one picture under callgrind.
fn count(bench: &Bench, scene: Scene, options: &[&str]) -> Result<u64, String> {
    let scene = match scene {
        Scene::BuiltIn(name) => PathBuf::from(name),
        Scene::Flat(depth) => bench.write("instructions-flat.toml", sphereflake::flat(depth).as_bytes())?,
        Scene::Nested(depth) => bench.write("instructions-nested.toml", sphereflake::nested(depth).as_bytes())?,
        Scene::Blob(triangles) => {
            let file = bench.scratch.join("instructions.ply");
            models::blob(models::rings_for(triangles)).write_ply(&file)?;
            file
        }
    };
    let mut command = process::program("valgrind");
    command.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]).arg(&bench.programs.snell);
    let has = |option: &str| options.contains(&option);
    if has("draw") {
        command.arg("draw").arg(&scene).arg("-o").arg(bench.scratch.join("instructions.svg"));
    } else {
        command.arg("render").arg(&scene).arg("-o").arg(bench.scratch.join("instructions.png"));
        command.args(["--threads", "1"]).args(options);
        if !has("--width") {
            command.args(["--width", "96", "--height", "72"]);
        }
    }
    command.arg("--quiet").stdin(Stdio::null()).stdout(Stdio::null());
    let output = command.output().map_err(|error| format!("cannot start {}: {error}", process::shown(&command)))?;
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    collected(&told).ok_or_else(|| format!("{} failed ({})\n{told}", process::shown(&command), output.status))
}

/// The count in callgrind's closing lines, `Collected : N`.
fn collected(told: &str) -> Option<u64> {
    told.lines().find_map(|line| line.split_once("Collected :")?.1.split_whitespace().next()?.parse().ok())
}

/// What this very program sees under valgrind of what it looks for.
fn features_under_valgrind() -> Result<String, String> {
    let own = std::env::current_exe().map_err(|error| format!("cannot find this program: {error}"))?;
    let mut command = Command::new("valgrind");
    command.args(["--tool=none", "--quiet"]).arg(own).args(["bench", "--features"]);
    Ok(process::output(&mut command)?.trim().to_owned())
}

/// The instructions that the processor has, of those that decide which way is taken.
pub fn features() -> String {
    let mut found = vec![std::env::consts::ARCH];
    #[cfg(target_arch = "x86_64")]
    {
        let known = [
            ("avx2", is_x86_feature_detected!("avx2")),
            ("avx512f", is_x86_feature_detected!("avx512f")),
            ("avx512vl", is_x86_feature_detected!("avx512vl")),
        ];
        found.extend(known.iter().filter(|(_, has)| *has).map(|(name, _)| *name));
    }
    found.join(" ")
}

/// The text of the file.
fn written(counted: &Counts) -> String {
    let mut text = "# Instructions of small pictures, by callgrind: `cargo xtask bench instructions` compares, `--bless` writes this file.\n\n".to_owned();
    let _ = write!(text, "rustc = \"{}\"\nfeatures = \"{}\"\n\n[counts]\n", counted.rustc, counted.features);
    for (name, count) in &counted.counts {
        let _ = writeln!(text, "{name} = {count}");
    }
    text
}

/// What the file says.
fn read(text: &str) -> Result<Counts, String> {
    let table = DeTable::parse(text).map_err(|error| format!("{FILE}: {}", error.message()))?;
    let table = table.get_ref();
    let string = |key: &str| table.get(key).and_then(|value| value.get_ref().as_str()).unwrap_or_default().to_owned();
    let mut counts = Vec::new();
    for (name, value) in table.get("counts").and_then(|value| value.get_ref().as_table()).into_iter().flatten() {
        let count = match value.get_ref() {
            DeValue::Integer(count) => count.as_str().parse().ok(),
            _ => None,
        };
        counts.push((
            name.get_ref().to_string(),
            count.ok_or_else(|| format!("{FILE}: {} is no count", name.get_ref()))?,
        ));
    }
    Ok(Counts { rustc: string("rustc"), features: string("features"), counts })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counts(count: u64) -> Counts {
        Counts { rustc: "rustc 1".to_owned(), features: "x".to_owned(), counts: vec![("a".to_owned(), count)] }
    }

    #[test]
    fn what_is_written_is_read_again() {
        assert_eq!(read(&written(&counts(12_345_678_901))), Ok(counts(12_345_678_901)));
        assert!(read("[counts]\na = \"b\"").is_err());
        assert_eq!(collected("==1== Events    : Ir\n==1== Collected : 1234567\n"), Some(1_234_567));
    }

    #[test]
    fn more_than_tolerated_is_a_regression_and_less_is_not() {
        assert!(compared(&counts(1000), &counts(1019)).1.is_empty());
        assert!(compared(&counts(1000), &counts(500)).1.is_empty());
        assert_eq!(compared(&counts(1000), &counts(1030)).1, ["a takes 3.0 % more instructions"]);
        let other = Counts { rustc: "rustc 2".to_owned(), ..counts(2000) };
        let (text, more) = compared(&counts(1000), &other);
        assert!(more.is_empty() && text.contains("nothing follows"), "{text}");
    }

    #[test]
    fn the_stored_file_has_every_picture() {
        let text = std::fs::read_to_string(process::root().join(FILE)).expect("it is there");
        let stored = read(&text).expect("it is good");
        let names: Vec<&str> = stored.counts.iter().map(|(name, _)| name.as_str()).collect();
        for (name, ..) in PICTURES {
            assert!(names.contains(name), "{name}");
        }
    }
}
