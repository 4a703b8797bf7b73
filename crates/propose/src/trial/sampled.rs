//! How good a trial is: its defects at some times and of some members.

use crate::orbit::FloatSeries;
use rug::Rational;
use sigmastar_lang::expr::Evaluator;
use sigmastar_lang::plant::Plant;
use std::sync::Arc;

/// Times of a period, and over what share of it a slope is taken.
const TIMES: usize = 256;
const STEP: f64 = 1e-4;

/// The largest `|L^-1 (f - x')|`, `|q|` and slope of q along a curve of states at e = 0 that are met, of the nominal member and the corners of the
/// box, and of those half way to them; `inverse` is L^-1.
#[must_use]
pub fn sampled_defects(plant: &Plant, curve: &FloatSeries, inverse: &[Vec<f64>]) -> [f64; 3] {
    let n = plant.states();
    let period = plant.period.nominal().to_f64();
    let corners = plant.parameters.looked_at();
    let nominal = plant.parameters.nominal();
    let half_way = |corner: &Vec<Rational>| -> Vec<Rational> {
        corner.iter().zip(&nominal).map(|(a, b)| Rational::from(a + b) / 2).collect()
    };
    let between: Vec<Vec<Rational>> = corners.iter().skip(1).map(half_way).collect();
    let mut largest = [0.0_f64; 3];
    for member in corners.iter().chain(&between) {
        let values: Vec<f64> = member.iter().map(Rational::to_f64).collect();
        let mut evaluator = Evaluator::new(Arc::new(plant.program().with_parameters(&values)));
        let mut outputs = vec![0.0; n + 1];
        let mut at = |s: f64| {
            let (x, slope) = curve.at(s);
            evaluator.set_time(s * period);
            evaluator.evaluate(&x, 0.0, &mut outputs);
            let apart: Vec<f64> = (0..n).map(|i| outputs[i] - slope[i] / period).collect();
            (apart, outputs[n])
        };
        for j in 0..TIMES {
            let s = j as f64 / TIMES as f64;
            let (apart, q) = at(s);
            let row = |row: &Vec<f64>| row.iter().zip(&apart).map(|(l, x)| l * x).sum::<f64>();
            let length = inverse.iter().map(|of| row(of) * row(of)).sum::<f64>().sqrt();
            let slope = (at(s + STEP).1 - at(s - STEP).1) / (2.0 * STEP * period);
            largest = [largest[0].max(length), largest[1].max(q.abs()), largest[2].max(slope.abs())];
        }
    }
    largest
}
