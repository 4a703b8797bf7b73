//! What the printed chain says about the data.

use sigmastar_document::Block;
use sigmastar_document::number::{compact, estimate};
use sigmastar_prove::certify::Certification;

/// Why the printed derivation gives nothing, and the figure that its other conditions would give.
pub(super) fn section(run: &Certification<'_>, rechecked: bool) -> Vec<Block> {
    let printed = &run.printed;
    let mut items = Vec::new();
    match &printed.refutation {
        Some(reason) => items.push(format!("{reason}.")),
        None => items.push("P:eq:boundx_bounde_1 was not refuted at this precision.".to_owned()),
    }
    if let Some(sigma) = &printed.sigma {
        let factor = run.sharp.proved().map_or_else(String::new, |proof| {
            let factor = sigma.midpoint_f64() / proof.witness.sigma.to_f64();
            format!(", about {} times the sharp one", estimate(factor))
        });
        items.push(format!(
            "Without that condition, the other printed conditions would give sigma* = {}{factor}. This is no theorem: \
             several of the formulas are unsound.",
            compact(sigma)
        ));
    } else if let Some(evaluation) = &printed.evaluation {
        let reasons: Vec<String> = [("sigma_p*", &evaluation.sigma_p), ("sigma_a*", &evaluation.sigma_a)]
            .into_iter()
            .filter_map(|(name, value)| value.as_ref().err().map(|reason| format!("{name}: {reason}")))
            .collect();
        let reasons = if reasons.is_empty() { "their figures are not finite".to_owned() } else { reasons.join("; ") };
        items.push(format!("Without that condition, the other printed conditions give no sigma* either ({reasons})."));
    } else if rechecked {
        items
            .push("Its other conditions were not searched: the witness of a certificate was decided again.".to_owned());
    } else {
        items.push(
            "Without that condition, no free numbers were found that satisfy the other printed conditions either."
                .to_owned(),
        );
    }
    vec![Block::Aside("What the printed formulas say".to_owned()), Block::List(items)]
}
