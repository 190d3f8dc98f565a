//! `cargo xtask bench --write-docs`: the marked regions of docs/performance.md, rewritten from what was just measured.
//!
//! A region begins with the line `<!-- bench:NAME -->` and ends with `<!-- /bench:NAME -->`. Benchmarks that did not run keep theirs.

use crate::process;

/// The page with the regions.
const PAGE: &str = "docs/performance.md";

/// Puts `text` into the page's region `name`.
pub fn write(name: &str, text: &str) -> Result<(), String> {
    let path = process::root().join(PAGE);
    let page = std::fs::read_to_string(&path).map_err(|error| format!("cannot read {PAGE}: {error}"))?;
    let page = replaced(&page, name, text)?;
    std::fs::write(&path, page).map_err(|error| format!("cannot write {PAGE}: {error}"))
}

/// The page with another text in one region; an error where it has no such region.
fn replaced(page: &str, name: &str, text: &str) -> Result<String, String> {
    let (begin, end) = (format!("<!-- bench:{name} -->\n"), format!("<!-- /bench:{name} -->"));
    let missing = || format!("{PAGE} has no region `{name}` ({} ... {end})", begin.trim_end());
    let (before, rest) = page.split_once(&begin).ok_or_else(missing)?;
    let (_, after) = rest.split_once(&end).ok_or_else(missing)?;
    Ok(format!("{before}{begin}{}\n{end}{after}", text.trim_end()))
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
    fn the_page_has_a_region_for_every_benchmark() {
        let page = std::fs::read_to_string(process::root().join(PAGE)).expect("the page is there");
        for group in super::super::GROUPS {
            assert!(replaced(&page, group.name, "").is_ok(), "{}", group.name);
        }
        assert!(replaced(&page, "bars", "").is_ok());
    }
}
