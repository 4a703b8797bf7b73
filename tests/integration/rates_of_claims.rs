//! Rates for given n_o as a part of claims (derivation, 13.6): against the loops that the data allow, and along solutions.

use crate::support::{Shipped, answer, certified, json, number, options, program, read};
use faer::Mat;
use rug::Rational;
use serde_json::Value;
use sigmastar_lang::spec::{Document, Notation, Oscillators};
use sigmastar_prove::certificate::certificate_json;
use sigmastar_prove::certify::{Wanted, certify_for};
use sigmastar_prove::rate::found::RateForCount;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::stability::ErrorBox;

const COUNTS: [u32; 4] = [0, 1, 4, 10];

/// How fast linear plants with one state converge, at the periodic solution: `x' = -a x + g e`, `q = r x + d e` with
/// P = p_up, so that all of |g| = k_f, |r| = b_qx and the ends and the middle of d are within the data. The slowest of all signs.
fn slowest(data: &Data<'_>, error_box: &ErrorBox<sigmastar_exact::enclosure::Enclosure>, sigma: f64, n_o: u32) -> f64 {
    let of = |value: &sigmastar_exact::enclosure::Enclosure| value.midpoint_f64();
    let (a, k_f, k_x) = (of(&error_box.rate), of(&error_box.k_f), of(&error_box.k_x) * of(&data.p_low).sqrt());
    // Where q does not have x, e does not have its rate either.
    let a = if k_x == 0.0 { 1e9 } else { a };
    let (below, above) = (-of(&error_box.sector.below), of(&error_box.sector.above));
    let (mu, w) = (of(&data.mu), of(&data.base_frequency));
    let weight = |l: usize| data.spec.internal_model.weights.weight(l as u64, 128).midpoint_f64();
    let order = 2 * n_o as usize + 3;
    let mut found = f64::INFINITY;
    for sign in [-1.0, 0.0, 1.0] {
        for d in [below, f64::midpoint(below, above), above] {
            // (x, e, zeta): y = r x + d e + mu s, e' = y - sigma e, zeta' = Phi zeta - M y.
            let y = |j: usize| match j {
                0 => k_x,
                1 => d,
                2 => mu * weight(0),
                _ if j % 2 == 1 => mu * weight((j - 1) / 2),
                _ => 0.0,
            };
            let matrix = Mat::from_fn(order, order, |i, j| match i {
                0 => [-a, sign * k_f].get(j).copied().unwrap_or(0.0),
                1 => y(j) - if j == 1 { sigma } else { 0.0 },
                2 => -y(j),
                _ => {
                    let turn = (i - 1) as f64 / 2.0;
                    let (is_first, l) = (i % 2 == 1, turn.floor() * w);
                    match (is_first, j) {
                        (true, j) => (if j == i + 1 { l } else { 0.0 }) - y(j),
                        (false, j) if j == i - 1 => -l,
                        _ => 0.0,
                    }
                }
            });
            let values = matrix.eigenvalues().expect("finite");
            found = values.iter().map(|value| -value.re).fold(found, f64::min);
        }
    }
    found
}

/// At 1.5 sigma* each rate is at least a share of that of the slowest of a few members, and never more: by the median 0.3.
#[test]
fn rates_are_near_those_of_the_loops() {
    let mut shares: Vec<(f64, String)> = Vec::new();
    for Shipped { name, spec, run, .. } in certified() {
        let gain = run.sigma_star().expect("certified") * Rational::from((3, 2));
        let mut run =
            certify_for(spec, options(), Wanted { gain: Some(&gain), ..Wanted::default() }).expect("not refuted");
        assert_eq!(run.sigma_star(), Some(&gain), "{name}");
        run.prove_rates(&COUNTS.map(Oscillators::first)).expect("by norms");
        let proof = run.sharp.proved().expect("certified");
        let data = Data::new(spec, 128);
        let periodic = [&proof.evaluation.periodic.x_per, &proof.evaluation.periodic.e_per];
        let there = ErrorBox::new(&data, proof.witness.paths, periodic, [&data.zero(), &data.zero()]);
        for RateForCount { oscillators, bound, .. } in &run.for_n_o {
            let n_o = &oscillators.largest();
            let bound = bound.as_ref().unwrap_or_else(|| panic!("{name} {n_o}: no rate"));
            let share = bound.rate.to_f64() / slowest(&data, &there, gain.to_f64(), *n_o);
            assert!(share <= 1.0 + 1e-9, "{name} {n_o}: {share}");
            assert!(bound.factor.to_f64() >= run.claimed_set().expect("certified").e0.to_f64(), "{name} {n_o}");
            shares.push((share, format!("{name} {n_o}")));
        }
        let certificate = certificate_json(&run).expect("certified");
        let report = proofs_check::check(certificate.to_string().as_bytes());
        assert!(report.is_valid(), "{name}: {}", report.text(false));
    }
    shares.sort_by(|a, b| a.0.total_cmp(&b.0));
    let median = shares[shares.len() / 2].0;
    assert!(median >= 0.3, "{median} {shares:?}");
}

/// The plant of the paper, of which the specification of the paper bounds the shifted right sides: `(x, e, z)'` with n_o = 1, mu = 1.
fn paper(sigma: f64, time: f64, [x, y, e, z0, z1, z2]: [f64; 6]) -> [f64; 6] {
    let turn = std::f64::consts::TAU;
    let c = (turn * time).cos();
    let f = [
        -x / 5.0 + 3f64.sqrt() * y + y.sin() / 10.0 + (turn * time).sin(),
        -(3f64.sqrt()) * x - y + y * y / 10.0 + y * e + (2.0 * turn * time).cos() * (1.0 + (turn * time).sin()),
    ];
    let q = 1.0 + x + (e * y).atan() + c + c * c + c.powi(3) + c.powi(4);
    let s = 2.0 * (z0 - e) + (z1 - e);
    // Gamma = -(Phi + sigma) M.
    [f[0], f[1], q - sigma * e + s, -sigma * e, turn * z2 - sigma * e, -turn * z1 + turn * e]
}

/// A step of the method of Runge and Kutta.
pub fn step(field: &dyn Fn(f64, [f64; 6]) -> [f64; 6], time: f64, h: f64, state: [f64; 6]) -> [f64; 6] {
    let add = |a: [f64; 6], b: [f64; 6], c: f64| std::array::from_fn(|i| a[i] + c * b[i]);
    let k1 = field(time, state);
    let k2 = field(time + h / 2.0, add(state, k1, h / 2.0));
    let k3 = field(time + h / 2.0, add(state, k2, h / 2.0));
    let k4 = field(time + h, add(state, k3, h));
    std::array::from_fn(|i| state[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
}

/// The largest share of factor exp(-rate t) that |e - e_per| takes from each start, for 40 periods of 1 in so many steps each. The third state is e, and
/// e_per is what is left of it after so many periods from 0.
pub fn shares(
    field: &dyn Fn(f64, [f64; 6]) -> [f64; 6],
    [steps, settled]: [usize; 2],
    [rate, factor]: [f64; 2],
    starts: &[[f64; 6]],
) -> Vec<f64> {
    let h = 1.0 / steps as f64;
    let run = |mut state: [f64; 6], periods: usize, see: &mut dyn FnMut(usize, [f64; 6])| {
        for i in 0..periods * steps {
            see(i, state);
            state = step(field, (i % steps) as f64 * h, h, state);
        }
        state
    };
    let settled = run([0.0; 6], settled, &mut |_, _| {});
    let mut periodic = Vec::new();
    run(settled, 1, &mut |_, state| periodic.push(state[2]));
    let worst = |start: &[f64; 6]| {
        let mut worst = 0.0_f64;
        run(*start, 40, &mut |i, state| {
            let error = (state[2] - periodic[i % steps]).abs();
            // What is left of the transient in the periodic solution, and of rounding.
            if error > 1e-8 {
                worst = worst.max(error / (factor * (-rate * i as f64 * h).exp()));
            }
        });
        worst
    };
    starts.iter().map(worst).collect()
}

/// Solutions of a plant within the data, from the boundary of the set, stay below factor exp(-rate t), for 40 periods.
#[test]
fn solutions_decay_as_it_is_claimed() {
    let spec = "specs/paper-example-at-rest.json";
    let found = answer(&["certify", spec, "--sigma", "45", "--n-o", "1", "--no-alternatives", "--format", "json"]);
    let report = json(&found.stdout);
    let rate = &report["for_n_o"][0];
    let (rate, factor) = (number(&rate["rate"]), number(&rate["factor"]));
    let [x_0, e_0] = ["X0", "E0"].map(|name| number(&report["initial_set"][name]));
    // x_0(0) of section 9.
    let starts = [[1.0, 0.0, 1.0], [0.0, 1.0, -1.0], [-0.7, 0.7, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]
        .map(|[x, y, e]| [-0.17869 + 0.999 * x_0 * x, 0.073256 + 0.999 * x_0 * y, e_0 * e, 0.0, 0.0, 0.0]);
    let found = shares(&|time, state| paper(45.0, time, state), [4000, 120], [rate, factor], &starts);
    assert!(found.iter().all(|share| *share <= 1.0 && *share > 0.0), "{found:?}");
    assert!(found.iter().any(|share| *share > 1e-3), "nothing is near the bound: {found:?}");
}

#[test]
fn what_has_no_rates_is_refused_with_the_reason() {
    for (arguments, part) in [
        (&["specs/paper-example.json", "--n-o", "101"][..], "100"),
        (&["specs/paper-example.json", "--n-o", "100,42"], "at most 24000 fit into one certificate"),
        (&["specs/paper-example.json", "--n-o", "0..8"], "at most 8"),
        (&["specs/paper-example.json", "--n-o", "inf"], "inf"),
        (&["specs/paper-example.json", "--n-o", "-1"], "`-1`"),
    ] {
        let output = program().arg("certify").args(arguments).args(["--format", "json"]).output().expect("it runs");
        let report = json(&output.stdout);
        assert_eq!((output.status.code(), &report["verdict"]), (Some(2), &Value::from("bad-input")), "{arguments:?}");
        let message = report["errors"][0]["message"].as_str().expect("a message");
        assert!(message.contains(part), "{arguments:?}: {message}");
    }
}

/// The largest number is decided by both programs, and its file is one that both read.
#[test]
fn many_oscillators_are_within_reach() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("certificate.json");
    let call =
        ["certify", "specs/paper-example.json", "--no-alternatives", "-q", "--sigma", "60", "--n-o", "100", "-o"];
    assert_eq!(program().args(call).arg(&path).output().expect("it runs").status.code(), Some(0));
    let bytes = std::fs::read(&path).expect("written");
    assert!(proofs_check::check(&bytes).is_valid());
    let document = Document::from_bytes_as("certificate", &bytes, Notation::Json).expect("it is not too large");
    // The slowest mode falls like n_o^(-3/2): 5e-4 with 100 of them.
    let rate = document.at("/claim/for_n_o/0/rate").expect("a rate").to_json();
    assert!((4e-4..6e-4).contains(&number(&rate)), "{rate}");
}

/// One that is given to be decided again keeps its claim, and has rates where they are asked for.
#[test]
fn a_witness_is_read_beside_rates() {
    let folder = tempfile::tempdir().expect("a folder");
    let [first, again] = ["first.json", "again.json"].map(|name| folder.path().join(name).display().to_string());
    let run = |arguments: &[&str]| program().args(arguments).output().expect("it runs").status.code();
    let spec = "specs/no-x.json";
    assert_eq!(run(&["certify", spec, "--n-o", "2,0", "-o", &first, "--no-alternatives"]), Some(0));
    assert_eq!(
        run(&["certify", spec, "--witness", &first, "--n-o", "0,2", "-o", &again, "--no-alternatives"]),
        Some(0)
    );
    let (first, again) = (read(&first), read(&again));
    assert_eq!(first["claim"], again["claim"]);
    assert_eq!(first["witness"], again["witness"]);
    assert_eq!(first["claim"]["for_n_o"][1]["n_o"], 2);
}

/// The gain has the rates that were asked for, hardly a smaller one does, and what is never reached is undecided.
#[test]
fn a_gain_for_rates_that_are_asked_for() {
    let file = "specs/motor-axis.json";
    let report = |more: &[&str]| {
        let output =
            program().args(["certify", file, "--n-o", "0,4", "--format", "json", "-q"]).args(more).output().unwrap();
        (output.status.code(), json(&output.stdout))
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("certificate.json");
    let (code, found) = report(&["--rate", "3", "-o", path.to_str().unwrap()]);
    assert_eq!((code, &found["given_gain"]), (Some(0), &Value::Bool(false)));
    let (gain, least) = (number(&found["sigma_star"]), number(&found["sigma_star_estimate"]));
    let proved = number(&found["limits"]["rate"]["proved"]);
    assert!((3.0..3.05).contains(&proved) && gain > 1.2 * least, "{proved} at {gain}, {least}");
    let claim = json(&std::fs::read(&path).unwrap())["claim"].clone();
    let slowest = claim["for_n_o"].as_array().unwrap().iter().map(|entry| number(&entry["rate"])).reduce(f64::min);
    assert_eq!(slowest, Some(proved));
    assert!(proofs_check::check(&std::fs::read(&path).unwrap()).is_valid());
    // Just below it the rate is not proved, and it is a given gain that is refused; just above it it is.
    let (code, missed) = report(&["--rate", "3", "--sigma", &format!("{:.3}", 0.98 * gain)]);
    assert_eq!((code, missed["verdict"].as_str()), (Some(3), Some("undecided")));
    assert!(missed["statement"].as_str().unwrap().contains("the rate for n_o = 4 is not proved to be at least 3"));
    let (code, given) = report(&["--rate", "3", "--sigma", &format!("{:.3}", 1.01 * gain)]);
    assert_eq!((code, &given["given_gain"]), (Some(0), &Value::Bool(true)));
    // With what else is asked for.
    let (_, both) = report(&["--rate", "3", "--peak-error", "2"]);
    assert!(number(&both["sigma_star"]) > gain && number(&both["limits"]["peak_error"]["proved"]) <= 2.0);
    let (code, never) = report(&["--rate", "1000"]);
    assert_eq!(code, Some(3));
    assert!(never["statement"].as_str().unwrap().contains("the largest one found is about"));
    for wrong in ["0", "-1", "x", "sqrt(2)"] {
        assert_eq!(report(&["--rate", wrong]).0, Some(2), "{wrong}");
    }
    program().args(["certify", file, "--rate", "3"]).assert().code(2);
    let without = sigmastar::certify(
        sigmastar::Subject::from_bytes(file, &std::fs::read(file).unwrap()).unwrap(),
        &sigmastar::CertifyOptions::new().rate("3"),
    );
    assert_eq!(without.unwrap_err().kind(), sigmastar::ErrorKind::Options);
}

/// The smallest gain of a plant at samples may rest on (Ms), which has no rates: with `--n-o` it rests on norms, and so it does where limits are kept
/// with them alone.
#[test]
fn at_samples_a_plant_of_which_rates_are_asked_rests_on_norms() {
    let report = |more: &[&str]| {
        let call =
            ["certify", "specs/plants/motor-axis.json", "--sampling-period", "1/20000", "--no-alternatives", "-q"];
        json(&program().args(call).args(["--format", "json"]).args(more).output().unwrap().stdout)
    };
    let [least, with_rates, fast, kept] =
        [&[][..], &["--n-o", "4"], &["--n-o", "4", "--rate", "4.7"], &["--peak-error", "120"]].map(report);
    assert!(number(&with_rates["sigma"]) > number(&least["sigma"]));
    assert!(number(&with_rates["for_n_o"][0]["rate"]) > 1.0);
    assert!(number(&fast["limits"]["rate"]["proved"]) >= 4.7);
    assert!(number(&kept["limits"]["peak_error"]["proved"]) <= 120.0, "{kept:#}");
}
