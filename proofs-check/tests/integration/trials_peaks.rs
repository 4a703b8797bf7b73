//! Which solution a trial is about, and the peaks by the function of the claim (docs/mathematics.md, sections 14.4 and 14.5).

use crate::trials_support::{Case, Expected, FORMULAS, SIGMA, expected, expected_with, n_bar, peaks, text};
use proofs_check::json::{Field, parse};
use proofs_check::rules::inequality::{Inequality, Kind};
use proofs_check::verdict::Verdict::Invalid;
use rug::Rational;
use serde_json::json;

const E: &str = ":/claim/by_n_o/0/largest/e";
const U: &str = ":/claim/by_n_o/0/largest/u";

/// w_x, h, and P_up of the triple.
const WEIGHTS: [&str; 2] = ["0.3", "0.7"];
const P_UP: f64 = 1.25;

/// With defects of a size that counts, and a function of the claim that is smaller than those of the forms.
fn case() -> Case {
    let case = Case::new(1, FORMULAS).trial("/defect_x", "1e-3").trial("/defect_q", "2e-3");
    let case = case.trial("/forms/0/k_p", "1.5").trial("/forms/0/P_up", "2").trial("/forms/0/c_y", "0.15");
    Case { weights: WEIGHTS, ..case.part("/witness/lyapunov/p_up", P_UP.to_string()) }
}

/// `w_x P_up dX^2 + dE^2 + h dZ^2`.
fn level([x, e, z]: [f64; 3]) -> f64 {
    let [w_x, h] = WEIGHTS.map(|text| text.parse::<f64>().unwrap());
    w_x * P_UP * x * x + e * e + h * z * z
}

/// These are the least that is proved of both numbers.
#[track_caller]
fn least(case: &Case, [e, u]: [f64; 2]) {
    for (at, number, place) in [("/largest/e", e, E), ("/largest/u", u, U)] {
        case.entry(at, text(number * (1.0 + 1e-7))).accepted();
        case.entry(at, text(number * (1.0 - 1e-7))).refused(Invalid, place);
    }
}

#[test]
fn the_function_of_the_claim_bounds_the_peaks() {
    let (one, more) = (case(), Case::or_more(FORMULAS).trial("/defect_q", "2e-3").trial("/forms/0/P_up", "9"));
    let more = Case { weights: WEIGHTS, ..more.part("/witness/lyapunov/p_up", P_UP.to_string()) };
    for case in [one, more] {
        let Expected { distances, largest: [of_e, _], .. } = expected(&case);
        let own = peaks(&case, level(distances), [1.0, 0.7]);
        assert!(own[0] < of_e * (1.0 - 1e-3), "{own:?} {of_e}");
        let [_, by_form] = expected(&case).largest;
        least(&case, [own[0], own[1].min(by_form)]);
        // The sizes are those of this number of oscillators, and Nbar too.
        let fewer = level(expected_with(&case, n_bar(0)).distances);
        let wrong = peaks(&case, fewer, [1.0, 0.7])[0];
        assert!(wrong < own[0] * (1.0 - 1e-3));
        case.entry("/largest/e", text(wrong)).refused(Invalid, E);
        // Of each number the least counts.
        let large = Case { weights: ["1e9", "1e9"], ..case.clone() };
        least(&large, expected(&case).largest);
    }
}

/// Of joint metrics the share of each counts, with e_low and k_p.
#[test]
fn joint_metrics_are_the_function_of_the_claim() {
    let part = json!({
        "X": "2", "E": "2", "sigma": "3",
        "near": {
            "P": [["0.2"]], "p": ["0.01"], "w": "0.6", "k_p": "0.5", "c_x": "1", "c_e": "1", "c_y": "1",
            "P_up": "0.25", "x_low": "0.1", "e_low": "0.5",
        },
        "far": {
            "P": [["0.3"]], "w": "0.4", "k_p": "0.9", "c_x": "1", "c_e": "1", "c_y": "1",
            "P_up": "0.35", "x_low": "0.1", "e_low": "0.3",
        },
    });
    let json = parse(part.to_string().as_bytes()).unwrap();
    let none = Rational::new();
    let field = Field { json: &json, pointer: "/witness/joint_inequality".to_owned() };
    let joint = Inequality::read(&field, Kind::Joint, [&none; 2], None).unwrap();
    let case = Case { stability: Some(joint), ..case() };
    let [x, e, z] = expected(&case).distances;
    let near = 0.25 * x * x + 0.02 * x * e + 0.6 * e * e + 0.25 * z * z;
    let far = 0.35 * x * x + 0.4 * e * e + 0.45 * z * z;
    let share = 3.0 / SIGMA;
    let between = |near: f64, far: f64| share * near + (1.0 - share) * far;
    let own = peaks(&case, between(near, far), [between(0.5, 0.3), between(0.25, 0.45)]);
    let of_forms = expected(&case).largest;
    assert!(own[0] < of_forms[0] && own[1] < of_forms[1], "{own:?} {of_forms:?}");
    least(&case, own);
}

/// Where solutions may leave the box of the trial nothing is known by its forms.
#[test]
fn forms_count_in_their_box_alone() {
    let large = |case: Case| Case { weights: ["1.2", "1.9"], ..case };
    let inside = large(case());
    let of_forms = expected(&inside).largest;
    inside.entry("/largest/e", text(of_forms[0] * (1.0 + 1e-7))).accepted();
    let outside = inside.trial("/box/e", "0.3");
    outside.entry("/largest/e", text(of_forms[0] * (1.0 + 1e-7))).refused(Invalid, E);
    let [x, e, z] = expected(&inside).distances;
    least(&outside, peaks(&inside, 1.2 * P_UP * x * x + e * e + 1.9 * z * z, [1.0, 1.9]));
    let finding = outside.entry("/largest/e", "0.1").judged().unwrap_err();
    assert!(finding.message.contains("of the forms nothing is known: not satisfied: T, sqrt(V_0/"), "{finding:?}");
    // Nor is it known which solution it is, where the error box is too small as well.
    let unknown = Case { error_box: ["1", "0.5"].map(str::to_owned), ..outside };
    unknown.refused(Invalid, "/box/e");
    unknown.steady_alone().refused(Invalid, "");
    let finding = unknown.judged().unwrap_err();
    assert!(finding.message.contains("s_e < D_e of the box"), "{finding:?}");
    assert!(finding.message.contains("; and not satisfied: T, E_N + e_per <= D_e of the claim"), "{finding:?}");
}

/// Of several forms one is enough to keep solutions in the box, whichever it is.
#[test]
fn one_of_the_forms_keeps_the_box() {
    let fine = Case { error_box: ["1", "0.5"].map(str::to_owned), ..Case::new(1, FORMULAS) };
    let coarse = fine.trial("/forms/0/P_up", "2");
    let reach = |case: &Case| {
        let Expected { v_0, s_e, .. } = expected(case);
        (v_0 / 0.9975).sqrt() + s_e
    };
    let [near, far] = [reach(&fine), reach(&coarse)];
    assert!(near < far * 0.99, "{near} {far}");
    let forms = [&coarse, &fine].map(|case| case.trial["forms"][0].clone());
    let with = |box_e: f64, which: &[usize]| {
        let list: Vec<_> = which.iter().map(|i| forms[*i].clone()).collect();
        fine.trial("/forms", list).trial("/box/e", text(box_e))
    };
    for which in [&[0, 1][..], &[1, 0], &[1]] {
        with(near * (1.0 + 1e-7), which).accepted();
        with(near * (1.0 - 1e-7), which).refused(Invalid, "/box/e");
    }
    with(near * (1.0 + 1e-7), &[0]).refused(Invalid, "/box/e");
    with(far * (1.0 + 1e-7), &[0]).accepted();
}
