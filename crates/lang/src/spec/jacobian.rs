//! The Jacobian of the zero dynamics, in place of the Lyapunov triple.

use super::constant::{any_constant, expression, read_expression, whole};
use super::document::Value;
use super::error::{ErrorKind, Errors, Reported};
use super::parts::{Jacobian, JacobianEntry};
use super::period::Period;
use super::quantity::Quantity;
use crate::expr::{Expr, Monomial, Variables};
use rug::Rational;
use sigmastar_exact::enclosure::{DEFAULT_PRECISION, Truth};

/// The largest number of states that a Jacobian is read for.
pub const MAX_STATES: usize = 12;

/// Reads a square matrix; its entries are numbers, intervals `["lo", "hi"]` and trigonometric polynomials in t.
///
/// # Errors
/// Reports another shape, entries that cannot be read, an interval with lo > hi, and an entry in t that is not proved to be a
/// trigonometric polynomial of the period.
pub(super) fn read(value: &Value<'_>, period: Option<&Period>, errors: &mut Errors) -> Result<Jacobian, Reported> {
    let lists = value.array(errors)?;
    let order = lists.len();
    if order == 0 || order > MAX_STATES {
        let message = format!("`jacobian` has {order} rows");
        let expected = format!("expected a square matrix of 1 to {MAX_STATES} rows");
        return Err(errors.report(value.error(ErrorKind::Range, message).expected(expected)));
    }
    let mut rows = Vec::with_capacity(order);
    for list in lists {
        let entries = list.array(errors)?;
        if entries.len() != order {
            let message = format!("this row has {} entries, and `jacobian` has {order} rows", entries.len());
            let error = list.error(ErrorKind::Range, message).expected(format!("expected {order} entries"));
            return Err(errors.report(error));
        }
        rows.push(list.each(errors, |value, errors| read_entry(value, period, errors)));
    }
    let rows = rows.into_iter().collect::<Result<Vec<_>, _>>()?;
    Ok(Jacobian { rows, period: period.and_then(|period| period.nominal().exact.clone()) })
}

fn read_entry(value: &Value<'_>, period: Option<&Period>, errors: &mut Errors) -> Result<JacobianEntry, Reported> {
    if value.type_name() == "an array" {
        return read_interval(value, errors);
    }
    let expected = "a number, an interval or a string with an expression in t";
    let expr = match period {
        // Another error is told already.
        None => expression(value, Variables::Time, expected, errors)?,
        Some(period) => read_expression(value, expected, |text| Expr::parse_in_time(text, &period.phase()), errors)?,
    };
    let exact = period.and_then(|period| period.nominal().exact.as_ref());
    let unit = Monomial::rational(Rational::from(1));
    match expr.trigonometric(exact.unwrap_or(&unit), DEFAULT_PRECISION) {
        // Without an exact period only constants are known to have it.
        Ok(polynomial) if exact.is_some() || polynomial.harmonics.is_empty() => Ok(JacobianEntry::Function(expr)),
        // The period itself is in error, and was reported.
        _ if period.is_none() => Ok(JacobianEntry::Function(expr)),
        Ok(_) => {
            let message = "the period is not known exactly, so that no function of t can be told to have it";
            let error = whole(value, ErrorKind::Range, message).help("write the period in rational multiples of pi");
            Err(errors.report(error))
        }
        Err(error) => {
            let error = value
                .error_in(ErrorKind::Range, &error.span, error.reason)
                .expected("expected a trigonometric polynomial with the period of the specification")
                .help(
                    "write sums and products of numbers, cos(k*2*pi*t/period) and sin(k*2*pi*t/period) with whole k, \
                     or enclose the entry in an interval [\"lo\", \"hi\"]",
                );
            Err(errors.report(error))
        }
    }
}

fn read_interval(value: &Value<'_>, errors: &mut Errors) -> Result<JacobianEntry, Reported> {
    let ends = value.array(errors)?;
    let [low, up] = &ends[..] else {
        let message = format!("an interval has two ends, and this list has {}", ends.len());
        let error = value.error(ErrorKind::Range, message).expected("expected [\"lo\", \"hi\"]");
        return Err(errors.report(error));
    };
    let (low_end, up_end) = (any_constant(low, errors), any_constant(up, errors));
    let (low_end, up_end) = (low_end?, up_end?);
    let ordered = Quantity::constant(&low_end).le(&Quantity::constant(&up_end));
    let (kind, message) = match ordered {
        Truth::True => return Ok(JacobianEntry::Interval(Box::new([low_end, up_end]))),
        Truth::False => (ErrorKind::Range, "the lower end of this interval exceeds its upper end"),
        Truth::Undecided => (ErrorKind::Undecided, "cannot be decided whether this interval is empty"),
    };
    Err(errors.report(whole(value, kind, message).expected("expected [\"lo\", \"hi\"] with lo <= hi")))
}
