//! The certified error for several numbers of oscillators, and the number of oscillators that a target needs.

use super::consequences::{ErrorBounds, Excitation, Psi, error_bounds, smallest_n_o};
use crate::data::Data;
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
    /// It does not up to [`MAX_OSCILLATORS`](super::consequences::MAX_OSCILLATORS).
    NotReached,
    /// The base frequency is not asserted to be 2 pi / period, so no bound decreases with n_o.
    NotMatched,
}

/// Certified bounds of the periodic error.
#[derive(Clone, Debug)]
pub struct Consequences {
    /// psi_1, psi_x, psi_2.
    pub psi: Psi,
    /// Bounds for several n_o; empty unless the base frequency is matched.
    pub by_n_o: Vec<(u64, ErrorBounds)>,
    /// The answers to the targets.
    pub targets: Vec<(Target, TargetOutcome)>,
    /// Whether the base frequency is matched: only then is psi_2 a bound, and only then do bounds decrease with n_o.
    pub matched: bool,
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
        let matched = data.spec.internal_model.matched;
        let at = |n_o| error_bounds(data, excitation, sigma, e_per, n_o);
        let by_n_o = if matched { N_O.map(|n_o| (n_o, at(n_o))).to_vec() } else { Vec::new() };
        let answer = |target: &Target| {
            if !matched {
                return TargetOutcome::NotMatched;
            }
            let value = target.value.enclose(data.precision);
            let reached = match target.kind {
                TargetKind::Sup => smallest_n_o(&value, |n_o| at(n_o).sup),
                TargetKind::Rms => smallest_n_o(&value, |n_o| at(n_o).rms),
            };
            reached.map_or(TargetOutcome::NotReached, TargetOutcome::Reached)
        };
        let targets = targets.iter().map(|target| (target.clone(), answer(target))).collect();
        Consequences { psi: Psi::new(data, excitation), by_n_o, targets, matched }
    }
}
