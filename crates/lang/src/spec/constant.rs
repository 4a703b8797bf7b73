//! Constants of a document, and the proof of their sign.

use super::document::Value;
use super::error::{ErrorKind, Errors, Reported, SpecError};
use super::parts::Constant;
use super::quantity::{Quantity, decide};
use crate::expr::{Definitions, Expr, ExprError, Variables};
use sigmastar_exact::enclosure::{MAX_PRECISION, Truth};

/// Reads a constant: a JSON number, taken as the decimal that is written, or a string with a constant expression.
///
/// Guarantee: the constant is a real number, shown by its exact form or by a bounded enclosure.
///
/// # Errors
/// Reports another type, an expression that cannot be read, and one that has no value (as `1/0`) or none that can
/// be enclosed.
pub fn any_constant(value: &Value<'_>, errors: &mut Errors) -> Result<Constant, Reported> {
    any_constant_in(value, Definitions::none(), errors)
}

/// Reads a constant in which names of other constants may stand; it is the constant with these written out.
///
/// # Errors
/// Those of [`any_constant`].
pub fn any_constant_in(value: &Value<'_>, names: &Definitions, errors: &mut Errors) -> Result<Constant, Reported> {
    let expected = "a number or a string with a constant expression";
    let Some(text) = value.numeral().or_else(|| value.text()) else {
        return Err(value.wrong_type(expected, errors));
    };
    let read = names.spelled_out(text).and_then(|text| Expr::parse(&text, Variables::None));
    let expr = read.map_err(|error| errors.report(value.expression_error(&error)))?;
    let exact = expr.exact();
    let constant = Constant { text: expr.text().to_owned(), expr, exact };
    let real = decide(|precision| match constant.enclose(precision).is_bounded() {
        true => Truth::True,
        false => Truth::Undecided,
    });
    if real.is_true() {
        return Ok(constant);
    }
    let message = "this constant has no value that can be enclosed";
    let help = "a division by 0, the root or logarithm of a negative number, or a number too large or too close to \
                such a place";
    Err(errors.report(whole(value, ErrorKind::Expression, message).help(help)))
}

/// Reads a constant that is proved to be positive.
///
/// # Errors
/// Those of [`any_constant`]; reports a number that is not positive, and one whose sign cannot be decided.
pub fn positive_constant(value: &Value<'_>, errors: &mut Errors) -> Result<Constant, Reported> {
    positive_constant_in(value, Definitions::none(), errors)
}

/// Reads a constant that is proved to be positive, in which names of other constants may stand.
///
/// # Errors
/// Those of [`positive_constant`].
pub fn positive_constant_in(value: &Value<'_>, names: &Definitions, errors: &mut Errors) -> Result<Constant, Reported> {
    let constant = any_constant_in(value, names, errors)?;
    let positive = Quantity::rational(0).lt(&Quantity::constant(&constant));
    in_range(value, constant, positive, "positive", errors)
}

/// Reads a constant that is proved to be nonnegative.
///
/// # Errors
/// Those of [`any_constant`]; reports a negative number, and one whose sign cannot be decided.
pub fn nonnegative_constant(value: &Value<'_>, errors: &mut Errors) -> Result<Constant, Reported> {
    nonnegative_constant_in(value, Definitions::none(), errors)
}

/// Reads a constant that is proved to be nonnegative, in which names of other constants may stand.
///
/// # Errors
/// Those of [`nonnegative_constant`].
pub(super) fn nonnegative_constant_in(
    value: &Value<'_>,
    names: &Definitions,
    errors: &mut Errors,
) -> Result<Constant, Reported> {
    let constant = any_constant_in(value, names, errors)?;
    let nonnegative = Quantity::rational(0).le(&Quantity::constant(&constant));
    in_range(value, constant, nonnegative, "nonnegative", errors)
}

/// Reads an expression from a JSON number or a string.
///
/// # Errors
/// Reports another type (as "expected `expected`") and an expression that cannot be read, in its place.
pub(super) fn expression(
    value: &Value<'_>,
    variables: Variables,
    expected: &str,
    errors: &mut Errors,
) -> Result<Expr, Reported> {
    read_expression(value, expected, |text| Expr::parse(text, variables), errors)
}

/// Reads an expression in another way.
///
/// # Errors
/// Those of [`expression`].
pub(super) fn read_expression(
    value: &Value<'_>,
    expected: &str,
    parse: impl Fn(&str) -> Result<Expr, ExprError>,
    errors: &mut Errors,
) -> Result<Expr, Reported> {
    let Some(text) = value.numeral().or_else(|| value.text()) else {
        return Err(value.wrong_type(expected, errors));
    };
    parse(text).map_err(|error| errors.report(value.expression_error(&error)))
}

/// An error that points at the whole text of a constant, without the quotes.
pub(super) fn whole(value: &Value<'_>, kind: ErrorKind, message: impl Into<String>) -> SpecError {
    let length = value.text().or_else(|| value.numeral()).map_or(0, str::len);
    value.error_in(kind, &(0..length), message)
}

/// Why two constants, each with its name, are not proved to be in an order, `<=` or `>=`.
pub(super) fn not_in_order(
    value: &Value<'_>,
    (left, a): (&str, &Constant),
    relation: &str,
    (right, b): (&str, &Constant),
) -> Option<SpecError> {
    let (a, b) = (Quantity::constant(a), Quantity::constant(b));
    let holds = if relation == "<=" { a.le(&b) } else { b.le(&a) };
    let (kind, message) = match holds {
        Truth::True => return None,
        Truth::False => {
            let (a, b) = a.shown_apart(&b);
            (ErrorKind::Range, format!("{left} {relation} {right} fails: {left} = {a} and {right} = {b}"))
        }
        Truth::Undecided => {
            let message = format!("cannot be decided at {MAX_PRECISION} bits whether {left} {relation} {right}");
            (ErrorKind::Undecided, message)
        }
    };
    Some(whole(value, kind, message))
}

/// That `low` is certainly above `high`, with both.
pub(super) fn exchanged(low_value: &Value<'_>, low: &Constant, high: &Constant) -> Option<SpecError> {
    let (low, high) = (Quantity::constant(low), Quantity::constant(high));
    if !high.lt(&low).is_true() {
        return None;
    }
    let (low, high) = low.shown_apart(&high);
    let message = format!("`low` = {low} is above `high` = {high}");
    let error = whole(low_value, ErrorKind::Range, message).expected("expected low <= nominal <= high");
    Some(error.help(format!("exchange the two: `low` is the smaller end, {high}, and `high` the larger one, {low}")))
}

/// The constant if the range is proved, else an error that says which of the two other answers it is.
fn in_range(
    value: &Value<'_>,
    constant: Constant,
    holds: Truth,
    range: &str,
    errors: &mut Errors,
) -> Result<Constant, Reported> {
    let name = value.name();
    let error = match holds {
        Truth::True => return Ok(constant),
        Truth::False => {
            let shown = Quantity::constant(&constant).shown();
            let error = whole(value, ErrorKind::Range, format!("{name} must be {range}, but it is {shown}"));
            match value.pointer().starts_with("/input_gain/") {
                true => error.help("count the control with the other sign: then its gain is positive"),
                false => error,
            }
        }
        Truth::Undecided => {
            let message = format!("cannot be decided at {MAX_PRECISION} bits whether {name} is {range}");
            whole(value, ErrorKind::Undecided, message).help("write the number in a simpler way")
        }
    };
    Err(errors.report(error.expected(format!("expected a {range} number"))))
}
