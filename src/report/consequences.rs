//! What a certified claim says about the regulated error, and the number of oscillators that a target needs.

use super::document::{Block, Table, clean};
use super::number::upper;
use crate::derivation::consequences::{MAX_OSCILLATORS, Psi};
use crate::derivation::targets::{Consequences, Target, TargetOutcome};

/// The section of the report.
pub(super) fn section(consequences: &Consequences) -> Vec<Block> {
    let mut blocks = vec![Block::heading("The regulated error"), Block::List(psi_items(consequences))];
    if consequences.matched {
        let mut table = Table::new(&["n_o", "rms(e) at most", "sup|e| at most"]);
        for (n_o, bounds) in &consequences.by_n_o {
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
    if !consequences.targets.is_empty() {
        blocks
            .push(Block::List(consequences.targets.iter().map(|(target, outcome)| answer(target, *outcome)).collect()));
    }
    blocks
}

fn psi_items(consequences: &Consequences) -> Vec<String> {
    let Psi { psi_1, psi_x, psi_2 } = &consequences.psi;
    let mut items = vec![
        format!("sup|e| <= psi_1/sigma with psi_1 = {}, for every n_o and mu", upper(psi_1)),
        format!("sup|x| <= psi_x/sigma with psi_x = {}, for every n_o and mu", upper(psi_x)),
    ];
    if consequences.matched {
        items.push(format!("the integral of e^2 over a period <= psi_2/(n_o + 1)^2 with psi_2 = {}", upper(psi_2)));
    }
    items
}

fn answer(target: &Target, outcome: TargetOutcome) -> String {
    let wanted = format!("{} <= {}", target.kind.name(), clean(&target.value.text));
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
