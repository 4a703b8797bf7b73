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
use super::options::Ladder;
use super::proof::{Outcome, SharpProof};
use super::rates::{for_n_o, for_n_o_at_samples};
use super::round::LONG_DIGITS;
use super::sampled::{SampledCertification, recheck_sampled};
use crate::rate::bound::RateForCount;
use crate::rate::noise::NoNoiseBound;
use crate::rate::sampled::bound::SampledRateForCount;
use rug::Rational;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::sampled::SampledWitness;
use sigmastar_theory::derivation::sharp::SharpWitness;

/// Larger boxes that are tried one after the other.
const WIDENINGS: usize = 4;

/// By so much a box is larger than the bounds of a smaller one ask for: its own are worse.
const WIDER: f64 = 1.05;

impl Certification<'_> {
    /// Where the error box has no room for what noise and a disturbance add, a larger one is taken if the claim is proved with it, and more
    /// of the bounds under noise are.
    pub(super) fn make_room(&mut self, counts: &[u32]) {
        let bounds = |proof: &SharpProof| for_n_o(self.spec, proof, counts);
        let noise = |found: &RateForCount| found.noise.as_ref().map(|noise| noise.as_ref().err().copied());
        if let Some((proof, found)) = with_room(&self.for_n_o, |factor| self.widened(factor), bounds, noise) {
            self.rest_on(proof);
            self.for_n_o = found;
        }
    }

    /// The claim with an error box so many times as large; `None` where it is not proved.
    fn widened(&self, factor: f64) -> Option<SharpProof> {
        let witness = &self.sharp.proved()?.witness;
        let [d_x, d_e] = wider([&witness.d_x, &witness.d_e], factor)?;
        let witness = SharpWitness { d_x, d_e, ..witness.clone() };
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

impl SampledCertification<'_> {
    /// The same of a claim at samples.
    pub(super) fn make_room(&mut self, counts: &[u32]) {
        let bounds = |run: &SampledCertification<'_>| {
            run.claim().map_or_else(Vec::new, |proof| for_n_o_at_samples(self.spec, proof, counts))
        };
        let noise = |found: &SampledRateForCount| found.noise.as_ref().map(|noise| noise.as_ref().err().copied());
        if let Some((run, found)) = with_room(&self.for_n_o, |factor| self.widened(factor), bounds, noise) {
            let (outcome, no_plant) = (run.outcome, run.no_plant);
            (self.outcome, self.no_plant, self.for_n_o) = (outcome, no_plant, found);
        }
    }

    fn widened(&self, factor: f64) -> Option<SampledCertification<'_>> {
        let proof = self.claim()?;
        let [d_x, d_e] = wider([&proof.witness.d_x, &proof.witness.d_e], factor)?;
        let witness = SampledWitness { d_x, d_e, ..proof.witness.clone() };
        let ladder = Ladder { start: proof.precision, limit: proof.precision };
        recheck_sampled(self.spec, &witness, ladder).ok().filter(|run| run.claim().is_some())
    }
}

/// Radii so many times as large.
fn wider(radii: [&Rational; 2], factor: f64) -> Option<[Rational; 2]> {
    let [d_x, d_e] = radii.map(|radius| round_f64(radius.to_f64() * factor, LONG_DIGITS, Direction::Up));
    Some([d_x?, d_e?])
}

/// A claim with a larger error box with which more bounds under noise are proved than in `first`, and what is proved with it; `noise` says of an
/// entry whether it is about noise, and why there are no bounds where there are none.
fn with_room<P, F>(
    first: &[F],
    widened: impl Fn(f64) -> Option<P>,
    bounds: impl Fn(&P) -> Vec<F>,
    noise: impl Fn(&F) -> Option<Option<NoNoiseBound>>,
) -> Option<(P, Vec<F>)> {
    // How much larger the box would have to be for the bounds that are missing, in rising order.
    let needed = |found: &[F]| {
        let one = |found: &F| match noise(found) {
            Some(Some(NoNoiseBound::LeavesBox { needed, .. })) if needed.is_finite() => Some(needed),
            _ => None,
        };
        let mut all: Vec<f64> = found.iter().filter_map(one).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    let proved = |found: &[F]| found.iter().filter(|found| matches!(noise(found), Some(None))).count();
    let (mut factor, mut missing) = (1.0, needed(first));
    let mut best: Option<(P, Vec<F>)> = None;
    for _ in 0..WIDENINGS {
        // For all that are missing if that can be had, for some of them else.
        let found = missing.iter().rev().find_map(|needed| {
            let factor = factor * needed * WIDER;
            Some((factor, widened(factor)?))
        });
        let Some((larger, claim)) = found else { break };
        let found = bounds(&claim);
        (factor, missing) = (larger, needed(&found));
        if proved(&found) > best.as_ref().map_or_else(|| proved(first), |(_, known)| proved(known)) {
            best = Some((claim, found));
        }
    }
    best
}
