//! The points of a grid, looked at in pieces, so that several threads may: what is found does not depend on who looks.

use super::place::{Outputs, Place, Places, keep, merged};
use super::pointwise::{Asked, Derivatives, MatrixAt, Pointwise};
use super::suprema::FloatSuprema;
use sigmastar_exact::parallel;
use sigmastar_lang::expr::Evaluator;
use sigmastar_lang::spec::Bound;
use sigmastar_theory::evidence::{TABLE, of_table};

/// Points of a piece.
const PIECE: usize = 1024;

/// Where single bounds are largest, so many points each: a list that serves at other weights too.
const OF_A_BOUND: usize = 4;

impl FloatSuprema {
    /// What `see` makes of all points, in pieces, in the order of the points; `asked` says which derivatives there are.
    pub(super) fn in_pieces<A: Send>(
        &self,
        [reach, e]: [f64; 2],
        places: &Places,
        asked: Asked,
        make: impl Fn() -> A + Sync,
        see: impl Fn(&mut A, &mut Pointwise, Place, Outputs<'_>) + Sync,
    ) -> Vec<A> {
        let piece = |places: &[Place]| {
            let (mut made, mut pointwise) = (make(), self.pointwise());
            let mut evaluator = Evaluator::new(self.program.clone());
            let mut outputs = vec![0.0; asked.outputs(self.states())];
            let mut x = vec![0.0; self.states()];
            let mut last = None;
            let mut matrices = [MatrixAt::Missing, MatrixAt::Missing];
            for place @ [i, j, _] in places.iter().copied() {
                let moment = &self.moments[i];
                if last != Some(i) {
                    self.load(moment, &mut evaluator);
                    matrices = self.matrices_at(moment);
                    last = Some(i);
                }
                self.place(&moment.orbit, &self.ball[j], reach, &mut x);
                evaluator.evaluate(&x, self.error(place, e), &mut outputs);
                see(&mut made, &mut pointwise, place, Outputs { outputs: &outputs, moment, matrices: &matrices });
            }
            made
        };
        let places = self.places(e, places);
        match places.len() {
            0..=PIECE => vec![piece(&places)],
            _ => parallel::map(&places.chunks(PIECE).collect::<Vec<_>>(), |places| piece(places)),
        }
    }

    /// The suprema of the bounds that are asked for, in the order of [`TABLE`], at points of the grid.
    #[must_use]
    pub fn survey(&self, reach: f64, e: f64, places: &Places, asked: Asked) -> [f64; TABLE.len()] {
        let nothing = || [f64::NEG_INFINITY; TABLE.len()];
        // Where a value is undefined, so is the supremum.
        let larger = |largest: &mut [f64; TABLE.len()], values: [f64; TABLE.len()]| {
            for (largest, value) in largest.iter_mut().zip(values) {
                *largest = if value.is_nan() || largest.is_nan() { f64::NAN } else { largest.max(value) };
            }
        };
        let pieces = self.in_pieces([reach, e], places, asked, nothing, |largest, pointwise, _, at| {
            larger(largest, pointwise.at(at.outputs, &at.moment.velocity, at.matrices, asked));
        });
        let mut largest = nothing();
        pieces.into_iter().for_each(|piece| larger(&mut largest, piece));
        std::array::from_fn(|index| if TABLE[index].is_rate() { -largest[index] } else { largest[index] })
    }

    /// What a function makes of the first derivatives in the coordinates y, and P, at every point, in their order.
    pub(super) fn of_derivatives<T: Send>(
        &self,
        at: [f64; 2],
        places: &Places,
        value: impl Fn(&Derivatives<'_>, &MatrixAt) -> T + Sync,
    ) -> Vec<T> {
        let pieces = self.in_pieces(at, places, Asked::FIRST, Vec::new, |found, pointwise, _, at| {
            found.push(value(&pointwise.derivatives(at.outputs), &at.matrices[0]));
        });
        pieces.into_iter().flatten().collect()
    }

    /// So many points at most where a value of them is largest, the largest first; of those that are numbers.
    pub(super) fn largest_of_derivatives(
        &self,
        at: [f64; 2],
        places: &Places,
        count: usize,
        value: impl Fn(&Derivatives<'_>, &MatrixAt) -> f64 + Sync,
    ) -> Vec<(f64, Place)> {
        let pieces = self.in_pieces(at, places, Asked::FIRST, Vec::new, |best, pointwise, place, at| {
            keep(best, count, value(&pointwise.derivatives(at.outputs), &at.matrices[0]), place);
        });
        merged(pieces, count)
    }

    /// The points where values of the bounds of [`TABLE`] are largest: for each of `lists` values at most `count` points, the largest first;
    /// of those that are numbers. `value(list, bounds)` is the value with this number; only the bounds in `asked` are computed.
    pub(super) fn largest_of_bounds(
        &self,
        at: [f64; 2],
        places: &Places,
        (asked, count, lists): (Asked, usize, usize),
        value: impl Fn(usize, &[f64; TABLE.len()]) -> f64 + Sync,
    ) -> Vec<Vec<(f64, Place)>> {
        let nothing = || vec![Vec::new(); lists];
        let mut pieces = self.in_pieces(at, places, asked, nothing, |best, pointwise, place, at| {
            let values = pointwise.at(at.outputs, &at.moment.velocity, at.matrices, asked);
            best.iter_mut().enumerate().for_each(|(list, best)| keep(best, count, value(list, &values), place));
        });
        let list = |list: usize| merged(pieces.iter_mut().map(|piece| std::mem::take(&mut piece[list])), count);
        (0..lists).map(list).collect()
    }

    /// The places where these of the table are largest, and where the last of them is least.
    pub(super) fn where_largest<const N: usize>(
        &self,
        at: [f64; 2],
        places: &Places,
        bounds: [Bound; N],
    ) -> Vec<Place> {
        let asked = bounds.into_iter().map(Asked::only).fold(Asked::NOTHING, Asked::and);
        let value = |list: usize, values: &[f64; TABLE.len()]| match bounds.get(list) {
            Some(bound) => of_table(*bound, values),
            None => bounds.last().map_or(f64::NAN, |bound| -of_table(*bound, values)),
        };
        let best = self.largest_of_bounds(at, places, (asked, OF_A_BOUND, N + 1), value);
        best.into_iter().flatten().map(|(_, place)| place).collect()
    }
}
