//! Whether the cells of a certificate cover the box of the parameters, exactly (derivation, 13.2).

use super::cells::MAX_CELLS;
use rug::Rational;
use sigmastar_lang::spec::Parameters;

/// The ends of a box, one pair for each parameter.
type Ends = Vec<[Rational; 2]>;

fn ends(parameters: &Parameters) -> Ends {
    parameters.intervals().map(|interval| [interval.low.clone(), interval.high.clone()]).collect()
}

/// Whether every point of the box lies in a cell. Cells of no volume, more than [`MAX_CELLS`], and cells of other parameters never do.
pub(super) fn covers(cells: &[Parameters], parameters: &Parameters) -> bool {
    let whole = ends(parameters);
    let cells: Vec<Ends> = cells.iter().map(ends).collect();
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

#[cfg(test)]
mod tests {
    use super::*;

    fn ends(sides: &[[i32; 2]]) -> Ends {
        sides.iter().map(|side| side.map(Rational::from)).collect()
    }

    fn all_but(left_out: Option<usize>, cells: &[&[[i32; 2]]]) -> bool {
        let cells: Vec<Ends> = cells.iter().map(|cell| ends(cell)).collect();
        let kept = cells.iter().enumerate().filter(|(i, _)| Some(*i) != left_out).map(|(_, cell)| cell);
        is_covered(&ends(&[[0, 4], [0, 4]]), &kept.collect::<Vec<_>>())
    }

    /// Five boxes like a pinwheel, and each of them counts; overlaps, repeated and larger boxes do no harm.
    #[test]
    fn the_box_is_covered_or_not() {
        let wheel: [&[[i32; 2]]; 5] =
            [&[[0, 3], [0, 1]], &[[3, 4], [0, 3]], &[[1, 4], [3, 4]], &[[0, 1], [1, 4]], &[[1, 3], [1, 3]]];
        assert!(all_but(None, &wheel));
        assert!((0..5).all(|left_out| !all_but(Some(left_out), &wheel)));
        let twice = [wheel, wheel].concat();
        assert!((0..10).all(|left_out| all_but(Some(left_out), &twice)));
        assert!(all_but(None, &[&[[-1, 3], [-1, 9]], &[[2, 5], [0, 4]]]));
        assert!(!all_but(None, &[&[[-1, 3], [-1, 9]], &[[2, 5], [1, 4]]]));
        assert!(!all_but(None, &[]));
        // Without parameters there is one member.
        assert!(is_covered(&Vec::new(), &[&Vec::new()]) && !is_covered(&Vec::new(), &[]));
    }
}
