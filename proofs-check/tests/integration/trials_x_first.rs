//! The peaks of a trial along x first (docs/mathematics.md, section 14.5, (14.5a)).

use crate::trials_support::{Case, Expected, FORMULAS, Formulas, asks_for_a_domain, expected, largest, peaks, text};
use proofs_check::verdict::Verdict::{BadInput, Invalid, Undecided};
use serde_json::{Value, json};

/// q_e grows with |e|: `d = 3 e^2/50 + x/10`; `r = 1 + e/5`, and `J = -2 - x^2/20`, `g = 1/4`.
pub const GROWING: Formulas = Formulas {
    q: "x/2 + e^3/50 + x*e/10",
    values: |x, e| {
        let [f, _] = (FORMULAS.values)(x, e);
        [f, x / 2.0 + e.powi(3) / 50.0 + x * e / 10.0]
    },
    ..FORMULAS
};

/// `[s_x, s_y]`, the diagonal of S.
const S: [f64; 2] = [0.5, 0.5];
/// D_x', D_e' and eta.
const BOX: [f64; 3] = [1.5, 1.7, 1.0];

/// Of a trial whose own box, and the error box of the claim, are too small, with defects of a size that counts.
fn with(formulas: Formulas) -> Case {
    let case = Case::new(1, formulas).trial("/defect_x", "1e-3").trial("/defect_q", "2e-3");
    along(&Case { error_box: ["0.1", "0.1"].map(str::to_owned), ..case })
}

pub fn along(case: &Case) -> Case {
    let mut case = case.trial("/box/x", "0.3").trial("/box/e", "0.3");
    case.trial["x_first"] = json!({
        "box": { "x": BOX[0].to_string(), "e": BOX[1].to_string() }, "E": BOX[2].to_string(),
        "forms": [{
            "P": [["1"]], "p": ["0"], "w": "1", "k_p": "0.8", "c_x": "1.5", "c_e": "2", "c_y": "0.15",
            "P_up": "1.01", "x_low": "0.99", "e_low": "0.9",
            "S": [[S[0].to_string(), "0"], ["0", S[1].to_string()]],
        }],
    });
    case
}

fn case() -> Case {
    with(GROWING)
}

/// V_0 of its form.
pub fn level(case: &Case) -> f64 {
    let [x, e, z] = expected(case).distances;
    1.01 * x * x + e * e + 0.4 * z * z
}

#[test]
fn the_peaks_are_bounded() {
    let case = case();
    case.accepted();
    case.steady_alone().accepted();
    let bounds = peaks(&case, level(&case), [1.0, 0.4]);
    for (at, number) in [("/largest/e", bounds[0]), ("/largest/u", bounds[1])] {
        case.entry(at, text(number * (1.0 + 1e-7))).accepted();
        case.entry(at, text(number * (1.0 - 1e-7))).refused(Invalid, &format!(":/claim/by_n_o/0{at}"));
    }
    // Without it nothing is known.
    let mut without = case.clone();
    without.trial.as_object_mut().unwrap().remove("x_first");
    without.refused(Invalid, "/box/x");
    without.steady_alone().refused(Invalid, "");
    // Of so many oscillators or more with the sum of all weights.
    let case = along(&Case::or_more(GROWING).trial("/defect_q", "2e-3"));
    let bounds = peaks(&case, level(&case), [1.0, 0.4]);
    for (at, number) in [("/largest/e", bounds[0]), ("/largest/u", bounds[1])] {
        case.entry(at, text(number * (1.0 + 1e-7))).accepted();
        case.entry(at, text(number * (1.0 - 1e-7))).refused(Invalid, &format!(":/claim/by_n_o/0{at}"));
    }
    // With another form the least of both counts, and the first says where solutions stay.
    let second = |case: &Case| {
        let mut two = case.clone();
        let mut form = two.trial["x_first"]["forms"][0].clone();
        form["P_up"] = "1.5".into();
        two.trial["x_first"]["forms"].as_array_mut().unwrap().insert(0, form);
        two
    };
    let both = second(&case);
    both.entry("/largest/e", text(bounds[0] * (1.0 + 1e-7))).accepted();
    both.entry("/largest/e", text(bounds[0] * (1.0 - 1e-7))).refused(Invalid, ":/claim/by_n_o/0/largest/e");
    both.trial("/x_first/forms/1/S/1/1", "0.6").refused(Invalid, "/x_first/forms/1");
}

/// One of both inequalities is not proved; boxes along a border may hide a place where it is wrong.
#[track_caller]
fn unproved(case: &Case) {
    let finding = case.judged().expect_err(&case.trial["x_first"].to_string());
    assert!(matches!(finding.verdict, Invalid | Undecided), "{finding:?}");
    assert_eq!(finding.pointer, "/witness/by_n_o/trials/0/x_first/forms/0", "{finding:?}");
}

/// S is between what J and r leave, where e is within eta of ehat, and what g and d take, in all of the box.
#[test]
fn s_is_between() {
    let Case { x, e, .. } = case();
    let r = largest(|t| 1.0 + (e.at(t, 0) + BOX[2]) / 5.0);
    let most = 0.65 - (0.4 * r).powi(2) / (2.5 - S[0]);
    let d = largest(|t| 0.06 * (e.at(t, 0).abs() + BOX[1]).powi(2) + (x.at(t, 0) + 2.0 * BOX[0]) / 10.0);
    let least = (1.0 + 0.4 * d).powi(2) / (6.0 - 0.0625 / S[0]);
    assert!(least < S[1] && S[1] < most, "{least} {most}");
    let with = |s: f64| case().trial("/x_first/forms/0/S/1/1", text(s));
    with(most - 1e-6).accepted();
    unproved(&with(most + 1e-6));
    with(least + 1e-5).accepted();
    unproved(&with(least - 1e-5));
    unproved(&with(least - 1e-2));
    // J and r are not asked about in all of the box, and g and d are.
    let near = largest(|t| 0.06 * (e.at(t, 0).abs() + BOX[2]).powi(2) + (x.at(t, 0) + 2.0 * BOX[0]) / 10.0);
    assert!((1.0 + 0.4 * near).powi(2) / (6.0 - 0.0625 / S[0]) < least - 1e-3);
    with(0.53).trial("/x_first/E", "0.5").accepted();
    unproved(&with(0.53).trial("/x_first/E", BOX[1].to_string()));
    // Every number stands in them, and an S with signs of its own is as the columns have them: here `-w - k_p d/2` and `-k_p r/2` are below 0.
    for (at, value) in [("c_x", "2.1"), ("c_e", "5.5"), ("c_y", "0.25"), ("k_p", "0.5"), ("w", "4")] {
        unproved(&case().trial(&format!("/x_first/forms/0/{at}"), value));
    }
    let turned = |s: &str| case().trial("/x_first/forms/0/S/0/1", s).trial("/x_first/forms/0/S/1/0", s);
    turned("-0.1").accepted();
    unproved(&turned("0.1"));
}

/// A derivative that is wrong somewhere in the larger box alone.
#[test]
fn a_form_holds_on_all_of_the_box() {
    let bump = Formulas {
        f: "-2*x - x^3/60",
        q: "x/2 + tanh(60*(x - 2))/6",
        values: |x, _| [-2.0 * x - x.powi(3) / 60.0, x / 2.0 + (60.0 * (x - 2.0)).tanh() / 6.0],
    };
    let flat = Formulas { q: "x/2 - 1/6", ..bump };
    with(flat).accepted();
    with(bump).refused(Invalid, "/x_first/forms/0");
    // One of d, where e is beyond eta.
    let bump = Formulas {
        f: "-2*x - x^3/60",
        q: "x/2 + tanh(200*(e - 1.9))/20",
        values: |x, e| [-2.0 * x - x.powi(3) / 60.0, x / 2.0 + (200.0 * (e - 1.9)).tanh() / 20.0],
    };
    with(bump).refused(Invalid, "/x_first/forms/0");
    with(bump).trial("/x_first/box/e", "1.3").accepted();
}

#[test]
fn the_tube_lies_in_the_slice() {
    let s_e = expected(&case()).s_e;
    case().trial("/x_first/E", text(s_e * (1.0 + 1e-9))).accepted();
    case().trial("/x_first/E", text(s_e * (1.0 - 1e-9))).refused(Invalid, "/x_first/E");
    case().trial("/x_first/E", "1.70001").refused(Invalid, "/x_first/E");
}

#[test]
fn no_solution_leaves_the_box() {
    let case = case();
    let Expected { s_x, s_e, .. } = expected(&case);
    let v_0 = level(&case);
    // The weight of e is w.
    for (at, size) in [("/x_first/box/x", (v_0 / 0.99).sqrt() + s_x), ("/x_first/box/e", v_0.sqrt() + s_e)] {
        let case = case.trial("/x_first/E", "0.5");
        case.trial(at, text(size * (1.0 + 1e-7))).accepted();
        for case in [case.clone(), case.steady_alone(), Case { error_box: ["9", "9"].map(str::to_owned), ..case }] {
            case.trial(at, text(size * (1.0 - 1e-7))).refused(Invalid, at);
        }
    }
}

#[test]
fn a_form_is_what_it_says() {
    for (at, value) in [("P_up", "0.9999"), ("x_low", "1.0001"), ("e_low", "1.0001")] {
        let at = format!("/x_first/forms/0/{at}");
        case().trial(&at, value).refused(Invalid, &at);
    }
    case().trial("/x_first/forms/0/p/0", "1e-30").refused(BadInput, "/x_first/forms/0/p");
}

#[test]
fn the_larger_box_lies_in_the_domain() {
    let [x, e] = [2.0 * (0.16 + BOX[0]), expected(&case()).sizes[1] + BOX[1]];
    asks_for_a_domain(case, [x, e], [1e-6, 1e-2], "/x_first/box");
}

/// 1/(e + 2) is smooth as long as the box does not reach e = -2.
#[test]
fn the_formulas_are_smooth_on_the_larger_box() {
    let formulas = Formulas {
        f: "-2*x + 1/(1000*(e + 2))",
        q: "x/2",
        values: |x, e| [-2.0 * x + 1.0 / (1000.0 * (e + 2.0)), x / 2.0],
    };
    let with = |e: &str| with(formulas).trial("/x_first/box/e", e);
    with("1.2").accepted();
    with("1.75").refused(Undecided, "/x_first/box");
}

#[test]
fn the_form_of_it() {
    let changed = |change: &dyn Fn(&mut Value)| {
        let mut case = case();
        change(&mut case.trial["x_first"]);
        case
    };
    for (object, place) in [("", "/x_first"), ("/box", "/x_first/box"), ("/forms/0", "/x_first/forms/0")] {
        let whole = case().trial["x_first"].clone();
        for name in whole.pointer(object).unwrap().as_object().unwrap().keys() {
            let without = |part: &mut Value| {
                part.pointer_mut(object).unwrap().as_object_mut().unwrap().remove(name);
            };
            changed(&without).refused(BadInput, place);
        }
    }
    let form = case().trial["x_first"]["forms"][0].clone();
    for (at, value, place) in [
        ("/forms", json!([]), "/x_first/forms"),
        ("/forms", json!(vec![form; 4]), "/x_first/forms"),
        ("/forms/0/S", json!([["0.5"]]), "/x_first/forms/0/S"),
        ("/forms/0/S", json!([["0.5", "0"]]), "/x_first/forms/0/S"),
        ("/forms/0/S", json!([["0.5", "0"], ["0.1", "0.5"]]), "/x_first/forms/0/S"),
        ("/forms/0/S", json!([["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]]), "/x_first/forms/0/S"),
        ("/forms/0/P", json!([["1", "0"], ["0", "1"]]), "/x_first/forms/0/p"),
        ("/forms/0/p", json!([]), "/x_first/forms/0/p"),
        ("/box/x", json!("0"), "/x_first/box/x"),
        ("/box/e", json!("0"), "/x_first/box/e"),
        ("/E", json!("-0.1"), "/x_first/E"),
        ("/forms/0/c_x", json!("0"), "/x_first/forms/0/c_x"),
        ("/forms/0/c_e", json!("0"), "/x_first/forms/0/c_e"),
        ("/forms/0/c_y", json!("0"), "/x_first/forms/0/c_y"),
        ("/forms/0/k_p", json!("0"), "/x_first/forms/0/k_p"),
        ("/forms/0/e_low", json!("0"), "/x_first/forms/0/e_low"),
    ] {
        case().trial(&format!("/x_first{at}"), value).refused(BadInput, place);
    }
    changed(&|part| part["more"] = "1".into()).refused(BadInput, "/x_first/more");
}

/// Without states S is a number between `k_p - c_y` and `(w + k_p d/2)^2/(2 sigma w - c_e)`.
#[test]
fn a_plant_without_states() {
    let formulas = Formulas { q: "e/10 - e^3/50", values: |_, e| [0.0, e / 10.0 - e.powi(3) / 50.0], ..FORMULAS };
    let mut case = with(formulas).stateless();
    case.trial["x_first"]["box"].as_object_mut().unwrap().remove("x");
    let empty = [("P", json!([])), ("p", json!([])), ("S", json!([["0.5"]]))];
    let case = empty.into_iter().fold(case, |case, (at, value)| case.trial(&format!("/x_first/forms/0/{at}"), value));
    case.accepted();
    let with = |s: f64| case.trial("/x_first/forms/0/S/0/0", text(s));
    with(0.65).accepted();
    with(0.650001).refused(Invalid, "/x_first/forms/0");
    // d is largest at e = 0.
    let least = 1.04f64.powi(2) / 6.0;
    with(least + 1e-6).accepted();
    with(least - 1e-6).refused(Invalid, "/x_first/forms/0");
    let mut of_x = case.clone();
    of_x.trial["x_first"]["box"]["x"] = "1".into();
    of_x.refused(BadInput, "/x_first/box/x");
}
