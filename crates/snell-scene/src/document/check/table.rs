//! Tables: unknown keys, missing keys, keys of which exactly or at most one may be there.

use super::super::schema::Part;
use super::super::tree::{Key, Node};
use super::{Checker, say, with_related};
use crate::diagnostic::{Diagnostic, did_you_mean};

impl<'a> Checker<'a> {
    pub(super) fn table(&mut self, node: &Node, entries: &[(Key, Node)], form: Part<'a>) -> bool {
        let mut right = true;
        let mut guessed = Vec::new();
        for (key, value) in entries {
            if let Some(property) = form.property(&key.name) {
                right &= self.entry(&key.name, value, property);
            } else if let Some(entry) = form.entries() {
                right &= self.entry(&key.name, value, entry);
            } else {
                guessed.extend(self.unknown_key(key, form));
                right = false;
            }
        }
        let find = |name: &str| entries.iter().find(|(key, _)| key.name == name).map(|(key, _)| key);
        for name in form.required() {
            if find(name).is_none() && !guessed.contains(&name) {
                self.missing_key(node, name, form);
                right = false;
            }
        }
        let kinds = form.exactly_one();
        let present: Vec<&Key> = entries.iter().map(|(key, _)| key).filter(|key| kinds.contains(&&*key.name)).collect();
        if let [first, second, ..] = present.as_slice() {
            self.exclusive_keys(first, second);
            right = false;
        } else if present.is_empty() && !kinds.is_empty() && !guessed.iter().any(|guess| kinds.contains(guess)) {
            let choice = say::list(kinds.iter().map(|kind| format!("`{kind}`")), "or");
            let message = format!("{} needs one of the keys {choice}", self.place());
            self.tell(Diagnostic::error(message).at(node.span.clone(), "has none of them"));
            right = false;
        }
        for set in form.at_most_one() {
            let present: Vec<&Key> = set.iter().filter_map(|name| find(name)).collect();
            if let [first, second, ..] = present.as_slice() {
                let (first, second) =
                    if first.span.range.start <= second.span.range.start { (first, second) } else { (second, first) };
                self.exclusive_keys(first, second);
                right = false;
            }
        }
        right
    }

    fn missing_key(&mut self, node: &Node, name: &str, form: Part<'a>) {
        let what = form.property(name).map_or_else(String::new, |part| format!(": {}", say::expected(part)));
        let message = format!("{} needs the key `{name}`", self.place());
        self.tell(Diagnostic::error(message).at(node.span.clone(), format!("expected `{name}`{what}")));
    }

    fn exclusive_keys(&mut self, first: &Key, second: &Key) {
        let message = format!("{} has both `{}` and `{}`", self.place(), first.name, second.name);
        let diagnostic = Diagnostic::error(message).at(second.span.clone(), "only one of the two is possible");
        self.tell(with_related(diagnostic, Some(first.span.clone()), "the other is here"));
    }

    /// Tells of a key that is not there, and gives the key that was probably meant.
    pub(super) fn unknown_key(&mut self, key: &Key, form: Part<'a>) -> Option<&'a str> {
        let place = self.place();
        let message = if self.path.is_empty() {
            format!("there is no key `{}` at the top of a scene", key.name)
        } else {
            format!("there is no key `{}` in {place}", key.name)
        };
        let meant = say::nearest(&key.name, form.properties().map(|(name, _)| name));
        let help = match meant {
            Some(name) => format!("did you mean `{name}`?"),
            None => self.where_else(&key.name, form),
        };
        self.tell(Diagnostic::error(message).at(key.span.clone(), "unknown key").help(help));
        meant
    }

    /// Advice on a key that is like none of the table's: where there is such a key, or which there are.
    fn where_else(&self, key: &str, form: Part<'a>) -> String {
        let within = |part: Part<'a>| -> Vec<&'a str> {
            let has = |part: &Part<'a>| part.forms().iter().any(|form| form.property(key).is_some());
            part.properties().filter(|(_, property)| has(property)).map(|(name, _)| name).collect()
        };
        let children = within(form);
        if !children.is_empty() && children.len() <= 6 {
            return format!(
                "`{key}` is a key of {}",
                say::list(children.iter().map(|name| format!("`{name}`")), "and")
            );
        }
        if !self.path.is_empty() {
            if self.root.property(key).is_some() {
                return format!("`{key}` belongs to the top of the file, before the first `[table]` or as its own");
            }
            if let Some(section) = within(self.root).first() {
                return format!("`{key}` is a key of `{section}`");
            }
        }
        let keys: Vec<&str> = form.properties().map(|(name, _)| name).filter(|name| !name.starts_with('$')).collect();
        if let Some(near) = did_you_mean(key, keys.iter().copied()) {
            return format!("did you mean `{near}`?");
        }
        format!("its keys are {}", say::list(keys.iter().map(|name| format!("`{name}`")), "and"))
    }
}
