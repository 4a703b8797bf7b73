//! The interval through which a component of the orbit moves.

use super::chart::{MAX_LEVEL, Side};
use super::time_cell::Waves;
use crate::spec::TrigonometricVector;
use rug::Rational;

/// Points at which the extremes are sampled.
const SAMPLES: u32 = 512;

/// What is added to the sampled extremes, relative to the sum of the amplitudes; then 30 times as much, and so on.
const SLACK: f64 = 1e-5;
const GROWTH: f64 = 30.0;
const ATTEMPTS: u32 = 4;

/// The parts of the period of an attempt.
const MAX_PARTS: usize = 4096;

/// An interval that contains the component at all t, and is little larger than need be.
pub(super) fn extent(orbit: &TrigonometricVector, index: usize) -> [Rational; 2] {
    let mean = &orbit.mean[index];
    let pairs = || orbit.harmonics.iter().map(move |[a, b]| [&a[index], &b[index]]);
    let amplitude = pairs().flatten().fold(Rational::new(), |sum, value| sum + Rational::from(value.abs_ref()));
    if amplitude.is_zero() {
        return [mean.clone(), mean.clone()];
    }
    let doubles: Vec<[f64; 2]> = pairs().map(|pair| pair.map(Rational::to_f64)).collect();
    let value = |angle: f64| {
        doubles.iter().zip(1..).fold(mean.to_f64(), |sum, ([a, b], k)| {
            let (sin, cos) = libm::sincos(angle * f64::from(k));
            sum + a * cos + b * sin
        })
    };
    let angles = (0..SAMPLES).map(|sample| std::f64::consts::TAU * f64::from(sample) / f64::from(SAMPLES));
    let [low, high] = angles
        .map(value)
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)]);
    let size = amplitude.to_f64();
    // A sampled extreme is off by at most half of the second derivative times the square of half a step.
    let bend: f64 = doubles.iter().zip(1..).map(|([a, b], k)| f64::from(k * k) * (a.abs() + b.abs())).sum();
    let missed = bend * (std::f64::consts::PI / f64::from(SAMPLES)).powi(2) / 2.0;
    for attempt in 0..ATTEMPTS {
        let slack = missed + size * SLACK * GROWTH.powi(attempt as i32);
        let bounds = Rational::from_f64(low - slack).zip(Rational::from_f64(high + slack));
        if let Some((low, high)) = bounds
            && lies_within(orbit, index, &low, &high)
        {
            return [low, high];
        }
    }
    [Rational::from(mean - &amplitude), Rational::from(mean + &amplitude)]
}

/// Whether the component is proved to lie in the interval at all t.
fn lies_within(orbit: &TrigonometricVector, index: usize, low: &Rational, high: &Rational) -> bool {
    let mut open = vec![Side::WHOLE];
    let mut parts = 0;
    while let Some(side) = open.pop() {
        parts += 1;
        if parts > MAX_PARTS || side.level >= MAX_LEVEL {
            return false;
        }
        let coefficients = orbit.harmonics.iter().map(move |[a, b]| [&a[index], &b[index]]);
        let value = Waves::new(side, orbit.harmonics.len()).polynomial(&orbit.mean[index], coefficients, false);
        if !(*value.range.lower() >= *low && *value.range.upper() <= *high) {
            open.extend(side.halves());
        }
    }
    true
}
