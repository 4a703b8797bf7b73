//! The matrix inequalities of a run: C5, C3 and R.

use rug::Rational;
use serde_json::{Value, json};
use sigmastar_document::number::{exact, pair};
use sigmastar_document::{Block, Table};
use sigmastar_exact::number::{Direction, Portable, round_f64, write_exact};
use sigmastar_prove::certify::{MatrixChecks, SylvesterCheck};
use sigmastar_prove::lmi::{CrossCheck, SigmaBothWays};

/// The solver's figure in as many digits as it gives on every machine.
fn solver_sigma(value: f64) -> String {
    round_f64(value, 5, Direction::Nearest).map_or_else(|| "nothing".to_owned(), |sigma| write_exact(&sigma))
}

/// The power of ten above a difference; the last digits of a solver are not the same on every machine.
fn order_of_magnitude(difference: f64) -> String {
    (-6..=0)
        .map(|k| 10f64.portable_powi(k))
        .find(|power| difference < *power)
        .map_or("unknown".to_owned(), |p| format!("{p:e}"))
}

/// C5 for the weights of the certificate, and with C4 for the best ones in its error box.
fn decay_items(check: &CrossCheck) -> [String; 2] {
    let proved = if check.multipliers.is_some() {
        "at $`sigma*`$ the matrix is proved positive definite, exactly, with the multipliers in the certificate"
    } else {
        "no multipliers were proved at $`sigma*`$; C5 rests on the closed form"
    };
    let fixed = format!(
        "C5: $`sigma`$ must exceed {} by the closed form (proved), {} by the semidefinite program (floating point); {}; {proved}.",
        pair(&check.fixed.closed_form),
        solver_sigma(check.fixed.solver_sigma),
        compared(&check.fixed, true)
    );
    let free = match &check.free {
        Ok(free) => format!(
            "$`sigma`$ must exceed {} by the semidefinite program (floating point), {} by the closed form there; {}",
            solver_sigma(free.solver_sigma),
            solver_sigma(free.closed_form.midpoint_f64()),
            compared(free, check.free_contradicts())
        ),
        Err(error) => format!("not worked out: {error}"),
    };
    [fixed, format!("C4 and C5 in the same error box, with the best $`w_x`$ and $`h`$ for it: {free}.")]
}

fn compared(figures: &SigmaBothWays, contradiction: bool) -> String {
    let verdict = match (&figures.remark, figures.agree()) {
        (_, true) => "they agree".to_owned(),
        (None, false) if contradiction => "they DISAGREE".to_owned(),
        (None, false) => "possible, though not the smallest $`sigma`$ for these".to_owned(),
        (Some(remark), false) => format!("the solver stopped early ({remark})"),
    };
    format!("{verdict}: the relative difference is below {}", order_of_magnitude(figures.relative_difference))
}

/// The section, with R of the repaired derivation where that is proved.
pub(super) fn section(checks: &MatrixChecks, sylvester: Option<&SylvesterCheck>) -> Vec<Block> {
    let mut items = Vec::new();
    match &checks.decay {
        Some(Ok(check)) => items.extend(decay_items(check)),
        Some(Err(error)) => items.push(format!("C5: not cross-checked by the semidefinite program: {error}.")),
        None => {}
    }
    items.extend(checks.contraction.as_ref().map(|check| {
        let [low, up] = &check.spectral_radius;
        // What the contraction in mean squares says beyond the claim; nothing asks for it.
        let unique = if *up < 1 {
            "below 1, so the periodic solution is the only one in its set"
        } else {
            "not proved to be below 1, so that the periodic solution is the only one in its set is not claimed (that all \
             solutions from the initial set tend to it is)"
        };
        let stein = match &check.stein {
            Some(_) => "; the diagonal Stein inequality $`D - M'DM > 0`$ is proved, exactly",
            None => "",
        };
        format!(
            "Contraction in mean squares (no condition needs it): the spectral radius of the matrix M of upper bounds \
             lies in [{}, {}], {unique}{stein}.",
            exact(low, Direction::Down),
            exact(up, Direction::Up)
        )
    }));
    let mut blocks = Vec::new();
    if !items.is_empty() || sylvester.is_some() {
        blocks.push(Block::heading("Matrix inequalities"));
    }
    if !items.is_empty() {
        blocks.push(Block::List(items));
    }
    if let Some(check) = sylvester {
        let verdict = if check.is_positive_definite() { "R is positive definite" } else { "nothing is proved of R" };
        blocks.push(Block::says(format!(
            "Sylvester's criterion for R of the repaired derivation, with entries rounded to its disadvantage; the minors are \
             computed exactly, and all are shown to four digits: {verdict}."
        )));
        let mut table = Table::new(&["<", "R", "", "", "leading minor"]);
        for (row, entries) in check.rows.iter().enumerate() {
            let shown = |value: &Rational| exact(value, Direction::Nearest);
            let minor = check.minors.get(row).map_or_else(|| "-".to_owned(), shown);
            let cells = entries.iter().map(shown);
            table.push(std::iter::once(format!("{}", row + 1)).chain(cells).chain([minor]));
        }
        blocks.push(Block::Table(table));
    }
    blocks
}

fn figures_json(figures: &SigmaBothWays) -> Value {
    json!({
        "solver_estimate": solver_sigma(figures.solver_sigma),
        "relative_difference_below": order_of_magnitude(figures.relative_difference),
        "agree": figures.agree(),
    })
}

/// The checks by matrices as JSON.
pub(super) fn checks_json(checks: &MatrixChecks, sylvester: Option<&SylvesterCheck>) -> Value {
    let list = |values: &[Rational]| Value::Array(values.iter().map(|value| json!(write_exact(value))).collect());
    let decay = checks.decay.as_ref().map(|decay| match decay {
        Ok(check) => {
            let mut fixed = figures_json(&check.fixed);
            fixed["closed_form"] = json!(check.fixed.closed_form.decimals());
            fixed["contradiction"] = json!(check.contradicts());
            fixed["proved_at_sigma_star"] = json!(check.multipliers.is_some());
            fixed["best_weights"] = match &check.free {
                Ok(figures) => figures_json(figures),
                Err(error) => json!({ "unavailable": error.to_string() }),
            };
            fixed
        }
        Err(error) => json!({ "unavailable": error.to_string() }),
    });
    let contraction = checks.contraction.as_ref().map(|check| {
        json!({
            "spectral_radius": list(&check.spectral_radius),
            "stein_diagonal": check.stein.as_deref().map(list),
        })
    });
    let sylvester = sylvester.map(|check| {
        json!({
            "R": Value::Array(check.rows.iter().map(|row| list(row)).collect()),
            "leading_minors": list(&check.minors),
            "positive_definite": check.is_positive_definite(),
        })
    });
    json!({ "C5": decay, "C3": contraction, "R": sylvester })
}
