//! Q of the closed loop's Lyapunov function, proposed by a Riccati equation in floating point.

use super::inequality::{ErrorDynamics, RateWitness};
use super::small_gain::{Multipliers, SmallGain};
use faer::linalg::solvers::DenseSolveCore;
use faer::{Mat, c64};
use sigmastar_exact::number::{Direction, round_f64};

/// Shares of the largest rate that are claimed, in this order.
const SHARES: [f64; 5] = [0.9999, 0.999, 0.99, 0.9, 0.5];

/// The largest share of the rate that can be proved with Q from the Riccati equation
/// `Q (A_y + rate' I) + (.)' + c e e' + beta Q B B'Q = 0` at a rate' halfway between the claimed and the largest one: the difference
/// leaves the term 2 (rate' - rate) Q in the matrix, which makes it definite.
///
/// Guarantee: the rate of the witness is proved; `None` if none is.
#[must_use]
pub fn propose_and_prove(dynamics: &ErrorDynamics<'_>, condition: &SmallGain) -> Option<RateWitness> {
    let largest = condition.largest_rate()?;
    SHARES.iter().find_map(|share| {
        let witness = propose(dynamics, condition, largest, *share)?;
        dynamics.proves(&witness).then_some(witness)
    })
}

/// A witness for a share of the largest rate; a proposal.
#[must_use]
pub fn propose(dynamics: &ErrorDynamics<'_>, condition: &SmallGain, largest: f64, share: f64) -> Option<RateWitness> {
    let shifted = largest * (1.0 + share) / 2.0;
    let multipliers = condition.multipliers(shifted)?;
    let (a, input) = shifted_dynamics(dynamics, shifted)?;
    let Multipliers { output, input_gain, .. } = multipliers;
    let q = stabilising(&a, &input, output, input_gain)?;
    // The subspace is less accurate where eigenvalues of the Hamiltonian matrix are close to the imaginary axis.
    let q = refined(&a, &input, output, input_gain, &q).unwrap_or(q);
    let rate = round_f64(largest * share, 6, Direction::Down)?;
    Some(RateWitness { rate, w_x: multipliers.w_x, q, multipliers: multipliers.l })
}

/// `A_y + rate I` and B in doubles; `None` if a number is not finite.
fn shifted_dynamics(dynamics: &ErrorDynamics<'_>, rate: f64) -> Option<(Mat<f64>, Vec<f64>)> {
    let oscillators = dynamics.oscillators;
    let n = oscillators.order() + 1;
    let mu = oscillators.mu.midpoint_f64();
    let b: Vec<f64> = std::iter::once(0.0).chain(oscillators.b.iter().map(|b| b.midpoint_f64())).collect();
    let input: Vec<f64> = b.iter().enumerate().map(|(i, b)| if i == 0 { 1.0 } else { -b }).collect();
    let mut a = Mat::from_fn(n, n, |i, j| mu * input[i] * b[j] + if i == j { rate } else { 0.0 });
    a[(0, 0)] -= dynamics.sigma.to_f64();
    for column in 0..n - 1 {
        if let Some((row, entry)) = oscillators.phi(column) {
            a[(row + 1, column + 1)] += entry.midpoint_f64();
        }
    }
    let finite = (0..n).all(|j| input[j].is_finite() && (0..n).all(|i| a[(i, j)].is_finite()));
    finite.then_some((a, input))
}

/// The least symmetric solution of `Q A + A'Q + c e e' + beta Q B B'Q = 0`, from the stable subspace of the Hamiltonian matrix
/// `[[A, beta B B'], [-c e e', -A']]`: with [X; Y] a basis of it, Q = Y X^-1.
fn stabilising(a: &Mat<f64>, input: &[f64], c: f64, beta: f64) -> Option<Mat<f64>> {
    let n = input.len();
    // Q in the unit root(c/beta), in which both rank-one terms have the same size.
    let (coupling, unit) = ((c * beta).sqrt(), (c / beta).sqrt());
    if !(coupling.is_finite() && unit.is_finite()) {
        return None;
    }
    let hamiltonian = Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
        (true, true) => a[(i, j)],
        (true, false) => coupling * input[i] * input[j - n],
        (false, true) => {
            if i == n && j == 0 {
                -coupling
            } else {
                0.0
            }
        }
        (false, false) => -a[(j - n, i - n)],
    });
    let eigen = hamiltonian.eigen().ok()?;
    let values: Vec<c64> = eigen.S().column_vector().iter().copied().collect();
    let stable: Vec<usize> = (0..2 * n).filter(|i| values[*i].re < 0.0).collect();
    // Eigenvalues on the imaginary axis: there is no such subspace.
    if stable.len() != n {
        return None;
    }
    let vectors = eigen.U();
    let x = Mat::from_fn(n, n, |i, j| vectors[(i, stable[j])]);
    let y = Mat::from_fn(n, n, |i, j| vectors[(n + i, stable[j])]);
    let quotient = y * x.partial_piv_lu().inverse();
    let q = Mat::from_fn(n, n, |i, j| unit * f64::midpoint(quotient[(i, j)].re, quotient[(j, i)].re));
    (0..n).all(|j| (0..n).all(|i| q[(i, j)].is_finite())).then_some(q)
}

/// One step of Newton's method: `Q + D` with `D K + K'D = -R`, `K = A + beta B B'Q` and R the left side of the equation at Q.
fn refined(a: &Mat<f64>, input: &[f64], c: f64, beta: f64, q: &Mat<f64>) -> Option<Mat<f64>> {
    let n = input.len();
    let image: Vec<f64> = (0..n).map(|i| (0..n).map(|j| q[(i, j)] * input[j]).sum()).collect();
    let product = q * a;
    let residual = Mat::from_fn(n, n, |i, j| {
        let output = if i == 0 && j == 0 { c } else { 0.0 };
        product[(i, j)] + product[(j, i)] + output + beta * image[i] * image[j]
    });
    let closed = Mat::from_fn(n, n, |i, j| a[(i, j)] + beta * input[i] * image[j]);
    if !(0..n).all(|j| (0..n).all(|i| closed[(i, j)].is_finite() && residual[(i, j)].is_finite())) {
        return None;
    }
    // In the basis V of eigenvectors of K: (V*D V)_ij = -(V*R V)_ij/(conj(l_i) + l_j).
    let eigen = closed.eigen().ok()?;
    let values: Vec<c64> = eigen.S().column_vector().iter().copied().collect();
    let vectors = eigen.U().to_owned();
    let residual = Mat::from_fn(n, n, |i, j| c64::new(residual[(i, j)], 0.0));
    let inside = vectors.adjoint() * &residual * &vectors;
    let divided = Mat::from_fn(n, n, |i, j| -inside[(i, j)] / (values[i].conj() + values[j]));
    let inverse = vectors.partial_piv_lu().inverse();
    let step = inverse.adjoint() * &divided * &inverse;
    let better = Mat::from_fn(n, n, |i, j| q[(i, j)] + f64::midpoint(step[(i, j)].re, step[(j, i)].re));
    (0..n).all(|j| (0..n).all(|i| better[(i, j)].is_finite())).then_some(better)
}
