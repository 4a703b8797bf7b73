//! Pi of the closed loop's Lyapunov function, proposed by a Riccati equation in floating point.

use faer::linalg::solvers::DenseSolveCore;
use faer::{Mat, c64};

/// Steps of Newton's method, and the share of its terms that is left of the equation where it holds.
const STEPS: usize = 4;
const HOLDS: f64 = 1e-7;

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
    fn stabilising(&self, [of_output, of_gain]: [f64; 2]) -> Option<Mat<f64>> {
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

    /// The same, after a step of Newton's method, and a few more where the equation does not hold yet: the subspace is less accurate where eigenvalues of the
    /// Hamiltonian matrix are close to the imaginary axis. `None` where it does not hold in the end, as far away from a solution a step may lead anywhere.
    pub(super) fn solution(&self, sizes: [f64; 2]) -> Option<Mat<f64>> {
        let mut pi = self.stabilising(sizes)?;
        for _ in 0..STEPS {
            pi = self.refined(&pi)?;
            let (_, share) = self.residual(&pi);
            if share <= HOLDS {
                return Some(pi);
            }
        }
        None
    }

    /// The left side of the equation at Pi, and the largest of its entries as a share of the largest of its terms.
    fn residual(&self, pi: &Mat<f64>) -> (Mat<f64>, f64) {
        let Equation { a, inputs, output } = self;
        let n = a.nrows();
        let image = |input: &[f64]| (0..n).map(|i| (0..n).map(|j| pi[(i, j)] * input[j]).sum()).collect::<Vec<f64>>();
        let images: Vec<Vec<f64>> = inputs.iter().map(|(_, input)| image(input)).collect();
        let product = pi * *a;
        let square = |i: usize, j: usize| {
            inputs.iter().zip(&images).map(|((beta, _), image)| beta * image[i] * image[j]).sum::<f64>()
        };
        let residual = Mat::from_fn(n, n, |i, j| product[(i, j)] + product[(j, i)] + output[(i, j)] + square(i, j));
        let largest = |of: &dyn Fn(usize, usize) -> f64| {
            (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(|(i, j)| of(i, j).abs()).fold(0.0, f64::max)
        };
        let terms = [largest(&|i, j| product[(i, j)]), largest(&|i, j| output[(i, j)]), largest(&square)];
        let share = largest(&|i, j| residual[(i, j)]) / terms.into_iter().fold(f64::MIN_POSITIVE, f64::max);
        (residual, share)
    }

    /// One step of Newton's method: `Pi + D` with `D K + K'D` the negative of the left side of the equation at Pi, `K = A + R Pi`.
    fn refined(&self, pi: &Mat<f64>) -> Option<Mat<f64>> {
        let Equation { a, inputs, .. } = self;
        let n = a.nrows();
        let image = |input: &[f64]| (0..n).map(|i| (0..n).map(|j| pi[(i, j)] * input[j]).sum()).collect::<Vec<f64>>();
        let images: Vec<Vec<f64>> = inputs.iter().map(|(_, input)| image(input)).collect();
        let (residual, _) = self.residual(pi);
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
