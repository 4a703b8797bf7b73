//! Whether a value is valid by a JSON Schema of draft 2020-12.

use boon::{Compiler, Draft, SchemaIndex, Schemas};
use serde_json::Value;

/// Any address: nothing is fetched.
const PLACE: &str = "https://example.org/schema.json";

pub struct Validator {
    schemas: Schemas,
    index: SchemaIndex,
}

impl Validator {
    /// Reads a schema, which has to be one of that draft.
    pub fn new(schema: &Value) -> Validator {
        let (mut schemas, mut compiler) = (Schemas::new(), Compiler::new());
        compiler.set_default_draft(Draft::V2020_12);
        compiler.add_resource(PLACE, schema.clone()).expect("the address is one");
        let index = compiler.compile(PLACE, &mut schemas).unwrap_or_else(|error| panic!("{error:#}"));
        Validator { schemas, index }
    }

    /// What is wrong with a value.
    pub fn complaints(&self, value: &Value) -> Option<String> {
        self.schemas.validate(value, self.index).err().map(|error| format!("{error:#}"))
    }

    pub fn is_valid(&self, value: &Value) -> bool {
        self.complaints(value).is_none()
    }
}

#[test]
fn what_is_no_schema_is_told_and_what_is_invalid_too() {
    let schema = serde_json::json!({ "type": "object", "required": ["a"], "properties": { "a": { "maximum": 3 } } });
    let validator = Validator::new(&schema);
    assert!(validator.is_valid(&serde_json::json!({ "a": 3 })));
    assert!(validator.complaints(&serde_json::json!({ "a": 4 })).unwrap().contains("maximum"));
    assert!(!validator.is_valid(&serde_json::json!({})));
    assert!(std::panic::catch_unwind(|| Validator::new(&serde_json::json!({ "type": "no such" }))).is_err());
}
