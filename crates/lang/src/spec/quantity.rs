//! Real numbers that are known exactly or can be enclosed at any precision, and how they are compared.

use super::parts::Constant;
use crate::expr::Monomial;
use rug::Rational;
use sigmastar_exact::enclosure::{DEFAULT_PRECISION, Enclosure, MAX_PRECISION, Truth};
use sigmastar_exact::number::write_exact;
use std::cmp::Ordering;

/// Digits of a number in a message.
const DIGITS: usize = 10;

/// What stands for the digits that are not written.
const CUT: &str = "...";

/// Digits in a message at which telling two numbers apart is given up.
const MOST_DIGITS: usize = 80;

/// A real number: its exact form where there is one, and enclosures at any precision.
pub(super) struct Quantity<'a> {
    exact: Option<Monomial>,
    enclose: Box<dyn Fn(u32) -> Enclosure + 'a>,
}

impl<'a> Quantity<'a> {
    /// The number with the given exact form, or else with the given enclosures.
    pub(super) fn new(exact: Option<Monomial>, enclose: impl Fn(u32) -> Enclosure + 'a) -> Quantity<'a> {
        match exact {
            Some(exact) => Quantity::exact(exact),
            None => Quantity { exact: None, enclose: Box::new(enclose) },
        }
    }

    /// A number that is known exactly.
    pub(super) fn exact(value: Monomial) -> Quantity<'a> {
        Quantity { exact: Some(value.clone()), enclose: Box::new(move |precision| value.enclose(precision)) }
    }

    /// A rational number.
    pub(super) fn rational(value: impl Into<Rational>) -> Quantity<'a> {
        Quantity::exact(Monomial::rational(value.into()))
    }

    /// The number of a specification.
    pub(super) fn constant(constant: &'a Constant) -> Quantity<'a> {
        Quantity::new(constant.exact.clone(), |precision| constant.enclose(precision))
    }

    /// The product.
    pub(super) fn times(self, other: Quantity<'a>) -> Quantity<'a> {
        let exact = self.exact.as_ref().zip(other.exact.as_ref()).and_then(|(a, b)| a.mul(b));
        Quantity::new(exact, move |precision| (self.enclose)(precision) * (other.enclose)(precision))
    }

    /// Whether this number is at most the other one.
    pub(super) fn le(&self, other: &Quantity<'_>) -> Truth {
        match self.compare(other) {
            Some(ordering) => Truth::exact(ordering != Ordering::Greater),
            None => decide(|precision| (self.enclose)(precision).le(&(other.enclose)(precision))),
        }
    }

    /// Whether this number is less than the other one.
    pub(super) fn lt(&self, other: &Quantity<'_>) -> Truth {
        match self.compare(other) {
            Some(ordering) => Truth::exact(ordering == Ordering::Less),
            None => decide(|precision| (self.enclose)(precision).lt(&(other.enclose)(precision))),
        }
    }

    /// Whether the two numbers are equal. Without exact forms that can be refuted, by disjoint enclosures, but not
    /// proved.
    pub(super) fn equals(&self, other: &Quantity<'_>) -> Truth {
        match (&self.exact, &other.exact) {
            (Some(a), Some(b)) => a.equals(b),
            _ => decide(|precision| {
                let (a, b) = ((self.enclose)(precision), (other.enclose)(precision));
                if a.lt(&b).or(b.lt(&a)).is_true() { Truth::False } else { Truth::Undecided }
            }),
        }
    }

    /// The number for a message: exactly where that is short, else to ten digits.
    pub(super) fn shown(&self) -> String {
        self.shown_to(DIGITS)
    }

    /// Two numbers for a message that compares them: to as many digits as it takes to tell them apart.
    pub(super) fn shown_apart(&self, other: &Quantity<'_>) -> (String, String) {
        let mut digits = DIGITS;
        loop {
            let pair = (self.shown_to(digits), other.shown_to(digits));
            digits *= 2;
            if apart(&pair.0, &pair.1) || digits > MOST_DIGITS {
                return pair;
            }
        }
    }

    fn shown_to(&self, digits: usize) -> String {
        if let Some(rational) = self.exact.as_ref().and_then(Monomial::as_rational) {
            let text = write_exact(rational);
            if text.len() <= 2 * digits {
                return text;
            }
        }
        // A digit takes three bits and a third.
        let value = (self.enclose)(DEFAULT_PRECISION + 4 * digits as u32);
        // Digits are cut off towards 0, so that those shown are those of the number.
        let (sign, size) = if value.is_nonnegative().is_false() { ("-", value.negate()) } else { ("", value) };
        let (lower, upper) = (size.lower_decimal(digits), size.ceiling().lower_decimal(digits));
        if lower == upper { format!("{sign}{lower}{CUT}") } else { format!("about {sign}{upper}") }
    }

    fn compare(&self, other: &Quantity<'_>) -> Option<Ordering> {
        self.exact.as_ref()?.compare(other.exact.as_ref()?)
    }
}

/// Whether two numbers can be told apart as they are written: one that is cut off differs in the digits it shows.
fn apart(a: &str, b: &str) -> bool {
    let hidden = |cut: &str, other: &str| {
        cut.strip_suffix(CUT).is_some_and(|shown| other.strip_suffix(CUT).unwrap_or(other).starts_with(shown))
    };
    a != b && !hidden(a, b) && !hidden(b, a)
}

/// Asks at rising precision until the answer is a proof, or the highest precision has none.
pub(super) fn decide(ask: impl Fn(u32) -> Truth) -> Truth {
    let mut precision = DEFAULT_PRECISION;
    while precision < MAX_PRECISION {
        let answer = ask(precision);
        if !answer.is_undecided() {
            return answer;
        }
        precision *= 2;
    }
    ask(MAX_PRECISION)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Expr, Variables};

    #[test]
    fn the_digits_shown_are_those_of_the_number() {
        for (text, shown) in [
            ("1/sqrt(3)", "0.5773502691..."),
            ("-1/sqrt(3)", "-0.5773502691..."),
            ("2 - exp(1)", "-0.7182818284..."),
            ("-1/3", "-1/3"),
            ("-0.25", "-0.25"),
        ] {
            let expr = Expr::parse(text, Variables::None).unwrap();
            let constant = Constant { text: text.to_owned(), exact: expr.exact(), expr };
            assert_eq!(Quantity::constant(&constant).shown(), shown, "{text}");
        }
    }
}
