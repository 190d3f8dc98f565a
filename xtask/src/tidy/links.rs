//! Links in Markdown files to other files of the repository lead somewhere.
//!
//! Looked at are `[text](target)`, `![text](target)`, `[label]: target`, and `src="..."` and `href="..."` of embedded
//! HTML; not what stands in code, and not addresses of the web, which only the web can check.

use super::source::line_at;
use super::{Report, Tree};

/// Every relative link of every Markdown file names a file or folder of the repository.
pub fn links_lead_somewhere(tree: &Tree, report: &mut Report) {
    for (path, text) in tree.text().filter(|(path, _)| path.ends_with(".md")) {
        let prose = without_code(text);
        for (offset, target) in targets(&prose) {
            let Some(file) = file_of(target) else { continue };
            let found = resolve(path, &file).is_some_and(|wanted| exists(tree, &wanted));
            if !found {
                let message = format!("the link to `{target}` leads nowhere");
                report.problem("link", path, line_at(text, offset), message);
            }
        }
    }
}

/// Blanks fenced blocks and code spans; lines and offsets stay.
fn without_code(text: &str) -> String {
    let mut prose = String::with_capacity(text.len());
    let mut fence: Option<&str> = None;
    for line in text.split_inclusive('\n') {
        let mark = line.trim_start();
        let opens = ["```", "~~~"].into_iter().find(|fence| mark.starts_with(fence));
        match (fence, opens) {
            (None, None) => prose += &without_spans(line),
            (None, Some(mark)) => {
                fence = Some(mark);
                prose += &super::source::blank(line);
            }
            (Some(open), _) => {
                if mark.starts_with(open) {
                    fence = None;
                }
                prose += &super::source::blank(line);
            }
        }
    }
    prose
}

/// Blanks what stands between pairs of equally long runs of backticks in one line.
fn without_spans(line: &str) -> String {
    let mut prose = String::with_capacity(line.len());
    let mut rest = line;
    while let Some(start) = rest.find('`') {
        let run = rest[start..].bytes().take_while(|&byte| byte == b'`').count();
        let after = start + run;
        let ticks = &rest[start..after];
        prose += &rest[..start];
        match rest[after..].find(ticks) {
            Some(length) => {
                let end = after + length + run;
                prose += &super::source::blank(&rest[start..end]);
                rest = &rest[end..];
            }
            None => {
                prose += ticks;
                rest = &rest[after..];
            }
        }
    }
    prose + rest
}

/// All link targets with their offsets.
fn targets(prose: &str) -> Vec<(usize, &str)> {
    let mut targets = Vec::new();
    let mut take = |start: usize, ends: &[char]| {
        let length = prose[start..].find(ends).unwrap_or(prose.len() - start);
        targets.push((start, prose[start..start + length].trim()));
    };
    for (offset, opening) in prose.match_indices("](") {
        let start = offset + opening.len();
        // `(target "title")` ends the target at the space, `(<a b>)` at the bracket.
        if prose[start..].starts_with('<') { take(start + 1, &['>', '\n']) } else { take(start, &[')', ' ', '\n']) }
    }
    for (offset, opening) in ["src=\"", "href=\""].iter().flat_map(|opening| prose.match_indices(opening)) {
        take(offset + opening.len(), &['"', '\n']);
    }
    let mut line_start = 0;
    for line in prose.split_inclusive('\n') {
        // `[label]: target`, but not the footnote `[^1]: text`.
        if line.starts_with('[')
            && !line.starts_with("[^")
            && let Some(end) = line.find("]: ")
        {
            let gap = line[end + 2..].len() - line[end + 2..].trim_start().len();
            take(line_start + end + 2 + gap, &[' ', '\n']);
        }
        line_start += line.len();
    }
    targets
}

/// The file that a target names, without its anchor; `None` for the web and for anchors in the same file.
fn file_of(target: &str) -> Option<String> {
    let scheme = target.split_once(':').map(|(scheme, _)| scheme);
    if scheme.is_some_and(|scheme| !scheme.contains('/')) {
        return None;
    }
    let file = target.split(['#', '?']).next().unwrap_or_default();
    (!file.is_empty() || target.is_empty()).then(|| file.replace("%20", " "))
}

/// The path from the root; `None` where it is empty or leaves the repository.
fn resolve(from: &str, target: &str) -> Option<String> {
    let folder = from.rsplit_once('/').map_or("", |(folder, _)| folder);
    let (folder, target) = match target.strip_prefix('/') {
        Some(from_root) => ("", from_root),
        None if target.is_empty() => return None,
        None => (folder, target),
    };
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in target.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop()?;
            }
            name => parts.push(name),
        }
    }
    Some(parts.join("/"))
}

/// Whether the path is a file of the tree or a folder that holds one; the root is empty.
fn exists(tree: &Tree, path: &str) -> bool {
    path.is_empty() || tree.below(path).next().is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_of_every_kind_are_found_and_code_is_not() {
        let text = "[a](one.md) ![b](<two b.png> \"t\") `[c](no.md)` ``x ` [d](no.md)``\n```\n[e](no.md)\n```\n\
                    [f]: three.md\n<img src=\"four.png\"> [^1]: no.md\n";
        let prose = without_code(text);
        assert_eq!(prose.len(), text.len());
        let mut found: Vec<&str> = targets(&prose).into_iter().map(|(_, target)| target).collect();
        found.sort_unstable();
        assert_eq!(found, ["four.png", "one.md", "three.md", "two b.png"]);
    }

    #[test]
    fn the_web_and_anchors_are_left_alone() {
        assert_eq!(file_of("https://example.org/a"), None);
        assert_eq!(file_of("mailto:a@example.org"), None);
        assert_eq!(file_of("#part"), None);
        assert_eq!(file_of("a%20b.md#part").as_deref(), Some("a b.md"));
        assert_eq!(file_of("").as_deref(), Some(""));
    }

    #[test]
    fn targets_are_relative_to_their_file_and_stay_inside() {
        assert_eq!(resolve("docs/a.md", "../README.md").as_deref(), Some("README.md"));
        assert_eq!(resolve("docs/a.md", "./b/c.png").as_deref(), Some("docs/b/c.png"));
        assert_eq!(resolve("docs/a.md", "/src").as_deref(), Some("src"));
        assert_eq!(resolve("docs/a.md", "../../outside.md"), None);
        assert_eq!(resolve("docs/a.md", ""), None);
    }
}
