//! The reference of the scene file, `docs/scene-format.md`, written from the schema.

use std::collections::BTreeSet;
use std::fmt::Write;

use serde_json::Value;

use super::schema::{Part, schema};

const INTRODUCTION: &str = include_str!("reference.md");

/// The reference as Markdown: an introduction, then every table with its keys, what they take and mean, and examples.
pub fn reference() -> String {
    let schema = schema();
    let mut text = INTRODUCTION.to_owned();
    let Some(root) = Part::root(&schema) else { return text };
    section(&mut text, "The file", root);
    // Breadth first, so that what belongs together stands near and each table comes once, where it is first named.
    let mut seen = BTreeSet::new();
    let mut queue = Vec::new();
    references(root, &mut seen, &mut queue);
    let mut next = 0;
    while let Some((name, part)) = queue.get(next).copied() {
        if part.kind() == Some("object") || part.text("x-called").is_some() {
            section(&mut text, name, part);
        }
        references(part, &mut seen, &mut queue);
        next += 1;
    }
    text
}

/// The definitions that a table's keys refer to and that have not been seen yet.
fn references<'a>(part: Part<'a>, seen: &mut BTreeSet<&'a str>, queue: &mut Vec<(&'a str, Part<'a>)>) {
    for (_, property) in part.properties() {
        collect(property, seen, queue);
    }
}

fn collect<'a>(part: Part<'a>, seen: &mut BTreeSet<&'a str>, queue: &mut Vec<(&'a str, Part<'a>)>) {
    if let Some(name) = part.reference() {
        if seen.insert(name) {
            queue.push((name, part));
        }
        return;
    }
    for word in ["items", "additionalProperties"] {
        if let Some(inner) = part.body.get(word).and_then(|inner| part.at(inner)) {
            collect(inner, seen, queue);
        }
    }
    if let Some(Value::Array(branches)) = part.body.get("anyOf") {
        branches.iter().filter_map(|branch| part.at(branch)).for_each(|branch| collect(branch, seen, queue));
    }
}

fn section(text: &mut String, name: &str, part: Part<'_>) {
    // Writing to a String does not fail.
    let _ =
        write!(text, "\n## {name}\n\n{}\n", part.body.get("description").and_then(Value::as_str).unwrap_or_default());
    let keys: Vec<(&str, Part<'_>)> = part.properties().filter(|(name, _)| !name.starts_with('$')).collect();
    if !keys.is_empty() {
        text.push_str("\n| key | takes | default | |\n|---|---|---|---|\n");
    }
    let (required, kinds) = (part.required(), part.exactly_one());
    for (key, property) in keys {
        let default = match property.written.get("default") {
            Some(default) => format!("`{}`", toml_text(default)),
            None if required.contains(&key) => "*required*".to_owned(),
            None if kinds.contains(&key) => "*one of these*".to_owned(),
            None => String::new(),
        };
        let about = description(property);
        let words = words(property);
        let _ = writeln!(text, "| `{key}` | {} | {default} | {} |", takes(property), cell(&format!("{about}{words}")));
    }
    if let Some(example) = part.body.get("x-example").and_then(Value::as_str) {
        let _ = write!(text, "\n```toml\n{example}```\n");
    }
}

/// What a key takes, with a link where that is a table with its own section.
fn takes(part: Part<'_>) -> String {
    let mut phrase = cell(&super::check::expected(part));
    let mut linked = Vec::new();
    collect(part, &mut BTreeSet::new(), &mut linked);
    for (name, target) in linked {
        let anchor = name.to_lowercase();
        let link = |word: &str| format!("[{word}](#{anchor})");
        if let Some(called) = target.text("x-called") {
            phrase = phrase.replacen(called, &link(called), 1);
        } else if target.kind() == Some("object") {
            phrase = if phrase.contains("tables") {
                phrase.replacen("tables", &link("tables"), 1)
            } else {
                phrase.replacen("a table", &link(name), 1)
            };
        }
    }
    phrase
}

/// The words that a key takes, with their meanings.
fn words(part: Part<'_>) -> String {
    let explained = part.forms().into_iter().filter_map(|form| {
        let word = form.body.get("const")?.as_str()?;
        Some(format!(" `\"{word}\"`: {}", description(form)))
    });
    explained.collect()
}

fn description(part: Part<'_>) -> &str {
    part.text("description").unwrap_or_default()
}

fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

/// A default as TOML writes it.
fn toml_text(value: &Value) -> String {
    match value {
        Value::Array(items) => format!("[{}]", items.iter().map(toml_text).collect::<Vec<_>>().join(", ")),
        Value::Number(number) => number.as_f64().map_or_else(|| number.to_string(), |number| number.to_string()),
        other => other.to_string(),
    }
}
