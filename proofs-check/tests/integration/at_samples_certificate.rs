//! Certificates at samples with matrix inequalities, each of their parts and each of their conditions forged: the converter at 1000
//! samples a period, from its certificate by norms, with numbers from semidefinite programs apart from both programs.

use super::existence_inequality::number;
use super::matrix_inequality::{PLACE, RULE, stored, times};
use super::mutations::{pointers, replacements};
use crate::common::{accepted, assert_refused, every, fails, judged, open, parsed, rehash};
use proofs_check::Report;
use proofs_check::verdict::Verdict;
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
    rehash(&mut made);
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
        let about = parsed("sampled", name);
        refused(about.clone(), "matrix_inequality", &own, PLACE);
        refused(about, "existence_inequality", &part(0), EXISTENCE_PLACE);
    }
}

/// The forms of both parts in floating point, where `tanh` in f is flat and where it is steepest, as they are written in (x, e_k, y, G,
/// w, q_0): whether each is positive semidefinite but for rounding, and lies where it must.
fn is_true(made: &Value) -> bool {
    let witness = &made["witness"];
    let (h, sigma, gain, sum) =
        (0.02 / 1000.0, 2279.03, number(&made["claim"]["gain"]), number(&witness["weight_sum"]));
    let (l, [l_21, l_22]) = (1.0127, [0.02523, 1.0124]);
    let of = |part: &Value, existence: bool| {
        let value = |name: &str| part.get(name).map_or(0.0, number);
        let p: [[f64; 2]; 2] = if existence {
            [0, 1].map(|i| [0, 1].map(|j| number(&part["P"][i][j])))
        } else {
            let w_x = number(&witness["w_x"]);
            [[w_x, 0.0], [0.0, w_x]]
        };
        let k_p = if existence { value("k_p") } else { 2.0 * number(&witness["h"]) / gain };
        let form = |steep: f64, s: f64, v: [f64; 8]| {
            let [x_1, x_2, e_k, y, slack, w, q_0, _] = v;
            let e = (1.0 - s * sigma) * e_k + s * y + slack;
            // L x' = f' (L x) + f_e e.
            let (volt, amp) = (l * x_1, l_21 * x_1 + l_22 * x_2);
            let (f_1, f_2) =
                (-400.0 * volt + 2000.0 * amp + 1000.0 * e, -2000.0 * volt - (600.0 - 300.0 * steep) * amp);
            let rate = [f_1 / l, (f_2 - l_21 * f_1 / l) / l_22];
            let q = 500.0 * volt + 800.0 * e + if existence { q_0 } else { 0.0 };
            let moved: f64 = (0..2).map(|i| (0..2).map(|j| [x_1, x_2][i] * p[i][j] * rate[j]).sum::<f64>()).sum();
            let own: f64 = (0..2).map(|i| (0..2).map(|j| [x_1, x_2][i] * p[i][j] * [x_1, x_2][j]).sum::<f64>()).sum();
            let lambda = value("lambda");
            -2.0 * moved + sigma * (2.0 - h * sigma) * e_k * e_k - 2.0 * (1.0 - h * sigma) * e_k * y - h * y * y
                + k_p * (1.0 - gain * h * sum / 2.0) * y * y
                - k_p * y * q
                + lambda * (slack * slack + 2.0 * h / PI * w * q + w * w)
                - 2.0 * value("rate") * own
                - value("c_x") * (x_1 * x_1 + x_2 * x_2)
                - value("c_e") * if existence { e * e } else { e_k * e_k }
                - value("c_y") * y * y
                + if existence { value("gamma") * q_0 * q_0 } else { q_0 * q_0 }
        };
        let [x, e] = if existence { ["X_p", "E_p"].map(|name| number(&witness[name])) } else { [0.0; 2] };
        let reaches = value("X") >= x && value("E") >= e;
        let both =
            [0.0, 1.0].into_iter().all(|steep| [0.0, h].into_iter().all(|s| semidefinite(|v| form(steep, s, v))));
        reaches && both
    };
    of(&witness["matrix_inequality"], false) && of(&witness["existence_inequality"], true)
}

/// Whether a quadratic form in seven variables is, in units in which its diagonal is 1, but for 1e-7.
fn semidefinite(form: impl Fn([f64; 8]) -> f64) -> bool {
    let unit = |i: usize, k: usize, of_k: f64| {
        form(std::array::from_fn(|l| f64::from(u8::from(l == i)) + if l == k { of_k } else { 0.0 }))
    };
    let own: Vec<f64> = (0..7).map(|i| unit(i, 7, 0.0)).collect();
    let scaled = |i: usize, k: usize| {
        let value = if i == k { own[i] } else { (unit(i, k, 1.0) - unit(i, k, -1.0)) / 4.0 };
        value / (own[i] * own[k]).abs().sqrt() + if i == k { 1e-7 } else { 0.0 }
    };
    let mut rows: Vec<Vec<f64>> = (0..7).map(|i| (0..7).map(|k| scaled(i, k)).collect()).collect();
    (0..7).all(|k| {
        let pivot = rows[k].clone();
        for row in &mut rows[k + 1..] {
            let factor = row[k] / pivot[k];
            row.iter_mut().zip(&pivot).for_each(|(entry, of)| *entry -= factor * of);
        }
        pivot[k] > 0.0
    })
}

/// Every leaf of both parts, and of what they take from the witness, altered as a forger or an accident might: what is accepted is
/// true.
#[test]
fn leaves_of_both_parts() {
    let mut original = stable();
    original["witness"]["existence_inequality"] = part(0);
    assert!(is_true(&original));
    accepted(&original);
    let mut all = Vec::new();
    for (place, name) in [(PLACE, "matrix_inequality"), (EXISTENCE_PLACE, "existence_inequality")] {
        let mut inside = Vec::new();
        pointers(&original["witness"][name], String::new(), &mut inside);
        all.extend(inside.into_iter().map(|at| format!("{place}{at}")));
    }
    all.extend(["w_x", "h", "weight_sum"].map(|name| format!("/witness/{name}")));
    let (mut made, mut passed) = (0, 0);
    let leaves = all.iter().filter(|at| original.pointer(at).is_some_and(Value::is_string));
    for (turn, at) in leaves.enumerate() {
        let value = original.pointer(at).unwrap().clone();
        let others = replacements(&value).into_iter().filter(|(_, new)| *new != value);
        for (kind, replacement) in others.skip(turn % every(4)).step_by(every(4)) {
            let mut mutant = original.clone();
            *mutant.pointer_mut(at).unwrap() = replacement;
            made += 1;
            if judged(&mutant).verdict == Verdict::Valid {
                passed += 1;
                assert!(is_true(&mutant), "{at}: {kind} is accepted");
            }
        }
    }
    println!("{made} mutants, {passed} accepted and true");
    assert!(made > 60 && passed > 0 && passed < made);
}
