//! Failures before a verdict on the claim: what is wrong with the input, for scripts.

use super::json::{FORMAT, VERSION};
use crate::certificate::{BoundingProblem, Verdict};
use crate::expr::BoundingFailure;
use crate::spec::{ErrorKind, SpecErrors, Specification};
use serde_json::{Value, json};

/// The problem with a bounding function as an error at its place in the specification, to be rendered in context.
#[must_use]
pub fn bounding_errors(spec: &Specification, problem: &BoundingProblem) -> SpecErrors {
    let field = format!("/{}/{}", problem.which.section(), problem.which.field());
    let text = spec.bounds.own(problem.which).map_or("", |expr| expr.text());
    let whole = 0..text.len();
    let (span, kind, help) = match &problem.failure {
        BoundingFailure::Refuted { span, .. } => (
            span,
            ErrorKind::Range,
            "correct the expression, or give a `domain` on which it is finite, nonnegative and nondecreasing in X and \
             in E",
        ),
        BoundingFailure::Undecided { span, .. } => (
            span,
            ErrorKind::Undecided,
            "rewrite it as sums, products and compositions of nondecreasing functions, or give a smaller `domain`",
        ),
    };
    let span = span.clone().unwrap_or(whole);
    spec.errors_at(&field, &span, kind, problem.sentence(), Some(help.to_owned()))
        .with_sentence_in_full(problem.failure.in_full())
}

/// A Jacobian without a proved triple, as an error at its place: undecided, for no search proves that there is none.
#[must_use]
pub fn jacobian_errors(spec: &Specification, message: impl Into<String>) -> SpecErrors {
    let help =
        "check the signs, narrow the intervals or give them as functions of t, or give the triple p_low, p_up, alpha";
    spec.errors_at("/lyapunov/jacobian", &(0..0), ErrorKind::Undecided, message, Some(help.to_owned()))
}

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
