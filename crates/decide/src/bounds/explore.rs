//! Where a bound is large: its values in the middles of boxes, the most promising box first. A feature that samples miss is
//! found where an enclosure cannot leave it out. The result is in doubles; it serves the next attempt, and no verdict rests on it.

use super::chart::{Cell, MAX_LEVEL};
use super::decide::OnBoxes;
use super::definite::Verdict;
use super::engine::{Engine, Tube};
use super::side::Side;
use rug::Rational;
use sigmastar_lang::spec::Bound;

/// What was met, of a rate downwards.
#[derive(Clone, Copy, Debug)]
pub struct Explored {
    /// The largest value in the middle of a box (of a rate the least), or what was known before.
    pub largest: f64,
    /// What the boxes that are left allow; infinite where one of them allows anything.
    pub above: f64,
}

impl Engine {
    /// Looks at so many boxes of `G(X,E)`, in each cell of a family, for values that exceed `known`, until none may exceed the largest by
    /// more than `room`.
    pub fn explore(&self, kind: Bound, at: [&Rational; 2], (known, room): (f64, f64), effort: usize) -> Explored {
        let sign = if kind.is_rate() { -1.0 } else { 1.0 };
        let nothing = Explored { largest: known, above: sign * f64::NEG_INFINITY };
        self.tubes().fold(nothing, |all, tube| {
            let found = self.explore_cell(tube, kind, at, (all.largest, room), effort);
            Explored { above: sign * (sign * found.above).max(sign * all.above), ..found }
        })
    }

    fn explore_cell(
        &self,
        tube: &Tube,
        kind: Bound,
        [x, e]: [&Rational; 2],
        (known, room): (f64, f64),
        effort: usize,
    ) -> Explored {
        let sign = if kind.is_rate() { -1.0 } else { 1.0 };
        // Of what is not computed nothing is known.
        let Some(quantity) = self.quantity(kind) else {
            return Explored { largest: known, above: sign * f64::INFINITY };
        };
        let chart = self.chart(tube, &quantity.active, [x, e]);
        let mut boxes = OnBoxes::new(self, quantity, (tube, &chart));
        let mut largest = sign * known;
        let mut open: Vec<(f64, Cell)> = vec![(f64::INFINITY, vec![Side::WHOLE; chart.sides()])];
        let mut stuck = false;
        for _ in 0..effort {
            // The first of the most promising.
            let first = (0..open.len()).reduce(|best, at| if open[at].0 > open[best].0 { at } else { best });
            let Some((most, cell)) = first.map(|at| open.swap_remove(at)) else { break };
            let Some(ball) = chart.ball(&cell) else { continue };
            let inside = ball.has_its_middle();
            let (value, verdict) = boxes.with(&cell, &ball, |values, frame| {
                let [middle, reach] = values.middle(kind);
                if inside && middle > largest {
                    largest = middle;
                }
                let bound = Rational::from_f64(sign * (largest + room));
                let verdict =
                    bound.map_or(Verdict::Stuck, |bound| values.examine(kind, &frame.rational(&bound), &ball));
                (middle + reach, verdict)
            });
            let side = match verdict {
                Verdict::Holds => continue,
                Verdict::Halve(side) => Some(side),
                Verdict::Fails | Verdict::Stuck => (0..cell.len()).min_by_key(|&side| cell[side].level),
            };
            let Some(side) = side.filter(|side| cell[*side].level < MAX_LEVEL) else {
                stuck = true;
                continue;
            };
            let most = if value.is_nan() { most } else { most.min(value) };
            for half in cell[side].halves() {
                let mut next = cell.clone();
                next[side] = half;
                open.push((most, next));
            }
        }
        let above = open.iter().map(|(most, _)| *most).fold(largest + room, f64::max);
        Explored { largest: sign * largest, above: if stuck { sign * f64::INFINITY } else { sign * above } }
    }
}
