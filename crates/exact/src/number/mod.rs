//! Exact numbers: decimals and fractions in, short rationals out.
//!
//! Everything a claim rests on is a [`rug::Rational`]. This module reads the decimals that users write (0.1 is 1/10,
//! never the nearest double), writes rationals as terminating decimals or fractions, and rounds floating-point
//! proposals of a search to short rationals in a chosen direction.

mod apart;
mod bernoulli;
mod decimal;
mod portable;
mod short;

pub use apart::told_apart;
pub use bernoulli::bernoulli_over_factorial;
pub use decimal::positional;
pub use decimal::{DecimalError, MAX_EXPONENT, MAX_LENGTH, parse_decimal, parse_rational, write_exact};
pub use portable::Portable;
pub use short::{Direction, in_digits, round_f64, round_rational};
