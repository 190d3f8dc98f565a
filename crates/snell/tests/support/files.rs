//! The repository's own files, as the tests of the engine need them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use snell::scene::assets::{AssetError, Assets};
use snell::scene::document::read_scene;
use snell::scene::{Diagnostics, Scene};

/// Files below the repository's root; their names are relative to it.
struct Repository;

impl Assets for Repository {
    fn read(&self, resolved: &str) -> Result<Arc<[u8]>, AssetError> {
        match std::fs::read(root().join(resolved)) {
            Ok(bytes) => Ok(bytes.into()),
            Err(_) => Err(AssetError::NotFound),
        }
    }
}

/// The repository's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The scene of a file, given by its path below the root.
///
/// # Panics
/// Where it has mistakes; the message tells them all.
pub fn scene_of_file(path: &str) -> Scene {
    let bytes = std::fs::read(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"));
    scene_of_text(path, &bytes)
}

/// The scene of a text; files that it names are looked for from `name`'s folder, below the root.
///
/// # Panics
/// Where it has mistakes; the message tells them all.
pub fn scene_of_text(name: &str, text: &[u8]) -> Scene {
    let (scene, diagnostics) = read_scene(name, text, &Repository, &[]);
    scene.unwrap_or_else(|| panic!("{name} is no scene:\n{}", told(&diagnostics)))
}

fn told(diagnostics: &Diagnostics) -> String {
    let line = |diagnostic: &snell::scene::Diagnostic| {
        let place = diagnostic.place.as_ref().map_or_else(String::new, |(span, _)| diagnostics.sources.location(span));
        format!("{place} {}", diagnostic.message)
    };
    diagnostics.list.iter().map(line).collect::<Vec<_>>().join("\n")
}
