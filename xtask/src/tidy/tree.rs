//! The files that the rules look at: what git knows or would add, or everything below the root where git is absent.

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;
use std::process::Command;

use super::source;

/// Folders that hold products, not sources, for when git cannot tell.
const PRODUCTS: &[&str] =
    &[".git", "target", "node_modules", "fuzz/target", "fuzz/corpus", "fuzz/artifacts", "fuzz/coverage"];

/// How much of a file decides whether it is text; bytes.
const SNIFFED: u64 = 8192;

/// All files of the project.
#[derive(Debug)]
pub struct Tree {
    /// Sorted by path.
    pub files: Vec<TreeFile>,
}

/// One file, read.
#[derive(Debug)]
pub struct TreeFile {
    /// Relative to the root, with `/`.
    pub path: String,
    /// In bytes.
    pub size: u64,
    pub content: Content,
}

/// What is in a file.
#[derive(Debug)]
pub enum Content {
    Binary,
    Text(String),
    Rust(RustSource),
}

/// A Rust file in three views of equal length and equal lines.
#[derive(Debug)]
pub struct RustSource {
    pub text: String,
    /// Comments and the insides of strings are blank.
    pub code: String,
    /// As `code`, and what is compiled for tests only is blank as well.
    pub shipped: String,
}

impl Tree {
    /// Reads the project below `root`.
    pub fn read(root: &Path) -> Result<Self, String> {
        let mut paths = match paths_from_git(root) {
            Some(paths) => paths,
            None => {
                let mut paths = Vec::new();
                walk(root, "", &mut paths)?;
                paths
            }
        };
        paths.sort();
        paths.dedup();
        let mut files = Vec::new();
        for path in paths {
            // Git also lists what has just been deleted, and submodules; symbolic links lead to files that are read anyway.
            match fs::symlink_metadata(root.join(&path)) {
                Ok(metadata) if metadata.is_file() => files.push(TreeFile::read(root, path, metadata.len())?),
                _ => {}
            }
        }
        Ok(Self { files })
    }

    /// Files whose path is, or is below, `prefix`.
    pub fn below<'t>(&'t self, prefix: &'t str) -> impl Iterator<Item = &'t TreeFile> {
        self.files.iter().filter(move |file| is_below(&file.path, prefix))
    }

    /// The Rust files.
    pub fn rust(&self) -> impl Iterator<Item = (&str, &RustSource)> {
        self.files.iter().filter_map(|file| match &file.content {
            Content::Rust(source) => Some((file.path.as_str(), source)),
            _ => None,
        })
    }

    /// All text files, Rust among them.
    pub fn text(&self) -> impl Iterator<Item = (&str, &str)> {
        self.files.iter().filter_map(|file| Some((file.path.as_str(), file.text()?)))
    }
}

impl TreeFile {
    fn read(root: &Path, path: String, size: u64) -> Result<Self, String> {
        let content =
            Content::read(&root.join(&path), &path).map_err(|error| format!("cannot read {path}: {error}"))?;
        Ok(Self { path, size, content })
    }

    /// The text, unless the file is binary.
    pub fn text(&self) -> Option<&str> {
        match &self.content {
            Content::Binary => None,
            Content::Text(text) => Some(text),
            Content::Rust(source) => Some(&source.text),
        }
    }
}

impl Content {
    fn read(file: &Path, path: &str) -> std::io::Result<Self> {
        let mut file = File::open(file)?;
        let mut bytes = Vec::new();
        (&mut file).take(SNIFFED).read_to_end(&mut bytes)?;
        if bytes.contains(&0) {
            return Ok(Self::Binary);
        }
        file.read_to_end(&mut bytes)?;
        Ok(match String::from_utf8(bytes) {
            Err(_) => Self::Binary,
            Ok(text) if path.ends_with(".rs") => {
                let code = source::without_comments_and_strings(&text);
                let shipped = if is_for_tests_only(path) { source::blank(&code) } else { source::without_tests(&code) };
                Self::Rust(RustSource { text, code, shipped })
            }
            Ok(text) => Self::Text(text),
        })
    }
}

/// Whether `path` is `prefix` or below it.
pub fn is_below(path: &str, prefix: &str) -> bool {
    path.strip_prefix(prefix).is_some_and(|rest| rest.is_empty() || rest.starts_with('/') || prefix.ends_with('/'))
}

/// Whether a Rust file is by its place no part of what ships: `tests.rs`, or below `tests/`, `benches/` or `examples/`.
fn is_for_tests_only(path: &str) -> bool {
    let mut parts = path.split('/').rev();
    parts.next() == Some("tests.rs") || parts.any(|folder| matches!(folder, "tests" | "benches" | "examples"))
}

/// Tracked files and those that git would add; `None` where `root` is no checkout or git does not run.
fn paths_from_git(root: &Path) -> Option<Vec<String>> {
    if !root.join(".git").exists() {
        return None;
    }
    let mut git = Command::new("git");
    git.current_dir(root).args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"]);
    let output = git.output().ok().filter(|output| output.status.success())?;
    let paths = String::from_utf8(output.stdout).ok()?;
    Some(paths.split_terminator('\0').map(str::to_owned).collect())
}

fn walk(root: &Path, folder: &str, paths: &mut Vec<String>) -> Result<(), String> {
    let entries = fs::read_dir(root.join(folder)).map_err(|error| format!("cannot read `{folder}`: {error}"))?;
    for entry in entries {
        let entry = entry.map_err(|error| format!("cannot read `{folder}`: {error}"))?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = if folder.is_empty() { name } else { format!("{folder}/{name}") };
        if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
            if !PRODUCTS.contains(&path.as_str()) {
                walk(root, &path, paths)?;
            }
        } else {
            paths.push(path);
        }
    }
    Ok(())
}
