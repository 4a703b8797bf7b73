//! Certificates at samples with matrix inequalities, each of their parts and each of their conditions forged: the converter at 1000
//! samples a period, from its certificate by norms, with numbers from semidefinite programs apart from both programs.

use super::common::{assert_refused, text};
use super::matrix_inequality::{PLACE, RULE, stored, times};
use proofs_check::json::{Json, decimal, parse};
use proofs_check::verdict::Verdict;
use proofs_check::{Report, check, sha256};
use serde_json::{Value, json};
use std::f64::consts::PI;

const EXISTENCE: &str = "existence inequality";
const EXISTENCE_PLACE: &str = "/witness/existence_inequality";

/// By norms, without its figures.
fn plain() -> Value {
    stored("converter-samples")
}

/// In a larger error box with a larger weight of zeta, where norms do not prove that U falls, and with an inequality that does.
fn stable() -> Value {
    let mut made = plain();
    for (name, value) in [("D_x", "13000"), ("D_e", "9400"), ("h", "0.0475")] {
        made["witness"][name] = value.into();
    }
    for entry in made["witness"]["bounds"].as_array_mut().unwrap() {
        if entry["X"] == "13374.562" {
            entry["X"] = "14200".into();
        }
        if entry["E"] == "9903.9547" {
            entry["E"] = "10500".into();
        }
    }
    made["witness"]["matrix_inequality"] =
        json!({ "X": "14200", "E": "10500", "lambda": "160800", "rate": "0.2", "c_e": "1.5", "c_y": "7e-7" });
    made
}

/// For the least rms of y, of x, of e.
fn part(which: usize) -> Value {
    let (p, [k_p, gamma, c_x, c_e, c_y]) = [
        (["0.71042", "0.12111", "0.70456"], ["0.0010954", "0.001475", "2.2", "2.2", "0.0001316"]),
        (["0.73243", "0.10867", "0.72629"], ["0.00076231", "0.000905", "68", "2.2", "4.3e-7"]),
        (["0.54182", "0.09225", "0.53734"], ["0.00075127", "0.000875", "2.2", "225", "4.3e-7"]),
    ][which];
    let [xx, xy, yy] = p;
    json!({
        "X": "3500", "E": "3100", "P": [[xx, xy], [xy, yy]], "lambda": "68371", "k_p": k_p, "gamma": gamma, "c_x": c_x, "c_e": c_e,
        "c_y": c_y,
    })
}

fn exists(which: usize) -> Value {
    let mut made = plain();
    made["witness"]["existence_inequality"] = part(which);
    made
}

fn number(value: &Value) -> f64 {
    decimal(value.as_str().unwrap()).unwrap().to_f64()
}

/// `sqrt(gamma/c) Q_m`, for the name of c.
fn by(part: &Value, name: &str) -> f64 {
    let oscillation = ((20_049.586_82_f64.powi(2) + 2.711_73_f64.powi(2) + 4000.0_f64.powi(2)) / 2.0).sqrt();
    (number(&part["gamma"]) / number(&part[name])).sqrt() * (oscillation + 6.584_82e-6)
}

/// What the inequality says of rms(x), sup|e|, rms(e), rms(e') of the converter's solution, with the sizes of this witness.
fn bounds(made: &Value) -> [f64; 4] {
    let (part, witness) = (&made["witness"]["existence_inequality"], &made["witness"]);
    let (period, samples, sigma) = (0.02_f64, 1000, 2279.03);
    let h = period / f64::from(samples);
    let a = 1.0 - h * sigma;
    let gain = |j: i32| 1.0 / (sigma * sigma + a * (2.0 / h * (PI * f64::from(j) / f64::from(samples)).sin()).powi(2));
    let r_y = by(part, "c_y");
    let start = by(&json!({ "gamma": "1", "c": "1" }), "c");
    let r_q = start + 506.356 * number(&witness["r_x"]) + 800.009 * number(&witness["r_e"]);
    let sup_e = (1..samples).map(gain).sum::<f64>().sqrt() * r_y + (h * period).sqrt() / 2.0 * r_q;
    let rms_e_t = (2.0 * r_y / (2.0 - h * sigma)).hypot(r_q);
    [by(part, "c_x"), sup_e, by(part, "c_e"), rms_e_t]
}

fn judged(certificate: &Value) -> Report {
    check(certificate.to_string().as_bytes())
}

/// The conditions of the claim that fail or are undecided, in order.
fn open(report: &Report) -> Vec<String> {
    let open = report.lines.iter().filter(|line| line.contains(" FAILS: ") || line.contains(" undecided: "));
    open.map(|line| line.split_whitespace().next().unwrap().to_owned()).collect()
}

#[track_caller]
fn accepted(certificate: &Value) -> Report {
    let report = judged(certificate);
    assert_eq!(report.verdict, Verdict::Valid, "{:?} {}", open(&report), report.text(false));
    report
}

/// Invalid for these conditions, and for no other.
#[track_caller]
fn fails(certificate: &Value, conditions: &[&str]) {
    let report = judged(certificate);
    assert_eq!(
        (open(&report), report.verdict),
        (conditions.iter().map(ToString::to_string).collect(), Verdict::Invalid)
    );
}

fn says(report: &Report, start: &str) -> bool {
    report.lines.iter().any(|line| line.trim_start().starts_with(start))
}

#[test]
fn stability_that_norms_do_not_prove() {
    let report = accepted(&stable());
    assert!(
        ["C5x ", "C5e ", RULE].iter().all(|start| says(&report, start)) && !says(&report, "C5h "),
        "{:?}",
        report.lines
    );
    let mut without = stable();
    without["witness"].as_object_mut().unwrap().remove("matrix_inequality");
    fails(&without, &["C5h"]);
    let report = accepted(&plain());
    assert!(says(&report, "C5h ") && !says(&report, RULE) && !says(&report, EXISTENCE), "{:?}", report.lines);
}

#[test]
fn existence_with_each_part() {
    for which in 0..3 {
        let report = accepted(&exists(which));
        assert!(["E1 ", "E2 ", "S1 ", EXISTENCE].iter().all(|start| says(&report, start)), "{:?}", report.lines);
        for strict in ["S1b ", "S1c ", "S2 ", "S2b ", "S2c "] {
            let line = report.lines.iter().find(|line| line.trim_start().starts_with(strict)).unwrap();
            assert!(line.contains(" < ") && !line.contains("<="), "{line}");
        }
    }
    let mut both = stable();
    both["witness"]["existence_inequality"] = part(0);
    accepted(&both);
}

/// The last digits of each number count, nothing else fails with it, and norms alone do not give it.
#[test]
fn each_condition_of_existence() {
    for (which, name, at, condition) in
        [(1, "r_x", 0, "S1c"), (0, "E_p", 1, "S2"), (2, "r_e", 2, "S2b"), (0, "r_d", 3, "S2c")]
    {
        let with = |factor: f64| {
            let mut made = exists(which);
            made["witness"][name] = format!("{:.9}", bounds(&made)[at] * factor).into();
            made
        };
        fails(&with(1.0 - 1e-7), &[condition]);
        let mut enough = with(1.0 + 1e-7);
        accepted(&enough);
        enough["witness"].as_object_mut().unwrap().remove("existence_inequality");
        assert_eq!(open(&judged(&enough))[0], condition);
    }
    let mut made = exists(0);
    made["witness"]["X_p"] = "1126.9".into();
    fails(&made, &["S1b"]);
    // A rate that is none, which is true too.
    let mut made = exists(0);
    for entry in made["witness"]["bounds"].as_array_mut().unwrap().iter_mut().filter(|entry| entry["bound"] == "rate") {
        entry["value"] = "-1".into();
    }
    assert_eq!(open(&judged(&made))[0], "S1");
}

/// They reach just as far as they must, and not less.
#[test]
fn regions_that_are_too_small() {
    let mut made = exists(0);
    for (name, of, condition) in [("X", "X_p", "E1"), ("E", "E_p", "E2")] {
        made["witness"]["existence_inequality"][name] = made["witness"][of].clone();
        accepted(&made);
        let mut less = made.clone();
        times(&mut less, &format!("{EXISTENCE_PLACE}/{name}"), 0.999_999);
        fails(&less, &[condition]);
    }
    for (name, condition) in [("X", "C5x"), ("E", "C5e")] {
        let mut less = stable();
        times(&mut less, &format!("{PLACE}/{name}"), 0.99);
        fails(&less, &[condition]);
    }
}

/// Every number a little too good, or a weight that does not go with the others.
#[test]
fn forged_numbers_are_refused() {
    let forged = |original: &Value, at: &str, factor: f64, rule: &str, place: &str| {
        let mut made = original.clone();
        times(&mut made, at, factor);
        assert_refused(&judged(&made), Verdict::Invalid, rule, place);
    };
    for (name, factor) in [("rate", 10.0), ("c_e", 10.0), ("c_y", 6.0), ("lambda", 0.5), ("lambda", 2.0)] {
        forged(&stable(), &format!("{PLACE}/{name}"), factor, RULE, PLACE);
    }
    for (which, name, factor) in [
        (0, "c_y", 1.02),
        (1, "c_x", 1.02),
        (2, "c_e", 1.1),
        (0, "gamma", 0.98),
        (0, "k_p", 0.9),
        (0, "k_p", 1.1),
        (0, "lambda", 0.5),
        (0, "lambda", 10.0),
        (0, "P/0/0", 0.97),
        (0, "P/0/0", 1.03),
        (0, "P/1/1", 0.97),
        (0, "P/1/1", 1.03),
        (0, "P/0/0", -1.0),
    ] {
        forged(&exists(which), &format!("{EXISTENCE_PLACE}/{name}"), factor, EXISTENCE, EXISTENCE_PLACE);
    }
    let mut other = exists(0);
    other["witness"]["existence_inequality"]["P"] = part(2)["P"].clone();
    assert_refused(&judged(&other), Verdict::Invalid, EXISTENCE, EXISTENCE_PLACE);
    // The weights and the law are those of the witness and of the claim.
    for (weight, factor) in [("w_x", 1.2), ("w_x", 0.8), ("h", 1.15), ("h", 0.85)] {
        let mut made = stable();
        times(&mut made, &format!("/witness/{weight}"), factor);
        assert_ne!(judged(&made).verdict, Verdict::Valid, "{weight} by {factor}");
    }
}

/// `q_0` counts without its mean in what the inequality says, and with all of the rest.
#[test]
fn the_forcing_without_its_mean() {
    let mut made = exists(2);
    made["plant"]["q"] = format!("500 + {}", made["plant"]["q"].as_str().unwrap()).into();
    made["witness"]["forcing"]["mean"] = "500".into();
    let mut canonical = String::new();
    let plant: Json = parse(made["plant"].to_string().as_bytes()).unwrap();
    plant.canonical(&mut canonical);
    made["plant_sha256"] = sha256::hex_digest(canonical.as_bytes()).into();
    for (name, value) in [("zeta", "40000"), ("z", "42000")] {
        made["claim"]["periodic_solution"][name] = value.into();
    }
    let r_e = |excess: f64| format!("{:.9}", bounds(&exists(2))[2] * excess);
    made["witness"]["r_e"] = r_e(1.0 + 1e-7).into();
    accepted(&made);
    made["witness"]["forcing"]["rest"] = "300".into();
    fails(&made, &["S2b"]);
}

/// The parts are those of a regulator at samples, and about formulas.
#[test]
fn where_they_cannot_be() {
    let (own, other) =
        (stable()["witness"]["matrix_inequality"].clone(), stored("pendulum")["witness"]["matrix_inequality"].clone());
    let existence = stored("converter");
    let refused = |mut made: Value, name: &str, part: &Value, place: &str| {
        made["witness"][name] = part.clone();
        assert_refused(&judged(&made), Verdict::BadInput, "format", place);
    };
    refused(plain(), "matrix_inequality", &other, PLACE);
    refused(stored("pendulum"), "matrix_inequality", &own, PLACE);
    refused(existence, "existence_inequality", &part(0), EXISTENCE_PLACE);
    for name in ["no-x", "paper-example"] {
        let about: Value = serde_json::from_str(&text("sampled", name)).unwrap();
        refused(about.clone(), "matrix_inequality", &own, PLACE);
        refused(about, "existence_inequality", &part(0), EXISTENCE_PLACE);
    }
}
