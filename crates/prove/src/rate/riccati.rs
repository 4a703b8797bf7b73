//! Pi of the closed loop's Lyapunov function, proposed by a Riccati equation in floating point.

use super::small_gain::{FloatDynamics, SmallGain};
use faer::linalg::solvers::DenseSolveCore;
use faer::{Mat, c64};
use rug::Rational;
use sigmastar_decide::rates::inequality::RateWitness;
use sigmastar_exact::number::{Direction, Portable, round_f64};

/// One of so many parts of what the small-gain condition leaves over goes to each of its two sides.
const PARTS: f64 = 3.0;

/// The numbers of a proof in doubles, with l = 1.
#[derive(Clone, Debug)]
pub struct Proposal {
    /// The rate, rounded down.
    pub rate: Rational,
    /// w.
    pub w: f64,
    /// Pi.
    pub pi: Mat<f64>,
}

impl Proposal {
    /// The witness with w and each entry of Pi to so many digits, 0 where it is beyond those of its diagonal; `None` if one is not finite.
    #[must_use]
    pub fn in_digits(&self, digits: u32) -> Option<RateWitness> {
        self.witness(round_f64(self.w, digits, Direction::Nearest), in_digits(&self.pi, digits))
    }

    fn witness(&self, w: Option<Rational>, pi: Option<Vec<Vec<Rational>>>) -> Option<RateWitness> {
        Some(RateWitness { rate: self.rate.clone(), w: w?, pi: pi?, l: Rational::from(1), inputs: [None, None] })
    }
}

/// The lower triangle of Pi to so many digits, 0 where an entry is beyond those of its diagonal; `None` if one is not finite.
pub(super) fn in_digits(pi: &Mat<f64>, digits: u32) -> Option<Vec<Vec<Rational>>> {
    let least = 0.1f64.portable_powi(digits as i32 + 1);
    let entry = |i: usize, j: usize| {
        let small = pi[(i, j)].abs() < least * (pi[(i, i)] * pi[(j, j)]).sqrt();
        if small { Some(Rational::new()) } else { round_f64(pi[(i, j)], digits, Direction::Nearest) }
    };
    (0..pi.nrows()).map(|i| (0..=i).map(|j| entry(i, j)).collect()).collect()
}

/// A proposal for a share of the largest rate, with Pi from the Riccati equation
/// `Pi (A_c + rate' I) + (.)' + c e e' + c_v v v' + beta Pi B B'Pi = 0` at a rate' halfway between the claimed and the largest one: the
/// difference leaves the term 2 (rate' - rate) Pi in the matrix, which makes it definite.
#[must_use]
pub fn propose(condition: &SmallGain, largest: f64, share: f64) -> Option<Proposal> {
    let shifted = largest * (1.0 + share) / 2.0;
    let multipliers = condition.multipliers(shifted, PARTS)?;
    let FloatDynamics { matrix, input, moved, .. } = &condition.dynamics;
    let n = input.len();
    let a = Mat::from_fn(n, n, |i, j| matrix[(i, j)] + if i == j { shifted } else { 0.0 });
    let output = Mat::from_fn(n, n, |i, j| {
        let of_e = if i == 0 && j == 0 { multipliers.output } else { 0.0 };
        of_e + if moved.is_empty() { 0.0 } else { multipliers.moved * moved[i] * moved[j] }
    });
    let inputs = [(multipliers.input, input.clone())];
    let equation = Equation { a: &a, inputs: &inputs, output: &output };
    let pi = equation.stabilising([multipliers.output, multipliers.input])?;
    // The subspace is less accurate where eigenvalues of the Hamiltonian matrix are close to the imaginary axis.
    let pi = equation.refined(&pi).unwrap_or(pi);
    let rate = round_f64(largest * share, 6, Direction::Down)?;
    Some(Proposal { rate, w: multipliers.w, pi })
}

/// `Pi A + A'Pi + C + Pi R Pi = 0`, R the sum of the beta B B' of some inputs.
pub(super) struct Equation<'a> {
    /// A.
    pub(super) a: &'a Mat<f64>,
    /// beta and B of each input.
    pub(super) inputs: &'a [(f64, Vec<f64>)],
    /// C.
    pub(super) output: &'a Mat<f64>,
}

impl Equation<'_> {
    /// The least symmetric solution, from the stable subspace of the Hamiltonian matrix `[[A, R], [-C, -A']]`: with [X; Y] a
    /// basis of it, Pi = Y X^-1. The sizes are those of C and of R.
    pub(super) fn stabilising(&self, [of_output, of_gain]: [f64; 2]) -> Option<Mat<f64>> {
        let Equation { a, inputs, output } = self;
        let n = a.nrows();
        // Pi in the unit root(size of C/size of R), in which both terms have the same size.
        let unit = (of_output / of_gain).sqrt();
        if !(unit.is_finite() && unit > 0.0) {
            return None;
        }
        let hamiltonian = Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
            (true, true) => a[(i, j)],
            (true, false) => inputs.iter().map(|(beta, input)| beta * unit * input[i] * input[j - n]).sum(),
            (false, true) => -output[(i - n, j)] / unit,
            (false, false) => -a[(j - n, i - n)],
        });
        if !hamiltonian.as_ref().is_all_finite() {
            return None;
        }
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
        let pi = Mat::from_fn(n, n, |i, j| unit * f64::midpoint(quotient[(i, j)].re, quotient[(j, i)].re));
        pi.as_ref().is_all_finite().then_some(pi)
    }

    /// One step of Newton's method: `Pi + D` with `D K + K'D` the negative of the left side of the equation at Pi, `K = A + R Pi`.
    pub(super) fn refined(&self, pi: &Mat<f64>) -> Option<Mat<f64>> {
        let Equation { a, inputs, output } = self;
        let n = a.nrows();
        let image = |input: &[f64]| (0..n).map(|i| (0..n).map(|j| pi[(i, j)] * input[j]).sum()).collect::<Vec<f64>>();
        let images: Vec<Vec<f64>> = inputs.iter().map(|(_, input)| image(input)).collect();
        let product = pi * *a;
        let residual = Mat::from_fn(n, n, |i, j| {
            let square = inputs.iter().zip(&images).map(|((beta, _), image)| beta * image[i] * image[j]);
            product[(i, j)] + product[(j, i)] + output[(i, j)] + square.sum::<f64>()
        });
        let closed = Mat::from_fn(n, n, |i, j| {
            let moved = inputs.iter().zip(&images).map(|((beta, input), image)| beta * input[i] * image[j]);
            a[(i, j)] + moved.sum::<f64>()
        });
        if !(closed.as_ref().is_all_finite() && residual.as_ref().is_all_finite()) {
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
        let better = Mat::from_fn(n, n, |i, j| pi[(i, j)] + f64::midpoint(step[(i, j)].re, step[(j, i)].re));
        better.as_ref().is_all_finite().then_some(better)
    }
}
