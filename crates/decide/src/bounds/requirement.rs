//! What a right side has to meet to be smooth.

use super::chart::Active;
use sigmastar_lang::expr::{Demand, Formulas, PlantExpr, Walk};

/// One demand on a right side, ready to be decided.
#[derive(Debug)]
pub(super) struct Requirement {
    pub(super) index: usize,
    pub(super) part: String,
    pub(super) demand: Demand,
    pub(super) walk: Walk,
    pub(super) active: Active,
}

impl Requirement {
    pub(super) fn new(index: usize, expr: &PlantExpr, demand: Demand, formulas: &Formulas) -> Requirement {
        let walk = formulas.walk(&[demand.of]);
        let active = Active::of(&walk);
        let part = expr.text().get(demand.span.clone()).unwrap_or_default().to_owned();
        Requirement { index, part, demand, walk, active }
    }
}
