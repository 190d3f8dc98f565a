//! The scenes inside the program: those of the repository's folder `scenes`, with their pictures.

use std::sync::{Arc, Mutex};

use snell::scene::{AssetError, Assets};

/// `SCENES`: name and text of each, by name; `ASSETS`: path and bytes of the files that they name, by path.
mod embedded {
    include!(concat!(env!("OUT_DIR"), "/builtin.rs"));
}

/// The scene that is rendered where none is named.
pub const DEFAULT: &str = "nine-red-balls";

/// A built-in scene.
#[derive(Clone, Copy, Debug)]
pub struct BuiltinScene {
    /// What it is called.
    pub name: &'static str,
    /// Its file, TOML.
    pub text: &'static str,
}

impl BuiltinScene {
    /// The first line of the comment that opens it.
    pub fn title(&self) -> &'static str {
        self.text.lines().next().unwrap_or_default().trim_start_matches('#').trim()
    }

    /// The name under which diagnostics know its file. No folder is in it, so that its pictures are found in [`BuiltinAssets`].
    pub fn source_name(&self) -> String {
        format!("built-in:{}.toml", self.name)
    }
}

/// All of them, by name.
pub fn all() -> impl Iterator<Item = BuiltinScene> {
    embedded::SCENES.iter().map(|&(name, text)| BuiltinScene { name, text })
}

/// The one of that name.
pub fn find(name: &str) -> Option<BuiltinScene> {
    all().find(|scene| scene.name == name)
}

/// The files that built-in scenes name; it remembers which were read.
#[derive(Debug, Default)]
pub struct BuiltinAssets {
    read: Mutex<Vec<&'static str>>,
}

impl BuiltinAssets {
    /// Paths and bytes of what was read, by path, each once.
    pub fn files_read(&self) -> Vec<(&'static str, &'static [u8])> {
        let read = self.read.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        embedded::ASSETS.iter().copied().filter(|(path, _)| read.contains(path)).collect()
    }
}

impl Assets for BuiltinAssets {
    fn read(&self, resolved: &str) -> Result<Arc<[u8]>, AssetError> {
        let asset = embedded::ASSETS.iter().find(|(path, _)| *path == resolved);
        let (path, bytes) = asset.ok_or(AssetError::NotFound)?;
        self.read.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push(path);
        Ok((*bytes).into())
    }

    fn similar(&self, _resolved: &str) -> Vec<String> {
        embedded::ASSETS.iter().map(|(path, _)| (*path).to_owned()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_of_the_repository_is_inside() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes");
        let names = crate::assets::files_in(std::path::Path::new(folder));
        let names: Vec<&str> = names.iter().filter_map(|name| name.strip_suffix(".toml")).collect();
        assert_eq!(all().map(|scene| scene.name).collect::<Vec<_>>(), names);
        assert!(find(DEFAULT).is_some() && find("no such scene").is_none());
    }

    #[test]
    fn every_scene_has_a_title_and_a_name_for_the_command_line() {
        for scene in all() {
            assert!(scene.text.starts_with("# ") && !scene.title().is_empty(), "{}", scene.name);
            assert!(scene.name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'));
        }
    }
}
