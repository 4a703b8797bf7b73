//! What came of one derivation, and which of two proofs is the better one.

use sigmastar_decide::conditions::{Decidable, Proof, SharpProof};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_propose::search::{Failing, Obstacle};
use sigmastar_theory::derivation::condition::Condition;

/// One derivation's outcome.
#[derive(Clone, Debug)]
pub enum Outcome<P> {
    /// Proved.
    Proved(Box<P>),
    /// A witness was found (or given), and these conditions are not proved.
    NotProved {
        /// The witness and its evaluation.
        proof: Box<P>,
        /// The conditions that are not proved.
        failing: Vec<Condition>,
    },
    /// No candidate was found.
    NotFound(Obstacle),
}

impl<P> Outcome<P> {
    /// The proof, if there is one.
    #[must_use]
    pub fn proved(&self) -> Option<&P> {
        match self {
            Outcome::Proved(proof) => Some(proof),
            _ => None,
        }
    }

    /// The witness that was decided, proved or not.
    #[must_use]
    pub fn attempt(&self) -> Option<&P> {
        match self {
            Outcome::Proved(proof) | Outcome::NotProved { proof, .. } => Some(proof),
            Outcome::NotFound(_) => None,
        }
    }
}

impl<W: Decidable> From<Option<Proof<W>>> for Outcome<Proof<W>> {
    /// Proved, where every condition is; without a witness, no numbers were finite.
    fn from(attempt: Option<Proof<W>>) -> Outcome<Proof<W>> {
        let Some(proof) = attempt.map(Box::new) else { return Outcome::NotFound(Failing::NotFinite(None).into()) };
        let failing = failing(W::conditions(&proof.evaluation));
        if failing.is_empty() { Outcome::Proved(proof) } else { Outcome::NotProved { proof, failing } }
    }
}

/// The conditions that are not proved.
pub(super) fn failing(conditions: &[Condition]) -> Vec<Condition> {
    conditions.iter().filter(|condition| !condition.truth().is_true()).cloned().collect()
}

/// Whether a proof has a smaller gain, or at the same gain a smaller bound of |e|.
pub(super) fn is_better(one: &SharpProof, other: &SharpProof) -> bool {
    let [first, second] = [one, other].map(|proof| &proof.witness.sigma);
    first < second || (first == second && has_smaller_peak(one, other))
}

/// Whether a proof has the smaller bound of |e| on the way.
pub(super) fn has_smaller_peak(one: &SharpProof, other: &SharpProof) -> bool {
    smaller([one, other].map(|proof| &proof.evaluation.peak))
}

/// Whether the first of two bounds is smaller; what is no number is larger than all.
pub(super) fn smaller(bounds: [&Enclosure; 2]) -> bool {
    let [first, second] = bounds.map(|bound| Some(bound.upper_f64()).filter(|upper| !upper.is_nan()));
    first.unwrap_or(f64::INFINITY) < second.unwrap_or(f64::INFINITY)
}
