//! What serves every finite set of harmonics that contains 0, beside the pair for the first harmonics.

use serde_json::{Value, json};
use sigmastar_document::Block;
use sigmastar_document::number::upper;
use sigmastar_exact::number::write_exact;
use sigmastar_theory::transfer::{ForEverySet, SetPair, TransferStudy};

/// The section.
pub(super) fn section(study: &TransferStudy<'_>, sets: &ForEverySet) -> Vec<Block> {
    let (data, of_first) = (&study.data, &study.pair);
    let mut blocks = vec![Block::heading("Every set of harmonics")];
    match &sets.pair {
        Some(SetPair { k0, k1, proof }) => {
            blocks.push(Block::says(format!(
                "Proved: $`T_H(x) <= k0 + k1 x^2`$ with $`k0 = {}`$ and $`k1 = {}`$, for oscillators at every finite set $`H`$ of harmonics that contains \
                 0 and every $`x >= 0`$. For the first harmonics alone $`k1`$ is {} with this $`k0`$.",
                write_exact(k0),
                write_exact(k1),
                write_exact(&of_first.k1),
            )));
            blocks.push(Block::says(format!(
                "The proof: {} boxes over $`x`$ in [0, {}], once for all $`H`$, and one scalar test for $`x`$ beyond.",
                proof.boxes(),
                f64::from(proof.m0) - 0.5,
            )));
            if let Some(excess) = of_first.excess_of(data, k1) {
                blocks.push(Block::says(format!("$`k1`$ is at most {} % above the best.", upper(&(100 * excess)))));
            }
        }
        None => blocks.push(Block::says(
            "With this $`k0`$ no proof by boxes was found that serves every finite set $`H`$ of harmonics that contains 0: the scalar test or the boxes would \
             need more than they may. A larger $`k0`$ lets fewer boxes do.",
        )),
    }
    let (k0, k1) = &study.printed.repaired;
    blocks.push(Block::says(format!(
        "The closed form serves every set, too: $`k0 = {}`$, $`k1 = {}`$.",
        upper(k0),
        upper(k1)
    )));
    if let Some(serves) = sets.matched {
        let whether = if serves { "serves every set, too" } else { "is not proved to serve every set" };
        blocks.push(Block::says(format!("The pair for a matched base frequency, at integers $`x`$, {whether}.")));
    }
    blocks
}

/// The field `every_set`.
pub(super) fn json(study: &TransferStudy<'_>, sets: &ForEverySet) -> Value {
    let pair = sets.pair.as_ref().map(|SetPair { k0, k1, proof }| {
        let [kappa_0, kappa_1] = study.data.kappas(&study.data.rational(k0), &study.data.rational(k1));
        json!({
            "statement": "T_H(x) <= k0 + k1 x^2 for every finite set H of harmonics that contains 0 and every x >= 0",
            "k0": write_exact(k0), "k1": write_exact(k1),
            "kappa_0": kappa_0.decimals(), "kappa_1": kappa_1.decimals(),
            "excess": study.pair.excess_of(&study.data, k1).map(|excess| excess.upper_decimal(6)),
            "m0": proof.m0, "N0": proof.n0, "boxes": proof.boxes(),
        })
    });
    json!({ "pair": pair, "matched": sets.matched })
}
