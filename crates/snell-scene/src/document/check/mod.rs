//! A scene's tree against the schema of the model: every mistake of form, each with its place and a suggestion.
//!
//! What is found wrong is taken out of the tree at the level of whole objects, lights, materials and sections, so that the
//! rest can still be examined for mistakes of meaning, and all are told at once.

mod names;
pub(super) mod number;
mod say;
mod table;
mod text;

use super::schema::Part;
use super::tree::{Node, Value};
use crate::diagnostic::{Diagnostic, Diagnostics, Span};
use names::Names;
pub(in crate::document) use say::expected;

/// How many mistakes of form are told one by one.
const MAX_TOLD: usize = 100;

/// Checks a whole file and takes out of its tree what is wrong.
pub(in crate::document) fn check(root: &mut Node, schema: &serde_json::Value, diagnostics: &mut Diagnostics) {
    let Some(part) = Part::root(schema) else { return };
    let mut checker = Checker { root: part, names: Names::of(root), path: Vec::new(), diagnostics, told: 0, untold: 0 };
    checker.duplicate_names(root);
    let keep = checker.file(root, part);
    if checker.untold > 0 {
        let more = checker.untold;
        checker.diagnostics.push(Diagnostic::error(format!("and {more} more mistakes of this kind")));
    }
    checker.names.tell_unused(checker.diagnostics);
    prune(root, keep);
}

/// What of an entry of the file is right.
enum Keep {
    Whole,
    Items(Vec<bool>),
    Nothing,
}

fn prune(root: &mut Node, keep: Vec<Keep>) {
    let Value::Table(entries) = &mut root.value else { return };
    let mut keep = keep.into_iter();
    entries.retain_mut(|(_, node)| match keep.next() {
        Some(Keep::Whole) => true,
        Some(Keep::Items(flags)) => {
            let mut flags = flags.into_iter();
            match &mut node.value {
                Value::List(items) => items.retain(|_| flags.next() == Some(true)),
                Value::Table(items) => items.retain(|_| flags.next() == Some(true)),
                _ => {}
            }
            true
        }
        Some(Keep::Nothing) | None => false,
    });
}

/// One step on the way to a value.
#[derive(Clone, Debug)]
enum Step {
    Key(String),
    Index(usize),
}

struct Checker<'a> {
    root: Part<'a>,
    names: Names,
    path: Vec<Step>,
    diagnostics: &'a mut Diagnostics,
    told: usize,
    untold: usize,
}

impl<'a> Checker<'a> {
    fn tell(&mut self, diagnostic: Diagnostic) {
        if !self.is_enough() {
            self.told += 1;
            self.diagnostics.push(diagnostic);
        }
    }

    /// True once enough has been told; what is found then is but counted.
    fn is_enough(&mut self) -> bool {
        let enough = self.told >= MAX_TOLD;
        self.untold += usize::from(enough);
        enough
    }

    /// The whole file: what of each of its entries is right.
    fn file(&mut self, root: &Node, part: Part<'a>) -> Vec<Keep> {
        let Value::Table(entries) = &root.value else { return Vec::new() };
        let mut keep = Vec::with_capacity(entries.len());
        for (key, node) in entries {
            let Some(property) = part.property(&key.name) else {
                self.unknown_key(key, part);
                keep.push(Keep::Nothing);
                continue;
            };
            self.path.push(Step::Key(key.name.clone()));
            keep.push(match (&node.value, property.items(), property.entries()) {
                (Value::List(items), Some(item), _) => {
                    Keep::Items(items.iter().enumerate().map(|(i, node)| self.item(i, node, item)).collect())
                }
                (Value::Table(items), _, Some(item)) => {
                    Keep::Items(items.iter().map(|(key, node)| self.entry(&key.name, node, item)).collect())
                }
                _ if self.value(node, property) => Keep::Whole,
                _ => Keep::Nothing,
            });
            self.path.pop();
        }
        keep
    }

    /// Any value; true where it is right.
    fn value(&mut self, node: &Node, part: Part<'a>) -> bool {
        let forms = part.forms();
        let form = forms.iter().copied().find(|form| takes(*form, &node.value));
        match (&node.value, form) {
            (Value::Integer(_) | Value::Float(_), Some(form)) => self.number(node, part, form),
            (Value::Text(text), Some(_)) => self.text(node, text, part, &forms),
            (Value::List(items), Some(form)) => self.list(node, items, form),
            (Value::Table(entries), Some(form)) => self.table(node, entries, form),
            (Value::Boolean(_), Some(_)) => true,
            _ => {
                self.wrong_type(node, part, &forms);
                false
            }
        }
    }

    fn wrong_type(&mut self, node: &Node, part: Part<'a>, forms: &[Part<'a>]) {
        if self.is_enough() {
            return;
        }
        let expected = expected(part);
        let message = format!("{} must be {}, but is {}", self.place(), say::kinds(part), node.called());
        let mut diagnostic = Diagnostic::error(message).at(node.span.clone(), format!("expected {expected}"));
        let wanted = |kind: &str| forms.iter().any(|form| form.kind() == Some(kind));
        if let Value::Text(text) = &node.value {
            if (wanted("number") || wanted("integer")) && text.trim().parse::<f64>().is_ok() {
                diagnostic = diagnostic.help("write the number without quotes");
            } else if wanted("boolean") && matches!(text.as_str(), "true" | "false") {
                diagnostic = diagnostic.help("write it without quotes");
            }
        } else if let Value::Table(_) = &node.value
            && wanted("array")
            && let Some(key) = self.section()
        {
            diagnostic = diagnostic.help(format!("write `[[{key}]]`, with two brackets"));
        }
        self.tell(diagnostic);
    }

    /// The way to the value now looked at, where it has one or two keys: what may be the name of a section.
    fn section(&self) -> Option<String> {
        match self.path.as_slice() {
            [Step::Key(key)] => Some(key.clone()),
            [Step::Key(outer), Step::Key(key)] | [Step::Key(outer), Step::Index(_), Step::Key(key)] => {
                Some(format!("{outer}.{key}"))
            }
            _ => None,
        }
    }

    fn list(&mut self, node: &Node, items: &[Node], form: Part<'a>) -> bool {
        let mut right = true;
        let count = items.len() as f64;
        let (min, max) = (form.number("minItems"), form.number("maxItems"));
        if min.is_some_and(|min| count < min) || max.is_some_and(|max| count > max) {
            let message = format!("{} must be {}, but has {}", self.place(), say::kinds(form), items.len());
            self.tell(Diagnostic::error(message).at(node.span.clone(), format!("expected {}", expected(form))));
            right = false;
        }
        if let Some(item) = form.items() {
            for (i, node) in items.iter().enumerate() {
                right &= self.item(i, node, item);
            }
        }
        right
    }

    fn item(&mut self, index: usize, node: &Node, part: Part<'a>) -> bool {
        self.path.push(match node.get("name").and_then(Node::text) {
            Some(name) => Step::Key(name.to_owned()),
            None => Step::Index(index),
        });
        let right = self.value(node, part);
        self.path.pop();
        right
    }

    fn entry(&mut self, key: &str, node: &Node, part: Part<'a>) -> bool {
        self.path.push(Step::Key(key.to_owned()));
        let right = self.value(node, part);
        self.path.pop();
        right
    }

    /// The value now looked at, as a message names it and as `--set` takes it.
    fn place(&self) -> String {
        if self.path.is_empty() {
            return "the scene".to_owned();
        }
        let steps: Vec<String> = self
            .path
            .iter()
            .map(|step| match step {
                Step::Index(index) => index.to_string(),
                Step::Key(key) if super::overrides::is_bare(key) => key.clone(),
                Step::Key(key) => format!("{key:?}"),
            })
            .collect();
        format!("`{}`", steps.join("."))
    }
}

/// True where a part of the schema takes values of this type.
fn takes(form: Part<'_>, value: &Value) -> bool {
    let Some(kind) = form.kind() else { return false };
    match value {
        Value::Boolean(_) => kind == "boolean",
        Value::Integer(_) | Value::Float(_) => kind == "number" || kind == "integer",
        Value::Text(_) => kind == "string",
        Value::List(_) => kind == "array",
        Value::Table(_) => kind == "object",
        Value::Other(_) => false,
    }
}

/// A diagnostic with a second place where there is one.
fn with_related(diagnostic: Diagnostic, span: Option<Span>, label: &str) -> Diagnostic {
    match span {
        Some(span) => diagnostic.related(span, label),
        None => diagnostic,
    }
}
