//! Texts: words of a fixed choice, colours, and names of what the scene defines.

use super::super::color;
use super::super::schema::Part;
use super::super::tree::Node;
use super::{Checker, say};
use crate::diagnostic::{Diagnostic, did_you_mean};

impl<'a> Checker<'a> {
    /// A text, in any of the forms that take one.
    pub(super) fn text(&mut self, node: &Node, text: &str, part: Part<'a>, forms: &[Part<'a>]) -> bool {
        let forms: Vec<Part<'a>> = forms.iter().copied().filter(|form| form.kind() == Some("string")).collect();
        let words: Vec<&str> = forms.iter().flat_map(Part::words).collect();
        if words.contains(&text) {
            return true;
        }
        let Some(free) = forms.iter().find(|form| form.words().is_empty()) else {
            return self.unknown_word(node, text, part, &words);
        };
        if free.text("format") == Some("color") {
            return color::parse(text).is_some() || self.unknown_color(node, text);
        }
        match free.text("x-names") {
            Some(table) => self.name(node, text, table),
            None => true,
        }
    }

    fn unknown_word(&mut self, node: &Node, text: &str, part: Part<'a>, words: &[&str]) -> bool {
        let message = format!("{} is {text:?}, but must be {}", self.place(), say::expected(part));
        let diagnostic = Diagnostic::error(message).at(node.span.clone(), "not one of its words");
        self.tell(match say::nearest(text, words.iter().copied()) {
            Some(word) => diagnostic.help(format!("did you mean {word:?}?")),
            None => diagnostic,
        });
        false
    }

    fn unknown_color(&mut self, node: &Node, text: &str) -> bool {
        let diagnostic = Diagnostic::error(format!("{}: there is no colour {text:?}", self.place()))
            .at(node.span.clone(), "expected a colour");
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

    fn name(&mut self, node: &Node, text: &str, table: &str) -> bool {
        if self.names.refer(table, text) {
            return true;
        }
        let diagnostic =
            Diagnostic::error(format!("there is no {table} {text:?}")).at(node.span.clone(), "not defined anywhere");
        let names: Vec<&str> = self.names.all(table).collect();
        let help = match say::nearest(text, names.iter().copied()) {
            Some(name) => format!("did you mean {name:?}?"),
            None if names.is_empty() => format!("define it as `[{table}.{}]`", super::super::overrides::key_text(text)),
            None => format!("there is {}", say::list(names.iter().map(|name| format!("{name:?}")), "and")),
        };
        self.tell(diagnostic.help(help));
        false
    }
}
