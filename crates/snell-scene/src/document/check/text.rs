//! Texts: words of a fixed choice, colours, and names of what the scene defines.

use super::super::color;
use super::super::schema::Part;
use super::super::tree::Node;
use super::rules::{FreeText, TextRule};
use super::{Checker, say};
use crate::diagnostic::{Diagnostic, did_you_mean};

/// How many names a message lists.
const MAX_LISTED: usize = 8;

impl<'a> Checker<'a, '_> {
    /// A text, in any of the forms that take one.
    pub(super) fn text(&mut self, node: &Node<'_>, text: &str, rule: &TextRule<'a>) -> bool {
        if rule.words.contains(&text) {
            return true;
        }
        match rule.free {
            None => self.unknown_word(node, text, rule.part, &rule.words),
            Some(FreeText::Color) => color::parse(text).is_some() || self.unknown_color(node, text),
            Some(FreeText::Name(table)) => self.name(node, text, table),
            Some(FreeText::Any) => true,
        }
    }

    fn unknown_word(&mut self, node: &Node<'_>, text: &str, part: Part<'a>, words: &[&str]) -> bool {
        if self.is_enough() {
            return false;
        }
        let message = format!("{} is {text:?}, but must be {}", self.place(), say::expected(part));
        let diagnostic = Diagnostic::error(message).at(node.place.span(), "not one of its words");
        self.tell(match say::nearest(text, words.iter().copied()) {
            Some(word) => diagnostic.help(format!("did you mean {word:?}?")),
            None => diagnostic,
        });
        false
    }

    fn unknown_color(&mut self, node: &Node<'_>, text: &str) -> bool {
        if self.is_enough() {
            return false;
        }
        let diagnostic = Diagnostic::error(format!("{}: there is no colour {text:?}", self.place()))
            .at(node.place.span(), "expected a colour");
        let help = if text.starts_with('#') {
            "write \"#rgb\" or \"#rrggbb\", with hexadecimal digits".to_owned()
        } else if self.names.has("texture", text) {
            format!("did you mean the texture, `{{ texture = {text:?} }}`?")
        } else if let Some(name) = did_you_mean(text, color::names()) {
            format!("did you mean {name:?}?")
        } else {
            "write a number, [r, g, b], \"#rrggbb\" or a CSS colour name".to_owned()
        };
        self.tell(diagnostic.help(help));
        false
    }

    fn name(&mut self, node: &Node<'_>, text: &str, table: &str) -> bool {
        if self.names.refer(table, text) {
            return true;
        }
        if self.is_enough() {
            return false;
        }
        let diagnostic =
            Diagnostic::error(format!("there is no {table} {text:?}")).at(node.place.span(), "not defined anywhere");
        let names: Vec<&str> = self.names.all(table).collect();
        let help = match say::nearest(text, names.iter().copied()) {
            Some(name) => format!("did you mean {name:?}?"),
            None if names.is_empty() => format!("define it as `[{table}.{}]`", super::super::overrides::key_text(text)),
            None => {
                let more = names.len().saturating_sub(MAX_LISTED);
                let rest = (more > 0).then(|| format!("{more} more"));
                let listed = names.iter().take(MAX_LISTED).map(|name| format!("{name:?}")).chain(rest);
                format!("there is {}", say::list(listed, "and"))
            }
        };
        self.tell(diagnostic.help(help));
        false
    }
}
