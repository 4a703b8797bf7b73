//! Places of a grid, what is known there, and lists of those where a value is largest.

use super::pointwise::MatrixAt;
use std::sync::Arc;

/// A place in the grid: of the time, of the point of the ball, and of the share of E, or of the errors of a narrowed grid.
pub type Place = [usize; 3];

/// Which points of the grid are looked at.
#[derive(Clone, Debug)]
pub enum Places {
    /// Every so many times; where that is above 1, fewer points at each time.
    Stride(usize),
    /// Those of a list, as [`FloatSuprema::extreme`](super::FloatSuprema::extreme) makes it.
    Listed(Arc<Vec<Place>>),
}

impl Places {
    /// These, each once.
    pub(super) fn listed(mut places: Vec<Place>) -> Places {
        places.sort_unstable();
        places.dedup();
        Places::Listed(Arc::new(places))
    }
}

/// What depends on t alone at one time.
#[derive(Clone, Debug)]
pub(super) struct Moment {
    pub(super) time: f64,
    pub(super) orbit: Vec<f64>,
    /// f(t, xb, 0).
    pub(super) velocity: Vec<f64>,
    /// What the program computes from t alone.
    pub(super) kept: Vec<f64>,
    /// Of which member of the family.
    pub(super) member: usize,
}

/// The derivatives at a point, in the order of the program, and what depends on t alone there.
#[derive(Clone, Copy)]
pub(super) struct Outputs<'a> {
    pub(super) outputs: &'a [f64],
    pub(super) moment: &'a Moment,
    pub(super) matrices: &'a [MatrixAt; 2],
}

/// Keeps the largest values, the largest first, and of equal ones those that come first.
pub(super) fn keep(best: &mut Vec<(f64, Place)>, count: usize, value: f64, at: Place) {
    if value.is_nan() || (best.len() == count && best.last().is_some_and(|(least, _)| value <= *least)) {
        return;
    }
    let place = best.iter().position(|(other, _)| value > *other).unwrap_or(best.len());
    best.insert(place, (value, at));
    best.truncate(count);
}

/// The largest values of all pieces.
pub(super) fn merged(pieces: impl IntoIterator<Item = Vec<(f64, Place)>>, count: usize) -> Vec<(f64, Place)> {
    let mut best = Vec::new();
    pieces.into_iter().flatten().for_each(|(value, place)| keep(&mut best, count, value, place));
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In pieces the same values are kept, of equal ones the same places, and none that is no number.
    #[test]
    fn pieces_keep_what_all_would() {
        let values = [2.0, 5.0, f64::NAN, 5.0, 1.0, 5.0, 3.0, 5.0, 2.0, 4.0, f64::NEG_INFINITY, 5.0];
        let listed = |from: usize, to: usize, count: usize| {
            let mut best = Vec::new();
            (from..to).for_each(|i| keep(&mut best, count, values[i], [i, 0, 0]));
            best
        };
        for count in [1, 3, 6, 20] {
            let all = listed(0, values.len(), count);
            assert_eq!(all.len(), count.min(11));
            assert!(all.iter().zip([1, 3, 5, 7, 11]).all(|((_, place), i)| *place == [i, 0, 0]), "{all:?}");
            for size in 1..values.len() {
                let starts = (0..values.len()).step_by(size);
                let pieces = starts.map(|from| listed(from, values.len().min(from + size), count));
                assert_eq!(merged(pieces, count), all, "{count} {size}");
            }
        }
    }
}
