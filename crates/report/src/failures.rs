//! Failures before a verdict on the claim: what is wrong with the input, for scripts.

use serde_json::{Value, json};
use sigmastar_lang::spec::SpecErrors;
use sigmastar_prove::certify::Verdict;

/// The format of a report on a certification, and of what is told in its place.
pub(super) const FORMAT: &str = "sigmastar/report";
/// Its version.
pub(super) const VERSION: u64 = 1;

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
    told(verdict, &errors_json(errors))
}

/// The report object of a call that is wrong as a whole: the verdict and what is wrong.
#[must_use]
pub fn call_failure_json(verdict: Verdict, message: &str, help: &str) -> Value {
    told(verdict, &json!([{ "code": "call", "message": message, "help": help }]))
}

fn told(verdict: Verdict, errors: &Value) -> Value {
    json!({ "format": FORMAT, "version": VERSION, "verdict": verdict.to_string(), "errors": errors })
}
