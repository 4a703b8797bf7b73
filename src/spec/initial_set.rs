//! The initial set in a document.

use super::constant::nonnegative_constant;
use super::document::Value;
use super::error::{Errors, Reported};
use super::model::{Constant, InitialSet};
use super::object::{Object, choose};

/// Reads `initial_set`: `paper` has no other field, `at-rest` may have X0 and E0, `box` has X0, E0 and Z0.
///
/// # Errors
/// Reports an unknown kind, fields that are missing or do not belong to the kind, and numbers that are negative.
pub(super) fn read(value: &Value<'_>, errors: &mut Errors) -> Result<InitialSet, Reported> {
    let mut object = value.object(errors)?;
    let kind = object.required("kind", errors);
    // Without a kind the other fields have no meaning to check.
    match kind.and_then(|value| choose(&value, "kind of initial set", &["paper", "at-rest", "box"], errors))? {
        "paper" => {
            object.finish_as("for the kind `paper`", errors);
            Ok(InitialSet::Paper)
        }
        "at-rest" => {
            let x0 = optional(&mut object, "X0", errors);
            let e0 = optional(&mut object, "E0", errors);
            object.finish_as("for the kind `at-rest`", errors);
            Ok(InitialSet::AtRest { x0: x0?, e0: e0? })
        }
        _ => {
            let x0 = object.required("X0", errors).and_then(|value| nonnegative_constant(&value, errors));
            let e0 = object.required("E0", errors).and_then(|value| nonnegative_constant(&value, errors));
            let z0 = object.required("Z0", errors).and_then(|value| nonnegative_constant(&value, errors));
            object.finish_as("for the kind `box`", errors);
            Ok(InitialSet::Box { x0: x0?, e0: e0?, z0: z0? })
        }
    }
}

fn optional(object: &mut Object<'_>, name: &'static str, errors: &mut Errors) -> Result<Option<Constant>, Reported> {
    object.optional(name).map(|value| nonnegative_constant(&value, errors)).transpose()
}
