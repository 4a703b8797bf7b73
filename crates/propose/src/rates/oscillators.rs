//! P_zeta of Lemma 1 of the paper (P:lemma:hurwitzPhiM) in doubles, of the Lyapunov equation in a basis of eigenvectors.

use faer::linalg::solvers::DenseSolveCore;
use faer::{Mat, Side, c64};
use sigmastar_decide::rates::OscillatorMatrix;
use sigmastar_exact::enclosure::Enclosure;

/// What is proposed for `A = Phi - mu b b'`.
#[derive(Clone, Debug)]
pub struct Proposed {
    /// P with `P A + A'P = -2 I`, twice of what is proved; symmetric, by rows.
    pub p: Vec<Vec<f64>>,
    /// Its largest eigenvalue.
    pub largest: f64,
    /// The spectral abscissa of A.
    pub abscissa: f64,
}

/// The proposal for one n_o; `None` where a number is not finite.
#[must_use]
pub fn propose(of: &OscillatorMatrix) -> Option<Proposed> {
    let n = of.order();
    let b: Vec<f64> = of.b.iter().map(Enclosure::midpoint_f64).collect();
    let mu = of.mu.midpoint_f64();
    let mut a = Mat::from_fn(n, n, |i, j| -mu * b[i] * b[j]);
    for column in 0..n {
        if let Some((row, entry)) = of.phi(column) {
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
    let inverse = vectors.partial_piv_lu().inverse();
    let gram = vectors.adjoint() * &vectors;
    // Y_ij = -2 (V*V)_ij/(conj(l_i) + l_j), P = V^-* Y V^-1.
    let y = Mat::from_fn(n, n, |i, j| gram[(i, j)] * c64::new(-2.0, 0.0) / (values[i].conj() + values[j]));
    let complex = inverse.adjoint() * &y * &inverse;
    let p = Mat::from_fn(n, n, |i, j| (complex[(i, j)].re + complex[(j, i)].re) / 2.0);
    if !p.as_ref().is_all_finite() {
        return None;
    }
    let largest = *p.self_adjoint_eigenvalues(Side::Lower).ok()?.last()?;
    let abscissa = values.iter().map(|value| value.re).fold(f64::NEG_INFINITY, f64::max);
    let p = (0..n).map(|i| (0..n).map(|j| p[(i, j)]).collect()).collect();
    Some(Proposed { p, largest, abscissa })
}
