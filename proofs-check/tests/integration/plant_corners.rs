//! Boxes reach out of the ball on which formulas are smooth. Corners, poles and ends of domains out there, of which nothing is
//! demanded, must not make a false bound inside pass.

use super::plant_support::Parts;
use crate::common::{drawn, every};
use proofs_check::verdict::Verdict;
use serde_json::{Value, json};

/// Two states with L = P = I, at rest in the origin: x = (a, b).
fn two_states(f: [&str; 2], q: &str, alpha: &str) -> Parts {
    let zero = json!({ "mean": ["0", "0"], "harmonics": [], "defect": "1e-30", "tube": "1e-9", "radius": "1e-20" });
    Parts::scalar("-x", q)
        .with("/plant/states", json!(["a", "b"]))
        .with("/plant/f", json!(f))
        .with("/witness/coordinates", json!([["1", "0"], ["0", "1"]]))
        .with("/witness/orbit", zero)
        .with("/witness/lyapunov", json!({ "P": [["1", "0"], ["0", "1"]], "p_low": "1", "p_up": "1", "alpha": alpha }))
        .forcing(0.0, 1.0, 0.0, "1e-9", "1e-6")
}

/// With `y = 0.6 a + 0.8 b`: `m(y)` has the slope 99999999 up to a corner outside of the ball, and a steep step just inside, where
/// the rate is -899; the boxes that the corner cuts have their middles beyond it, where the slope is that of the step alone.
fn audited(value: &str) -> Parts {
    let y = "(0.6*a + 0.8*b)";
    let m = format!("(99999999*(min({y} - 1.045, 0) + 1.045) + 0.6*(1 + tanh(1500*({y} - 0.9965))))");
    let f = [format!("-1e8*a + 0.6*{m}"), format!("-1e8*b + 0.8*{m}")];
    two_states([&f[0], &f[1]], "cos(2*pi*t)", "9/10").bounds(&[("rate", "1", "0", value)])
}

#[test]
fn a_corner_outside_of_the_ball_hides_no_unstable_place() {
    for value in ["0.1", "0", "-1", "-400", "-890"] {
        let (verdict, rule) = audited(value).verdict();
        assert!(verdict != Verdict::Valid && rule == "bounds of the plant", "{value}: {verdict} by {rule}");
    }
    audited("-1e9").accepted();
}

/// What is added to f or q, of y: flat inside of the ball but for a step of the slope near its edge, and not smooth beyond.
/// `corner` has slopes of its own on either side.
fn guises(step: &str) -> Vec<String> {
    let edge = "1.02";
    vec![
        format!("1000*(min(Y, {edge}) - Y) + {step}"),
        format!("1000*(max(Y, {edge}) - {edge}) + {step}"),
        format!("500*(abs(Y - {edge}) + Y - {edge}) + {step}"),
        format!("{step} + 1e-6*sqrt({edge} - Y)"),
        format!("{step} + 1e-6*log({edge} - Y)"),
        format!("{step} + 1e-9/({edge} - Y)"),
        format!("{step} + 1e-9*({edge} - Y)^2.5"),
        format!("{step} + 1e-9*tan(Y*pi/2/{edge})"),
        format!("min(Y, {edge})*0 + {step}"),
    ]
}

/// The formula of a guise, in the states; y = 0.6 a + 0.8 b.
fn of_states(guise: &str) -> String {
    guise.replace('Y', "(0.6*a + 0.8*b)")
}

/// For each kind of bound: the plant, and a value that the step near the edge exceeds.
fn kinds() -> Vec<(Parts, &'static str, &'static str, &'static str)> {
    let mut all = Vec::new();
    let slopes = guises("(1 + tanh(400*(Y - 0.99)))/100");
    for guise in &slopes {
        let m = of_states(guise);
        let q = format!("cos(2*pi*t) + {m} - ({})", of_states(&guise.replace('Y', "(0*Y)")));
        // The slope of the step is 4.
        all.push((two_states(["-a", "-b"], &q, "1"), "q_x", "0", "3.9"));
        let f = [format!("-a + {m} - ({})", of_states(&guise.replace('Y', "(0*Y)"))), "-b".to_owned()];
        let moved = || two_states([&f[0], &f[1]], "cos(2*pi*t)", "9/10");
        all.push((moved(), "f_x", "0", "3.5"));
        all.push((moved(), "rate", "0", "-0.5"));
        let twice = |parts: Parts| {
            let p = json!({ "P": [["1", "0"], ["0", "1"]], "p_low": "1", "p_up": "1", "alpha": "9/10" });
            parts.with("/witness/lyapunov_existence", p)
        };
        all.push((twice(moved()), "rate_existence", "0", "-0.5"));
        let with_e = format!("cos(2*pi*t) + e*({m})");
        let scale = "1e-2";
        // e times the guise: the derivative along e is the guise, which the step doubles.
        let flat = guise.contains("1000") || guise.contains("500") || guise.contains("0 +");
        if flat {
            all.push((two_states(["-a", "-b"], &with_e, "1"), "q_e", scale, "0.0199"));
            all.push((two_states(["-a", "-b"], &with_e, "1"), "q_e_max", scale, "0.0199"));
            let f = [format!("-a + e*({m})"), "-b".to_owned()];
            all.push((two_states([&f[0], &f[1]], "cos(2*pi*t)", "1"), "f_e", scale, "0.0199"));
            let in_time = format!("cos(2*pi*t) + cos(2*pi*t)*e*({m})");
            all.push((two_states(["-a", "-b"], &in_time, "1"), "q_te", scale, "0.12"));
            let in_time = format!("cos(2*pi*t) + cos(2*pi*t)*({m} - ({}))", of_states(&guise.replace('Y', "(0*Y)")));
            all.push((two_states(["-a", "-b"], &in_time, "1"), "q_tx", "0", "24"));
        }
    }
    all
}

#[test]
fn no_kind_of_bound_is_believed_beyond_a_corner_a_pole_or_the_end_of_a_domain() {
    // Of nine or four cases a guise every fourth: each guise and each kind of bound once.
    for (parts, bound, e, value) in kinds().into_iter().step_by(every(4)) {
        let q: &Value = &parts.0["plant"];
        let (verdict, rule) = parts.clone().bounds(&[(bound, "1", e, value)]).verdict();
        let text = format!("{bound} <= {value}: {} and {}", q["f"], q["q"]);
        assert!(verdict != Verdict::Valid, "{text}: accepted");
        assert_eq!(rule, "bounds of the plant", "{text}");
        // The same with room is true, and can be proved where the corner is outside: what cancels inside of the ball is wide.
        let enough = if bound.starts_with("rate") { "-5" } else { "3000" };
        let (verdict, rule) = parts.bounds(&[(bound, "1", e, enough)]).verdict();
        assert!(verdict == Verdict::Valid, "{text} with {enough}: {verdict} by {rule}");
    }
}

/// A relative of the audited plant: with `y = d . x` a slope K up to an edge outside of the ball, none beyond, and a step of a
/// slope that is a small part of K at the rim. `d` is near the diagonal: there the boxes that cover the rim have their middles
/// beyond the edge. The bound is exceeded at the step.
fn relative(case: u64) -> (Parts, &'static str, String) {
    let mut next = drawn(case);
    let directions = [["3/5", "4/5"], ["4/5", "3/5"], ["20/29", "21/29"], ["48/73", "55/73"], ["72/97", "65/97"]];
    let [along, across] = directions[(5.0 * next()) as usize];
    let y = format!("({along}*a + {across}*b)");
    let edge = format!("{:.4}", 1.002 + 0.05 * next());
    let (steep, at) = (10f64.powf(2.7 + 0.8 * next()).round(), format!("{:.5}", 0.996 + 0.002 * next()));
    let step = 10f64.powf(4.0 * next()).round();
    // What the step bends over a quarter of the ball is less than K.
    let slope = (step * steep * 10f64.powf(2.0 * next())).round();
    let cut = match (3.0 * next()) as u32 {
        0 => format!("{slope}*(min({y} - {edge}, 0) + {edge})"),
        1 => format!("{slope}*({edge} - max({edge} - {y}, 0))"),
        _ => format!("{slope}/2*({y} - abs({y} - {edge}) + {edge})"),
    };
    let m = format!("({cut} + {}*(tanh({steep}*({y} - {at})) - tanh(-{steep}*{at})))", step / steep);
    // Along d the slope of f is -1 and that of the step.
    let f = [format!("-{0}*a + {along}*{m}", slope + 1.0), format!("-{0}*b + {across}*{m}", slope + 1.0)];
    let moved = two_states([&f[0], &f[1]], "cos(2*pi*t)", "9/10");
    let unmoved = |q: &str| two_states(["-a", "-b"], q, "1");
    match (4.0 * next()) as u32 {
        0 => (moved, "rate", format!("{}", 1.0 - step / 2.0)),
        1 => {
            let p = json!({ "P": [["1", "0"], ["0", "1"]], "p_low": "1", "p_up": "1", "alpha": "9/10" });
            (moved.with("/witness/lyapunov_existence", p), "rate_existence", format!("{}", 1.0 - step / 2.0))
        }
        2 => (unmoved(&format!("cos(2*pi*t) + {m}")), "q_x", format!("{}", slope + step / 2.0)),
        _ => (
            unmoved(&format!("cos(2*pi*t)*(1 + {m})")),
            "q_tx",
            format!("{}", std::f64::consts::TAU * (slope + step / 2.0)),
        ),
    }
}

/// Were the sign of what may vanish taken for a number, and the mean value form used where a corner cuts a box, all of the rates and
/// of q_x here would be called valid.
#[test]
fn no_relative_of_a_plant_with_a_corner_outside_is_believed() {
    for case in 0..400 / every(20) as u64 {
        let (parts, bound, value) = relative(case);
        let plant = parts.0["plant"].clone();
        let (verdict, rule) = parts.bounds(&[(bound, "1", "0", &value)]).verdict();
        let text = format!("case {case}: {bound} <= {value}: {} and {}", plant["f"], plant["q"]);
        assert!(verdict != Verdict::Valid && rule == "bounds of the plant", "{text}: {verdict} by {rule}");
    }
}
