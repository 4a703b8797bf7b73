//! So many oscillators or more by a trial (docs/mathematics.md, section 14.4): what is accepted and refused of a loop whose periodic solution has e = 0.

use crate::trials_support::{
    Case, Expected, FORMULAS, Formulas, L, asks_for_a_tube_inside, expected, expected_with, first, largest, n_bar, text,
};
use proofs_check::verdict::Verdict;
use serde_json::{Value, json};
use std::f64::consts::TAU;

use Verdict::{BadInput, Invalid, Undecided};

/// The numbers that a trial of one number of oscillators does not have.
const MORE: [&str; 5] = ["defect_q_t", "q_tx", "q_te", "f_x", "f_e"];

/// q has a second derivative by x, and terms in t with x and e that vanish along the trial.
fn case() -> Case {
    let formulas = Formulas {
        q: "x/2 + x^2/80 - e^3/50 + x*e/10",
        values: |x, e| {
            let [f, q] = (FORMULAS.values)(x, e);
            [f, q + x * x / 80.0]
        },
        ..FORMULAS
    };
    let case = Case::or_more(formulas).trial("/q_x", "1.8");
    let q = case.parts.0["plant"]["q"].as_str().unwrap().to_owned();
    let with_t = format!("{q} + (x - ({}))*cos(2*pi*t)/20 + e*sin(2*pi*t)/20", case.x.text());
    case.part("/plant/q", with_t)
}

/// With defects of a size that counts.
fn coarse() -> Case {
    case().trial("/defect_x", "1e-3").trial("/defect_q", "2e-3").trial("/defect_q_t", "4e-3")
}

#[test]
fn the_solution_itself_is_a_trial() {
    case().accepted();
    case().steady_alone().accepted();
    Case::or_more(FORMULAS).accepted();
    // Of more oscillators it is one, too.
    case().entry("/n_o", 7).accepted();
    // With one oscillator the second harmonic of q has an answer.
    case().entry("/n_o", 1).refused(Invalid, "/u");
    case().trial("/x/mean/0", "0.101").refused(Invalid, "/defect_x");
    case().trial("/u/mean", "-0.301").refused(Invalid, "/defect_q");
    case().trial("/u/harmonics/1/cos", "-0.051").refused(Invalid, "/defect_q");
}

#[test]
fn there_is_no_harmonic_that_some_number_would_answer() {
    let with = |curve: &str, harmonics: Value| {
        let mut case = case();
        case.trial[curve]["harmonics"] = harmonics;
        case
    };
    let pair = |cos: &str, sin: &str| json!({ "cos": cos, "sin": sin });
    for first in [pair("1e-30", "0"), pair("0", "-1e-30")] {
        with("e", json!([first])).refused(Invalid, "/e");
        // Above n_o, too, where a trial of one number has them.
        with("e", json!([pair("0", "0"), pair("0", "0"), first])).refused(Invalid, "/e");
        let mut of_u = case().trial["u"]["harmonics"].as_array().unwrap().clone();
        of_u.push(first);
        with("u", json!(of_u)).refused(Invalid, "/u");
    }
    // Those that are 0 are none.
    let mut of_u = case().trial["u"]["harmonics"].as_array().unwrap().clone();
    of_u.push(pair("0", "0"));
    with("u", json!(of_u)).accepted();
    with("e", json!([pair("0", "0"), pair("0", "0"), pair("0", "0")])).accepted();
    with("e", json!([])).accepted();
}

#[test]
fn every_number_of_the_claim_is_bounded() {
    for case in [case(), coarse(), Case { own: first(5), ..coarse().entry("/n_o", 5) }] {
        let expected = expected(&case);
        let steady = ["e", "e_rms", "u"].map(|name| format!("/steady/{name}"));
        let all = ["e", "u"].map(|name| format!("/largest/{name}"));
        let mut numbers: Vec<_> = steady.iter().zip(expected.steady).chain(all.iter().zip(expected.largest)).collect();
        // A bound of the error that is not 0 as it is written, because the defects are not.
        numbers.retain(|(_, number)| *number > 1e-9);
        for (at, number) in numbers {
            case.entry(at, text(number * (1.0 + 1e-7))).accepted();
            case.entry(at, text(number * (1.0 - 1e-7))).refused(Invalid, &format!(":/claim/by_n_o/0{at}"));
        }
    }
}

/// Those of the trial, k0 and k1 each have a part in it.
#[test]
fn the_control_counts_every_number() {
    let coarse = coarse();
    let base = expected(&coarse).steady[2];
    let larger = MORE.map(|name| {
        let number: f64 = coarse.trial[name].as_str().unwrap().parse().unwrap();
        coarse.trial(&format!("/{name}"), text(number * 1.5))
    });
    let pairs = [["29.7", "79.1"], ["19.8", "118.65"]].map(|transfer| Case { transfer, ..coarse.clone() });
    for case in larger.iter().chain(&pairs) {
        let u = expected(case).steady[2];
        assert!(u > base * (1.0 + 1e-5), "{u} {base}");
        case.entry("/steady/u", text(u * (1.0 + 1e-7))).accepted();
        case.entry("/steady/u", text(u * (1.0 - 1e-7))).refused(Invalid, ":/claim/by_n_o/0/steady/u");
    }
}

/// All weights count, not those up to n_o alone: what the sum of these would give is too small.
#[test]
fn the_sum_of_all_weights_counts() {
    let case = coarse();
    let Expected { steady: [_, _, u], largest: [e, all], .. } = expected(&case);
    let own = expected_with(&case, n_bar(2));
    for (at, right, wrong) in
        [("/steady/u", u, own.steady[2]), ("/largest/e", e, own.largest[0]), ("/largest/u", all, own.largest[1])]
    {
        assert!(wrong < right * (1.0 - 1e-3), "{at}: {wrong} {right}");
        case.entry(at, text(wrong)).refused(Invalid, &format!(":/claim/by_n_o/0{at}"));
    }
}

#[test]
fn bounds_of_the_derivatives_hold_on_the_box() {
    let case = case();
    let x = case.x.clone();
    let (cos, sin) = (|t: f64| (TAU * t).cos(), |t: f64| (TAU * t).sin());
    // xhat is a solution: fhat = xhat'.
    let velocity = |t: f64| x.at(t, 1);
    let f_x = largest(|t| 2.0 + (x.at(t, 0).abs() + 4.0).powi(2) / 20.0);
    let q_tx = largest(|t| L * (velocity(t) / 40.0 - TAU * sin(t) / 20.0));
    let q_te = largest(|t| velocity(t) / 10.0 + TAU * cos(t) / 20.0);
    // The velocity counts: without it both would be far from this.
    for ratio in [q_tx / (L * TAU / 20.0), q_te / (TAU / 20.0)] {
        assert!((ratio - 1.0).abs() > 0.05, "{ratio}");
    }
    for (at, size) in [("/f_x", f_x), ("/f_e", 0.25), ("/q_tx", q_tx), ("/q_te", q_te)] {
        case.trial(at, text(size * (1.0 + 1e-5))).accepted();
        case.trial(at, text(size * (1.0 - 1e-5))).refused(Invalid, at);
    }
}

/// fhat is what f is along the curve, not the velocity of the curve.
#[test]
fn the_velocity_is_that_of_the_formulas() {
    let (case, plain) = (case(), Case::or_more(FORMULAS));
    let f = case.parts.0["plant"]["f"][0].as_str().unwrap().to_owned() + " + 1/100";
    let case = case.part("/plant/f", json!([f])).trial("/defect_x", "0.0050001").steady_alone().trial("/box/x", "1.5");
    let q_te = |more: f64| largest(|t| (case.x.at(t, 1) + more) / 10.0 + TAU * (TAU * t).cos() / 20.0);
    // Any value is taken that is so far from the velocity of the curve as the defect says.
    let right = q_te(0.01).max(q_te(-0.01));
    assert!(q_te(0.0) * (1.0 + 1e-4) < right);
    case.trial("/q_te", text(right * (1.0 + 1e-5))).accepted();
    case.trial("/q_te", text(right * (1.0 - 1e-5))).refused(Undecided, "/q_te");
    case.trial("/q_te", text(q_te(0.0) * (1.0 - 1e-2))).refused(Invalid, "/q_te");
    // In x and e alone nothing moves, where q has no t beside them.
    let f = plain.parts.0["plant"]["f"][0].as_str().unwrap().to_owned() + " + 1/100";
    let plain = plain.part("/plant/f", json!([f])).trial("/defect_x", "0.0050001").steady_alone();
    let q_te = largest(|t| plain.x.at(t, 1).abs() + 0.01) / 10.0;
    plain.trial("/q_te", text(q_te * (1.0 + 1e-5))).accepted();
    plain.trial("/q_te", text(q_te * (1.0 - 1e-5))).refused(Undecided, "/q_te");
}

/// The derivative of what is left of q along the curve.
#[test]
fn the_defect_of_the_derivative() {
    let off = case().trial("/u/harmonics/1/cos", "-0.051").trial("/defect_q", "0.0010001");
    let rate = 0.001 * 2.0 * TAU;
    off.trial("/defect_q_t", text(rate * (1.0 + 1e-6))).accepted();
    off.trial("/defect_q_t", text(rate * (1.0 - 1e-6))).refused(Invalid, "/defect_q_t");
    // A mean has none.
    case().trial("/u/mean", "-0.301").trial("/defect_q", "0.0010001").accepted();
    // The curve moves by its own velocity: with another one beside f, the same q is left.
    let f = case().parts.0["plant"]["f"][0].as_str().unwrap().to_owned() + " + 1/100";
    case()
        .part("/plant/f", json!([f]))
        .trial("/defect_x", "0.0050001")
        .trial("/box/x", "1.5")
        .steady_alone()
        .accepted();
}

#[test]
fn the_form_of_a_trial() {
    for name in MORE {
        let mut without = case();
        without.trial.as_object_mut().unwrap().remove(name);
        without.refused(BadInput, "");
        let at = format!("/{name}");
        case().trial(&at, "-1e-9").refused(BadInput, &at);
        // Of one number of oscillators there is no such field.
        let mut one = Case::new(1, FORMULAS);
        one.trial[name] = "9".into();
        one.refused(BadInput, &at);
        // Nor without the word in the entry.
        let mut alone = case();
        alone.entry.as_object_mut().unwrap().remove("or_more");
        MORE.iter().filter(|other| **other != name).for_each(|other| {
            alone.trial.as_object_mut().unwrap().remove(*other);
        });
        alone.refused(BadInput, &at);
    }
    // Without these fields it is a trial of one number, and with the word alone it is none.
    let mut alone = case();
    alone.entry.as_object_mut().unwrap().remove("or_more");
    MORE.iter().for_each(|name| drop(alone.trial.as_object_mut().unwrap().remove(*name)));
    alone.accepted();
    let mut word = Case::new(1, FORMULAS);
    word.entry["or_more"] = true.into();
    word.refused(Invalid, "/e");
    let mut unknown = case();
    unknown.trial["more"] = "1".into();
    unknown.refused(BadInput, "/more");
}

/// Only of a box on which it is one.
#[test]
fn the_solution_lies_inside_of_the_box() {
    asks_for_a_tube_inside(&coarse().steady_alone());
}

#[test]
fn a_plant_without_states() {
    let formulas = Formulas { q: "e/10 - e^3/50", values: |_, e| [0.0, e / 10.0 - e.powi(3) / 50.0], ..FORMULAS };
    let case = Case::or_more(formulas).stateless();
    case.accepted();
    let q = case.parts.0["plant"]["q"].as_str().unwrap().to_owned() + " + e*sin(2*pi*t)/20";
    let case = case.part("/plant/q", q);
    let q_te = TAU / 20.0;
    case.trial("/q_te", text(q_te * (1.0 + 1e-6))).accepted();
    case.trial("/q_te", text(q_te * (1.0 - 1e-6))).refused(Invalid, "/q_te");
    case.trial("/u/mean", "-0.301").refused(Invalid, "/defect_q");
    for name in ["q_tx", "f_x", "f_e"] {
        let mut of_states = case.clone();
        of_states.trial[name] = "1".into();
        of_states.refused(BadInput, &format!("/{name}"));
    }
}
