//! Loops with periodic coefficients, and a matrix inequality for each of them.

use nalgebra::{Complex, DMatrix, DVector};
use rand::RngExt;
use rand::rngs::StdRng;
use rug::Rational;
use serde_json::{Value, json};
use sigmastar_decide::bounds::{Engine, Region};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{ExistenceInequality, Specification, TrigonometricVector};
use sigmastar_matrix::AffineMatrix;
use sigmastar_propose::semidefinite::propose;
use std::f64::consts::TAU;

/// Boxes of a decision.
const EFFORT: usize = 20_000;

/// Instants at which the inequality is looked at, and how much too large a c_y is asked for.
const SAMPLED: usize = 128;
const TOO_LARGE: f64 = 1.002;

/// `[[f_x, f_e], [q_x, q_e]]` in the hull of these vertices: `sum_i (1 + cos(turns Om t - 2 pi i/count))/count` times the i-th one.
pub struct Loop {
    pub period: &'static str,
    pub omega: f64,
    /// w over Om, 1 where it is matched.
    pub ratio: f64,
    pub mu: f64,
    pub oscillators: usize,
    pub sigma: f64,
    pub vertices: Vec<DMatrix<f64>>,
    pub turns: usize,
    /// The first harmonic of q_0.
    pub first: usize,
}

/// The free numbers of an inequality.
pub struct Weights {
    pub p: DMatrix<f64>,
    pub k_p: f64,
    pub c_x: f64,
    pub c_y: f64,
    pub value: f64,
}

impl Weights {
    /// The largest c_y at one point; negative where there is none.
    fn largest(&self, vertex: &DMatrix<f64>) -> f64 {
        let n = self.p.nrows();
        let form = form(vertex, &self.p, [self.k_p, 1.0, self.value]) - diagonal(n, [self.c_x, 0.0, 0.0]);
        let column = form.view((0, n + 1), (n + 1, 1)).into_owned();
        let rest = form.view((0, 0), (n + 1, n + 1)).into_owned().cholesky();
        rest.map_or(-1.0, |rest| self.k_p - column.dot(&rest.solve(&column)))
    }
}

/// The places (i, j), i <= j, of a symmetric matrix.
fn triangle(n: usize) -> Vec<(usize, usize)> {
    (0..n).flat_map(|j| (0..=j).map(move |i| (i, j))).collect()
}

/// F for P, k_p, the weight w of e^2 and the threshold, as it is by (13.7c), but for c_x and c_y.
fn form(vertex: &DMatrix<f64>, p: &DMatrix<f64>, [k_p, w, value]: [f64; 3]) -> DMatrix<f64> {
    let n = p.nrows();
    let (j, g) = (vertex.view((0, 0), (n, n)), vertex.view((0, n), (n, 1)));
    let decay = -(p * j + j.transpose() * p);
    let column = -(p * g);
    DMatrix::from_fn(n + 2, n + 2, |a, b| match (a.min(b), a.max(b)) {
        (a, b) if b < n => decay[(a, b)],
        (a, b) if a < n && b == n => column[a],
        (a, _) if a < n => -0.5 * k_p * vertex[(n, a)],
        (a, b) if a == n && b == n => 2.0 * w * value,
        (a, _) if a == n => -w - 0.5 * k_p * vertex[(n, n)],
        _ => k_p,
    })
}

/// A matrix at all vertices, affine in P and so many others: its coefficients are differences.
fn constraints(
    vertices: &[DMatrix<f64>],
    others: usize,
    matrix: impl Fn(&DMatrix<f64>, &DMatrix<f64>, &[f64]) -> DMatrix<f64>,
) -> Vec<AffineMatrix<f64>> {
    let n = vertices[0].nrows() - 1;
    let places = triangle(n);
    let at = |vertex: &DMatrix<f64>, variable: Option<usize>| {
        let mut p = DMatrix::zeros(n, n);
        let mut rest = vec![0.0; others];
        match variable.map(|k| (k, places.get(k))) {
            Some((_, Some((i, j)))) => (p[(*i, *j)], p[(*j, *i)]) = (1.0, 1.0),
            Some((k, None)) => rest[k - places.len()] = 1.0,
            None => {}
        }
        matrix(vertex, &p, &rest)
    };
    let of_vertex = |vertex| {
        let constant = at(vertex, None);
        let terms: Vec<DMatrix<f64>> = (0..places.len() + others).map(|k| at(vertex, Some(k)) - &constant).collect();
        AffineMatrix::from_fn(n + 2, terms.len(), |i, j| constant[(i, j)], |k, i, j| terms[k][(i, j)])
    };
    vertices.iter().map(of_vertex).collect()
}

/// Minimises `cost` of what is beside P.
fn least(cost: &[f64], all: &[AffineMatrix<f64>]) -> Option<Vec<f64>> {
    let variables = all[0].terms().len();
    let cost: Vec<f64> = std::iter::repeat_n(0.0, variables - cost.len()).chain(cost.iter().copied()).collect();
    propose(&cost, all).ok().map(|found| found.x)
}

/// `diag(x, .., x, e, y)`.
fn diagonal(n: usize, [x, e, y]: [f64; 3]) -> DMatrix<f64> {
    DMatrix::from_diagonal(&DVector::from_iterator(n + 2, std::iter::repeat_n(x, n).chain([e, y])))
}

impl Loop {
    /// One to three states, each of which decays or grows, and a gain above the least one of an inequality, with its weights.
    pub fn random(random: &mut StdRng) -> Option<(Loop, Weights)> {
        let n = random.random_range(1..=3_usize);
        let count = random.random_range(1..=3_usize);
        let (period, omega) = [("1", TAU), ("2", TAU / 2.0), ("5/2", TAU / 2.5)][random.random_range(0..3_usize)];
        let signs: Vec<f64> = (0..n).map(|_| if random.random_bool(0.2) { 1.0 } else { -1.0 }).collect();
        let size = 10f64.powf(random.random_range(-1.0..0.5));
        let decays: Vec<f64> = (0..n).map(|_| 10f64.powf(random.random_range(-0.5..1.3))).collect();
        let vertex = |random: &mut StdRng| {
            DMatrix::from_fn(n + 1, n + 1, |i, j| match i == j && i < n {
                true => signs[i] * decays[i] * random.random_range(0.8..1.2),
                false => size * random.random_range(-1.0..1.0),
            })
        };
        let vertices: Vec<DMatrix<f64>> = (0..count).map(|_| vertex(random)).collect();
        let oscillators = [0, 1, 5, 20][random.random_range(0..4_usize)];
        let matched = random.random_bool(0.5);
        // At a matched frequency no harmonic of the oscillators leaves anything of v.
        let first = if matched && random.random_bool(0.8) { oscillators + 1 } else { 1 };
        let mut found = Loop {
            period,
            omega,
            ratio: if matched { 1.0 } else { (random.random_range(0.3..2.5_f64) * 1e3).round() / 1e3 },
            mu: (10f64.powf(random.random_range(-2.0..1.0)) * 1e4).round() / 1e4,
            oscillators,
            sigma: 0.0,
            vertices,
            turns: random.random_range(1..=2),
            first,
        };
        let weights = found.weights(random)?;
        found.sigma = weights.value * (1.0 + 10f64.powf(random.random_range(-3.0..0.5)));
        Some((found, weights))
    }

    /// A threshold above the least one, and the numbers that make c_y, and then c_x or the weight of e^2, large in units of k_p.
    fn weights(&self, random: &mut StdRng) -> Option<Weights> {
        let n = self.vertices[0].nrows() - 1;
        let places = triangle(n).len();
        let by_threshold = |vertex: &DMatrix<f64>, p: &DMatrix<f64>, rest: &[f64]| {
            let doubled = diagonal(n, [0.0, 2.0 * rest[1], 0.0]);
            form(vertex, p, [rest[0], 1.0, 0.0]) + doubled
        };
        let least_value = *least(&[0.0, 1.0], &constraints(&self.vertices, 2, by_threshold))?.last()?;
        let above = 1.0 + 10f64.powf(random.random_range(-1.0..1.5));
        let value = least_value.max(0.02 * self.omega) * above;
        let by_margin = |vertex: &DMatrix<f64>, p: &DMatrix<f64>, rest: &[f64]| {
            form(vertex, p, [1.0, rest[0], value]) - diagonal(n, [0.0, 0.0, rest[1]])
        };
        let largest = *least(&[0.0, -1.0], &constraints(&self.vertices, 2, by_margin))?.last()?;
        let c = largest * [0.3, 0.5, 0.7, 0.95, 0.998][random.random_range(0..5_usize)];
        let by_room = |vertex: &DMatrix<f64>, p: &DMatrix<f64>, rest: &[f64]| {
            form(vertex, p, [1.0, rest[0], value]) - diagonal(n, [rest[1], 0.0, c])
        };
        let found = least(&[0.0, -1.0], &constraints(&self.vertices, 2, by_room))?;
        let room = found[places + 1] * [0.01, 0.5, 0.999, 0.999][random.random_range(0..4_usize)];
        let by_weight = |vertex: &DMatrix<f64>, p: &DMatrix<f64>, rest: &[f64]| {
            form(vertex, p, [1.0, rest[0], value]) - diagonal(n, [room, 0.0, c])
        };
        let found = least(&[-1.0], &constraints(&self.vertices, 1, by_weight))?;
        let w = found[places];
        let mut p = DMatrix::zeros(n, n);
        for ((i, j), entry) in triangle(n).into_iter().zip(&found) {
            (p[(i, j)], p[(j, i)]) = (entry / w, entry / w);
        }
        // A little less than what the program found, so that rounding has no part in it.
        let [c_x, c_y] = [room, c].map(|value| value * (1.0 - 1e-5) / w);
        let weights = Weights { p, k_p: 1.0 / w, c_x, c_y, value };
        let holds = |vertex: &DMatrix<f64>| weights.largest(vertex) > weights.c_y;
        (c_x > 0.0 && c_y > 0.0 && w > 0.0 && self.vertices.iter().all(holds)).then_some(weights)
    }

    /// The derivatives at an instant, in periods.
    pub fn derivatives(&self, time: f64) -> DMatrix<f64> {
        let count = self.vertices.len();
        let part = |i: usize| match count {
            1 => 1.0,
            _ => (1.0 + (TAU * (self.turns as f64 * time - i as f64 / count as f64)).cos()) / count as f64,
        };
        self.vertices.iter().enumerate().map(|(i, vertex)| vertex * part(i)).reduce(|sum, part| sum + part).unwrap()
    }

    /// Their harmonics -turns, 0, turns.
    pub fn harmonics(&self) -> Vec<(i64, DMatrix<Complex<f64>>)> {
        let count = self.vertices.len() as f64;
        let sum = |factor: &dyn Fn(usize) -> Complex<f64>| {
            let parts = self.vertices.iter().enumerate().map(|(i, vertex)| vertex.map(|entry| factor(i) * entry));
            parts.reduce(|sum, part| sum + part).unwrap()
        };
        let mean = sum(&|_| Complex::from(1.0 / count));
        if self.vertices.len() == 1 {
            return vec![(0, mean)];
        }
        let turned = sum(&|i| Complex::from_polar(0.5 / count, -TAU * i as f64 / count));
        let turns = self.turns as i64;
        vec![(0, mean), (turns, turned.clone()), (-turns, turned.map(|entry| entry.conj()))]
    }

    /// The plant without a force.
    fn plant(&self) -> Plant {
        let (order, count) = (self.vertices[0].nrows(), self.vertices.len());
        let part = |i: usize| match count {
            1 => "1".to_owned(),
            _ => format!("(1 + cos(2*pi*{}*t/({}) - 2*pi*{i}/{count}))/{count}", self.turns, self.period),
        };
        let side = |row: usize| -> String {
            let term = |i: usize, column: usize| {
                let name = if column + 1 < order { format!("x{column}") } else { "e".to_owned() };
                format!("({})*{}*{name}", self.vertices[i][(row, column)], part(i))
            };
            let terms = (0..count).flat_map(|i| (0..order).map(move |column| (i, column)));
            terms.map(|(i, column)| term(i, column)).collect::<Vec<_>>().join(" + ")
        };
        let states: Vec<String> = (0..order - 1).map(|j| format!("x{j}")).collect();
        let text = json!({
            "format": "sigmastar/plant", "version": 1, "name": "a linear loop", "period": self.period, "states": states,
            "f": (0..order - 1).map(side).collect::<Vec<_>>(), "q": side(order - 1),
            "internal_model": self.model()
        });
        Plant::from_json("a linear loop", &text.to_string()).unwrap_or_else(|errors| panic!("{}", errors.render(false)))
    }

    /// That the engine proves the inequality, and does not with a c_y that is too large at an instant.
    pub fn decide(&self, weights: &Weights) -> Result<(), String> {
        let n = weights.p.nrows();
        let unit = (0..n).map(|i| (0..n).map(|j| Rational::from(u8::from(i == j))).collect()).collect();
        let orbit = TrigonometricVector { mean: vec![Rational::new(); n], harmonics: Vec::new() };
        let region = Region::new(unit, orbit, Rational::new()).expect("the unit matrix has an inverse");
        let engine = Engine::new(&self.plant(), region, None, None).expect("the region is the plant's");
        let exact = |value: f64| Rational::from_f64(value).expect("it is finite");
        let asked = |c_y: f64| {
            let Weights { p, k_p, c_x, value, .. } = weights;
            let inequality = ExistenceInequality {
                x: Rational::from(1),
                e: Rational::from(1),
                matrix: (0..n).map(|i| (0..n).map(|j| exact(p[(i, j)])).collect()).collect(),
                k_p: exact(*k_p),
                c_x: exact(*c_x),
                c_y: exact(c_y),
                value: exact(*value),
            };
            engine.decide_existence(&inequality, EFFORT).truth
        };
        let largest = (0..SAMPLED).map(|i| weights.largest(&self.derivatives(i as f64 / SAMPLED as f64)));
        let largest = largest.fold(f64::INFINITY, f64::min);
        if !asked(weights.c_y).is_true() {
            return Err(format!("c_y = {} is not proved, {largest} at instants", weights.c_y));
        }
        if asked(largest * TOO_LARGE).is_true() {
            return Err(format!("c_y = {} is proved, {largest} at instants", largest * TOO_LARGE));
        }
        Ok(())
    }

    /// The internal model of a file.
    fn model(&self) -> Value {
        json!({
            "mu": self.mu.to_string(), "base_frequency": format!("{}*2*pi/({})", self.ratio, self.period),
            "matched": self.ratio == 1.0, "weights": { "family": "power", "n0": "2", "epsilon": "1/2" }
        })
    }

    /// The specification with the harmonics of a force; nothing of its bounding functions is used.
    pub fn specification(&self, harmonics: &[f64], rest: f64) -> Specification {
        let text = json!({
            "format": "sigmastar/bounding-spec", "version": 1, "name": "a linear loop", "period": self.period,
            "lyapunov": { "p_low": "1", "p_up": "1", "alpha": "1" },
            "bounds": { "f": "1", "f_e": "1", "f_xx": "1", "f_ex": "1", "q": "1", "q_e": "1", "q_x": "1", "q_t": "1" },
            "q_0": { "harmonics": harmonics.iter().map(f64::to_string).collect::<Vec<_>>(), "rest_rms": rest.to_string() },
            "internal_model": self.model(),
            "initial_set": { "kind": "paper" }
        });
        Specification::from_json("a linear loop", &text.to_string())
            .unwrap_or_else(|errors| panic!("{}", errors.render(false)))
    }
}
