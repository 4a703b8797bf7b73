//! The formulas of each bound.

use super::chart::Active;
use sigmastar_lang::expr::{Formula, Formulas, PlantVariable, Walk};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::Bound;
use sigmastar_theory::evidence::Part;

/// The matrix `A (plain + sum_l along_l x_0'_l) B` of which a bound speaks; A is the inverse of L or 1, B is L or 1.
#[derive(Clone, Debug)]
pub(super) struct Quantity {
    pub(super) walk: Walk,
    /// Rows of outputs of the walk.
    pub(super) plain: Vec<Vec<usize>>,
    /// Rows of outputs that are multiplied with x_0'_1, x_0'_2, ...; those that are 0 are left out.
    pub(super) along: Vec<Vec<Vec<(usize, usize)>>>,
    /// Whether the inverse of L stands on the left.
    pub(super) inverse: bool,
    /// What stands on the right.
    pub(super) right: Right,
    /// The variables that matter.
    pub(super) active: Active,
}

/// The factor on the right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Right {
    /// 1.
    One,
    /// L.
    Matrix,
    /// L for each of the two indices that the columns stand for.
    Pair,
}

impl Quantity {
    /// The formulas of a bound, from those of f and q; `None` where it is not computed of a plant. `moves` says whether P depends
    /// on t.
    pub(super) fn new(
        plant: &Plant,
        formulas: &mut Formulas,
        f: &[Formula],
        q: Formula,
        kind: Bound,
        moves: bool,
    ) -> Option<Quantity> {
        let order = f.len();
        let in_time = |formulas: &mut Formulas, of: &[Formula]| plant.derivatives_in_time(formulas, of);
        let states: Vec<PlantVariable> = (0..order).map(PlantVariable::State).collect();
        let columns = |formulas: &mut Formulas, of: &[Formula]| -> Vec<Vec<Formula>> {
            let columns: Vec<Vec<Formula>> = states.iter().map(|x| formulas.derivatives(of, *x)).collect();
            (0..of.len()).map(|row| columns.iter().map(|column| column[row]).collect()).collect()
        };
        let (plain, along) = match kind {
            Bound::F | Bound::QRms | Bound::QtRms => return None,
            Bound::Fx | Bound::Rate | Bound::RateExistence => (columns(formulas, f), Vec::new()),
            Bound::Fe => {
                let column = formulas.derivatives(f, PlantVariable::Error);
                (column.into_iter().map(|entry| vec![entry]).collect(), Vec::new())
            }
            Bound::Qx => (columns(formulas, &[q]), Vec::new()),
            Bound::Q => (vec![vec![q]], Vec::new()),
            Bound::Qt => {
                let gradient = columns(formulas, &[q]).concat();
                (vec![in_time(formulas, &[q])], vec![vec![gradient]])
            }
            Bound::Fxx => {
                let jacobian = columns(formulas, f).concat();
                let rows = columns(formulas, &jacobian);
                (rows.chunks(order.max(1)).map(<[Vec<Formula>]>::concat).collect(), Vec::new())
            }
            Bound::Fex => {
                let column = formulas.derivatives(f, PlantVariable::Error);
                (columns(formulas, &column), Vec::new())
            }
            Bound::Qe | Bound::QeMax => (vec![formulas.derivatives(&[q], PlantVariable::Error)], Vec::new()),
            Bound::Qtx => {
                let gradient = columns(formulas, &[q]).concat();
                let plain = in_time(formulas, &gradient);
                let along = columns(formulas, &gradient);
                (vec![plain], vec![along])
            }
            Bound::Qte => {
                let slope = formulas.derivatives(&[q], PlantVariable::Error);
                let plain = in_time(formulas, &slope);
                let along = columns(formulas, &slope);
                (vec![plain], vec![along])
            }
        };
        let mut outputs: Vec<Formula> = Vec::new();
        let mut output = |formula: Formula| {
            outputs.push(formula);
            outputs.len() - 1
        };
        let plain: Vec<Vec<usize>> = plain.iter().map(|row| row.iter().map(|entry| output(*entry)).collect()).collect();
        let along: Vec<Vec<Vec<(usize, usize)>>> = along
            .iter()
            .map(|row| {
                let entry = |terms: &Vec<Formula>| {
                    let kept = terms.iter().enumerate().filter(|(_, term)| !formulas.is_zero(**term));
                    kept.map(|(state, term)| (output(*term), state)).collect()
                };
                row.iter().map(entry).collect()
            })
            .collect();
        let walk = formulas.walk(&outputs);
        let mut active = Active::of(&walk);
        active.time |= moves && kind.is_rate();
        let inverse =
            matches!(kind, Bound::Fx | Bound::Fe | Bound::Rate | Bound::RateExistence | Bound::Fxx | Bound::Fex);
        let right = match kind {
            Bound::Fx | Bound::Qx | Bound::Qtx | Bound::Rate | Bound::RateExistence | Bound::Fex => Right::Matrix,
            Bound::Fxx => Right::Pair,
            _ => Right::One,
        };
        let mut quantity = Quantity { walk, plain, along, inverse, right, active };
        quantity.active.time |= quantity.is_carried();
        Some(quantity)
    }

    /// First derivatives, by the formulas themselves.
    pub(super) fn first_derivatives(formulas: &mut Formulas, sides: &[Formula], part: Part, moves: bool) -> Quantity {
        let order = sides.len() - 1;
        let states = (0..order).filter(|_| part != Part::Error).map(PlantVariable::State);
        let variables = states.chain((part != Part::States).then_some(PlantVariable::Error));
        let columns: Vec<Vec<Formula>> = variables.map(|variable| formulas.derivatives(sides, variable)).collect();
        let outputs: Vec<Formula> = (0..=order).flat_map(|row| columns.iter().map(move |column| column[row])).collect();
        let walk = formulas.walk(&outputs);
        let mut active = Active::of(&walk);
        active.time |= moves;
        let row = |row: usize| (0..columns.len()).map(|column| row * columns.len() + column).collect();
        let plain = (0..=order).map(row).collect();
        Quantity { walk, plain, along: Vec::new(), inverse: false, right: Right::One, active }
    }

    /// Whether it goes with the velocity x_0'.
    pub(super) fn is_carried(&self) -> bool {
        self.along.iter().flatten().any(|terms| !terms.is_empty())
    }
}
