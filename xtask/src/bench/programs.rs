//! The renderers that are compared, and the command lines by which each makes a picture.
//!
//! Sizes, threads and antialiasing are set for all; the rest is what a user gets. None opens a window or prints.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::process;

/// What is installed. Snell is built on the spot; the others may be absent.
pub struct Programs {
    pub snell: PathBuf,
    /// How POV-Ray names itself.
    pub povray: Option<String>,
    /// How Tachyon names itself.
    pub tachyon: Option<String>,
}

/// How a picture is rendered, by whichever renderer.
#[derive(Clone, Copy, Debug)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    pub threads: u32,
    pub antialiasing: Antialiasing,
}

/// How pixels are sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Antialiasing {
    /// One ray a pixel.
    None,
    /// More rays where neighbouring pixels differ: our `adaptive`, POV-Ray's usual `+A0.3 +AM1 +R3`.
    Adaptive,
    /// 64 rays a pixel, to compare the others with.
    Reference,
}

/// 1024 x 768 without antialiasing on two threads.
pub const PLAIN: Picture = Picture { width: 1024, height: 768, threads: 2, antialiasing: Antialiasing::None };

impl Programs {
    /// Builds ours and looks for the others.
    pub fn find() -> Result<Self, String> {
        let programs = Self {
            snell: process::build_snell()?,
            povray: names_itself("povray", "--version", "POV-Ray"),
            tachyon: names_itself("tachyon", "-version", "0.").map(|version| format!("Tachyon {version}")),
        };
        for (name, package, found) in [
            ("POV-Ray", "povray povray-includes", programs.povray.is_some()),
            ("Tachyon", "tachyon", programs.tachyon.is_some()),
        ] {
            if !found {
                println!("{name} is not installed and is left out (`apt-get install {package}`).");
            }
        }
        Ok(programs)
    }

    /// How all of them and the compiler name themselves.
    pub fn versions(&self) -> Result<Vec<String>, String> {
        let mut versions = vec![process::output(process::program(&self.snell.to_string_lossy()).arg("--version"))?];
        versions.extend(self.povray.clone());
        versions.extend(self.tachyon.clone());
        versions.push(process::output(Command::new("rustc").arg("--version"))?);
        Ok(versions.iter().map(|version| version.trim().to_owned()).collect())
    }

    /// Snell rendering the scene in a file; further options may follow.
    pub fn snell(&self, scene: &Path, output: &Path, picture: Picture) -> Command {
        let mut command = process::program(&self.snell.to_string_lossy());
        command.arg("render").arg(scene).arg("-o").arg(output).arg("--quiet");
        command.args(["--width", &picture.width.to_string(), "--height", &picture.height.to_string()]);
        command.args(["--threads", &picture.threads.to_string(), "--aa"]);
        command.arg(match picture.antialiasing {
            Antialiasing::None => "none",
            Antialiasing::Adaptive => "adaptive",
            Antialiasing::Reference => "64",
        });
        silent(command)
    }

    /// POV-Ray rendering the scene in a file, from that file's folder; `None` where it is not installed.
    pub fn povray(&self, scene: &Path, output: &Path, picture: Picture) -> Option<Command> {
        self.povray.as_ref()?;
        let mut command = Command::new("povray");
        if let (Some(folder), Some(name)) = (scene.parent(), scene.file_name()) {
            command.current_dir(folder).arg(format!("+I{}", name.to_string_lossy()));
        }
        command.arg(format!("+O{}", output.display()));
        let Picture { width, height, threads, antialiasing } = picture;
        command.args([format!("+W{width}"), format!("+H{height}"), format!("+WT{threads}")]).args(["-D", "-GA"]);
        command.args(match antialiasing {
            Antialiasing::None => ["-A"].as_slice(),
            Antialiasing::Adaptive => &["+A0.3", "+AM1", "+R3"],
            Antialiasing::Reference => &["+A0.0", "+AM1", "+R8"],
        });
        Some(silent(command))
    }

    /// Tachyon rendering the scene in a file, highlights by Phong's formula as in the others; `None` where it is not installed.
    pub fn tachyon(&self, scene: &Path, output: &Path, picture: Picture) -> Option<Command> {
        self.tachyon.as_ref()?;
        let mut command = Command::new("tachyon");
        command.arg(scene).args(["-fullshade", "-shade_phong", "-format", "PNG", "-o"]).arg(output);
        command.args(["-res", &picture.width.to_string(), &picture.height.to_string()]);
        command.args(["-numthreads", &picture.threads.to_string()]);
        Some(silent(command))
    }
}

fn silent(mut command: Command) -> Command {
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// The line in which a program names itself; `None` where it cannot be started.
fn names_itself(program: &str, option: &str, begins: &str) -> Option<String> {
    let output = Command::new(program).arg(option).output().ok()?;
    // Versions come among other messages, on either stream.
    let text = [output.stdout, output.stderr].concat();
    let text = String::from_utf8_lossy(&text);
    text.lines().find(|line| line.starts_with(begins)).map(|line| line.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn programs() -> Programs {
        Programs { snell: "snell".into(), povray: Some("POV-Ray 3".to_owned()), tachyon: None }
    }

    #[test]
    fn all_are_asked_for_the_same_picture() {
        let picture = Picture { width: 64, height: 48, threads: 1, antialiasing: Antialiasing::Adaptive };
        let ours = process::shown(&programs().snell(Path::new("a.toml"), Path::new("a.png"), picture));
        assert!(ours.contains("--width 64 --height 48 --threads 1 --aa adaptive"), "{ours}");
        let theirs = programs().povray(Path::new("x/a.pov"), Path::new("a.png"), picture).expect("it is there");
        let theirs = process::shown(&theirs);
        assert!(theirs.contains("+Ia.pov +Oa.png +W64 +H48 +WT1 -D -GA +A0.3 +AM1 +R3"), "{theirs}");
    }

    #[test]
    fn what_is_not_installed_has_no_command() {
        assert!(programs().tachyon(Path::new("a.dat"), Path::new("a.png"), PLAIN).is_none());
        assert!(names_itself("no-such-program-anywhere", "--version", "").is_none());
    }
}
