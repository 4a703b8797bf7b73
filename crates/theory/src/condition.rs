//! One decided condition of a certificate.

use sigmastar_exact::enclosure::{Enclosure, Truth};
use std::fmt;

/// The relation between the two sides of a condition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// `lhs < rhs`.
    Less,
    /// `lhs <= rhs`.
    LessOrEqual,
}

impl fmt::Display for Relation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Relation::Less => "<",
            Relation::LessOrEqual => "<=",
        })
    }
}

/// A condition `lhs relation rhs`, with both sides enclosed.
#[derive(Clone, Debug)]
pub struct Condition {
    /// The identifier: C1, C2, ... (a letter is appended where a condition has several parts).
    pub id: &'static str,
    /// What it says, in a few words.
    pub what: String,
    /// The left side.
    pub lhs: Enclosure,
    /// The relation.
    pub relation: Relation,
    /// The right side.
    pub rhs: Enclosure,
}

impl Condition {
    /// `lhs < rhs`.
    #[must_use]
    pub fn less(id: &'static str, what: impl Into<String>, lhs: Enclosure, rhs: Enclosure) -> Condition {
        Condition { id, what: what.into(), lhs, relation: Relation::Less, rhs }
    }

    /// `lhs <= rhs`.
    #[must_use]
    pub fn at_most(id: &'static str, what: impl Into<String>, lhs: Enclosure, rhs: Enclosure) -> Condition {
        Condition { id, what: what.into(), lhs, relation: Relation::LessOrEqual, rhs }
    }

    /// Whether it holds.
    #[must_use]
    pub fn truth(&self) -> Truth {
        match self.relation {
            Relation::Less => self.lhs.lt(&self.rhs),
            Relation::LessOrEqual => self.lhs.le(&self.rhs),
        }
    }

    /// `rhs - lhs`, enclosed.
    #[must_use]
    pub fn margin(&self) -> Enclosure {
        &self.rhs - &self.lhs
    }

    /// The margin relative to the right side, in floating point, for reports.
    #[must_use]
    pub fn relative_margin(&self) -> f64 {
        let scale = self.rhs.midpoint_f64().abs();
        if scale > 0.0 { self.margin().midpoint_f64() / scale } else { self.margin().midpoint_f64() }
    }
}

/// The truth of all conditions together.
#[must_use]
pub fn all(conditions: &[Condition]) -> Truth {
    conditions.iter().fold(Truth::True, |truth, condition| truth.and(condition.truth()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn whole(value: i64) -> Enclosure {
        Enclosure::from_integer(value, 64)
    }

    #[test]
    fn strict_and_loose_relations_differ_at_equality() {
        let strict = Condition::less("C", "", whole(1), whole(1));
        let loose = Condition::at_most("C", "", whole(1), whole(1));
        assert_eq!(strict.truth(), Truth::False);
        assert_eq!(loose.truth(), Truth::True);
        assert_eq!(all(&[loose.clone(), strict]), Truth::False);
        assert_eq!(all(&[loose.clone(), Condition::less("C", "", whole(0), Enclosure::entire(64))]), Truth::Undecided);
        assert_eq!(all(&[]), Truth::True);
        assert_eq!(loose.relative_margin(), 0.0);
    }
}
