//! Starting other programs: always from the workspace's root, always saying what failed.

use std::path::PathBuf;
use std::process::{Command, Stdio};

/// The folder that holds the workspace's `Cargo.toml`.
pub fn root() -> PathBuf {
    let mut path = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    path.pop();
    path
}

/// Where cargo puts what it builds.
pub fn target() -> PathBuf {
    match std::env::var_os("CARGO_TARGET_DIR") {
        Some(folder) => root().join(folder),
        None => root().join("target"),
    }
}

/// The cargo that started this program, ready to run in the workspace's root.
pub fn cargo() -> Command {
    program(std::env::var("CARGO").as_deref().unwrap_or("cargo"))
}

/// Any program, ready to run in the workspace's root.
pub fn program(name: &str) -> Command {
    let mut command = Command::new(name);
    command.current_dir(root());
    command
}

/// Runs to the end, with this program's own output; an error unless it succeeds.
pub fn run(command: &mut Command) -> Result<(), String> {
    let status = command.status().map_err(|error| format!("cannot start {}: {error}", shown(command)))?;
    if status.success() { Ok(()) } else { Err(format!("{} failed ({status})", shown(command))) }
}

/// Runs to the end and returns what it printed on standard output; an error unless it succeeds.
pub fn output(command: &mut Command) -> Result<String, String> {
    command.stdin(Stdio::null());
    let output = command.output().map_err(|error| format!("cannot start {}: {error}", shown(command)))?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    } else {
        let errors = String::from_utf8_lossy(&output.stderr);
        Err(format!("{} failed ({})\n{}", shown(command), output.status, errors.trim_end()))
    }
}

/// The command line as a person would type it.
pub fn shown(command: &Command) -> String {
    let name = PathBuf::from(command.get_program());
    let mut line = name.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    for argument in command.get_args() {
        line.push(' ');
        line += &argument.to_string_lossy();
    }
    format!("`{line}`")
}

/// The release binary of the `snell` command, built now.
pub fn build_snell() -> Result<PathBuf, String> {
    run(cargo().args(["build", "--release", "--package", "snell-cli"]))?;
    Ok(target().join("release").join(format!("snell{}", std::env::consts::EXE_SUFFIX)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failing_program_is_an_error_that_names_it() {
        let error = run(cargo().arg("no-such-subcommand").stderr(Stdio::null())).expect_err("cargo refuses");
        assert!(error.contains("cargo no-such-subcommand"), "{error}");
        let error = output(&mut program("no-such-program-anywhere")).expect_err("nothing to start");
        assert!(error.contains("no-such-program-anywhere"), "{error}");
    }
}
