//! JSON with exact numbers.

use rug::Rational;
use serde_json::Value;
use sigmastar_exact::number::write_exact;

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

pub(super) fn vector(values: &[Rational]) -> Value {
    values.iter().map(exact).collect()
}

/// Lists of exact rationals.
pub(super) fn rows(matrix: &[Vec<Rational>]) -> Value {
    matrix.iter().map(|row| vector(row)).collect()
}
