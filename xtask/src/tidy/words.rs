//! Words that must not stand in the repository: marks of unfinished work, and a list of the project's own.

use super::source::{is_name, line_at};
use super::{Report, Tree};

/// Marks of unfinished work, put together here so that this file does not find itself.
const MARKS: &[&str] = &[concat!("TO", "DO"), concat!("FIX", "ME"), concat!("XX", "X")];

/// Endings of files that people of the project write; in others, letters may mean anything.
const WRITTEN: &[&str] = &["rs", "toml", "md", "sh", "yml", "yaml", "py", "pov", "inc", "html", "css", "js", "ts"];

/// The list of words that no file may mention: one a line, `#` begins a comment. Absent or empty, all words are allowed.
const LIST: &str = "xtask/forbidden-words.txt";

/// What is not finished is not merged; what is left for later is an issue.
pub fn no_unfinished_work(tree: &Tree, report: &mut Report) {
    for (path, text) in tree.text() {
        let is_written = path.rsplit_once('.').is_some_and(|(_, ending)| WRITTEN.contains(&ending));
        if is_written || path == ".ci/run" {
            for mark in MARKS {
                for offset in whole_words(text, mark) {
                    report.problem(
                        "unfinished",
                        path,
                        line_at(text, offset),
                        format!("`{mark}`: finish it, or file it"),
                    );
                }
            }
        }
    }
}

/// No file mentions, in its path or its text, a word of the list; case does not matter.
pub fn no_forbidden_words(tree: &Tree, report: &mut Report) {
    let list = tree.text().find(|(path, _)| *path == LIST).map_or("", |(_, text)| text);
    let words = list.lines().filter_map(|line| line.split('#').next()).map(str::trim).filter(|word| !word.is_empty());
    for word in words.map(str::to_ascii_lowercase) {
        for (path, text) in tree.text().filter(|(path, _)| *path != LIST) {
            for offset in whole_words(&text.to_ascii_lowercase(), &word) {
                report.problem("word", path, line_at(text, offset), format!("mentions `{word}`"));
            }
        }
        for file in
            tree.files.iter().filter(|file| whole_words(&file.path.to_ascii_lowercase(), &word).next().is_some())
        {
            report.problem("word", &file.path, 1, format!("its path mentions `{word}`"));
        }
    }
}

/// The offsets of `word` where it is not part of a longer one.
fn whole_words<'t>(text: &'t str, word: &'t str) -> impl Iterator<Item = usize> + 't {
    let bytes = text.as_bytes();
    text.match_indices(word).map(|(offset, _)| offset).filter(move |&offset| {
        let before = offset.checked_sub(1).map(|at| bytes[at]);
        let after = bytes.get(offset + word.len()).copied();
        !before.is_some_and(is_name) && !after.is_some_and(is_name)
    })
}
