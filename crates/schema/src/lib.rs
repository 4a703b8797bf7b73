//! JSON Schemas of the files that people write: for editors and validators.
//!
//! A schema knows the names, types and places of fields. It knows no mathematics: what it accepts, the readers may refuse.
//! What the readers accept, it accepts.

#![deny(missing_docs)]
// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

mod parts;
mod plant;
mod shape;
mod specification;
mod study;

use serde_json::{Map, Value, json};
use shape::Shape;

/// The dialect of the schemas.
const DIALECT: &str = "https://json-schema.org/draft/2020-12/schema";

/// The files that have a schema.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Schema {
    /// A bounding specification.
    Specification,
    /// A plant.
    Plant,
    /// A parameter study.
    Study,
}

impl Schema {
    /// All of them.
    pub const ALL: [Schema; 3] = [Schema::Specification, Schema::Plant, Schema::Study];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Schema::Specification => "specification",
            Schema::Plant => "plant",
            Schema::Study => "study",
        }
    }

    fn shape(self) -> Shape {
        match self {
            Schema::Specification => Shape::Object(specification::fields()),
            Schema::Plant => Shape::Object(plant::fields()),
            Schema::Study => study::shape(),
        }
    }

    fn title(self) -> &'static str {
        match self {
            Schema::Specification => "Bounding specification of sigmastar",
            Schema::Plant => "Plant of sigmastar",
            Schema::Study => "Parameter study of sigmastar",
        }
    }

    /// The schema.
    #[must_use]
    pub fn json(self) -> Value {
        let mut schema = Map::new();
        schema.insert("$schema".to_owned(), json!(DIALECT));
        schema.insert("$id".to_owned(), json!(format!("urn:sigmastar:schema:{}:1", self.name())));
        schema.insert("title".to_owned(), json!(self.title()));
        schema.extend(self.shape().json());
        Value::Object(schema)
    }
}
