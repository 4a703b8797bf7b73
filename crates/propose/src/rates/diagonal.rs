//! Diagonal matrices above and below Pi, in doubles.

use faer::linalg::solvers::DenseSolveCore;
use faer::{Mat, Side};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, Portable, round_f64};

/// By what share these bounds may differ from the best ones.
const ROOM: f64 = 1e-3;

/// e_low, e_up, z_up in floating point, rounded to the safe side: of all `diag(e_up, z_up I) >= Pi` one for which
/// `e_up dE^2 + z_up dZ^2` is about least.
pub(super) fn bounds(pi: &Mat<f64>, [_, of_e, of_zeta]: [&Enclosure; 3]) -> Option<[Rational; 3]> {
    let n = pi.nrows();
    let rest = Mat::from_fn(n - 1, n - 1, |i, j| pi[(i + 1, j + 1)]);
    let eigen = rest.self_adjoint_eigen(Side::Lower).ok()?;
    let values: Vec<f64> = eigen.S().column_vector().iter().copied().collect();
    let vectors = eigen.U();
    let along = |k: usize| (0..n - 1).map(|i| vectors[(i, k)] * pi[(i + 1, 0)]).sum::<f64>();
    let squares: Vec<f64> = (0..n - 1).map(|k| along(k).portable_powi(2)).collect();
    let largest = values.iter().copied().fold(0.0, f64::max);
    let [of_e, of_zeta] = [of_e, of_zeta].map(|distance| distance.upper_f64().portable_powi(2));
    // The Schur complement, for z_up above the largest eigenvalue.
    let of = |z_up: f64| {
        pi[(0, 0)] + squares.iter().zip(&values).map(|(square, value)| square / (z_up - value)).sum::<f64>()
    };
    let cost = |z_up: f64| of(z_up) * of_e + z_up * of_zeta;
    let candidates = (0..60).map(|k| largest * (1.0 + ROOM * 1.3f64.portable_powi(k)));
    let z_up = candidates.min_by(|a, b| cost(*a).total_cmp(&cost(*b)))?;
    let inverse = pi.partial_piv_lu().inverse();
    let low = round_f64((1.0 - ROOM) / inverse[(0, 0)], 6, Direction::Down)?;
    let up = [(1.0 + ROOM) * of(z_up), z_up].map(|value| round_f64(value, 6, Direction::Up));
    let [e_up, z_up] = up;
    Some([low, e_up?, z_up?]).filter(|all| all[0] > 0)
}

/// x_up, e_up, z_up and e_low in floating point, rounded to the safe side: of all upper bounds some for which
/// `x_up dX^2 + e_up dE^2 + z_up dZ^2` is about least. Without states x_up is 0.
pub(super) fn bounds_of_states(
    pi: &Mat<f64>,
    states: usize,
    distances: [&Enclosure; 3],
) -> Option<([Rational; 3], Rational)> {
    let (n, signals) = (pi.nrows(), states + 1);
    let squares = distances.map(|distance| distance.upper_f64().portable_powi(2));
    let block = |from: usize, to: usize| Mat::from_fn(to - from, to - from, |i, j| pi[(from + i, from + j)]);
    let eigen = block(signals, n).self_adjoint_eigen(Side::Lower).ok()?;
    let values: Vec<f64> = eigen.S().column_vector().iter().copied().collect();
    let across = Mat::from_fn(signals, n - signals, |i, j| pi[(i, signals + j)]) * eigen.U();
    let largest = values.iter().copied().fold(0.0, f64::max);
    let steps = (0..40).map(|k| 1.0 + ROOM * 1.4f64.portable_powi(k));
    let mut best: Option<(f64, [f64; 3])> = None;
    for z_up in steps.clone().map(|step| largest * step) {
        // The Schur complement, for z_up above the largest eigenvalue; and once more for x_up.
        let rest = Mat::from_fn(signals, signals, |i, j| {
            let taken = values.iter().enumerate().map(|(k, value)| across[(i, k)] * across[(j, k)] / (z_up - value));
            pi[(i, j)] + taken.sum::<f64>()
        });
        let corner = rest[(states, states)];
        if states == 0 {
            take(&mut best, squares, [0.0, corner, z_up]);
            continue;
        }
        let eigen = Mat::from_fn(states, states, |i, j| rest[(i, j)]).self_adjoint_eigen(Side::Lower).ok()?;
        let own: Vec<f64> = eigen.S().column_vector().iter().copied().collect();
        let column = Mat::from_fn(1, states, |_, j| rest[(states, j)]) * eigen.U();
        let most = own.iter().copied().fold(0.0, f64::max);
        for x_up in steps.clone().map(|step| most * step) {
            let taken = own.iter().enumerate().map(|(k, value)| column[(0, k)].portable_powi(2) / (x_up - value));
            take(&mut best, squares, [x_up, corner + taken.sum::<f64>(), z_up]);
        }
    }
    let (_, upper) = best?;
    let inverse = pi.partial_piv_lu().inverse();
    let low = round_f64((1.0 - ROOM) / inverse[(states, states)], 6, Direction::Down).filter(|low| *low > 0)?;
    let [x_up, e_up, z_up] = upper.map(|value| round_f64(value * (1.0 + ROOM), 6, Direction::Up));
    Some(([x_up?, e_up?, z_up?], low))
}

/// Keeps the bounds for which the sum at the start is less.
fn take(best: &mut Option<(f64, [f64; 3])>, squares: [f64; 3], upper: [f64; 3]) {
    let cost: f64 = squares.iter().zip(upper).map(|(square, upper)| square * upper).sum();
    if best.is_none_or(|(least, _)| cost < least) && cost.is_finite() {
        *best = Some((cost, upper));
    }
}

/// The largest `(c'y)^2` where `y'Pi y <= 1`, of the rows of the lower triangle of Pi: `c'Pi^-1 c` in floating point.
#[must_use]
pub fn largest_square(pi: &[Vec<Rational>], c: &[f64]) -> Option<f64> {
    // In units of the diagonal, which may have entries of very different sizes.
    let root: Vec<f64> = pi.iter().enumerate().map(|(i, row)| row[i].to_f64().sqrt()).collect();
    let scaled = Mat::from_fn(pi.len(), pi.len(), |i, j| pi[i.max(j)][i.min(j)].to_f64() / (root[i] * root[j]));
    let along = Mat::from_fn(pi.len(), 1, |i, _| c[i] / root[i]);
    let found = (along.transpose() * scaled.partial_piv_lu().inverse() * &along)[(0, 0)];
    (found > 0.0 && found.is_finite()).then_some(found)
}

/// z_low and z_up of a Pi in floating point, rounded to the safe side.
pub(super) fn bounds_of_zeta(pi: &Mat<f64>) -> Option<[Rational; 2]> {
    let largest = largest_of_zeta(pi)?;
    let inverse = largest_of_zeta(&pi.partial_piv_lu().inverse())?;
    let low = round_f64((1.0 - ROOM) / inverse, 6, Direction::Down).filter(|low| *low > 0)?;
    Some([low, round_f64((1.0 + ROOM) * largest, 6, Direction::Up)?])
}

/// The largest eigenvalue of the block of zs.
pub(super) fn largest_of_zeta(matrix: &Mat<f64>) -> Option<f64> {
    let n = matrix.nrows() - 1;
    let block = Mat::from_fn(n, n, |i, j| f64::midpoint(matrix[(i + 1, j + 1)], matrix[(j + 1, i + 1)]));
    let values = block.self_adjoint_eigenvalues(Side::Lower).ok()?;
    values.last().copied().filter(|value| *value > 0.0 && value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: the least eigenvalue of the Schur complement [[1.75, 0.375], [0.375, 2.9375]] is 1.64149, the largest one of the block 3.05902.
    #[test]
    fn of_zeta() {
        let pi = Mat::from_fn(3, 3, |i, j| [[4.0, 1.0, -0.5], [1.0, 2.0, 0.25], [-0.5, 0.25, 3.0]][i][j]);
        let [low, up] = bounds_of_zeta(&pi).unwrap().map(|bound| bound.to_f64());
        assert!((low / 1.64149 - 0.999).abs() < 1e-5 && (up / 3.05902 - 1.001).abs() < 1e-5, "{low} {up}");
    }
}
