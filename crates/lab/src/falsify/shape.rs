//! The pieces that drawn plants are made of, as texts of plant files and as texts of bounds in X and E.

use rug::Rational;
use sigmastar_exact::number::parse_decimal;
use std::fmt;

/// A coefficient with nine significant decimal digits: what is written is exactly what is bounded.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Number(f64);

impl Number {
    /// The nearest number of nine digits.
    #[must_use]
    pub fn new(value: f64) -> Number {
        Number(format!("{value:.8e}").parse().unwrap_or(value))
    }

    /// The value as a double.
    #[must_use]
    pub fn value(self) -> f64 {
        self.0
    }

    /// The decimal that is written, exactly; `None` where it is not finite.
    #[must_use]
    pub fn exact(self) -> Option<Rational> {
        parse_decimal(&format!("{:?}", self.0)).ok()
    }

    /// The number times a factor.
    #[must_use]
    pub fn times(self, factor: f64) -> Number {
        Number::new(self.0 * factor)
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The shortest decimal that gives the double: the nine digits, in parentheses for its sign.
        write!(f, "({:?})", self.0)
    }
}

/// A function phi of one variable with phi(0) = 0, |phi'| <= 1, |phi| <= min(|s|, scale) and |phi''| <= 1/scale.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Shape {
    /// phi(s) = s; there is no scale.
    #[default]
    Linear,
    /// phi(s) = scale tanh(s/scale); its second derivative is at most 4/(3 sqrt 3) = 0.770 times 1/scale.
    Tanh(Number),
    /// phi(s) = scale sin(s/scale).
    Sin(Number),
}

impl Shape {
    /// phi of a text.
    pub(super) fn of(self, argument: &str) -> String {
        match self {
            Shape::Linear => argument.to_owned(),
            Shape::Tanh(scale) => format!("{scale}*tanh({argument}/{scale})"),
            Shape::Sin(scale) => format!("{scale}*sin({argument}/{scale})"),
        }
    }

    /// A bound of |phi(s)| for |s| <= `size`.
    pub(super) fn bound(self, size: &str) -> String {
        match self {
            Shape::Linear => size.to_owned(),
            Shape::Tanh(scale) | Shape::Sin(scale) => format!("min({size}, {scale})"),
        }
    }

    /// A bound of |phi''|.
    pub(super) fn bend(self) -> String {
        match self {
            Shape::Linear => "0".to_owned(),
            Shape::Tanh(scale) | Shape::Sin(scale) => format!("1/{scale}"),
        }
    }
}

/// A factor of the time: 1, which is the default, or cos(k Om t + phase) for k >= 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Factor {
    /// k; 0 for the factor 1.
    pub order: u32,
    /// The phase.
    pub phase: Number,
}

impl Factor {
    /// The factor 1.
    pub const ONE: Factor = Factor { order: 0, phase: Number(0.0) };

    /// The factor as a text; `period` is the text of T.
    pub(super) fn text(self, period: &str) -> String {
        match self.order {
            0 => "1".to_owned(),
            order => format!("cos({order}*2*pi*t/({period}) + {})", self.phase),
        }
    }

    /// A bound of the derivative: k Om.
    pub(super) fn speed(self, period: &str) -> String {
        format!("{}*2*pi/({period})", self.order)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_the_number() {
        for (value, text) in [(0.123_456_789_123, "(0.123456789)"), (-2.0, "(-2.0)"), (1.5e-9, "(1.5e-9)")] {
            assert_eq!(Number::new(value).to_string(), text);
        }
        assert_eq!(Number::new(2.0).times(0.1).to_string(), "(0.2)");
        assert_eq!(Number::new(1.5e-9).exact(), Some(Rational::from((3, 2_000_000_000))));
        assert_eq!(Number::new(f64::INFINITY).exact(), None);
    }
}
