//! The rules of section 11 one by one, on small plants of which everything is known in closed form.

use super::plant_support::{Parts, judged};
use proofs_check::verdict::Verdict;
use serde_json::json;

/// `x' = -x + e + cos(2 pi t)`, `q = sin(2 pi t) + x`.
fn linear() -> Parts {
    let om = 2.0 * std::f64::consts::PI;
    let (cos, sin) = (1.0 / (1.0 + om * om), om / (1.0 + om * om));
    Parts::scalar("-x + e + cos(2*pi*t)", "sin(2*pi*t) + x")
        .orbit(cos, sin, "1e-14", "1.1e-14")
        .forcing(0.0, cos, 1.0 + sin, "3e-14", "2e-13")
        .bounds(&[
            ("f_x", "1", "0", "1"),
            ("f_e", "2", "3", "1"),
            ("q_x", "2", "3", "1"),
            ("q_e", "2", "3", "0"),
            ("q_e_max", "2", "3", "0"),
            ("q_tx", "2", "3", "0"),
            ("q_te", "2", "3", "0"),
            ("rate", "2", "3", "1"),
        ])
}

/// `x_0 = sin(2 pi t)` exactly; `J = -1 - 3 v^2 + e`.
fn cubic() -> Parts {
    let f = "-(x - sin(2*pi*t)) - (x - sin(2*pi*t))^3 + 2*pi*cos(2*pi*t) + e*(1 + x)";
    Parts::scalar(f, "x^2/2 + e*x + cos(2*pi*t)")
        .orbit(0.0, 1.0, "1e-17", "1e-16")
        .with(
            "/witness/forcing",
            json!({
                "mean": "0.25", "rest": "1e-14", "rest_t": "1e-13",
                "harmonics": [{ "cos": "1", "sin": "0" }, { "cos": "-0.25", "sin": "0" }],
            }),
        )
        .bounds(&[
            ("f_x", "1/2", "0", "1.751"),
            ("f_e", "1/2", "1/4", "2.501"),
            ("q_x", "1/2", "1/4", "1.751"),
            ("q_e", "1/2", "1/4", "1.501"),
            ("q_e_max", "1/2", "1/4", "1.501"),
            ("q_tx", "1/2", "1/4", "6.2832"),
            ("q_te", "1/2", "1/4", "6.2832"),
            ("rate", "1/2", "0", "0.999"),
            ("rate", "1/2", "1/4", "0.749"),
        ])
}

#[test]
fn true_parts_are_accepted() {
    linear().accepted();
    cubic().accepted();
}

#[test]
fn a_bound_that_is_too_small_is_refuted() {
    for (index, wrong) in
        ["1.74", "2.49", "1.74", "1.49", "1.49", "6.22", "6.22", "1.001", "0.751"].into_iter().enumerate()
    {
        let at = format!("/witness/bounds/{index}/value");
        cubic().with(&at, json!(wrong)).refused(Verdict::Invalid, "bounds of the plant", &at);
    }
    for index in 0..8 {
        let at = format!("/witness/bounds/{index}/value");
        let wrong = match index {
            0..=2 => "0.99",
            7 => "1.01",
            _ => continue,
        };
        linear().with(&at, json!(wrong)).refused(Verdict::Invalid, "bounds of the plant", &at);
    }
    // Norms are decided by squares.
    let at = "/witness/bounds/2/value";
    linear().with(at, json!("-2")).refused(Verdict::Invalid, "bounds of the plant", at);
}

#[test]
fn the_orbit_must_be_one() {
    linear().with("/witness/orbit/mean", json!(["0.001"])).refused(Verdict::Invalid, "orbit", "/witness/orbit/defect");
    linear().with("/witness/orbit/defect", json!("1e-18")).refused(Verdict::Invalid, "orbit", "/witness/orbit/defect");
    linear().with("/witness/orbit/radius", json!("9e-15")).refused(Verdict::Invalid, "orbit", "/witness/orbit/radius");
    linear().with("/witness/orbit/radius", json!("0.5")).refused(Verdict::Invalid, "orbit", "/witness/orbit/tube");
    linear().with("/witness/lyapunov/alpha", json!("1.001")).refused(Verdict::Invalid, "orbit", "/witness/lyapunov");
    linear().with("/witness/lyapunov/p_low", json!("1.1")).refused(Verdict::Invalid, "", "/witness/lyapunov");
    linear().with("/witness/lyapunov/P", json!([["2"]])).refused(Verdict::Invalid, "orbit", "/witness/lyapunov");
    // A constant term of xb and the wrong phase, with the defect that belongs to them, but a tube that is too small.
    let moved = linear().with("/witness/orbit/mean", json!(["0.001"])).with("/witness/orbit/defect", json!("0.002"));
    let narrow = moved.with("/witness/orbit/radius", json!("0.003")).with("/witness/orbit/tube", json!("0.002"));
    narrow.refused(Verdict::Invalid, "orbit", "/witness/orbit/tube");
}

#[test]
fn coordinates_and_a_periodic_p_are_used() {
    // v = 2 x: f_e doubles, q_x halves.
    let scaled = linear()
        .with("/witness/coordinates", json!([["1/2"]]))
        .with("/witness/orbit/defect", json!("2e-14"))
        .with("/witness/orbit/radius", json!("2.2e-14"));
    scaled.clone().refused(Verdict::Invalid, "bounds of the plant", "/witness/bounds/1/value");
    scaled.with("/witness/bounds/1/value", json!("2")).with("/witness/bounds/2/value", json!("1/2")).accepted();
    linear().with("/witness/coordinates", json!([["0"]])).refused(Verdict::Invalid, "coordinates", "");
    // P = 1 + cos/4: P' - 2 P <= -2 a P, with a = 1 - max P'/(2 P) = 1 - pi/4/sqrt(15/16) = 0.1888.
    let p = json!({
        "P": [["1"]], "harmonics": [{ "cos": [["1/4"]], "sin": [["0"]] }], "p_low": "0.7499", "p_up": "1.2501", "alpha": "0.188",
    });
    let periodic = linear()
        .with("/witness/lyapunov", p)
        .with("/witness/bounds/7/value", json!("0.188"))
        .with("/witness/orbit/radius", json!("1e-13"))
        .with("/witness/forcing/rest", json!("3e-13"))
        .with("/witness/forcing/rest_t", json!("2e-12"));
    periodic.clone().accepted();
    for (at, wrong) in [("p_low", "0.7501"), ("p_up", "1.2499"), ("alpha", "0.19")] {
        let at = format!("/witness/lyapunov/{at}");
        periodic.clone().with(&at, json!(wrong)).refused(Verdict::Invalid, "orbit", "/witness/lyapunov");
    }
    let at = "/witness/bounds/7/value";
    periodic.with(at, json!("0.19")).refused(Verdict::Invalid, "bounds of the plant", at);
}

#[test]
fn the_forcing_must_be_what_it_says() {
    for (field, wrong) in [("rest", "1e-16"), ("rest_t", "1e-16"), ("mean", "1e-6"), ("harmonics", "")] {
        let value = if wrong.is_empty() { json!([]) } else { json!(wrong) };
        let parts = linear().with(&format!("/witness/forcing/{field}"), value);
        parts.refused(Verdict::Invalid, "forcing", "/witness/forcing");
    }
    let high = json!([{ "cos": "1", "sin": "0" }, { "cos": "-0.2501", "sin": "0" }]);
    cubic().with("/witness/forcing/harmonics", high).refused(Verdict::Invalid, "forcing", "/witness/forcing");
}

const SPIKE: &str = "exp(-4000*(1-cos(2*pi*t-1)))";

#[test]
fn a_narrow_spike_is_seen() {
    let at = "/witness/bounds/0/value";
    let parts = |value: &str| {
        linear().with("/plant/q", json!(format!("sin(2*pi*t) + x + e*{SPIKE}"))).bounds(&[("q_e", "1", "1", value)])
    };
    parts("1.003").accepted();
    parts("0.9").refused(Verdict::Invalid, "bounds of the plant", at);
    parts("0.1").refused(Verdict::Invalid, "bounds of the plant", at);
    // The rate is 1 but near one time.
    let rate = |value: &str| {
        linear()
            .with("/plant/f/0", json!(format!("-x*(1 - {SPIKE}*e) + e + cos(2*pi*t)")))
            .bounds(&[("f_e", "1", "1", "2.5"), ("rate", "1", "1/2", value)])
    };
    rate("0.499").accepted();
    for wrong in ["0.51", "0.9", "0.999"] {
        rate(wrong).refused(Verdict::Invalid, "bounds of the plant", "/witness/bounds/1/value");
    }
}

#[test]
fn only_periodic_formulas_are_taken() {
    let verdict = |q: &str| linear().with("/plant/q", json!(q)).verdict();
    for q in [
        "sin(t) + x",
        "t*x",
        "t",
        "sin(2*pi*t/3) + x",
        "sin(t^2)",
        "exp(t)",
        "cos(2*pi*t + t*x)",
        "sin(2*pi*t*x)",
        "sin(6.283185307179586*t)",
        "tan(t/10)",
        "cos(2*pi*t*1.5)",
        "abs(t)",
        "sin(2*pi*t + sin(t))",
        "t - 2*t/2 + x*t",
        "cos(exp(1)*t)",
        "min(t, 1)",
        "2^t",
        "t^2",
        "atan(t)",
    ] {
        let (verdict, rule) = verdict(q);
        assert!(rule == "periodicity" && verdict != Verdict::Valid, "{q}: {verdict} by {rule}");
    }
    for q in [
        "sin(2*pi*t) + x",
        "sin(2*pi*(t + 1/3)) + x - sin(2*pi*(t + 1/3)) + sin(2*pi*t)",
        "sin(-(2*pi)*(-t)) + x",
        "sin(4*pi*t/2 + 0*x*e) + x",
        "x - cos(2*pi*t + pi/2)",
        "x + sin(2*pi*t + x*e - e*x)",
        "x + sin(2*pi*t) + 0*tan(pi/8 + 0*t)",
    ] {
        let (_, rule) = verdict(q);
        assert_ne!(rule, "periodicity", "{q}");
    }
}

#[test]
fn formulas_must_be_smooth_where_they_are_used() {
    let added = |part: &str| linear().with("/plant/q", json!(format!("sin(2*pi*t) + x + {part}")));
    // |x_0| <= 0.16, |v| <= 2, |e| <= 3.
    for part in [
        "0*abs(x)",
        "0*sqrt(x)",
        "0*sqrt(x + 2)",
        "0*log(x + 2)",
        "0/x",
        "0*x^-1",
        "0*(x + 2)^0.5",
        "0*min(x, e)",
        "0*max(x, 1)",
        "0*tan(x)",
        "0*abs(e)",
        "0*(1/0)",
        "0*log(-1)",
        "0*sqrt(2 - 3)",
        "0*min(x, x)",
        "0*tan(cos(2*pi*t)*2)",
    ] {
        let (verdict, rule) = added(part).verdict();
        assert!(rule == "smoothness" && verdict != Verdict::Valid, "{part}: {verdict} by {rule}");
    }
    for part in [
        "0*abs(x + 3)",
        "0*sqrt(x + 3)",
        "0*log(x + 3)",
        "0/(x + 3)",
        "0*(x + 3)^-1",
        "0*(x + 3)^0.5",
        "0*min(x, e + 6)",
        "0*max(x, 4)",
        "0*tan(x/2)",
        "0*sqrt(0)",
        "0*abs(0)",
        "0*exp(x)",
        "0*(x + 3)^x",
        "0*tan(cos(2*pi*t))",
    ] {
        added(part).accepted();
    }
}

#[test]
fn what_is_written_is_defined_whatever_it_is_multiplied_with() {
    // Each of these is simplified to a number, or left out, where the operand that is not defined is not looked at.
    let undefined = [
        "0/(1-1)",
        "0/0",
        "(x-x)/(x-x)",
        "0/(e-e)",
        "(x-x)/(x-x) + 0/(e-e)",
        "0/sin(pi)",
        "(0/0)^2",
        "(0/0)^0",
        "(0/0)^1",
        "(1/0)^-1",
        "1/(1/0)",
        "log(1+0/0)",
        "0*(0/0)",
        "x*(0/0)*0",
        "x^(0/0)",
        "(0/0)^x*0",
        "1*(0/0)",
        "-1*(0/0)",
        "0/0 - 0/0",
        "0 - 0/0",
        "--(0/0)",
        "0*sqrt(0/0)",
        "0*exp(0/0)",
        "0*sin(0/0)",
        "0*atan(0/0)",
        "0*tanh(0/0)",
        "0*exprelr(0/0)",
        "0*sinc(0/0)",
        "sin(x-x)/(x-x) - 1",
        "0*abs(0/0)",
        "0*tan(0/0)",
        "min(0, 0/0)",
        "max(x, 0/0)*0",
        "0*(x/(1-1))",
        "0*log(0)",
        "0*0^-1",
        "0*0^-0.5",
        "0*(-1)^0.5",
    ];
    for part in undefined {
        let (verdict, rule) = linear().with("/plant/q", json!(format!("sin(2*pi*t) + x + {part}"))).verdict();
        assert!(rule == "smoothness" && verdict != Verdict::Valid, "q with {part}: {verdict} by {rule}");
        let f = format!("-x + e + cos(2*pi*t) + {part}");
        let (verdict, rule) = linear().with("/plant/f/0", json!(f)).verdict();
        assert!(rule == "smoothness" && verdict != Verdict::Valid, "f with {part}: {verdict} by {rule}");
    }
    for part in [
        "0/(1-2)",
        "0/pi",
        "0/sin(1)",
        "(x-x)/(x-x+1)",
        "0*(1/3)^x",
        "0^0 - 1",
        "0*sqrt(0)",
        "0/exp(x)",
        "sinc(x-x) - 1",
        "exprelr(0)-1",
    ] {
        linear().with("/plant/q", json!(format!("sin(2*pi*t) + x + {part}"))).accepted();
    }
}

#[test]
fn functions_of_every_kind_have_bounds() {
    // q_e at x = sin(2 pi t) + v, |v| <= 1/2, of e g(x): the largest |g|.
    for (g, value) in [
        ("abs(x - 3)", 4.5),
        ("min(x, 4) + 3", 4.5),
        ("max(x, -4)", 1.5),
        ("sqrt(x + 3)", 4.5_f64.sqrt()),
        ("log(x + 3)", 4.5_f64.ln()),
        ("(x + 3)^1.5", 4.5_f64.powf(1.5)),
        ("tanh(x)", 1.5_f64.tanh()),
        ("exp(-x)", 1.5_f64.exp()),
        ("1/(x + 2)", 2.0),
        ("tan(x)", 1.5_f64.tan()),
        ("2^x", 1.5_f64.exp2()),
        ("atan(x)^3", 1.5_f64.atan().powi(3)),
        ("exprelr(x)", 1.5 / (1.0 - (-1.5_f64).exp())),
        ("sinc(x)", 1.0),
        ("exprelr(-x) + x/4", 1.5 / (1.0 - (-1.5_f64).exp()) + 1.5 / 4.0),
        ("x^-2 - x^-2 + x", 0.0),
        ("(x + 3)^-2", 1.5_f64.powi(-2)),
    ] {
        let q = format!("x^2/2 + cos(2*pi*t) + e*({g})");
        let parts =
            |value: f64| cubic().with("/plant/q", json!(q)).bounds(&[("q_e", "1/2", "1/4", &format!("{value:.9}"))]);
        if value == 0.0 {
            assert_eq!(parts(2.0).verdict().1, "smoothness");
            continue;
        }
        parts(value * 1.003).accepted();
        parts(value * 0.99).refused(Verdict::Invalid, "bounds of the plant", "/witness/bounds/0/value");
    }
}

#[test]
fn what_is_read_is_read_strictly() {
    for (at, value) in [
        ("/plant/states", json!(["t"])),
        ("/plant/states", json!(["x", "x"])),
        ("/plant/states", json!(["1x"])),
        ("/plant/states", json!([])),
        ("/plant/f", json!(["-x", "x"])),
        ("/plant/q", json!("y")),
        ("/plant/internal_model/extra", json!(1)),
        ("/witness/orbit/mean", json!([])),
        ("/witness/coordinates", json!([])),
        ("/witness/coordinates", json!([["1", "0"]])),
        ("/witness/bounds/0/bound", json!("f_xx")),
        ("/plant/initial", json!({ "x": [] })),
        ("/witness/bounds/0/extra", json!(1)),
        ("/witness/forcing/mean", json!("pi")),
        ("/witness/orbit/extra", json!(1)),
        ("/witness/bounds/0/bound", json!("rate_existence")),
        ("/plant/initial_set", json!({ "kind": "at-rest", "ball": "1", "X0": "1" })),
        ("/plant/domain", json!({ "X": "1", "E": "1" })),
        ("/witness/lyapunov/P", json!([])),
    ] {
        linear().with(at, value).refused(Verdict::BadInput, "format", "");
    }
    for (at, value) in [
        ("/witness/bounds/0/X", json!("-1")),
        ("/plant/domain", json!({ "x": "0", "e": "1" })),
        ("/witness/orbit/tube", json!("0")),
    ] {
        linear().with(at, value).refused(Verdict::Invalid, "", "");
    }
    let names: Vec<String> = (0..7).map(|i| format!("x{i}")).collect();
    let f: Vec<String> = names.iter().map(|name| format!("-{name}")).collect();
    linear().with("/plant/states", json!(names)).with("/plant/f", json!(f)).refused(
        Verdict::BadInput,
        "format",
        "/plant/states",
    );
    assert!(judged(&linear().0).is_ok());
}
