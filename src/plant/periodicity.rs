//! Whether the right sides have the stated period, as far as points can tell.

use super::Plant;
use crate::expr::Evaluator;
use std::fmt;
use std::sync::Arc;

/// Points at which the periodicity is checked.
const POINTS: u32 = 200;

/// The relative difference that rounding is given; t + T is itself rounded.
const TOLERANCE: f64 = 1e-7;

/// A point at which a right side differs from itself a period later.
#[derive(Clone, Debug)]
pub(super) struct Counterexample {
    /// The index of the right side: a state, or the number of states for q.
    pub(super) index: usize,
    t: f64,
    values: [f64; 2],
}

impl fmt::Display for Counterexample {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [now, later] = self.values;
        write!(f, "at some x and e it is {now:.6e} at t = {:.6} and {later:.6e} a period later", self.t)
    }
}

/// Compares the right sides at t and t + T at points that are spread evenly (an additive recurrence) over a period and
/// the box |x_i|, |e| <= 1.
pub(super) fn counterexample(plant: &Plant) -> Option<Counterexample> {
    let period = plant.period.to_f64();
    let program = Arc::new(plant.program());
    let mut evaluator = Evaluator::new(program.clone());
    let (mut now, mut later) = (vec![0.0; program.outputs()], vec![0.0; program.outputs()]);
    for point in 1..=POINTS {
        let coordinate =
            |along: u32| (f64::from(point) * f64::from(2 * along + 1).sqrt() * 0.618_033_988_749_894_9).fract();
        let t = coordinate(1) * period;
        let x: Vec<f64> = (0..plant.states()).map(|i| 2.0 * coordinate(3 + i as u32) - 1.0).collect();
        let e = 2.0 * coordinate(2) - 1.0;
        evaluator.set_time(t);
        evaluator.evaluate(&x, e, &mut now);
        evaluator.set_time(t + period);
        evaluator.evaluate(&x, e, &mut later);
        let size = now.iter().chain(&later).fold(1.0, |size: f64, value| size.max(value.abs()));
        // Where a right side is undefined there is nothing to compare.
        let differs = |(a, b): (&f64, &f64)| (a - b).abs() > TOLERANCE * size;
        if let Some(index) = now.iter().zip(&later).position(differs) {
            return Some(Counterexample { index, t, values: [now[index], later[index]] });
        }
    }
    None
}
