//! Room in the error box for what noise and a disturbance add to the error (derivation, 13.6).
//!
//! The box of a search is as small as C4 allows, and its bounds are best. With the same weights C4 holds in every larger box, where C5 has
//! worse bounds.

use super::bounding::prove_up_to;
use super::certification::Certification;
use super::constants::Columns;
use super::decide::decide;
use super::matrix_checks::MatrixChecks;
use super::no_plant::no_plant;
use super::proof::{Outcome, SharpProof};
use super::rates::for_n_o;
use super::round::LONG_DIGITS;
use crate::rate::bound::RateForCount;
use crate::rate::noise::NoNoiseBound;
use rug::Rational;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::sharp::SharpWitness;

/// Larger boxes that are tried one after the other.
const WIDENINGS: usize = 4;

/// By so much a box is larger than the bounds of a smaller one ask for: its own are worse.
const WIDER: f64 = 1.05;

impl Certification<'_> {
    /// Where the error box has no room for what noise and a disturbance add, a larger one is taken if the claim is proved with it, and more
    /// of the bounds under noise are.
    pub(super) fn make_room(&mut self, counts: &[u32]) {
        let mut factor = 1.0;
        let mut missing = needed(&self.for_n_o);
        let mut best: Option<(SharpProof, Vec<RateForCount>)> = None;
        for _ in 0..WIDENINGS {
            // For all that are missing if that can be had, for some of them else.
            let found = missing.iter().rev().find_map(|needed| {
                let factor = factor * needed * WIDER;
                Some((factor, self.widened(factor)?))
            });
            let Some((wider, proof)) = found else { break };
            let found = for_n_o(self.spec, &proof, counts);
            (factor, missing) = (wider, needed(&found));
            let known = best.as_ref().map_or(&self.for_n_o, |(_, found)| found);
            if proved(&found) > proved(known) {
                best = Some((proof, found));
            }
        }
        if let Some((proof, found)) = best {
            self.rest_on(proof);
            self.for_n_o = found;
        }
    }

    /// The claim with an error box so many times as large; `None` where it is not proved.
    fn widened(&self, factor: f64) -> Option<SharpProof> {
        let witness = &self.sharp.proved()?.witness;
        let wider = |radius: &Rational| round_f64(radius.to_f64() * factor, LONG_DIGITS, Direction::Up);
        let witness = SharpWitness { d_x: wider(&witness.d_x)?, d_e: wider(&witness.d_e)?, ..witness.clone() };
        let proof = decide(self.spec, witness, self.options.ladder);
        let proved = |proof: &SharpProof| {
            let [x, e] = proof.decided().reach()?;
            let known = self.spec.domain.is_some() || prove_up_to(self.spec, &x, &e).is_ok();
            Some(known && !MatrixChecks::new(self.spec, Some(proof), None).disagree())
        };
        (proof.truth().is_true() && proved(&proof) == Some(true)).then_some(proof)
    }

    /// Puts another proof of the same claim in the place of its own, with the figures that depend on it.
    fn rest_on(&mut self, proof: SharpProof) {
        let reach = proof.decided().reach();
        let (sharp, repaired) = (Outcome::Proved(Box::new(proof)), self.repaired.take());
        self.checks = MatrixChecks::new(self.spec, sharp.proved(), repaired.as_ref().and_then(Outcome::proved));
        let columns = Columns { sharp, repaired, printed: &self.printed, exact: self.exact.as_ref() };
        let start = self.options.ladder.start.max(53);
        let (Columns { sharp, repaired, .. }, constants) = columns.evaluated(self.spec, start, self.options.ladder);
        self.no_plant = no_plant(&Data::new(self.spec, start), reach.as_ref().filter(|_| self.spec.domain.is_none()));
        (self.sharp, self.repaired) = (sharp, repaired);
        (self.constants, self.precision) = (constants.rows, constants.precision);
    }
}

/// How much larger the box would have to be for the bounds that are missing, in rising order.
fn needed(found: &[RateForCount]) -> Vec<f64> {
    let one = |found: &RateForCount| match found.noise {
        Some(Err(NoNoiseBound::LeavesBox { needed, .. })) if needed.is_finite() => Some(needed),
        _ => None,
    };
    let mut all: Vec<f64> = found.iter().filter_map(one).collect();
    all.sort_by(f64::total_cmp);
    all
}

/// How many bounds under noise are proved.
fn proved(found: &[RateForCount]) -> usize {
    found.iter().filter(|found| matches!(found.noise, Some(Ok(_)))).count()
}
