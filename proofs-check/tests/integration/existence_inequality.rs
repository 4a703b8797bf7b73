//! The matrix inequality of existence: its question about formulas against thresholds by hand, and certificates that need one,
//! with each of its parts and each of its conditions forged.

use super::matrix_inequality::{at_rest, stored, times};
use super::mutations::replacements;
use super::plant_support::Parts;
use crate::common::{accepted, assert_refused, certificate, drawn, every, fails, judged, open, rehash};
use proofs_check::Report;
use proofs_check::data::Data;
use proofs_check::json::{Field, decimal, parse};
use proofs_check::rules::derivation::{Derivation, Witness};
use proofs_check::rules::inequality::{Inequality, Kind, Metric, P};
use proofs_check::rules::mean_squares;
use proofs_check::rules::set::ClaimedSet;
use proofs_check::scope::Scope;
use proofs_check::spec::Specification;
use proofs_check::verdict::Verdict;
use rug::Rational;
use serde_json::{Value, json};
use std::f64::consts::PI;

const RULE: &str = "existence inequality";
const PLACE: &str = "/witness/existence_inequality";
const SIGMA: f64 = 2235.0;

pub fn number(value: &Value) -> f64 {
    let (numerator, denominator) = value.as_str().unwrap().split_once('/').unwrap_or((value.as_str().unwrap(), "1"));
    decimal(numerator).unwrap().to_f64() / decimal(denominator).unwrap().to_f64()
}

/// For the converter, from a semidefinite program: the least r_y at 2200, a smaller rms(x), and at 1900 a smaller rms(e).
fn part(which: usize) -> Value {
    let (p, [k_p, c_x, c_y, threshold]) = [
        ([0.770288, 0.129643, 0.763732], ["0.00129224", "9.3604", "0.000390516", "2200"]),
        ([1.01123, 0.131652, 1.00258], ["0.000908817", "167.699", "0.000140069", "2200"]),
        ([0.726621, 0.112467, 0.720426], ["0.00117909", "48.4675", "0.000180797", "1900"]),
    ][which];
    let [xx, xy, yy] = p.map(|entry: f64| entry.to_string());
    json!({
        "X": "3500", "E": "3100", "P": [[xx, xy], [xy, yy]], "k_p": k_p, "c_x": c_x, "c_y": c_y, "sigma": threshold,
    })
}

/// The converter's certificate by norms, without its figures and what is claimed besides.
fn plain() -> Value {
    let mut made = stored("converter");
    for figures in ["/conditions", "/constants", "/witness/lmi", "/witness/exact_regulation"] {
        let (object, name) = figures.rsplit_once('/').unwrap();
        made.pointer_mut(object).unwrap().as_object_mut().unwrap().remove(name);
    }
    made
}

fn converter(part: Value) -> Value {
    let mut made = plain();
    made["witness"]["existence_inequality"] = part;
    made
}

/// What (E) says of the converter's solution: rms(x), rms(e), rms(e'), sup|e|, where Q_m is this.
fn bounds(part: &Value, oscillation: f64) -> [f64; 4] {
    let [k_p, c_x, c_y, threshold] = ["k_p", "c_x", "c_y", "sigma"].map(|name| number(&part[name]));
    let (period, sg) = (0.02, SIGMA.hypot(100.0 * PI));
    let y = SIGMA * period;
    let bt = period * ((y / 2.0).tanh().recip() / (2.0 * y) - 1.0 / (y * y)).sqrt();
    let r_y = k_p * oscillation / c_y;
    let by = |weight: f64| k_p * oscillation / (2.0 * (weight * c_y).sqrt());
    let r_e = (r_y / sg).min(by(2.0 * (SIGMA - threshold)));
    [by(c_x).min(988.754 / 349.474 * r_e), r_e, r_y, bt * r_y]
}

/// Q_m of the converter.
fn oscillation() -> f64 {
    ((20_049.586_82_f64.powi(2) + 2.711_73_f64.powi(2) + 4000.0_f64.powi(2)) / 2.0).sqrt()
}

/// A witness that is larger than its bounds by this factor: by far too small for 10.3.
fn tight(part: Value, factor: f64) -> Value {
    let [r_x, r_e, r_d, e_p] = bounds(&part, oscillation()).map(|bound| factor * bound);
    let mut made = converter(part);
    let x_p = factor * (988.754 / 349.474 * e_p).min(0.005_355 * 988.754 * r_e);
    for (name, value) in [("r_x", r_x), ("r_e", r_e), ("r_d", r_d), ("E_p", e_p), ("X_p", x_p)] {
        made["witness"][name] = format!("{value:.6}").into();
    }
    made
}

/// After a change at a place it is invalid for these conditions, and for no other.
#[track_caller]
fn fails_with(mut made: Value, at: &str, value: &str, conditions: &[&str]) {
    made["witness"][at] = value.into();
    fails(&made, conditions);
}

#[test]
fn certificates_with_one() {
    for which in 0..3 {
        let report = accepted(&converter(part(which)));
        let line = |start: &str| report.lines.iter().find(|line| line.trim_start().starts_with(start));
        let all = ["E1 ", "E2 ", "E3 ", "S1 ", RULE];
        assert!(all.iter().all(|start| line(start).is_some()), "{:?}", report.lines);
        for strict in ["S1b ", "S1c ", "S2 ", "S2b ", "S2c "] {
            let line = line(strict).unwrap();
            assert!(line.contains(" < ") && !line.contains("<="), "{line}");
        }
    }
    // Without it nothing of it is said.
    let report = accepted(&plain());
    assert!(!report.lines.iter().any(|line| line.contains(RULE) || line.contains("r_y")), "{:?}", report.lines);
}

/// Norms ask for E_p = 3022 here. Each of the five bounds is needed by one of these.
#[test]
fn what_norms_do_not_give() {
    for (which, missing) in [(0, vec!["S2", "S2b", "S2c"]), (1, vec!["S1c"]), (2, vec!["S2b"])] {
        let made = tight(part(which), 1.01);
        let e_p = number(&made["witness"]["E_p"]);
        assert!(e_p < 205.0, "{e_p}");
        accepted(&made);
        let mut without = made.clone();
        without["witness"].as_object_mut().unwrap().remove("existence_inequality");
        let report = judged(&without);
        let open = open(&report);
        assert!(
            report.verdict == Verdict::Invalid && missing.iter().all(|id| open.contains(&id.to_string())),
            "{open:?}"
        );
    }
}

/// The last digits of each number count, and nothing else fails with it.
#[test]
fn each_condition_of_existence() {
    let below = |which: usize, at: usize| format!("{:.9}", bounds(&part(which), oscillation())[at] * (1.0 - 1e-7));
    let above = |which: usize, at: usize| format!("{:.9}", bounds(&part(which), oscillation())[at] * (1.0 + 1e-7));
    for (which, name, at, condition) in
        [(0, "E_p", 3, "S2"), (0, "r_e", 1, "S2b"), (0, "r_d", 2, "S2c"), (1, "r_x", 0, "S1c"), (2, "r_e", 1, "S2b")]
    {
        let mut made = tight(part(which), 1.01);
        fails_with(made.clone(), name, &below(which, at), &[condition]);
        made["witness"][name] = above(which, at).into();
        accepted(&made);
    }
    fails_with(tight(part(0), 1.01), "X_p", "100", &["S1b"]);
    for (name, value, condition) in
        [("X", "112", "E1"), ("E", "99", "E2"), ("sigma", "2235", "E3"), ("sigma", "2236", "E3")]
    {
        let mut made = tight(part(0), 1.01);
        made["witness"]["existence_inequality"][name] = value.into();
        assert_eq!((open(&judged(&made)), judged(&made).verdict), (vec![condition.to_owned()], Verdict::Invalid));
    }
    // A rate that is none, which is true too, makes the sides of S1b and S1c negative.
    let mut made = tight(part(0), 1.01);
    for entry in made["witness"]["bounds"].as_array_mut().unwrap().iter_mut().filter(|entry| entry["bound"] == "rate") {
        entry["value"] = "-1".into();
    }
    assert_eq!(open(&judged(&made))[0], "S1");
    // X and E reach just as far as they must.
    let mut made = tight(part(0), 1.01);
    for (name, of) in [("X", "X_p"), ("E", "E_p")] {
        made["witness"]["existence_inequality"][name] = made["witness"][of].clone();
    }
    accepted(&made);
}

/// A threshold that is not below sigma gives no bound of rms(e).
#[test]
fn the_gain_is_above_the_threshold() {
    let mut made = tight(part(2), 1.01);
    made["witness"]["existence_inequality"]["sigma"] = SIGMA.to_string().into();
    assert_eq!(open(&judged(&made)), ["E3", "S2b"]);
    let mut lower = converter(part(0));
    lower["claim"]["sigma_star"] = "2200".into();
    assert_eq!(open(&judged(&lower))[0], "E3");
}

#[test]
fn refined_mean_squares() {
    let made = |factor: f64| {
        let mut made = tight(part(0), 1.2);
        let [r_x, r_e, r_d, _] = bounds(&part(0), oscillation()).map(|bound| factor * bound);
        let [r_x, r_e, r_d] = [factor * r_x, r_e, r_d].map(|bound| format!("{bound:.9}"));
        made["witness"]["refined"] = json!({ "r_x": r_x, "r_e": r_e, "r_d": r_d });
        made
    };
    accepted(&made(1.0001));
    let mut forged = made(1.0001);
    for (name, condition) in [("r_x", "S3"), ("r_e", "S3b"), ("r_d", "S3c")] {
        let mut made = forged.clone();
        times(&mut made, &format!("/witness/refined/{name}"), 0.9998);
        assert_eq!(open(&judged(&made)), [condition]);
    }
    forged["witness"].as_object_mut().unwrap().remove("existence_inequality");
    assert!(open(&judged(&forged)).contains(&"S3b".to_owned()));
}

/// 10.4 is one more bound, and M is asked for with it.
#[test]
fn with_a_linear_part() {
    let mut made = tight(part(0), 1.01);
    made["witness"]["kap"] = "1".into();
    let report = accepted(&made);
    let m = |report: &Report| report.lines.iter().any(|line| line.contains("-b_qe <= q_e_max at (X_p, E_p)"));
    assert!(m(&report) && !m(&accepted(&tight(part(0), 1.01))), "{:?}", report.lines);
    assert!(report.lines.iter().any(|line| line.contains("q_0 form, g_k Rt, r_y/sg")), "{:?}", report.lines);
    made["witness"]["kap"] = "1e9".into();
    accepted(&made);
}

/// Every number of the inequality a little too good.
#[test]
fn forged_numbers_are_refused() {
    let original = converter(part(0));
    for (name, factor) in [
        ("c_y", 1.005),
        ("c_x", 1.5),
        ("k_p", 0.98),
        ("k_p", 6.0),
        ("sigma", 0.997),
        ("P/0/0", 0.99),
        ("P/0/0", 1.01),
        ("P/1/1", 0.97),
        ("P/1/1", 1.03),
        ("P/0/0", -1.0),
    ] {
        let mut made = original.clone();
        times(&mut made, &format!("{PLACE}/{name}"), factor);
        assert!(!is_true(&made), "{name} by {factor}");
        assert_refused(&judged(&made), Verdict::Invalid, RULE, PLACE);
    }
    for value in ["0.11", "0.15", "-0.129643", "0"] {
        let mut made = original.clone();
        for at in ["P/0/1", "P/1/0"] {
            *made.pointer_mut(&format!("{PLACE}/{at}")).unwrap() = value.into();
        }
        assert_refused(&judged(&made), Verdict::Invalid, RULE, PLACE);
    }
    // The matrix of another part.
    let mut made = original;
    made["witness"]["existence_inequality"]["P"] = part(1)["P"].clone();
    assert_refused(&judged(&made), Verdict::Invalid, RULE, PLACE);
}

/// What cannot be read, or is not where it can be.
#[test]
fn parts_that_are_none() {
    let original = converter(part(0));
    let bad = |name: &str, value: Value, pointer: &str| {
        let mut made = original.clone();
        made["witness"]["existence_inequality"][name] = value;
        assert_refused(&judged(&made), Verdict::BadInput, "format", &format!("{PLACE}{pointer}"));
    };
    for name in ["k_p", "c_x", "c_y", "sigma"] {
        for value in ["0", "-1", "x", "1e-5*2", ""] {
            bad(name, json!(value), &format!("/{name}"));
        }
    }
    for (name, value) in [("X", "-1"), ("E", "-1e-9"), ("X", "inf"), ("E", "pi")] {
        bad(name, json!(value), &format!("/{name}"));
    }
    for matrix in [
        json!([]),
        json!([["1"]]),
        json!([["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]]),
        json!([["1", "0.1"], ["0.2", "1"]]),
        json!([["1", "0"], ["0"]]),
        json!([["1", "0"]]),
        json!("1"),
        json!([["1", "x"], ["x", "1"]]),
    ] {
        bad("P", matrix, "/P");
    }
    for (name, value) in [("rate", "1"), ("splitting", "1"), ("tau", "1")] {
        bad(name, json!(value), "");
    }
    for name in ["X", "E", "P", "k_p", "c_x", "c_y", "sigma"] {
        let mut made = original.clone();
        made["witness"]["existence_inequality"].as_object_mut().unwrap().remove(name);
        assert_refused(&judged(&made), Verdict::BadInput, "format", PLACE);
    }
    let mut other = certificate(super::common::PAPER);
    other["witness"]["existence_inequality"] = part(0);
    assert_refused(&judged(&other), Verdict::BadInput, "format", PLACE);
    let mut sampled: Value = serde_json::from_str(&super::common::text("sampled", "plant-motor-axis")).unwrap();
    sampled["witness"]["existence_inequality"] = part(0);
    assert_refused(&judged(&sampled), Verdict::BadInput, "format", "/witness");
    let mut regulation = stored("linear");
    regulation["witness"]["exact_regulation"]["existence_inequality"] = part(0);
    assert_refused(&judged(&regulation), Verdict::BadInput, "format", "/witness/exact_regulation");
}

/// `q_0` counts without its mean, and with all of the rest.
#[test]
fn the_forcing_without_its_mean() {
    // 500 more, which 10.3 has in R_q; its size is in that of zeta alone.
    let mut made = tight(part(0), 1.01);
    made["plant"]["q"] = format!("500 + {}", made["plant"]["q"].as_str().unwrap()).into();
    made["witness"]["forcing"]["mean"] = "500".into();
    rehash(&mut made);
    accepted(&made);
    // A rest that is larger than it need be is one that may be there.
    let rest = 300.0;
    made["witness"]["forcing"]["rest"] = format!("{rest}").into();
    assert_eq!(open(&judged(&made)), ["S2", "S2b", "S2c"]);
    let [r_x, r_e, r_d, e_p] = bounds(&part(0), oscillation() + rest).map(|bound| format!("{:.9}", 1.0000001 * bound));
    let larger = |value: &Value| format!("{}", 1.02 * number(value));
    made["witness"]["X_p"] = larger(&made["witness"]["X_p"]).into();
    made["witness"]["r_x"] = larger(&json!(r_x)).into();
    for (name, value) in [("r_e", r_e), ("r_d", r_d), ("E_p", e_p)] {
        made["witness"][name] = value.into();
    }
    accepted(&made);
}

/// `x' = -x + e`, `q = x`: c = a_1 = b_fe = 1, so both sides of S1b and S1c are numbers without rounding.
#[test]
fn equality_is_not_enough() {
    let made = |[x_p, r_x, r_e]: [&str; 3], with: bool| {
        let mut made = stored("linear");
        for entry in made["witness"]["bounds"].as_array_mut().unwrap() {
            (entry["X"], entry["E"]) = ("2".into(), "2".into());
        }
        for (name, value) in [("X_p", x_p), ("E_p", "1/16"), ("r_x", r_x), ("r_e", r_e), ("r_d", "2/5")] {
            made["witness"][name] = value.into();
        }
        if with {
            made["witness"]["existence_inequality"] = json!({
                "X": "1/8", "E": "1/8", "P": [["1"]], "k_p": "1", "c_x": "1/2", "c_y": "1/2", "sigma": "10",
            });
        }
        let open = open(&judged(&made));
        open.into_iter().filter(|id| id.starts_with('S') || id.starts_with('E')).collect::<Vec<_>>()
    };
    // E_p = X_p, then r_e = r_x.
    for (equal, larger, condition) in [
        (["1/16", "1/13", "1/14"], ["1001/16000", "1/13", "1/14"], "S1b"),
        (["1/10", "1/16", "1/16"], ["1/10", "1001/16000", "1/16"], "S1c"),
    ] {
        assert_eq!(made(equal, true), [condition]);
        assert!(made(equal, false).is_empty() && made(larger, true).is_empty());
    }
}

/// Without states P has no rows; `2 threshold (k_p - c_y) >= 1`.
#[test]
fn without_states() {
    let made = |c_y: &str, p: Value| {
        let mut made = stored("no-states");
        // |x| <= X_p is nothing where there is no x, but E1 asks for it.
        made["witness"]["existence_inequality"] = json!({
            "X": made["witness"]["X_p"], "E": "1", "P": p, "k_p": "21/20", "c_x": "1", "c_y": c_y, "sigma": "10",
        });
        judged(&made)
    };
    assert_eq!(made("0.999", json!([])).verdict, Verdict::Valid, "{}", made("0.999", json!([])).text(false));
    assert_refused(&made("1.0001", json!([])), Verdict::Invalid, RULE, PLACE);
    assert_refused(&made("1", json!([["1"]])), Verdict::BadInput, "format", &format!("{PLACE}/P"));
}

/// The least threshold for one state and the P p, where the two other minors are positive.
fn threshold([p, k_p, c_x, c_y]: [f64; 4], [j, g, r, d]: [f64; 4]) -> f64 {
    let (a, c, k) = (-2.0 * p * j - c_x, -k_p / 2.0 * r, k_p - c_y);
    let (b_x, b_y) = (-p * g, -1.0 - k_p / 2.0 * d);
    assert!(a > 0.0 && k > 0.0 && a * k > c * c);
    (k * b_x * b_x - 2.0 * c * b_x * b_y + a * b_y * b_y) / (a * k - c * c) / 2.0
}

fn with(f: &str, q: &str, numbers: [f64; 4], [x, e]: [&str; 2], threshold: f64) -> Parts {
    let [p, k_p, c_x, c_y] = numbers.map(|value| value.to_string());
    at_rest(f, q).with(
        "/existence",
        json!({ "X": x, "E": e, "P": [[p]], "k_p": k_p, "c_x": c_x, "c_y": c_y, "sigma": format!("{threshold:.12}") }),
    )
}

/// Accepted a little above the threshold, refused a little below.
#[track_caller]
fn decided(f: &str, q: &str, numbers: [f64; 4], at: [&str; 2], least: f64) {
    with(f, q, numbers, at, 1.0001 * least).accepted();
    with(f, q, numbers, at, 0.9999 * least).refused(Verdict::Invalid, RULE, PLACE);
}

/// Every number of the inequality and of the derivatives is where it belongs; mu, w_x, h and the P of stability are nowhere.
#[test]
fn against_a_threshold_by_hand() {
    let mut draw = drawn(11);
    let mut cases = 0;
    while cases < 40 {
        let numbers = [0.2 + 2.0 * draw(), 0.3 + 2.0 * draw(), 0.1 + draw(), 0.1 + draw()];
        let [j, g, r, d] =
            [-1.0 - draw(), draw() - 0.5, draw() - 0.5, draw() - 0.5].map(|value| (value * 64.0).round() / 64.0);
        let (a, k) = (-2.0 * numbers[0] * j - numbers[2], numbers[1] - numbers[3]);
        if a < 0.1 || k < 0.1 || a * k < 1.1 * (numbers[1] / 2.0 * r).powi(2) {
            continue;
        }
        cases += 1;
        let (f, q) = (format!("{j}*x + {g}*e"), format!("{r}*x + {d}*e"));
        let least = threshold(numbers, [j, g, r, d]);
        decided(&f, &q, numbers, ["1", "1"], least);
        with(&f, &q, numbers, ["1", "1"], 1.0001 * least).with("/plant/internal_model/mu", json!("7")).accepted();
    }
}

/// The worst point is at an end of the region, or beyond it.
#[test]
fn over_the_region() {
    let numbers = [0.7, 0.6, 0.1, 0.2];
    let at = |j: f64, r: f64, d: f64| threshold(numbers, [j, 0.3, r, d]);
    decided("-2*x - x^3 + 3*e/10", "x/2", numbers, ["1/2", "1"], at(-2.0, 0.5, 0.0));
    decided("-2*x + 3*e/10", "x/2 + x^2/4", numbers, ["1/2", "1"], at(-2.0, 0.75, 0.0));
    decided("-2*x + 3*e/10", "x/2 + e^2/4", numbers, ["1", "1/2"], at(-2.0, 0.5, 0.25));
    decided("-2*x + 3*e/10", "x/2 + e^2/4", numbers, ["1", "1"], at(-2.0, 0.5, 0.5));
    with("-2*x + x^3 + 3*e/10", "x/2", numbers, ["9/10", "1"], 1e6).refused(Verdict::Invalid, RULE, PLACE);
}

/// dq/de is -1/4 at e = 0, half way and at both ends, where samples look, and larger between.
#[test]
fn what_holds_at_samples_alone_is_refused() {
    let numbers = [0.7, 0.6, 0.1, 0.2];
    let q = "x/2 - e/4 + (1 - cos(2*pi*e))/(4*pi)";
    let at = |d: f64| threshold(numbers, [-2.0, 0.3, 0.5, d]);
    let sampled = 1.001 * at(-0.25);
    assert!(sampled < at(0.25));
    with("-2*x + 3*e/10", q, numbers, ["1", "1"], sampled).refused(Verdict::Invalid, RULE, PLACE);
    decided("-2*x + 3*e/10", q, numbers, ["1", "1"], at(0.25));
    let wave = "-2*x + 3*e/10 + (1 - cos(2*pi*x))/(4*pi)";
    with(wave, "x/2", numbers, ["1", "1"], 1.001 * at(0.0)).refused(Verdict::Invalid, RULE, PLACE);
    decided(wave, "x/2", numbers, ["1", "1"], threshold(numbers, [-1.5, 0.3, 0.5, 0.0]));
}

/// Formulas are smooth up to its X and E, not only up to what the claim uses.
#[test]
fn smooth_as_far_as_it_is_asked() {
    let made = |e: &str| with("-2*x + 3*e/10", "x/2 + abs(e - 2)/10 - 1/5", [0.7, 0.6, 0.1, 0.2], ["1", e], 100.0);
    made("1").accepted();
    made("3").refused(Verdict::Undecided, "", "");
    let made = |x: &str| with("-2*x + 3*e/10", "x/2 + 0*sqrt(x + 2)", [0.7, 0.6, 0.1, 0.2], [x, "1"], 100.0);
    made("1").accepted();
    assert_eq!(made("3").verdict().1, "smoothness");
}

/// Coordinates: with x = L y it is about y.
#[test]
fn in_the_coordinates() {
    let numbers = [0.7, 0.6, 0.1, 0.2];
    let made = |least: f64| {
        with("-2*x + 3*e/5", "x/2 - e/4", numbers, ["1", "1"], least).with("/witness/coordinates", json!([["1/2"]]))
    };
    let own = threshold(numbers, [-2.0, 1.2, 0.25, -0.25]);
    assert!((own / threshold(numbers, [-2.0, 0.6, 0.5, -0.25]) - 1.0).abs() > 0.01, "{own}");
    made(1.0001 * own).accepted();
    made(0.9999 * own).refused(Verdict::Invalid, RULE, PLACE);
}

/// b_q_rms bounds q with all of its forcing, and the loop with a share of it is another: where (E) is, it counts as unknown.
#[test]
fn bounds_of_all_of_q_are_not_used() {
    let made = certificate("paper-example-rms.sharp");
    let (document, witness) = (made["specification"].to_string(), made["witness"].to_string());
    let [document, witness] = [document, witness].map(|text| parse(text.as_bytes()).unwrap());
    let field = |json| Field { json, pointer: String::new() };
    let mut fields = field(&witness).fields().unwrap();
    let spec = Specification::read(&field(&document), &mut fields).unwrap();
    let one = || Rational::from(1);
    let set = ClaimedSet { x0: one(), e0: one(), z0: None };
    let derivation = Derivation::read(&mut fields, Rational::from(40), (set, Scope::First)).unwrap();
    let (free, Witness::Sharp(w)) = (derivation.free, derivation.witness) else { panic!("it is in continuous time") };
    let d = Data::new(&spec, 128);
    let free = [&free.x_p, &free.e_p, &free.k0, &free.k1].map(|value| d.number(value));
    let [x_p, e_p, k0, k1] = &free;
    let evaluated = |inequality: Option<&Inequality>| {
        let w = mean_squares::Witness { r: [one(), one(), one()], refined: None, ..w.existence.clone() };
        mean_squares::evaluate(
            &d,
            (&w, inequality),
            &Rational::from(40),
            [x_p, e_p],
            ([k0, k1], true),
            &[d.int(1), d.int(1)],
        )
    };
    let metric = Metric {
        p: P::Own(Vec::new()),
        w: one(),
        half: one(),
        cross: Vec::new(),
        least: [one(), Rational::new(), one()],
        lambda: Rational::new(),
        gamma: None,
        extent: None,
    };
    let (kind, pointer, at) = (Kind::Existence, String::new(), [one(), one()]);
    let part = Inequality { kind, pointer, at, sigma: one(), at_samples: false, metric, far: None, splitting: None };
    let [with, without] = [evaluated(Some(&part)), evaluated(None)];
    assert!(without.rates[0].lt(&with.rates[0]) == Some(true) && without.rates[1].is_defined());
    assert!(!with.rates[1].is_defined(), "there is no other bound of it");
}

/// Whether the inequality of a part is true of the converter, by its leading minors at both ends of the slope of tanh, and whether it
/// serves the witness.
fn is_true(certificate: &Value) -> bool {
    let w = &certificate["witness"];
    let part = &w["existence_inequality"];
    let of = |name: &str| number(&part[name]);
    let p = |i: usize, j: usize| number(&part["P"][i][j]);
    let l = |i: usize, j: usize| number(&w["coordinates"][i][j]);
    let det = l(0, 0) * l(1, 1) - l(0, 1) * l(1, 0);
    let inverse = [[l(1, 1) / det, -l(0, 1) / det], [-l(1, 0) / det, l(0, 0) / det]];
    let (k, c_x, c_y) = (of("k_p"), of("c_x"), of("c_y"));
    let holds_at = |slope: f64| {
        let f_x = [[-400.0, 2000.0], [-2000.0, -600.0 + slope]];
        let sum = |term: &dyn Fn(usize) -> f64| term(0) + term(1);
        let moved = |i: usize, b: usize| sum(&|a| inverse[i][a] * f_x[a][b]);
        let j = |i: usize, m: usize| sum(&|b| moved(i, b) * l(b, m));
        let g = |i: usize| inverse[i][0] * 1000.0;
        let r = |m: usize| 500.0 * l(0, m);
        let entry = |i: usize, m: usize| match (i, m) {
            (0..2, 0..2) => -sum(&|b| p(i, b) * j(b, m) + j(b, i) * p(b, m)) - if i == m { c_x } else { 0.0 },
            (0..2, 2) => -sum(&|b| p(i, b) * g(b)),
            (0..2, 3) => -k / 2.0 * r(i),
            (2, 2) => 2.0 * of("sigma"),
            (2, 3) => -1.0 - k / 2.0 * 800.0,
            _ => k - c_y,
        };
        let mut a: Vec<Vec<f64>> = (0..4).map(|i| (0..4).map(|m| entry(i, m)).collect()).collect();
        // Elimination; the rows are the columns.
        (0..4).all(|i| {
            let pivot = a[i][i];
            for row in i + 1..4 {
                for column in row..4 {
                    a[row][column] -= a[i][row] * a[i][column] / pivot;
                }
            }
            pivot > 0.0
        })
    };
    let serves = number(&w["X_p"]) <= of("X") && number(&w["E_p"]) <= of("E") && of("sigma") < SIGMA;
    serves && part["P"][0][1] == part["P"][1][0] && holds_at(0.0) && holds_at(300.0)
}

/// Whatever a leaf is replaced by: what is accepted is true.
#[test]
fn leaves_of_the_part() {
    let (mut counts, stride) = ([0, 0], every(7));
    for which in 0..3 {
        let original = tight(part(which), 1.01);
        assert!(is_true(&original));
        let leaves = ["X", "E", "P/0/0", "P/0/1", "P/1/0", "P/1/1", "k_p", "c_x", "c_y", "sigma"];
        let mut mutants = Vec::new();
        for leaf in leaves {
            let at = format!("{PLACE}/{leaf}");
            let mut all = replacements(original.pointer(&at).unwrap());
            let value = number(original.pointer(&at).unwrap());
            let factors = [0.5, 0.9, 0.99, 1.01, 1.1, 2.0];
            all.extend(factors.map(|factor| ("scaled", json!((value * factor).to_string()))));
            for (kind, replacement) in all {
                let mut mutant = original.clone();
                *mutant.pointer_mut(&at).unwrap() = replacement.clone();
                mutants.push((format!("{at} {kind} {replacement}"), mutant.clone()));
                // Off the diagonal both entries.
                if let Some(other) = [("P/0/1", "P/1/0"), ("P/1/0", "P/0/1")].iter().find(|(one, _)| *one == leaf) {
                    *mutant.pointer_mut(&format!("{PLACE}/{}", other.1)).unwrap() = replacement;
                    mutants.push((format!("{at} and its mirror {kind}"), mutant));
                }
            }
        }
        for (what, mutant) in mutants.into_iter().skip(which).step_by(stride) {
            let valid = judged(&mutant).verdict == Verdict::Valid;
            assert!(!valid || is_true(&mutant), "accepted and not true: {what}");
            counts[usize::from(valid)] += 1;
        }
    }
    println!("{} refused, {} accepted and true", counts[0], counts[1]);
    assert!(counts[0] * stride > 300 && counts[1] * stride > 30);
}
