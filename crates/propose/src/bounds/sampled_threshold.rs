//! The least sigma of the matrix inequality (M) at sampled points, in doubles: it proposes, and nothing rests on it.

use super::place::{Place, Places};
use super::pointwise::{Asked, Derivatives, MatrixAt};
use super::sampled_pairs::{Corners, MatrixArguments};
use super::suprema::FloatSuprema;
use super::weights::{FloatWeights, Root, Thresholds};
use sigmastar_theory::evidence::TABLE;

/// So many times more points are listed for the threshold of the matrix inequality, which all derivatives enter.
const OF_THRESHOLD: usize = 6;

/// So many times more pairs of points are listed for the threshold at pairs; and so many where they are sought for one set of weights alone.
const OF_PAIRS: usize = 2;
const AT_ONCE: usize = 6;

/// Which points are looked at.
#[derive(Clone, Debug)]
pub struct Focus {
    /// For bounds, and for the matrix inequality with all derivatives at one point.
    pub places: Places,
    /// For the matrix inequality at pairs of points.
    pub corners: Option<Corners>,
}

impl FloatSuprema {
    /// The places where bounds are largest on some `G(X, E)`: so many for each bound of [`TABLE`] and each (X, E), and more where the
    /// threshold of the matrix inequality is.
    #[must_use]
    pub fn extreme(
        &self,
        boxes: &[[f64; 2]],
        each: usize,
        inequality: Option<(MatrixArguments, FloatWeights)>,
    ) -> Focus {
        let mut kept: Vec<Vec<(f64, Place)>> = Vec::new();
        for at in boxes {
            let all = (Asked::ALL, each, TABLE.len());
            kept.extend(self.largest_of_bounds(*at, &Places::Stride(1), all, |list, values| values[list]));
        }
        let mut corners = None;
        match inequality {
            Some((at, weights)) if at.apart => {
                corners = Some(self.corners(at, &Places::Stride(1), weights, OF_PAIRS * each));
            }
            Some((at, weights)) => {
                let count = OF_THRESHOLD * each;
                let best = self.largest_of_derivatives(at.states, &Places::Stride(1), count, |derivatives, matrix| {
                    thresholds(derivatives, matrix, weights, self.moves).value()
                });
                kept.push(best);
            }
            None => {}
        }
        let listed = kept.into_iter().flatten().map(|(_, place)| place).collect();
        Focus { places: Places::listed(listed), corners }
    }

    /// The least sigma of (M): [`FloatSuprema::threshold`], or [`FloatSuprema::threshold_of_pairs`] at the corners that are known, else
    /// at those of the grid.
    #[must_use]
    pub fn least_sigma(&self, at: MatrixArguments, focus: &Focus, weights: FloatWeights) -> f64 {
        match &focus.corners {
            _ if !at.apart => self.threshold(at.states, &focus.places, weights),
            Some(corners) => self.threshold_of_pairs(at, corners, weights),
            None => self.threshold_of_pairs(at, &self.corners(at, &focus.places, weights, AT_ONCE), weights),
        }
    }

    /// The least sigma at which F of `Engine::decide_inequality` of sigmastar-decide is positive semidefinite at points of the grid, with
    /// P = 1: half of `v' G^-1 v` for the column v that e has beside its diagonal, and G what F is without e. Infinite where G is not positive definite at one of them; not a number where P is not
    /// the identity.
    #[must_use]
    pub fn threshold(&self, at: [f64; 2], places: &Places, weights: FloatWeights) -> f64 {
        let at =
            self.of_derivatives(at, places, |derivatives, matrix| thresholds(derivatives, matrix, weights, self.moves));
        at.into_iter().fold(Thresholds::ALL, Thresholds::and).value()
    }

    /// The least sigma of [`FloatSuprema::threshold`] by a longer search: local ones start from the best points of the grid.
    #[must_use]
    pub fn refined_threshold(&self, at: [f64; 2], weights: FloatWeights) -> f64 {
        self.refined_of_derivatives(at, |derivatives, matrix| {
            thresholds(derivatives, matrix, weights, self.moves).value()
        })
    }
}

/// Those of one point.
pub fn thresholds(
    at: &Derivatives<'_>,
    matrix: &MatrixAt,
    weights: FloatWeights,
    moves: Option<[f64; 2]>,
) -> Thresholds {
    match Root::new(weights.of_states(at, matrix)) {
        Ok(root) => root.thresholds(&weights.of_error(at, moves), &mut Vec::new()),
        Err(without) => Thresholds::from(without),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WEIGHTS: FloatWeights = FloatWeights { w_x: 0.7, k_p: 1.3, rate: 0.1 };

    fn threshold(j: &[f64], g: &[f64], r: &[f64], d: f64, weights: FloatWeights) -> f64 {
        thresholds(&Derivatives { j, g, r, d }, &MatrixAt::Identity, weights, None).value()
    }

    /// F = [[2 sigma, -1 - kp d/2], [., kp]].
    #[test]
    fn without_states() {
        let at = Derivatives { j: &[], g: &[], r: &[], d: 3.0 };
        let found = thresholds(&at, &MatrixAt::Missing, WEIGHTS, None).value();
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
        let moving = Derivatives { j: &[-2.0], g: &[0.4], r: &[0.3], d: 0.0 };
        let moving = thresholds(&moving, &MatrixAt::Missing, WEIGHTS, None).value();
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
