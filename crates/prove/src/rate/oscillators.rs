//! `Phi - mu M M'N` for a given n_o, and Lyapunov functions of it.
//!
//! In the coordinates `N^(1/2) zeta`, in which |zeta|_N is the Euclidean norm, the matrix is `A = Phi - mu b b'` with
//! `b = N^(1/2) M`: Phi commutes with N. Its order is 2 n_o + 1.

use faer::{Mat, Side, c64};
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_matrix::ScaledMatrix;
use sigmastar_theory::data::Data;

/// The matrix A of one n_o, enclosed.
pub struct OscillatorMatrix {
    order: usize,
    frequency: Enclosure,
    pub(super) mu: Enclosure,
    /// b, one number for each state; 0 for the second state of an oscillator.
    pub(super) b: Vec<Enclosure>,
}

/// An eigenvalue decomposition of A in floating point.
pub struct Eigen {
    values: Vec<c64>,
    /// The inverse of the matrix of eigenvectors.
    inverse: Mat<c64>,
    /// `V* V`.
    gram: Mat<c64>,
}

impl Eigen {
    /// The eigenvalues.
    #[must_use]
    pub fn values(&self) -> &[c64] {
        &self.values
    }

    /// The largest real part.
    #[must_use]
    pub fn abscissa(&self) -> f64 {
        self.values.iter().map(|value| value.re).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// A proved P > 0 with `P (A + rate I) + (A + rate I)' P <= -I`.
#[derive(Clone, Debug)]
pub struct ProvedLyapunov {
    /// The rate, in 1/time.
    pub rate: Rational,
    /// An upper bound of the largest eigenvalue of P.
    pub largest: Rational,
    /// An upper bound of |P b|.
    pub gain: Enclosure,
}

impl OscillatorMatrix {
    /// The matrix of a specification for n_o oscillators.
    #[must_use]
    pub fn new(data: &Data<'_>, n_o: u32) -> OscillatorMatrix {
        let weights = &data.spec.internal_model.weights;
        let root = |l: u64| weights.weight(l, data.precision).sqrt();
        let mut b = vec![root(0)];
        b.extend((1..=u64::from(n_o)).flat_map(|l| [root(l), data.zero()]));
        OscillatorMatrix { order: b.len(), frequency: data.base_frequency.clone(), mu: data.mu.clone(), b }
    }

    /// `2 n_o + 1`.
    #[must_use]
    pub fn order(&self) -> usize {
        self.order
    }

    /// w in floating point.
    pub(super) fn base_frequency_f64(&self) -> f64 {
        self.frequency.midpoint_f64()
    }

    /// `(P Phi)_ij` for column j: where the one entry of that column of Phi stands, and the entry.
    pub(super) fn phi(&self, column: usize) -> Option<(usize, Enclosure)> {
        let oscillator = column.div_ceil(2) as i64;
        let entry = &self.frequency * oscillator;
        // Phi = l w [[0, 1], [-1, 0]] on the states 2l - 1 and 2l.
        match column {
            0 => None,
            odd if odd % 2 == 1 => Some((column + 1, entry.negate())),
            _ => Some((column - 1, entry)),
        }
    }

    /// The eigenvalues and eigenvectors of A in floating point.
    #[must_use]
    pub fn eigen(&self) -> Option<Eigen> {
        let n = self.order;
        let b: Vec<f64> = self.b.iter().map(Enclosure::midpoint_f64).collect();
        let mu = self.mu.midpoint_f64();
        let mut a = Mat::from_fn(n, n, |i, j| -mu * b[i] * b[j]);
        for column in 0..n {
            if let Some((row, entry)) = self.phi(column) {
                a[(row, column)] += entry.midpoint_f64();
            }
        }
        // A NaN would not stop the iteration.
        if !a.as_ref().is_all_finite() {
            return None;
        }
        let eigen = a.eigen().ok()?;
        let vectors = eigen.U().to_owned();
        let values: Vec<c64> = eigen.S().column_vector().iter().copied().collect();
        use faer::linalg::solvers::DenseSolveCore;
        let inverse = vectors.partial_piv_lu().inverse();
        let gram = vectors.adjoint() * &vectors;
        Some(Eigen { values, inverse, gram })
    }

    /// Proposes P for a rate by the Lyapunov equation `P (A + rate I) + (A + rate I)' P = -2 I` in the basis of eigenvectors, and
    /// proves it with half of the right side.
    ///
    /// `None` if nothing is proved: a rate too near the spectral abscissa, or above it.
    #[must_use]
    pub fn prove(&self, eigen: &Eigen, rate: f64) -> Option<ProvedLyapunov> {
        let n = self.order;
        // Y_ij = -2 (V*V)_ij/(conj(l_i) + l_j + 2 rate), P = V^-* Y V^-1.
        let y = Mat::from_fn(n, n, |i, j| {
            let sum = eigen.values[i].conj() + eigen.values[j] + c64::new(2.0 * rate, 0.0);
            eigen.gram[(i, j)] * c64::new(-2.0, 0.0) / sum
        });
        let complex = eigen.inverse.adjoint() * &y * &eigen.inverse;
        let p = Mat::from_fn(n, n, |i, j| (complex[(i, j)].re + complex[(j, i)].re) / 2.0);
        if !p.as_ref().is_all_finite() {
            return None;
        }
        let rate = if rate == 0.0 { Rational::new() } else { round_f64(rate, 6, Direction::Down)? };
        self.verify(&p, rate)
    }

    /// Proves the inequality for P, taken as the exact rational numbers that its doubles are.
    fn verify(&self, p: &Mat<f64>, rate: Rational) -> Option<ProvedLyapunov> {
        let n = self.order;
        let precision = self.mu.precision();
        let exact: Option<Vec<Enclosure>> = (0..n)
            .flat_map(|i| (0..n).map(move |j| (i.max(j), i.min(j))))
            .map(|at| Some(Enclosure::from_rational(&Rational::from_f64(p[at])?, precision)))
            .collect();
        let exact = exact?;
        let at = |i: usize, j: usize| &exact[i * n + j];
        // P b, with b zero at every second state.
        let image: Vec<Enclosure> = (0..n)
            .map(|i| {
                let states = (0..n).filter(|j| *j == 0 || j % 2 == 1);
                states.fold(Enclosure::zero(precision), |sum, j| sum + at(i, j) * &self.b[j])
            })
            .collect();
        let twice = Enclosure::from_rational(&rate, precision) * 2;
        let phi: Vec<Option<(usize, Enclosure)>> = (0..n).map(|column| self.phi(column)).collect();
        let decay = |i: usize, j: usize| {
            let mut sum = &self.mu * (&image[i] * &self.b[j] + &self.b[i] * &image[j]) - &twice * at(i, j);
            for (column, other) in [(j, i), (i, j)] {
                if let Some((row, entry)) = &phi[column] {
                    sum = sum - at(other, *row) * entry;
                }
            }
            if i == j { sum - Enclosure::one(precision) } else { sum }
        };
        let proved = |matrix: Option<ScaledMatrix>| matrix.is_some_and(|m| m.is_positive_definite() == Truth::True);
        if !proved(ScaledMatrix::from_enclosures(n, decay))
            || !proved(ScaledMatrix::from_doubles(n, |i, j| p[(i, j)], &vec![0.0; n]))
        {
            return None;
        }
        let eigenvalues = p.self_adjoint_eigenvalues(Side::Lower).ok()?;
        let largest = round_f64(*eigenvalues.last()? * 1.0001, 6, Direction::Up)?;
        let bound = Enclosure::from_rational(&largest, precision);
        let below = |i: usize, j: usize| if i == j { &bound - at(i, j) } else { at(i, j).negate() };
        if !proved(ScaledMatrix::from_enclosures(n, below)) {
            return None;
        }
        let gain = image.iter().fold(Enclosure::zero(precision), |sum, entry| sum + entry.sqr()).sqrt().ceiling();
        Some(ProvedLyapunov { rate, largest, gain })
    }
}
