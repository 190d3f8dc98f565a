//! The words of messages: what was expected, lists of choices, the nearest key.

use super::super::schema::Part;
use super::number::Range;
use crate::diagnostic::did_you_mean;

/// What a part of the schema takes, with range and unit: "a number above 0, in world units".
pub(in crate::document) fn expected(part: Part<'_>) -> String {
    let mut phrases = Vec::new();
    gather(part, part, &mut phrases, &one);
    with_unit(part, list(phrases.into_iter(), "or"))
}

fn with_unit(part: Part<'_>, phrase: String) -> String {
    match part.text("x-unit") {
        Some(unit) => format!("{phrase}, in {unit}"),
        None => phrase,
    }
}

/// What each of the types that a part may be of is called, once.
fn gather<'a>(whole: Part<'a>, part: Part<'a>, phrases: &mut Vec<String>, say: &dyn Fn(Part<'a>, Part<'a>) -> String) {
    let branches = part.branches();
    let phrase = match part.text("x-called") {
        Some(called) => called.to_owned(),
        None if branches.is_empty() => say(whole, part),
        None => return branches.iter().for_each(|branch| gather(whole, *branch, phrases, say)),
    };
    if !phrases.contains(&phrase) {
        phrases.push(phrase);
    }
}

/// What a number may be, with range and unit.
pub(super) fn number(part: Part<'_>, form: Part<'_>) -> String {
    with_unit(part, one(part, form))
}

/// The types that a part takes, without ranges: "a number or a table".
pub(super) fn kinds(part: Part<'_>) -> String {
    let mut phrases = Vec::new();
    gather(part, part, &mut phrases, &|_, form| match form.kind() {
        Some("array") => list_of(form),
        kind => article(kind.unwrap_or("string")).to_owned(),
    });
    list(phrases.into_iter(), "or")
}

fn one(whole: Part<'_>, form: Part<'_>) -> String {
    match form.kind() {
        Some(kind @ ("number" | "integer")) => {
            let range = Range::of(whole, form).in_words();
            if range.is_empty() { article(kind).to_owned() } else { format!("{} {range}", article(kind)) }
        }
        Some("string") if !form.words().is_empty() => list(form.words().iter().map(|word| format!("{word:?}")), "or"),
        Some("string") => match form.text("x-names") {
            Some(table) => format!("the name of a {table}"),
            None => "a text".to_owned(),
        },
        Some("array") => list_of(form),
        Some("object") if form.entries().is_some() => "tables by name".to_owned(),
        Some(kind) => article(kind).to_owned(),
        None => "a value".to_owned(),
    }
}

fn list_of(form: Part<'_>) -> String {
    let item = form.items().map_or_else(|| "values".to_owned(), |item| plural(item));
    match (form.number("minItems"), form.number("maxItems")) {
        (Some(min), Some(max)) if min == max => format!("a list of {min} {item}"),
        (Some(min), None) => format!("a list of {min} or more {item}"),
        (Some(min), Some(max)) => format!("a list of {min} to {max} {item}"),
        _ => format!("a list of {item}"),
    }
}

fn plural(item: Part<'_>) -> String {
    if let Some(called) = item.text("x-called") {
        // "a colour" are "colours", "a number or formula" are "numbers or formulas".
        let words = called.strip_prefix("a ").unwrap_or(called).split(" or ");
        return words.map(|word| format!("{word}s")).collect::<Vec<_>>().join(" or ");
    }
    match item.forms().as_slice() {
        [form] => match form.kind() {
            Some("number") => "numbers".to_owned(),
            Some("integer") => "whole numbers".to_owned(),
            Some("array") => list_of(*form).replacen("a list", "lists", 1),
            Some("object") => "tables".to_owned(),
            _ => "texts".to_owned(),
        },
        _ => "values".to_owned(),
    }
}

fn article(kind: &str) -> &'static str {
    match kind {
        "number" => "a number",
        "integer" => "a whole number",
        "string" => "a text",
        "boolean" => "true or false",
        "array" => "a list",
        _ => "a table",
    }
}

/// "a, b or c".
pub(super) fn list(items: impl Iterator<Item = String>, last: &str) -> String {
    let items: Vec<String> = items.collect();
    match items.as_slice() {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., end] => format!("{} {last} {end}", first.join(", ")),
    }
}

/// The candidate nearest to a word: by spelling, or the only one that begins with it.
pub(super) fn nearest<'a>(word: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let candidates: Vec<&str> = candidates.collect();
    did_you_mean(word, candidates.iter().copied()).or_else(|| {
        let mut beginning = candidates.iter().filter(|candidate| !word.is_empty() && candidate.starts_with(word));
        beginning.next().copied().filter(|_| beginning.next().is_none())
    })
}
