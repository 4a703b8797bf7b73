//! The decided conditions with both sides.

use serde_json::{Value, json};
use sigmastar_document::number::{estimate, margin, pair};
use sigmastar_document::{Block, Table};
use sigmastar_prove::certificate::conditions_json;
use sigmastar_prove::certify::Certification;
use sigmastar_theory::derivation::condition::Condition;

/// The conditions of the claim.
pub(super) fn section(run: &Certification<'_>) -> Vec<Block> {
    of("Conditions", run.conditions())
}

/// The table of any conditions.
pub(super) fn of(heading: &str, conditions: &[Condition]) -> Vec<Block> {
    if conditions.is_empty() {
        return Vec::new();
    }
    let mut table = Table::new(&["<", "left side", "<", "right side", "margin", "relative", "<"]);
    let mut legend = Vec::new();
    let mut previous = "";
    for condition in conditions {
        // Several conditions may share an identifier (the three of the set); the legend then follows their order.
        let id = if condition.id == previous { String::new() } else { condition.id.to_owned() };
        previous = condition.id;
        table.push([
            id,
            pair(&condition.lhs),
            format!("$`{}`$", condition.relation),
            pair(&condition.rhs),
            margin(&condition.margin()),
            estimate(condition.relative_margin()),
            condition.truth().to_string(),
        ]);
        legend.push((condition.id, format!("$`{}`$", condition.what)));
    }
    vec![
        Block::heading(heading),
        Block::says(
            "Both sides are enclosed, rounded outward; the margin is right minus left, rounded down; the relative margin \
             is an estimate. A margin near 0 is no weakness: at the smallest $`sigma`$ some conditions are just satisfied.",
        ),
        Block::Table(table),
        Block::facts(legend),
    ]
}

/// The conditions as in a certificate, with the truth of each.
pub(super) fn conditions_with_truth(conditions: &[Condition]) -> Value {
    let mut list = conditions_json(conditions);
    for (item, condition) in list.as_array_mut().into_iter().flatten().zip(conditions) {
        item["truth"] = json!(condition.truth().to_string());
    }
    list
}
