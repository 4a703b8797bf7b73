//! The written specification against the plant, by values and differences of its formulas.

#[path = "../../../prove/src/attempt/bound_tests/random_points.rs"]
mod random_points;

use super::bounding_specification;
use random_points::random_points;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::{Evaluator, Program};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Bound, Document, OfPlant, Specification, TrigonometricVector};
use sigmastar_prove::reduction::reduce_by_norms;
use std::sync::Arc;

/// The whole domain has what no part of it has: every bound is met at a corner, with x_0 = 0.
const MET: &str = r#"{ "format": "sigmastar/plant", "version": 1, "name": "met", "period": "1", "states": ["x"],
    "f": ["-x - x^3/10 + e*(1 + x^2)/2"], "q": "cos(2*pi*t)*(1 + x + e)/4 + e/8",
    "internal_model": { "mu": "1", "base_frequency": "2*pi", "matched": true,
        "weights": { "family": "power", "n0": "2", "epsilon": "1/2" } } }"#;

/// What only a specification has, and no table of values.
const OWN: [Bound; 5] = [Bound::F, Bound::Fxx, Bound::Fex, Bound::Q, Bound::Qt];

/// Steps of differences: of y and e, and of t.
const STEP: f64 = 1e-3;

/// Rounding and what differences leave out, relative and absolute.
const ROOM: f64 = 1e-4;

struct Formulas<'p> {
    evaluator: Evaluator,
    rows: Vec<Vec<f64>>,
    inverse: Vec<Vec<f64>>,
    orbit: &'p TrigonometricVector,
    period: f64,
    outputs: Vec<f64>,
}

impl<'p> Formulas<'p> {
    fn new(plant: &Plant, of_plant: &'p OfPlant) -> Formulas<'p> {
        let sides: Vec<_> = plant.f.iter().chain([&plant.q]).collect();
        let doubles = |rows: &[Vec<Rational>]| -> Vec<Vec<f64>> {
            rows.iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect()
        };
        Formulas {
            evaluator: Evaluator::new(Arc::new(Program::values(&sides, plant.states()))),
            rows: doubles(&of_plant.coordinates),
            inverse: doubles(&sigmastar_matrix::inverse(&of_plant.coordinates).unwrap()),
            orbit: &of_plant.cells[0].orbit.approximation.centre,
            period: plant.period.nominal().enclose(64).midpoint_f64(),
            outputs: vec![0.0; sides.len()],
        }
    }

    /// (L^-1 f, q) at t/T, x_0(t) + L y and e.
    fn at(&mut self, time: f64, y: &[f64], e: f64) -> (Vec<f64>, f64) {
        let wave = |i: usize| {
            let harmonics = self.orbit.harmonics.iter().zip(1..);
            let sum = harmonics.map(|([a, b], k)| {
                let (sin, cos) = (std::f64::consts::TAU * time * f64::from(k)).sin_cos();
                a[i].to_f64() * cos + b[i].to_f64() * sin
            });
            self.orbit.mean[i].to_f64() + sum.sum::<f64>()
        };
        let dot = |row: &[f64], y: &[f64]| -> f64 { row.iter().zip(y).map(|(a, b)| a * b).sum() };
        let x: Vec<f64> = self.rows.iter().enumerate().map(|(i, row)| wave(i) + dot(row, y)).collect();
        self.evaluator.set_time(time * self.period);
        self.evaluator.evaluate(&x, e, &mut self.outputs);
        let (q, f) = self.outputs.split_last().unwrap();
        (self.inverse.iter().map(|row| dot(row, f)).collect(), *q)
    }

    /// Lower estimates of what [`OWN`] bounds, along a direction u.
    fn sizes(&mut self, time: f64, y: &[f64], e: f64, u: &[f64]) -> [f64; 5] {
        let norm = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
        let zero = vec![0.0; y.len()];
        let moved = |h: f64| -> Vec<f64> { y.iter().zip(u).map(|(y, u)| y + h * u).collect() };
        let (rest, _) = self.at(time, &zero, 0.0);
        let (f, q) = self.at(time, y, e);
        let from_rest: Vec<f64> = f.iter().zip(&rest).map(|(f, rest)| f - rest).collect();
        let [above, below] = [STEP, -STEP].map(|h| self.at(time, &moved(h), e).0);
        let bend: Vec<f64> = (0..f.len()).map(|i| (above[i] - 2.0 * f[i] + below[i]) / STEP.powi(2)).collect();
        let [a, b, c, d] = [(STEP, STEP), (STEP, -STEP), (-STEP, STEP), (-STEP, -STEP)]
            .map(|(h, k)| self.at(time, &moved(h), e + k).0);
        let mixed: Vec<f64> = (0..f.len()).map(|i| (a[i] - b[i] - c[i] + d[i]) / (4.0 * STEP.powi(2))).collect();
        let [later, before] = [STEP, -STEP].map(|h| self.at(time + h, y, e).1);
        let q_t = (later - before) / (2.0 * STEP * self.period);
        [norm(&from_rest), norm(&bend), norm(&mixed), q.abs(), q_t.abs()]
    }
}

/// No bound is below what its points reach; the largest parts of each that are reached.
fn reached(plant: &Plant, domain: Option<[Rational; 2]>) -> [f64; 5] {
    let reduced = reduce_by_norms(plant).unwrap();
    let of_plant = reduced.spec.plant().unwrap();
    let bounded = bounding_specification(plant, &reduced.spec, domain).unwrap();
    let document = Document::parse("bounded", &bounded.document.to_string()).unwrap();
    let spec = Specification::from_value(&document.root()).unwrap();
    let [largest_x, largest_e] = bounded.domain.each_ref().map(|end| end.to_f64() - STEP);
    let mut formulas = Formulas::new(plant, of_plant);
    let directions = random_points(plant.states(), 3000);
    let mut largest = [0.0_f64; 5];
    for ((time, y, part), (_, u, _)) in directions.iter().zip(directions.iter().skip(7)) {
        let y: Vec<f64> = y.iter().map(|y| y * largest_x).collect();
        let u: Vec<f64> = u.iter().map(|v| v / u.iter().map(|v| v * v).sum::<f64>().sqrt()).collect();
        let e = part * largest_e;
        let exact = |value: f64| Enclosure::from_rational(&Rational::from_f64(value).unwrap(), 64);
        let x = exact(y.iter().map(|y| y * y).sum::<f64>().sqrt());
        let found = formulas.sizes(*time, &y, e, &u);
        for ((bound, found), largest) in OWN.into_iter().zip(found).zip(&mut largest) {
            let value = spec.bounds.at(bound, &x, &exact(e.abs())).upper_f64();
            let allowed = value * (1.0 + ROOM) + ROOM;
            assert!(found <= allowed, "{}: {} is {found}, not {value}", plant.name, bound.field());
            *largest = largest.max(found / value);
        }
    }
    largest
}

#[test]
fn bounds_that_are_met_somewhere_are_not_below_the_plant() {
    let document = Document::parse("met", MET).unwrap();
    let plant = Plant::from_value(&document.root()).unwrap();
    let domain = [Rational::from(2), Rational::from((3, 2))];
    let parts = reached(&plant, Some(domain));
    assert!(parts.iter().all(|part| *part > 0.9), "{parts:?}");
}

#[test]
fn bounds_of_three_states_are_not_below_the_plant() {
    let plant = Plant::from_json("chain", include_str!("../../../../specs/plants/chain.json")).unwrap();
    let parts = reached(&plant, None);
    assert!(parts.iter().all(|part| *part > 0.05), "{parts:?}");
}
