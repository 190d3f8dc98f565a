//! A scene file as a tree of values, each with its place: what TOML, JSON and `--set` are parsed into, and what the checks
//! and the deserializer read.
//!
//! A scene that a program wrote has hundreds of thousands of values, so the tree is frugal: places are three small numbers,
//! and texts without escapes are borrowed from the file.

use std::borrow::Cow;
use std::ops::Range;

use crate::diagnostic::{SourceId, Span};

/// A value and where it is said.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::document) struct Node<'t> {
    /// Where: the whole value, or for a table under a header, the header.
    pub place: Place,
    /// What.
    pub value: Value<'t>,
}

/// A stretch of one source, in half the bytes of a [`Span`]: texts of more than [`Place::LONGEST`] bytes are refused before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::document) struct Place {
    pub source: SourceId,
    pub start: u32,
    pub end: u32,
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::document) enum Value<'t> {
    /// `true` or `false`.
    Boolean(bool),
    /// A whole number.
    Integer(i64),
    /// Any other number, NaN and infinity too.
    Float(f64),
    /// A text.
    Text(Cow<'t, str>),
    /// A date or time, or JSON's `null`: nothing that a scene takes. Its name, for messages.
    Other(&'static str),
    /// A list.
    List(Vec<Node<'t>>),
    /// A table, in the order of the file; keys are unique.
    Table(Vec<(Key<'t>, Node<'t>)>),
}

/// A key of a table.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::document) struct Key<'t> {
    /// The key.
    pub name: Cow<'t, str>,
    /// Where.
    pub place: Place,
}

impl Place {
    /// The longest text whose places can be said; bytes.
    pub const LONGEST: usize = u32::MAX as usize;

    /// A stretch of a source of at most [`Place::LONGEST`] bytes.
    pub fn new(source: SourceId, range: Range<usize>) -> Self {
        Self { source, start: range.start as u32, end: range.end as u32 }
    }

    /// As diagnostics take it.
    pub fn span(self) -> Span {
        Span { source: self.source, range: self.start as usize..self.end as usize }
    }
}

impl Node<'_> {
    /// What messages call this kind of value.
    pub fn called(&self) -> &'static str {
        match &self.value {
            Value::Boolean(_) => "a truth value",
            Value::Integer(_) => "a whole number",
            Value::Float(_) => "a number",
            Value::Text(_) => "a text",
            Value::Other(name) => name,
            Value::List(_) => "a list",
            Value::Table(_) => "a table",
        }
    }

    /// The entry under a key, where this is a table that has it.
    pub fn get(&self, key: &str) -> Option<&Self> {
        match &self.value {
            Value::Table(entries) => entries.iter().find(|(k, _)| k.name == key).map(|(_, node)| node),
            _ => None,
        }
    }

    /// The text, where this is one.
    pub fn text(&self) -> Option<&str> {
        match &self.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The number, where this is one.
    pub fn number(&self) -> Option<f64> {
        match self.value {
            Value::Integer(number) => Some(number as f64),
            Value::Float(number) => Some(number),
            _ => None,
        }
    }

    /// How many tables and lists stand within each other, this one counted.
    pub fn depth(&self) -> usize {
        let below = match &self.value {
            Value::List(items) => items.iter().map(Self::depth).max(),
            Value::Table(entries) => entries.iter().map(|(_, node)| node.depth()).max(),
            _ => return 0,
        };
        1 + below.unwrap_or(0)
    }
}
