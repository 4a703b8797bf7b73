//! Quadratic forms that fall along the differences of solutions of a linear loop, for small peaks (derivation, 14.5): semidefinite programs
//! over a few members.

use crate::semidefinite::propose;
use sigmastar_matrix::AffineMatrix;
use sigmastar_matrix::symmetric::{Symmetric, triangle};

/// What is to be small.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PeakOf {
    /// |e - e_per|.
    Error,
    /// |u - u_per|.
    Control,
}

/// A linear loop, and how far from its periodic solution it starts.
#[derive(Clone, Debug)]
pub struct PeakProgram {
    /// `[[A, b], [c, d]]` of some members, by rows, in the coordinates of the norms of x.
    pub members: Vec<Vec<Vec<f64>>>,
    /// b at both ends of the input gain.
    pub gain: [f64; 2],
    /// sigma.
    pub sigma: f64,
    /// mu.
    pub mu: f64,
    /// The sum of all weights.
    pub n_bar_squared: f64,
    /// The distances of the start from the periodic solution: of x, e, and zeta.
    pub start: [f64; 3],
}

/// `V = x'P x + w e^2 + (b mu k_p/2) |zeta|_N^2`.
#[derive(Clone, Debug)]
pub struct FallingForm {
    /// P by rows.
    pub matrix: Vec<Vec<f64>>,
    /// w.
    pub weight: f64,
    /// k_p.
    pub k_p: f64,
}

/// By what share of the diagonal the matrices are to be definite.
const MARGINS: [f64; 2] = [1e-6, 1e-4];

impl PeakProgram {
    /// The form with the least bound of the peak that is found; the margins in turn, so that `attempt` 0 has the smallest. `None` where none
    /// is found.
    #[must_use]
    pub fn propose(&self, of: PeakOf, attempt: usize) -> Option<FallingForm> {
        let margin = *MARGINS.get(attempt)?;
        let n = self.members.first()?.len() - 1;
        let pairs: Vec<(usize, usize)> = triangle(n).collect();
        let m = pairs.len();
        let (w, kappa, a) = (m, m + 1, m + 2);
        let variables = m + 3;
        // Lengths of x, e and y, so that the distances of the start are 1: x = d_x xi, e = d_e eps, y = sigma d_e up.
        let d_e = positive(self.start[1], 1.0);
        let d_x = positive(self.start[0], d_e);
        let ratio = d_e / d_x;
        let sigma = self.sigma;
        let mut constraints = Vec::new();
        for rows in &self.members {
            for b in self.gain {
                let moved = (rows[n][n] + (1.0 - b) * sigma) / sigma;
                let term = |variable: usize, i: usize, k: usize| {
                    let (i, k) = (i.min(k), i.max(k));
                    let of_margin = |own: bool| if own && i == k { -margin } else { 0.0 };
                    if variable == a {
                        return of_margin(i < n);
                    }
                    if variable == w {
                        return match (i == n, k == n, k == n + 1) {
                            (true, true, _) => 2.0 - margin,
                            (true, _, true) => -1.0,
                            _ => 0.0,
                        };
                    }
                    if variable == kappa {
                        return match (i, k) {
                            (i, k) if i < n && k == n + 1 => -0.5 * rows[n][i] / (ratio * sigma),
                            (i, k) if i == n && k == n + 1 => -0.5 * moved,
                            (i, k) if i == n + 1 && k == n + 1 => 1.0 - margin,
                            _ => 0.0,
                        };
                    }
                    let (p, q) = pairs[variable];
                    // Row `row` of the matrix with ones at (p, q) and (q, p), times a column.
                    let times = |row: usize, column: usize| match (row == p, row == q) {
                        (true, _) => rows[q][column],
                        (false, true) => rows[p][column],
                        (false, false) => 0.0,
                    };
                    match (i < n, k < n, k == n) {
                        (true, true, _) => -(times(i, k) + times(k, i)) / sigma,
                        (true, false, true) => -times(i, n) * ratio / sigma,
                        _ => 0.0,
                    }
                };
                constraints.push(AffineMatrix::from_fn(n + 2, variables, |_, _| 0.0, term));
            }
        }
        let of_p = |variable: usize, i: usize, k: usize| {
            let (i, k) = (i.min(k), i.max(k));
            if pairs.get(variable).is_some_and(|&(p, q)| (p.min(q), p.max(q)) == (i, k)) { 1.0 } else { 0.0 }
        };
        let diagonal = |variable: usize, i: usize, k: usize| if variable == a && i == k { 1.0 } else { 0.0 };
        if n > 0 {
            let above = |v: usize, i: usize, k: usize| diagonal(v, i, k) - of_p(v, i, k);
            let below = |v: usize, i: usize, k: usize| of_p(v, i, k) - margin * diagonal(v, i, k);
            constraints.push(AffineMatrix::from_fn(n, variables, |_, _| 0.0, above));
            constraints.push(AffineMatrix::from_fn(n, variables, |_, _| 0.0, below));
        } else {
            constraints.push(AffineMatrix::from_fn(1, variables, |_, _| 0.0, diagonal));
        }
        let is = |variable: usize, other: usize| if variable == other { 1.0 } else { 0.0 };
        constraints.push(match of {
            PeakOf::Error => AffineMatrix::from_fn(1, variables, |_, _| -1.0, |v, _, _| is(v, w)),
            PeakOf::Control => {
                // 1/w + share/kappa <= 1, by its Schur complement.
                let share = 2.0 * self.mu * self.n_bar_squared / (sigma * self.gain[0]);
                let constant = |i: usize, k: usize| match (i.min(k), i.max(k)) {
                    (0, 0) | (0, 1) => 1.0,
                    (0, 2) => share.sqrt(),
                    _ => 0.0,
                };
                let term = |v: usize, i: usize, k: usize| match (i, k) {
                    (1, 1) => is(v, w),
                    (2, 2) => is(v, kappa),
                    _ => 0.0,
                };
                AffineMatrix::from_fn(3, variables, constant, term)
            }
        });
        let mut cost = vec![0.0; variables];
        cost[a] = if n > 0 { 1.0 } else { 0.0 };
        cost[w] = 1.0;
        let of_zeta = self.start[2] / d_e;
        cost[kappa] = self.gain[1] * self.mu / (2.0 * sigma) * of_zeta * of_zeta;
        let found = propose(&cost, &constraints).ok()?.x;
        // In units of e^2.
        let matrix = Symmetric::from_entries(n, &found).map(|_, _, value| value * ratio * ratio).rows();
        Some(FallingForm { matrix, weight: found[w], k_p: found[kappa] / sigma })
    }
}

fn positive(value: f64, other: f64) -> f64 {
    if value > 0.0 && value.is_finite() { value } else { other }
}
