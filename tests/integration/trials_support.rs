//! What the tests of trials have in common: a plant of one state, its simulation, and a trial with what proves it.

use rug::Rational;
use serde_json::{Value, json};
use sigmastar_decide::bounds::StatesForm;
use sigmastar_decide::linear::{Loop, PRECISION};
use sigmastar_decide::trial::{Trial, TubeProof};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Document, Interval, Level, Metric, OrbitCurve, TrigonometricVector};
use sigmastar_propose::trial::{Members, TrialLoop};
use std::f64::consts::PI;

const WEIGHTS: [f64; 2] = [2.0, 1.5];
const MU: f64 = 1.0;
pub const OMEGA: f64 = PI;

pub fn weight(l: usize) -> f64 {
    if l == 0 { WEIGHTS[0] } else { (l as f64).powf(-WEIGHTS[1]) }
}

/// `x' = -2 x - x^3/3 + e + cos(phase)`, `e' = x/2 - atan(e) + sin(phase) + sin(2 phase)/2 + u`, period 2.
pub fn document() -> Value {
    json!({
        "format": "sigmastar/plant", "version": 1, "name": "one state", "period": 2, "states": ["v"],
        "f": ["-2*v - v^3/3 + e + cos(phase)"], "q": "v/2 - atan(e) + sin(phase) + sin(2*phase)/2",
        "initial_set": { "kind": "aligned", "X0": "1/2", "E0": "1/2" },
        "internal_model": {
            "mu": 1, "base_frequency": "pi", "matched": true, "weights": { "family": "power", "n0": 2, "epsilon": "1/2" },
        },
    })
}

pub fn plant() -> Plant {
    Plant::from_value(&Document::parse("one state", &document().to_string()).unwrap().root()).unwrap()
}

/// The right side of the loop with oscillators at these harmonics and 0 at (x, e, z), and u: z' = Phi z + Gamma e, u = -sigma e + mu M'N (z - M e).
fn right_side(sigma: f64, harmonics: &[usize], t: f64, y: &[f64]) -> (Vec<f64>, f64) {
    let (x, e) = (y[0], y[1]);
    let phase = OMEGA * t;
    // z_0, and where the states of each oscillator begin.
    let blocks = (3..).step_by(2).zip(harmonics);
    let of_z = blocks.clone().fold(weight(0) * (y[2] - e), |sum, (at, l)| sum + weight(*l) * (y[at] - e));
    let u = -sigma * e + MU * of_z;
    let mut slopes = vec![
        -2.0 * x - x.powi(3) / 3.0 + e + phase.cos(),
        x / 2.0 - e.atan() + phase.sin() + (2.0 * phase).sin() / 2.0 + u,
        // Gamma = -(Phi + sigma I) M.
        -sigma * e,
    ];
    for (at, l) in blocks {
        let frequency = *l as f64 * OMEGA;
        slopes.push(frequency * y[at + 1] - sigma * e);
        slopes.push(-frequency * y[at] + frequency * e);
    }
    (slopes, u)
}

/// The largest |e| and |u| over all times, and over the last of so many periods, with the root mean square of e there; of the member of the family with
/// the coefficient `of_x` of v in q, and the gain of the actuator `gain`.
pub fn simulated(
    sigma: f64,
    harmonics: &[usize],
    [of_x, gain]: [f64; 2],
    [x, e]: [f64; 2],
    periods: usize,
) -> [f64; 5] {
    let slopes = |t: f64, y: &[f64]| {
        let (mut slopes, u) = right_side(sigma, harmonics, t, y);
        slopes[1] += (of_x - 0.5) * y[0] + (gain - 1.0) * u;
        (slopes, u)
    };
    let (steps, mut y) = (2000, vec![x, e]);
    y.extend((0..=2 * harmonics.len()).map(|i| if i == 0 || i % 2 == 1 { e } else { 0.0 }));
    let h = 2.0 / steps as f64;
    let mut found = [0.0_f64; 5];
    for step in 0..steps * periods {
        let t = step as f64 * h;
        let (k_1, u) = slopes(t, &y);
        found[0] = found[0].max(y[1].abs());
        found[1] = found[1].max(u.abs());
        if step >= steps * (periods - 1) {
            found[2] = found[2].max(y[1].abs());
            found[3] = found[3].max(u.abs());
            found[4] += y[1] * y[1] / steps as f64;
        }
        let moved = |k: &[f64], by: f64| y.iter().zip(k).map(|(y, k)| y + by * k).collect::<Vec<f64>>();
        let k_2 = slopes(t + h / 2.0, &moved(&k_1, h / 2.0)).0;
        let k_3 = slopes(t + h / 2.0, &moved(&k_2, h / 2.0)).0;
        let k_4 = slopes(t + h, &moved(&k_3, h)).0;
        for (i, y) in y.iter_mut().enumerate() {
            *y += h / 6.0 * (k_1[i] + 2.0 * k_2[i] + 2.0 * k_3[i] + k_4[i]);
        }
    }
    found[4] = found[4].sqrt();
    found
}

/// What is decided around a trial for one oscillator at sigma = 3.
pub struct Case {
    pub trial: Trial,
    pub proof: TubeProof,
    pub own: Loop,
    pub period: Enclosure,
}

pub fn rational(a: i32, b: i32) -> Rational {
    Rational::from((a, b))
}

/// The trial for one oscillator at sigma = 3.
pub fn trial_of(plant: &Plant, orbit: &OrbitCurve, gain: Option<Interval>) -> Trial {
    let members = Members { plant, orbit, gain: gain.as_ref() };
    let weights = vec![weight(0), weight(1)];
    let terms = members.propose(|plant, gain| TrialLoop {
        plant,
        gain,
        sigma: 3.0,
        samples: None,
        mu: MU,
        oscillators: 1.into(),
        weights: weights.clone(),
        resolved: if plant.is_family() { 1e-6 } else { 1e-15 },
        or_more: false,
    });
    let parameters = plant.parameters.intervals().cloned().collect();
    Trial { oscillators: 1.into(), or_more: false, terms: terms.unwrap(), parameters, gain }
}

pub fn case() -> Case {
    let plant = plant();
    let trial = trial_of(&plant, &orbit(), None);
    let identity = vec![vec![Rational::from(1)]];
    let lines = trial.terms[0].error.harmonics.len();
    let own = Loop::new(&Rational::from(3), &plant.internal_model, lines, None, identity)
        .with_oscillators(&1.into())
        .unwrap();
    let metric = Metric {
        matrix: vec![vec![rational(1, 2)]],
        cross: vec![Rational::new()],
        weight: Rational::from(1),
        k_p: rational(1, 2),
        c_x: rational(1, 10),
        c_e: rational(1, 10),
        c_y: rational(1, 100),
    };
    let level = Level { p_up: rational(51, 100), x_low: rational(49, 100), e_low: rational(99, 100) };
    let states = StatesForm {
        matrix: vec![vec![Rational::from(1)]],
        q_low: rational(99, 100),
        q_up: rational(101, 100),
        c: Rational::from(1),
        gamma: Rational::from(1),
    };
    let proof = TubeProof {
        defects: [rational(1, 100_000_000), rational(1, 100_000_000)],
        radii: [rational(1, 10), rational(1, 10)],
        slopes: [rational(51, 100), rational(101, 100)],
        forms: vec![(metric, level)],
        states: Some(states),
        or_more: None,
        x_first: None,
        within: Vec::new(),
    };
    Case { trial, proof, own, period: Enclosure::from_integer(2, PRECISION) }
}

pub fn orbit() -> OrbitCurve {
    TrigonometricVector::constant(vec![Rational::new()]).into()
}
