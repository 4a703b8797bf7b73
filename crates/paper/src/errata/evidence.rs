//! Pieces of evidence: two quantities, the relation between them, and whether it was proved here.

use rug::Rational;
use sigmastar_exact::enclosure::{DEFAULT_PRECISION, Enclosure, Truth};
use sigmastar_exact::number::write_exact;
use sigmastar_lang::spec::Constant;
use std::cmp::Ordering;
use std::fmt;

/// Significant digits of an enclosure when it is written out for a reader.
const DISPLAY_DIGITS: usize = 6;

/// The longest exact number that is written out digit by digit.
const LONGEST_EXACT: usize = 24;

/// One side of a comparison.
#[derive(Clone, Debug, PartialEq)]
pub enum Side {
    /// The number itself.
    Exact(Rational),
    /// An interval proved to contain the number.
    Enclosed(Enclosure),
}

impl Side {
    /// An enclosure of the number at the default precision.
    #[must_use]
    pub fn enclosure(&self) -> Enclosure {
        match self {
            Side::Exact(value) => Enclosure::from_rational(value, DEFAULT_PRECISION),
            Side::Enclosed(value) => value.clone(),
        }
    }
}

impl From<Rational> for Side {
    fn from(value: Rational) -> Side {
        Side::Exact(value)
    }
}

impl From<i64> for Side {
    fn from(value: i64) -> Side {
        Side::Exact(Rational::from(value))
    }
}

/// The exact value of a constant of a specification, where it is rational.
impl From<&Constant> for Side {
    fn from(constant: &Constant) -> Side {
        match constant.as_rational() {
            Some(value) => Side::Exact(value.clone()),
            None => Side::Enclosed(constant.enclose(DEFAULT_PRECISION)),
        }
    }
}

impl From<Enclosure> for Side {
    fn from(value: Enclosure) -> Side {
        Side::Enclosed(value)
    }
}

/// A short exact number as it is, anything else as an outward-rounded interval.
impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Side::Exact(value) = self {
            let text = write_exact(value);
            if text.len() <= LONGEST_EXACT {
                return f.write_str(&text);
            }
        }
        let value = self.enclosure();
        let (lower, upper) = (value.lower_decimal(DISPLAY_DIGITS), value.upper_decimal(DISPLAY_DIGITS));
        if lower == upper { f.write_str(&lower) } else { write!(f, "[{lower}, {upper}]") }
    }
}

/// The relation that a piece of evidence states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// `lhs < rhs`.
    Less,
    /// `lhs <= rhs`.
    LessOrEqual,
    /// `lhs > rhs`.
    Greater,
    /// `lhs >= rhs`.
    GreaterOrEqual,
    /// `lhs = rhs`.
    Equal,
    /// `lhs != rhs`.
    Different,
}

impl Relation {
    /// Decides the relation: exactly between exact numbers, by enclosures otherwise.
    #[must_use]
    pub fn decide(self, lhs: &Side, rhs: &Side) -> Truth {
        if let (Side::Exact(a), Side::Exact(b)) = (lhs, rhs) {
            let order = a.cmp(b);
            return Truth::exact(match self {
                Relation::Less => order == Ordering::Less,
                Relation::LessOrEqual => order != Ordering::Greater,
                Relation::Greater => order == Ordering::Greater,
                Relation::GreaterOrEqual => order != Ordering::Less,
                Relation::Equal => order == Ordering::Equal,
                Relation::Different => order != Ordering::Equal,
            });
        }
        let (a, b) = (lhs.enclosure(), rhs.enclosure());
        match self {
            Relation::Less => a.lt(&b),
            Relation::LessOrEqual => a.le(&b),
            Relation::Greater => a.gt(&b),
            Relation::GreaterOrEqual => a.ge(&b),
            Relation::Equal => a.le(&b).and(a.ge(&b)),
            Relation::Different => a.lt(&b).or(a.gt(&b)),
        }
    }
}

impl fmt::Display for Relation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Relation::Less => "<",
            Relation::LessOrEqual => "<=",
            Relation::Greater => ">",
            Relation::GreaterOrEqual => ">=",
            Relation::Equal => "=",
            Relation::Different => "!=",
        })
    }
}

/// What a piece of evidence rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Decided here, by exact rationals or by enclosures.
    Rigorous,
    /// Taken from a floating-point simulation or another source: reported, not proved.
    Cited,
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Kind::Rigorous => "rigorous",
            Kind::Cited => "cited",
        })
    }
}

/// A comparison that supports an erratum.
#[derive(Clone, Debug)]
pub struct Evidence {
    /// What is compared, and why it matters; formulas are marked.
    pub statement: String,
    /// The left side.
    pub lhs: Side,
    /// The relation that is stated.
    pub relation: Relation,
    /// The right side.
    pub rhs: Side,
    /// `True` for a relation that was proved here; always `Undecided` for cited evidence.
    pub truth: Truth,
    /// What it rests on.
    pub kind: Kind,
}

impl Evidence {
    /// A comparison that is decided here.
    #[must_use]
    pub fn rigorous(
        statement: impl Into<String>,
        (lhs, relation, rhs): (impl Into<Side>, Relation, impl Into<Side>),
    ) -> Evidence {
        let (lhs, rhs) = (lhs.into(), rhs.into());
        let truth = relation.decide(&lhs, &rhs);
        Evidence { statement: statement.into(), lhs, relation, rhs, truth, kind: Kind::Rigorous }
    }

    /// A comparison whose numbers come from elsewhere; it claims nothing, whatever the numbers say.
    #[must_use]
    pub fn cited(statement: impl Into<String>, inequality: (impl Into<Side>, Relation, impl Into<Side>)) -> Evidence {
        Evidence { truth: Truth::Undecided, kind: Kind::Cited, ..Evidence::rigorous(statement, inequality) }
    }

    /// Whether the relation was proved here.
    #[must_use]
    pub fn is_proved(&self) -> bool {
        self.kind == Kind::Rigorous && self.truth.is_true()
    }
}

impl fmt::Display for Evidence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: $`{} {} {}`$", self.statement, self.lhs, self.relation, self.rhs)?;
        match self.kind {
            Kind::Rigorous => write!(f, " ({})", self.truth),
            Kind::Cited => f.write_str(" (cited, not proved)"),
        }
    }
}
