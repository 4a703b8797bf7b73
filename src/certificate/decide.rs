//! Deciding a claim from its rational witness, at a precision that rises while the answer is undecided.

use crate::data::Data;
use crate::derivation::exact_regulation::{ExactEvaluation, ExactWitness};
use crate::derivation::repaired::{RepairedEvaluation, RepairedWitness};
use crate::derivation::sharp::{ClaimedSet, SharpEvaluation, SharpWitness};
use crate::enclosure::{DEFAULT_PRECISION, MAX_PRECISION, Truth};
use crate::spec::model::Specification;

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
    /// Evaluates at rising precisions until `truth` decides; returns the last evaluation and its precision.
    fn climb<T>(self, evaluate: impl Fn(u32) -> T, truth: impl Fn(&T) -> Truth) -> (T, u32) {
        let mut precision = self.start.max(53);
        loop {
            let evaluation = evaluate(precision);
            if !truth(&evaluation).is_undecided() || precision >= self.limit {
                return (evaluation, precision);
            }
            precision = (2 * precision).min(self.limit);
        }
    }
}

/// Decides C1-C5 of the sharp derivation; with the precision used.
#[must_use]
pub fn decide_sharp(spec: &Specification, witness: &SharpWitness, ladder: Ladder) -> (SharpEvaluation, u32) {
    ladder.climb(|precision| SharpEvaluation::new(&Data::new(spec, precision), witness), SharpEvaluation::truth)
}

/// Decides the repaired conditions; with the precision used.
#[must_use]
pub fn decide_repaired(spec: &Specification, witness: &RepairedWitness, ladder: Ladder) -> (RepairedEvaluation, u32) {
    ladder.climb(|precision| RepairedEvaluation::new(&Data::new(spec, precision), witness), RepairedEvaluation::truth)
}

/// Decides exact regulation for a claimed set; with the precision used.
#[must_use]
pub fn decide_exact(
    spec: &Specification,
    set: &ClaimedSet,
    witness: &ExactWitness,
    ladder: Ladder,
) -> (ExactEvaluation, u32) {
    ladder.climb(|precision| ExactEvaluation::new(&Data::new(spec, precision), set, witness), ExactEvaluation::truth)
}
