//! The program benches/embree/kernels.cpp, compiled where a C++ compiler and Embree 3 are installed.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::kernels::{View, figures};
use crate::process;

/// The program, compiled.
pub struct Embree(PathBuf);

impl Embree {
    /// Compiles it; `None` where that does not succeed, which is said.
    pub fn build(scratch: &Path) -> Option<Self> {
        let program = scratch.join("embree-kernels");
        let source = process::root().join("benches/embree/kernels.cpp");
        let mut compiler = Command::new("c++");
        compiler.args(["-std=c++17", "-O3", "-march=native", "-o"]).arg(&program).arg(&source).arg("-lembree3");
        match compiler.stderr(Stdio::null()).status() {
            Ok(status) if status.success() => Some(Self(program)),
            _ => {
                println!(
                    "Embree 3 or a C++ compiler is not installed, so that is left out (`apt-get install g++ libembree-dev`)."
                );
                None
            }
        }
    }

    /// Makes the ray sets of a mesh: files that begin with `prefix`, `edge` x `edge` rays each.
    pub fn make_rays(&self, mesh: &Path, prefix: &Path, edge: u32, view: &View) -> Result<(), String> {
        let mut command = process::program(&self.0.to_string_lossy());
        command.arg("rays").arg(mesh).arg(prefix).arg(edge.to_string());
        let numbers = view.eye.iter().chain(&view.at).chain([&view.tangent]).chain(&view.light);
        command.args(numbers.chain([&view.half_edge, &view.lift]).map(f64::to_string));
        process::run(&mut command)
    }

    /// Measures in Embree's default mode or the robust one.
    pub fn measure(&self, mesh: &Path, prefix: &Path, mode: &str, rounds: usize) -> Result<Vec<(String, f64)>, String> {
        let mut command = process::program(&self.0.to_string_lossy());
        command.arg("measure").arg(mesh).arg(prefix).arg(mode).arg(rounds.to_string());
        Ok(figures(&process::output(&mut command)?))
    }
}
