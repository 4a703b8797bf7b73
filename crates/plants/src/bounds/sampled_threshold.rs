//! The least sigma of the matrix inequality (M) at sampled points, in doubles: it proposes, and nothing rests on it.

use super::entry::TABLE;
use super::pointwise::{Asked, Derivatives, MatrixAt};
use super::suprema::{FloatSuprema, Place, Places, keep};
use std::sync::Arc;

/// So many times more points are listed for the threshold of the matrix inequality, which all derivatives enter.
const OF_THRESHOLD: usize = 6;

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

impl FloatSuprema {
    /// The places where bounds are largest on some `G(X, E)`: so many for each bound of [`TABLE`] and each (X, E), and as many where
    /// `value` is largest at the last of them.
    #[must_use]
    pub fn extreme(&self, boxes: &[[f64; 2]], each: usize, weights: Option<FloatWeights>) -> Places {
        let mut kept: Vec<Vec<(f64, Place)>> = Vec::new();
        for at in boxes {
            let mut best = vec![Vec::new(); TABLE.len()];
            self.at_points(*at, &Places::Stride(1), Asked::ALL, |place, values| {
                best.iter_mut().zip(values).for_each(|(best, value)| keep(best, each, value, place));
            });
            kept.append(&mut best);
        }
        if let (Some(at), Some(weights)) = (boxes.last(), weights) {
            let mut best = Vec::new();
            self.thresholds_at_points(*at, &Places::Stride(1), weights, |place, value| {
                keep(&mut best, OF_THRESHOLD * each, value, place);
            });
            kept.push(best);
        }
        let mut listed: Vec<Place> = kept.into_iter().flatten().map(|(_, place)| place).collect();
        listed.sort_unstable();
        listed.dedup();
        Places::Listed(Arc::new(listed))
    }

    /// The least sigma at which F of [`Engine::decide_inequality`](super::Engine::decide_inequality) is positive semidefinite at
    /// points of the grid, with P = 1: half of `b' G^-1 b` for the column b that e has beside its
    /// diagonal, and G what F is without e. Infinite where G is not positive definite at one of them; not a number where P is not
    /// the identity.
    #[must_use]
    pub fn threshold(&self, at: [f64; 2], places: &Places, weights: FloatWeights) -> f64 {
        let mut largest = f64::NEG_INFINITY;
        self.thresholds_at_points(at, places, weights, |_, value| {
            // Where a value is undefined, so is the supremum.
            largest = if value.is_nan() || largest.is_nan() { f64::NAN } else { largest.max(value) };
        });
        largest
    }

    /// Calls `see` with every place and the least sigma there.
    pub(super) fn thresholds_at_points(
        &self,
        at: [f64; 2],
        places: &Places,
        weights: FloatWeights,
        mut see: impl FnMut(Place, f64),
    ) {
        let mut form = Form::new(self.order());
        self.derivatives_at_points(at, places, |place, derivatives, matrix| {
            see(place, form.threshold(derivatives, matrix, weights));
        });
    }

    /// The same at these points: t/T, y in the unit ball, e/E.
    #[must_use]
    pub fn threshold_at(&self, at: [f64; 2], points: &[(f64, Vec<f64>, f64)], weights: FloatWeights) -> f64 {
        let mut form = Form::new(self.order());
        self.largest_of_derivatives_at(at, points, |derivatives, matrix| form.threshold(derivatives, matrix, weights))
    }

    /// The same by a longer search.
    #[must_use]
    pub fn refined_threshold(&self, at: [f64; 2], weights: FloatWeights) -> f64 {
        let mut form = Form::new(self.order());
        self.refined_of_derivatives(at, |derivatives, matrix| form.threshold(derivatives, matrix, weights))
    }
}

/// The lower triangle of G and b beside it, by rows, as working memory.
struct Form {
    states: usize,
    rows: Vec<f64>,
}

impl Form {
    fn new(states: usize) -> Form {
        Form { states, rows: vec![0.0; (states + 1) * (states + 2)] }
    }

    fn threshold(&mut self, at: &Derivatives<'_>, matrix: &MatrixAt, weights: FloatWeights) -> f64 {
        let n = self.states;
        if n > 0 && !matches!(matrix, MatrixAt::Identity) {
            return f64::NAN;
        }
        let FloatWeights { w_x, k_p, rate } = weights;
        // The column b is the last one.
        let width = n + 2;
        for i in 0..n {
            for k in 0..=i {
                let own = if i == k { 2.0 * rate } else { 0.0 };
                self.rows[i * width + k] = -w_x * (at.j[i * n + k] + at.j[k * n + i] + own);
            }
            self.rows[n * width + i] = -0.5 * k_p * at.r[i];
            self.rows[i * width + n + 1] = -w_x * at.g[i];
        }
        self.rows[n * width + n] = k_p;
        self.rows[n * width + n + 1] = -1.0 - 0.5 * k_p * at.d;
        // Cholesky, and what it makes of b.
        let mut square = 0.0;
        for i in 0..=n {
            for k in (0..=i).chain([n + 1]) {
                let column = |m: usize| if k <= n { self.rows[k * width + m] } else { self.rows[m * width + n + 1] };
                let sum: f64 = (0..k.min(i)).map(|m| self.rows[i * width + m] * column(m)).sum();
                let rest = self.rows[i * width + k] - sum;
                self.rows[i * width + k] = match k {
                    _ if k == i && rest > 0.0 => rest.sqrt(),
                    _ if k == i => return if rest.is_nan() { f64::NAN } else { f64::INFINITY },
                    _ if k <= n => rest / self.rows[k * width + k],
                    _ => rest / self.rows[i * width + i],
                };
            }
            square += self.rows[i * width + n + 1] * self.rows[i * width + n + 1];
        }
        0.5 * square
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WEIGHTS: FloatWeights = FloatWeights { w_x: 0.7, k_p: 1.3, rate: 0.1 };

    fn threshold(j: &[f64], g: &[f64], r: &[f64], d: f64, weights: FloatWeights) -> f64 {
        Form::new(g.len()).threshold(&Derivatives { j, g, r, d }, &MatrixAt::Identity, weights)
    }

    /// F = [[2 sigma, -1 - kp d/2], [., kp]].
    #[test]
    fn without_states() {
        let found =
            Form::new(0).threshold(&Derivatives { j: &[], g: &[], r: &[], d: 3.0 }, &MatrixAt::Missing, WEIGHTS);
        assert!((found - (1.0_f64 + 1.95).powi(2) / 2.6).abs() < 1e-14);
    }

    /// F at the threshold has the determinant 0, and a positive one above it; elimination in another order.
    #[test]
    fn the_determinant_vanishes_at_the_threshold() {
        let determinant = |sigma: f64| {
            let FloatWeights { w_x, k_p, rate } = WEIGHTS;
            let (a, b) = (w_x * 2.0 * (2.0 - rate), -w_x * 0.4);
            let (c, e) = (-k_p / 2.0 * 0.3, -1.0 - k_p / 2.0 * -0.5);
            a * (2.0 * sigma * k_p - e * e) - b * (b * k_p - e * c) + c * (b * e - 2.0 * sigma * c)
        };
        let found = threshold(&[-2.0], &[0.4], &[0.3], -0.5, WEIGHTS);
        assert!(determinant(found).abs() < 1e-12 && determinant(1.01 * found) > 1e-3, "{found}");
        let grows = threshold(&[-0.05], &[0.4], &[0.3], -0.5, WEIGHTS);
        assert_eq!(grows, f64::INFINITY);
        let moving = Form::new(1).threshold(
            &Derivatives { j: &[-2.0], g: &[0.4], r: &[0.3], d: 0.0 },
            &MatrixAt::Missing,
            WEIGHTS,
        );
        assert!(moving.is_nan());
    }

    /// States that have nothing to do with each other: their shares add up.
    #[test]
    fn states_apart() {
        let alone = |j: f64, g: f64| {
            let both = threshold(&[j], &[g], &[0.0], -0.5, WEIGHTS);
            both - threshold(&[j], &[0.0], &[0.0], -0.5, WEIGHTS)
        };
        let none = threshold(&[-1.0], &[0.0], &[0.0], -0.5, WEIGHTS);
        let found = threshold(&[-2.0, 0.7, -0.7, -3.0], &[0.4, 1.1], &[0.0, 0.0], -0.5, WEIGHTS);
        // The skew part of J does nothing.
        assert!((found - none - alone(-2.0, 0.4) - alone(-3.0, 1.1)).abs() < 1e-14, "{found}");
    }
}
