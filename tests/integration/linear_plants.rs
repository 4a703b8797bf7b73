//! Bounds by the number of oscillators, of plants that are linear in x and e, against loops that are solved otherwise.

use nalgebra::{Complex, DMatrix, DVector};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rug::Rational;
use serde_json::{Value, json};
use sigmastar_decide::linear::{Answers, Falling, LinearPlant, Loop, PRECISION, Start, sizes};
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::Document;
use sigmastar_lang::spec::Oscillators;
use std::f64::consts::TAU;

const WEIGHTS: [f64; 2] = [2.0, 1.5];

fn plant(f: [&str; 2], q: &str) -> Plant {
    let document = json!({
        "format": "sigmastar/plant", "version": 1, "name": "linear", "period": 2, "states": ["v", "w"], "f": f, "q": q,
        "parameters": { "a": { "nominal": 1, "low": "4/5", "high": "6/5" } },
        "input_gain": { "nominal": 3, "low": "27/10", "high": "33/10" },
        "initial_set": { "kind": "aligned", "X0": 1, "E0": 1 },
        "internal_model": {
            "mu": 1, "base_frequency": "pi", "matched": true,
            "weights": { "family": "power", "n0": 2, "epsilon": "1/2" },
        },
    });
    Plant::from_value(&Document::parse("linear", &document.to_string()).unwrap().root()).unwrap()
}

fn example() -> Plant {
    plant(
        ["-2*a*v + w + e + cos(phase)", "-v - a*w/2 + sin(2*phase)*a"],
        "v - 3*w + e/2 + 1/2 + cos(phase)^2*2 + sin(4*phase)/a",
    )
}

/// `[[A, b], [c, d]]`, and the harmonics of f and q at x = 0, e = 0, of the example: those of `e^{i k Om t}`, k >= 0.
fn member(a: f64) -> (DMatrix<f64>, Vec<[Complex<f64>; 3]>) {
    let rows = DMatrix::from_row_slice(3, 3, &[-2.0 * a, 1.0, 1.0, -1.0, -a / 2.0, 0.0, 1.0, -3.0, 0.5]);
    let (zero, one, i) = (Complex::new(0.0, 0.0), Complex::new(1.0, 0.0), Complex::i());
    let waves = vec![
        [zero, zero, one * 1.5],
        [one * 0.5, zero, zero],
        [zero, -i * 0.5 * a, one * 0.5],
        [zero, zero, zero],
        [zero, zero, -i * 0.5 / a],
    ];
    (rows, waves)
}

fn weight(l: usize) -> f64 {
    if l == 0 { WEIGHTS[0] } else { (l as f64).powf(-WEIGHTS[1]) }
}

/// The loop of (x, e, z) with oscillators at these harmonics and 0, and its matrices Phi, M and N.
struct StateSpace {
    matrix: DMatrix<f64>,
    /// The control over (x, e, z).
    control: DVector<f64>,
    m: DVector<f64>,
    weights: DVector<f64>,
}

fn state_space(rows: &DMatrix<f64>, b: f64, sigma: f64, mu: f64, omega: f64, harmonics: &[u32]) -> StateSpace {
    let order = 2 * harmonics.len() + 1;
    let mut phi = DMatrix::zeros(order, order);
    let mut m = DVector::zeros(order);
    let mut weights = DVector::zeros(order);
    (m[0], weights[0]) = (1.0, weight(0));
    for (at, l) in (1..).step_by(2).zip(harmonics) {
        let l = *l as usize;
        (phi[(at, at + 1)], phi[(at + 1, at)]) = (l as f64 * omega, -(l as f64) * omega);
        m[at] = 1.0;
        (weights[at], weights[at + 1]) = (weight(l), weight(l));
    }
    let total = rows.nrows() - 1;
    let weighted = m.component_mul(&weights);
    // u = -sigma e + mu M'N (z - M e), z' = Phi z + Gamma e, Gamma = -(Phi + sigma I) M.
    let mut control = DVector::zeros(total + 1 + order);
    control[total] = -sigma - mu * weighted.dot(&m);
    control.rows_mut(total + 1, order).copy_from(&(&weighted * mu));
    let mut matrix = DMatrix::zeros(total + 1 + order, total + 1 + order);
    matrix.view_mut((0, 0), (total + 1, total + 1)).copy_from(rows);
    let own = matrix.row(total).into_owned() + control.transpose() * b;
    matrix.row_mut(total).copy_from(&own);
    let gamma = -(&phi + DMatrix::identity(order, order) * sigma) * &m;
    matrix.view_mut((total + 1, total), (order, 1)).copy_from(&gamma);
    matrix.view_mut((total + 1, total + 1), (order, order)).copy_from(&phi);
    StateSpace { matrix, control, m, weights }
}

/// (x, e, z) over the orbit at 400 instants of the period, and u there.
fn periodic(a: f64, b: f64, sigma: f64, oscillators: &Oscillators) -> (StateSpace, Vec<DVector<f64>>, Vec<f64>) {
    let (rows, waves) = member(a);
    let omega = TAU / 2.0;
    let space = state_space(&rows, b, sigma, 1.0, omega, oscillators.beyond_mean());
    let order = space.matrix.nrows();
    let complex = space.matrix.map(|entry| Complex::new(entry, 0.0));
    let zero_dynamics = rows.view((0, 0), (2, 2)).map(|entry| Complex::new(entry, 0.0));
    let mut harmonics = Vec::new();
    for (k, wave) in waves.iter().enumerate() {
        let at = Complex::new(0.0, k as f64 * omega);
        let solve = |matrix: &DMatrix<Complex<f64>>, right: DVector<Complex<f64>>| {
            let size = matrix.nrows();
            (DMatrix::identity(size, size) * at - matrix).lu().solve(&right).unwrap()
        };
        let mut right = DVector::zeros(order);
        for (i, part) in wave.iter().enumerate() {
            right[i] = *part;
        }
        let mut all = solve(&complex, right);
        let control = space.control.map(|entry| Complex::new(entry, 0.0)).dot(&all);
        let orbit = solve(&zero_dynamics, DVector::from_row_slice(&wave[..2]));
        for i in 0..2 {
            all[i] -= orbit[i];
        }
        harmonics.push((all, control));
    }
    let at = |step: usize| {
        let mut state = DVector::zeros(order);
        let mut control = 0.0;
        for (k, (all, u)) in harmonics.iter().enumerate() {
            let turn = Complex::from_polar(if k == 0 { 1.0 } else { 2.0 }, TAU * (k * step) as f64 / 400.0);
            state += all.map(|entry| (entry * turn).re);
            control += (u * turn).re;
        }
        (state, control)
    };
    let (states, controls) = (0..400).map(at).unzip();
    (space, states, controls)
}

fn own(sigma: i32, linear: &LinearPlant, plant: &Plant) -> Loop {
    let gain = plant.input_gain.as_ref().unwrap().factors(PRECISION);
    let identity = [[1, 0], [0, 1]].map(|row| row.map(Rational::from).to_vec()).to_vec();
    Loop::new(&Rational::from(sigma), &plant.internal_model, linear.lines().max(8), gain, identity)
}

/// |zeta|_N.
fn norm(space: &StateSpace, state: &DVector<f64>) -> f64 {
    let order = space.m.len();
    let zeta = state.rows(3, order) - &space.m * state[2];
    zeta.component_mul(&zeta).dot(&space.weights).sqrt()
}

#[test]
fn sizes_are_those_of_the_worst_member() {
    let plant = example();
    let linear = LinearPlant::of(&plant).unwrap();
    assert_eq!(linear.lines(), 4);
    for sigma in [12, 40] {
        let own = own(sigma, &linear, &plant);
        let answers = Answers::new(&linear, own.clock());
        let sets = [&[0, 1, 4][..], &[0, 2], &[0, 3, 7], &[0, 1, 3, 8]].map(|set| Oscillators::at(set).unwrap());
        for oscillators in (0..=5).map(Oscillators::first).chain(sets) {
            let found = sizes(&answers, &own, &oscillators, 8192).unwrap();
            let mut largest = [0.0_f64; 4];
            for (a, b) in [(0.8, 0.9), (0.8, 1.1), (1.2, 0.9), (1.2, 1.1), (1.0, 1.0), (1.0, 0.9), (1.1, 0.93)] {
                let (space, states, controls) = periodic(a, b, f64::from(sigma), &oscillators);
                for (state, control) in states.iter().zip(&controls) {
                    let own = [state[2].abs(), control.abs(), state[0].hypot(state[1]), norm(&space, state)];
                    largest = std::array::from_fn(|i| largest[i].max(own[i]));
                }
            }
            let bounds = [&found.error, &found.control, &found.states, &found.zeta].map(Enclosure::upper_f64);
            for (i, room) in [1.02, 1.02, 1.6, 1.6].into_iter().enumerate() {
                let slack = 1e-9 * (1.0 + largest[i]);
                assert!(largest[i] <= bounds[i] + slack, "{sigma} {oscillators} {i}: {largest:?} {bounds:?}");
                assert!(bounds[i] <= room * largest[i] + slack, "{sigma} {oscillators} {i}: {largest:?} {bounds:?}");
            }
        }
    }
}

/// The steps of a few periods from starts all around, against the peaks of a form that falls; and forms that do not are refused.
#[test]
fn nothing_goes_beyond_the_peaks() {
    let plant = example();
    let linear = LinearPlant::of(&plant).unwrap();
    let identity = [[1, 0], [0, 1]].map(|row| row.map(Rational::from).to_vec()).to_vec();
    let own = own(40, &linear, &plant);
    let form = |p: (i32, i32), k_p: (i32, i32)| Falling {
        matrix: identity.iter().map(|row| row.iter().map(|one| one * Rational::from(p)).collect()).collect(),
        p_up: Rational::from(p) + Rational::from((1, 1000)),
        weight: Rational::from(1),
        k_p: Rational::from(k_p),
        held: None,
    };
    let falling = form((1, 2), (1, 20));
    assert_eq!(falling.decide(&linear, &own, &identity), Truth::True);
    for (wrong, is) in [
        (form((1, 2), (-1, 20)), Truth::False),
        (Falling { p_up: Rational::from((49, 100)), ..falling.clone() }, Truth::False),
        (Falling { weight: Rational::new(), ..falling.clone() }, Truth::False),
        (form((1, 2), (1, 2000)), Truth::Undecided),
        (form((500, 1), (1, 20)), Truth::Undecided),
    ] {
        assert_eq!(wrong.decide(&linear, &own, &identity), is, "{wrong:?}");
    }
    let answers = Answers::new(&linear, own.clock());
    let exact = |value: i32| Enclosure::from_integer(i64::from(value), PRECISION);
    let start = Start { x0: exact(1), e0: exact(2), z0: None, y0: exact(0) };
    let mut random = StdRng::seed_from_u64(14);
    let mut nearest = 0.0_f64;
    for oscillators in [0.into(), 2.into(), 5.into(), Oscillators::at(&[0, 2, 3, 8]).unwrap()] {
        let steady = sizes(&answers, &own, &oscillators, 8192).unwrap();
        let peak = falling.peak(&own, &start, &steady);
        let [of_e, of_u] = [&peak.error, &peak.control].map(Enclosure::upper_f64);
        for _ in 0..40 {
            let pick = |random: &mut StdRng, ends: [f64; 2]| ends[usize::from(random.random::<bool>())];
            let (a, b) = (pick(&mut random, [0.8, 1.2]), pick(&mut random, [0.9, 1.1]));
            let (space, states, _) = periodic(a, b, 40.0, &oscillators);
            let (angle, e) = (random.random::<f64>() * TAU, pick(&mut random, [-2.0, 2.0]));
            let at = random.random_range(0..400);
            // The difference from the periodic solution, aligned: z = M e.
            let mut difference = -states[at].clone();
            difference[0] += angle.cos();
            difference[1] += angle.sin();
            difference[2] += e;
            for (i, m) in space.m.iter().enumerate() {
                difference[3 + i] += m * e;
            }
            let step = 1e-3;
            for _ in 0..3000 {
                let (error, control) = (difference[2].abs(), space.control.dot(&difference).abs());
                assert!(error <= of_e && control <= of_u, "{oscillators}: {error} {of_e} {control} {of_u}");
                nearest = nearest.max(error / of_e).max(control / of_u);
                let k_1 = &space.matrix * &difference;
                let k_2 = &space.matrix * (&difference + &k_1 * (step / 2.0));
                let k_3 = &space.matrix * (&difference + &k_2 * (step / 2.0));
                let k_4 = &space.matrix * (&difference + &k_3 * step);
                difference += (k_1 + k_2 * 2.0 + k_3 * 2.0 + k_4) * (step / 6.0);
            }
        }
    }
    assert!(nearest > 0.5, "{nearest}");
}

#[test]
fn what_is_not_linear_or_has_no_harmonics_is_not_read() {
    for (f, q) in [
        (["-2*a*v + w + e + v^2", "-v - w"], "v"),
        (["-2*a*v + w*cos(phase) + e", "-v - w"], "v"),
        (["-2*a*v + w + e", "-v - w"], "v*e"),
        (["-2*a*v + w + e", "-v - w"], "v + exp(cos(phase))"),
        (["-2*a*v + w + e", "-v - w + abs(e)"], "v"),
        (["-2*a*v + w + e", "-v - w"], "v + cos(17*phase)"),
        (["-2*a*v + w + e", "-v - w"], "v + 0*log(2 + e)"),
    ] {
        assert!(LinearPlant::of(&plant(f, q)).is_none(), "{f:?} {q}");
    }
    // A constant that is written otherwise, and a period that is not known exactly.
    assert!(LinearPlant::of(&plant(["-2*a*v + w + e/exp(a)", "-v - w*sqrt(a)"], "v + (a*e - cos(phase))/2")).is_some());
    let mut document: Value = example().document;
    document["period"] = json!({ "nominal": 2, "low": "19/10", "high": "21/10" });
    document["internal_model"]["matched"] = json!(false);
    let text = document.to_string();
    let plant = Plant::from_value(&Document::parse("period", &text).unwrap().root()).unwrap();
    assert!(LinearPlant::of(&plant).is_none());
}
