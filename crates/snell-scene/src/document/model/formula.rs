//! Numbers that may be written as formulas, and formulas of a variable.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::value::{Either, Form, Forms};

/// A number, or a formula of numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Quantity(pub Either<f64, String>);

impl From<f64> for Quantity {
    fn from(number: f64) -> Self {
        Self(Either::A(number))
    }
}

impl Forms for Quantity {
    const FORMS: &'static [Form] = &[Form::Number, Form::Text];
}

impl JsonSchema for Quantity {
    fn schema_name() -> Cow<'static, str> {
        "Number".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A number, or a text with a formula of numbers such as \"2*pi\" or \"sqrt(3)/2\": what a formula knows is said under `PlotFunction`.",
            "x-called": "a number or formula",
            "anyOf": [{ "type": "number" }, { "type": "string" }],
        })
    }
}

/// A formula of one variable, as a text.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(transparent)]
pub struct Formula(pub String);

impl JsonSchema for Formula {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        "Formula".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string", "x-called": "a formula" })
    }
}
