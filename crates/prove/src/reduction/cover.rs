//! Whether the cells of a certificate cover the box of the parameters, exactly (derivation, 13.2).

use super::cells::MAX_CELLS;
use rug::Rational;
use sigmastar_lang::spec::{Parameters, ProvedCell};

/// The ends of a box, one pair for each parameter.
type Ends = Vec<[Rational; 2]>;

fn ends(parameters: &Parameters) -> Ends {
    parameters.intervals().map(|interval| [interval.low.clone(), interval.high.clone()]).collect()
}

/// Whether every point of the box lies in a cell. Cells of no volume, more than [`MAX_CELLS`], and cells of other parameters never do.
pub(super) fn covers(cells: &[ProvedCell], parameters: &Parameters) -> bool {
    let whole = ends(parameters);
    let cells: Vec<Ends> = cells.iter().map(|cell| ends(&cell.parameters)).collect();
    let is_box = |cell: &Ends| cell.len() == whole.len() && cell.iter().all(|[low, high]| low < high);
    cells.len() <= MAX_CELLS && cells.iter().all(is_box) && is_covered(&whole, &cells.iter().collect::<Vec<_>>())
}

/// As cells are closed, it is enough that the inside is covered. The first cell that meets it is cut off, and the parts beside it are left.
fn is_covered(whole: &Ends, cells: &[&Ends]) -> bool {
    let meets = |cell: &&Ends| cell.iter().zip(whole).all(|(cell, own)| cell[0] < own[1] && own[0] < cell[1]);
    let meeting: Vec<&Ends> = cells.iter().copied().filter(meets).collect();
    let Some((first, others)) = meeting.split_first() else { return false };
    let mut left = whole.clone();
    (0..whole.len()).all(|axis| {
        let [low, high] = &first[axis];
        let beside = |from: &Rational, to: &Rational, left: &Ends| {
            let mut part = left.clone();
            part[axis] = [from.clone(), to.clone()];
            from >= to || is_covered(&part, others)
        };
        let own = left[axis].clone();
        let covered = beside(&own[0], low, &left) && beside(high, &own[1], &left);
        left[axis] = [low.clone().max(own[0].clone()), high.clone().min(own[1].clone())];
        covered
    })
}
