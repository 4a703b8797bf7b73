//! Bounds of random plants that are stated 0.1 % below a value which is met: neither program may prove one.

use super::plants::Drawn;
use super::random;
use crate::support::cases;
use rand::RngExt;
use rand::rngs::StdRng;
use rug::Rational;
use sigmastar_lang::spec::Bound;
use sigmastar_propose::bounds::FloatSuprema;
use sigmastar_theory::evidence::{Entry, TABLE};

/// Below a value that is met, and well above what is sampled.
const BELOW: f64 = -0.001;
const ABOVE: f64 = 0.3;

/// Boxes that the producer may take.
const BOXES: usize = 300;

/// What is smaller is rounding.
const LEAST: f64 = 1e-6;

/// Points t/T, y, e/E: on the ray along which the features change, dense at its end, and others.
fn points(drawn: &Drawn, random: &mut StdRng) -> Vec<(f64, Vec<f64>, f64)> {
    let mut points = Vec::new();
    for step in 0..70 {
        // The last sixty within a fifth of the rim.
        let part = if step < 10 { f64::from(step) / 10.0 } else { 1.0 - 0.2 * f64::from(step - 10) / 60.0 };
        let y: Vec<f64> = drawn.ray.iter().map(|c| c * part).collect();
        for time in [0.0, 0.25, 0.5, 0.75] {
            points.extend([1.0, -1.0].map(|e| (time, y.clone(), e)));
        }
    }
    for _ in 0..150 {
        let mut y: Vec<f64> = drawn.ray.iter().map(|_| random.random_range(-1.0..1.0)).collect();
        let norm = y.iter().map(|y| y * y).sum::<f64>().sqrt().max(1.0);
        y.iter_mut().for_each(|y| *y /= norm);
        points.push((random.random_range(0.0..1.0), y, random.random_range(-1.0..=1.0)));
    }
    points
}

/// A value this part of itself above the largest that is met (of a rate below the least); `None` where that is about 0.
fn stated(drawn: &Drawn, samples: &FloatSuprema, kind: Bound, random: &mut StdRng, part: f64) -> Option<Rational> {
    let largest = samples.largest_at(kind, [drawn.x.to_f64(), drawn.e.to_f64()], &points(drawn, random));
    let moved = largest + part * largest.abs();
    let value = Rational::from_f64(if kind.is_rate() { -moved } else { moved })?;
    (largest.abs() > LEAST).then_some(value)
}

#[test]
fn fuzz_bounds_of_plants_by_the_producer() {
    let (mut tried, mut accepted) = (0, 0);
    for case in cases(4, 1000) {
        let random = &mut random(5, case);
        let drawn = Drawn::new(random);
        let (engine, samples) = (drawn.engine(), drawn.samples());
        for kind in TABLE {
            let mut decide = |part: f64| {
                let value = stated(&drawn, &samples, kind, random, part)?;
                let entry = Entry { bound: kind, x: drawn.x.clone(), e: drawn.e.clone(), value };
                Some((engine.decide(&entry, BOXES).truth.is_true(), entry.value.to_f64()))
            };
            let Some((proved, value)) = decide(BELOW) else { continue };
            assert!(!proved, "case {case}: {} at {value}: {}", kind.field(), drawn.name());
            if case % 3 > 0 {
                continue;
            }
            tried += 1;
            accepted += u32::from(decide(ABOVE).is_some_and(|(proved, _)| proved));
        }
    }
    println!("{accepted} of {tried} true values proved");
    assert!(tried == 0 || accepted > 0, "nothing is proved, so nothing is tested");
}

#[test]
fn fuzz_bounds_of_plants_by_the_checker() {
    let (mut refused, mut accepted, mut open) = (0, 0, 0);
    let large = Rational::from(1) << 60;
    for case in cases(9, 1200) {
        let random = &mut random(6, case);
        let drawn = Drawn::new(random);
        let samples = drawn.samples();
        let kind = TABLE[(case % 9) as usize];
        let mut checked = |part: f64| {
            let value = stated(&drawn, &samples, kind, random, part)?;
            let witness = drawn.witness(&drawn.proof(), [&large, &large], &[(kind.field(), &value)]);
            Some((drawn.checked(&witness), value.to_f64()))
        };
        let Some((proved, value)) = checked(BELOW) else { continue };
        assert!(proved != Some(true), "case {case}: {} at {value}: {}", kind.field(), drawn.name());
        if case % 3 > 0 {
            continue;
        }
        match checked(ABOVE) {
            Some((Some(true), _)) => accepted += 1,
            Some((Some(false), _)) => refused += 1,
            _ => open += 1,
        }
    }
    println!("true values: {accepted} proved, {refused} refused, {open} beyond the steps");
    assert!(accepted + refused + open == 0 || accepted > 0, "nothing is proved, so nothing is tested");
}
