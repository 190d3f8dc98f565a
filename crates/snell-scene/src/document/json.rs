//! JSON text (RFC 8259) to a [`Node`] tree with places, so that a scene that a program wrote has the same messages.
//!
//! serde_json gives no places of values, hence this small parser. It recurses, and refuses to go deeper than the limit.

use std::borrow::Cow;

use super::parse::MAX_NESTING;
use super::tree::{Key, Node, Place, Value};
use crate::diagnostic::{Diagnostic, Diagnostics, SourceId, Span};

/// The object that a whole file is; `None` where the syntax is wrong, which is then told.
pub(in crate::document) fn document<'t>(
    text: &'t str,
    source: SourceId,
    diagnostics: &mut Diagnostics,
) -> Option<Node<'t>> {
    let mut parser = Parser { text, at: 0, source };
    let parsed = parser.value(1).and_then(|node| {
        parser.space();
        if parser.at < text.len() { Err(parser.wrong("expected the end of the file", 1)) } else { Ok(node) }
    });
    match parsed {
        Ok(node) if matches!(node.value, Value::Table(_)) => Some(node),
        Ok(node) => {
            let called = node.called();
            diagnostics.push(Diagnostic::error(format!("a scene is a table, not {called}")).at(node.place.span(), ""));
            None
        }
        Err(diagnostic) => {
            diagnostics.push(*diagnostic);
            None
        }
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    source: SourceId,
}

type Parsed<T> = Result<T, Box<Diagnostic>>;

impl<'t> Parser<'t> {
    fn wrong(&self, expected: &str, length: usize) -> Box<Diagnostic> {
        let end = self.text.len().min(self.at + length);
        let range = self.at..self.text.ceil_char_boundary(end);
        let diagnostic = Diagnostic::error(format!("this is not JSON: {expected}"));
        Box::new(diagnostic.at(Span { source: self.source, range }, ""))
    }

    fn place(&self, start: usize) -> Place {
        Place::new(self.source, start..self.at)
    }

    fn rest(&self) -> &'t str {
        &self.text[self.at..]
    }

    fn space(&mut self) {
        let rest = self.rest();
        self.at += rest.len() - rest.trim_start_matches([' ', '\t', '\n', '\r']).len();
    }

    /// Goes on over white space and a character, if that is next.
    fn take(&mut self, character: char) -> bool {
        self.space();
        let taken = self.rest().starts_with(character);
        self.at += if taken { character.len_utf8() } else { 0 };
        taken
    }

    fn value(&mut self, depth: usize) -> Parsed<Node<'t>> {
        self.space();
        if depth > MAX_NESTING {
            return Err(self.wrong(&format!("tables and lists stand more than {MAX_NESTING} deep in each other"), 1));
        }
        let start = self.at;
        let value = match self.rest().chars().next() {
            Some('{') => self.table(depth)?,
            Some('[') => self.list(depth)?,
            Some('"') => Value::Text(self.string()?),
            Some('-' | '0'..='9') => self.number()?,
            _ => {
                let words =
                    [("true", Value::Boolean(true)), ("false", Value::Boolean(false)), ("null", Value::Other("null"))];
                let word = words.into_iter().find(|(word, _)| self.rest().starts_with(word));
                let Some((word, value)) = word else { return Err(self.wrong("expected a value", 1)) };
                self.at += word.len();
                value
            }
        };
        Ok(Node { place: self.place(start), value })
    }

    fn list(&mut self, depth: usize) -> Parsed<Value<'t>> {
        self.take('[');
        let mut items = Vec::new();
        if self.take(']') {
            return Ok(Value::List(items));
        }
        loop {
            items.push(self.value(depth + 1)?);
            if self.take(']') {
                return Ok(Value::List(items));
            }
            if !self.take(',') {
                return Err(self.wrong("expected `,` or `]`", 1));
            }
        }
    }

    fn table(&mut self, depth: usize) -> Parsed<Value<'t>> {
        self.take('{');
        let mut entries: Vec<(Key<'t>, Node<'t>)> = Vec::new();
        let mut names = std::collections::BTreeSet::new();
        if self.take('}') {
            return Ok(Value::Table(entries));
        }
        loop {
            self.space();
            let start = self.at;
            if !self.rest().starts_with('"') {
                return Err(self.wrong("expected a key in quotes", 1));
            }
            let key = Key { name: self.string()?, place: self.place(start) };
            if !names.insert(key.name.clone()) {
                let diagnostic = Diagnostic::error(format!("`{}` is defined twice", key.name));
                return Err(Box::new(diagnostic.at(key.place.span(), "")));
            }
            if !self.take(':') {
                return Err(self.wrong("expected `:`", 1));
            }
            let value = self.value(depth + 1)?;
            entries.push((key, value));
            if self.take('}') {
                return Ok(Value::Table(entries));
            }
            if !self.take(',') {
                return Err(self.wrong("expected `,` or `}`", 1));
            }
        }
    }

    /// A string, decoded by serde_json once its end is found.
    fn string(&mut self) -> Parsed<Cow<'t, str>> {
        let mut escaped = false;
        let end = self.rest().bytes().enumerate().skip(1).find_map(|(i, byte)| {
            let ends = byte == b'"' && !escaped;
            escaped = byte == b'\\' && !escaped;
            ends.then_some(i + 1)
        });
        let Some(end) = end else { return Err(self.wrong("the text is not closed", 1)) };
        let written = &self.rest()[..end];
        // Without escapes, the text is what stands in the file.
        let text = match serde_json::from_str::<&str>(written) {
            Ok(text) => Cow::Borrowed(text),
            Err(_) => match serde_json::from_str(written) {
                Ok(text) => Cow::Owned(text),
                Err(_) => return Err(self.wrong("the text is not well-formed", end)),
            },
        };
        self.at += end;
        Ok(text)
    }

    fn number(&mut self) -> Parsed<Value<'t>> {
        let rest = self.rest();
        let end = rest.find(|c: char| !matches!(c, '-' | '+' | '.' | 'e' | 'E' | '0'..='9')).unwrap_or(rest.len());
        let text = &rest[..end];
        let digits = text.trim_start_matches('-');
        let leading_zero = digits.len() > 1 && digits.starts_with('0') && digits.as_bytes()[1].is_ascii_digit();
        let value = match (text.parse::<i64>(), text.parse::<f64>()) {
            _ if leading_zero || text.ends_with('.') => None,
            (Ok(integer), _) => Some(Value::Integer(integer)),
            (_, Ok(number)) => Some(Value::Float(number)),
            _ => None,
        };
        let Some(value) = value else { return Err(self.wrong("the number is not well-formed", end)) };
        self.at += end;
        Ok(value)
    }
}
