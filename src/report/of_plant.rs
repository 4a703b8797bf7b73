//! What was proved from a plant's formulas: the orbit, the coordinates, the values of the bounds.

use super::document::{Block, Table};
use super::number::exact;
use crate::certify::claimed_ball;
use crate::derivation::sharp::ClaimedSet;
use crate::number::{Direction, write_exact};
use crate::spec::model::Lyapunov;
use crate::spec::{OfPlant, ProvedValue, Specification};
use rug::Rational;
use serde_json::{Value, json};

/// The section; nothing where the data are those of a specification.
pub(super) fn section(spec: &Specification, set: Option<&ClaimedSet>) -> Vec<Block> {
    let Some(plant) = spec.plant() else { return Vec::new() };
    let mut blocks = vec![Block::heading("From the plant's formulas")];
    if plant.states() > 0 {
        blocks.push(Block::says(
            "x_0(t) is the T-periodic solution of x' = f(t,x,0), and y = L^-1 (x - x_0) are the coordinates in which all norms are \
             taken. Everything below is proved.",
        ));
        blocks.push(Block::facts(facts(plant, set)));
        blocks.push(matrix("L", &plant.coordinates));
    }
    blocks.push(Block::says("The bounds that the conditions use, for |y| <= X, |e| <= E and every t:"));
    let mut table = Table::new(&["<bound", "<of", "X", "E", "value"]);
    for ProvedValue { bound, x, e, value } in spec.bounds.proved_values().entries() {
        let [x, e] = [x, e].map(|end| exact(end, Direction::Down));
        let direction = if bound.is_nonincreasing() { Direction::Down } else { Direction::Up };
        table.push([bound.field().to_owned(), bound.of_what().to_owned(), x, e, exact(value, direction)]);
    }
    blocks.push(Block::Table(table));
    blocks
}

fn facts(plant: &OfPlant, set: Option<&ClaimedSet>) -> Vec<(&'static str, String)> {
    let up = |value: &Rational| exact(value, Direction::Up);
    let orbit = &plant.orbit;
    let mut facts = vec![
        (
            "orbit",
            format!(
                "a trigonometric polynomial with {} harmonics; |L^-1 (x_0 - xb)| <= {} (defect {}, tube {})",
                orbit.approximation.harmonics.len(),
                up(&orbit.radius),
                up(&orbit.defect),
                up(&orbit.tube)
            ),
        ),
        ("rate along it", format!("alpha = {}", plant.triple.alpha.text)),
    ];
    if !plant.matrix.harmonics.is_empty() {
        facts.push((
            "P(t)",
            format!(
                "{} harmonics, p_low = {}, p_up = {}",
                plant.matrix.harmonics.len(),
                plant.triple.p_low.text,
                plant.triple.p_up.text
            ),
        ));
    }
    if let Some((triple, _)) = plant.existence.as_deref() {
        let Lyapunov { p_low, p_up, alpha } = triple;
        facts.push(("P of existence", format!("alpha = {}, p_low = {}, p_up = {}", alpha.text, p_low.text, p_up.text)));
    }
    facts.push((
        "q(t, x_0, 0)",
        format!(
            "{} harmonics; the rest is at most {}, its derivative {}",
            plant.forcing.harmonics.len(),
            up(&plant.forcing.rest),
            up(&plant.forcing.rest_t)
        ),
    ));
    if let Some(ball) = set.and_then(|set| claimed_ball(plant, &set.x0)) {
        facts.push(("the initial set contains", format!("|x - x_0| <= {}", exact(&ball, Direction::Down))));
    }
    facts
}

fn matrix(name: &str, rows: &[Vec<Rational>]) -> Block {
    let row = |row: &Vec<Rational>| row.iter().map(write_exact).collect::<Vec<_>>().join(", ");
    let rows: Vec<String> = rows.iter().map(row).collect();
    Block::facts([(name.to_owned(), format!("[{}]", rows.join("; ")))])
}

/// The same as JSON; null where the data are those of a specification.
pub(super) fn plant_json(spec: &Specification, set: Option<&ClaimedSet>) -> Value {
    let Some(plant) = spec.plant() else { return Value::Null };
    let rows = |matrix: &[Vec<Rational>]| -> Vec<Vec<String>> {
        matrix.iter().map(|row| row.iter().map(write_exact).collect()).collect()
    };
    let ball = set.and_then(|set| claimed_ball(plant, &set.x0));
    let values: Vec<Value> = spec
        .bounds
        .proved_values()
        .entries()
        .iter()
        .map(|entry| {
            json!({
                "bound": entry.bound.field(), "X": write_exact(&entry.x), "E": write_exact(&entry.e),
                "value": write_exact(&entry.value),
            })
        })
        .collect();
    json!({
        "coordinates": rows(&plant.coordinates),
        "orbit": {
            "harmonics": plant.orbit.approximation.harmonics.len(), "defect": write_exact(&plant.orbit.defect),
            "tube": write_exact(&plant.orbit.tube), "radius": write_exact(&plant.orbit.radius),
        },
        "alpha": plant.triple.alpha.text, "ball": ball.as_ref().map(write_exact), "bounds": values,
    })
}
