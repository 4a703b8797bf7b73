//! What binds sigma*, and which datum would lower it most.

use super::document::{Block, Table};
use super::number::estimate;
use crate::certify::{Certification, Derivation, Verdict};

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
        for (datum, gain) in shown {
            table.push([datum.name().to_owned(), format!("{} %", estimate(100.0 * gain))]);
        }
        blocks.push(Block::Table(table));
    }
    blocks
}
