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
