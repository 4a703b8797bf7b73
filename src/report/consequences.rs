//! What a certified claim says about the regulated error, and the number of oscillators that a target needs.

use super::blocks::{Block, Table};
use super::number::upper;
use crate::certify::Certification;
use crate::data::Data;
use crate::derivation::consequences::{ErrorBounds, MAX_OSCILLATORS, Psi, error_bounds, smallest_n_o};
use crate::enclosure::Enclosure;
use crate::spec::Constant;

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
    /// It does not up to [`MAX_OSCILLATORS`].
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
    matched: bool,
}

impl Consequences {
    /// Evaluates the bounds; `None` without a certified claim.
    ///
    /// Guarantee: they hold for every sigma' >= sigma* and the stated n_o, along the periodic solution.
    #[must_use]
    pub fn new(run: &Certification<'_>, targets: &[Target]) -> Option<Consequences> {
        let claim = run.claim()?;
        let (excitation, [_, e_per, _], precision) = (claim.excitation, claim.periodic, claim.precision);
        let data = Data::new(run.spec, precision);
        let sigma = data.rational(claim.sigma);
        let matched = run.spec.internal_model.matched;
        let at = |n_o| error_bounds(&data, excitation, &sigma, e_per, n_o);
        let by_n_o = if matched { N_O.map(|n_o| (n_o, at(n_o))).to_vec() } else { Vec::new() };
        let answer = |target: &Target| {
            if !matched {
                return TargetOutcome::NotMatched;
            }
            let value = target.value.enclose(precision);
            let reached = match target.kind {
                TargetKind::Sup => smallest_n_o(&value, |n_o| at(n_o).sup),
                TargetKind::Rms => smallest_n_o(&value, |n_o| at(n_o).rms),
            };
            reached.map_or(TargetOutcome::NotReached, TargetOutcome::Reached)
        };
        let targets = targets.iter().map(|target| (target.clone(), answer(target))).collect();
        Some(Consequences { psi: Psi::new(&data, excitation), by_n_o, targets, matched })
    }

    /// The section of the report.
    pub(super) fn section(&self) -> Vec<Block> {
        let mut blocks = vec![Block::Heading("The regulated error".to_owned()), Block::List(self.psi_items())];
        if self.matched {
            let mut table = Table::new(&["n_o", "rms(e) at most", "sup|e| at most"]);
            for (n_o, bounds) in &self.by_n_o {
                table.push([n_o.to_string(), upper(&bounds.rms), upper(&bounds.sup)]);
            }
            blocks.push(Block::says(
                "Bounds of the error along the periodic solution, at sigma* and for every larger sigma, by the number of \
                 oscillators. They follow from the claim, are computed with enclosures, and have no independent check:",
            ));
            blocks.push(Block::Table(table));
        } else {
            blocks.push(Block::says(
                "The base frequency is not asserted to be 2 pi / period (`\"matched\": true`), so nothing is certified \
                 about how the error decreases with the number of oscillators.",
            ));
        }
        if !self.targets.is_empty() {
            blocks.push(Block::List(self.targets.iter().map(|(target, outcome)| answer(target, *outcome)).collect()));
        }
        blocks
    }

    fn psi_items(&self) -> Vec<String> {
        let Psi { psi_1, psi_x, psi_2 } = &self.psi;
        let mut items = vec![
            format!("sup|e| <= psi_1/sigma with psi_1 = {}, for every n_o and mu", upper(psi_1)),
            format!("sup|x| <= psi_x/sigma with psi_x = {}, for every n_o and mu", upper(psi_x)),
        ];
        if self.matched {
            items.push(format!("the integral of e^2 over a period <= psi_2/(n_o + 1)^2 with psi_2 = {}", upper(psi_2)));
        }
        items
    }
}

fn answer(target: &Target, outcome: TargetOutcome) -> String {
    let wanted = format!("{} <= {}", target.kind.name(), super::blocks::clean(&target.value.text));
    match outcome {
        TargetOutcome::Reached(n_o) => {
            format!("Target {wanted}: certified with n_o = {n_o} oscillators (the smallest number for these bounds)")
        }
        TargetOutcome::NotReached => {
            format!("Target {wanted}: not certified with any number of oscillators up to {MAX_OSCILLATORS}")
        }
        TargetOutcome::NotMatched => format!(
            "Target {wanted}: no number of oscillators certifies it, because the base frequency is not asserted to be \
             2 pi / period"
        ),
    }
}

/// An upper bound for JSON: the upper end with all its digits.
pub(super) fn full(value: &Enclosure) -> String {
    value.upper_decimal(crate::enclosure::DIGITS)
}
