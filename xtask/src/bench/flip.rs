//! How far apart two pictures look, by ꟻLIP: asked of the example program of `snell-image`, since this crate knows no other of ours.

use std::path::{Path, PathBuf};

use crate::process;

/// The program, built.
pub struct Flip(PathBuf);

impl Flip {
    /// Builds it.
    pub fn build() -> Result<Self, String> {
        process::run(process::cargo().args([
            "build",
            "--release",
            "--quiet",
            "-p",
            "snell-image",
            "--example",
            "flip",
        ]))?;
        let name = format!("flip{}", std::env::consts::EXE_SUFFIX);
        Ok(Self(process::target().join("release").join("examples").join(name)))
    }

    /// The mean of the map of two PNG files: 0 where no difference is seen, at most 1.
    pub fn between(&self, reference: &Path, test: &Path) -> Result<f64, String> {
        let printed = process::output(process::program(&self.0.to_string_lossy()).arg(reference).arg(test))?;
        printed.trim().parse().map_err(|_| format!("`flip` printed `{}`", printed.trim()))
    }
}
