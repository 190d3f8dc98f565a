//! `cargo xtask bench --write-docs`: the marked regions of docs/performance.md, rewritten from what was just measured.
//!
//! A region begins with the line `<!-- bench:NAME -->` and ends with `<!-- /bench:NAME -->`. Benchmarks that did not run keep theirs.

use super::report::BARS_HEAD;
use crate::process;

/// The page with the regions.
const PAGE: &str = "docs/performance.md";

/// The name of the region with the bars of all benchmarks.
const BARS: &str = "bars";

/// Puts `text` into the page's region `name`.
pub fn write(name: &str, text: &str) -> Result<(), String> {
    rewrite(|page| replaced(page, name, text))
}

/// Puts rows into the table of bars, each benchmark's with its name, in the order of `groups`. Rows of benchmarks that are not among them
/// stay; of those that are, only where `is_part` and their figure was not measured anew.
pub fn write_bars(groups: &[&str], fresh: &[(&str, String)], is_part: bool) -> Result<(), String> {
    rewrite(|page| {
        let (_, old, _) = region(page, BARS)?;
        replaced(page, BARS, &merged(old, groups, fresh, is_part))
    })
}

/// The table of bars after a run.
fn merged(old: &str, groups: &[&str], fresh: &[(&str, String)], is_part: bool) -> String {
    let mut table = BARS_HEAD.to_owned();
    for group in groups {
        let head = format!("| {group} |");
        let new = fresh.iter().find(|(name, _)| name == group).map(|(_, rows)| rows);
        let figure = |row: &str| row.split('|').nth(2).map(str::to_owned);
        let is_kept = |row: &str| match new {
            None => true,
            Some(rows) => is_part && !rows.lines().any(|row_now| figure(row_now) == figure(row)),
        };
        for row in old.lines().filter(|row| row.starts_with(&head) && is_kept(row)) {
            table += row;
            table.push('\n');
        }
        table += new.map_or("", String::as_str);
    }
    table
}

fn rewrite(change: impl FnOnce(&str) -> Result<String, String>) -> Result<(), String> {
    let path = process::root().join(PAGE);
    let page = std::fs::read_to_string(&path).map_err(|error| format!("cannot read {PAGE}: {error}"))?;
    std::fs::write(&path, change(&page)?).map_err(|error| format!("cannot write {PAGE}: {error}"))
}

/// The page before a region, with the line that begins it; the region; and what follows.
fn region<'p>(page: &'p str, name: &str) -> Result<(&'p str, &'p str, &'p str), String> {
    let (begin, end) = (format!("<!-- bench:{name} -->\n"), format!("<!-- /bench:{name} -->"));
    let missing = || format!("{PAGE} has no region `{name}` ({} ... {end})", begin.trim_end());
    let start = page.find(&begin).ok_or_else(missing)? + begin.len();
    let length = page[start..].find(&end).ok_or_else(missing)?;
    Ok((&page[..start], &page[start..start + length], &page[start + length..]))
}

/// The page with another text in one region; an error where it has no such region.
fn replaced(page: &str, name: &str, text: &str) -> Result<String, String> {
    let (before, _, after) = region(page, name)?;
    Ok(format!("{before}{}\n{after}", text.trim_end()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_named_region_changes() {
        let page = "a\n<!-- bench:x -->\nold\n<!-- /bench:x -->\nb\n<!-- bench:y -->\nkept\n<!-- /bench:y -->\n";
        let new = replaced(page, "x", "new\n").expect("it is there");
        assert_eq!(new, page.replace("old", "new"));
        assert!(replaced(page, "z", "new").is_err());
        assert!(replaced("<!-- bench:x -->\nno end", "x", "new").is_err());
    }

    #[test]
    fn bars_of_benchmarks_that_did_not_run_stay() {
        let old = "| benchmark | figure |\n|---|---|\n| a | one | 1 |\n| a | two | 1 |\n| b | three | 1 |\n";
        let groups = ["b", "a"];
        let rows = |table: String| table.lines().skip(2).map(str::to_owned).collect::<Vec<_>>();
        let fresh = [("a", "| a | two | 2 |\n".to_owned())];
        assert_eq!(rows(merged(old, &groups, &fresh, false)), ["| b | three | 1 |", "| a | two | 2 |"]);
        let part = rows(merged(old, &groups, &fresh, true));
        assert_eq!(part, ["| b | three | 1 |", "| a | one | 1 |", "| a | two | 2 |"]);
    }

    #[test]
    fn the_page_has_a_region_for_every_benchmark() {
        let page = std::fs::read_to_string(process::root().join(PAGE)).expect("the page is there");
        for group in super::super::GROUPS {
            assert!(replaced(&page, group.name, "").is_ok(), "{}", group.name);
        }
        assert!(replaced(&page, "bars", "").is_ok());
    }
}
