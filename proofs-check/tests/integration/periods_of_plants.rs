//! A plant whose period is an interval: its clock `v = T_nom/T` in the orbit, the forcing, the bounds and the inequalities. All numbers
//! that are enough, and those that are not, are known by hand.

use super::families::interval;
use super::plant_support::{Parts, read};
use proofs_check::verdict::Verdict::{BadInput, Invalid};
use serde_json::{Value, json};

/// v between 4/5 and 5/4, between 1 and 5/4, between 4/5 and 1.
pub const BOTH: [&str; 3] = ["1", "0.8", "1.25"];
const FAST: [&str; 3] = ["1", "0.8", "1"];
const SLOW: [&str; 3] = ["1", "1", "1.25"];

/// With this period, not matched, and these sensitivities of the clock.
fn with_period(parts: Parts, period: [&str; 3], [orbit, forcing]: [Value; 2]) -> Parts {
    parts
        .with("/plant/period", interval(period))
        .with("/plant/internal_model/matched", json!(false))
        .with("/witness/orbit/sensitivities", json!([orbit]))
        .with("/witness/forcing/sensitivities", json!([forcing]))
}

fn idle() -> [Value; 2] {
    [json!({ "mean": ["0"] }), json!({ "mean": "0" })]
}

/// `x' = f`, which rests at 0 for e = 0, within 0.05 of it, and q.
pub fn at_rest(f: &str, q: &str, period: [&str; 3]) -> Parts {
    let parts = Parts::scalar(f, q).orbit(0.0, 0.0, "0", "0.05").forcing(0.0, 0.0, 0.0, "10", "100");
    with_period(parts, period, idle()).with("/witness/lyapunov/alpha", json!("0.5"))
}

/// `x' = -x + e + cos(phase)`, `q = sin(phase) + x`. The orbit is the real part of `e^(i phase)/(1 + i v om)`, and
/// with its derivative in v at 1 the defect is `(v - 1)^2 om^2/(1 + om^2)`.
fn turning(period: [&str; 3]) -> Parts {
    let om = 2.0 * std::f64::consts::PI;
    let square = 1.0 + om * om;
    let (cos, sin) = (1.0 / square, om / square);
    let (of_cos, of_sin) = (-2.0 * om * om / (square * square), om * (1.0 - om * om) / (square * square));
    let [of_cos, of_sin] = [of_cos, of_sin].map(|value| format!("{value:.17}"));
    let sensitivities = [
        json!({ "mean": ["0"], "harmonics": [{ "cos": [of_cos], "sin": [of_sin] }] }),
        json!({ "mean": "0", "harmonics": [{ "cos": of_cos, "sin": of_sin }] }),
    ];
    let parts = Parts::scalar("-x + e + cos(phase)", "sin(phase) + x")
        .orbit(cos, sin, "4e-4", "4.4e-4")
        .forcing(0.0, cos, 1.0 + sin, "4.5e-4", "9e-4")
        .with("/witness/lyapunov/alpha", json!("0.9999"));
    with_period(parts, period, sensitivities)
}

const NEAR: [&str; 3] = ["1", "1/1.02", "1/0.98"];

#[test]
fn the_defect_is_of_second_order_in_the_clock() {
    turning(NEAR).accepted();
    // 0.0004 * 0.97529.
    let with_defect = |value: &str| turning(NEAR).with("/witness/orbit/defect", json!(value));
    with_defect("3.902e-4").accepted();
    with_defect("3.90e-4").refused(Invalid, "orbit", "/witness/orbit/defect");
    // Either end: v = 1.03, v = 0.97.
    for wider in [["1", "1/1.03", "1/0.98"], ["1", "1/1.02", "1/0.97"]] {
        turning(wider).refused(Invalid, "orbit", "/witness/orbit/defect");
    }
    // The radius, and the radius with the defect.
    for (part, enough, less) in [("rest", "4.41e-4", "4.38e-4"), ("rest_t", "8.42e-4", "8.3e-4")] {
        let with = |value: &str| turning(NEAR).with(&format!("/witness/forcing/{part}"), json!(value));
        with(enough).accepted();
        with(less).refused(Invalid, "forcing", "/witness/forcing");
    }
}

#[test]
fn the_sensitivities_to_the_clock_count() {
    for (part, half) in [("orbit", "-0.0494"), ("forcing", "-0.0494")] {
        let list = format!("/witness/{part}/sensitivities");
        let given = turning(NEAR).0.pointer(&list).unwrap()[0].clone();
        let with = |value: Value| turning(NEAR).with(&list, value);
        for wrong in [Value::Null, json!([]), json!([given, given])] {
            with(wrong).refused(BadInput, "format", &list);
        }
        let mut forged = given;
        let sin = forged.pointer_mut("/harmonics/0/sin").unwrap();
        *sin = if part == "orbit" { json!([half]) } else { json!(half) };
        with(json!([forged])).refused(Invalid, part, &format!("/witness/{part}"));
        with(json!([idle()[usize::from(part == "forcing")]])).refused(Invalid, part, &format!("/witness/{part}"));
    }
    // One period has no clock.
    turning(["1", "1", "1"]).refused(BadInput, "format", "/witness/orbit/sensitivities");
    let exact = turning(NEAR).with("/plant/period", json!("1"));
    exact.refused(BadInput, "format", "/witness/orbit/sensitivities");
}

/// The clock stands after the parameters.
#[test]
fn parameters_and_the_clock_in_order() {
    let om = 2.0 * std::f64::consts::PI;
    // x = (cos, om sin)/(1 + om^2) at a = 1, and its derivative in a.
    let square = (1.0 + om * om) * (1.0 + om * om);
    let (of_cos, of_sin) = ((om * om - 1.0) / square, -2.0 * om / square);
    let [of_cos, of_sin] = [of_cos, of_sin].map(|value| format!("{value:.17}"));
    let of_a = [
        json!({ "mean": ["0"], "harmonics": [{ "cos": [of_cos], "sin": [of_sin] }] }),
        json!({ "mean": "0", "harmonics": [{ "cos": of_cos, "sin": of_sin }] }),
    ];
    let clocks = ["orbit", "forcing"].map(|part| turning(NEAR).0["witness"][part]["sensitivities"][0].clone());
    let with = |swapped: [bool; 2]| {
        let mut parts = turning(NEAR)
            .with("/plant/f/0", json!("-a*x + e + cos(phase)"))
            .with("/plant/parameters", json!({ "a": interval(["1", "0.98", "1.02"]) }))
            .with("/witness/orbit/defect", json!("6e-4"))
            .with("/witness/orbit/radius", json!("6.6e-4"))
            .with("/witness/lyapunov/alpha", json!("0.97"))
            .with("/witness/forcing/rest", json!("7e-4"))
            .with("/witness/forcing/rest_t", json!("1.4e-3"));
        for (i, part) in ["orbit", "forcing"].into_iter().enumerate() {
            let both = if swapped[i] { [&clocks[i], &of_a[i]] } else { [&of_a[i], &clocks[i]] };
            parts = parts.with(&format!("/witness/{part}/sensitivities"), json!(both));
        }
        parts
    };
    with([false, false]).accepted();
    with([true, false]).refused(Invalid, "orbit", "/witness/orbit/defect");
    with([false, true]).refused(Invalid, "forcing", "/witness/forcing");
    // The middle of the parameter is not that of the clock.
    let moved = with([false, false]).with("/plant/parameters/a", interval(["1", "1", "1.02"]));
    moved.accepted();
    moved.with("/plant/parameters/a/nominal", json!("1.02")).refused(Invalid, "orbit", "/witness/orbit/defect");
}

/// The derivative in t of what is a function of the phase is v times that at the nominal period.
#[test]
fn derivatives_in_time_take_the_clock() {
    let fastest = |period: [&str; 3]| if period[1] == "0.8" { 1.25 } else { 1.0 };
    let om = 2.0 * std::f64::consts::PI;
    for period in [BOTH, FAST, SLOW] {
        let v = fastest(period);
        let near = |value: f64| [1.001, 0.97].map(|factor| format!("{:.9}", factor * value));
        // x sin(phase): its derivative at a fixed x has the slope v om cos(phase). Likewise e sin(phase).
        for (bound, q) in [("q_tx", "x*sin(phase)"), ("q_te", "e*sin(phase)")] {
            let [enough, less] = near(v * om);
            let with = |value: &str| at_rest("-x + e", q, period).bounds(&[(bound, "0", "3", value)]);
            with(&enough).accepted();
            with(&less).refused(Invalid, "bounds of the plant", "/witness/bounds/0");
        }
        // The rest of the forcing: without states, and `r sup|v om cos - (1 + sin)|`.
        let [enough, less] = near(0.01 * 2.0 * om * v);
        let alone = |value: &str| {
            let parts = Parts::scalar("-x + e", "sin(phase) + sin(2*phase)/100")
                .orbit(0.0, 0.0, "0", "0")
                .forcing(0.0, 0.0, 1.0, "0.0101", value);
            with_period(parts, period, idle())
        };
        alone(&enough).accepted();
        alone(&less).refused(Invalid, "forcing", "/witness/forcing");
        let [enough, less] = near(0.05 * ((v * om).hypot(1.0) + 1.0));
        let beside =
            |value: &str| at_rest("-x + e", "x*(1 + sin(phase))", period).with("/witness/forcing/rest_t", json!(value));
        beside(&enough).accepted();
        beside(&less).refused(Invalid, "forcing", "/witness/forcing");
    }
}

/// `P = 1 + cos(phase)/10` with `x' = (-1 + sin(phase)/2 ...) x`: what P' adds is largest at one end of v or at the other.
#[test]
fn rates_take_both_ends_of_the_clock() {
    let om = 2.0 * std::f64::consts::PI;
    // The least over the phase of `1 - k sin + v (om/20) sin/(1 + cos/10)`.
    let rate = |k: f64, v: f64| {
        let at = |phase: f64| 1.0 - k * phase.sin() + v * om / 20.0 * phase.sin() / (1.0 + phase.cos() / 10.0);
        (0..100_000).map(|i| at(f64::from(i) * om / 100_000.0)).fold(f64::INFINITY, f64::min)
    };
    let with =
        |k: &str, period, alpha: f64, value: f64| {
            let p = json!({
                "P": [["1"]], "harmonics": [{ "cos": [["0.1"]], "sin": [["0"]] }], "p_low": "0.89", "p_up": "1.11",
                "alpha": format!("{alpha:.9}"),
            });
            at_rest(&format!("-x + {k}*sin(phase)*x + e/1000"), "x/1000", period)
                .with("/witness/lyapunov", p)
                .bounds(&[("rate", "0", "0", &format!("{value:.9}"))])
        };
    for (k, exact, period, v) in
        [("0", 0.0, BOTH, 1.25), ("0", 0.0, SLOW, 1.0), ("1/2", 0.5, BOTH, 0.8), ("1/2", 0.5, FAST, 1.0)]
    {
        let most = rate(exact, v);
        // That of the other ends is larger.
        assert!([0.8, 1.0, 1.25].iter().all(|other| period != BOTH || rate(exact, *other) >= most), "{k}");
        with(k, period, most - 1e-3, most - 1e-3).accepted();
        with(k, period, most + 1e-3, 0.1).refused(Invalid, "orbit", "/witness/lyapunov/alpha");
        with(k, period, 0.5, most + 1e-3).refused(Invalid, "bounds of the plant", "/witness/bounds/0");
        // (M) with w_x = 1 and hardly a coupling: the rate of the inequality is that rate.
        let matrix =
            |value: f64| with(k, period, 0.5, 0.1).inequality(["1", "0.01"], ["1", "1"], &format!("{value:.9}"), 100.0);
        matrix(most - 1e-3).accepted();
        matrix(most + 1e-3).refused(Invalid, "matrix inequality", "/witness/matrix_inequality");
    }
}

/// Where x is for every v counts in what is bounded around it.
#[test]
fn the_orbits_of_all_periods_are_looked_at() {
    // The mean of xb moves with the clock, and the defect is that.
    let with = |value: &str| {
        at_rest("-x + e", "x^2/2", BOTH)
            .with("/witness/orbit/sensitivities", json!([{ "mean": ["1"] }]))
            .with("/witness/orbit/defect", json!("0.2501"))
            .with("/witness/orbit/radius", json!("0.55"))
            .with("/witness/orbit/tube", json!("0.6"))
            .bounds(&[("q_x", "1", "0", value)])
    };
    // 1/4 at v = 5/4, the radius and X.
    with("1.801").accepted();
    with("1.799").refused(Invalid, "bounds of the plant", "/witness/bounds/0");
}

/// The magnitudes of the harmonics are convex in v: largest at one of its ends.
#[test]
fn the_harmonics_are_those_of_the_worst_end() {
    let with = |period: [&str; 3], cos: &str| {
        let parts = turning(period).with("/witness/forcing/harmonics", json!([{ "cos": "3", "sin": "4" }])).with(
            "/witness/forcing/sensitivities",
            json!([{ "mean": "0", "harmonics": [{ "cos": cos, "sin": "0" }] }]),
        );
        let (spec, _) = read(&parts.0).unwrap();
        spec.q_0.unwrap().harmonics[1].enclose(128).hi().to_f64()
    };
    // v - 1 up to 1/4, and down to -1/5.
    for (period, cos, expected) in
        [(BOTH, "4", 4.0), (SLOW, "4", 3.0), (FAST, "4", 4.0), (BOTH, "-5", 4.0), (FAST, "-5", 3.0)]
    {
        let expected = f64::hypot(expected, 4.0) / 2.0;
        assert!((with(period, cos) - expected).abs() < 1e-12, "{period:?} {cos}: {}", with(period, cos));
    }
}

/// Four intervals and the clock beside them; it is a side that is cut.
#[test]
fn four_parameters_and_the_clock() {
    let parameters: serde_json::Map<String, Value> =
        (1..5).map(|i| (format!("p{i}"), interval(["0", "-0.01", "0.01"]))).collect();
    let five = |value: Value| json!([value, value, value, value, value]);
    let with = |value: &str| {
        at_rest("-x + e", "e*sin(phase) + p1*x + p2*x + p3*x + p4*x", BOTH)
            .with("/plant/parameters", Value::Object(parameters.clone()))
            .with("/witness/orbit/sensitivities", five(json!({ "mean": ["0"] })))
            .with("/witness/forcing/sensitivities", five(json!({ "mean": "0" })))
            .bounds(&[("q_te", "0", "3", value)])
    };
    with("7.86").accepted();
    with("7.85").refused(Invalid, "bounds of the plant", "/witness/bounds/0");
}

#[test]
fn time_is_written_by_the_phase() {
    let near = |f: &str, q: &str| turning(NEAR).with("/plant/f/0", json!(f)).with("/plant/q", json!(q));
    for (f, q, place) in [
        ("-x + e + cos(2*pi*t)", "sin(phase) + x", "/plant/f/0"),
        ("-x + e + cos(phase)", "sin(2*pi*t) + x", "/plant/q"),
        ("-x + e + cos(phase) + 0*t", "sin(phase) + x", "/plant/f/0"),
    ] {
        near(f, q).refused(BadInput, "format", place);
        let message = match super::plant_support::judged(&near(f, q).0) {
            Err(finding) => finding.message,
            Ok(_) => panic!("accepted"),
        };
        assert!(message.contains("write `phase`"), "{message}");
    }
    // What is wrong besides is told as it is.
    let message = match super::plant_support::judged(&near("-x + cos(phase", "x").0) {
        Err(finding) => finding.message,
        Ok(_) => panic!("accepted"),
    };
    assert!(message.contains("parenthesis") && !message.contains("phase"), "{message}");
    for q in ["phase", "sin(phase/2)", "x*cos(3*phase/2)", "phase^2"] {
        near("-x + e + cos(phase)", q).refused(Invalid, "periodicity", "/plant/q");
    }
    near("-x + e + cos(phase)", "sin(phase + 7) + sin(phase*3 - phase) + x").refused(Invalid, "forcing", "");
    // With one period it is allowed beside t, and the same.
    let exact = |q: &str| {
        let mut parts = turning(NEAR).with("/plant/period", json!("1")).with("/plant/q", json!(q));
        for part in ["orbit", "forcing"] {
            drop(parts.0["witness"][part].as_object_mut().unwrap().remove("sensitivities"));
        }
        parts
    };
    for q in ["sin(phase) + x", "sin(2*pi*t) + x", "sin(3*phase/2 - pi*t) + x"] {
        exact(q).accepted();
    }
    exact("sin(phase + pi*t) + x").refused(Invalid, "periodicity", "/plant/q");
    // Neither a state nor a parameter has its name, nor is it a number.
    let named = turning(NEAR).with("/plant/states/0", json!("phase"));
    named.refused(BadInput, "format", "/plant/states/0");
    let parameter = turning(NEAR).with("/plant/parameters", json!({ "phase": "1" }));
    parameter.refused(BadInput, "format", "/plant/parameters/phase");
    for place in ["/plant/internal_model/mu", "/plant/period/low"] {
        turning(NEAR).with(place, json!("phase")).refused(BadInput, "format", place);
    }
    // Constants have names in it; what is an interval is no number of it.
    let constants = json!({ "h": "1/1.02", "k": interval(["1", "0.9", "1.1"]) });
    let named =
        |low: &str| turning(NEAR).with("/plant/parameters", constants.clone()).with("/plant/period/low", json!(low));
    named("k").refused(BadInput, "format", "/plant/period/low");
    let one = turning(NEAR).with("/plant/parameters", json!({ "h": "1/1.02" }));
    one.clone().with("/plant/period/low", json!("h")).accepted();
    one.with("/plant/period/low", json!("h/2")).refused(Invalid, "orbit", "/witness/orbit/defect");
}
