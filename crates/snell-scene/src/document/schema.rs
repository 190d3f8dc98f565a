//! The JSON Schema of the scene file, generated from the model, and the few words of it that the checks read.

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

/// A part of the schema, with the whole to look references up in.
#[derive(Clone, Copy)]
pub(in crate::document) struct Part<'a> {
    root: &'a Value,
    /// The part as it is written, before any reference is followed.
    pub written: &'a Map<String, Value>,
    /// The part with its reference followed.
    pub body: &'a Map<String, Value>,
}

impl<'a> Part<'a> {
    /// The whole schema.
    pub fn root(root: &'a Value) -> Option<Self> {
        Self::new(root, root)
    }

    fn new(root: &'a Value, written: &'a Value) -> Option<Self> {
        let written = written.as_object()?;
        let body = match written.get("$ref").and_then(Value::as_str) {
            Some("#") => root.as_object()?,
            Some(reference) => root.get("$defs")?.get(reference.strip_prefix("#/$defs/")?)?.as_object()?,
            None => written,
        };
        Some(Self { root, written, body })
    }

    /// Another part of the same schema.
    pub fn at(&self, written: &'a Value) -> Option<Self> {
        Self::new(self.root, written)
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
