//! Three-valued truth: what rigorous arithmetic can say about a comparison.

use std::fmt;

/// The answer of a rigorous predicate.
///
/// `True` and `False` are proofs; `Undecided` says that the enclosures overlap at this precision and claims
/// nothing either way. There is deliberately no conversion to `bool` and no negation: a claim may rest on
/// `is_true`, a refutation on `is_false`, and "not certainly true" is neither.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Truth {
    /// Proved to hold.
    True,
    /// Proved not to hold.
    False,
    /// Not decided at this precision; it may be either.
    Undecided,
}

impl Truth {
    /// Whether the statement is proved.
    #[must_use]
    pub fn is_true(self) -> bool {
        self == Truth::True
    }

    /// Whether the opposite of the statement is proved.
    #[must_use]
    pub fn is_false(self) -> bool {
        self == Truth::False
    }

    /// Whether nothing is proved; a higher precision may decide.
    #[must_use]
    pub fn is_undecided(self) -> bool {
        self == Truth::Undecided
    }

    /// Kleene conjunction: false as soon as one side is, true only when both are.
    #[must_use]
    pub fn and(self, other: Truth) -> Truth {
        match (self, other) {
            (Truth::False, _) | (_, Truth::False) => Truth::False,
            (Truth::True, Truth::True) => Truth::True,
            _ => Truth::Undecided,
        }
    }

    /// Kleene disjunction: true as soon as one side is, false only when both are.
    #[must_use]
    pub fn or(self, other: Truth) -> Truth {
        match (self, other) {
            (Truth::True, _) | (_, Truth::True) => Truth::True,
            (Truth::False, Truth::False) => Truth::False,
            _ => Truth::Undecided,
        }
    }

    /// The truth of an exactly decided statement.
    #[must_use]
    pub fn exact(holds: bool) -> Truth {
        if holds { Truth::True } else { Truth::False }
    }
}

impl fmt::Display for Truth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Truth::True => "proved",
            Truth::False => "refuted",
            Truth::Undecided => "undecided",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Truth::{False, True, Undecided};

    #[test]
    fn kleene_tables() {
        for (a, b, and, or) in [
            (True, True, True, True),
            (True, False, False, True),
            (True, Undecided, Undecided, True),
            (False, False, False, False),
            (False, Undecided, False, Undecided),
            (Undecided, Undecided, Undecided, Undecided),
        ] {
            assert_eq!(a.and(b), and);
            assert_eq!(b.and(a), and);
            assert_eq!(a.or(b), or);
            assert_eq!(b.or(a), or);
        }
    }
}
