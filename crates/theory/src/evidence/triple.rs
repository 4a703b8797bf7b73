//! A P(t) with the rate that it proves (derivation, 11.2).

use rug::Rational;
use sigmastar_lang::spec::model::{Constant, Lyapunov, PeriodicMatrix};

/// A proved triple with its witness.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProvedTriple {
    /// P(t).
    pub matrix: PeriodicMatrix,
    /// `p_low I <= P(t)`.
    pub p_low: Rational,
    /// `P(t) <= p_up I`.
    pub p_up: Rational,
    /// The rate, in 1/time.
    pub alpha: Rational,
}

impl ProvedTriple {
    /// As a specification has it.
    #[must_use]
    pub fn stated(&self) -> (Lyapunov, PeriodicMatrix) {
        let [p_low, p_up, alpha] = [&self.p_low, &self.p_up, &self.alpha].map(Constant::rational);
        (Lyapunov { p_low, p_up, alpha }, self.matrix.clone())
    }

    /// A triple that serves wherever one of these does, which are of one P: that of all cells of a family. None of none.
    #[must_use]
    pub fn in_common(triples: Vec<ProvedTriple>) -> Option<ProvedTriple> {
        triples.into_iter().reduce(|one, other| ProvedTriple {
            p_low: one.p_low.min(other.p_low),
            p_up: one.p_up.max(other.p_up),
            alpha: one.alpha.min(other.alpha),
            ..one
        })
    }
}

/// The proved triples of a Jacobian.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProvedTriples {
    /// That of stability; it serves for existence too where there is no other.
    pub stability: ProvedTriple,
    /// That of the existence of the periodic solution.
    pub existence: Option<ProvedTriple>,
}
