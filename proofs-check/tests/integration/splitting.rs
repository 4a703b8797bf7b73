//! A matrix inequality with the derivatives at two points: its two questions against numbers by hand, and a certificate that rests
//! on a splitting matrix with each of its parts forged.

use super::matrix_inequality::{PLACE, RULE, at_rest, stored, times};
use super::plant_support::Parts;
use proofs_check::check;
use proofs_check::verdict::Verdict;
use serde_json::{Value, json};

/// F without e for `x' = -2 x + ...`, `q = x/2 + ...`, with w_x = 0.7, h = 0.6 and mu = 2, so that kp is 0.6: times a factor.
fn s(factor: f64) -> Value {
    let entry = |value: f64| format!("{:.12}", value * factor);
    let (own, beside, last) = (entry(0.7 * 2.0 * 1.999), entry(-0.6 / 2.0 * 0.5), entry(0.6));
    json!([[own, beside], [beside, last]])
}

/// `v' S^-1 v/2` for df/de = 3/10 and that dq/de, with S = s(1).
fn threshold(d: f64) -> f64 {
    let (a, b, c) = (0.7 * 2.0 * 1.999, -0.15, 0.6);
    let (g, k) = (-0.7 * 0.3, -1.0 - 0.3 * d);
    (c * g * g - 2.0 * b * g * k + a * k * k) / (a * c - b * b) / 2.0
}

/// (J, r) with E = `e_of_s`, (g, d) with X = `x_of_s`.
fn with_s(f: &str, q: &str, [x_of_s, e_of_s]: [&str; 2], s: Value, sigma: f64) -> Parts {
    at_rest(f, q)
        .with("/plant/internal_model/mu", json!("2"))
        .inequality(["0.7", "0.6"], ["1", "1"], "0.001", sigma)
        .with("/inequality/part/splitting", json!({ "X": x_of_s, "E": e_of_s, "S": s }))
}

/// dq/de is largest at an end of E: S is all of F without e, and then a little more than that.
#[test]
fn against_a_threshold_by_hand() {
    let made = |factor: f64, sigma: f64| with_s("-2*x + 3*e/10", "x/2 + e^2/4", ["1", "1/2"], s(factor), sigma);
    let least = threshold(0.5);
    made(1.0 - 1e-6, 1.0001 * least).accepted();
    made(1.0 - 1e-6, 0.9999 * least).refused(Verdict::Invalid, RULE, PLACE);
    made(1.0001, 1.0001 * least).refused(Verdict::Invalid, RULE, PLACE);
    // At mu = 1 the same S is no longer below F.
    let other = made(1.0 - 1e-6, 10.0 * least).with("/plant/internal_model/mu", json!("3"));
    other.refused(Verdict::Invalid, RULE, PLACE);
}

/// Each question is about its own region: df/dx changes with e, dq/de with x.
#[test]
fn each_side_has_its_own_region() {
    let f = |reach: &str| with_s("-2*x + x*e/2 + 3*e/10", "x/2", ["0", reach], s(0.999), 3.0);
    f("0").accepted();
    f("1").refused(Verdict::Invalid, RULE, PLACE);
    let q = |reach: &str, sigma: f64| with_s("-2*x + 3*e/10", "x/2 + x*e", [reach, "0"], s(0.999), sigma);
    q("0", 1.01 * threshold(0.0)).accepted();
    q("1", 1.01 * threshold(0.0)).refused(Verdict::Invalid, RULE, PLACE);
    q("1", 1.01 * threshold(1.0)).accepted();
}

/// df/dx is -2 at x = 0, half way and at both ends, where samples look, and larger between.
#[test]
fn what_holds_at_samples_alone_is_refused() {
    let wave = "-2*x + 3*e/10 + (1 - cos(2*pi*x))/(4*pi)";
    with_s(wave, "x/2", ["1", "1"], s(0.999), 10.0).refused(Verdict::Invalid, RULE, PLACE);
    with_s(wave, "x/2", ["1", "1"], s(0.7), 10.0).accepted();
}

#[test]
fn what_is_no_splitting() {
    let made = |s: Value| with_s("-2*x + 3*e/10", "x/2", ["1", "1"], s, 10.0);
    made(s(0.99)).accepted();
    let at = format!("{PLACE}/splitting/S");
    for matrix in [json!([]), json!([["0.1"]]), json!([["1", "0.1"], ["0.2", "1"]]), json!([["1", "0"], ["0"]])] {
        made(matrix).refused(Verdict::BadInput, "", &at);
    }
    let three = json!([["0.1", "0", "0"], ["0", "0.1", "0"], ["0", "0", "0.1"]]);
    made(three).refused(Verdict::BadInput, "", &at);
    for (name, value) in [("X", "-1"), ("E", "-1"), ("X", "x")] {
        let made = made(s(0.99)).with(&format!("/inequality/part/splitting/{name}"), json!(value));
        made.refused(Verdict::BadInput, "", &format!("{PLACE}/splitting/{name}"));
    }
}

/// A certificate whose paths move e first; mu = 2.
#[test]
fn forged_parts_are_refused() {
    let original = stored("splitting");
    let report = check(original.to_string().as_bytes());
    assert!(report.is_valid(), "{}", report.text(false));
    for name in ["C5j ", "C5g ", "C5m "] {
        assert!(report.lines.iter().any(|line| line.trim_start().starts_with(name)), "{name}: {:?}", report.lines);
    }
    for (name, factor, rule, message) in [
        ("sigma", 1.02, "sharp", ": C5m, "),
        ("sigma", 0.98, RULE, "S with e >= 0 at"),
        ("X", 0.99, "sharp", ": C5x, "),
        ("E", 0.99, "sharp", ": C5e, "),
        ("splitting/X", 0.99, "sharp", ": C5g, "),
        ("splitting/E", 0.99, "sharp", ": C5j, "),
        ("splitting/E", 3.0, RULE, "F without e >= S at"),
        ("splitting/X", 100.0, RULE, "S with e >= 0 at"),
        ("E", 3.0, RULE, "S with e >= 0 at"),
    ] {
        let mut made = original.clone();
        times(&mut made, &format!("{PLACE}/{name}"), factor);
        refused(&made, Verdict::Invalid, rule, message, &format!("{name} by {factor}"));
    }
    for (factor, message) in [(1.05, "F without e >= S at"), (0.9, "S with e >= 0 at"), (-1.0, "S with e >= 0 at")] {
        let mut made = original.clone();
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            times(&mut made, &format!("{PLACE}/splitting/S/{i}/{j}"), factor);
        }
        refused(&made, Verdict::Invalid, RULE, message, &format!("S by {factor}"));
    }
}

/// Where f and q move on two paths, only the straight one is open to both; it needs the whole of each region.
#[test]
fn two_paths_are_the_straight_one() {
    for (f, q) in [("straight", "e-first"), ("e-first", "x-first"), ("straight", "straight")] {
        let mut made = stored("splitting");
        made["witness"]["paths"] = json!({ "f": f, "q": q });
        refused(&made, Verdict::Invalid, "sharp", ": C5g, ", &format!("{f}, {q}"));
    }
}

#[track_caller]
fn refused(certificate: &Value, verdict: Verdict, rule: &str, message: &str, what: &str) {
    let report = check(certificate.to_string().as_bytes());
    let finding = report.finding.as_ref().unwrap_or_else(|| panic!("{what} is accepted"));
    assert_eq!((finding.verdict, finding.rule), (verdict, rule), "{what}: {finding:?}");
    assert!(finding.message.contains(message), "{what}: {}", finding.message);
}
