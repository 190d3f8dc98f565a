//! Which crate may know which: the only edges there are between the crates of this workspace.

use toml::de::{DeTable, DeValue};

use super::source::line_at;
use super::{Report, Tree};

/// A crate and those it may be built on.
struct Edges {
    name: &'static str,
    may_use: &'static [&'static str],
}

/// Mathematics at the bottom, shells on top. The shells see the lower crates through `snell`, which re-exports them.
const CRATES: &[Edges] = &[
    Edges { name: "snell-math", may_use: &[] },
    Edges { name: "snell-image", may_use: &["snell-math"] },
    Edges { name: "snell-scene", may_use: &["snell-math"] },
    Edges { name: "snell", may_use: &["snell-math", "snell-image", "snell-scene"] },
    Edges { name: "snell-cli", may_use: &["snell"] },
    Edges { name: "snell-studio", may_use: &["snell"] },
    Edges { name: "snell-python", may_use: &["snell"] },
    Edges { name: "snell-testkit", may_use: &["snell-math", "snell-image"] },
    Edges { name: "snell-fuzz", may_use: &["snell-math", "snell-image", "snell-scene", "snell"] },
    Edges { name: "xtask", may_use: &[] },
];

/// What tests of any crate may use besides.
const FOR_TESTS: &[&str] = &["snell-testkit"];

/// Every `Cargo.toml` names only the crates of ours that it may.
pub fn dependencies_point_inwards(tree: &Tree, report: &mut Report) {
    for (path, text) in tree.text().filter(|(path, _)| *path == "Cargo.toml" || path.ends_with("/Cargo.toml")) {
        let manifest = match DeTable::parse(text) {
            Ok(manifest) => manifest,
            Err(error) => {
                let line = line_at(text, error.span().map_or(0, |span| span.start));
                report.problem("crates", path, line, error.message());
                continue;
            }
        };
        check(path, text, manifest.get_ref(), report);
    }
}

fn check(path: &str, text: &str, manifest: &DeTable, report: &mut Report) {
    let Some(package) = table(manifest, "package") else { return };
    let name = package.get("name").and_then(|name| name.get_ref().as_str()).unwrap_or_default();
    let Some(edges) = CRATES.iter().find(|edges| edges.name == name) else {
        let message = format!("crate `{name}` is not in the table of xtask/src/tidy/crates.rs");
        report.problem("crates", path, 1, message);
        return;
    };
    let of_targets = table(manifest, "target").into_iter().flat_map(|targets| targets.values());
    for manifest in of_targets.filter_map(|target| target.get_ref().as_table()).chain([manifest]) {
        for (kind, is_for_tests) in [("dependencies", false), ("build-dependencies", false), ("dev-dependencies", true)]
        {
            for (key, value) in table(manifest, kind).into_iter().flatten() {
                // `alias = { package = "name" }`
                let package = value.get_ref().as_table().and_then(|table| table.get("package"));
                let used = package.and_then(|package| package.get_ref().as_str()).unwrap_or(key.get_ref());
                let is_ours = CRATES.iter().any(|edges| edges.name == used) || used.starts_with("snell");
                let is_allowed = edges.may_use.contains(&used) || is_for_tests && FOR_TESTS.contains(&used);
                if is_ours && !is_allowed {
                    let line = line_at(text, key.span().start);
                    let message = format!("`{name}` must not know `{used}`: see xtask/src/tidy/crates.rs");
                    report.problem("crates", path, line, message);
                }
            }
        }
    }
}

fn table<'m, 'i>(parent: &'m DeTable<'i>, key: &str) -> Option<&'m DeTable<'i>> {
    match parent.get(key)?.get_ref() {
        DeValue::Table(table) => Some(table),
        _ => None,
    }
}
