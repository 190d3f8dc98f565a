//! Running the command, and what its results are compared with.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use snell::image::{DisplayImage, Limits, decode_display};
use tempfile::TempDir;

/// A folder of its own, gone at the end, in which the command runs.
pub struct Folder(TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// The names of all that is in it, in order.
    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// The command, ready to run here with the words of a line as its arguments.
    pub fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_snell"));
        command.args(line.split_whitespace()).current_dir(self.0.path()).stdin(Stdio::null());
        for variable in ["NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE", "RAYON_NUM_THREADS", "RUST_BACKTRACE"] {
            command.env_remove(variable);
        }
        command
    }

    pub fn run(&self, line: &str) -> Run {
        Run::new(line, self.command(line).output().unwrap())
    }

    /// Runs what must succeed.
    pub fn good(&self, line: &str) -> Run {
        let run = self.run(line);
        assert_eq!(run.code, Some(0), "{run:?}");
        run
    }

    pub fn picture(&self, name: &str) -> DisplayImage {
        decode(&self.read(name))
    }
}

/// What came of running the command.
#[derive(Debug)]
pub struct Run {
    /// Read by `Debug` where an assertion fails.
    #[expect(dead_code, reason = "shown by failing assertions")]
    line: String,
    pub code: Option<i32>,
    pub stdout: Vec<u8>,
    pub stderr: String,
}

impl Run {
    pub fn new(line: &str, output: Output) -> Self {
        Self {
            line: line.to_owned(),
            code: output.status.code(),
            stdout: output.stdout,
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }

    pub fn text(&self) -> &str {
        std::str::from_utf8(&self.stdout).unwrap()
    }

    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.stdout).unwrap_or_else(|error| panic!("{error}: {self:?}"))
    }
}

pub fn decode(png: &[u8]) -> DisplayImage {
    decode_display(png, &Limits::default()).unwrap()
}

/// True where the user may write everywhere, whatever permissions say.
#[cfg(unix)]
pub fn is_almighty(folder: &Path) -> bool {
    let probe = folder.join("probe");
    let made = fs::write(&probe, b"").is_ok();
    let _ = fs::remove_file(probe);
    made
}
