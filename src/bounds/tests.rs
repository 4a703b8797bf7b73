//! Decided bounds against samples, and the paper's plant.

use super::*;
use crate::expr::Evaluator;
use crate::number::{Direction, round_f64};
use crate::plant::Plant;
use crate::spec::{PeriodicMatrix, TrigonometricVector};
use rug::Rational;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

fn rational(text: &str) -> Rational {
    crate::number::parse_decimal(text).unwrap()
}

fn paper() -> Plant {
    Plant::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("specs/plants/paper-example.json")).unwrap()
}

/// The orbit by Runge and Kutta, and its Fourier coefficients to nine digits.
fn orbit_of(plant: &Plant, degree: usize) -> TrigonometricVector {
    let (n, steps) = (plant.states(), 512);
    let program = Arc::new(plant.program());
    let mut evaluator = Evaluator::new(program.clone());
    let h = plant.period.to_f64() / steps as f64;
    let mut slope = |t: f64, x: &[f64]| {
        let mut out = vec![0.0; program.outputs()];
        evaluator.set_time(t);
        evaluator.evaluate(x, 0.0, &mut out);
        out
    };
    let plus = |x: &[f64], k: &[f64], h: f64| -> Vec<f64> { x.iter().zip(k).map(|(x, k)| x + h * k).collect() };
    let mut x = vec![0.0; n];
    let mut samples = Vec::new();
    for step in 0..100 * steps {
        if step >= 99 * steps {
            samples.push(x.clone());
        }
        let t = step as f64 * h;
        let a = slope(t, &x);
        let b = slope(t + h / 2.0, &plus(&x, &a, h / 2.0));
        let c = slope(t + h / 2.0, &plus(&x, &b, h / 2.0));
        let d = slope(t + h, &plus(&x, &c, h));
        x = (0..n).map(|i| x[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i])).collect();
    }
    let short = |value: f64| Rational::from(((value * 1e9).round() as i64, 1_000_000_000));
    let coefficient = |wave: &dyn Fn(f64) -> f64| -> Vec<Rational> {
        (0..n)
            .map(|i| {
                let sum: f64 = samples.iter().enumerate().map(|(s, x)| x[i] * wave(s as f64 / steps as f64)).sum();
                short(sum / steps as f64)
            })
            .collect()
    };
    let turn = std::f64::consts::TAU;
    let harmonics = (1..=degree)
        .map(|k| {
            let k = k as f64;
            [coefficient(&|s| 2.0 * (turn * k * s).cos()), coefficient(&|s| 2.0 * (turn * k * s).sin())]
        })
        .collect();
    TrigonometricVector { mean: coefficient(&|_| 1.0), harmonics }
}

fn identity(order: usize) -> PeriodicMatrix {
    let row = |i: usize| (0..order).map(|j| Rational::from(u8::from(i == j))).collect();
    PeriodicMatrix { mean: (0..order).map(row).collect(), harmonics: Vec::new() }
}

struct Case {
    engine: Engine,
    samples: FloatSuprema,
}

fn case(plant: &Plant, matrix: &[Vec<f64>], orbit: TrigonometricVector, radius: &str) -> Case {
    let exact: Vec<Vec<Rational>> =
        matrix.iter().map(|row| row.iter().map(|v| round_f64(*v, 4, Direction::Nearest).unwrap()).collect()).collect();
    let doubles = exact.iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect();
    let p = identity(plant.states());
    let samples = FloatSuprema::new(plant, FloatOrbit::from(&orbit), doubles, [Some(&p), None]);
    let region = Region::new(exact, orbit, rational(radius)).unwrap();
    Case { engine: Engine::new(plant, region, Some(p), None).unwrap(), samples }
}

/// L with its second row of length 1 and the best rate on (X,E), by trial.
fn best_matrix(plant: &Plant, orbit: &TrigonometricVector, x: f64, e: f64) -> Vec<Vec<f64>> {
    let p = identity(2);
    let candidate = |b: f64, c: f64| {
        // L L^T = P^-1 scaled to a second diagonal entry 1: [[c, b], [b, 1]] with c > b^2.
        let root = (c - b * b).sqrt();
        vec![vec![root, b], vec![0.0, 1.0]]
    };
    let rate = |matrix: &Vec<Vec<f64>>| {
        let samples = FloatSuprema::new(plant, FloatOrbit::from(orbit), matrix.clone(), [Some(&p), None]);
        samples.at(Kind::Rate, x, e)
    };
    let (mut best, mut at, mut step) = (f64::NEG_INFINITY, (0.0, 1.0), 0.2);
    while step > 1e-3 {
        let around = [(0.0, 0.0), (step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step), (step, step), (-step, -step)];
        let found = around
            .iter()
            .map(|(b, c)| (at.0 + b, at.1 + c))
            .filter(|(b, c)| c - b * b > 0.05)
            .map(|(b, c)| (rate(&candidate(b, c)), (b, c)))
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap();
        if found.0 > best + 1e-9 {
            (best, at) = found;
        } else {
            step /= 2.0;
        }
    }
    candidate(at.0, at.1)
}

#[test]
fn the_papers_plant() {
    let plant = paper();
    let orbit = orbit_of(&plant, 12);
    for (x, e, rate) in [("0.5", "0.1", 0.497), ("0.7", "0.15", 0.449), ("1", "0.2", 0.389)] {
        let (x, e) = (rational(x), rational(e));
        let matrix = best_matrix(&plant, &orbit, x.to_f64(), e.to_f64());
        let case = case(&plant, &matrix, orbit.clone(), "1e-6");
        let proved = case.engine.prove_value(&case.samples, Kind::Rate, &x, &e).unwrap();
        println!("rate on ({x}, {e}): {} against {rate}", proved.value.to_f64());
        assert!((proved.value.to_f64() - rate).abs() < 0.003, "{proved:?}");
    }
    let matrix = best_matrix(&plant, &orbit, 0.5, 0.1);
    let case = case(&plant, &matrix, orbit, "1e-6");
    for e in ["0", "0.1", "1", "4"] {
        let (x, e) = (rational("0.5"), rational(e));
        let start = Instant::now();
        let all = case.samples.survey(0.5, e.to_f64(), 1);
        println!("(0.5, {e}): all sampled in {:.2} ms: {all:.4?}", start.elapsed().as_secs_f64() * 1e3);
        for kind in Kind::ALL.into_iter().filter(|kind| *kind != Kind::RateExistence) {
            let start = Instant::now();
            let sampled = case.samples.refined(kind, 0.5, e.to_f64());
            let refined = start.elapsed().as_secs_f64() * 1e3;
            let proved = case.engine.prove_value(&case.samples, kind, &x, &e);
            let time = start.elapsed().as_secs_f64() * 1e3 - refined;
            let name = kind.name();
            println!("  {name:8} {:10.5} {refined:5.1} ms; {time:7.1} ms, {proved:?}", sampled.value);
            assert!(proved.is_some_and(|proved| proved.slack <= 0.01), "{name}");
        }
        assert_eq!(case.engine.smooth(&x, &e), Ok(()));
    }
}
