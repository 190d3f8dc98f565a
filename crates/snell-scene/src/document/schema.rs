//! The JSON Schema of the scene file, generated from the model, and the few words of it that the checks read.
//!
//! To generate it takes two milliseconds, longer than reading most scenes and rendering small ones. So the checks read an
//! extract, `schema-rules.txt`: a definition a line, its name and its JSON without what only people read, and no line is
//! parsed before a scene has what it is about. A test keeps the extract current.

use std::cell::OnceCell;

use serde_json::{Map, Value};

use super::model::Document;

/// The JSON Schema (draft 2020-12) of a scene file, as TOML or JSON. It is what the reader checks a scene against, and what
/// `docs/scene.schema.json` gives to editors for completion, hover help and checks.
///
/// ```
/// let schema = snell_scene::document::schema();
/// let radius = &schema["$defs"]["Sphere"]["properties"]["radius"];
/// assert_eq!(radius["default"], 1.0);
/// assert_eq!(radius["x-unit"], "world units");
/// ```
pub fn schema() -> Value {
    let mut schema = schemars::schema_for!(Document).to_value();
    tidy(&mut schema);
    schema
}

/// Takes out what says that an optional key may be `null`: TOML has no such value, and a key that is not wanted is left out.
/// And joins the lines of descriptions, which are wrapped where the source code is.
fn tidy(schema: &mut Value) {
    match schema {
        Value::Array(items) => items.iter_mut().for_each(tidy),
        Value::Object(object) => {
            if object.get("default").is_some_and(Value::is_null) {
                object.shift_remove("default");
            }
            if let Some(Value::Array(types)) = object.get_mut("type") {
                types.retain(|name| name != "null");
                if let [only] = types.as_slice() {
                    let only = only.clone();
                    object.insert("type".to_owned(), only);
                }
            }
            if let Some(Value::Array(branches)) = object.get_mut("anyOf") {
                branches.retain(|branch| branch.get("type").is_none_or(|name| name != "null"));
                if let [Value::Object(only)] = branches.as_slice() {
                    let only = only.clone();
                    object.shift_remove("anyOf");
                    object.extend(only);
                }
            }
            if let Some(Value::String(description)) = object.get_mut("description") {
                *description = description.split_whitespace().collect::<Vec<_>>().join(" ");
            }
            object.values_mut().for_each(tidy);
        }
        _ => {}
    }
}

/// What only people read, and what the checks do without.
#[cfg(test)]
const FOR_PEOPLE: [&str; 5] = ["$schema", "title", "description", "default", "x-example"];

/// The name under which the extract has the schema's root.
const ROOT: &str = "#";

/// The extract of a schema: a line for the root, then one for each definition.
#[cfg(test)]
pub(in crate::document) fn extract(schema: &Value) -> String {
    fn without(schema: &Value) -> Value {
        match schema {
            Value::Array(items) => items.iter().map(without).collect(),
            Value::Object(object) => {
                let kept = object.iter().filter(|(word, _)| !FOR_PEOPLE.contains(&word.as_str()) && *word != "$defs");
                let entry = |(word, value): (&String, &Value)| match value {
                    // Under `properties` stand the author's keys, which may be called like words of the schema.
                    Value::Object(keys) if word == "properties" => {
                        (word.clone(), keys.iter().map(|(key, value)| (key.clone(), without(value))).collect())
                    }
                    _ => (word.clone(), without(value)),
                };
                kept.map(entry).collect()
            }
            _ => schema.clone(),
        }
    }
    let definitions = schema["$defs"].as_object().into_iter().flatten();
    let root = (ROOT, schema);
    std::iter::once(root)
        .chain(definitions.map(|(name, definition)| (name.as_str(), definition)))
        .map(|(name, definition)| format!("{name} {}\n", without(definition)))
        .collect()
}

/// The extract of the schema that the checks read, parsed as far as it was needed.
pub(in crate::document) struct RuleBook {
    definitions: Vec<(&'static str, &'static str, OnceCell<Option<Value>>)>,
}

impl RuleBook {
    /// The committed extract.
    pub fn new() -> Self {
        let lines = include_str!("schema-rules.txt").lines();
        let definition = |line: &'static str| line.split_once(' ').map(|(name, json)| (name, json, OnceCell::new()));
        Self { definitions: lines.filter_map(definition).collect() }
    }

    fn get(&self, name: &str) -> Option<&Value> {
        let (_, json, parsed) = self.definitions.iter().find(|(known, ..)| *known == name)?;
        parsed.get_or_init(|| serde_json::from_str(json).ok()).as_ref()
    }
}

/// What references are looked up in.
#[derive(Clone, Copy)]
enum Whole<'a> {
    Schema(&'a Value),
    Rules(&'a RuleBook),
}

impl<'a> Whole<'a> {
    fn root(self) -> Option<&'a Value> {
        match self {
            Self::Schema(root) => Some(root),
            Self::Rules(rules) => rules.get(ROOT),
        }
    }

    fn definition(self, name: &str) -> Option<&'a Value> {
        match self {
            Self::Schema(root) => root.get("$defs")?.get(name),
            Self::Rules(rules) => rules.get(name),
        }
    }
}

/// A part of the schema, with the whole to look references up in.
#[derive(Clone, Copy)]
pub(in crate::document) struct Part<'a> {
    whole: Whole<'a>,
    /// The part as it is written, before any reference is followed.
    pub written: &'a Map<String, Value>,
    /// The part with its reference followed.
    pub body: &'a Map<String, Value>,
}

impl<'a> Part<'a> {
    /// The whole schema.
    pub fn root(root: &'a Value) -> Option<Self> {
        Self::new(Whole::Schema(root), root)
    }

    /// The whole schema, by its extract for the checks.
    pub fn rules(rules: &'a RuleBook) -> Option<Self> {
        let whole = Whole::Rules(rules);
        Self::new(whole, whole.root()?)
    }

    /// A definition, by the extract for the checks.
    pub fn definition(rules: &'a RuleBook, name: &str) -> Option<Self> {
        Self::new(Whole::Rules(rules), rules.get(name)?)
    }

    fn new(whole: Whole<'a>, written: &'a Value) -> Option<Self> {
        let written = written.as_object()?;
        let body = match written.get("$ref").and_then(Value::as_str) {
            Some("#") => whole.root()?.as_object()?,
            Some(reference) => whole.definition(reference.strip_prefix("#/$defs/")?)?.as_object()?,
            None => written,
        };
        Some(Self { whole, written, body })
    }

    /// Another part of the same schema.
    pub fn at(&self, written: &'a Value) -> Option<Self> {
        Self::new(self.whole, written)
    }

    /// The name of the definition that this refers to.
    pub fn reference(&self) -> Option<&'a str> {
        self.written.get("$ref")?.as_str()?.strip_prefix("#/$defs/")
    }

    /// A word of this part: as written beside a reference, or else in what it refers to.
    pub fn word(&self, key: &str) -> Option<&'a Value> {
        self.written.get(key).or_else(|| self.body.get(key))
    }

    /// A word whose value is a text.
    pub fn text(&self, key: &str) -> Option<&'a str> {
        self.word(key)?.as_str()
    }

    /// A word whose value is a number.
    pub fn number(&self, key: &str) -> Option<f64> {
        self.word(key)?.as_f64()
    }

    /// The keys of a table and what they take.
    pub fn properties(&self) -> impl Iterator<Item = (&'a str, Part<'a>)> {
        let part = *self;
        let properties = self.body.get("properties").and_then(Value::as_object);
        properties.into_iter().flatten().filter_map(move |(key, schema)| Some((key.as_str(), part.at(schema)?)))
    }

    /// What a table takes under a key.
    pub fn property(&self, key: &str) -> Option<Part<'a>> {
        self.at(self.body.get("properties")?.get(key)?)
    }

    /// What a table takes under keys of the author's choice.
    pub fn entries(&self) -> Option<Part<'a>> {
        self.at(self.body.get("additionalProperties")?)
    }

    /// What a list's items are.
    pub fn items(&self) -> Option<Part<'a>> {
        self.at(self.body.get("items")?)
    }

    /// The keys that must be there.
    pub fn required(&self) -> Vec<&'a str> {
        texts(self.body.get("required"))
    }

    /// The keys of which exactly one must be there: a `oneOf` of nothing but single required keys.
    pub fn exactly_one(&self) -> Vec<&'a str> {
        let Some(Value::Array(branches)) = self.body.get("oneOf") else { return Vec::new() };
        branches.iter().flat_map(|branch| texts(branch.get("required"))).collect()
    }

    /// Sets of keys that exclude each other.
    pub fn at_most_one(&self) -> Vec<Vec<&'a str>> {
        let Some(Value::Array(sets)) = self.body.get("x-at-most-one") else { return Vec::new() };
        sets.iter().map(|set| texts(Some(set))).collect()
    }

    /// The type that this is, where it is just one.
    pub fn kind(&self) -> Option<&'a str> {
        self.body.get("type")?.as_str()
    }

    /// The words that a text may be, where it may not be any.
    pub fn words(&self) -> Vec<&'a str> {
        self.body.get("const").and_then(Value::as_str).into_iter().chain(texts(self.body.get("enum"))).collect()
    }

    /// The types that a value may be of, where there are several; else none.
    pub fn branches(&self) -> Vec<Part<'a>> {
        let branches = match (self.body.get("anyOf"), self.body.get("oneOf")) {
            (Some(Value::Array(branches)), _) => branches,
            (_, Some(Value::Array(branches))) if self.kind().is_none() => branches,
            _ => return Vec::new(),
        };
        branches.iter().filter_map(|branch| self.at(branch)).collect()
    }

    /// The ways in which a value of several forms may be written; just this part where there is one only.
    pub fn forms(&self) -> Vec<Part<'a>> {
        let branches = self.branches();
        if branches.is_empty() { vec![*self] } else { branches.iter().flat_map(Part::forms).collect() }
    }
}

fn texts(value: Option<&Value>) -> Vec<&str> {
    value.and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str).collect()
}
