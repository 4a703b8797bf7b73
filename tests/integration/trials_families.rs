//! Bounds for given numbers of oscillators by trials, of a family whose actuator has a gain in an interval: its members, and both ends of the gain.

use super::support::{assert_valid, certified_in, number, read};
use super::trials_support::{OMEGA, case, document, orbit, rational, simulated, trial_of};
use rug::Rational;
use serde_json::{Value, json};
use sigmastar_decide::bounds::{Engine, Region};
use sigmastar_decide::linear::{Loop, PRECISION, Start};
use sigmastar_decide::trial::{Concluded, Known, OfAllCounts, Peaks, Trial};
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_lang::plant::{CurveTerm, Plant};
use sigmastar_lang::spec::{Document, Interval, Metric, OrbitCurve, TrigonometricVector};
use std::f64::consts::PI;

/// The plant of one state with a coefficient between 0.4 and 0.6 and a gain of the actuator between 0.9 and 1.1.
pub fn family() -> Value {
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
    let own = Loop::new(&Rational::from(3), &plant.internal_model, lines, Some(ends), identity)
        .with_oscillators(&1.into())
        .unwrap();
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
    let known =
        Known { own: &own, period: &period, orbit: &orbit, radius: &radius, of_all: OfAllCounts::Continuous(&kappas) };
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
        engine
            .decide_forms(&[(metric.clone(), level.clone())], &sigma, [&proof.radii[0], &proof.radii[1]], 20_000)
            .truth
    };
    assert_eq!(truth(&plant, metric), Truth::True);
    let nominal = Plant { input_gain: None, ..plant.clone() };
    let stiff = Metric { k_p: rational(33, 200), ..metric.clone() };
    assert_eq!(truth(&nominal, &stiff), Truth::True);
    assert_ne!(truth(&plant, &stiff), Truth::True, "at b = 9/10 it does not hold");

    let (orbit, radius) = (orbit(), Rational::new());
    let period = Enclosure::from_integer(2, PRECISION);
    let kappas = [2, 3].map(|value| Enclosure::from_integer(value, PRECISION));
    let known =
        |own| Known { own, period: &period, orbit: &orbit, radius: &radius, of_all: OfAllCounts::Continuous(&kappas) };
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
    let start = Start {
        x0: Enclosure::one(PRECISION),
        e0: Enclosure::one(PRECISION),
        z0: Some(Enclosure::one(PRECISION)),
        y0: Enclosure::zero(PRECISION),
    };
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
                let found = simulated(sigma, &(1..=n).collect::<Vec<_>>(), [a, b], start, 300);
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
