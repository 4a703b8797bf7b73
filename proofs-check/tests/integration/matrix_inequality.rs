//! The matrix inequality of stability: its question about formulas against thresholds by hand, and a certificate that rests on one
//! with each of its parts forged.

use super::plant_support::Parts;
use crate::common::{assert_refused, parsed};
use proofs_check::check;
use proofs_check::json::decimal;
use proofs_check::verdict::Verdict;
use rug::Rational;
use serde_json::{Value, json};
use std::f64::consts::PI;

pub const RULE: &str = "matrix inequality";
pub const PLACE: &str = "/witness/matrix_inequality";

/// The least sigma of F for one state: `b' G^-1 b/2` with `G = [[-p' - 2 p (j + rate), -(h/mu) r], [., 2 h/mu]]`, times w_x where P
/// is, and `b = (-p g, -1 - (h/mu) d)`; mu = 1.
fn threshold([w_x, h, rate]: [f64; 3], [p, p_rate]: [f64; 2], [j, g, r, d]: [f64; 4]) -> f64 {
    let (a, c, k) = (-w_x * (p_rate + 2.0 * p * (j + rate)), -h * r, 2.0 * h);
    let (b_x, b_y) = (-w_x * p * g, -1.0 - h * d);
    (k * b_x * b_x - 2.0 * c * b_x * b_y + a * b_y * b_y) / (a * k - c * c) / 2.0
}

/// A plant with the orbit 0, whose forcing is 0.
pub fn at_rest(f: &str, q: &str) -> Parts {
    let orbit = json!({ "mean": ["0"], "defect": "0", "tube": "0.01", "radius": "0" });
    let forcing = json!({ "mean": "0", "rest": "1e-9", "rest_t": "1e-9" });
    Parts::scalar(f, q).with("/witness/orbit", orbit).with("/witness/forcing", forcing)
}

/// Accepted a little above the threshold, refused a little below.
#[track_caller]
fn decided(parts: &Parts, weights: [&str; 2], [x, e]: [&str; 2], threshold: f64) {
    parts.clone().inequality(weights, [x, e], "0.001", 1.0001 * threshold).accepted();
    let below = parts.clone().inequality(weights, [x, e], "0.001", 0.9999 * threshold);
    below.refused(Verdict::Invalid, RULE, PLACE);
}

#[test]
fn of_a_linear_plant() {
    let linear = at_rest("-2*x + 3*e/10", "x/2 - e/4");
    let own = threshold([0.7, 0.6, 0.001], [1.0, 0.0], [-2.0, 0.3, 0.5, -0.25]);
    decided(&linear, ["0.7", "0.6"], ["1", "1"], own);
    // Every number of the weights and of the derivatives counts.
    for (weights, f, q) in [
        (["0.7", "0.8"], "-2*x + 3*e/10", "x/2 - e/4"),
        (["0.4", "0.6"], "-2*x + 3*e/10", "x/2 - e/4"),
        (["0.7", "0.6"], "-1.5*x + 3*e/10", "x/2 - e/4"),
        (["0.7", "0.6"], "-2*x - 3*e/10", "x/2 - e/4"),
        (["0.7", "0.6"], "-2*x + 3*e/10", "x - e/4"),
        (["0.7", "0.6"], "-2*x + 3*e/10", "x/2 + e/4"),
    ] {
        let number = |text: &str| decimal(text).unwrap().to_f64();
        let j = if f.starts_with("-1.5") { -1.5 } else { -2.0 };
        let g = if f.contains("- 3") { -0.3 } else { 0.3 };
        let (r, d) = (if q.starts_with("x/2") { 0.5 } else { 1.0 }, if q.contains('+') { 0.25 } else { -0.25 });
        let other = threshold([number(weights[0]), number(weights[1]), 0.001], [1.0, 0.0], [j, g, r, d]);
        assert!((other / own - 1.0).abs() > 1e-3, "{weights:?} {f} {q}");
        decided(&at_rest(f, q), weights, ["1", "1"], other);
    }
}

/// The worst point is in the middle of the region in x, or at its end.
#[test]
fn over_the_region_in_x() {
    let weights = ([0.7, 0.6, 0.001], ["0.7", "0.6"]);
    let at = |j: f64, r: f64| threshold(weights.0, [1.0, 0.0], [j, 0.3, r, 0.0]);
    decided(&at_rest("-2*x - x^3 + 3*e/10", "x/2"), weights.1, ["1/2", "1"], at(-2.0, 0.5));
    // dq/dx = 1/2 + x.
    decided(&at_rest("-2*x + 3*e/10", "x/2 + x^2/2"), weights.1, ["1/2", "1"], at(-2.0, 1.0));
    decided(&at_rest("-2*x + 3*e/10", "x/2 + x^2/2"), weights.1, ["1/4", "1"], at(-2.0, 0.75));
    // f bends the other way: no damping is left at x = 9/10, and no sigma is enough.
    let wild = at_rest("-2*x + x^3 + 3*e/10", "x/2").inequality(weights.1, ["9/10", "1"], "0.001", 1e6);
    wild.refused(Verdict::Invalid, RULE, PLACE);
}

/// dq/de is -1/4 at e = 0 and at both ends, where samples look, and larger between.
#[test]
fn what_holds_at_samples_alone_is_refused() {
    let wave = at_rest("-2*x + 3*e/10", "x/2 - e/4 + (1 - cos(2*pi*e))/(4*pi)");
    let at = |d: f64| threshold([0.7, 0.6, 0.001], [1.0, 0.0], [-2.0, 0.3, 0.5, d]);
    let sampled = 1.001 * at(-0.25);
    assert!(sampled < at(0.25));
    wave.clone().inequality(["0.7", "0.6"], ["1", "1"], "0.001", sampled).refused(Verdict::Invalid, RULE, PLACE);
    // E = 1/2 has the slope sin(pi)/2 - 1/4 at its end too.
    decided(&wave, ["0.7", "0.6"], ["1", "1/2"], at(0.25));
}

/// P' counts, and P stands beside df/de.
#[test]
fn with_a_p_that_moves() {
    let moving = at_rest("-2*x + 3*e/10", "x/2 - e/4")
        .with("/witness/lyapunov/harmonics", json!([{ "cos": [["1/5"]], "sin": [["0"]] }]))
        .with("/witness/lyapunov/p_low", json!("0.79"))
        .with("/witness/lyapunov/p_up", json!("1.21"));
    let at = |k: u32| {
        let (sin, cos) = (2.0 * PI * f64::from(k) / 20_000.0).sin_cos();
        threshold([0.7, 0.6, 0.001], [1.0 + 0.2 * cos, -0.4 * PI * sin], [-2.0, 0.3, 0.5, -0.25])
    };
    let largest = (0..20_000).map(at).fold(0.0, f64::max);
    decided(&moving, ["0.7", "0.6"], ["1", "1"], largest);
}

#[test]
fn parts_that_are_no_inequality() {
    let linear = at_rest("-2*x + 3*e/10", "x/2 - e/4").inequality(["0.7", "0.6"], ["1", "1"], "0.001", 10.0);
    linear.accepted();
    for (name, value) in [("X", "-1"), ("E", "-1"), ("rate", "0"), ("rate", "-1"), ("sigma", "0"), ("sigma", "x")] {
        let made = linear.clone().with(&format!("/inequality/part/{name}"), json!(value));
        made.refused(Verdict::BadInput, "", &format!("{PLACE}/{name}"));
    }
    linear.clone().with("/inequality/part/w_x", json!("1")).refused(Verdict::BadInput, "", PLACE);
}

/// The pendulum, whose claim rests on a matrix inequality.
fn pendulum() -> Value {
    stored("pendulum")
}

pub fn stored(name: &str) -> Value {
    parsed("plants", &format!("{name}.certificate"))
}

pub fn times(certificate: &mut Value, pointer: &str, factor: f64) {
    let place = certificate.pointer_mut(pointer).unwrap();
    let exact = decimal(place.as_str().unwrap()).unwrap() * Rational::from_f64(factor).unwrap();
    *place = json!(exact.to_string());
}

#[test]
fn a_certificate_that_rests_on_one() {
    let report = check(pendulum().to_string().as_bytes());
    assert!(report.is_valid(), "{}", report.text(false));
    let proved = |start: &str| report.lines.iter().any(|line| line.trim_start().starts_with(start));
    assert!(proved("C5m ") && proved(RULE) && !proved("C5b "), "{:?}", report.lines);
}

/// Each part of it, a little too good.
#[test]
fn forged_parts_are_refused() {
    for (name, factor, rule, message) in [
        ("sigma", 1.02, "sharp", ": C5m, "),
        ("sigma", 0.98, RULE, "F >= 0 at"),
        ("X", 0.99, "sharp", ": C5x, "),
        ("E", 0.99, "sharp", ": C5e, "),
        ("X", 2.0, RULE, "F >= 0 at"),
        ("rate", 1e7, RULE, "F >= 0 at"),
    ] {
        let mut made = pendulum();
        times(&mut made, &format!("{PLACE}/{name}"), factor);
        let report = check(made.to_string().as_bytes());
        let finding = report.finding.as_ref().unwrap_or_else(|| panic!("{name} by {factor} is accepted"));
        assert_eq!((finding.verdict, finding.rule), (Verdict::Invalid, rule), "{name} by {factor}: {finding:?}");
        assert!(finding.message.contains(message), "{name} by {factor}: {}", finding.message);
    }
    // Its weights are those of the witness.
    for (weight, factor) in [("w_x", 1.02), ("w_x", 0.98), ("h", 1.02), ("h", 0.98)] {
        let mut made = pendulum();
        times(&mut made, &format!("/witness/{weight}"), factor);
        assert_ne!(check(made.to_string().as_bytes()).verdict, Verdict::Valid, "{weight} by {factor}");
    }
}

/// Without it C5 is asked for, which the norms of this witness do not give; and no specification has one.
#[test]
fn without_it_and_where_it_cannot_be() {
    let mut made = pendulum();
    let taken = made["witness"].as_object_mut().unwrap().remove("matrix_inequality").unwrap();
    let report = check(made.to_string().as_bytes());
    assert_refused(&report, Verdict::Invalid, "sharp", "/witness");
    let mut other = super::common::certificate(super::common::PAPER);
    other["witness"]["matrix_inequality"] = taken;
    assert_refused(&check(other.to_string().as_bytes()), Verdict::BadInput, "format", PLACE);
}
