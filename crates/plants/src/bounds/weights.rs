//! F of the matrix inequality (M) at one point in doubles: without e, the column of e, and the least sigma of both (derivation, 13.7).

use super::pointwise::{Derivatives, MatrixAt};

/// The free numbers of (M) in doubles (derivation, 13.7).
#[derive(Clone, Copy, Debug)]
pub struct FloatWeights {
    /// w_x.
    pub w_x: f64,
    /// kp = 2 h/mu.
    pub k_p: f64,
    /// The rate that x keeps.
    pub rate: f64,
}

impl FloatWeights {
    /// G: the lower triangle by rows, of x and y. Not a number where P is not the identity.
    pub(super) fn of_states(self, at: &Derivatives<'_>, matrix: &MatrixAt) -> Vec<f64> {
        let FloatWeights { w_x, k_p, rate } = self;
        let n = at.r.len();
        let mut rows = Vec::with_capacity((n + 1) * (n + 2) / 2);
        let known = if n == 0 || matches!(matrix, MatrixAt::Identity) { -w_x } else { f64::NAN };
        for i in 0..n {
            for k in 0..=i {
                let own = if i == k { 2.0 * rate } else { 0.0 };
                rows.push(known * (at.j[i * n + k] + at.j[k * n + i] + own));
            }
        }
        rows.extend(at.r.iter().map(|slope| -0.5 * k_p * slope));
        rows.push(k_p);
        rows
    }

    /// v: the column of e, in x and y, with P = 1.
    pub(super) fn of_error(self, at: &Derivatives<'_>) -> Vec<f64> {
        let of_states = at.g.iter().map(|slope| -self.w_x * slope);
        of_states.chain([-1.0 - 0.5 * self.k_p * at.d]).collect()
    }
}

/// A positive definite matrix by its Cholesky factor, the lower triangle by rows.
pub(super) struct Root(Vec<f64>);

impl Root {
    /// Of the lower triangle of a matrix.
    ///
    /// # Errors
    /// What stands for the threshold of a matrix that is not positive definite: infinity, or what is not a number.
    pub(super) fn new(lower: &[f64]) -> Result<Root, f64> {
        let mut rows = lower.to_vec();
        let at = |i: usize, k: usize| i * (i + 1) / 2 + k;
        let mut i = 0;
        while at(i, 0) < rows.len() {
            for k in 0..=i {
                let sum: f64 = (0..k).map(|m| rows[at(i, m)] * rows[at(k, m)]).sum();
                let rest = rows[at(i, k)] - sum;
                rows[at(i, k)] = match k < i {
                    true => rest / rows[at(k, k)],
                    false if rest > 0.0 => rest.sqrt(),
                    false => return Err(if rest.is_nan() { f64::NAN } else { f64::INFINITY }),
                };
            }
            i += 1;
        }
        Ok(Root(rows))
    }

    /// Half of `v' G^-1 v`.
    pub(super) fn threshold(&self, v: &[f64]) -> f64 {
        let (mut solved, mut square) = (Vec::with_capacity(v.len()), 0.0);
        let mut rows = self.0.as_slice();
        for (i, value) in v.iter().enumerate() {
            let (row, rest) = rows.split_at(i + 1);
            let sum: f64 = row.iter().zip(&solved).map(|(a, b)| a * b).sum();
            let next = (value - sum) / row[i];
            square += next * next;
            solved.push(next);
            rows = rest;
        }
        0.5 * square
    }
}
