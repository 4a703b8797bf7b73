//! What is said about the trials.

use super::claim::Claim;
use super::finding::{Falsification, Finding};
use crate::number::{Direction, round_f64, write_exact};
use crate::report::document::{Block, Readable, Table, clean};
use serde_json::{Value, json};

/// The report on the trials of a certificate, and of those at other base frequencies.
pub struct FalsificationReport<'r> {
    /// The claims that were tried, the certificate's own first.
    pub tried: &'r [(Claim, Falsification)],
}

impl Readable for FalsificationReport<'_> {
    fn blocks(&self) -> Vec<Block> {
        self.tried.iter().flat_map(|(claim, outcome)| blocks(claim, outcome)).collect()
    }

    /// As JSON: `{"format": "sigmastar/falsification", "version": 1, ...}`, with the reports on other base frequencies in
    /// a field of their own.
    fn json(&self) -> Value {
        let mut reports = self.tried.iter().map(|(claim, outcome)| json(claim, outcome));
        let mut first = reports.next().unwrap_or_default();
        let others: Vec<Value> = reports.collect();
        if !others.is_empty() {
            first["other_base_frequencies"] = others.into();
        }
        first
    }
}

fn blocks(claim: &Claim, outcome: &Falsification) -> Vec<Block> {
    let mut blocks = vec![Block::Title(format!("{}: falsification", clean(&claim.spec.name)))];
    let (mut held, mut unfinished) = (0, Vec::new());
    let mut largest: Vec<(&str, f64)> = Vec::new();
    for finding in &outcome.findings {
        match finding {
            Finding::Holds { shares } => {
                held += 1;
                for (quantity, share) in shares {
                    match largest.iter_mut().find(|(name, _)| name == quantity) {
                        Some((_, most)) => *most = most.max(*share),
                        None => largest.push((quantity, *share)),
                    }
                }
            }
            Finding::Unfinished(why) => unfinished.push(why.as_str()),
            Finding::Violated(..) => {}
        }
    }
    let violated = outcome.findings.len() - held - unfinished.len();
    blocks.push(Block::says(format!(
        "{} trials at 1.000001 sigma*, sigma* = {}, base frequency {}, seed {}: in {held} every bound holds, in {violated} one \
         does not, {} could not be finished. Floating point: what is found can be simulated again, what is not found is no \
         proof.",
        outcome.settings.trials,
        round_f64(claim.sigma, 9, Direction::Nearest).map_or_else(|| claim.sigma.to_string(), |sigma| write_exact(&sigma)),
        claim.spec.internal_model.base_frequency.text,
        outcome.settings.seed,
        unfinished.len()
    )));
    if let Some((trial, violation)) = outcome.counterexample() {
        blocks.push(Block::heading("Counterexample"));
        blocks.push(Block::says(format!(
            "Trial {}, n_o = {}: {} is {:.6e}, the claim says at most {:.6e}.",
            trial.number, trial.n_o, violation.quantity, violation.found, violation.bound
        )));
    }
    if !largest.is_empty() {
        blocks.push(Block::heading("How much of each bound was used, at most"));
        let mut table = Table::new(&["<quantity", "found/bound"]);
        largest.iter().for_each(|(quantity, share)| table.push([(*quantity).to_owned(), format!("{share:.3}")]));
        blocks.push(Block::Table(table));
    }
    unfinished.sort_unstable();
    unfinished.dedup();
    if !unfinished.is_empty() {
        blocks.push(Block::heading("Not finished"));
        blocks.push(Block::List(unfinished.into_iter().map(str::to_owned).collect()));
    }
    blocks
}

fn json(claim: &Claim, outcome: &Falsification) -> Value {
    let trials: Vec<Value> = outcome
        .findings
        .iter()
        .map(|finding| match finding {
            Finding::Holds { shares } => {
                let shares: Vec<Value> =
                    shares.iter().map(|(quantity, share)| json!({ "quantity": quantity, "share": share })).collect();
                json!({ "finding": "holds", "shares": shares })
            }
            Finding::Violated(trial, violation) => json!({
                "finding": "violated", "n_o": trial.n_o, "quantity": violation.quantity,
                "found": violation.found, "bound": violation.bound,
            }),
            Finding::Unfinished(why) => json!({ "finding": "unfinished", "reason": why }),
        })
        .collect();
    json!({
        "format": "sigmastar/falsification", "version": 1, "name": clean(&claim.spec.name), "sigma_star": claim.sigma,
        "base_frequency": claim.spec.internal_model.base_frequency.text,
        "seed": outcome.settings.seed, "trials": trials, "refuted": outcome.counterexample().is_some(),
    })
}
