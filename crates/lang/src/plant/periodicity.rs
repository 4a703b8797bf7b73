//! Whether the right sides have the stated period: as far as points can tell, and by proof.

use super::Plant;
use crate::expr::{Evaluator, NotPeriodic, PeriodicityReason, PlantExpr, Program};
use crate::spec::Constant;
use sigmastar_exact::number::told_apart;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;
use thiserror::Error;

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
        let [now, later] = told_apart(self.values);
        write!(f, "at some x and e it is about {now} near t = {:.6e} and {later} a period later", self.t)
    }
}

/// Compares the right sides at t and t + T at points that are spread evenly (an additive recurrence) over a period and
/// the box |x_i|, |e| <= 1.
pub(super) fn counterexample(program: Program, states: usize, period: &Constant) -> Option<Counterexample> {
    let period = period.to_f64();
    let program = Arc::new(program);
    let mut evaluator = Evaluator::new(program.clone());
    let (mut now, mut later) = (vec![0.0; program.outputs()], vec![0.0; program.outputs()]);
    for point in 1..=POINTS {
        let coordinate =
            |along: u32| (f64::from(point) * f64::from(2 * along + 1).sqrt() * 0.618_033_988_749_894_9).fract();
        let t = coordinate(1) * period;
        let x: Vec<f64> = (0..states).map(|i| 2.0 * coordinate(3 + i as u32) - 1.0).collect();
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

/// A right side that is not proved to have the period of its plant.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{part}`: {reason}")]
pub struct PeriodicityFailure {
    /// The index of the right side: a state, or the number of states for q.
    pub index: usize,
    /// The bytes of the part at fault in the text of the right side.
    pub span: Range<usize>,
    /// The part at fault.
    pub part: String,
    /// Why.
    pub reason: PeriodicityReason,
}

impl Plant {
    /// Proves that f and q have the period in t, for every x and e (derivation, 11.1).
    ///
    /// # Errors
    /// The first part that has not the form which is asked for there; it says nothing against the period.
    pub fn prove_periodic(&self) -> Result<(), PeriodicityFailure> {
        let mut all = self.right_sides().into_iter().enumerate();
        all.try_for_each(|(index, expr)| decide(expr, index, self.period.nominal()))
    }
}

/// Proves that one right side has the period, or returns the first part that is not seen to have it.
pub(super) fn decide(expr: &PlantExpr, index: usize, period: &Constant) -> Result<(), PeriodicityFailure> {
    expr.prove_periodic(period.exact.as_ref()).map_err(|NotPeriodic { span, reason }| {
        let part = expr.text().get(span.clone()).unwrap_or_default().to_owned();
        PeriodicityFailure { index, span, part, reason }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plants_of_the_examples_are_periodic() {
        for name in ["paper-example", "linear"] {
            let file = format!("{}/../../specs/plants/{name}.json", env!("CARGO_MANIFEST_DIR"));
            let mut plant = Plant::from_json(name, &std::fs::read_to_string(file).unwrap()).unwrap();
            assert_eq!(plant.prove_periodic(), Ok(()));
            plant.period = crate::spec::Constant::rational(&rug::Rational::from((2, 3))).into();
            let failure = plant.prove_periodic().unwrap_err();
            assert_eq!(failure.reason, PeriodicityReason::Frequency, "{failure}");
        }
    }
}
