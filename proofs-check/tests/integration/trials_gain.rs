//! Trials with a gain of the actuator in an interval (docs/mathematics.md, sections 13.1, 14.4 and 14.5), of loops with e = 0: there `u = -q/b`, of which a
//! trial has the Taylor polynomial in `b - 1`.

use crate::trials_support::{
    Case, Expected, FORMULAS, Formulas, Wave, expected, expected_with, largest, n_bar, peaks, text,
};
use proofs_check::json::{Field, parse};
use proofs_check::rules::inequality::{Inequality, Kind};
use proofs_check::verdict::Verdict::{BadInput, Invalid};
use serde_json::{Value, json};

/// b_lo, b_hi and the largest `|b - 1|`.
const GAIN: [f64; 2] = [0.9, 1.2];
const APART: f64 = 0.2;

/// A wave times a number.
fn times(factor: f64, Wave(mean, pairs): &Wave) -> Wave {
    Wave(factor * mean, pairs.iter().map(|pair| pair.map(|part| factor * part)).collect())
}

/// This q, of a trial whose u has the powers of `b - 1` up to a degree.
pub fn of_gain(case: &Case, degree: i32) -> Case {
    let [low, high] = GAIN.map(|b| (4.0 * b).to_string());
    let mut case = case.part("/plant/input_gain", json!({ "nominal": "4", "low": low, "high": high }));
    let none = Wave(0.0, vec![]);
    let states = case.trial.get("x").is_some();
    let member = |j: i32| {
        let u = times(if j % 2 == 0 { -1.0 } else { 1.0 }, &case.q);
        let mut member = json!({ "powers": [j], "e": none.json(false, false), "u": u.json(true, false) });
        if states {
            member["x"] = none.json(true, true);
        }
        member
    };
    let members: Value = (1..=degree).map(member).collect();
    case.trial["members"] = members;
    case.gain = GAIN;
    case.of_u = (0..=degree).map(|j| APART.powi(j)).sum();
    // What is left is `q (1-b)^(degree+1)`.
    let left = largest(|t| case.q.at(t, 0)) * APART.powi(degree + 1);
    case.trial("/defect_q", text(left * (1.0 + 1e-9) + 1e-12))
}

/// With two oscillators, without an error.
fn case() -> Case {
    let mut case = Case::or_more(FORMULAS);
    case.entry.as_object_mut().unwrap().remove("or_more");
    for name in ["defect_q_t", "q_tx", "q_te", "f_x", "f_e"] {
        case.trial.as_object_mut().unwrap().remove(name);
    }
    of_gain(&case, 3)
}

/// With two or more.
fn or_more() -> Case {
    let case = of_gain(&Case::or_more(FORMULAS), 3);
    let rate = largest(|t| case.q.at(t, 1)) * APART.powi(4);
    case.trial("/defect_q_t", text(rate * (1.0 + 1e-9)))
}

/// Numbers of the claim are bounded by what is put out, u/4.
fn of_claim(case: &Case) -> [(&'static str, f64); 5] {
    let Expected { steady, largest, .. } = expected(case);
    [
        ("/steady/e", steady[0]),
        ("/steady/e_rms", steady[1]),
        ("/steady/u", steady[2] / 4.0),
        ("/largest/e", largest[0]),
        ("/largest/u", largest[1] / 4.0),
    ]
}

#[test]
fn defects_are_those_of_every_gain() {
    for degree in 0..4 {
        let case = of_gain(&case(), degree);
        let left = largest(|t| case.q.at(t, 0)) * APART.powi(degree + 1);
        let mut case = if degree > 0 { case } else { case.steady_alone() };
        if degree == 0 {
            case.trial.as_object_mut().unwrap().remove("members");
        }
        let wide = case.trial("/box/x", "4").trial("/box/e", "4");
        if degree > 0 {
            case.trial("/defect_q", text(left * (1.0 + 1e-4))).accepted();
        }
        wide.trial("/defect_q", text(left * (1.0 - 1e-4))).steady_alone().refused(Invalid, "/defect_q");
    }
    // The nominal member alone has no defect.
    case().trial("/defect_q", "1e-6").refused(Invalid, "/defect_q");
    let off = case().trial("/u/mean", "-0.301");
    off.refused(Invalid, "/defect_q");
    off.trial("/defect_q", "0.0035").accepted();
    let q = case().q;
    let rate = largest(|t| q.at(t, 1)) * APART.powi(4);
    or_more().trial("/defect_q_t", text(rate * (1.0 + 1e-4))).accepted();
    or_more().trial("/defect_q_t", text(rate * (1.0 - 1e-4))).refused(Invalid, "/defect_q_t");
}

/// kappa counts with b_hi.
#[test]
fn what_the_law_does_not_put_out_counts_with_the_largest_gain() {
    let mut case = case();
    let left = largest(|t| case.q.at(t, 0)) * APART.powi(4);
    case.trial["u"]["harmonics"].as_array_mut().unwrap().push(json!({ "cos": "0.001", "sin": "0" }));
    // The harmonic is in the defect itself, at most with b_hi, and in kappa.
    let most = largest(|t| case.q.at(t, 0) * 0.2_f64.powi(4) + 1.2e-3 * (3.0 * std::f64::consts::TAU * t).cos());
    let least = largest(|t| case.q.at(t, 0) * 0.2_f64.powi(4) - 1.2e-3 * (3.0 * std::f64::consts::TAU * t).cos());
    let right = most.max(least) + 1.2e-3;
    assert!(right > left + 1e-3);
    case.trial("/defect_q", text(right * (1.0 + 1e-4))).accepted();
    case.trial("/defect_q", text(right * (1.0 - 1e-2))).refused(Invalid, "/defect_q");
}

#[test]
fn every_number_of_the_claim_is_bounded() {
    for case in [case(), or_more()] {
        // With b = 1 each number would be smaller.
        let alone = of_claim(&Case { gain: [1.0; 2], ..case.clone() });
        for ((at, number), (_, alone)) in of_claim(&case).into_iter().zip(alone) {
            case.entry(at, text(number * (1.0 + 1e-7))).accepted();
            case.entry(at, text(number * (1.0 - 1e-7))).refused(Invalid, &format!(":/claim/by_n_o/0{at}"));
            if at.ends_with('u') || at.starts_with("/largest") {
                assert!(alone < number * (1.0 - 1e-4), "{at} {alone} {number}");
            }
        }
        // Each end counts: b_lo below, b_hi above.
        for gain in [[1.0, GAIN[1]], [GAIN[0], 1.0]] {
            let [.., (at, one)] = of_claim(&Case { gain, ..case.clone() });
            assert!(one < of_claim(&case)[4].1 * (1.0 - 1e-5));
            case.entry(at, text(one)).refused(Invalid, &format!(":/claim/by_n_o/0{at}"));
        }
    }
}

/// Of b and of its shift the end counts that is further from 1: here b_lo, with the same powers of `b - 1` and the same defect.
#[test]
fn the_further_end_counts() {
    let case = case().part("/plant/input_gain", json!({ "nominal": "4", "low": "3.2", "high": "4.4" }));
    let case = Case { gain: [0.8, 1.1], ..case };
    for (at, number) in of_claim(&case) {
        case.entry(at, text(number * (1.0 + 1e-7))).accepted();
        case.entry(at, text(number * (1.0 - 1e-7))).refused(Invalid, &format!(":/claim/by_n_o/0{at}"));
    }
}

/// Where what stands before 1/b is large the least gain counts in the peak of u.
#[test]
fn the_least_gain_counts() {
    let case = case().trial("/forms/0/P_up", "20");
    let u = expected(&case).largest[1];
    let only = expected(&Case { gain: [1.0, GAIN[1]], ..case.clone() }).largest[1];
    assert!(only < u * (1.0 - 1e-3), "{only} {u}");
    case.entry("/largest/u", text(u / 4.0 * (1.0 + 1e-7))).accepted();
    case.entry("/largest/u", text(u / 4.0 * (1.0 - 1e-7))).refused(Invalid, ":/claim/by_n_o/0/largest/u");
}

/// (14.4a) holds at both ends.
#[test]
fn a_form_holds_at_both_ends() {
    let known = || {
        let mut known = case().part("/plant/input_gain", json!({ "nominal": "4", "low": "4", "high": "4" }));
        known.trial.as_object_mut().unwrap().remove("members");
        known
    };
    let form = |case: Case, c_y: &str| case.trial("/forms/0/c_y", c_y).steady_alone();
    form(known(), "0.5").accepted();
    form(case(), "0.45").accepted();
    form(case(), "0.5").refused(Invalid, "/forms/0");
    let finding = form(case(), "0.5").judged().unwrap_err();
    assert!(finding.message.contains(", at b_lo"), "{finding:?}");
    // Where d is positive and the shift negative it is the other one.
    let lower = Formulas {
        q: "x/2 - e^3/50 + x*e/10 - 6*e",
        values: |x, e| {
            let [f, q] = (FORMULAS.values)(x, e);
            [f, q - 6.0 * e]
        },
        ..FORMULAS
    };
    let with = |formulas: Formulas, c_y: &str| {
        let mut case = Case::or_more(formulas);
        case.entry.as_object_mut().unwrap().remove("or_more");
        for name in ["defect_q_t", "q_tx", "q_te", "f_x", "f_e"] {
            case.trial.as_object_mut().unwrap().remove(name);
        }
        case.trial("/q_e", "8").trial("/forms/0/c_y", c_y).steady_alone()
    };
    with(lower, "0.2").accepted();
    let finding = of_gain(&with(lower, "0.2"), 3).judged().unwrap_err();
    assert!(finding.pointer.ends_with("/forms/0") && finding.message.contains(", at b_hi"), "{finding:?}");
}

/// By the function of the claim: b_hi h at the start, and b_lo h, with the share of a threshold, below.
#[test]
fn the_function_of_the_claim() {
    const P_UP: f64 = 1.25;
    let case = case().trial("/forms/0/P_up", "9").part("/witness/lyapunov/p_up", P_UP.to_string());
    let case = Case { weights: ["0.3", "0.7"], ..case };
    let part = json!({ "X": "2", "E": "2", "rate": "1", "sigma": "3" });
    let json = parse(part.to_string().as_bytes()).unwrap();
    let weights = ["0.3", "0.7"].map(|text| proofs_check::json::decimal(text).unwrap());
    let field = Field { json: &json, pointer: "/witness/matrix_inequality".to_owned() };
    let by_matrix: Inequality = Inequality::read(&field, Kind::Matrix, [&weights[0], &weights[1]], None).unwrap();
    let [x, e, z] = expected(&case).distances;
    let level = 0.3 * P_UP * x * x + e * e + 0.7 * GAIN[1] * z * z;
    for (case, share) in [(case.clone(), 1.0), (Case { stability: Some(by_matrix), ..case.clone() }, 0.75)] {
        let [of_e, of_u] = peaks(&case, level, [1.0, 0.7 * GAIN[0] * share]);
        let forms = expected(&case).largest;
        assert!(of_e < forms[0], "{of_e} {forms:?}");
        for (at, number) in [("/largest/e", of_e), ("/largest/u", of_u.min(forms[1]) / 4.0)] {
            case.entry(at, text(number * (1.0 + 1e-7))).accepted();
            case.entry(at, text(number * (1.0 - 1e-7))).refused(Invalid, &format!(":/claim/by_n_o/0{at}"));
        }
        if of_u < forms[1] {
            let wrong = peaks(&case, level, [1.0, 0.7 * share])[1];
            assert!(wrong < of_u * (1.0 - 1e-3));
        }
    }
    let fewer = expected_with(&case, n_bar(0)).distances[2];
    assert!(fewer < z);
}

/// (14.5a) along x first: S with e at both ends.
#[test]
fn along_x_first_at_both_ends() {
    let with = |case: Case, s: &str| {
        let mut case = Case { error_box: ["0.1", "0.1"].map(str::to_owned), ..case };
        case = case.trial("/box/x", "0.4").trial("/box/e", "0.4");
        case.trial["x_first"] = json!({
            "box": { "x": "1.5", "e": "1.7" }, "E": "1",
            "forms": [{
                "P": [["1"]], "p": ["0"], "w": "1", "k_p": "0.8", "c_x": "1.5", "c_e": "2", "c_y": "0.05",
                "P_up": "1.01", "x_low": "0.99", "e_low": "0.9", "S": [["0.5", "0"], ["0", s]],
            }],
        });
        case
    };
    let mut known = case().part("/plant/input_gain", json!({ "nominal": "4", "low": "4", "high": "4" }));
    known.trial.as_object_mut().unwrap().remove("members");
    // d is at most (x + 3)/10 there: `(1 + 0.4 d)^2/(6 - 0.125)` of x and d is the least with b = 1, and with `d + 0.4` at b_lo.
    with(known.clone(), "0.45").accepted();
    with(case(), "0.45").accepted();
    with(known, "0.24").accepted();
    with(case(), "0.24").refused(Invalid, "/x_first/forms/0");
}

#[test]
fn powers_of_the_gain_stand_last() {
    let family = |powers: Value| {
        let mut case =
            case().part("/plant/parameters", json!({ "a": { "nominal": "1", "low": "0.9", "high": "1.1" } }));
        for part in ["orbit", "forcing"] {
            let zero = if part == "orbit" { json!(["0"]) } else { json!("0") };
            case.parts.0["witness"][part]["sensitivities"] = json!([{ "mean": zero, "harmonics": [] }]);
        }
        for j in 0..3 {
            case.trial["members"][j]["powers"] = powers[j].clone();
        }
        case
    };
    family(json!([[0, 1], [0, 2], [0, 3]])).accepted();
    family(json!([[1, 0], [2, 0], [3, 0]])).refused(Invalid, "/defect_q");
    // The orbit moves with a where the curves do not: by 1/2 in its coordinates.
    let mut moving =
        family(json!([[0, 1], [0, 2], [0, 3]])).trial("/box/x", "0.1").trial("/box/e", "0.1").steady_alone();
    moving.parts.0["witness"]["orbit"]["sensitivities"] = json!([{ "mean": ["1"], "harmonics": [] }]);
    let x = expected(&case()).sizes[0] + 0.05 + 0.1;
    let within = |x: f64| Case { error_box: [format!("{x:e}"), "1".to_owned()], ..moving.clone() };
    within(x * (1.0 + 1e-6)).accepted();
    within(x * (1.0 - 1e-6)).refused(Invalid, "");
    family(json!([[0, 1], [0, 2], [3]])).refused(BadInput, "/members/2/powers");
    case().trial("/members/0/powers", json!([0, 1])).refused(BadInput, "/members/0/powers");
}

/// Of a gain that is nominal nothing moves.
#[test]
fn a_gain_that_is_known() {
    let case = case().part("/plant/input_gain", json!({ "nominal": "4", "low": "4", "high": "4" }));
    case.refused(BadInput, "/members");
}
