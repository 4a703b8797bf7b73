//! Rates for given n_o at samples as a part of claims (derivation, 13.6): against the loops that the data allow, and along solutions.

use crate::controller::{constant, example};
use crate::rounding::claim;
use crate::support::{Shipped, certified, every, json, program};
use faer::Mat;
use rug::Rational;
use serde_json::Value;
use sigmastar_decide::conditions::Ladder;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::{Oscillators, Specification};
use sigmastar_prove::certify::{SampledCertification, certify_sampled};
use sigmastar_regulator::{Design, Stepper};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::stability::ErrorBox;

const COUNTS: [u32; 4] = [0, 1, 4, 10];

/// The samples of a period that are tried, in this order.
const SAMPLES: [u32; 7] = [60, 120, 250, 500, 2000, 8000, 30000];

/// exp of a matrix, by squaring.
pub fn exponential(matrix: &Mat<f64>) -> Mat<f64> {
    let n = matrix.nrows();
    let size = (0..n).map(|i| (0..n).map(|j| matrix[(i, j)].abs()).sum::<f64>()).fold(0.0, f64::max);
    let halvings = (size.log2().ceil().max(0.0) as i32) + 6;
    let small = Mat::from_fn(n, n, |i, j| matrix[(i, j)] / 2f64.powi(halvings));
    let (mut sum, mut term) = (Mat::<f64>::identity(n, n), Mat::<f64>::identity(n, n));
    for k in 1..12 {
        term = &term * &small;
        term = Mat::from_fn(n, n, |i, j| term[(i, j)] / f64::from(k));
        sum += &term;
    }
    (0..halvings).fold(sum, |power, _| &power * &power)
}

/// A linear plant with the law: a sample of (x, e, zeta), and what v and d, constant in it, add.
struct Member {
    matrix: Mat<f64>,
    inputs: [Vec<f64>; 2],
}

/// Linear plants with one state at samples, at the periodic solution: `x' = -a x + g e`, `q = r x + d e` with P = p_up, u held by the law; all of
/// |g| = k_f, |r| = b_qx and the ends and the middle of d are within the data.
fn members(data: &Data<'_>, error_box: &ErrorBox<Enclosure>, run: &SampledCertification<'_>, n_o: u32) -> Vec<Member> {
    let of = |value: &Enclosure| value.midpoint_f64();
    let proof = run.claim().expect("certified");
    let (law, sigma) = (&proof.evaluation.law, proof.witness.sigma.to_f64());
    let (h, k) = (of(&law.step), of(&law.gain));
    let (a, k_f, k_x) = (of(&error_box.rate), of(&error_box.k_f), of(&error_box.k_x) * of(&data.p_low).sqrt());
    // Where q does not have x, e does not have its rate either.
    let a = if k_x == 0.0 { 1e3 / h } else { a };
    let (below, above) = (-of(&error_box.sector.below), of(&error_box.sector.above));
    let weight = |l: usize| data.spec.internal_model.weights.weight(l as u64, 128).midpoint_f64();
    let angle = std::f64::consts::TAU / f64::from(law.samples);
    let order = 2 * n_o as usize + 1;
    let in_m = |i: usize| f64::from(u8::from(i == 0 || i % 2 == 1));
    let turned = |i: usize, j: usize| {
        if i == 0 || j == 0 || i.div_ceil(2) != j.div_ceil(2) {
            return if i == j { 1.0 } else { 0.0 };
        }
        let (sin, cos) = (angle * i.div_ceil(2) as f64).sin_cos();
        if i == j {
            cos
        } else if i < j {
            sin
        } else {
            -sin
        }
    };
    // M'N R: what the law sees of zeta; R M; and what it makes of v.
    let seen = |j: usize| (0..order).map(|i| in_m(i) * weight(i.div_ceil(2)) * turned(i, j)).sum::<f64>();
    let of_m = |i: usize| (0..order).map(|j| turned(i, j) * in_m(j)).sum::<f64>();
    let of_v = -sigma - k * (0..order).map(|j| seen(j) * in_m(j)).sum::<f64>();
    let mut found = Vec::new();
    for sign in [-1.0, 0.0, 1.0] {
        for d in [below, f64::midpoint(below, above), above] {
            // (x, e, u) within a sample.
            let within =
                exponential(&Mat::from_fn(3, 3, |i, j| h * [[-a, sign * k_f, 0.0], [k_x, d, 1.0], [0.0; 3]][i][j]));
            // (x, e, zeta): e+ = (1 - h sigma) e + h y, zeta+ = R zeta - h M y.
            let control = |j: usize| match j {
                0 => 0.0,
                1 => -sigma,
                _ => k * seen(j - 2),
            };
            let next = |i: usize, j: usize| if j < 2 { within[(i, j)] } else { 0.0 } + within[(i, 2)] * control(j);
            let matrix = Mat::from_fn(order + 2, order + 2, |i, j| {
                if i < 2 {
                    return next(i, j);
                }
                let moved = next(1, j) - if j == 1 { 1.0 - h * sigma } else { 0.0 };
                let own = if j >= 2 { turned(i - 2, j - 2) } else { 0.0 };
                own - in_m(i - 2) * moved
            });
            let input = |control: f64, pushed: f64| -> Vec<f64> {
                let of = |i: usize| match i {
                    0 | 1 => within[(i, 2)] * control,
                    _ => {
                        let state = i - 2;
                        pushed * ((1.0 - h * sigma) * in_m(state) - of_m(state))
                            - in_m(state) * within[(1, 2)] * control
                    }
                };
                (0..order + 2).map(of).collect()
            };
            found.push(Member { matrix, inputs: [input(of_v, 1.0), input(1.0, 0.0)] });
        }
    }
    found
}

/// How fast the slowest of them converges.
fn slowest(data: &Data<'_>, error_box: &ErrorBox<Enclosure>, run: &SampledCertification<'_>, n_o: u32) -> f64 {
    let h = run.claim().expect("certified").evaluation.law.step.midpoint_f64();
    let of = |member: Member| {
        let values = member.matrix.eigenvalues().expect("finite");
        values.iter().map(|value| -value.norm().ln() / h).fold(f64::INFINITY, f64::min)
    };
    members(data, error_box, run, n_o).into_iter().map(of).fold(f64::INFINITY, f64::min)
}

/// How far e gets from 0 in the worst of them, by the worst signals that are constant over each sample: the sum of the moduli of the impulse response.
fn farthest(members: Vec<Member>, sizes: [f64; 2], samples: usize) -> f64 {
    let of = |Member { matrix, inputs }: Member| {
        let mut total = 0.0;
        for (input, size) in inputs.iter().zip(sizes).filter(|(_, size)| *size > 0.0) {
            let mut state = Mat::from_fn(input.len(), 1, |i, _| input[i]);
            for _ in 0..samples {
                total += size * state[(1, 0)].abs();
                state = &matrix * &state;
            }
        }
        total
    };
    members.into_iter().map(of).fold(0.0, f64::max)
}

/// At 1.5 times the certified gain each rate is at least a share of that of the slowest of a few members, and never more: by the median 0.3.
#[test]
fn rates_at_samples_are_near_those_of_the_loops() {
    let mut shares: Vec<(f64, String)> = Vec::new();
    for Shipped { name, spec, .. } in certified().iter().step_by(every(6)) {
        let found = SAMPLES.iter().find_map(|samples| {
            let mut document = spec.document.clone();
            document["internal_model"]["sampling_period"] =
                format!("({})/{samples}", spec.period.nominal().text).into();
            let sampling = Specification::from_json("sampled", &document.to_string()).ok()?.internal_model.sampling?;
            claim(spec, &sampling)
        });
        let Some(mut run) = found else {
            println!("{name}: no claim at samples");
            continue;
        };
        run.prove_rates(&COUNTS.map(Oscillators::first)).expect("by norms");
        let proof = run.claim().expect("certified");
        let data = Data::new(spec, 128);
        let periodic = [&proof.evaluation.size.x_per, &proof.evaluation.size.e_per];
        let there = ErrorBox::new(&data, proof.witness.paths, periodic, [&data.zero(), &data.zero()]);
        for found in &run.for_n_o {
            let n_o = found.oscillators.largest();
            let true_rate = slowest(&data, &there, &run, n_o);
            let Some(bound) = found.bound.as_ref() else {
                println!("{name} {n_o}: no rate ({true_rate})");
                shares.push((0.0, format!("{name} {n_o}")));
                continue;
            };
            let share = bound.rate.to_f64() / true_rate;
            println!(
                "{name} N_s = {} n_o = {n_o}: rate {} of {true_rate} share {share} factor {}",
                run.sampling.samples,
                bound.rate.to_f64(),
                bound.factor.to_f64()
            );
            assert!(share <= 1.0 + 1e-9, "{name} {n_o}: {share}");
            assert!(bound.factor.to_f64() >= proof.witness.set.e0.to_f64(), "{name} {n_o}");
            shares.push((share, format!("{name} {n_o}")));
        }
    }
    shares.sort_by(|a, b| a.0.total_cmp(&b.0));
    let median = shares[shares.len() / 2].0;
    println!("{shares:?}");
    assert!(median >= 0.3, "{median} {shares:?}");
}

/// The exported code, step by step, against the recursion of section 13.6 in (e, zeta): measurements that are off by v, any mean of q, any input gain.
#[test]
fn the_exported_law_has_the_recursion_of_the_proof() {
    let sigma = constant("30");
    let step = constant("1/40");
    let (h, s) = (1.0 / 40.0, 30.0);
    let model = example().internal_model;
    let mut state = 7_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / 2f64.powi(52) - 1.0
    };
    for n_o in [0, 1, 2, 5, 19] {
        let design = Design::new(&model, &sigma, n_o);
        let (regulator, discrete) = (design.regulator(), design.discretise(&step).expect("a law"));
        let (m, weights) = (regulator.m(), regulator.n_diagonal());
        let n = regulator.dimension();
        let k = discrete.gain;
        let turned = |zeta: &[f64]| -> Vec<f64> {
            let turn = |i: usize| {
                let (sin, cos) = (std::f64::consts::TAU * i.div_ceil(2) as f64 * h).sin_cos();
                match i {
                    0 => zeta[0],
                    _ if i % 2 == 1 => cos * zeta[i] + sin * zeta[i + 1],
                    _ => cos * zeta[i] - sin * zeta[i - 1],
                }
            };
            (0..n).map(turn).collect()
        };
        let seen = |turned: &[f64]| -> f64 { (0..n).map(|i| m[i] * weights[i] * turned[i]).sum() };
        let of_m = turned(&m);
        let b_1 = seen(&of_m);
        for _ in 0..50 {
            let [e, v, q, b_u] = [next(), next(), 10.0 * next(), 1.0 + 0.5 * next()];
            let zeta: Vec<f64> = (0..n).map(|_| next()).collect();
            let z: Vec<f64> = zeta.iter().zip(&m).map(|(zeta, m)| zeta + m * e).collect();
            let mut stepper = Stepper::starting(regulator.clone(), discrete.clone(), z).expect("of this size");
            let after = e + h * (q + b_u * stepper.step(e + v));
            let turned = turned(&zeta);
            let y = q + (1.0 - b_u) * s * e + b_u * k * seen(&turned) - b_u * (s + k * b_1) * v;
            let expected = (1.0 - h * s) * e + h * y;
            let scale = 1.0 + y.abs();
            assert!((after - expected).abs() < 1e-12 * scale, "{n_o}: {after} {expected}");
            for i in 0..n {
                let zeta = stepper.state()[i] - m[i] * after;
                let expected = turned[i] - h * m[i] * y + ((1.0 - h * s) * m[i] - of_m[i]) * v;
                assert!((zeta - expected).abs() < 1e-12 * scale, "{n_o} {i}: {zeta} {expected}");
            }
        }
    }
}

/// What can have no rates at samples is refused with the reason.
#[test]
fn what_has_no_rates_at_samples_is_refused_with_the_reason() {
    let spec = "specs/paper-example-rms-at-rest.json";
    let folder = tempfile::tempdir().expect("a folder");
    // The smallest gain of this plant rests on (Ms), and so does a claim that is decided again.
    let by_matrix = folder.path().join("matrix.json").display().to_string();
    let at = ["specs/plants/motor-axis.json", "--sampling-period", "1/20000"];
    program().arg("certify").args(at).args(["-q", "--no-alternatives", "-o", &by_matrix]).assert().success();
    let answer = |arguments: &[&str]| {
        let output = program().arg("certify").args(arguments).args(["--format", "json"]).output().expect("it runs");
        (output.status.code(), json(&output.stdout))
    };
    // Nothing is wrong with the question then: the claim stays, and why there is no rate is told.
    let (code, report) = answer(&[&at[..], &["--witness", &by_matrix, "--n-o", "1"]].concat());
    let why = report["for_n_o"][0]["limited_by"].as_str().expect("a reason");
    assert!(
        code == Some(0) && report["for_n_o"][0]["rate"].is_null() && why.contains("the claim rests on (Ms)"),
        "{why}"
    );
    let (code, report) = answer(&[spec, "--sampling-period", "1/60", "--n-o", "1,30"]);
    assert_eq!((code, &report["verdict"]), (Some(2), &Value::from("bad-input")));
    let message = report["errors"][0]["message"].as_str().expect("a message");
    assert!(message.contains("n_o < 60/2"), "{message}");
    let path = folder.path().join("delayed.json").display().to_string();
    let mut document = json(&std::fs::read(spec).expect("shipped"));
    document["internal_model"]["sampling_period"] = "1/400".into();
    document["internal_model"]["delay_samples"] = 1.into();
    std::fs::write(&path, document.to_string()).expect("written");
    let output = program().args(["certify", &path, "--n-o", "1", "--format", "json"]).output().expect("it runs");
    let report = json(&output.stdout);
    assert_eq!(output.status.code(), Some(2), "{report}");
    assert!(report["errors"][0]["message"].as_str().expect("a message").contains("delay_samples"), "{report}");
}

/// The certificate has claim, witness and sentence; a witness is read beside them; text and JSON reports have them.
#[test]
fn a_certificate_at_samples_has_its_rates() {
    let folder = tempfile::tempdir().expect("a folder");
    let [first, again] = ["first.json", "again.json"].map(|name| folder.path().join(name).display().to_string());
    let spec = "specs/paper-example-rms-at-rest.json";
    let shared = ["certify", spec, "--sampling-period", "1/400", "--n-o", "0,2"];
    let run = |rest: &[&str]| program().args(shared).args(rest).output().expect("it runs");
    let report = run(&["--sigma", "22", "--format", "json", "-o", &first]);
    assert_eq!(report.status.code(), Some(0));
    let report = json(&report.stdout);
    assert_eq!(run(&["--witness", &first, "-o", &again]).status.code(), Some(0));
    let read = |path: &str| json(&std::fs::read(path).expect("written"));
    let (first, again) = (read(&first), read(&again));
    assert_eq!((&first["claim"], &first["witness"]), (&again["claim"], &again["witness"]));
    for (at, n_o) in [(0, 0), (1, 2)] {
        let [claim, witness, told] =
            [&first["claim"]["for_n_o"][at], &first["witness"]["for_n_o"][at], &report["for_n_o"][at]];
        assert_eq!((&claim["n_o"], &witness["n_o"]), (&Value::from(n_o), &Value::from(n_o)));
        assert_eq!((&claim["rate"], &claim["factor"]), (&told["rate"], &told["factor"]));
        assert_eq!(witness["Pi"].as_array().expect("rows").len(), 2 * n_o + 2);
        let [rate, factor] = [&claim["rate"], &claim["factor"]].map(|value| value.as_str().expect("a number"));
        let sentence = format!(
            " With n_o = {n_o} and sigma = 22 exactly, |e(t) - e_per(t)| <= {factor} exp(-{rate} (t - t_0)) at the sampling instants t for \
             these solutions, where e_per is the e of the periodic solution and t_0 the initial time."
        );
        assert!(first["claim"]["statement"].as_str().expect("words").contains(&sentence), "{sentence}");
    }
    let text = String::from_utf8(run(&["--sigma", "22"]).stdout).expect("UTF-8");
    assert!(text.contains("bounds of |e - e_per| at the sampling instants: "), "{text}");
}

/// Bounds under noise and a disturbance are never below what the worst such signals do in members, and not idle.
#[test]
fn bounds_under_noise_hold_in_the_loops() {
    let text = std::fs::read_to_string("specs/paper-example-rms-at-rest.json").expect("shipped");
    let sizes = [(Some("0.0003"), Some("0.01")), (Some("0.0005"), None), (None, Some("0.02"))];
    for (noise, disturbance) in sizes.into_iter().step_by(every(3)) {
        let mut document: Value = serde_json::from_str(&text).expect("JSON");
        document["internal_model"]["sampling_period"] = "1/400".into();
        if let Some(noise) = noise {
            document["measurement"] = serde_json::json!({ "noise": noise });
        }
        if let Some(disturbance) = disturbance {
            document["disturbance"] = disturbance.into();
        }
        let spec = Specification::from_json("disturbed", &document.to_string()).expect("sound");
        let sampling = spec.internal_model.sampling.clone().expect("sampled");
        let gain = Rational::from(25);
        let mut run = certify_sampled(&spec, &sampling, Some(&gain), None, Ladder::default()).expect("not refuted");
        run.prove_rates(&[0, 1, 4, 10].map(Oscillators::first)).expect("by norms");
        let proof = run.claim().expect("certified");
        let data = Data::new(&spec, 128);
        let periodic = [&proof.evaluation.size.x_per, &proof.evaluation.size.e_per];
        let there = ErrorBox::new(&data, proof.witness.paths, periodic, [&data.zero(), &data.zero()]);
        let sizes = [noise, disturbance].map(|size| size.map_or(0.0, |size| size.parse::<f64>().expect("a number")));
        for found in &run.for_n_o {
            let bound = found.noise.as_ref().expect("asked for");
            let worst = farthest(
                members(&data, &there, &run, found.oscillators.largest()),
                sizes,
                60_000 / (found.oscillators.largest() as usize + 1),
            );
            let bound = match bound {
                Ok(bound) => bound,
                Err(reason) => {
                    panic!("{sizes:?} n_o = {}: {} ({worst})", found.oscillators.largest(), reason.message())
                }
            };
            let [limit, peak] = [&bound.limit, &bound.peak].map(Rational::to_f64);
            println!(
                "{sizes:?} n_o = {}: limit {limit} peak {peak}, worst {worst}, ratio {}",
                found.oscillators.largest(),
                limit / worst
            );
            assert!(
                limit >= worst && peak > limit,
                "{sizes:?} {}: {limit} {peak} {worst}",
                found.oscillators.largest()
            );
            assert!(
                found.oscillators.largest() > 1 || limit < 10.0 * worst,
                "{sizes:?} {}: {limit} {worst}",
                found.oscillators.largest()
            );
        }
    }
}
