//! Failures before a verdict on the claim: what is wrong with the input, for scripts.

use crate::certificate::{BoundingProblem, Certification, Verdict};
use crate::derivation::relative_degree::RelativeDegreeError;
use crate::expr::BoundingFailure;
use crate::spec::{ErrorKind, SpecErrors, Specification};
use serde_json::{Value, json};

/// The format of a report on a certification, and of what is told in its place.
pub(super) const FORMAT: &str = "sigmastar/report";
/// Its version.
pub(super) const VERSION: u64 = 1;

/// The problem with a bounding function as an error at its place in the specification, to be rendered in context.
#[must_use]
pub fn bounding_errors(spec: &Specification, problem: &BoundingProblem) -> SpecErrors {
    let field = format!("/bounds/{}", problem.field);
    let text = spec.bounds.named().find(|(name, _)| *name == problem.field).map_or("", |(_, expr)| expr.text());
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
    spec.errors_at(&field, &span, kind, problem.failure.to_string(), Some(help.to_owned()))
        .with_sentence_in_full(problem.failure.in_full())
}

/// A Jacobian without a proved triple, as an error at its place: undecided, for no search proves that there is none.
#[must_use]
pub fn jacobian_errors(spec: &Specification, message: impl Into<String>) -> SpecErrors {
    let help =
        "check the signs, narrow the intervals or give them as functions of t, or give the triple p_low, p_up, alpha";
    spec.errors_at("/lyapunov/jacobian", &(0..0), ErrorKind::Undecided, message, Some(help.to_owned()))
}

/// The error of a filter that is proved to be unstable, at its place in the specification.
#[must_use]
pub fn filter_errors(run: &Certification<'_>) -> Option<SpecErrors> {
    let Some(Err(error @ RelativeDegreeError::NotHurwitz(_))) = &run.relative_degree else { return None };
    let help = "the coefficients a_1, ..., a_(r-1) must make s^(r-1) + a_(r-1) s^(r-2) + ... + a_1 stable; mind their \
                order";
    let message = error.to_string();
    Some(run.spec.errors_at("/relative_degree/a", &(0..0), ErrorKind::Range, message, Some(help.to_owned())))
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
    told(verdict, &errors_json(errors))
}

/// The same, of a call that is wrong as a whole.
#[must_use]
pub fn call_failure_json(verdict: Verdict, message: &str, help: &str) -> Value {
    told(verdict, &json!([{ "code": "call", "message": message, "help": help }]))
}

fn told(verdict: Verdict, errors: &Value) -> Value {
    json!({ "format": FORMAT, "version": VERSION, "verdict": verdict.to_string(), "errors": errors })
}
