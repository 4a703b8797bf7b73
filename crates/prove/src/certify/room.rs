//! Room in the error box for what noise and a disturbance add to the error (derivation, 13.6).
//!
//! The box of a search is as small as C4 allows, and its weights are best for C5. With a smaller weight of zeta the level is lower in the same
//! box, and with the same weights C4 holds in every larger box; of either C5 asks for a larger gain.

use super::certification::{Certification, ExactClaim};
use super::gain_row::ByCount;
use super::matrix_checks::MatrixChecks;
use super::options::Limits;
use super::outcome::Outcome;
use super::precision::refined;
use super::rates::{for_n_o, for_n_o_at_samples};
use super::round::LONG_DIGITS;
use super::sampled::{SampledCertification, recheck_sampled};
use crate::rate::found::ForCount;
use crate::rate::noise::NoNoiseBound;
use rug::Rational;
use sigmastar_decide::conditions::Ladder;
use sigmastar_decide::conditions::no_plant;
use sigmastar_decide::conditions::prove_up_to;
use sigmastar_decide::conditions::{SampledProof, SharpProof};
use sigmastar_decide::conditions::{decide, decide_exact};
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Document, Oscillators, Specification};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::initial_set::claimed_distances;
use sigmastar_theory::derivation::sampled::{SampledEvaluation, SampledWitness};
use sigmastar_theory::derivation::sharp::{SharpEvaluation, SharpWitness};
use sigmastar_theory::derivation::stability::level_condition;
use std::mem::replace;
use std::sync::OnceLock;

/// Proofs with more room that are tried one after the other.
const TRIES: usize = 4;

/// By so much the room is larger than what was found in a smaller one asks for, in turn: little where little is asked for, as the bounds of a plant
/// are proved hardly further than a claim needs them.
const MORE: [fn(f64) -> f64; 2] = [|needed| 1.0 + 1.25 * (needed - 1.0), |needed| 1.05 * needed];

impl Certification<'_> {
    /// Where the error box has no room for what noise and a disturbance add, another proof of the claim is taken that has, if more of the bounds
    /// under noise are proved with it.
    pub(super) fn make_room(&mut self, asked: &[Oscillators]) {
        let Some(own) = self.sharp.proved().filter(|_| may_be_replaced(&self.limits, self.by_count.as_ref())) else {
            return;
        };
        let known_with = |proof: &SharpProof| {
            let same_set = own.witness.set == proof.witness.set;
            self.by_count.as_ref().filter(|found| same_set && found.is_of_set())
        };
        let bounds = |proof: &SharpProof| for_n_o(self.spec, (proof, known_with(proof)), asked);
        let mut best = more_proved(&self.for_n_o, |factor| self.with_room(own, factor), bounds);
        let roomy = self.roomy.as_ref().and_then(|proof| self.proved_with(proof.witness.clone()));
        if let Some(roomy) = roomy {
            let first = bounds(&roomy);
            let other = more_proved(&first, |factor| self.with_room(&roomy, factor), bounds).unwrap_or((roomy, first));
            if count(&other.1) > best.as_ref().map_or_else(|| count(&self.for_n_o), |(_, known)| count(known)) {
                best = Some(other);
            }
        }
        if let Some((proof, found)) = best {
            let known = known_with(&proof).cloned();
            let before = replace(&mut self.by_count, known);
            self.rest_on(proof);
            self.for_n_o = found;
            if self.by_count.is_none() {
                self.count_again(before, asked);
            }
        }
    }

    /// Finds bounds by the number of oscillators again, of those of which there were some before another proof, and with them what is proved of these oscillators.
    fn count_again(&mut self, before: Option<ByCount>, asked: &[Oscillators]) {
        let Some((plant, oscillators)) = before.and_then(|before| again(self.spec, before)) else { return };
        self.set_counts(&plant, &oscillators);
        if let (Some(found), Some(proof)) = (&mut self.by_count, self.sharp.proved()) {
            found.checked = true;
            self.for_n_o = for_n_o(self.spec, (proof, self.by_count.as_ref()), asked);
        }
    }

    /// The claim with a box that is so many times as large against its level as that of a proof; `None` where it is not proved.
    fn with_room(&self, SharpProof { witness, evaluation, precision }: &SharpProof, factor: f64) -> Option<SharpProof> {
        let data = Data::new(self.spec, *precision);
        let periodic = [&evaluation.periodic.x_per, &evaluation.periodic.e_per, &evaluation.z];
        let distances = claimed_distances(&data, &witness.set, periodic);
        let level = |h: &Rational| {
            let numbers = [&witness.d_x, &witness.d_e, &witness.w_x, h].map(|value| data.rational(value));
            level_condition(&data, distances.each_ref(), numbers.each_ref()).0.upper_f64()
        };
        let (all, without) = (level(&witness.h), level(&Rational::new()));
        let share = (all / (factor * factor) - without) / (all - without);
        let scaled = |value: &Rational, by: f64| round_f64(value.to_f64() * by, LONG_DIGITS, Direction::Up);
        let lower = || {
            let h = scaled(&witness.h, share).filter(|h| *h > 0)?;
            self.proved_with(SharpWitness { h, ..witness.clone() })
        };
        let wider = || {
            let [d_x, d_e] = [&witness.d_x, &witness.d_e].map(|radius| scaled(radius, factor));
            self.proved_with(SharpWitness { d_x: d_x?, d_e: d_e?, ..witness.clone() })
        };
        lower().or_else(wider)
    }

    /// The claim with another witness, where it is proved and keeps to what was asked for.
    fn proved_with(&self, witness: SharpWitness) -> Option<SharpProof> {
        let proof = decide(self.spec, witness, self.options.ladder);
        if !proof.truth().is_true() {
            return None;
        }
        let SharpEvaluation { periodic, peak, control, .. } = &proof.evaluation;
        let [x, e] = proof.decided().reach()?;
        let bounded = self.spec.domain.is_some() || prove_up_to(self.spec, &x, &e).is_ok();
        let kept = self.limits.kept([&periodic.e_per, peak], control);
        (bounded && kept && !MatrixChecks::new(self.spec, Some(&proof)).disagree()).then_some(proof)
    }

    /// Puts another proof of the same claim in the place of its own, with the figures that depend on it.
    fn rest_on(&mut self, proof: SharpProof) {
        let reach = proof.decided().reach();
        // That claim is about the set, which may be another one now.
        let again = |claim: ExactClaim| {
            let evaluation = decide_exact(self.spec, &proof.witness.set, &claim.witness, self.options.ladder);
            evaluation.truth().is_true().then_some(ExactClaim { evaluation, ..claim })
        };
        self.exact = self.exact.take().and_then(again);
        self.checks = MatrixChecks::new(self.spec, Some(&proof));
        (self.sharp, self.precision) = refined(Outcome::Proved(Box::new(proof)), self.spec, self.options.ladder);
        self.constants = OnceLock::new();
        let start = self.options.ladder.start.max(53);
        self.no_plant = no_plant(&Data::new(self.spec, start), reach.as_ref().filter(|_| self.spec.domain.is_none()));
    }
}

impl SampledCertification<'_> {
    /// The same of a claim at samples, whose box alone is made larger.
    pub(super) fn make_room(&mut self, asked: &[Oscillators]) {
        let Some(own) = self.claim().filter(|_| may_be_replaced(&self.limits, self.by_count.as_ref())) else {
            return;
        };
        let known_with = |proof: &SampledProof| {
            let same_set = own.witness.set == proof.witness.set;
            self.by_count.as_ref().filter(|found| same_set && found.is_of_set())
        };
        let bounds = |run: &SampledCertification<'_>| {
            let of = |proof| for_n_o_at_samples(self.spec, (proof, known_with(proof)), asked);
            run.claim().map_or_else(Vec::new, of)
        };
        let mut best = more_proved(&self.for_n_o, |factor| self.widened(own, factor), bounds);
        if let Some((roomy, run)) = self.roomy.as_ref().and_then(|roomy| Some((roomy, self.widened(roomy, 1.0)?))) {
            let first = bounds(&run);
            let other = more_proved(&first, |factor| self.widened(roomy, factor), bounds).unwrap_or((run, first));
            if count(&other.1) > best.as_ref().map_or_else(|| count(&self.for_n_o), |(_, known)| count(known)) {
                best = Some(other);
            }
        }
        if let Some((run, found)) = best {
            let known = run.claim().and_then(known_with).cloned();
            (self.outcome, self.no_plant, self.for_n_o) = (run.outcome, run.no_plant, found);
            let before = replace(&mut self.by_count, known);
            if self.by_count.is_none() {
                self.count_again(before, asked);
            }
        }
    }

    /// The same of a claim at samples.
    fn count_again(&mut self, before: Option<ByCount>, asked: &[Oscillators]) {
        let Some((plant, oscillators)) = before.and_then(|before| again(self.spec, before)) else { return };
        self.set_counts(&plant, &oscillators);
        if let Some(found) = &mut self.by_count {
            found.checked = true;
        }
        if let Some(proof) = self.claim().filter(|_| self.by_count.is_some()) {
            self.for_n_o = for_n_o_at_samples(self.spec, (proof, self.by_count.as_ref()), asked);
        }
    }

    /// The claim with the error box of a proof, so many times as large, where it is proved and keeps to what was asked for.
    fn widened(&self, proof: &SampledProof, factor: f64) -> Option<SampledCertification<'_>> {
        let wider = |radius: &Rational| round_f64(radius.to_f64() * factor, LONG_DIGITS, Direction::Up);
        let [d_x, d_e] = [&proof.witness.d_x, &proof.witness.d_e].map(wider);
        let witness = SampledWitness { d_x: d_x?, d_e: d_e?, ..proof.witness.clone() };
        let ladder = Ladder { start: proof.precision, limit: proof.precision };
        let run = recheck_sampled(self.spec, &witness, ladder).ok()?;
        let SampledEvaluation { size, peak, control, .. } = &run.claim()?.evaluation;
        self.limits.kept([&size.e_per, peak], control).then_some(run)
    }
}

/// Whether a claim may rest on another proof, which keeps to the same limits: by trials other bounds would follow then than those that limits are judged by.
fn may_be_replaced(limits: &Limits, by_count: Option<&ByCount>) -> bool {
    let is_judged = limits.by_count.is_some() && limits.bounds_anything();
    !is_judged || by_count.is_none_or(ByCount::is_of_set)
}

/// The plant of a specification, and the oscillators of which there were bounds that an independent checker decides; `None` without a plant, and where it
/// does not decide them.
fn again(spec: &Specification, before: ByCount) -> Option<(Plant, Vec<Oscillators>)> {
    let plant = before.checked.then(|| plant_of(spec))??;
    Some((plant, before.counts.into_iter().map(|bounds| bounds.oscillators).collect()))
}

/// The plant that a specification is made of, read from the copy of it that a certificate has.
pub(crate) fn plant_of(spec: &Specification) -> Option<Plant> {
    spec.plant()?;
    let document = Document::parse("the plant", &spec.document.to_string()).ok()?;
    Plant::from_value(&document.root()).ok()
}

/// For how many numbers of oscillators and sets something is proved of noise.
fn count<P, Q>(found: &[ForCount<P, Q>]) -> usize {
    found.iter().filter_map(ForCount::proved_noise).count()
}

/// A proof with more room with which more bounds under noise are proved than are in `first`, and what is proved with it.
fn more_proved<C, P, Q>(
    first: &[ForCount<P, Q>],
    with_room: impl Fn(f64) -> Option<C>,
    bounds: impl Fn(&C) -> Vec<ForCount<P, Q>>,
) -> Option<(C, Vec<ForCount<P, Q>>)> {
    // How much larger the box would have to be for the bounds that are missing, in rising order.
    let needed = |found: &[ForCount<P, Q>]| {
        let one = |found: &ForCount<P, Q>| match found.noise {
            Some(Err(NoNoiseBound::LeavesBox { needed, .. })) if needed.is_finite() => Some(needed),
            _ => None,
        };
        let mut all: Vec<f64> = found.iter().filter_map(one).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    let (mut factor, mut missing) = (1.0, needed(first));
    let mut best: Option<(C, Vec<ForCount<P, Q>>)> = None;
    for _ in 0..TRIES {
        // For all that are missing if that can be had, for some of them else.
        let found = missing.iter().rev().find_map(|needed| {
            MORE.iter().find_map(|more| {
                let factor = factor * more(*needed);
                Some((factor, with_room(factor)?))
            })
        });
        let Some((larger, claim)) = found else { break };
        let found = bounds(&claim);
        (factor, missing) = (larger, needed(&found));
        if count(&found) > best.as_ref().map_or_else(|| count(first), |(_, known)| count(known)) {
            best = Some((claim, found));
        }
    }
    best
}
