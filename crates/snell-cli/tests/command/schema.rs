//! Whether a JSON value is what a JSON Schema says, for the words of draft 2020-12 that our schemas use. A word that is not known
//! here is a failure, so that nothing goes unchecked.

use serde_json::Value;

/// What is wrong with a value, with its place; nothing where all is well.
pub fn problems(schema: &Value, value: &Value) -> Vec<String> {
    let mut list = Vec::new();
    check(schema, schema, value, "$", &mut list);
    list
}

fn check(root: &Value, schema: &Value, value: &Value, place: &str, list: &mut Vec<String>) {
    let words = schema.as_object().unwrap();
    for (word, rule) in words {
        match word.as_str() {
            "$schema" | "title" | "description" | "$defs" => {}
            "$ref" => {
                let pointer = rule.as_str().unwrap().strip_prefix('#').unwrap();
                let part = root.pointer(pointer).unwrap_or_else(|| panic!("no {pointer}"));
                check(root, part, value, place, list);
            }
            "type" => {
                let names: Vec<&str> = match rule {
                    Value::Array(names) => names.iter().map(|name| name.as_str().unwrap()).collect(),
                    one => vec![one.as_str().unwrap()],
                };
                if !names.iter().any(|name| is_of(name, value)) {
                    list.push(at(place, format!("{value} is none of {names:?}")));
                }
            }
            "const" if rule != value => list.push(at(place, format!("{value} is not {rule}"))),
            "enum" if !rule.as_array().unwrap().contains(value) => {
                list.push(at(place, format!("{value} is none of {rule}")))
            }
            "const" | "enum" => {}
            "minimum" if value.as_f64() < rule.as_f64() => list.push(at(place, format!("{value} is below {rule}"))),
            "minItems" if (value.as_array().map(Vec::len)) < rule.as_u64().map(|n| n as usize) => {
                list.push(at(place, format!("fewer than {rule} items")));
            }
            "maxItems" if (value.as_array().map(Vec::len)) > rule.as_u64().map(|n| n as usize) => {
                list.push(at(place, format!("more than {rule} items")));
            }
            "minimum" | "minItems" | "maxItems" => {}
            "items" => {
                for (index, item) in value.as_array().into_iter().flatten().enumerate() {
                    check(root, rule, item, &format!("{place}[{index}]"), list);
                }
            }
            "properties" => {
                for (key, item) in value.as_object().into_iter().flatten() {
                    if let Some(part) = rule.get(key) {
                        check(root, part, item, &format!("{place}.{key}"), list);
                    }
                }
            }
            "required" => {
                for key in rule.as_array().unwrap() {
                    if value.get(key.as_str().unwrap()).is_none() {
                        list.push(at(place, format!("{key} is missing")));
                    }
                }
            }
            "additionalProperties" => {
                assert_eq!(rule, &Value::Bool(false));
                for key in value.as_object().into_iter().flatten().map(|(key, _)| key) {
                    if words["properties"].get(key).is_none() {
                        list.push(at(place, format!("{key} is not expected")));
                    }
                }
            }
            "anyOf" | "oneOf" => {
                let branches = rule.as_array().unwrap();
                let fitting = branches.iter().filter(|branch| {
                    let mut problems = Vec::new();
                    check(root, branch, value, place, &mut problems);
                    problems.is_empty()
                });
                let count = fitting.count();
                if count == 0 || word == "oneOf" && count > 1 {
                    list.push(at(place, format!("{count} branches of {word} fit {value}")));
                }
            }
            _ => panic!("{place}: the schema's word {word} is not known here"),
        }
    }
}

fn at(place: &str, what: String) -> String {
    format!("{place}: {what}")
}

fn is_of(name: &str, value: &Value) -> bool {
    match name {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        "number" => value.is_number(),
        "integer" => value.is_u64() || value.is_i64(),
        _ => panic!("no type {name}"),
    }
}

#[test]
fn values_that_do_not_fit_are_told() {
    let schema = serde_json::json!({
        "type": "object",
        "properties": { "a": { "type": "array", "items": { "$ref": "#/$defs/n" }, "minItems": 1 } },
        "required": ["a"],
        "additionalProperties": false,
        "$defs": { "n": { "anyOf": [{ "type": "integer", "minimum": 2 }, { "enum": ["x"] }] } },
    });
    let told = |value: Value| problems(&schema, &value).len();
    assert_eq!(told(serde_json::json!({ "a": [2, "x"] })), 0);
    assert_eq!(told(serde_json::json!({ "a": [1] })), 1);
    assert_eq!(told(serde_json::json!({ "a": ["y", 1.5] })), 2);
    assert_eq!(told(serde_json::json!({ "a": [] })), 1);
    assert_eq!(told(serde_json::json!({ "a": [2], "b": 1 })), 1);
    assert_eq!(told(serde_json::json!([])), 2);
}
