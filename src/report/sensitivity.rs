//! What binds sigma*, and which datum would lower it most.

use super::document::{Block, Table};
use super::number::estimate;
use crate::certify::{Certification, Derivation, Verdict};
use crate::enclosure::Enclosure;
use crate::number::write_exact;
use crate::plot::Bars;
use rug::Rational;

/// The binding condition and the sensitivities of the sharp derivation.
pub(super) fn section(run: &Certification<'_>) -> Vec<Block> {
    if run.verdict != Verdict::Certified || run.options.derivation != Derivation::Sharp {
        return Vec::new();
    }
    let Some(binding) = run.binding else { return Vec::new() };
    let mut blocks = vec![
        Block::heading("What sets sigma* (estimates)"),
        Block::says(format!("sigma* is set by {}. {}", binding.describe(), binding.advice())),
    ];
    blocks.extend(ingredients(run).map(Block::Bars));
    if !run.without_optional.is_empty() {
        blocks.push(Block::says("What the optional data bring: sigma* without each."));
        let mut table = Table::new(&["<without", "sigma*"]);
        for (datum, sigma) in &run.without_optional {
            table.push([datum.field().to_owned(), sigma.map_or_else(|| "none found".to_owned(), estimate)]);
        }
        blocks.push(Block::Table(table));
    }
    let shown: Vec<_> = run.sensitivities.iter().filter(|(_, gain)| *gain >= 1e-6).collect();
    if let Some((datum, gain)) = shown.first() {
        blocks.push(Block::says(format!(
            "One per cent better {} lowers sigma* by about {} %, more than any other datum. Better means larger for \
             alpha and a rate, and smaller for the rest; floating point, re-optimised locally, not certified.",
            datum.name(),
            estimate(100.0 * gain)
        )));
        let mut table = Table::new(&["<1 % better", "lowers sigma* by"]);
        let mut bars = Bars { title: "By how much one per cent better lowers sigma*".to_owned(), entries: Vec::new() };
        for (datum, gain) in shown {
            let lowers = format!("{} %", estimate(100.0 * gain));
            bars.entries.push((datum.name().to_owned(), *gain, lowers.clone()));
            table.push([datum.name().to_owned(), lowers]);
        }
        blocks.push(Block::Table(table));
        blocks.push(Block::Bars(bars));
    }
    blocks
}

/// The two terms of the threshold of C5 beside sigma*. They are drawn from doubles and claim nothing.
fn ingredients(run: &Certification<'_>) -> Option<Bars> {
    let proof = run.sharp.proved()?;
    let decay = &proof.evaluation.decay;
    let [slope, all] = [&decay.by_slope, &decay.sigma_threshold].map(Enclosure::midpoint_f64);
    let term = |name: &str, value: f64| (name.to_owned(), value, estimate(value));
    let gain = |name: &str, sigma: &Rational| (name.to_owned(), sigma.to_f64(), write_exact(sigma));
    let mut entries = vec![
        term("C5: dq/de and the internal model's start", slope),
        term("C5: the loop through x", all - slope),
        gain("sigma*", &proof.witness.sigma),
    ];
    entries.extend(run.exact.as_ref().map(|claim| gain("sigma*_oo (n_o infinite)", &claim.witness.sigma)));
    Some(Bars { title: "sigma* and the two terms of C5 that it exceeds, in 1/time".to_owned(), entries })
}
