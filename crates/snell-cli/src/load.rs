//! From what the command line calls a scene to the scene: which file or built-in scene is meant, and who reads it.

use std::path::Path;

use snell::scene::diagnostic::did_you_mean;
use snell::scene::reader::{self, nff};
use snell::scene::{Diagnostic, Diagnostics, Scene, document};

use crate::assets::{FileAssets, files_in};
use crate::builtin::{self, BuiltinAssets, BuiltinScene};
use crate::console::quoted;
use crate::failure::Failure;

/// What the end of a file's name says about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// Our own format, as TOML or JSON.
    Document,
    /// The Neutral File Format.
    Nff,
    /// A mesh without a scene.
    Mesh,
}

const ENDINGS: &[(&str, Kind)] = &[
    ("toml", Kind::Document),
    ("json", Kind::Document),
    ("nff", Kind::Nff),
    ("ply", Kind::Mesh),
    ("obj", Kind::Mesh),
    ("stl", Kind::Mesh),
];

/// A scene's place.
#[derive(Clone, Debug)]
pub enum Place {
    /// Inside the program.
    Builtin(BuiltinScene),
    /// On disk: the path as it was given, with `/` between its parts.
    File(String),
}

impl Place {
    /// The file or built-in scene that a name means. A file comes first.
    pub fn find(name: &str) -> Result<Self, Failure> {
        let path = Path::new(name);
        if path.exists() && !path.is_dir() {
            let name = if cfg!(windows) { name.replace('\\', "/") } else { name.to_owned() };
            return Ok(Self::File(name));
        }
        if let Some(scene) = builtin::find(name) {
            return Ok(Self::Builtin(scene));
        }
        let problem = if path.is_dir() { "is a folder, not a scene" } else { "is no file and no built-in scene" };
        let help = suggestion(name).map_or_else(
            || "`snell scenes` lists the built-in scenes".to_owned(),
            |near| format!("did you mean {}?", quoted(&near)),
        );
        Err(Failure::input(Diagnostic::error(format!("{} {problem}", quoted(name))).help(help)))
    }

    /// As messages and statistics call it.
    pub fn name(&self) -> &str {
        match self {
            Self::Builtin(scene) => scene.name,
            Self::File(path) => path,
        }
    }

    /// What a picture of it is called, without the ending.
    pub fn stem(&self) -> String {
        let stem = match self {
            Self::Builtin(scene) => Some(scene.name.into()),
            Self::File(path) => Path::new(path).file_stem().map(|stem| stem.to_string_lossy().into_owned()),
        };
        stem.unwrap_or_else(|| "picture".to_owned())
    }

    /// Reads the scene. What is wrong with it, warnings too, goes with it.
    pub fn read(&self, set: &[String], assets: &FileAssets) -> Result<(Option<Scene>, Diagnostics), Failure> {
        let path = match self {
            Self::Builtin(scene) => {
                let assets = BuiltinAssets::default();
                return Ok(document::read_scene(&scene.source_name(), scene.text.as_bytes(), &assets, set));
            }
            Self::File(path) => path,
        };
        let kind = kind(path)?;
        if kind != Kind::Document && !set.is_empty() {
            let message = format!("--set changes scenes in TOML or JSON; {} is neither", quoted(path));
            return Err(Failure::usage(Diagnostic::error(message)));
        }
        let bytes = assets.read_named(path).map_err(|error| {
            Failure::input(Diagnostic::error(format!("the scene {} cannot be had: {error}", quoted(path))))
        })?;
        Ok(match kind {
            Kind::Document => document::read_scene(path, &bytes, assets, set),
            Kind::Nff => nff::read(path, &bytes),
            Kind::Mesh => reader::mesh_scene(path, &bytes, assets),
        })
    }
}

fn kind(path: &str) -> Result<Kind, Failure> {
    let extension = Path::new(path).extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    let known = ENDINGS.iter().find(|(ending, _)| extension.eq_ignore_ascii_case(ending));
    known.map(|(_, kind)| *kind).ok_or_else(|| {
        let ending =
            if extension.is_empty() { String::new() } else { format!(": {}", quoted(&format!(".{extension}"))) };
        let message = format!("{} does not end like a scene or a mesh{ending}", quoted(path));
        let help = "scenes are .toml, .json or .nff files, meshes .ply, .obj or .stl";
        Failure::input(Diagnostic::error(message).help(help))
    })
}

/// The name of a built-in scene or of a file in the same folder that looks like the one that is not there.
fn suggestion(name: &str) -> Option<String> {
    let (folder, file) = name.rsplit_once('/').map_or(("", name), |(folder, file)| (folder, file));
    let folder_path = if folder.is_empty() && !name.starts_with('/') { "." } else { &name[..name.len() - file.len()] };
    let mut files = files_in(Path::new(folder_path));
    files.retain(|file| kind(file).is_ok());

    // The same name without an ending, or with another one, is nearer than any misspelling.
    let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
    let same_stem = |other: &&String| other.rsplit_once('.').is_some_and(|(other, _)| other == stem);
    let prefix = &name[..name.len() - file.len()];
    if let Some(file) = files.iter().find(same_stem) {
        return Some(format!("{prefix}{file}"));
    }
    if let Some(scene) = builtin::find(stem) {
        return Some(scene.name.to_owned());
    }
    let builtins = builtin::all().map(|scene| scene.name);
    let near = did_you_mean(file, builtins.chain(files.iter().map(String::as_str)))?;
    let is_builtin = builtin::find(near).is_some();
    Some(if is_builtin { near.to_owned() } else { format!("{prefix}{near}") })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn misspelt_names_find_their_scene() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("kitchen-table.toml"), "").unwrap();
        std::fs::write(folder.path().join("notes.txt"), "").unwrap();
        let base = format!("{}/", folder.path().to_str().unwrap().replace('\\', "/"));
        let found = |name: &str| suggestion(&format!("{base}{name}"));
        assert_eq!(suggestion("nine-red-bals").as_deref(), Some("nine-red-balls"));
        assert_eq!(suggestion("lens.toml").as_deref(), Some("lens"));
        assert_eq!(found("kitchen-tabel.toml"), Some(format!("{base}kitchen-table.toml")));
        assert_eq!(found("kitchen-table"), Some(format!("{base}kitchen-table.toml")));
        assert_eq!(found("kitchen-table.nff"), Some(format!("{base}kitchen-table.toml")));
        assert_eq!(found("notes.tx"), None);
        for odd in ["", "/", ".", "..", "ä/ö.ü"] {
            let _ = suggestion(odd);
        }
    }

    #[test]
    fn endings_are_known_in_any_case() {
        assert_eq!(kind("a/b.TOML").unwrap(), Kind::Document);
        assert_eq!(kind("spot.Obj").unwrap(), Kind::Mesh);
        assert_eq!(kind("balls.nff").unwrap(), Kind::Nff);
        assert!(kind("picture.png").is_err() && kind("toml").is_err());
    }
}
