//! Failures before a verdict on the claim: what is wrong with the input, for scripts.

use super::json::{FORMAT, VERSION};
use crate::certify::Verdict;
use crate::spec::SpecErrors;
use serde_json::{Value, json};

/// One object for each error, in order; numbers have all their digits.
pub(super) fn errors_json<'e>(all: impl IntoIterator<Item = &'e SpecErrors>) -> Value {
    let mut list = Vec::new();
    for errors in all {
        for error in errors.errors() {
            let (line, column) = errors.place(error);
            list.push(json!({
                "file": errors.label(),
                "code": error.kind.code(),
                "pointer": error.pointer,
                "message": errors.in_full(error),
                "expected": error.expected,
                "help": error.help,
                "line": line,
                "column": column,
            }));
        }
        if errors.omitted() > 0 {
            let message = format!("{} more errors are not shown", errors.omitted());
            list.push(json!({ "file": errors.label(), "message": message }));
        }
    }
    Value::Array(list)
}

/// The report object of a call that did not come to a claim: the verdict and the errors.
#[must_use]
pub fn failure_json<'e>(verdict: Verdict, errors: impl IntoIterator<Item = &'e SpecErrors>) -> Value {
    json!({ "format": FORMAT, "version": VERSION, "verdict": verdict.to_string(), "errors": errors_json(errors) })
}
