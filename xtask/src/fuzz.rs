//! `cargo xtask fuzz`: feeds every reader of bytes from outside with broken input, by cargo-fuzz (libFuzzer).
//!
//! The targets are `fuzz/fuzz_targets/*.rs`. cargo-fuzz needs a nightly compiler; nothing else in the project does.

use std::process::Stdio;

use crate::Outcome;
use crate::arguments::Arguments;
use crate::process;

/// How long one target runs unless told, in seconds.
const SECONDS: u32 = 60;

/// Runs the command line `cargo xtask fuzz ...`.
pub fn run(mut arguments: Arguments) -> Outcome {
    let seconds = arguments.option("--seconds")?.unwrap_or(SECONDS);
    let wanted = arguments.at_most_one_name()?;
    let all = targets()?;
    let chosen: Vec<&String> = all.iter().filter(|target| wanted.as_ref().is_none_or(|name| name == *target)).collect();
    if chosen.is_empty() {
        return Err(match wanted {
            Some(name) => format!("there is no target `{name}`; there are: {}", all.join(", ")),
            None => "there is no target in fuzz/fuzz_targets".to_owned(),
        });
    }
    // `cargo +nightly` is a feature of rustup's cargo, so the cargo that runs now is of no use here.
    let mut probe = process::program("cargo");
    probe.args(["+nightly", "fuzz", "--version"]).stdout(Stdio::null()).stderr(Stdio::null());
    if process::run(&mut probe).is_err() {
        return Err("fuzzing needs a nightly compiler and cargo-fuzz:\n    rustup toolchain install nightly\n    \
                    cargo install cargo-fuzz"
            .to_owned());
    }
    for target in chosen {
        println!("== {target}, {seconds} s");
        let mut command = process::program("cargo");
        command.args(["+nightly", "fuzz", "run", target, "--"]).arg(format!("-max_total_time={seconds}"));
        process::run(&mut command)?;
    }
    Ok(())
}

/// The names of the fuzz targets, sorted.
fn targets() -> Result<Vec<String>, String> {
    let folder = process::root().join("fuzz").join("fuzz_targets");
    let entries = std::fs::read_dir(&folder).map_err(|error| format!("cannot read {}: {error}", folder.display()))?;
    let mut names: Vec<String> = entries
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .filter_map(|path| path.file_stem().map(|stem| stem.to_string_lossy().into_owned()))
        .collect();
    names.sort();
    Ok(names)
}
