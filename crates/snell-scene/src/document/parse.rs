//! TOML 1.1 text to a [`Node`] tree, with all syntax errors at once.
//!
//! The parser recurses with the nesting of the text, so nesting is measured on its tokens first and what is too deep is
//! refused before anything recurses.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};
use toml_parser::lexer::TokenKind;

use super::plain;
use super::tree::{Key, Node, Place, Value};
use crate::diagnostic::{Diagnostic, Diagnostics, SourceId, Span};

/// How many tables and lists may stand within each other: enough for a hundred nested solids, and little enough for the
/// smallest stacks that threads have.
pub(in crate::document) const MAX_NESTING: usize = 210;

/// The table that a whole file is; `None` where the syntax is wrong, which is then told.
pub(in crate::document) fn document<'t>(
    text: &'t str,
    source: SourceId,
    diagnostics: &mut Diagnostics,
) -> Option<Node<'t>> {
    plain::document(text, source).or_else(|| by_toml(text, source, diagnostics))
}

/// The same by the crate `toml`, which knows all of the language and every mistake.
pub(super) fn by_toml<'t>(text: &'t str, source: SourceId, diagnostics: &mut Diagnostics) -> Option<Node<'t>> {
    if let Some(range) = too_deep(text) {
        diagnostics.push(nesting_error(Span { source, range }));
        return None;
    }
    let (table, errors) = DeTable::parse_recoverable(text);
    if errors.is_empty() {
        let mut builder = Builder { source, too_deep: None };
        let value = builder.table(table.into_inner(), 1);
        if let Some(span) = builder.too_deep {
            diagnostics.push(nesting_error(span));
            return None;
        }
        return Some(Node { place: Place::new(source, 0..0), value });
    }
    report(errors, text, source, 0, diagnostics);
    None
}

/// A single value that stands in `text` from `offset` on, for `--set`; or the syntax errors.
pub(in crate::document) fn value(text: &str, offset: usize, source: SourceId) -> Result<Node<'_>, Vec<Diagnostic>> {
    let rest = &text[offset..];
    if let Some(range) = too_deep(rest) {
        return Err(vec![nesting_error(Span { source, range: range.start + offset..range.end + offset })]);
    }
    match DeValue::parse(rest) {
        Ok(value) => Ok(shifted(Builder { source, too_deep: None }.node(value, 1), offset)),
        Err(error) => {
            let mut found = Diagnostics::default();
            report(vec![error], text, source, offset, &mut found);
            Err(found.list)
        }
    }
}

fn nesting_error(span: Span) -> Diagnostic {
    Diagnostic::error(format!("tables and lists stand more than {MAX_NESTING} deep within each other"))
        .at(span, "too deep from here on")
        .help("define the inner parts as `[prototype.NAME]` and place them with `instance`")
}

fn report(errors: Vec<toml::de::Error>, text: &str, source: SourceId, offset: usize, diagnostics: &mut Diagnostics) {
    let mut errors: Vec<(Range<usize>, String)> = errors
        .into_iter()
        .map(|error| {
            let range = error.span().unwrap_or(0..0);
            (range.start + offset..range.end + offset, error.message().to_owned())
        })
        .collect();
    errors.sort_by_key(|(range, _)| range.start);
    // What follows on the same line follows from the first mistake.
    let line = |range: &Range<usize>| text[..text.floor_char_boundary(range.start)].rfind('\n');
    errors.dedup_by(|later, first| line(&later.0) == line(&first.0));
    for (range, message) in errors {
        let mut diagnostic = Diagnostic::error(format!("this is not TOML: {message}"));
        if message.starts_with("duplicate key")
            && let Some(key) = text.get(range.clone())
        {
            diagnostic.message = format!("`{key}` is defined twice");
        }
        let word = text.get(range.clone()).unwrap_or_default();
        let is_word = word.starts_with(|c: char| c.is_alphabetic()) && !word.contains(['"', '\'', '=', '\n']);
        if is_word && (message.starts_with("invalid") || message.starts_with("string values")) {
            diagnostic = diagnostic.help(format!("a text stands in quotes: \"{word}\""));
        }
        diagnostics.push(diagnostic.at(Span { source, range }, ""));
    }
}

/// The place from which on the nesting of brackets, braces and dotted keys is too deep.
fn too_deep(text: &str) -> Option<Range<usize>> {
    // For each open bracket, how many levels it and the dots of the key before it added.
    let mut open: Vec<usize> = Vec::new();
    let mut depth = 0;
    let mut dots = 0;
    for token in toml_parser::Source::new(text).lex() {
        match token.kind() {
            TokenKind::Dot => dots += 1,
            TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket => {
                open.push(dots + 1);
                depth += dots + 1;
                dots = 0;
            }
            TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket => {
                depth -= open.pop().unwrap_or(0);
                dots = 0;
            }
            TokenKind::Comma => dots = 0,
            // What a header adds to the tables below it is seen when the tree is built.
            TokenKind::Newline => dots = 0,
            _ => {}
        }
        if depth + dots > MAX_NESTING {
            return Some(token.span().start()..token.span().end());
        }
    }
    None
}

fn shifted(mut node: Node<'_>, offset: usize) -> Node<'_> {
    let shift = |place: Place| Place::new(place.source, place.start as usize + offset..place.end as usize + offset);
    node.place = shift(node.place);
    node.value = match node.value {
        Value::List(items) => Value::List(items.into_iter().map(|item| shifted(item, offset)).collect()),
        Value::Table(entries) => Value::Table(
            entries
                .into_iter()
                .map(|(key, item)| (Key { place: shift(key.place), ..key }, shifted(item, offset)))
                .collect(),
        ),
        scalar => scalar,
    };
    node
}

/// Builds the tree of one source.
struct Builder {
    source: SourceId,
    /// The first place that is too deep, which dotted headers can still bring about.
    too_deep: Option<Span>,
}

impl Builder {
    fn node<'t>(&mut self, value: Spanned<DeValue<'t>>, depth: usize) -> Node<'t> {
        let place = Place::new(self.source, value.span());
        if depth > MAX_NESTING {
            self.too_deep.get_or_insert(place.span());
            return Node { place, value: Value::Other("a value that is nested too deeply") };
        }
        let value = match value.into_inner() {
            DeValue::String(text) => Value::Text(text),
            DeValue::Integer(number) => match i64::from_str_radix(number.as_str(), number.radix()) {
                Ok(integer) => Value::Integer(integer),
                Err(_) => Value::Float(number.as_str().parse().unwrap_or(f64::INFINITY)),
            },
            DeValue::Float(number) => Value::Float(number.as_str().parse().unwrap_or(f64::NAN)),
            DeValue::Boolean(truth) => Value::Boolean(truth),
            DeValue::Datetime(_) => Value::Other("a date"),
            DeValue::Array(items) => Value::List(items.into_iter().map(|item| self.node(item, depth + 1)).collect()),
            DeValue::Table(table) => self.table(table, depth + 1),
        };
        Node { place, value }
    }

    fn table<'t>(&mut self, table: DeTable<'t>, depth: usize) -> Value<'t> {
        let mut entries: Vec<(Key<'t>, Node<'t>)> = table
            .into_iter()
            .map(|(key, value)| {
                let place = Place::new(self.source, key.span());
                (Key { name: key.into_inner(), place }, self.node(value, depth))
            })
            .collect();
        // The parser keeps them sorted by name; the author's order makes for messages in the order of the file.
        entries.sort_by_key(|(key, _)| key.place.start);
        Value::Table(entries)
    }
}
