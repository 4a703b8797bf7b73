//! What a field may hold, and how a JSON Schema (draft 2020-12) says so.

use serde_json::{Map, Value, json};

/// A field of an object.
pub(super) struct Field {
    name: &'static str,
    required: bool,
    title: String,
    description: String,
    shape: Shape,
}

/// What a value may be.
pub(super) enum Shape {
    /// A text.
    Text,
    /// A text or a number: an exact constant. What is negative and written as a number can be told.
    Constant(Sign),
    /// A text or a number: an exact constant that is not negative, without operations but a fraction's.
    Ratio,
    /// A text or a number: an expression in these variables.
    Expression(&'static str),
    /// true or false.
    Boolean,
    /// A whole number in a range.
    Whole(u64, u64),
    /// One of these texts.
    Word(Vec<&'static str>),
    /// One of these versions.
    Version(Vec<u64>),
    /// A text, a number or a Boolean.
    Scalar,
    /// So many values of a shape.
    List(Box<Shape>, u64, Option<u64>),
    /// An object of these fields and no others.
    Object(Vec<Field>),
    /// An object of any names with values of a shape.
    Map(Box<Shape>),
    /// An object that has this schema elsewhere: nothing is said of it here.
    Foreign,
    /// Exactly one of these.
    OneOf(Vec<Shape>),
}

/// A decimal numeral without a sign.
const UNSIGNED: &str = r"([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?";

/// What is known of the sign of a constant.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Sign {
    Any,
    Nonnegative,
    Positive,
}

/// A field that must be there.
pub(super) fn must(name: &'static str, title: impl Into<String>, text: impl Into<String>, shape: Shape) -> Field {
    Field { name, required: true, title: title.into(), description: text.into(), shape }
}

/// A field that may be left out.
pub(super) fn may(name: &'static str, title: impl Into<String>, text: impl Into<String>, shape: Shape) -> Field {
    Field { required: false, ..must(name, title, text, shape) }
}

/// A list of at least one value.
pub(super) fn list(shape: Shape, most: usize) -> Shape {
    Shape::List(Box::new(shape), 1, Some(most as u64))
}

/// A list of any length.
pub(super) fn any_list(shape: Shape) -> Shape {
    Shape::List(Box::new(shape), 0, None)
}

impl Field {
    fn json(&self) -> Value {
        let mut fields = Map::new();
        fields.insert("title".to_owned(), self.title.clone().into());
        let mut description = self.description.clone();
        description.extend(self.shape.notation());
        fields.insert("description".to_owned(), description.into());
        fields.extend(self.shape.json());
        Value::Object(fields)
    }
}

impl Shape {
    /// How the value is written, for the description of a field.
    fn notation(&self) -> Option<String> {
        match self {
            Shape::Constant(sign) => {
                let range = match sign {
                    Sign::Any => "",
                    Sign::Nonnegative => ", not negative",
                    Sign::Positive => ", positive",
                };
                Some(format!(" An exact number{range}: 0.1 is 1/10; in quotes \"1/3\", \"2*pi\", \"sqrt(3)/2\"."))
            }
            Shape::Ratio => Some(" An exact number, not negative: 0.1 is 1/10; in quotes \"1/300\".".to_owned()),
            Shape::Expression(variables) => Some(format!(" An expression in {variables}, in quotes, or a number.")),
            _ => None,
        }
    }

    /// The keywords that say what the value is.
    pub(super) fn json(&self) -> Map<String, Value> {
        let value = match self {
            Shape::Text => json!({ "type": "string" }),
            Shape::Constant(Sign::Any) | Shape::Expression(_) => {
                json!({ "type": ["string", "number"], "minLength": 1 })
            }
            // Not `exclusiveMinimum` for a positive one: an editor may round 1e-400 to 0.
            Shape::Constant(_) => json!({ "type": ["string", "number"], "minLength": 1, "minimum": 0 }),
            Shape::Ratio => {
                json!({ "type": ["string", "number"], "pattern": format!("^{UNSIGNED}(/{UNSIGNED})?$"), "minimum": 0 })
            }
            Shape::Boolean => json!({ "type": "boolean" }),
            Shape::Whole(least, most) => json!({ "type": "integer", "minimum": least, "maximum": most }),
            Shape::Word(words) => match words.as_slice() {
                [word] => json!({ "const": word }),
                words => json!({ "enum": words }),
            },
            Shape::Version(versions) => json!({ "enum": versions }),
            Shape::Scalar => json!({ "type": ["string", "number", "boolean"] }),
            Shape::List(shape, least, most) => {
                let mut list = json!({ "type": "array", "items": shape.json(), "minItems": least });
                if let Some(most) = most {
                    list["maxItems"] = json!(most);
                }
                list
            }
            Shape::Object(fields) => {
                let required: Vec<&str> =
                    fields.iter().filter(|field| field.required).map(|field| field.name).collect();
                let properties: Map<String, Value> =
                    fields.iter().map(|field| (field.name.to_owned(), field.json())).collect();
                json!({ "type": "object", "required": required, "additionalProperties": false, "properties": properties })
            }
            Shape::Map(shape) => json!({ "type": "object", "additionalProperties": shape.json() }),
            Shape::Foreign => json!({ "type": "object" }),
            Shape::OneOf(shapes) => json!({ "oneOf": shapes.iter().map(Shape::json).collect::<Vec<_>>() }),
        };
        match value {
            Value::Object(fields) => fields,
            // Every arm above is an object.
            _ => Map::new(),
        }
    }
}
