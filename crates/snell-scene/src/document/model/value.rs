//! The values that several keys share: places in the file, named tables, colours, rotations, and values of several forms.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, Error, IntoDeserializer, MapAccess, SeqAccess, Visitor};
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};
use snell_math::Rgb;

use crate::diagnostic::{SourceId, Span};
use crate::document::color;

/// Three numbers x, y, z.
pub type Triple = [f64; 3];

/// The name under which [`Located`] asks the deserializer of this crate for a place.
pub(in crate::document) const LOCATED: &str = "$snell::Located";

/// A value and where the file says it; nowhere for a default.
///
/// It can only be read by the deserializer of this crate, which gives it four values: source, start, end, and the value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Located<T> {
    /// The value.
    pub value: T,
    /// Where.
    pub span: Option<Span>,
}

impl<T> From<T> for Located<T> {
    fn from(value: T) -> Self {
        Self { value, span: None }
    }
}

impl<T: Serialize> Serialize for Located<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.value.serialize(serializer)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Located<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct LocatedVisitor<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for LocatedVisitor<T> {
            type Value = Located<T>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a value and its place")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut parts: A) -> Result<Self::Value, A::Error> {
                let missing = || A::Error::custom("a place in the file is missing");
                let source: u32 = parts.next_element()?.ok_or_else(missing)?;
                let start: usize = parts.next_element()?.ok_or_else(missing)?;
                let end: usize = parts.next_element()?.ok_or_else(missing)?;
                let value = parts.next_element()?.ok_or_else(missing)?;
                Ok(Located { value, span: Some(Span { source: SourceId(source), range: start..end }) })
            }
        }
        deserializer.deserialize_tuple_struct(LOCATED, 4, LocatedVisitor(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for Located<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }
    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }
    fn schema_id() -> Cow<'static, str> {
        T::schema_id()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

/// Entries under names that the author chose, in the order of the file.
#[derive(Clone, Debug)]
pub struct Named<T>(pub Vec<(Located<String>, Located<T>)>);

impl<T> Default for Named<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NamedVisitor<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for NamedVisitor<T> {
            type Value = Named<T>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table of names")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Named(entries))
            }
        }
        deserializer.deserialize_map(NamedVisitor(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for Named<T> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        format!("Named{}", T::schema_name()).into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let of = generator.subschema_for::<T>();
        json_schema!({ "type": "object", "additionalProperties": of })
    }
}

/// The forms in which a value may be written, as the syntax tells them apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A text.
    Text,
    /// A number.
    Number,
    /// A list.
    List,
    /// True or false.
    Truth,
    /// A table.
    Table,
}

/// Which forms a type is written in.
pub trait Forms {
    /// Those forms.
    const FORMS: &'static [Form];
}

macro_rules! forms {
    ($($type:ty: $($form:ident),+;)*) => {
        $(impl Forms for $type { const FORMS: &'static [Form] = &[$(Form::$form),+]; })*
    };
}
forms! {
    String: Text;
    bool: Truth;
    f64: Number;
    u32: Number;
    Triple: List;
    Color: Text, Number, List;
}

/// One of two types that are written in different forms, so that the form alone decides which.
#[derive(Clone, Debug, PartialEq)]
pub enum Either<A, B> {
    /// The first.
    A(A),
    /// The second.
    B(B),
}

impl<A: Serialize, B: Serialize> Serialize for Either<A, B> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::A(a) => a.serialize(serializer),
            Self::B(b) => b.serialize(serializer),
        }
    }
}

impl<'de, A: Deserialize<'de> + Forms, B: Deserialize<'de>> Deserialize<'de> for Either<A, B> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct EitherVisitor<A, B>(PhantomData<(A, B)>);
        fn choose<'de, A, B, D>(form: Form, deserializer: D) -> Result<Either<A, B>, D::Error>
        where
            A: Deserialize<'de> + Forms,
            B: Deserialize<'de>,
            D: Deserializer<'de>,
        {
            if A::FORMS.contains(&form) {
                A::deserialize(deserializer).map(Either::A)
            } else {
                B::deserialize(deserializer).map(Either::B)
            }
        }
        impl<'de, A: Deserialize<'de> + Forms, B: Deserialize<'de>> Visitor<'de> for EitherVisitor<A, B> {
            type Value = Either<A, B>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a value in one of its forms")
            }
            fn visit_str<E: Error>(self, text: &str) -> Result<Self::Value, E> {
                choose(Form::Text, text.into_deserializer())
            }
            fn visit_bool<E: Error>(self, truth: bool) -> Result<Self::Value, E> {
                choose(Form::Truth, truth.into_deserializer())
            }
            fn visit_i64<E: Error>(self, number: i64) -> Result<Self::Value, E> {
                choose(Form::Number, number.into_deserializer())
            }
            fn visit_u64<E: Error>(self, number: u64) -> Result<Self::Value, E> {
                choose(Form::Number, number.into_deserializer())
            }
            fn visit_f64<E: Error>(self, number: f64) -> Result<Self::Value, E> {
                choose(Form::Number, number.into_deserializer())
            }
            fn visit_seq<S: SeqAccess<'de>>(self, list: S) -> Result<Self::Value, S::Error> {
                choose(Form::List, SeqAccessDeserializer::new(list))
            }
            fn visit_map<M: MapAccess<'de>>(self, map: M) -> Result<Self::Value, M::Error> {
                choose(Form::Table, MapAccessDeserializer::new(map))
            }
        }
        deserializer.deserialize_any(EitherVisitor(PhantomData))
    }
}

impl<A: JsonSchema, B: JsonSchema> JsonSchema for Either<A, B> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        format!("{}Or{}", A::schema_name(), B::schema_name()).into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (a, b) = (generator.subschema_for::<A>(), generator.subschema_for::<B>());
        json_schema!({ "anyOf": [a, b] })
    }
}

/// A colour, scene-linear once read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Color(pub Rgb);

impl Color {
    /// One in every component.
    pub const WHITE: Self = Self(Rgb::WHITE);
}

impl Default for Color {
    fn default() -> Self {
        Self(Rgb::BLACK)
    }
}

impl<'de> Deserialize<'de> for Color {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ColorVisitor;
        impl<'de> Visitor<'de> for ColorVisitor {
            type Value = Color;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a colour")
            }
            fn visit_str<E: Error>(self, text: &str) -> Result<Color, E> {
                color::parse(text).map(Color).ok_or_else(|| E::custom(format!("there is no colour {text:?}")))
            }
            fn visit_i64<E: Error>(self, number: i64) -> Result<Color, E> {
                Ok(Color(Rgb::gray(number as f32)))
            }
            fn visit_u64<E: Error>(self, number: u64) -> Result<Color, E> {
                Ok(Color(Rgb::gray(number as f32)))
            }
            fn visit_f64<E: Error>(self, number: f64) -> Result<Color, E> {
                Ok(Color(Rgb::gray(number as f32)))
            }
            fn visit_seq<S: SeqAccess<'de>>(self, list: S) -> Result<Color, S::Error> {
                <[f32; 3]>::deserialize(SeqAccessDeserializer::new(list)).map(|rgb| Color(rgb.into()))
            }
        }
        deserializer.deserialize_any(ColorVisitor)
    }
}

impl JsonSchema for Color {
    fn schema_name() -> Cow<'static, str> {
        "Color".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A colour: one number for a grey, or three numbers [r, g, b], both scene-linear; or \"#rgb\", \"#rrggbb\" or a CSS name such as \"tomato\", both sRGB-encoded as in a web page and decoded on reading. Primaries are those of sRGB. 0.5 and \"#808080\" are therefore not the same: the latter is 0.216.",
            "x-called": "a colour",
            "anyOf": [
                { "type": "number", "minimum": 0 },
                { "type": "array", "items": { "type": "number", "minimum": 0 }, "minItems": 3, "maxItems": 3 },
                { "type": "string", "format": "color" },
            ],
        })
    }
}

macro_rules! names {
    ($($(#[$doc:meta])* $type:ident in $table:literal;)*) => {
        $(
            $(#[$doc])*
            #[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
            #[serde(transparent)]
            pub struct $type(pub String);
            impl JsonSchema for $type {
                fn inline_schema() -> bool {
                    true
                }
                fn schema_name() -> Cow<'static, str> {
                    stringify!($type).into()
                }
                fn json_schema(_: &mut SchemaGenerator) -> Schema {
                    json_schema!({ "type": "string", "x-names": $table })
                }
            }
            impl Forms for $type {
                const FORMS: &'static [Form] = &[Form::Text];
            }
        )*
    };
}
names! {
    /// The name of a material of the scene.
    MaterialName in "material";
    /// The name of a texture of the scene.
    TextureName in "texture";
    /// The name of a prototype of the scene.
    PrototypeName in "prototype";
}

/// Turns about an axis through the origin.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-example" = "[[object]]\nbox = { size = 1 }\nrotate = { axis = [1, 1, 0], angle = 30 }\n"))]
pub struct AxisAngle {
    /// The axis, of any length but 0.
    pub axis: Located<Triple>,
    /// How far it turns, counter-clockwise as seen from the axis's tip.
    #[schemars(extend("x-unit" = "degrees"))]
    pub angle: f64,
}

/// `[x, y, z]` in degrees, applied about x, then y, then z, or an axis and an angle.
pub type Rotation = Either<Triple, AxisAngle>;

/// One factor, or one along each axis.
pub type Scale = Either<f64, Triple>;

/// The default of factors.
pub(super) fn one() -> f32 {
    1.0
}

/// The default of sizes.
pub(super) fn unit() -> f64 {
    1.0
}

/// The default of colours that pass everything on.
pub(super) fn white() -> Color {
    Color::WHITE
}
