//! A relative degree above 1: from the filtered error to the regulated output.

use serde_json::{Value, json};
use sigmastar_document::Block;
use sigmastar_document::number::{full, upper};
use sigmastar_prove::certify::Certification;

/// The gains of the filter e = xi_r + a_{r-1} xi_{r-1} + ... + a_1 xi_1; nothing where the specification has none.
pub(super) fn section(run: &Certification<'_>) -> Vec<Block> {
    let Some(gains) = &run.relative_degree else { return Vec::new() };
    let body = match gains {
        Ok(gains) => {
            let mut items = vec![
                format!("$`limsup|xi_1| <= k_inf limsup|e|`$ with $`k_inf = {}`$", upper(&gains.k_inf)),
                format!(
                    "in the steady state the integral of $`xi_1^2`$ over a period is at most $`k_2`$ times that of $`e^2`$ with \
                     $`k_2 = {}`$",
                    upper(&gains.k_2)
                ),
            ];
            if let Some([sup, rms]) = run.regulated_output(gains) {
                items.push(format!(
                    "so, for every $`n_o`${}, $`sup|xi_1| <= {}`$ and $`rms(xi_1) <= {}`$ along the \
                     periodic solution; the bounds of $`e`$ for a given $`n_o`$ carry over by the factors $`k_inf`$ and $`sqrt(k_2) = {}`$",
                    // With an actuator nothing is said of another gain.
                    if run.spec.actuator.is_some() { "" } else { " and every $`sigma`$ from $`sigma*`$ on" },
                    upper(&sup),
                    upper(&rms),
                    upper(&gains.k_2.sqrt())
                ));
            }
            Block::List(items)
        }
        Err(error) => Block::says(format!("No bound of $`xi_1`$: {error}.")),
    };
    vec![Block::heading("Relative degree (from e to xi_1)"), body]
}

/// The gains for JSON.
pub(super) fn gains_json(run: &Certification<'_>) -> Value {
    match &run.relative_degree {
        None => Value::Null,
        Some(Ok(gains)) => {
            let bounds = run.regulated_output(gains).map(|bounds| bounds.map(|bound| full(&bound)));
            let [sup, rms] = bounds.map_or([None, None], |[sup, rms]| [Some(sup), Some(rms)]);
            json!({ "k_inf": gains.k_inf.decimals(), "k_2": gains.k_2.decimals(), "sup_xi_1": sup, "rms_xi_1": rms })
        }
        Some(Err(error)) => json!({ "reason": error.to_string() }),
    }
}
