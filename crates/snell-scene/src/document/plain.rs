//! The plain part of TOML straight to a tree of values: what nearly all of a scene file is written in, above all by
//! programs, in one pass and without tokens.
//!
//! It gives the tree that the crate `toml` gives, or nothing: whatever is not plain (escapes, dotted keys outside of headers,
//! dates, keys in quotes) or not surely right is left to that crate, which then says what is wrong. After the TOML 1.1
//! specification (toml.io, 2025). Places are bytes of the text.

use std::borrow::Cow;

use super::tree::{Key, Node, Place, Value};
use crate::diagnostic::SourceId;
use crate::reader::text::{Decimal, digits};

/// Tables and lists within each other, from which on it is left to the other parser to say where they become too many.
const MAX_DEPTH: usize = 60;
/// Keys of a header; the same.
const MAX_PATH: usize = 8;
/// Keys of a table that are compared with each other; tables by headers, such as that of the materials, may have more.
const MAX_KEYS: usize = 32;
/// How many keys may be looked at on the way to all tables of headers.
const MAX_LOOKS: usize = 1 << 20;

/// The table that a whole file is; `None` where it is not plain.
pub(super) fn document(text: &str, source: SourceId) -> Option<Node<'_>> {
    let mut parser = Parser {
        text,
        bytes: text.as_bytes(),
        at: 0,
        source,
        depth: 0,
        looks: 0,
        items: Vec::new(),
        entries: Vec::new(),
    };
    let entries = parser.document()?;
    Some(Node { place: Place::new(source, 0..0), value: Value::Table(entries) })
}

type Entries<'t> = Vec<(Key<'t>, Node<'t>)>;

struct Parser<'t> {
    text: &'t str,
    bytes: &'t [u8],
    at: usize,
    source: SourceId,
    depth: usize,
    looks: usize,
    /// The items of all lists that are open, so that each becomes a list of just its length.
    items: Vec<Node<'t>>,
    /// The entries of all tables that are open.
    entries: Entries<'t>,
}

/// `[path.key]` or `[[path.key]]`.
struct Header<'t> {
    path: Vec<Key<'t>>,
    key: Key<'t>,
    place: Place,
    is_list: bool,
}

impl<'t> Parser<'t> {
    #[inline]
    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    #[inline]
    fn take(&mut self, byte: u8) -> bool {
        let is_there = self.peek() == Some(byte);
        self.at += usize::from(is_there);
        is_there
    }

    fn place(&self, start: usize) -> Place {
        Place::new(self.source, start..self.at)
    }

    /// Over blanks.
    #[inline]
    fn blanks(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\t')) {
            self.at += 1;
        }
    }

    /// Over the end of a line.
    #[inline]
    fn newline(&mut self) -> bool {
        let length = match self.bytes[self.at..] {
            [b'\n', ..] => 1,
            [b'\r', b'\n', ..] => 2,
            _ => 0,
        };
        self.at += length;
        length > 0
    }

    /// Over a comment, up to the end of its line.
    fn comment(&mut self) -> Option<()> {
        if self.take(b'#') {
            while let Some(byte) = self.peek() {
                match byte {
                    b'\n' | b'\r' => break,
                    _ if is_control(byte) => return None,
                    _ => self.at += 1,
                }
            }
        }
        Some(())
    }

    /// Over blanks, ends of lines and comments.
    #[inline]
    fn space(&mut self) -> Option<()> {
        loop {
            self.blanks();
            match self.peek() {
                Some(b'#') => self.comment()?,
                Some(b'\n' | b'\r') if self.newline() => {}
                _ => return Some(()),
            }
        }
    }

    /// Over what may follow at the end of a line, and that end.
    fn end_of_line(&mut self) -> Option<()> {
        self.blanks();
        self.comment()?;
        (self.at == self.bytes.len() || self.newline()).then_some(())
    }

    fn document(&mut self) -> Option<Entries<'t>> {
        let mut root = self.statements()?;
        let mut is_checked = true;
        while self.at < self.bytes.len() {
            let header = self.header()?;
            let value = Value::Table(self.statements()?);
            let table = Node { place: header.place, value };
            self.put(&mut root, header, table, &mut is_checked)?;
        }
        if !is_checked && !self.keys_differ(&root) {
            return None;
        }
        Some(root)
    }

    /// The lines `key = value` up to a header or to the end.
    fn statements(&mut self) -> Option<Entries<'t>> {
        let base = self.entries.len();
        loop {
            self.space()?;
            if matches!(self.peek(), None | Some(b'[')) {
                return Some(self.entries.split_off(base));
            }
            self.entry(base)?;
            self.end_of_line()?;
        }
    }

    /// `key = value`; the keys of the same table are those of the open entries from `base` on.
    #[inline]
    fn entry(&mut self, base: usize) -> Option<()> {
        let key = self.key()?;
        let others = &self.entries[base..];
        if others.len() >= MAX_KEYS || others.iter().any(|(other, _)| other.name == key.name) {
            return None;
        }
        self.blanks();
        if !self.take(b'=') {
            return None;
        }
        self.blanks();
        let value = self.value()?;
        self.entries.push((key, value));
        Some(())
    }

    /// A bare key.
    #[inline]
    fn key(&mut self) -> Option<Key<'t>> {
        let start = self.at;
        while self.peek().is_some_and(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'-')) {
            self.at += 1;
        }
        let name = Cow::Borrowed(&self.text[start..self.at]);
        (start < self.at).then_some(Key { name, place: self.place(start) })
    }

    fn value(&mut self) -> Option<Node<'t>> {
        let start = self.at;
        let value = match self.peek()? {
            b'{' => self.nested(Self::table)?,
            b'[' => self.nested(Self::list)?,
            quote @ (b'"' | b'\'') => self.string(quote)?,
            _ => self.word()?,
        };
        Some(Node { place: self.place(start), value })
    }

    fn nested(&mut self, parse: impl FnOnce(&mut Self) -> Option<Value<'t>>) -> Option<Value<'t>> {
        self.at += 1;
        self.depth += 1;
        let value = if self.depth <= MAX_DEPTH { parse(self) } else { None };
        self.depth -= 1;
        value
    }

    fn list(&mut self) -> Option<Value<'t>> {
        let base = self.items.len();
        loop {
            self.space()?;
            if self.take(b']') {
                break;
            }
            let item = self.value()?;
            self.items.push(item);
            self.space()?;
            if !self.take(b',') && self.peek() != Some(b']') {
                return None;
            }
        }
        Some(Value::List(self.items.split_off(base)))
    }

    fn table(&mut self) -> Option<Value<'t>> {
        let base = self.entries.len();
        loop {
            self.space()?;
            if self.take(b'}') {
                break;
            }
            self.entry(base)?;
            self.space()?;
            if !self.take(b',') && self.peek() != Some(b'}') {
                return None;
            }
        }
        Some(Value::Table(self.entries.split_off(base)))
    }

    /// A text on one line and without escapes.
    fn string(&mut self, quote: u8) -> Option<Value<'t>> {
        self.at += 1;
        let start = self.at;
        loop {
            let byte = self.peek()?;
            if byte == quote {
                break;
            }
            if is_control(byte) || (byte == b'\\' && quote == b'"') {
                return None;
            }
            self.at += 1;
        }
        let text = &self.text[start..self.at];
        self.at += 1;
        // Three quotes begin a text of several lines.
        let is_long = text.is_empty() && self.peek() == Some(quote);
        (!is_long).then_some(Value::Text(Cow::Borrowed(text)))
    }

    /// A decimal number, or `true` or `false`.
    #[inline]
    fn word(&mut self) -> Option<Value<'t>> {
        let rest = &self.text[self.at..];
        let (value, length) = if rest.starts_with("true") {
            (Value::Boolean(true), 4)
        } else if rest.starts_with("false") {
            (Value::Boolean(false), 5)
        } else {
            number(rest)?
        };
        self.at += length;
        // Whatever goes on here is another kind of value: a date, a number with underscores, or none at all.
        let ends = |byte| matches!(byte, b' ' | b'\t' | b'\n' | b'\r' | b',' | b']' | b'}' | b'#');
        self.peek().is_none_or(ends).then_some(value)
    }

    fn header(&mut self) -> Option<Header<'t>> {
        let start = self.at;
        self.at += 1;
        let is_list = self.take(b'[');
        let mut path = Vec::new();
        let key = loop {
            self.blanks();
            let key = self.key()?;
            self.blanks();
            if !self.take(b'.') {
                break key;
            }
            path.push(key);
        };
        let is_closed = self.take(b']') && (!is_list || self.take(b']'));
        if !is_closed || path.len() >= MAX_PATH {
            return None;
        }
        let place = self.place(start);
        self.end_of_line()?;
        Some(Header { path, key, place, is_list })
    }

    /// Puts a header's table where it belongs. Clears `is_checked` where it was not compared with all keys beside it.
    fn put(
        &mut self,
        root: &mut Entries<'t>,
        header: Header<'t>,
        table: Node<'t>,
        is_checked: &mut bool,
    ) -> Option<()> {
        let mut entries = root;
        for key in header.path {
            let place = key.place;
            let index = match self.find(entries, &key.name)? {
                Some(index) => index,
                None => {
                    entries.push((key, Node { place, value: Value::Table(Vec::new()) }));
                    entries.len() - 1
                }
            };
            entries = match &mut entries[index].1 {
                Node { place, value: Value::Table(inner) } if !self.is_inline(*place) => inner,
                Node { value: Value::List(items), .. } => match items.last_mut() {
                    Some(Node { place, value: Value::Table(inner) }) if !self.is_inline(*place) => inner,
                    _ => return None,
                },
                _ => return None,
            };
        }
        if header.is_list {
            match self.find(entries, &header.key.name)? {
                None => {
                    let list = Node { place: header.place, value: Value::List(vec![table]) };
                    entries.push((header.key, list));
                }
                Some(index) => match &mut entries[index].1.value {
                    Value::List(items) if items.last().is_some_and(|item| self.is_header(item)) => items.push(table),
                    _ => return None,
                },
            }
        } else {
            if entries.len() >= MAX_KEYS {
                *is_checked = false;
            } else if entries.iter().any(|(other, _)| other.name == header.key.name) {
                return None;
            }
            entries.push((header.key, table));
        }
        Some(())
    }

    /// The entry of a key, the last of them looked at first: headers that belong together stand together. `None` where
    /// looking has taken long enough.
    fn find(&mut self, entries: &Entries<'t>, name: &str) -> Option<Option<usize>> {
        let found = entries.iter().rposition(|(key, _)| key.name == name);
        self.looks += entries.len() - found.unwrap_or(0);
        (self.looks <= MAX_LOOKS).then_some(found)
    }

    /// True for a table in braces, to which headers may add nothing.
    fn is_inline(&self, place: Place) -> bool {
        self.bytes[place.start as usize] == b'{'
    }

    /// True for a table under a header.
    fn is_header(&self, node: &Node<'t>) -> bool {
        matches!(node.value, Value::Table(_)) && self.bytes[node.place.start as usize] == b'['
    }

    /// True where the keys of all tables by headers differ.
    fn keys_differ(&self, entries: &Entries<'t>) -> bool {
        let mut names: Vec<&str> = entries.iter().map(|(key, _)| &*key.name).collect();
        names.sort_unstable();
        names.windows(2).all(|pair| pair[0] != pair[1])
            && entries.iter().all(|(_, node)| match &node.value {
                Value::Table(inner) => self.is_inline(node.place) || self.keys_differ(inner),
                Value::List(items) => items.iter().filter(|item| self.is_header(item)).all(|item| match &item.value {
                    Value::Table(inner) => self.keys_differ(inner),
                    _ => true,
                }),
                _ => true,
            })
    }
}

/// What no comment and no text on one line may hold.
fn is_control(byte: u8) -> bool {
    (byte < 0x20 && byte != b'\t') || byte == 0x7f
}

/// The decimal number that a text begins with, and its length.
#[inline]
fn number(text: &str) -> Option<(Value<'static>, usize)> {
    let bytes = text.as_bytes();
    let mut decimal = Decimal { negative: bytes.first() == Some(&b'-'), ..Decimal::default() };
    let sign = usize::from(decimal.negative || bytes.first() == Some(&b'+'));
    let whole = digits(bytes, sign, &mut decimal.mantissa);
    if whole == 0 || (whole > 1 && bytes[sign] == b'0') {
        return None;
    }
    let mut end = sign + whole;
    decimal.digits = whole;
    let mut is_whole = true;
    if bytes.get(end) == Some(&b'.') {
        let fraction = digits(bytes, end + 1, &mut decimal.mantissa);
        if fraction == 0 {
            return None;
        }
        is_whole = false;
        end += 1 + fraction;
        decimal.digits += fraction;
        decimal.exponent = -(fraction as i32);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let minus = bytes.get(end + 1) == Some(&b'-');
        let first = end + 1 + usize::from(minus || bytes.get(end + 1) == Some(&b'+'));
        let mut power = 0;
        let length = digits(bytes, first, &mut power);
        if length == 0 || length > 4 {
            return None;
        }
        is_whole = false;
        end = first + length;
        decimal.exponent += if minus { -(power as i32) } else { power as i32 };
    }
    let value = match is_whole {
        true => Value::Integer(decimal.integer()?),
        false => Value::Float(decimal.float().or_else(|| text[..end].parse().ok())?),
    };
    Some((value, end))
}

#[cfg(test)]
#[path = "plain_tests.rs"]
mod tests;
