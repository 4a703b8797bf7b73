//! Bounds for given numbers of oscillators by trials, against simulations that share nothing with them; and what proves them, broken.

use super::support::{assert_valid, certified_in, checked, number, read, stored};
use rug::Rational;
use serde_json::{Value, json};
use sigmastar_decide::bounds::{Engine, Region, StatesForm};
use sigmastar_decide::linear::{Loop, PRECISION, Start};
use sigmastar_decide::trial::{Concluded, Known, OrMore, Peaks, Trial, TubeProof};
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_lang::plant::{CurveTerm, Plant};
use sigmastar_lang::spec::{Document, Interval, Level, Metric, OrbitCurve, TrigonometricVector};
use sigmastar_propose::trial::{Members, TrialLoop};
use std::f64::consts::PI;

const WEIGHTS: [f64; 2] = [2.0, 1.5];
const MU: f64 = 1.0;
const OMEGA: f64 = PI;

fn weight(l: usize) -> f64 {
    if l == 0 { WEIGHTS[0] } else { (l as f64).powf(-WEIGHTS[1]) }
}

/// `x' = -2 x - x^3/3 + e + cos(phase)`, `e' = x/2 - atan(e) + sin(phase) + sin(2 phase)/2 + u`, period 2.
fn document() -> Value {
    json!({
        "format": "sigmastar/plant", "version": 1, "name": "one state", "period": 2, "states": ["v"],
        "f": ["-2*v - v^3/3 + e + cos(phase)"], "q": "v/2 - atan(e) + sin(phase) + sin(2*phase)/2",
        "initial_set": { "kind": "aligned", "X0": "1/2", "E0": "1/2" },
        "internal_model": {
            "mu": 1, "base_frequency": "pi", "matched": true, "weights": { "family": "power", "n0": 2, "epsilon": "1/2" },
        },
    })
}

fn plant() -> Plant {
    Plant::from_value(&Document::parse("one state", &document().to_string()).unwrap().root()).unwrap()
}

/// The right side of the loop with n oscillators at (x, e, z), and u: z' = Phi z + Gamma e, u = -sigma e + mu M'N (z - M e).
fn right_side(sigma: f64, n: usize, t: f64, y: &[f64]) -> (Vec<f64>, f64) {
    let (x, e) = (y[0], y[1]);
    let phase = OMEGA * t;
    let of_z: f64 = (0..=n).map(|l| weight(l) * (y[2 + if l == 0 { 0 } else { 2 * l - 1 }] - e)).sum();
    let u = -sigma * e + MU * of_z;
    let mut slopes = vec![
        -2.0 * x - x.powi(3) / 3.0 + e + phase.cos(),
        x / 2.0 - e.atan() + phase.sin() + (2.0 * phase).sin() / 2.0 + u,
        // Gamma = -(Phi + sigma I) M.
        -sigma * e,
    ];
    for l in 1..=n {
        let (frequency, at) = (l as f64 * OMEGA, 2 * l + 1);
        slopes.push(frequency * y[at + 1] - sigma * e);
        slopes.push(-frequency * y[at] + frequency * e);
    }
    (slopes, u)
}

/// The largest |e| and |u| over all times, and over the last of so many periods, with the root mean square of e there; of the member of the family with
/// the coefficient `of_x` of v in q, and the gain of the actuator `gain`.
fn simulated(sigma: f64, n: usize, [of_x, gain]: [f64; 2], [x, e]: [f64; 2], periods: usize) -> [f64; 5] {
    let slopes = |t: f64, y: &[f64]| {
        let (mut slopes, u) = right_side(sigma, n, t, y);
        slopes[1] += (of_x - 0.5) * y[0] + (gain - 1.0) * u;
        (slopes, u)
    };
    let (steps, mut y) = (2000, vec![x, e]);
    y.extend((0..=2 * n).map(|i| if i == 0 || i % 2 == 1 { e } else { 0.0 }));
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

#[test]
fn simulations_meet_the_bounds_and_do_not_exceed_them() {
    let folder = tempfile::tempdir().unwrap();
    let (file, report) = certified_in(folder.path(), &document(), &[]);
    assert_valid(&file);
    let certificate = read(&file);
    let sigma = number(&report["sigma_star"]);
    let orbit = &certificate["witness"]["orbit"];
    let cosines = orbit["harmonics"].as_array().unwrap().iter().map(|pair| number(&pair["cos"][0]));
    let at_0 = number(&orbit["mean"][0]) + cosines.sum::<f64>();
    let x_0 = number(&certificate["claim"]["initial_set"]["ball"]);
    let entries = certificate["claim"]["by_n_o"].as_array().unwrap();
    let numbers = entries.iter().map(|entry| entry["n_o"].as_u64().unwrap()).collect::<Vec<_>>();
    let from = numbers.len() as u64 - 1;
    assert_eq!(numbers, (0..=from).collect::<Vec<_>>());
    assert_eq!(entries.iter().filter(|entry| entry["or_more"] == true).count(), 1, "{entries:?}");
    // The last entry is about larger numbers, too.
    let last = [from, from + 9].map(|n| (n, &entries[from as usize]));
    for (n, entry) in [0, 1, 2, 3].map(|n| (n, &entries[n as usize])).into_iter().chain(last) {
        let n = n as usize;
        let bound = |part: &str, name: &str| number(&entry[part][name]);
        for start in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
            // The more oscillators, the longer they take.
            let periods = if n > 3 { 1500 } else { 200 };
            let [e, u, steady, steady_u, rms] =
                simulated(sigma, n, [0.5, 1.0], [at_0 + start[0] * x_0, start[1] * 0.5], periods);
            assert!(e <= bound("largest", "e") && u <= bound("largest", "u"), "{n}: {e} {u} {entry}");
            let meets =
                |value: f64, bound: f64| value <= bound * (1.0 + 1e-6) + 1e-9 && bound <= value * (1.0 + 1e-5) + 1e-5;
            assert!(meets(steady, bound("steady", "e")), "{n}: {steady} {entry}");
            assert!(meets(rms, bound("steady", "e_rms")), "{n}: {rms} {entry}");
            assert!(meets(steady_u, bound("steady", "u")), "{n}: {steady_u} {entry}");
        }
        assert!(bound("largest", "e") < 3.0, "{entry}");
    }
    // A bound that is a millionth too small is no bound, and the sentence has the numbers.
    let mut forged = certificate.clone();
    forged["claim"]["by_n_o"][0]["steady"]["e"] =
        (number(&entries[0]["steady"]["e"]) * (1.0 - 4e-6)).to_string().into();
    let answer = checked(&stored(folder.path(), "forged.json", &forged));
    assert_ne!(answer["verdict"], "valid", "{answer}");
    let sentence = certificate["claim"]["statement"].as_str().unwrap();
    let said = format!(
        "With n_o = 1 and sigma = {} exactly, |e| <= {}",
        report["sigma_star"].as_str().unwrap(),
        entries[1]["steady"]["e"].as_str().unwrap()
    );
    assert!(sentence.contains(&said), "{sentence}");
}

/// What is decided around a trial for one oscillator at sigma = 3.
struct Case {
    trial: Trial,
    proof: TubeProof,
    own: Loop,
    period: Enclosure,
}

fn rational(a: i32, b: i32) -> Rational {
    Rational::from((a, b))
}

/// The trial for one oscillator at sigma = 3.
fn trial_of(plant: &Plant, orbit: &OrbitCurve, gain: Option<Interval>) -> Trial {
    let members = Members { plant, orbit, gain: gain.as_ref() };
    let weights = vec![weight(0), weight(1)];
    let terms = members.propose(|plant, gain| TrialLoop {
        plant,
        gain,
        sigma: 3.0,
        mu: MU,
        weights: weights.clone(),
        resolved: if plant.is_family() { 1e-6 } else { 1e-15 },
        or_more: false,
    });
    let parameters = plant.parameters.intervals().cloned().collect();
    Trial { n_o: 1, or_more: false, terms: terms.unwrap(), parameters, gain }
}

fn case() -> Case {
    let plant = plant();
    let trial = trial_of(&plant, &orbit(), None);
    let identity = vec![vec![Rational::from(1)]];
    let lines = trial.terms[0].error.harmonics.len();
    let own = Loop::new(&Rational::from(3), &plant.internal_model, lines, None, identity).with_oscillators(1);
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
    };
    Case { trial, proof, own, period: Enclosure::from_integer(2, PRECISION) }
}

fn orbit() -> OrbitCurve {
    TrigonometricVector::constant(vec![Rational::new()]).into()
}

#[test]
fn what_is_broken_proves_nothing() {
    let plant = plant();
    let Case { trial, proof, own, period } = case();
    let identity = vec![vec![Rational::from(1)]];
    // The defects of the trial are small; off by a thousandth they are not.
    let within = |trial: &Trial, enough: f64| {
        let [of_x, of_q, _] = trial.defects(&plant, &identity, [enough; 3]).unwrap();
        (of_x.upper_f64().max(of_q.upper_f64()), trial.mismatch(&own).upper_f64())
    };
    // Of what is far off the first bound is enough.
    let small = |trial: &Trial| within(trial, 1.0);
    let (of_formulas, of_loop) = within(&trial, 1e-10);
    assert!(of_formulas < 1e-10 && of_loop < 1e-10, "{of_formulas} {of_loop}");
    let mut off = trial.clone();
    off.terms[0].states.harmonics[0][0][0] += rational(1, 1000);
    assert!(small(&off).0 > 1e-3);
    let mut off = trial.clone();
    off.terms[0].error.harmonics[1][0] += rational(1, 1000);
    assert!(small(&off).1 > 1e-3);
    let mut off = trial.clone();
    off.terms[0].control.harmonics[0][1] += rational(1, 1000);
    assert!(small(&off).0 > 0.99e-3);
    // y_k of another number of oscillators.
    assert!(small(&Trial { n_o: 0, ..trial.clone() }).1 > 1e-3);

    // Both inequalities, and what nearly is one.
    let region = Region::new(identity, trial.centre(), Rational::new()).unwrap();
    let engine = Engine::new(&trial.about(&plant), region, None, None).unwrap();
    let (sigma, at) = (Rational::from(3), [&proof.radii[0], &proof.radii[1]]);
    let (metric, level) = &proof.forms[0];
    let truth = |metric: &Metric, level: &Level| engine.decide_form((metric, level), &sigma, at, 2000).truth;
    assert_eq!(truth(metric, level), Truth::True);
    for (what, metric, level) in [
        ("c_y", Metric { c_y: rational(2, 5), ..metric.clone() }, level.clone()),
        ("c_x", Metric { c_x: Rational::new(), ..metric.clone() }, level.clone()),
        ("k_p", Metric { k_p: rational(1, 20), ..metric.clone() }, level.clone()),
        ("w", Metric { weight: rational(98, 100), ..metric.clone() }, level.clone()),
        ("P", Metric { matrix: vec![vec![rational(-1, 2)]], ..metric.clone() }, level.clone()),
        ("p", Metric { cross: Vec::new(), ..metric.clone() }, level.clone()),
        ("P_up", metric.clone(), Level { p_up: rational(49, 100), ..level.clone() }),
        ("e_low", metric.clone(), Level { e_low: Rational::from(1), ..level.clone() }),
    ] {
        assert_ne!(truth(&metric, &level), Truth::True, "{what}");
    }
    let states = proof.states.clone().unwrap();
    assert_eq!(engine.decide_states(&states, at, 2000).truth, Truth::True);
    for (what, broken) in [
        ("c", StatesForm { c: Rational::from(2), ..states.clone() }),
        ("gamma", StatesForm { gamma: rational(1, 10), ..states.clone() }),
        ("Q_low", StatesForm { q_low: Rational::from(1), ..states.clone() }),
        ("Q_up", StatesForm { q_up: Rational::from(1), ..states.clone() }),
    ] {
        assert_ne!(engine.decide_states(&broken, at, 2000).truth, Truth::True, "{what}");
    }

    // The conclusion: closer than the box, and only of a trial that the regulator answers.
    let (orbit, radius) = (orbit(), Rational::new());
    let kappas = [0, 1].map(|value| Enclosure::from_integer(value, PRECISION));
    let known = Known { own: &own, period: &period, orbit: &orbit, radius: &radius, kappas: &kappas };
    let found = Concluded::of(&trial, &proof, &known).unwrap();
    let [s_x, s_e] = found.distances.each_ref().map(Enclosure::upper_f64);
    assert!(s_x < 1e-6 && s_e < 1e-6 && found.error.upper_f64() > 0.05, "{found:?}");
    let touching = |i: usize| {
        let mut radii = proof.radii.clone();
        radii[i] = found.distances[i].lower_rational().unwrap();
        Concluded::of(&trial, &TubeProof { radii, ..proof.clone() }, &known).is_none()
    };
    assert!(touching(0) && touching(1));
    let mut met = trial.clone();
    met.terms[0].error.harmonics[0][1] = rational(1, 1_000_000);
    assert!(Concluded::of(&met, &proof, &known).is_none());
    met = trial.clone();
    met.terms[0].error.mean = rational(1, 1_000_000);
    assert!(Concluded::of(&met, &proof, &known).is_none());
    assert!(Concluded::of(&trial, &TubeProof { forms: Vec::new(), ..proof.clone() }, &known).is_none());

    // Peaks grow with the start, and start from the periodic solution.
    let start = |x: i32, e: i32| Start {
        x0: Enclosure::from_integer(i64::from(x), PRECISION),
        e0: Enclosure::from_integer(i64::from(e), PRECISION),
        z0: None,
    };
    let [near, far] =
        [start(0, 1), start(1, 1)].map(|start| Peaks::of((&proof.forms, true), &found, &own, &start).unwrap());
    assert!(near.error.upper_f64() > 1.0 && far.error.lower_f64() > near.error.upper_f64());
    assert!(far.control.lower_f64() > near.control.upper_f64() && far.reach[0][0].lower_f64() > 1.0);
}

#[test]
fn every_number_that_more_oscillators_need_counts() {
    let Case { trial, proof, own, period } = case();
    let mut trial = Trial { or_more: true, ..trial };
    trial.terms[0].error = sigmastar_lang::spec::Wave { mean: Rational::new(), harmonics: Vec::new() };
    trial.terms[0].control.harmonics.truncate(1);
    let more = OrMore {
        defect_t: rational(1, 10_000_000),
        in_time: [rational(1, 10), rational(1, 5)],
        states: [rational(5, 2), Rational::from(1)],
    };
    let proof = TubeProof { or_more: Some(more.clone()), ..proof };
    let (orbit, radius) = (orbit(), Rational::new());
    let kappas = [2, 3].map(|value| Enclosure::from_integer(value, PRECISION));
    let with = |trial: &Trial, proof: &TubeProof, kappas: &[Enclosure; 2]| {
        Concluded::of(trial, proof, &Known { own: &own, period: &period, orbit: &orbit, radius: &radius, kappas })
    };
    let found = with(&trial, &proof, &kappas).unwrap();
    let sizes = Concluded::sizes_of(
        &trial,
        &Known { own: &own, period: &period, orbit: &orbit, radius: &radius, kappas: &kappas },
    );
    let of_curve = sizes.unwrap()[2].clone();
    // s_z by the formula, in doubles: d_x = d_q = 1e-8, T = 2, mu = 1.
    let d = 1e-8_f64;
    let all = 4.0 * d * d * 0.51 * 0.51 / 0.1 + 0.25 * d * d / 0.01;
    let [of_x, of_y] = [0.1, 0.01].map(|c: f64| (all / c).sqrt());
    let of_e = of_x.min(of_y / (9.0 + 4.0 * PI * PI).sqrt());
    let of_q = 0.51 * of_x + 1.01 * of_e + d;
    let slope = 0.1 * of_x + 0.2 * of_e + 0.51 * (2.5 * of_x + of_e + d) + 1.01 * of_y + 1e-7;
    let right = (3.0 * of_q * of_q + 3.0 * slope * slope).sqrt();
    let s_z = (&found.zeta - &of_curve).upper_f64();
    assert!((s_z / right - 1.0).abs() < 1e-6, "{s_z} {right}");
    // Each of the numbers makes it larger.
    let larger = |more: OrMore| {
        let found = with(&trial, &TubeProof { or_more: Some(more), ..proof.clone() }, &kappas).unwrap();
        (&found.zeta - &of_curve).lower_f64() > s_z
    };
    for i in 0..2 {
        let more_of = |pair: &[Rational; 2]| {
            let mut pair = pair.clone();
            pair[i] += 1;
            pair
        };
        assert!(larger(OrMore { in_time: more_of(&more.in_time), ..more.clone() }), "{i}");
        assert!(larger(OrMore { states: more_of(&more.states), ..more.clone() }), "{i}");
    }
    assert!(larger(OrMore { defect_t: rational(1, 1_000_000), ..more.clone() }));
    let kappas_of = |a: i64, b: i64| [a, b].map(|value| Enclosure::from_integer(value, PRECISION));
    for kappas in [kappas_of(3, 3), kappas_of(2, 4)] {
        assert!(with(&trial, &proof, &kappas).unwrap().zeta.lower_f64() > found.zeta.upper_f64());
    }

    // Such a trial has no error, uhat no harmonics that not all of them meet, and what it needs is there.
    assert!(with(&trial, &TubeProof { or_more: None, ..proof.clone() }, &kappas).is_none());
    assert!(with(&Trial { or_more: false, ..trial.clone() }, &proof, &kappas).is_none());
    let mut with_error = trial.clone();
    with_error.terms[0].error.harmonics =
        vec![[0, 0].map(Rational::from), [rational(1, 1_000_000_000), Rational::new()]];
    assert!(with(&with_error, &proof, &kappas).is_none());
    let mut beyond = trial.clone();
    beyond.terms[0].control.harmonics.push([Rational::new(), rational(1, 1_000_000_000)]);
    assert!(with(&beyond, &proof, &kappas).is_none());
}

#[test]
fn along_x_first_both_inequalities_are_asked_for() {
    let plant = plant();
    let Case { trial, proof, .. } = case();
    let identity = vec![vec![Rational::from(1)]];
    let region = Region::new(identity, trial.centre(), Rational::new()).unwrap();
    let engine = Engine::new(&trial.about(&plant), region, None, None).unwrap();
    let (metric, level) = &proof.forms[0];
    // J and r at ehat: -(P J + J'P) - c_x is 1.9 or more, r = 1/2; g = 1, d between -1 and -1/2 or so.
    let s = vec![vec![rational(3, 2), rational(-1, 10)], vec![rational(-1, 10), rational(2, 5)]];
    let (sigma, eta) = (Rational::from(3), rational(1, 1000));
    let truth = |metric: &Metric, level: &Level, s: &[Vec<Rational>], eta: &Rational| {
        engine.decide_form_x_first((metric, level, s), &sigma, ([&proof.radii[0], &proof.radii[1]], eta), 2000).truth
    };
    assert_eq!(truth(metric, level, &s, &eta), Truth::True);
    let with = |i: usize, j: usize, value: Rational| {
        let mut s = s.clone();
        (s[i][j], s[j][i]) = (value.clone(), value);
        s
    };
    for (what, s) in [
        ("more than J has", with(0, 0, Rational::from(2))),
        ("more than k_p has", with(1, 1, rational(1, 2))),
        ("too little for g", with(0, 0, rational(1, 100))),
        ("too little for d", with(1, 1, rational(1, 100))),
        ("not symmetric", vec![s[0].clone(), vec![rational(1, 10), rational(2, 5)]]),
        ("of another order", vec![vec![rational(3, 2)]]),
    ] {
        assert_ne!(truth(metric, level, &s, &eta), Truth::True, "{what}");
    }
    let joined = Metric { cross: vec![rational(1, 1_000_000)], ..metric.clone() };
    assert_ne!(truth(&joined, level, &s, &eta), Truth::True);
    assert_ne!(truth(metric, &Level { p_up: rational(49, 100), ..level.clone() }, &s, &eta), Truth::True);
    assert_ne!(truth(metric, level, &s, &rational(2, 10)), Truth::True, "eta is above the radius");
}

/// The paper's plant, whose forms fall along x first alone.
#[test]
fn simulations_of_the_papers_plant_do_not_exceed_the_bounds() {
    let folder = tempfile::tempdir().unwrap();
    let document = read(std::path::Path::new("specs/plants/paper-example.json"));
    let (file, report) = certified_in(folder.path(), &document, &[]);
    let certificate = read(&file);
    assert!(certificate["witness"]["by_n_o"]["trials"][0]["x_first"].is_object());
    let sigma = number(&report["sigma_star"]);
    let orbit = &certificate["witness"]["orbit"];
    let at_0 = [0, 1].map(|i| {
        let cosines = orbit["harmonics"].as_array().unwrap().iter().map(|pair| number(&pair["cos"][i]));
        number(&orbit["mean"][i]) + cosines.sum::<f64>()
    });
    let set = &certificate["claim"]["initial_set"];
    let [ball, e_0] = ["ball", "E0"].map(|name| number(&set[name]));
    let slopes = |n: usize, t: f64, y: &[f64]| {
        let ([a, b, e], (s, c)) = ([y[0], y[1], y[2]], (2.0 * PI * t).sin_cos());
        let weight = |l: usize| if l == 0 { 2.0 } else { (l as f64).powf(-1.5) };
        let of_z: f64 = (0..=n).map(|l| weight(l) * (y[3 + if l == 0 { 0 } else { 2 * l - 1 }] - e)).sum();
        let u = -sigma * e + of_z;
        let root = 3.0_f64.sqrt();
        let mut slopes = vec![
            -a / 5.0 + root * b + b.sin() / 10.0 + s,
            -root * a - b + b * b / 10.0 + b * e + (4.0 * PI * t).cos() * (1.0 + s),
            1.0 + a + (e * b).atan() + c + c.powi(2) + c.powi(3) + c.powi(4) + u,
            -sigma * e,
        ];
        for l in 1..=n {
            let (frequency, at) = (l as f64 * 2.0 * PI, 2 * l + 2);
            slopes.extend([frequency * y[at + 1] - sigma * e, -frequency * y[at] + frequency * e]);
        }
        (slopes, u)
    };
    let entries = certificate["claim"]["by_n_o"].as_array().unwrap();
    for n in [0_usize, 1, 3, 12] {
        let entry = &entries[n.min(entries.len() - 1)];
        assert!(n < entries.len() || entry["or_more"] == true, "{entries:?}");
        let [most_e, most_u] = ["e", "u"].map(|name| number(&entry["largest"][name]));
        for j in 0..8 {
            let (sin, cos) = (f64::from(j) * PI / 4.0).sin_cos();
            let mut y = vec![at_0[0] + ball * cos, at_0[1] + ball * sin, if j % 2 == 0 { e_0 } else { -e_0 }];
            // At rest: z = 0.
            y.resize(4 + 2 * n, 0.0);
            let h = 1.0 / 1000.0;
            let (mut largest, mut steady) = ([0.0_f64; 2], 0.0_f64);
            for step in 0..240_000 {
                let t = f64::from(step) * h;
                let (k_1, u) = slopes(n, t, &y);
                largest = [largest[0].max(y[2].abs()), largest[1].max(u.abs())];
                if step >= 239_000 {
                    steady = steady.max(y[2].abs());
                }
                let moved = |k: &[f64], by: f64| y.iter().zip(k).map(|(y, k)| y + by * k).collect::<Vec<f64>>();
                let k_2 = slopes(n, t + h / 2.0, &moved(&k_1, h / 2.0)).0;
                let k_3 = slopes(n, t + h / 2.0, &moved(&k_2, h / 2.0)).0;
                let k_4 = slopes(n, t + h, &moved(&k_3, h)).0;
                for (i, y) in y.iter_mut().enumerate() {
                    *y += h / 6.0 * (k_1[i] + 2.0 * k_2[i] + 2.0 * k_3[i] + k_4[i]);
                }
            }
            assert!(largest[0] <= most_e && largest[1] <= most_u, "{n} {j}: {largest:?} {entry}");
            // With more oscillators they have not settled by then.
            let known = number(&entry["steady"]["e"]);
            assert!(n > 3 || steady <= known * (1.0 + 1e-6) + 1e-9, "{n} {j}: {steady} {entry}");
        }
        assert!(most_e < 1.4, "{entry}");
    }
}

/// The plant of one state with a coefficient between 0.4 and 0.6 and a gain of the actuator between 0.9 and 1.1.
fn family() -> Value {
    let mut document = document();
    document["q"] = "a*v - atan(e) + sin(phase) + sin(2*phase)/2".into();
    document["parameters"] = json!({ "a": { "nominal": "1/2", "low": "2/5", "high": "3/5" } });
    document["input_gain"] = json!({ "nominal": 1, "low": "9/10", "high": "11/10" });
    document
}

fn family_case() -> (Plant, Trial, Loop) {
    let plant = Plant::from_value(&Document::parse("family", &family().to_string()).unwrap().root()).unwrap();
    let gain = Interval { nominal: Rational::from(1), low: rational(9, 10), high: rational(11, 10) };
    let still = TrigonometricVector::constant(vec![Rational::new()]);
    let orbit = OrbitCurve { centre: still.clone(), sensitivities: vec![still] };
    let trial = trial_of(&plant, &orbit, Some(gain));
    let ends = [rational(9, 10), rational(11, 10)].map(|end| Enclosure::from_rational(&end, PRECISION));
    let lines = trial.terms.iter().map(|term| term.error.harmonics.len()).max().unwrap();
    let identity = vec![vec![Rational::from(1)]];
    let own = Loop::new(&Rational::from(3), &plant.internal_model, lines, Some(ends), identity).with_oscillators(1);
    (plant, trial, own)
}

#[test]
fn the_defects_of_a_family_are_those_of_its_worst_member() {
    let (plant, trial, own) = family_case();
    let identity = vec![vec![Rational::from(1)]];
    let within = |trial: &Trial, enough: f64| {
        let [of_x, of_q, _] = trial.defects(&plant, &identity, [enough; 3]).unwrap();
        of_x.upper_f64().max(of_q.upper_f64())
    };
    // Of what is far off the first bound is enough.
    let of = |trial: &Trial| within(trial, 1.0);
    let all = within(&trial, 2e-6);
    assert!(all < 1e-5 && trial.mismatch(&own).upper_f64() < 1e-10, "{all}");
    // Each member has at most that; a corner has it nearly.
    let curve = |term: &dyn Fn(&CurveTerm) -> sigmastar_lang::spec::Wave, by: [f64; 2], t: f64| {
        let wave_at = |wave: &sigmastar_lang::spec::Wave| {
            let (mut value, mut slope) = (wave.mean.to_f64(), 0.0);
            for (k, [a, b]) in (1..).zip(&wave.harmonics) {
                let (frequency, [a, b]) = (OMEGA * f64::from(k), [a.to_f64(), b.to_f64()]);
                let (sin, cos) = (frequency * t).sin_cos();
                value += a * cos + b * sin;
                slope += frequency * (b * cos - a * sin);
            }
            [value, slope]
        };
        trial.terms.iter().fold([0.0; 2], |[value, slope], own| {
            let scale = by[0].powi(own.powers[0] as i32) * by[1].powi(own.powers[1] as i32);
            let [more, more_slope] = wave_at(&term(own));
            [value + scale * more, slope + scale * more_slope]
        })
    };
    let mut largest = 0.0_f64;
    for i in -4..=4 {
        for j in -4..=4 {
            let by = [f64::from(i) / 40.0, f64::from(j) / 40.0];
            for step in 0..100 {
                let t = f64::from(step) / 50.0;
                let [[x, x_slope], [e, e_slope], [u, _]] = [
                    curve(&|term| term.state(0), by, t),
                    curve(&|term| term.error.clone(), by, t),
                    curve(&|term| term.control.clone(), by, t),
                ];
                let phase = OMEGA * t;
                let of_x = -2.0 * x - x.powi(3) / 3.0 + e + phase.cos() - x_slope;
                let q = (0.5 + by[0]) * x - e.atan() + phase.sin() + (2.0 * phase).sin() / 2.0;
                let of_q = q + (1.0 + by[1]) * u - e_slope;
                largest = largest.max(of_x.abs()).max(of_q.abs());
            }
        }
    }
    assert!(largest <= all && all < 4.0 * largest + 1e-7, "{largest} {all}");
    // Without the members, without the gain in a term, or with one that is off.
    let alone = Trial { terms: trial.terms[..1].to_vec(), ..trial.clone() };
    assert!(of(&alone) > 1e-2);
    for (which, left_out) in [("gain", [0, 1]), ("parameter", [1, 0])] {
        let terms = trial.terms.iter().filter(|term| term.powers != left_out).cloned().collect();
        assert!(of(&Trial { terms, ..trial.clone() }) > 1e-3, "{which}");
    }
    let mut off = trial.clone();
    let term = off.terms.iter_mut().find(|term| term.powers == [1, 0]).unwrap();
    term.control.mean += rational(1, 100);
    assert!(of(&off) > 0.9e-3);
    // Powers of another length are of another family, and a mean of one term is one.
    let (orbit, radius) = (orbit(), Rational::new());
    let period = Enclosure::from_integer(2, PRECISION);
    let kappas = [2, 3].map(|value| Enclosure::from_integer(value, PRECISION));
    let known = Known { own: &own, period: &period, orbit: &orbit, radius: &radius, kappas: &kappas };
    let proof = case().proof;
    assert!(Concluded::of(&trial, &proof, &known).is_some());
    let mut broken = trial.clone();
    broken.terms[1].powers.push(0);
    assert!(Concluded::of(&broken, &proof, &known).is_none());
    let mut broken = trial.clone();
    broken.terms[2].error.mean += 1;
    assert!(Concluded::of(&broken, &proof, &known).is_none());
}

#[test]
fn the_gain_of_the_actuator_counts_at_both_ends() {
    let (plant, trial, own) = family_case();
    let proof = case().proof;
    let identity = vec![vec![Rational::from(1)]];
    let region = Region::new(identity, trial.centre(), Rational::new()).unwrap();
    let (metric, level) = &proof.forms[0];
    let sigma = Rational::from(3);
    // d is between -1 and -0.9 near the trial; (1 - b) sigma moves it by 0.3 up and down.
    let truth = |plant: &Plant, metric: &Metric| {
        let engine = Engine::new(&trial.about(plant), region.clone(), None, None).unwrap();
        engine.decide_form((metric, level), &sigma, [&proof.radii[0], &proof.radii[1]], 20_000).truth
    };
    assert_eq!(truth(&plant, metric), Truth::True);
    let nominal = Plant { input_gain: None, ..plant.clone() };
    let stiff = Metric { k_p: rational(33, 200), ..metric.clone() };
    assert_eq!(truth(&nominal, &stiff), Truth::True);
    assert_ne!(truth(&plant, &stiff), Truth::True, "at b = 9/10 it does not hold");

    let (orbit, radius) = (orbit(), Rational::new());
    let period = Enclosure::from_integer(2, PRECISION);
    let kappas = [2, 3].map(|value| Enclosure::from_integer(value, PRECISION));
    let known = |own| Known { own, period: &period, orbit: &orbit, radius: &radius, kappas: &kappas };
    let found = Concluded::of(&trial, &proof, &known(&own)).unwrap();
    let of_curve = Concluded::sizes_of(&trial, &known(&own)).unwrap()[2].clone();
    // s_z by the formula, in doubles, with b_lo = 0.9 and sigma max|1 - b| = 0.3.
    let d = 1e-8_f64;
    let all = 4.0 * d * d * 0.51 * 0.51 / 0.1 + 0.25 * d * d / 0.01;
    let [of_x, of_y] = [0.1, 0.01].map(|c: f64| (all / c).sqrt());
    let of_e = of_x.min(of_y / (9.0 + 4.0 * PI * PI).sqrt());
    let of_q = 0.51 * of_x + 1.31 * of_e + d;
    let right = (2.0 / (2.0 * 0.9) + 2.0 / (0.9 * 0.9_f64)).sqrt() * of_q;
    let s_z = (&found.zeta - &of_curve).upper_f64();
    assert!((s_z / right - 1.0).abs() < 1e-5, "{s_z} {right}");
    // V_0 at 1.1, and the control at the worse end.
    let start =
        Start { x0: Enclosure::one(PRECISION), e0: Enclosure::one(PRECISION), z0: Some(Enclosure::one(PRECISION)) };
    let peaks = Peaks::of((&proof.forms, true), &found, &own, &start).unwrap();
    let [x, e, z] =
        start.distances(&own, [&found.states, &found.error, &found.zeta]).map(|distance| distance.upper_f64());
    let level_at = |b: f64| 0.51 * x * x + e * e + 0.25 * b * z * z;
    let n_bar_squared = own.n_bar_squared.upper_f64();
    let control = |b: f64| level_at(b) * (9.0 / 0.99 + 4.0 * n_bar_squared / b);
    let right = [(level_at(1.1) / 0.99).sqrt(), control(0.9).max(control(1.1)).sqrt()];
    for (found, right) in [&peaks.error, &peaks.control].into_iter().zip(right) {
        assert!((found.upper_f64() / right - 1.0).abs() < 1e-9, "{found:?} {right}");
    }
}

#[test]
fn members_of_a_family_do_not_exceed_its_bounds() {
    let folder = tempfile::tempdir().unwrap();
    let (file, report) = certified_in(folder.path(), &family(), &["--n-o", "0,1,2"]);
    assert_valid(&file);
    let certificate = read(&file);
    let sigma = number(&report["sigma_star"]);
    let entries = certificate["claim"]["by_n_o"].as_array().unwrap();
    let trial = &certificate["witness"]["by_n_o"]["trials"][0];
    assert!(trial["members"].as_array().is_some_and(|members| members.len() > 5), "{trial}");
    for n in [0_usize, 1, 2] {
        let entry = entries.iter().find(|entry| entry["n_o"] == n).unwrap();
        let bound = |part: &str, name: &str| number(&entry[part][name]);
        let mut worst = [0.0_f64; 5];
        for (a, b) in [(0.4, 0.9), (0.4, 1.1), (0.6, 0.9), (0.6, 1.1), (0.5, 1.0)] {
            for start in [[0.4, 0.5], [-0.4, -0.5]] {
                let found = simulated(sigma, n, [a, b], start, 300);
                worst = [0, 1, 2, 3, 4].map(|i| worst[i].max(found[i]));
            }
        }
        let [e, u, steady, steady_u, rms] = worst;
        assert!(e <= bound("largest", "e") && u <= bound("largest", "u"), "{n}: {worst:?} {entry}");
        for (found, name) in [(steady, "e"), (rms, "e_rms"), (steady_u, "u")] {
            let bound = bound("steady", name);
            assert!(found <= bound && bound <= 1.1 * found + 1e-3, "{n}, {name}: {found} {entry}");
        }
    }
}
