//! What the checks ask of each part of the schema, looked up once: a scene has a hundred thousand values but only some
//! hundred kinds of them, and to look words up in the JSON of the schema for each value takes longer than all else.

use std::cell::Cell;
use std::collections::HashMap;
use std::rc::Rc;

use super::super::schema::Part;
use super::number::Range;

/// What a part of the schema takes, by the type of the value: each time the first of its forms of that type.
pub(super) struct Rule<'a> {
    pub part: Part<'a>,
    /// All forms of the part, for messages.
    pub forms: Vec<Part<'a>>,
    pub boolean: bool,
    pub number: Option<NumberRule<'a>>,
    pub text: Option<TextRule<'a>>,
    pub list: Option<ListRule<'a>>,
    pub table: Option<TableRule<'a>>,
}

/// What is asked of a number.
pub(super) struct NumberRule<'a> {
    pub part: Part<'a>,
    pub form: Part<'a>,
    pub range: Range,
    pub whole: bool,
}

/// What is asked of a text.
pub(super) struct TextRule<'a> {
    pub part: Part<'a>,
    /// The words of all forms that take only certain ones.
    pub words: Vec<&'a str>,
    pub free: Option<FreeText<'a>>,
}

/// A text that is not one of a few words.
pub(super) enum FreeText<'a> {
    Color,
    /// A name of this table.
    Name(&'a str),
    Any,
}

/// What is asked of a list.
pub(super) struct ListRule<'a> {
    pub form: Part<'a>,
    pub least: Option<f64>,
    pub most: Option<f64>,
    pub item: Option<Child<'a>>,
}

/// What is asked of a table.
pub(super) struct TableRule<'a> {
    pub form: Part<'a>,
    pub properties: Vec<Property<'a>>,
    /// What stands under keys of the author's choice.
    pub entries: Option<Child<'a>>,
    pub required: Vec<&'a str>,
    /// Keys of which exactly one must be there.
    pub exactly_one: Vec<&'a str>,
    pub at_most_one: Vec<Vec<&'a str>>,
}

/// A key of a table and what stands there.
pub(super) struct Property<'a> {
    pub name: &'a str,
    pub child: Child<'a>,
    /// It is among those of which exactly one must be there.
    pub is_choice: bool,
}

/// A part within another, and its rule once that is known.
pub(super) struct Child<'a> {
    part: Part<'a>,
    rule: Cell<Option<u32>>,
}

/// All rules that were needed so far.
#[derive(Default)]
pub(super) struct Rules<'a> {
    rules: Vec<Rc<Rule<'a>>>,
    /// By the address of the part as it is written.
    numbers: HashMap<usize, u32>,
}

impl<'a> Rules<'a> {
    /// The rule of a part.
    pub fn of(&mut self, part: Part<'a>) -> Rc<Rule<'a>> {
        let number = self.number(part);
        Rc::clone(&self.rules[number as usize])
    }

    /// The rule of a part within another.
    pub fn of_child(&mut self, child: &Child<'a>) -> Rc<Rule<'a>> {
        let number = child.rule.get().unwrap_or_else(|| self.number(child.part));
        child.rule.set(Some(number));
        Rc::clone(&self.rules[number as usize])
    }

    fn number(&mut self, part: Part<'a>) -> u32 {
        *self.numbers.entry(std::ptr::from_ref(part.written).addr()).or_insert_with(|| {
            self.rules.push(Rc::new(Rule::new(part)));
            self.rules.len() as u32 - 1
        })
    }
}

impl<'a> Child<'a> {
    fn new(part: Part<'a>) -> Self {
        Self { part, rule: Cell::new(None) }
    }
}

impl<'a> Rule<'a> {
    fn new(part: Part<'a>) -> Self {
        let forms = part.forms();
        let first = |kinds: &[&str]| forms.iter().copied().find(|form| form.kind().is_some_and(|k| kinds.contains(&k)));
        Self {
            part,
            boolean: first(&["boolean"]).is_some(),
            number: first(&["number", "integer"]).map(|form| NumberRule {
                part,
                form,
                range: Range::of(part, form),
                whole: form.kind() == Some("integer"),
            }),
            text: first(&["string"]).map(|_| TextRule::new(part, &forms)),
            list: first(&["array"]).map(|form| ListRule {
                form,
                least: form.number("minItems"),
                most: form.number("maxItems"),
                item: form.items().map(Child::new),
            }),
            table: first(&["object"]).map(TableRule::new),
            forms,
        }
    }
}

impl<'a> TextRule<'a> {
    fn new(part: Part<'a>, forms: &[Part<'a>]) -> Self {
        let forms = || forms.iter().filter(|form| form.kind() == Some("string"));
        let free = forms().find(|form| form.words().is_empty()).map(|form| {
            if form.text("format") == Some("color") {
                FreeText::Color
            } else {
                form.text("x-names").map_or(FreeText::Any, FreeText::Name)
            }
        });
        Self { part, words: forms().flat_map(Part::words).collect(), free }
    }
}

impl<'a> TableRule<'a> {
    fn new(form: Part<'a>) -> Self {
        let exactly_one = form.exactly_one();
        let property =
            |(name, part)| Property { name, child: Child::new(part), is_choice: exactly_one.contains(&name) };
        Self {
            form,
            properties: form.properties().map(property).collect(),
            entries: form.entries().map(Child::new),
            required: form.required(),
            at_most_one: form.at_most_one(),
            exactly_one,
        }
    }

    /// The key and what stands there.
    pub fn property(&self, name: &str) -> Option<&Property<'a>> {
        self.properties.iter().find(|property| property.name == name)
    }
}
