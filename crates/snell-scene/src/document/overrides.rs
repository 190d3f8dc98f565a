//! `--set KEY=VALUE`: values put into a scene's tree before it is checked, so that every mistake points at the option.
//!
//! KEY is dotted, through lists by index or by name: `camera.fov`, `object.0.sphere.radius`, `light.key.point.intensity`.
//! VALUE is a TOML value; what is none and looks like bare words is a text.

use super::parse;
use super::tree::{Key, Node, Place, Value};
use crate::diagnostic::{Diagnostic, Diagnostics, SourceId, Span, did_you_mean};

/// The name under which diagnostics know the options.
const SOURCE_NAME: &str = "--set";

/// Puts the overrides into the tree, in their order.
pub(in crate::document) fn apply<'t>(root: &mut Node<'t>, overrides: &'t [String], diagnostics: &mut Diagnostics) {
    for text in overrides {
        let source = diagnostics.sources.add(SOURCE_NAME, text.as_str());
        match parse_override(text, source) {
            Ok((keys, value)) => {
                if let Err(diagnostic) = put(root, &keys, value) {
                    diagnostics.push(*diagnostic);
                }
            }
            Err(list) => diagnostics.list.extend(list),
        }
    }
}

/// The keys on the way and the value.
fn parse_override(text: &str, source: SourceId) -> Result<(Vec<Key<'_>>, Node<'_>), Vec<Diagnostic>> {
    let whole = Span { source, range: 0..text.len() };
    let wrong = |message: &str, span: Span| {
        vec![Diagnostic::error(message).at(span, "").help("write KEY=VALUE, such as camera.fov=30")]
    };
    let mut keys = Vec::new();
    let mut at = 0;
    loop {
        let key = next_key(text, at, source).map_err(|span| wrong("a key is missing or not closed", span))?;
        at = key.place.end as usize;
        keys.push(key);
        if keys.len() > parse::MAX_NESTING {
            return Err(wrong("too many keys", whole));
        }
        match text[at..].trim_start().chars().next() {
            Some('.') => at += text[at..].find('.').unwrap_or(0) + 1,
            Some('=') => {
                at += text[at..].find('=').unwrap_or(0) + 1;
                if text[at..].trim().is_empty() {
                    return Err(wrong("there is no value after `=`", whole));
                }
                break;
            }
            _ => return Err(wrong("there is no `=` between key and value", whole)),
        }
    }
    Ok((keys, parse_value(text, at, source)?))
}

/// The key that begins at or after a place: bare, or in quotes.
fn next_key(text: &str, at: usize, source: SourceId) -> Result<Key<'_>, Span> {
    let rest = &text[at..];
    let start = at + (rest.len() - rest.trim_start().len());
    let rest = &text[start..];
    let quote = rest.chars().next().filter(|c| matches!(c, '"' | '\''));
    let (name, length) = match quote {
        Some(quote) => {
            let inner = rest[1..].split(quote).next().unwrap_or_default();
            (inner, inner.len() + 2)
        }
        None => {
            let inner = rest.split(['.', '=']).next().unwrap_or_default();
            (inner.trim_end(), inner.trim_end().len())
        }
    };
    let end = start + length;
    if length == 0 || end > text.len() {
        return Err(Span { source, range: start..text.len() });
    }
    Ok(Key { name: name.into(), place: Place::new(source, start..end) })
}

fn parse_value(text: &str, at: usize, source: SourceId) -> Result<Node<'_>, Vec<Diagnostic>> {
    let rest = &text[at..];
    let start = at + (rest.len() - rest.trim_start().len());
    let word = text[start..].trim_end();
    let place = Place::new(source, start..start + word.len());
    let trimmed = &text[..place.end as usize];
    parse::value(trimmed, start, source).or_else(|errors| {
        let syntax = |c: char| matches!(c, '"' | '\'' | '[' | ']' | '{' | '}' | '=') || c.is_control();
        let bare = word.starts_with(|c: char| c.is_alphabetic() || matches!(c, '#' | '.' | '/' | '_'))
            && !word.contains(syntax);
        if bare { Ok(Node { place, value: Value::Text(word.into()) }) } else { Err(errors) }
    })
}

/// Puts a value where the keys lead, and makes the tables on the way.
fn put<'t>(root: &mut Node<'t>, keys: &[Key<'t>], value: Node<'t>) -> Result<(), Box<Diagnostic>> {
    let Some((last, way)) = keys.split_last() else { return Ok(()) };
    let mut node = root;
    for (depth, key) in way.iter().enumerate() {
        let place = path(&keys[..depth]);
        make_container(node, key);
        node = match &mut node.value {
            Value::List(items) => {
                let index = find(items, key, &place)?;
                &mut items[index]
            }
            Value::Table(entries) => {
                let index = match entries.iter().position(|(k, _)| k.name == key.name) {
                    Some(index) => index,
                    None if depth == 0 && matches!(&*key.name, "object" | "light") => {
                        let diagnostic = Diagnostic::error(format!("the scene has no {}s to set", key.name));
                        return Err(Box::new(diagnostic.at(key.place.span(), "there is none")));
                    }
                    None => {
                        let table = Node { place: key.place, value: Value::Table(Vec::new()) };
                        entries.push((key.clone(), table));
                        entries.len() - 1
                    }
                };
                &mut entries[index].1
            }
            _ => return Ok(()),
        };
    }
    make_container(node, last);
    match &mut node.value {
        Value::List(items) => {
            let index = find(items, last, &path(way))?;
            items[index] = value;
        }
        Value::Table(entries) => match entries.iter_mut().find(|(key, _)| key.name == last.name) {
            Some(entry) => *entry = (last.clone(), value),
            None => entries.push((last.clone(), value)),
        },
        _ => {}
    }
    Ok(())
}

/// Makes a table of a value that has no parts, such as a colour that becomes a texture.
fn make_container(node: &mut Node<'_>, key: &Key<'_>) {
    if !matches!(node.value, Value::List(_) | Value::Table(_)) {
        *node = Node { place: key.place, value: Value::Table(Vec::new()) };
    }
}

/// The item of a list that a key means: by index from 0, or by its `name`.
fn find(items: &[Node<'_>], key: &Key<'_>, place: &str) -> Result<usize, Box<Diagnostic>> {
    let names = || items.iter().map(|item| item.get("name").and_then(Node::text));
    if let Some(index) = names().position(|name| name == Some(&*key.name)) {
        return Ok(index);
    }
    if let Ok(index) = key.name.parse::<usize>()
        && index < items.len()
    {
        return Ok(index);
    }
    let diagnostic = Diagnostic::error(format!("`{place}` has nothing called {:?}", key.name))
        .at(key.place.span(), "neither an index nor a name in it");
    Err(Box::new(match (did_you_mean(&key.name, names().flatten()), items.len()) {
        (Some(name), _) => diagnostic.help(format!("did you mean {name:?}?")),
        (None, 0) => diagnostic.help("the list is empty"),
        (None, 1) => diagnostic.help("its only index is 0"),
        (None, count) => diagnostic.help(format!("its indices are 0 to {}", count - 1)),
    }))
}

fn path(keys: &[Key<'_>]) -> String {
    keys.iter().map(|key| key_text(&key.name)).collect::<Vec<_>>().join(".")
}

/// True where a key needs no quotes in TOML.
pub(in crate::document) fn is_bare(key: &str) -> bool {
    !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-'))
}

/// A key as TOML writes it.
pub(in crate::document) fn key_text(key: &str) -> String {
    if is_bare(key) { key.to_owned() } else { format!("{key:?}") }
}
