//! Bounds for given numbers of oscillators by trials, against simulations that share nothing with them; and what proves them, broken.

use super::support::{assert_valid, certified_in, checked, number, read, stored};
use super::trials_support::{Case, case, document, orbit, plant, rational, simulated};
use rug::Rational;
use sigmastar_decide::bounds::{Engine, Region, StatesForm};
use sigmastar_decide::linear::{PRECISION, Start};
use sigmastar_decide::trial::{Concluded, Known, OfAllCounts, OrMore, Peaks, Trial, TubeProof};
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_lang::spec::{Level, Metric};
use std::f64::consts::PI;

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
            let [e, u, steady, steady_u, rms] = simulated(
                sigma,
                &(1..=n).collect::<Vec<_>>(),
                [0.5, 1.0],
                [at_0 + start[0] * x_0, start[1] * 0.5],
                periods,
            );
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
    assert!(small(&Trial { oscillators: 0.into(), ..trial.clone() }).1 > 1e-3);

    // Both inequalities, and what nearly is one.
    let region = Region::new(identity, trial.centre(), Rational::new()).unwrap();
    let engine = Engine::new(&trial.about(&plant), region, None, None).unwrap();
    let (sigma, at) = (Rational::from(3), [&proof.radii[0], &proof.radii[1]]);
    let (metric, level) = &proof.forms[0];
    let truth = |metric: &Metric, level: &Level| {
        engine.decide_forms(&[(metric.clone(), level.clone())], &sigma, at, 2000).truth
    };
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
    let known =
        Known { own: &own, period: &period, orbit: &orbit, radius: &radius, of_all: OfAllCounts::Continuous(&kappas) };
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
        y0: Enclosure::zero(PRECISION),
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
        Concluded::of(
            trial,
            proof,
            &Known {
                own: &own,
                period: &period,
                orbit: &orbit,
                radius: &radius,
                of_all: OfAllCounts::Continuous(kappas),
            },
        )
    };
    let found = with(&trial, &proof, &kappas).unwrap();
    let sizes = Concluded::sizes_of(
        &trial,
        &Known { own: &own, period: &period, orbit: &orbit, radius: &radius, of_all: OfAllCounts::Continuous(&kappas) },
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
        let place = ([&proof.radii[0], &proof.radii[1]], eta);
        engine.decide_forms_x_first(&[(metric.clone(), level.clone())], &[s.to_vec()], &sigma, place, 2000).truth
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
