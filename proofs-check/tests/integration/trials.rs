//! Numbers by n_o by a trial (docs/mathematics.md, sections 14.4 and 14.5): what is accepted and refused of a loop whose periodic solution is known.

use crate::trials_support::{
    Case, Expected, FORMULAS, Formulas, Wave, asks_for_a_domain, asks_for_a_tube_inside, asks_for_every_number,
    expected, largest, text,
};
use proofs_check::verdict::Verdict;
use serde_json::{Value, json};

use Verdict::{BadInput, Invalid, Undecided};

fn case() -> Case {
    Case::new(1, FORMULAS)
}

/// With defects of a size that counts.
fn coarse() -> Case {
    case().trial("/defect_x", "1e-3").trial("/defect_q", "2e-3")
}

#[test]
fn the_solution_itself_is_a_trial() {
    for n_o in 0..3 {
        Case::new(n_o, FORMULAS).accepted();
        Case::new(n_o, FORMULAS).steady_alone().accepted();
    }
    // What is of another number of oscillators answers another q.
    case().entry("/n_o", 2).refused(Invalid, "/e");
    case().entry("/n_o", 0).refused(Invalid, "/defect_q");
    // No other gain and no other error.
    Case { sigma: "4.001", ..case() }.refused(Invalid, "/defect_q");
    for (at, value) in [("/x/mean/0", "0.101"), ("/x/harmonics/0/cos/0", "0.401")] {
        case().trial(at, value).refused(Invalid, "/defect_x");
    }
    for (at, value) in [("/u/mean", "-0.301"), ("/u/harmonics/0/sin", "0.101"), ("/u/harmonics/2/cos", "0")] {
        case().trial(at, value).refused(Invalid, "/defect_q");
    }
    case().trial("/e/harmonics/1/sin", "0.001").refused(Invalid, "/defect_x");
}

/// A trial that is off by a known size has it for its defect, in the norm of the coordinates.
#[test]
fn defects_are_bounded() {
    let of_q = case().trial("/u/mean", "-0.301");
    of_q.trial("/defect_q", "0.00100000001").accepted();
    of_q.trial("/defect_q", "0.00099999999").refused(Invalid, "/defect_q");
    // kappa is a part of it: the harmonic k of uhat that the regulator does not put out.
    let beyond = Value::from("0.001");
    let mut of_k = case();
    of_k.trial["u"]["harmonics"].as_array_mut().unwrap().push(json!({ "cos": "0", "sin": beyond }));
    of_k.trial("/defect_q", "0.00200000001").accepted();
    of_k.trial("/defect_q", "0.00199999999").refused(Invalid, "/defect_q");
    let f = case().parts.0["plant"]["f"][0].as_str().unwrap().to_owned() + " + 1/1000";
    let of_f = case().part("/plant/f", json!([f]));
    of_f.trial("/defect_x", "0.00050000001").accepted();
    of_f.trial("/defect_x", "0.00049999999").refused(Invalid, "/defect_x");
}

/// Of so fast a wave the Taylor polynomials on the first parts of the period are more than twice as large at their ends as the wave: what they leave
/// out counts.
#[test]
fn what_a_polynomial_in_time_leaves_out_counts() {
    let formulas = Formulas { q: "e/10", values: |_, e| [0.0, e / 10.0], ..FORMULAS };
    let still = || Wave(0.0, Vec::new());
    let case = Case::of(64, formulas, [still(), still()]).stateless();
    case.accepted();
    let mut harmonics = vec![[0.0; 2]; 64];
    harmonics[63] = [1e-3, 0.0];
    let fast = case.trial("/u", Wave(0.0, harmonics).json(true, false)).steady_alone();
    fast.trial("/defect_q", "0.0010001").accepted();
    fast.trial("/defect_q", "0.0009999").refused(Invalid, "/defect_q");
}

#[test]
fn every_number_of_the_claim_is_bounded() {
    for case in [case(), coarse(), Case::new(2, FORMULAS), Case::new(0, FORMULAS)] {
        asks_for_every_number(&case);
    }
}

/// What is put out is u over the nominal gain.
#[test]
fn the_control_is_what_is_put_out() {
    let gain = |low: &str| case().part("/plant/input_gain", json!({ "nominal": "4", "low": low, "high": "4" }));
    let [u, largest] = [expected(&case()).steady[2], expected(&case()).largest[1]].map(|u| u / 4.0);
    for (at, number) in [("/steady/u", u), ("/largest/u", largest)] {
        gain("4").entry(at, text(number * (1.0 + 1e-7))).accepted();
        gain("4").entry(at, text(number * (1.0 - 1e-7))).refused(Invalid, &format!(":/claim/by_n_o/0{at}"));
    }
}

/// A tube that touches the box is no tube.
#[test]
fn the_solution_lies_inside_of_the_box() {
    asks_for_a_tube_inside(&coarse().steady_alone());
    // No solution from the set leaves it, where nothing else says which solution it is.
    let coarse = Case { error_box: ["0.1", "0.1"].map(str::to_owned), ..coarse() };
    let Expected { s_x, s_e, v_0, .. } = expected(&coarse);
    let reach = (v_0 / 0.9975).sqrt();
    for (at, size) in [("/box/x", reach + s_x), ("/box/e", reach + s_e)] {
        coarse.trial(at, text(size * (1.0 + 1e-7))).accepted();
        coarse.trial(at, text(size * (1.0 - 1e-7))).refused(Invalid, at);
    }
}

/// Of these numbers all roots are exact: with `u = 2^-10` G is `25 u^2`, s_e is `10 u`, and s_x is `49 u/16`. A box of that size is touched.
#[test]
fn a_tube_that_touches_the_box_is_refused() {
    let numbers = [
        ("/defect_x", 1.5 / 1024.0),
        ("/defect_q", 1.0 / 1024.0),
        ("/forms/0/p/0", 0.0),
        ("/forms/0/k_p", 0.5),
        ("/forms/0/c_x", 1.0),
        ("/forms/0/c_e", 4.0),
        ("/forms/0/c_y", 1.0 / 64.0),
        ("/states/gamma", 4.5625 / 64.0),
    ];
    let exact = numbers.iter().fold(case().steady_alone(), |case, (at, value)| case.trial(at, value.to_string()));
    let Expected { s_x, s_e, .. } = expected(&exact);
    assert_eq!([s_x, s_e], [49.0 / 16.0 / 1024.0, 10.0 / 1024.0]);
    for (at, size) in [("/box/x", s_x), ("/box/e", s_e)] {
        exact.trial(at, size.to_string()).refused(Invalid, at);
        exact.trial(at, (size * (1.0 + 1e-15)).to_string()).accepted();
    }
}

/// Of the error box of the claim, in which there is one periodic solution.
#[test]
fn it_is_the_solution_of_the_claim() {
    let case = coarse();
    let small = case.steady_alone().trial("/box/x", "0.1").trial("/box/e", "0.1");
    let [x_n, e_n] = expected(&case).sizes;
    for (which, size) in [(0, x_n), (1, e_n)] {
        let with = |factor: f64| {
            let mut radii = [1.0; 2];
            radii[which] = (size + 0.1) * factor;
            radii.map(|radius| format!("{radius:e}"))
        };
        let [more, less] = [with(1.0 + 1e-7), with(1.0 - 1e-7)];
        let judged = |[x, e]: &[String; 2], case: &Case| Case { error_box: [x.clone(), e.clone()], ..case.clone() };
        judged(&more, &small).accepted();
        judged(&less, &small).refused(Invalid, "");
        // Where no solution from the set leaves the box it is known in any case.
        judged(&less, &case).accepted();
        judged(&less, &case.steady_alone()).accepted();
    }
}

#[test]
fn a_form_is_what_it_says() {
    for (at, value, place) in [
        ("/forms/0/e_low", "0.998", "/forms/0/e_low"),
        ("/forms/0/x_low", "0.998", "/forms/0/x_low"),
        ("/forms/0/P_up", "0.999", "/forms/0/P_up"),
        ("/states/Q_low", "1.001", "/states/Q_low"),
        ("/states/Q_up", "0.999", "/states/Q_up"),
        // These stand in F.
        ("/forms/0/c_y", "0.6", "/forms/0"),
        ("/forms/0/c_x", "3.99", "/forms/0"),
        ("/forms/0/c_e", "7.9", "/forms/0"),
        ("/forms/0/k_p", "0.2", "/forms/0"),
        // (14.4b) at x = 0, where the states decay least: `2 - c` and gamma with g = 1/4.
        ("/states/c", "1.97", "/states"),
        ("/states/gamma", "0.0312", "/states"),
    ] {
        case().trial(at, value).refused(Invalid, place);
    }
    for (at, value) in [("/states/c", "1.3"), ("/states/gamma", "0.0313"), ("/forms/0/c_y", "0.2")] {
        case().trial(at, value).accepted();
    }
    // A w that is negative, and a form that is not positive definite.
    case().trial("/forms/0/w", "-1").refused(Invalid, "/forms/0/x_low");
    case().trial("/forms/0/p/0", "1.1").refused(Invalid, "/forms/0/x_low");
    // Another sign of p is another form: the largest c_e by the eigenvalues of F on a grid, computed apart, are 5.58 and 4.37.
    let with_p = |p: &str| {
        let small = [("/forms/0/x_low", "0.4"), ("/forms/0/e_low", "0.4"), ("/forms/0/p/0", p)];
        small.iter().fold(case(), |case, (at, value)| case.trial(at, *value))
    };
    for (p, holds, fails) in [("0.3", "5.5", "5.65"), ("-0.3", "4.3", "4.45")] {
        with_p(p).trial("/forms/0/c_e", holds).accepted();
        with_p(p).trial("/forms/0/c_e", fails).refused(Invalid, "/forms/0");
    }
    // Of more forms each has to be right, and the peaks are the least of them.
    let mut two = case();
    let first = two.trial["forms"][0].clone();
    let mut second = first.clone();
    second["P"] = json!([["0.9"]]);
    second["P_up"] = "0.9".into();
    second["x_low"] = "0.8975".into();
    second["e_low"] = "0.997".into();
    two.trial["forms"] = json!([second, first]);
    two.accepted();
    two.trial("/forms/1/c_y", "0.6").refused(Invalid, "/forms/1");
    two.trial("/forms/1/e_low", "0.998").refused(Invalid, "/forms/1/e_low");
    let mut swapped = case();
    swapped.trial["forms"] = json!([first, second]);
    let [alone, both] = [expected(&case()).largest[0], expected(&two).largest[0]];
    assert!(both < alone * (1.0 - 1e-4), "{both} {alone}");
    for (case, bound) in [(case(), alone), (swapped, both)] {
        case.entry("/largest/e", text(bound * (1.0 + 1e-7))).accepted();
        case.entry("/largest/e", text(bound * (1.0 - 1e-7))).refused(Invalid, ":/claim/by_n_o/0/largest/e");
    }
}

/// A derivative that is wrong somewhere in the box alone: at its ends and along the trial, where `x <= 0.6`, it is as it should be to twenty digits.
#[test]
fn a_form_holds_on_all_of_the_box() {
    let bump = Formulas {
        f: "-2*x - x^3/60",
        q: "x/2 + tanh(60*(x - 2))/6",
        values: |x, _| [-2.0 * x - x.powi(3) / 60.0, x / 2.0 + (60.0 * (x - 2.0)).tanh() / 6.0],
    };
    let flat = Formulas { q: "x/2 - 1/6", ..bump };
    let with = |formulas: Formulas| Case::new(1, formulas).trial("/q_x", "30");
    with(flat).accepted();
    with(bump).refused(Invalid, "/forms/0");
    // On a box that does not reach the bump it is true.
    with(bump).steady_alone().trial("/box/x", "0.5").accepted();
}

/// The box of the states themselves has every e of the box, those of ehat besides: here the slope of q is wrong where e is near -2.39 alone, which
/// takes many boxes to find, so that the states are asked before.
#[test]
fn a_form_holds_for_every_error_of_the_box() {
    let with = |q: &'static str, values: fn(f64, f64) -> [f64; 2]| {
        let formulas = Formulas { f: "-2*x - x^3/60 + e/2", q, values };
        // The largest c_y, at x = 0 and where d = 0, is 0.55460746568.
        Case::new(1, formulas).trial("/q_e", "30").trial("/q_x", "3").trial("/forms/0/c_y", "0.5546073657")
    };
    with("x/2 + 1/100", |x, e| [-2.0 * x - x.powi(3) / 60.0 + e / 2.0, x / 2.0 + 0.01]).accepted();
    let bump = "x/2 + tanh(2000*(e + 2.39))/100";
    let values =
        |x: f64, e: f64| [-2.0 * x - x.powi(3) / 60.0 + e / 2.0, x / 2.0 + (2000.0 * (e + 2.39)).tanh() / 100.0];
    with(bump, values).refused(Invalid, "/forms/0");
}

#[test]
fn bounds_of_the_slopes_of_q_hold_on_the_box() {
    let Case { x, e, .. } = case();
    // In the coordinates `r = 1 + e/5`, with e up to that of the trial and 2.
    let most = |t: f64| 1.0 + (e.at(t, 0) + 2.0) / 5.0;
    let r = largest(most);
    case().trial("/q_x", text(r * 1.001)).accepted();
    case().trial("/q_x", text(r * 0.999)).refused(Invalid, "/q_x");
    // `d = -3 e^2/50 + x/10`, with x from that of the trial less 4 on.
    let most = |t: f64| 0.06 * (e.at(t, 0).abs() + 2.0).powi(2) + (4.0 - x.at(t, 0)) / 10.0;
    let d = largest(most);
    case().trial("/q_e", text(d * 1.001)).accepted();
    case().trial("/q_e", text(d * 0.999)).refused(Invalid, "/q_e");
}

#[test]
fn the_box_lies_in_the_domain() {
    // |x - x_0| <= 2 (0.3/2 + 0.01 + 2), |e| <= sup|ehat| + 2.
    let [x, e] = [4.32, expected(&case()).steady[0] + 2.0];
    asks_for_a_domain(case, [x, e], [1e-6, 1e-6], "/box");
}

/// 1/(e + 3) is smooth as long as the box does not reach e = -3.
#[test]
fn the_formulas_are_smooth_on_the_box() {
    let with = |e: &str| {
        let formulas = Formulas {
            f: "-2*x + 1/(1000*(e + 3))",
            q: "x/2",
            values: |x, e| [-2.0 * x + 1.0 / (1000.0 * (e + 3.0)), x / 2.0],
        };
        Case::new(1, formulas).trial("/box/e", e).trial("/defect_x", "1e-4").steady_alone()
    };
    with("2").accepted();
    with("2.7").refused(Undecided, "/box");
}

#[test]
fn the_error_of_a_trial_has_no_harmonic_of_an_oscillator() {
    let first = |part: &str| case().trial(&format!("/e/harmonics/0/{part}"), "1e-30");
    first("cos").refused(Invalid, "/e");
    first("sin").refused(Invalid, "/e");
    let mut mean = case();
    mean.trial["e"]["mean"] = "0".into();
    mean.refused(BadInput, "/e/mean");
}

#[test]
fn the_form_of_a_trial() {
    let changed = |change: &dyn Fn(&mut Value)| {
        let mut case = case();
        change(&mut case.trial);
        case
    };
    for name in ["x", "e", "u", "defect_x", "defect_q", "box", "q_x", "q_e", "forms", "states"] {
        changed(&|trial| drop(trial.as_object_mut().unwrap().remove(name))).refused(BadInput, "");
    }
    for (object, place) in [("/box", "/box"), ("/forms/0", "/forms/0"), ("/states", "/states")] {
        let names: Vec<String> = case().trial.pointer(object).unwrap().as_object().unwrap().keys().cloned().collect();
        for name in names {
            let without = |trial: &mut Value| {
                trial.pointer_mut(object).unwrap().as_object_mut().unwrap().remove(&name);
            };
            changed(&without).refused(BadInput, place);
        }
    }
    let pair = || json!({ "cos": "0", "sin": "0" });
    let many = |count: usize| (0..count).map(|_| pair()).collect::<Vec<_>>();
    for (at, value, place) in [
        ("/x/mean", json!(["0.1", "0"]), "/x/mean"),
        ("/x/mean", json!([]), "/x/mean"),
        ("/x/harmonics/1/cos", json!(["0", "0"]), "/x/harmonics/1/cos"),
        ("/x/harmonics/1/sin", json!([]), "/x/harmonics/1/sin"),
        ("/u/harmonics", json!(many(65)), "/u/harmonics"),
        ("/e/harmonics", json!(many(65)), "/e/harmonics"),
        ("/forms", json!([]), "/forms"),
        ("/forms", json!(vec![case().trial["forms"][0].clone(); 4]), "/forms"),
        ("/forms/0/P", json!([["1", "0"], ["0", "1"]]), "/forms/0/p"),
        ("/forms/0/P", json!([["1", "0"]]), "/forms/0/P"),
        ("/forms/0/p", json!(["0.05", "0"]), "/forms/0/p"),
        ("/forms/0/p", json!([]), "/forms/0/p"),
        ("/states/Q", json!([["1", "0"], ["0", "1"]]), "/states/Q"),
        ("/states/Q", json!([]), "/states/Q"),
        ("/box/x", json!("0"), "/box/x"),
        ("/box/e", json!("0"), "/box/e"),
        ("/defect_x", json!("-1e-9"), "/defect_x"),
        ("/defect_q", json!("-1e-9"), "/defect_q"),
        ("/q_x", json!("-2"), "/q_x"),
        ("/q_e", json!("-2"), "/q_e"),
        ("/forms/0/k_p", json!("0"), "/forms/0/k_p"),
        ("/forms/0/c_x", json!("0"), "/forms/0/c_x"),
        ("/forms/0/c_e", json!("0"), "/forms/0/c_e"),
        ("/forms/0/c_y", json!("0"), "/forms/0/c_y"),
        ("/forms/0/e_low", json!("0"), "/forms/0/e_low"),
        ("/forms/0/x_low", json!("0"), "/forms/0/x_low"),
        ("/states/Q_low", json!("0"), "/states/Q_low"),
        ("/states/c", json!("0"), "/states/c"),
        ("/states/gamma", json!("0"), "/states/gamma"),
    ] {
        case().trial(at, value).refused(BadInput, place);
    }
    changed(&|trial| trial["more"] = "1".into()).refused(BadInput, "/more");
    changed(&|trial| trial["u"]["harmonics"] = json!([many(3), many(61)].concat())).refused(Invalid, "/defect_q");
}

/// Without states: `4 sigma w k_p` against `(w + k_p d/2)^2`, and of the peaks nothing of x.
#[test]
fn a_plant_without_states() {
    let formulas = Formulas { q: "e/10 - e^3/50", values: |_, e| [0.0, e / 10.0 - e.powi(3) / 50.0], ..FORMULAS };
    for n_o in 0..3 {
        Case::without_states(n_o, formulas).accepted();
        Case::without_states(n_o, formulas).steady_alone().accepted();
    }
    let case = Case::without_states(1, formulas);
    // Numbers of x that say nothing.
    case.trial("/forms/0/P_up", "1e9").trial("/forms/0/x_low", "1e-9").trial("/forms/0/c_x", "7").accepted();
    let mut of_x = case.clone();
    of_x.trial["box"]["x"] = "1".into();
    of_x.refused(BadInput, "/box/x");
    for (at, value, place) in [
        ("/forms/0/e_low", "1.001", "/forms/0/e_low"),
        ("/forms/0/c_y", "0.7", "/forms/0"),
        ("/u/mean", "-0.301", "/defect_q"),
        ("/q_e", "0.2", "/q_e"),
    ] {
        case.trial(at, value).refused(Invalid, place);
    }
    let small = Case { error_box: ["0.1", "0.1"].map(str::to_owned), ..case.clone() };
    small.trial("/box/e", "0.5").refused(Invalid, "/box/e");
    // Of the claim's function and its error box x says nothing.
    let function = Case { error_box: ["1e-9", "1"].map(str::to_owned), weights: ["1e9", "0.4"], ..case.clone() };
    function.trial("/box/e", "0.5").accepted();
    let e = largest(|t| case.e.at(t, 0));
    case.entry("/steady/e", text(e * (1.0 + 1e-7))).accepted();
    case.entry("/steady/e", text(e * (1.0 - 1e-7))).refused(Invalid, ":/claim/by_n_o/0/steady/e");
}
