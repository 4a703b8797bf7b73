//! The matrix inequalities of a run: C5, C3 and R.

use super::blocks::{Block, Table};
use super::json::interval;
use super::number::{exact, pair};
use crate::certificate::{Certification, Derivation};
use crate::number::{Direction, round_f64, write_exact};
use rug::Rational;
use serde_json::{Value, json};

/// The solver's figure in as many digits as it gives on every machine.
fn solver_sigma(value: f64) -> String {
    round_f64(value, 5, Direction::Nearest).map_or_else(|| "nothing".to_owned(), |sigma| write_exact(&sigma))
}

/// The power of ten above a difference; the last digits of a solver are not the same on every machine.
fn order_of_magnitude(difference: f64) -> String {
    (-6..=0).map(|k| 10f64.powi(k)).find(|power| difference < *power).map_or("unknown".to_owned(), |p| format!("{p:e}"))
}

/// The section.
pub(super) fn section(run: &Certification<'_>) -> Vec<Block> {
    let checks = &run.checks;
    let mut items = Vec::new();
    if run.options.derivation == Derivation::Sharp {
        items.extend(checks.decay.as_ref().map(|decay| match decay {
            Ok(check) => {
                let verdict = if check.agrees() { "they agree" } else { "they DISAGREE" };
                let proved = if check.multipliers.is_some() {
                    "at sigma* the matrix is proved positive definite, exactly, with the multipliers in the certificate"
                } else {
                    "no multipliers were proved at sigma*; C5 rests on the closed form"
                };
                format!(
                    "C5: sigma must exceed {} by the closed form (proved), {} by the semidefinite program (floating point); \
                     {verdict}: the relative difference is below {}; {proved}.",
                    pair(&check.closed_form),
                    solver_sigma(check.solver_sigma),
                    order_of_magnitude(check.relative_difference)
                )
            }
            Err(error) => format!("C5: not cross-checked by the semidefinite program: {error}."),
        }));
        items.extend(checks.contraction.as_ref().map(|check| {
            let [low, up] = &check.spectral_radius;
            let stein = match &check.stein {
                Some(_) => "the diagonal Stein inequality D - M'DM > 0 is proved, exactly",
                None => "no diagonal D with D - M'DM > 0 was proved",
            };
            format!(
                "C3: the spectral radius of the matrix M of upper bounds lies in [{}, {}], by the weights p_x, p_e; {stein}.",
                exact(low, Direction::Down),
                exact(up, Direction::Up)
            )
        }));
    }
    let mut blocks = Vec::new();
    if !items.is_empty() || checks.sylvester.is_some() {
        blocks.push(Block::Heading("Matrix inequalities".to_owned()));
    }
    if !items.is_empty() {
        blocks.push(Block::List(items));
    }
    if let Some(check) = &checks.sylvester {
        let verdict = if check.is_positive_definite() { "R is positive definite" } else { "nothing is proved of R" };
        blocks.push(Block::says(format!(
            "Sylvester's criterion for R of the repaired derivation, with entries rounded to its disadvantage; the minors are \
             exact: {verdict}."
        )));
        let mut table = Table::new(&["<", "R", "", "", "leading minor"]);
        for (row, entries) in check.rows.iter().enumerate() {
            let minor = check.minors.get(row).map_or_else(|| "-".to_owned(), write_exact);
            let cells = entries.iter().map(write_exact);
            table.push(std::iter::once(format!("{}", row + 1)).chain(cells).chain([minor]));
        }
        blocks.push(Block::Table(table));
    }
    blocks
}

/// The same as JSON.
pub(super) fn checks_json(run: &Certification<'_>) -> Value {
    let checks = &run.checks;
    let list = |values: &[Rational]| Value::Array(values.iter().map(|value| json!(write_exact(value))).collect());
    let decay = checks.decay.as_ref().map(|decay| match decay {
        Ok(check) => json!({
            "closed_form": interval(&check.closed_form),
            "solver_estimate": solver_sigma(check.solver_sigma),
            "relative_difference_below": order_of_magnitude(check.relative_difference),
            "agree": check.agrees(),
            "proved_at_sigma_star": check.multipliers.is_some(),
        }),
        Err(error) => json!({ "unavailable": error.to_string() }),
    });
    let contraction = checks.contraction.as_ref().map(|check| {
        json!({
            "spectral_radius": list(&check.spectral_radius),
            "stein_diagonal": check.stein.as_deref().map(list),
        })
    });
    let sylvester = checks.sylvester.as_ref().map(|check| {
        json!({
            "R": Value::Array(check.rows.iter().map(|row| list(row)).collect()),
            "leading_minors": list(&check.minors),
            "positive_definite": check.is_positive_definite(),
        })
    });
    json!({ "C5": decay, "C3": contraction, "R": sylvester })
}
