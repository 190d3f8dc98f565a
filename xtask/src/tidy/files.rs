//! Rules on whole files: their first line, their length and size, and files that belong together.

use super::tree::{Content, is_below};
use super::{Report, Tree};

/// A Rust file this long is split; lines.
const TOO_LONG: usize = 800;
/// A Rust file this long is worth a thought; lines.
const LONG: usize = 500;
/// A file that is not text may have so many bytes.
const LARGEST_BINARY: u64 = 1 << 20;
/// A reference picture may have so many bytes: there will be many, and they change.
const LARGEST_GOLDEN: u64 = 64 << 10;
/// And a reference drawing, which is text and packs well.
const LARGEST_GOLDEN_DRAWING: u64 = 128 << 10;

/// Every Rust file begins with a line that says what it is.
pub fn first_line_says_what_it_is(tree: &Tree, report: &mut Report) {
    for (path, source) in tree.rust() {
        let first = source.text.lines().next().unwrap_or_default();
        if first.strip_prefix("//!").is_none_or(|words| words.trim().is_empty()) {
            report.problem("first-line", path, 1, "the first line says what the file is: `//! ...`");
        }
    }
}

/// Rust files are short enough to be read at one sitting.
pub fn no_file_is_too_long(tree: &Tree, report: &mut Report) {
    for (path, source) in tree.rust() {
        let lines = source.text.lines().count();
        if lines > TOO_LONG {
            report.problem("length", path, TOO_LONG + 1, format!("{lines} lines; {TOO_LONG} at most, split it"));
        } else if lines > LONG {
            report.notes.push(format!("{path} has {lines} lines; over {LONG} needs a reason"));
        }
    }
}

/// The repository stays quick to clone.
pub fn no_file_is_too_big(tree: &Tree, report: &mut Report) {
    for file in &tree.files {
        let limit = match file.content {
            _ if is_below(&file.path, "goldens/drawings") => LARGEST_GOLDEN_DRAWING,
            _ if is_below(&file.path, "goldens") => LARGEST_GOLDEN,
            Content::Binary => LARGEST_BINARY,
            _ => continue,
        };
        if file.size > limit {
            report.problem("size", &file.path, 1, format!("{} bytes; {limit} at most", file.size));
        }
    }
}

/// Once there are reference pictures, every scene has one: `scenes/**/NAME.toml` and `goldens/**/NAME.*`.
pub fn every_scene_has_its_golden(tree: &Tree, report: &mut Report) {
    let goldens: Vec<&str> = tree.below("goldens").filter_map(|file| stem(&file.path)).collect();
    if goldens.is_empty() {
        return;
    }
    for file in tree.below("scenes").filter(|file| file.path.ends_with(".toml")) {
        if stem(&file.path).is_some_and(|name| !goldens.contains(&name)) {
            report.problem("golden", &file.path, 1, "has no reference picture; `cargo xtask golden --bless` makes one");
        }
    }
}

/// The file's name without folders and without its last ending.
fn stem(path: &str) -> Option<&str> {
    let name = path.rsplit('/').next()?;
    name.rsplit_once('.').map(|(stem, _)| stem)
}

/// News for users have a place to go.
pub fn changelog_has_a_place_for_news(tree: &Tree, report: &mut Report) {
    let changelog = tree.text().find(|(path, _)| *path == "CHANGELOG.md").map(|(_, text)| text);
    let has_place = changelog
        .is_some_and(|text| text.lines().any(|line| matches!(line.trim_end(), "## [Unreleased]" | "## Unreleased")));
    if !has_place {
        report.problem("changelog", "CHANGELOG.md", 1, "needs a section `## [Unreleased]`");
    }
}
