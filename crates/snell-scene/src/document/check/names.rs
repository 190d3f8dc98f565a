//! The names that a scene defines and refers to: unknown ones, double ones, unused ones.

use super::super::tree::{Key, Node, Place, Value};
use super::Checker;
use crate::diagnostic::{Diagnostic, Diagnostics, Span};

/// The tables whose entries are referred to by name.
const TABLES: [&str; 3] = ["material", "texture", "prototype"];

/// A name that the scene defines.
struct Name {
    table: &'static str,
    name: String,
    span: Span,
    used: bool,
}

/// All names that the scene defines.
pub(super) struct Names(Vec<Name>);

impl Names {
    pub fn of(root: &Node<'_>) -> Self {
        let mut names = Vec::new();
        for table in TABLES {
            if let Some(Value::Table(entries)) = root.get(table).map(|node| &node.value) {
                let name = |key: &Key<'_>| Name {
                    table,
                    name: key.name.clone().into_owned(),
                    span: key.place.span(),
                    used: false,
                };
                names.extend(entries.iter().map(|(key, _)| name(key)));
            }
        }
        names.sort_by(|a, b| (a.table, &a.name).cmp(&(b.table, &b.name)));
        Self(names)
    }

    fn find(&self, table: &str, name: &str) -> Option<usize> {
        self.0.binary_search_by(|entry| (entry.table, &*entry.name).cmp(&(table, name))).ok()
    }

    pub fn has(&self, table: &str, name: &str) -> bool {
        self.find(table, name).is_some()
    }

    /// Marks a name as used; false where there is none.
    pub fn refer(&mut self, table: &str, name: &str) -> bool {
        let Some(index) = self.find(table, name) else { return false };
        self.0[index].used = true;
        true
    }

    pub fn all(&self, table: &str) -> impl Iterator<Item = &str> {
        self.0.iter().filter(move |entry| entry.table == table).map(|entry| &*entry.name)
    }

    pub fn tell_unused(&self, diagnostics: &mut Diagnostics) {
        // What a mistake left out may be what would have used them.
        if diagnostics.has_errors() {
            return;
        }
        let mut unused: Vec<&Name> = self.0.iter().filter(|entry| !entry.used).collect();
        unused.sort_by_key(|entry| (entry.span.source, entry.span.range.start));
        for entry in unused {
            let message = format!("the {} {:?} is not used", entry.table, entry.name);
            diagnostics.push(Diagnostic::warning(message).at(entry.span.clone(), "defined here"));
        }
    }
}

impl Checker<'_, '_> {
    /// Lights, objects and plots of the same name, which `--set` could not tell apart.
    pub(super) fn duplicate_names(&mut self, root: &Node<'_>) {
        for table in ["light", "object", "plot"] {
            let Some(Value::List(items)) = root.get(table).map(|node| &node.value) else { continue };
            let mut names: Vec<(&str, Place)> = items
                .iter()
                .filter_map(|item| item.get("name"))
                .filter_map(|node| Some((node.text()?, node.place)))
                .collect();
            names.sort_by_key(|(name, place)| (*name, place.start));
            for pair in names.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
                let message = format!("two {table}s have the name {:?}", pair[1].0);
                self.tell(
                    Diagnostic::error(message)
                        .at(pair[1].1.span(), "the same name again")
                        .related(pair[0].1.span(), "first defined here"),
                );
            }
        }
    }
}
