//! JSON with exact numbers.

use crate::certify::CLAIM_DIGITS;
use rug::{Integer, Rational};
use serde_json::Value;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_rational, write_exact};
use sigmastar_lang::expr::Fourier;
use std::sync::LazyLock;

/// An object from pairs, in their order.
#[must_use]
pub fn object<'n>(fields: impl IntoIterator<Item = (&'n str, Value)>) -> Value {
    Value::Object(fields.into_iter().map(|(name, value)| (name.to_owned(), value)).collect())
}

/// An exact rational number, as a certificate writes it.
#[must_use]
pub fn exact(value: &Rational) -> Value {
    text(write_exact(value))
}

pub(super) fn text(value: impl Into<String>) -> Value {
    Value::String(value.into())
}

/// A list that is left out where it is empty.
pub(super) fn listed(name: &'static str, values: impl Iterator<Item = Value>) -> Option<(&'static str, Value)> {
    let values: Vec<Value> = values.collect();
    (!values.is_empty()).then(|| (name, Value::Array(values)))
}

/// The mean in a field of its own, and `harmonics` where there are some: `cos` and `sin` of k = 1, 2, ...
pub(super) fn series<T>(
    mean: &'static str,
    series: &Fourier<T>,
    json: impl Fn(&T) -> Value,
) -> Vec<(&'static str, Value)> {
    let harmonic = |[cos, sin]: &[T; 2]| object([("cos", json(cos)), ("sin", json(sin))]);
    let harmonics = listed("harmonics", series.harmonics.iter().map(harmonic));
    std::iter::once((mean, json(&series.mean))).chain(harmonics).collect()
}

pub(super) fn vector(values: &[Rational]) -> Value {
    values.iter().map(exact).collect()
}

/// Lists of exact rationals.
#[must_use]
pub fn rows(matrix: &[Vec<Rational>]) -> Value {
    matrix.iter().map(|row| vector(row)).collect()
}

/// An upper end, rounded up; the text "inf" when there is none.
pub(super) fn upper_end(value: &Enclosure) -> Value {
    match value.upper_rational() {
        // A bound of what is smaller still, which no reader of exact numerals need take: `f_e` of exp(-1e12) gives one.
        Some(upper) if upper > 0 && upper < *LEAST_WRITTEN => exact(&LEAST_WRITTEN),
        Some(upper) => exact(&round_rational(&upper, CLAIM_DIGITS, Direction::Up)),
        None => text("inf"),
    }
}

/// An upper end that is enlarged by a share of itself, so that whoever finds it in another way comes to it; exactly 0 stays 0.
pub(super) fn with_room(value: &Enclosure, share: &Rational) -> Value {
    upper_end(&(value * (Enclosure::from_rational(share, value.precision()) + Enclosure::one(value.precision()))))
}

/// The least positive upper bound that a claim writes.
static LEAST_WRITTEN: LazyLock<Rational> =
    LazyLock::new(|| Rational::from((Integer::from(1), Integer::from(Integer::u_pow_u(10, 1000)))));
