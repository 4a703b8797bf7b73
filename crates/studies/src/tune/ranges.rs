//! The ends between which a number is sought, where the call gives none and where it does.
//!
//! Ends are needed: a larger mu moves a part of the gain into mu Nbar^2, which the law multiplies e by as well, so a smaller
//! sigma* alone is no reason to go on.

use rug::Rational;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::spec::{Document, Errors, positive_constant};

/// The usual range reaches from the value divided by this to the value times this.
const FACTOR: f64 = 10.0;

/// Digits of such an end.
const DIGITS: u32 = 3;

/// The usual range of a number with this value; `None` where a range without a thought makes no sense.
pub(super) fn usual(name: &str, value: f64) -> Option<[Rational; 2]> {
    let end = |value: f64| round_f64(value, DIGITS, Direction::Nearest);
    let tenfold = || Some([end(value / FACTOR)?, end(value * FACTOR)?]);
    match name {
        // Another frequency is another regulator: it no longer fits the disturbance.
        "base_frequency" => None,
        // Nbar^2 tends to infinity as epsilon tends to 0; above 1 there are no such weights.
        "epsilon" => Some([Rational::from((1, 20)), Rational::from(1)]),
        // 1 < exponent <= 2, for the same reasons.
        "exponent" => Some([Rational::from((21, 20)), Rational::from(2)]),
        // n_0 > n_1 = 1 in the power family; in a list n_0 > n_1 decides each case.
        "n0" if value > 1.0 => tenfold().map(|[low, high]| [low.max(Rational::from((101, 100))), high]),
        _ => tenfold(),
    }
}

/// A range as it is written: `low..high`.
pub(super) fn given(text: &str) -> Option<[Rational; 2]> {
    let (low, high) = text.split_once("..")?;
    let end = |text: &str| {
        let document = Document::flag("range", text.trim());
        let value = document.at("/range")?;
        let constant = positive_constant(&value, &mut Errors::new()).ok()?;
        constant.as_rational().cloned().filter(|end| (1e-100..=1e100).contains(&end.to_f64()))
    };
    let (low, high) = (end(low)?, end(high)?);
    (low < high).then_some([low, high])
}
