//! The least sigma of the matrix inequality (M) at pairs of sampled points, (J, r) at the one and (g, d) at the other, in doubles:
//! it proposes, and nothing rests on it.
//!
//! The points of a pair may have different times: that is what a constant S of [`super::splitting`] allows for.

use super::place::Places;
use super::suprema::FloatSuprema;
use super::weights::{Column, FloatWeights, Root, Thresholds};
use sigmastar_lang::spec::Bound;

/// (X, E) of (J, r), and of (g, d).
#[derive(Clone, Copy, Debug)]
pub struct MatrixArguments {
    /// Whether the two may be at two points; else all derivatives are at one, and both (X, E) are the same.
    pub apart: bool,
    /// Of (J, r).
    pub states: [f64; 2],
    /// Of (g, d).
    pub error: [f64; 2],
}

impl MatrixArguments {
    /// With so much more of x.
    #[must_use]
    pub fn beyond(self, radius: f64) -> MatrixArguments {
        let larger = |[x, e]: [f64; 2]| [x + radius, e];
        MatrixArguments { apart: self.apart, states: larger(self.states), error: larger(self.error) }
    }
}

/// Points of either kind.
#[derive(Clone, Debug)]
pub struct Corners {
    /// Of (J, r).
    pub(super) states: Places,
    /// Of (g, d).
    pub(super) error: Places,
}

/// How often the points of the one kind are sought for those of the other.
const TURNS: usize = 2;

impl FloatSuprema {
    /// The points whose pairs have the largest thresholds, so many of either kind beside those where single bounds are largest.
    #[must_use]
    pub fn corners(&self, at: MatrixArguments, places: &Places, weights: FloatWeights, each: usize) -> Corners {
        let mut states = self.where_largest(at.states, places, [Bound::Rate, Bound::Qx]);
        let mut error = self.where_largest(at.error, places, [Bound::Fe, Bound::QeMax]);
        for _ in 0..TURNS {
            let columns = self.columns(at.error, &Places::listed(error.clone()), weights);
            let best = self.largest_of_derivatives(at.states, places, each, |derivatives, matrix| {
                let mut solved = Vec::new();
                Root::new(weights.of_states(derivatives, matrix)).map_or_else(
                    |without| without,
                    |root| largest(&columns, |column| root.threshold(column, &mut solved)),
                )
            });
            states.extend(best.into_iter().map(|(_, place)| place));
            let roots = self.roots(at.states, &Places::listed(states.clone()), weights).unwrap_or_default();
            let best = self.largest_of_derivatives(at.error, places, each, |derivatives, _| {
                let (column, mut solved) = (weights.of_error(derivatives, self.moves), Vec::new());
                largest(&roots, |root| root.threshold(&column, &mut solved))
            });
            error.extend(best.into_iter().map(|(_, place)| place));
        }
        Corners { states: Places::listed(states), error: Places::listed(error) }
    }

    /// The largest threshold of pairs of corners; infinite where F has none.
    #[must_use]
    pub fn threshold_of_pairs(&self, at: MatrixArguments, corners: &Corners, weights: FloatWeights) -> f64 {
        let columns = self.columns(at.error, &corners.error, weights);
        match self.roots(at.states, &corners.states, weights) {
            Ok(roots) => {
                let mut solved = Vec::new();
                let pairs = roots.iter().flat_map(|root| columns.iter().map(move |column| (root, column)));
                let all =
                    pairs.fold(Thresholds::ALL, |all, (root, column)| all.and(root.thresholds(column, &mut solved)));
                let value = all.value();
                // What is not a number counts as infinite.
                if value.is_nan() { f64::INFINITY } else { value }
            }
            Err(without) => without,
        }
    }

    fn roots(&self, at: [f64; 2], places: &Places, weights: FloatWeights) -> Result<Vec<Root>, f64> {
        let roots =
            self.of_derivatives(at, places, |derivatives, matrix| Root::new(weights.of_states(derivatives, matrix)));
        roots.into_iter().collect()
    }

    fn columns(&self, at: [f64; 2], places: &Places, weights: FloatWeights) -> Vec<Column> {
        self.of_derivatives(at, places, |derivatives, _| weights.of_error(derivatives, self.moves))
    }
}

/// What is not a number counts as infinite.
fn largest<T>(of: &[T], value: impl FnMut(&T) -> f64) -> f64 {
    of.iter().map(value).fold(f64::NEG_INFINITY, |a, b| if b.is_nan() { f64::INFINITY } else { a.max(b) })
}
