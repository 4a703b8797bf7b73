//! The certified error for several numbers of oscillators, and the number of oscillators that a target needs.

use super::consequences::{ErrorBounds, Excitation, Psi, error_bounds, smallest_n_o};
use super::mistuned::Mistuning;
use crate::data::Data;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::Constant;

/// The numbers of oscillators in the table.
const N_O: [u64; 11] = [0, 1, 2, 3, 4, 5, 10, 20, 50, 100, 1000];

/// Which norm of the periodic error a target is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetKind {
    /// sup|e|.
    Sup,
    /// rms(e) over a period.
    Rms,
}

impl TargetKind {
    /// How reports write the norm.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            TargetKind::Sup => "sup|e|",
            TargetKind::Rms => "rms(e)",
        }
    }
}

/// A wanted bound of the periodic error.
#[derive(Clone, Debug)]
pub struct Target {
    /// The norm.
    pub kind: TargetKind,
    /// The bound, positive.
    pub value: Constant,
}

/// The answer to a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetOutcome {
    /// The certified bound reaches the target at this number of oscillators, and not below it.
    Reached(u64),
    /// One of the gain of the claim alone does at the first number; those that hold for every larger gain, too, do at the second one, if at any.
    ReachedAtGain(u64, Option<u64>),
    /// It does not up to [`MAX_OSCILLATORS`](super::consequences::MAX_OSCILLATORS).
    NotReached,
}

impl TargetOutcome {
    /// The answer of these bounds and of others, which are about the gain of the claim alone, as all of them may be.
    #[must_use]
    pub fn or_at_gain(self, own: Option<u64>, all_alone: bool) -> TargetOutcome {
        match (self, own) {
            (TargetOutcome::Reached(known), Some(own)) if own >= known => self,
            (_, Some(own)) if all_alone => TargetOutcome::Reached(own),
            (TargetOutcome::Reached(known), Some(own)) => TargetOutcome::ReachedAtGain(own, Some(known)),
            (TargetOutcome::NotReached, Some(own)) => TargetOutcome::ReachedAtGain(own, None),
            _ => self,
        }
    }
}

/// What oscillators are worth whose frequencies are not exactly those of the harmonics (derivation, 13.3).
#[derive(Clone, Debug)]
pub struct MistunedSummary {
    /// dm, an upper bound of `|Om/w - 1|`.
    pub largest: Enclosure,
    /// With more oscillators than these no bound falls.
    pub last_that_pays: u64,
    /// The smallest n_o from which on the bound of sup|e| falls by 1 % or less.
    pub enough: u64,
}

/// Certified bounds of the periodic error.
#[derive(Clone, Debug)]
pub struct Consequences {
    /// psi_1, psi_x, psi_2.
    pub psi: Psi,
    /// Bounds for several n_o.
    pub by_n_o: Vec<(u64, ErrorBounds)>,
    /// The answers to the targets.
    pub targets: Vec<(Target, TargetOutcome)>,
    /// What is said of oscillators away from a matched base frequency; only at one is psi_2 a bound.
    pub mistuned: Option<MistunedSummary>,
}

/// Bounds of the periodic error at samples.
#[derive(Clone, Debug)]
pub struct SampledConsequences {
    /// Bounds for several n_o, the largest one among them.
    pub by_n_o: Vec<(u64, ErrorBounds)>,
    /// The answers to the targets.
    pub targets: Vec<(Target, TargetOutcome)>,
    /// The largest n_o that the samples can tell apart.
    pub most: u64,
}

impl SampledConsequences {
    /// Answers from bounds for every number of oscillators from 0 on.
    ///
    /// Guarantee: the bound at the number of an answer is proved to be at most the target, and that at no smaller number is.
    #[must_use]
    pub fn new(bounds: &[ErrorBounds], precision: u32, targets: &[Target]) -> SampledConsequences {
        let most = bounds.len().saturating_sub(1) as u64;
        let all = (0_u64..).zip(bounds);
        let shown = |n_o: u64| N_O.contains(&n_o) || n_o == most;
        let by_n_o = all.clone().filter(|(n_o, _)| shown(*n_o)).map(|(n_o, bounds)| (n_o, bounds.clone())).collect();
        let answer = |target: &Target| {
            let value = target.value.enclose(precision);
            let of = |bounds: &ErrorBounds| match target.kind {
                TargetKind::Sup => bounds.sup.le(&value).is_true(),
                TargetKind::Rms => bounds.rms.le(&value).is_true(),
            };
            let reached = all.clone().find(|(_, bounds)| of(bounds));
            reached.map_or(TargetOutcome::NotReached, |(n_o, _)| TargetOutcome::Reached(n_o))
        };
        let targets = targets.iter().map(|target| (target.clone(), answer(target))).collect();
        SampledConsequences { by_n_o, targets, most }
    }
}

impl Consequences {
    /// Evaluates the bounds for the excitation of a proved witness at sigma, e_per a bound of sup|e|.
    ///
    /// Hypotheses: existence at sigma. Guarantee: the bounds hold for every sigma' >= sigma and the stated n_o, along the
    /// periodic solution.
    #[must_use]
    pub fn new(
        data: &Data<'_>,
        excitation: &Excitation,
        sigma: &Enclosure,
        e_per: &Enclosure,
        targets: &[Target],
    ) -> Consequences {
        let mistuning = Mistuning::new(data);
        let at = |n_o| error_bounds(data, excitation, mistuning.as_ref(), sigma, e_per, n_o);
        let by_n_o = N_O.map(|n_o| (n_o, at(n_o))).to_vec();
        let answer = |target: &Target| {
            let value = target.value.enclose(data.precision);
            let reached = match target.kind {
                TargetKind::Sup => smallest_n_o(&value, |n_o| at(n_o).sup),
                TargetKind::Rms => smallest_n_o(&value, |n_o| at(n_o).rms),
            };
            reached.map_or(TargetOutcome::NotReached, TargetOutcome::Reached)
        };
        let targets = targets.iter().map(|target| (target.clone(), answer(target))).collect();
        let mistuned = mistuning.as_ref().map(|mistuning| {
            let last_that_pays = mistuning.last_that_pays();
            let nearly = at(last_that_pays).sup * data.rational(&Rational::from((101, 100)));
            let enough = smallest_n_o(&nearly, |n_o| at(n_o).sup).unwrap_or(last_that_pays).min(last_that_pays);
            MistunedSummary { largest: mistuning.largest.clone(), last_that_pays, enough }
        });
        Consequences { psi: Psi::new(data, excitation), by_n_o, targets, mistuned }
    }
}
