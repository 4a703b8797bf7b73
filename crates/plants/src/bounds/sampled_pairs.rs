//! The least sigma of the matrix inequality (M) at pairs of sampled points, (J, r) at the one and (g, d) at the other, in doubles:
//! it proposes, and nothing rests on it.
//!
//! The points of a pair may have different times: that is what a constant S of [`super::splitting`] allows for.

use super::entry::of_table;
use super::pointwise::Asked;
use super::suprema::{FloatSuprema, Place, Places, keep};
use super::weights::{Column, FloatWeights, Root, Thresholds};
use sigmastar_lang::spec::Bound;
use std::sync::Arc;

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

/// Where single bounds are largest, so many points each: a list that serves at other weights too.
const OF_A_BOUND: usize = 4;

/// How often the points of the one kind are sought for those of the other.
const TURNS: usize = 2;

impl FloatSuprema {
    /// The points whose pairs have the largest thresholds, so many of either kind beside those where single bounds are largest.
    #[must_use]
    pub fn corners(&self, at: MatrixArguments, places: &Places, weights: FloatWeights, each: usize) -> Corners {
        let mut states = self.where_largest(at.states, places, [Bound::Rate, Bound::Qx]);
        let mut error = self.where_largest(at.error, places, [Bound::Fe, Bound::QeMax]);
        let mut solved = Vec::new();
        for _ in 0..TURNS {
            let columns = self.columns(at.error, &listed(&error), weights);
            let mut best = Vec::new();
            self.derivatives_at_points(at.states, places, |place, derivatives, matrix| {
                let value = Root::new(&weights.of_states(derivatives, matrix)).map_or_else(
                    |without| without,
                    |root| largest(&columns, |column| root.threshold(column, &mut solved)),
                );
                keep(&mut best, each, value, place);
            });
            states.extend(best.into_iter().map(|(_, place)| place));
            let roots = self.roots(at.states, &listed(&states), weights).unwrap_or_default();
            let mut best = Vec::new();
            self.derivatives_at_points(at.error, places, |place, derivatives, _| {
                let column = weights.of_error(derivatives, self.moves);
                keep(&mut best, each, largest(&roots, |root| root.threshold(&column, &mut solved)), place);
            });
            error.extend(best.into_iter().map(|(_, place)| place));
        }
        Corners { states: listed(&states), error: listed(&error) }
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
        let mut roots = Vec::new();
        self.derivatives_at_points(at, places, |_, derivatives, matrix| {
            roots.push(Root::new(&weights.of_states(derivatives, matrix)));
        });
        roots.into_iter().collect()
    }

    fn columns(&self, at: [f64; 2], places: &Places, weights: FloatWeights) -> Vec<Column> {
        let mut columns = Vec::new();
        self.derivatives_at_points(at, places, |_, derivatives, _| {
            columns.push(weights.of_error(derivatives, self.moves));
        });
        columns
    }

    /// The places where these of the table are largest, and where the last of them is least.
    pub(super) fn where_largest<const N: usize>(
        &self,
        at: [f64; 2],
        places: &Places,
        bounds: [Bound; N],
    ) -> Vec<Place> {
        let mut best = vec![Vec::new(); N + 1];
        self.at_points(at, places, Asked::ALL, |place, values| {
            let values = bounds.map(|bound| of_table(bound, &values));
            let least = values.last().map(|value| -value);
            best.iter_mut()
                .zip(values.into_iter().chain(least))
                .for_each(|(best, value)| keep(best, OF_A_BOUND, value, place));
        });
        best.into_iter().flatten().map(|(_, place)| place).collect()
    }
}

/// What is not a number counts as infinite.
fn largest<T>(of: &[T], value: impl FnMut(&T) -> f64) -> f64 {
    of.iter().map(value).fold(f64::NEG_INFINITY, |a, b| if b.is_nan() { f64::INFINITY } else { a.max(b) })
}

fn listed(places: &[Place]) -> Places {
    let mut places = places.to_vec();
    places.sort_unstable();
    places.dedup();
    Places::Listed(Arc::new(places))
}
