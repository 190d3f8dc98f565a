//! A scene's tree against the schema of the model: every mistake of form, each with its place and a suggestion.
//!
//! What is found wrong is taken out of the tree at the level of whole objects, lights, materials and sections, so that the
//! rest can still be examined for mistakes of meaning, and all are told at once.

mod names;
pub(super) mod number;
mod rules;
mod say;
mod table;
mod text;

use super::schema::{Part, RuleBook};
use super::tree::{Node, Value};
use crate::diagnostic::{Diagnostic, Diagnostics, Span};
use names::Names;
use rules::{Child, ListRule, Rule, Rules};
pub(in crate::document) use say::expected;

/// How many mistakes of form are told one by one.
const MAX_TOLD: usize = 100;

/// Checks a whole file and takes out of its tree what is wrong.
pub(in crate::document) fn check(root: &mut Node<'_>, rules: &RuleBook, diagnostics: &mut Diagnostics) {
    let Some(part) = Part::rules(rules) else { return };
    let mut checker = Checker::new(part, "the scene", root, diagnostics);
    checker.duplicate_names(root);
    let keep = checker.file(root, part);
    checker.tell_untold();
    checker.names.tell_unused(checker.diagnostics);
    prune(root, keep);
}

/// Checks a file that is one table of the schema, by its definition there; true where it is right.
pub(in crate::document) fn check_table(
    root: &Node<'_>,
    rules: &RuleBook,
    definition: &str,
    called: &'static str,
    diagnostics: &mut Diagnostics,
) -> bool {
    let Some(part) = Part::definition(rules, definition) else { return false };
    let mut checker = Checker::new(part, called, root, diagnostics);
    let rule = checker.rules.of(part);
    let right = checker.value(root, &rule);
    checker.tell_untold();
    right
}

/// What of an entry of the file is right.
enum Keep {
    Whole,
    Items(Vec<bool>),
    Nothing,
}

fn prune(root: &mut Node<'_>, keep: Vec<Keep>) {
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
#[derive(Clone, Copy, Debug)]
enum Step<'n> {
    Key(&'n str),
    Index(usize),
}

/// Checks the nodes of one tree (`'n`) against one schema (`'a`).
struct Checker<'a, 'n> {
    root: Part<'a>,
    /// What messages call the whole.
    called: &'static str,
    rules: Rules<'a>,
    names: Names,
    path: Vec<Step<'n>>,
    diagnostics: &'a mut Diagnostics,
    told: usize,
    untold: usize,
}

impl<'a, 'n> Checker<'a, 'n> {
    fn new(root: Part<'a>, called: &'static str, tree: &Node<'_>, diagnostics: &'a mut Diagnostics) -> Self {
        let (rules, names) = (Rules::default(), Names::of(tree));
        Self { root, called, rules, names, path: Vec::new(), diagnostics, told: 0, untold: 0 }
    }

    fn tell_untold(&mut self) {
        if self.untold > 0 {
            let more = self.untold;
            self.diagnostics.push(Diagnostic::error(format!("and {more} more mistakes of this kind")));
        }
    }

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
    fn file(&mut self, root: &'n Node<'_>, part: Part<'a>) -> Vec<Keep> {
        let Value::Table(entries) = &root.value else { return Vec::new() };
        let mut keep = Vec::with_capacity(entries.len());
        for (key, node) in entries {
            let Some(property) = part.property(&key.name) else {
                self.unknown_key(key, part);
                keep.push(Keep::Nothing);
                continue;
            };
            self.path.push(Step::Key(&key.name));
            keep.push(match (&node.value, property.items(), property.entries()) {
                (Value::List(items), Some(item), _) => {
                    let rule = self.rules.of(item);
                    Keep::Items(items.iter().enumerate().map(|(i, node)| self.item(i, node, &rule)).collect())
                }
                (Value::Table(items), _, Some(item)) => {
                    let rule = self.rules.of(item);
                    Keep::Items(items.iter().map(|(key, node)| self.entry(&key.name, node, &rule)).collect())
                }
                _ => {
                    let rule = self.rules.of(property);
                    if self.value(node, &rule) { Keep::Whole } else { Keep::Nothing }
                }
            });
            self.path.pop();
        }
        keep
    }

    /// Any value; true where it is right.
    fn value(&mut self, node: &'n Node<'_>, rule: &Rule<'a>) -> bool {
        match (&node.value, rule) {
            (Value::Integer(_) | Value::Float(_), Rule { number: Some(rule), .. }) => self.number(node, rule),
            (Value::Text(text), Rule { text: Some(rule), .. }) => self.text(node, text, rule),
            (Value::List(items), Rule { list: Some(rule), .. }) => self.list(node, items, rule),
            (Value::Table(entries), Rule { table: Some(rule), .. }) => self.table(node, entries, rule),
            (Value::Boolean(_), Rule { boolean: true, .. }) => true,
            _ => {
                self.wrong_type(node, rule.part, &rule.forms);
                false
            }
        }
    }

    /// A value within another.
    fn child(&mut self, node: &'n Node<'_>, child: &Child<'a>) -> bool {
        let rule = self.rules.of_child(child);
        self.value(node, &rule)
    }

    fn wrong_type(&mut self, node: &Node<'_>, part: Part<'a>, forms: &[Part<'a>]) {
        if self.is_enough() {
            return;
        }
        let expected = expected(part);
        let message = format!("{} must be {}, but is {}", self.place(), say::kinds(part), node.called());
        let mut diagnostic = Diagnostic::error(message).at(node.place.span(), format!("expected {expected}"));
        let wanted = |kind: &str| forms.iter().any(|form| form.kind() == Some(kind));
        if let Value::Text(text) = &node.value {
            if (wanted("number") || wanted("integer")) && text.trim().parse::<f64>().is_ok() {
                diagnostic = diagnostic.help("write the number without quotes");
            } else if wanted("boolean") && matches!(text.as_ref(), "true" | "false") {
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
            [Step::Key(key)] => Some((*key).to_owned()),
            [Step::Key(outer), Step::Key(key)] | [Step::Key(outer), Step::Index(_), Step::Key(key)] => {
                Some(format!("{outer}.{key}"))
            }
            _ => None,
        }
    }

    fn list(&mut self, node: &'n Node<'_>, items: &'n [Node<'_>], rule: &ListRule<'a>) -> bool {
        let mut right = true;
        let count = items.len() as f64;
        if rule.least.is_some_and(|least| count < least) || rule.most.is_some_and(|most| count > most) {
            let message = format!("{} must be {}, but has {}", self.place(), say::kinds(rule.form), items.len());
            let label = format!("expected {}", expected(rule.form));
            self.tell(Diagnostic::error(message).at(node.place.span(), label));
            right = false;
        }
        if let Some(item) = &rule.item {
            let rule = self.rules.of_child(item);
            for (i, node) in items.iter().enumerate() {
                right &= self.item(i, node, &rule);
            }
        }
        right
    }

    fn item(&mut self, index: usize, node: &'n Node<'_>, rule: &Rule<'a>) -> bool {
        self.path.push(match node.get("name").and_then(Node::text) {
            Some(name) => Step::Key(name),
            None => Step::Index(index),
        });
        let right = self.value(node, rule);
        self.path.pop();
        right
    }

    fn entry(&mut self, key: &'n str, node: &'n Node<'_>, rule: &Rule<'a>) -> bool {
        self.path.push(Step::Key(key));
        let right = self.value(node, rule);
        self.path.pop();
        right
    }

    /// The value now looked at, as a message names it and as `--set` takes it.
    fn place(&self) -> String {
        if self.path.is_empty() {
            return self.called.to_owned();
        }
        let steps: Vec<String> = self
            .path
            .iter()
            .map(|step| match step {
                Step::Index(index) => index.to_string(),
                Step::Key(key) if super::overrides::is_bare(key) => (*key).to_owned(),
                Step::Key(key) => format!("{key:?}"),
            })
            .collect();
        format!("`{}`", steps.join("."))
    }
}

/// A diagnostic with a second place where there is one.
fn with_related(diagnostic: Diagnostic, span: Option<Span>, label: &str) -> Diagnostic {
    match span {
        Some(span) => diagnostic.related(span, label),
        None => diagnostic,
    }
}
