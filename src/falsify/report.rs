//! What is said about the trials, and the counterexample as a plant file.

use super::claim::Claim;
use super::trial::{Finding, Outcome, Trial, Violation};
use crate::number::{Direction, round_f64, write_exact};
use crate::plant;
use crate::report::blocks::{Block, Table, clean};
use crate::spec::{Document, SpecErrors};
use serde_json::{Value, json as object};

/// The `format` of the JSON report.
pub const FORMAT: &str = "sigmastar/falsification";
/// Its version.
pub const VERSION: u64 = 1;

/// The plant of a trial as a plant file with its initial condition, as a document.
///
/// # Errors
/// None is known: the text is made here.
pub fn counterexample_plant(
    claim: &Claim,
    trial: &Trial,
    violation: Option<&Violation>,
) -> Result<Document, SpecErrors> {
    let (f, q) = trial.plant.family.texts();
    let states = f.len();
    let names: Vec<String> = (1..=states).map(|i| format!("x{i}")).collect();
    let (x, rest) = trial.start.split_at(states);
    let (e, z) = rest.split_first().map_or((0.0, &[][..]), |(e, z)| (*e, z));
    let description = violation.map_or_else(String::new, |violation| {
        format!(
            "Counterexample: {} is {} where at most {} is claimed. Simulate it with --sigma {:?} --n-o {}.",
            violation.quantity, violation.found, violation.bound, trial.sigma, trial.n_o
        )
    });
    let file = object!({
        "format": plant::FORMAT, "version": 1,
        "name": format!("Trial {} for {}", trial.number, clean(&claim.spec.name)),
        "description": description,
        "period": claim.spec.period.text,
        "states": names, "f": f, "q": q,
        "initial": { "x": x, "e": e, "z": z },
        "internal_model": claim.spec.document["internal_model"],
    });
    Document::parse("trial", &format!("{file:#}\n"))
}

/// The report as plain text.
#[must_use]
pub fn text(claim: &Claim, outcome: &Outcome) -> String {
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
        blocks.push(Block::Heading("Counterexample".to_owned()));
        blocks.push(Block::says(format!(
            "Trial {}, n_o = {}: {} is {:.6e}, the claim says at most {:.6e}.",
            trial.number, trial.n_o, violation.quantity, violation.found, violation.bound
        )));
    }
    if !largest.is_empty() {
        blocks.push(Block::Heading("How much of each bound was used, at most".to_owned()));
        let mut table = Table::new(&["<quantity", "found/bound"]);
        largest.iter().for_each(|(quantity, share)| table.push([(*quantity).to_owned(), format!("{share:.3}")]));
        blocks.push(Block::Table(table));
    }
    unfinished.sort_unstable();
    unfinished.dedup();
    if !unfinished.is_empty() {
        blocks.push(Block::Heading("Not finished".to_owned()));
        blocks.push(Block::List(unfinished.into_iter().map(str::to_owned).collect()));
    }
    crate::report::text(&blocks)
}

/// The report as JSON.
#[must_use]
pub fn json(claim: &Claim, outcome: &Outcome) -> Value {
    let trials: Vec<Value> = outcome
        .findings
        .iter()
        .map(|finding| match finding {
            Finding::Holds { shares } => {
                let shares: Vec<Value> =
                    shares.iter().map(|(quantity, share)| object!({ "quantity": quantity, "share": share })).collect();
                object!({ "finding": "holds", "shares": shares })
            }
            Finding::Violated(trial, violation) => object!({
                "finding": "violated", "n_o": trial.n_o, "quantity": violation.quantity,
                "found": violation.found, "bound": violation.bound,
            }),
            Finding::Unfinished(why) => object!({ "finding": "unfinished", "reason": why }),
        })
        .collect();
    object!({
        "format": FORMAT, "version": VERSION, "name": clean(&claim.spec.name), "sigma_star": claim.sigma,
        "base_frequency": claim.spec.internal_model.base_frequency.text,
        "seed": outcome.settings.seed, "trials": trials, "refuted": outcome.counterexample().is_some(),
    })
}
