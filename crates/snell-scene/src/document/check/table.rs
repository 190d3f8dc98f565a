//! Tables: unknown keys, missing keys, keys of which exactly or at most one may be there.

use super::super::schema::Part;
use super::super::tree::{Key, Node};
use super::rules::TableRule;
use super::{Checker, Step, say, with_related};
use crate::diagnostic::{Diagnostic, did_you_mean};

impl<'a, 'n> Checker<'a, 'n> {
    pub(super) fn table(&mut self, node: &Node<'_>, entries: &'n [(Key<'_>, Node<'_>)], rule: &TableRule<'a>) -> bool {
        let form = rule.form;
        let mut right = true;
        let mut guessed = Vec::new();
        // Those of which exactly one must be there.
        let mut choices = [None; 2];
        for (key, value) in entries {
            let property = rule.property(&key.name);
            if property.is_some_and(|property| property.is_choice) {
                let place = usize::from(choices[0].is_some());
                choices[place].get_or_insert(key);
            }
            if let Some(child) = property.map(|property| &property.child).or(rule.entries.as_ref()) {
                self.path.push(Step::Key(&key.name));
                right &= self.child(value, child);
                self.path.pop();
            } else {
                guessed.extend(self.unknown_key(key, form));
                right = false;
            }
        }
        let find = |name: &str| entries.iter().find(|(key, _)| key.name == name).map(|(key, _)| key);
        for name in &rule.required {
            if find(name).is_none() && !guessed.contains(name) {
                self.missing_key(node, name, form);
                right = false;
            }
        }
        let kinds = &rule.exactly_one;
        if let [Some(first), Some(second)] = choices {
            self.exclusive_keys(first, second);
            right = false;
        } else if choices[0].is_none() && !kinds.is_empty() && !guessed.iter().any(|guess| kinds.contains(guess)) {
            let choice = say::list(kinds.iter().map(|kind| format!("`{kind}`")), "or");
            let message = format!("{} needs one of the keys {choice}", self.place());
            self.tell(Diagnostic::error(message).at(node.place.span(), "has none of them"));
            right = false;
        }
        for set in &rule.at_most_one {
            let mut present = set.iter().filter_map(|name| find(name));
            if let (Some(first), Some(second)) = (present.next(), present.next()) {
                let (first, second) =
                    if first.place.start <= second.place.start { (first, second) } else { (second, first) };
                self.exclusive_keys(first, second);
                right = false;
            }
        }
        right
    }

    fn missing_key(&mut self, node: &Node<'_>, name: &str, form: Part<'a>) {
        let what = form.property(name).map_or_else(String::new, |part| format!(": {}", say::expected(part)));
        let message = format!("{} needs the key `{name}`", self.place());
        self.tell(Diagnostic::error(message).at(node.place.span(), format!("expected `{name}`{what}")));
    }

    fn exclusive_keys(&mut self, first: &Key<'_>, second: &Key<'_>) {
        let message = format!("{} has both `{}` and `{}`", self.place(), first.name, second.name);
        let diagnostic = Diagnostic::error(message).at(second.place.span(), "only one of the two is possible");
        self.tell(with_related(diagnostic, Some(first.place.span()), "the other is here"));
    }

    /// Tells of a key that is not there, and gives the key that was probably meant.
    pub(super) fn unknown_key(&mut self, key: &Key<'_>, form: Part<'a>) -> Option<&'a str> {
        if self.is_enough() {
            return None;
        }
        let place = self.place();
        let message = if self.path.is_empty() {
            // "The scene" is "a scene" there.
            format!("there is no key `{}` at the top of {}", key.name, self.called.replacen("the ", "a ", 1))
        } else {
            format!("there is no key `{}` in {place}", key.name)
        };
        let meant = say::nearest(&key.name, form.properties().map(|(name, _)| name));
        let help = match meant {
            Some(name) => format!("did you mean `{name}`?"),
            None => self.where_else(&key.name, form),
        };
        self.tell(Diagnostic::error(message).at(key.place.span(), "unknown key").help(help));
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
