//! `cargo xtask tidy`: the invariants of the architecture that a program can check, each with `file:line` where it breaks.
//!
//! One file per family of rules; what is allowed stands in small tables at their tops, to be changed on purpose and in
//! review. Every rule has a test that plants the defect it is for (`tests.rs`).

mod attributes;
mod crates;
mod files;
mod library;
mod links;
mod paths;
mod rooms;
mod source;
#[cfg(test)]
mod tests;
mod tree;
mod words;

use std::path::Path;

use crate::Outcome;
use crate::arguments::Arguments;
use crate::process;
use tree::Tree;

/// One place where an invariant does not hold.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Problem {
    /// Relative to the root, with `/`.
    path: String,
    /// From 1; 1 too where the whole file is meant.
    line: usize,
    /// The rule's short name.
    rule: &'static str,
    message: String,
}

/// What the rules have found.
#[derive(Debug, Default)]
struct Report {
    problems: Vec<Problem>,
    /// Worth knowing, but no failure.
    notes: Vec<String>,
}

impl Report {
    fn problem(&mut self, rule: &'static str, path: &str, line: usize, message: impl Into<String>) {
        self.problems.push(Problem { path: path.to_owned(), line, rule, message: message.into() });
    }
}

/// A family of rules.
type Rule = fn(&Tree, &mut Report);

const RULES: &[Rule] = &[
    files::first_line_says_what_it_is,
    files::no_file_is_too_long,
    files::no_file_is_too_big,
    files::every_scene_has_its_golden,
    files::changelog_has_a_place_for_news,
    crates::dependencies_point_inwards,
    rooms::rooms_know_only_what_they_may,
    library::libraries_touch_nothing_outside,
    attributes::silenced_lints_have_reasons,
    words::no_unfinished_work,
    words::no_forbidden_words,
    links::links_lead_somewhere,
];

/// Runs the command line `cargo xtask tidy`.
pub fn run(arguments: Arguments) -> Outcome {
    arguments.nothing()?;
    println!("{}", check_and_print(&process::root())?);
    Ok(())
}

/// Checks the tree below `root`, prints what is wrong, and sums up what is right.
pub fn check_and_print(root: &Path) -> Result<String, String> {
    let tree = Tree::read(root)?;
    let report = check(&tree);
    for note in &report.notes {
        println!("note: {note}");
    }
    for Problem { path, line, rule, message } in &report.problems {
        println!("{path}:{line}: {message} [{rule}]");
    }
    match report.problems.len() {
        0 => Ok(format!("{} files are tidy", tree.files.len())),
        1 => Err("1 place is untidy".to_owned()),
        several => Err(format!("{several} places are untidy")),
    }
}

fn check(tree: &Tree) -> Report {
    let mut report = Report::default();
    for rule in RULES {
        rule(tree, &mut report);
    }
    report.problems.sort();
    report
}
