//! The conditions that prove a claim.

use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_prove::reduction::Run;
use sigmastar_theory::derivation::condition;

/// A condition: a comparison of two real numbers, each known between two doubles.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Condition {
    id: &'static str,
    text: String,
    lhs: [f64; 2],
    rhs: [f64; 2],
    relation: &'static str,
    holds: Option<bool>,
}

impl Condition {
    /// Those of a run.
    pub(super) fn of_run(run: &Run<'_>) -> Vec<Condition> {
        run.conditions().iter().map(Condition::new).collect()
    }

    fn new(condition: &condition::Condition) -> Condition {
        let ends = |side: &Enclosure| [side.lower_f64(), side.upper_f64()];
        Condition {
            id: condition.id,
            text: condition.what.clone(),
            lhs: ends(&condition.lhs),
            rhs: ends(&condition.rhs),
            relation: match condition.relation {
                condition::Relation::Less => "<",
                condition::Relation::LessOrEqual => "<=",
            },
            holds: match condition.truth() {
                Truth::True => Some(true),
                Truth::False => Some(false),
                Truth::Undecided => None,
            },
        }
    }

    /// Its name: `C1`, `C2`, ... (`docs/mathematics.md`).
    #[must_use]
    pub fn id(&self) -> &'static str {
        self.id
    }

    /// What it says, in a few words.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The left side lies between these doubles, rounded outward; NaN where it is not known to be defined.
    #[must_use]
    pub fn lhs(&self) -> [f64; 2] {
        self.lhs
    }

    /// The right side, in the same way.
    #[must_use]
    pub fn rhs(&self) -> [f64; 2] {
        self.rhs
    }

    /// `<` or `<=`.
    #[must_use]
    pub fn relation(&self) -> &'static str {
        self.relation
    }

    /// Whether it holds, decided at a higher precision than the doubles; `None` where that is not known.
    #[must_use]
    pub fn holds(&self) -> Option<bool> {
        self.holds
    }
}
