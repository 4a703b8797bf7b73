//! What a claim says besides for given numbers of oscillators: how fast the error decays.

use serde_json::{Value, json};
use sigmastar_document::number::{estimate, exact};
use sigmastar_document::{Block, Table};
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_prove::certify::Certification;
use sigmastar_prove::rate::bound::{RateBound, RateForCount};
use sigmastar_prove::rate::small_gain::Limit;

/// The section; nothing where no number was asked about.
pub(super) fn section(run: &Certification<'_>) -> Vec<Block> {
    if run.for_n_o.is_empty() {
        return Vec::new();
    }
    let mut table = Table::new(&["n_o", "rate in 1/time", "factor in the unit of e", "limited by"]);
    for RateForCount { n_o, bound } in &run.for_n_o {
        table.push(match bound {
            None => [n_o.to_string(), "not proved".to_owned(), String::new(), String::new()],
            Some(RateBound { witness, factor, limit, .. }) => [
                n_o.to_string(),
                exact(&witness.rate, Direction::Down),
                exact(factor, Direction::Up),
                limited_by(*limit),
            ],
        });
    }
    let mut blocks = vec![
        Block::heading("For given numbers of oscillators"),
        Block::says(
            "For every start in the set |e(t) - e_per(t)| <= factor exp(-rate (t - t_0)): a part of the claim, for this n_o and this gain \
             alone, proved from the bounds on the error box, or from the derivatives there. The factor is for the whole set at once, and far above what most \
             starts need. What limits the rate is an estimate. `not proved` says nothing either way.",
        ),
        Block::Table(table),
    ];
    if run.matrix_arguments().is_some() && run.for_n_o.iter().any(|found| found.bound.is_none()) {
        blocks.push(Block::says(
            "The claim rests on a matrix inequality, and its rates on the first derivatives on the whole error box: where the loop would grow with \
             some of them that stay as they are, no rate is proved, although a solution does not stay there.",
        ));
    }
    blocks
}

fn limited_by(limit: Limit) -> String {
    match limit {
        Limit::Plant(rate) => format!("the plant: x decays at a_2 = {} in the error box", estimate(rate)),
        Limit::Oscillators(rate) => format!("the slowest mode of the loop, {}", estimate(rate)),
        Limit::Middle(rate) => {
            format!(
                "the slowest mode of the loop, {} in the middle of the derivatives, and how they vary",
                estimate(rate)
            )
        }
    }
}

/// The same as JSON; none where no number was asked about.
pub(super) fn rates_json(run: &Certification<'_>) -> Option<Value> {
    let one = |RateForCount { n_o, bound }: &RateForCount| match bound {
        None => json!({ "n_o": n_o, "rate": null, "factor": null, "limited_by": null }),
        Some(RateBound { witness, factor, limit, .. }) => json!({
            "n_o": n_o, "rate": write_exact(&witness.rate), "factor": write_exact(factor), "limited_by": limited_by(*limit),
        }),
    };
    (!run.for_n_o.is_empty()).then(|| run.for_n_o.iter().map(one).collect())
}
