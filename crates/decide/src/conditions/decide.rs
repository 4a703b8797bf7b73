//! Deciding a claim from its rational witness, at a precision that rises while the answer is undecided.

use super::proof::{Decidable, Proof};
use sigmastar_exact::enclosure::{DEFAULT_PRECISION, MAX_PRECISION};
use sigmastar_lang::spec::model::Specification;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::condition::{self, Condition};
use sigmastar_theory::derivation::exact_regulation::{ExactEvaluation, ExactWitness};
use sigmastar_theory::derivation::initial_set::ClaimedSet;

/// The precisions that are tried: from `start`, doubled, up to `limit` bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ladder {
    /// The first precision in bits.
    pub start: u32,
    /// The last precision in bits.
    pub limit: u32,
}

impl Default for Ladder {
    fn default() -> Ladder {
        Ladder { start: DEFAULT_PRECISION, limit: MAX_PRECISION }
    }
}

impl Ladder {
    /// Evaluates at rising precisions until the conditions are decided; returns the last evaluation and its precision.
    fn climb<T>(self, evaluate: impl Fn(u32) -> T, conditions: impl Fn(&T) -> &[Condition]) -> (T, u32) {
        let mut precision = self.start.max(53);
        loop {
            let evaluation = evaluate(precision);
            if !condition::all(conditions(&evaluation)).is_undecided() || precision >= self.limit {
                return (evaluation, precision);
            }
            precision = (2 * precision).min(self.limit);
        }
    }
}

/// Decides the conditions of the witness's derivation.
#[must_use]
pub fn decide<W: Decidable>(spec: &Specification, witness: W, ladder: Ladder) -> Proof<W> {
    let (evaluation, precision) =
        ladder.climb(|precision| witness.evaluate(&Data::new(spec, precision)), W::conditions);
    Proof { witness, evaluation, precision }
}

/// Decides exact regulation for a claimed set.
#[must_use]
pub fn decide_exact(spec: &Specification, set: &ClaimedSet, witness: &ExactWitness, ladder: Ladder) -> ExactEvaluation {
    let evaluate = |precision| ExactEvaluation::new(&Data::new(spec, precision), set, witness);
    ladder.climb(evaluate, |evaluation| &evaluation.conditions).0
}
