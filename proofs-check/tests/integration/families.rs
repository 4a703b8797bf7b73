//! Parameters in intervals: one certificate for every constant of a box, with each of its parts forged; and where it is not available.

use super::coq_support::assert_refused_at;
use super::plant_certificates::{changed, stored};
use super::plant_mutations::mutate;
use super::plant_support::{Parts, judged, read};
use crate::common::{assert_refused, every, said};
use proofs_check::verdict::Verdict::{BadInput, Invalid, Undecided, Valid};
use proofs_check::{Report, spec};
use rug::Rational;
use serde_json::{Value, json};

const ALL: [&str; 3] = ["family", "family-example", "family-joint"];

pub fn interval([nominal, low, high]: [&str; 3]) -> Value {
    json!({ "nominal": nominal, "low": low, "high": high })
}

/// `x' = -a x + e + cos(2 pi t)`, `q = g sin(2 pi t) + x`, and what xb, qb are at a = g = 1, and along a and g.
pub fn family(a: [&str; 3], g: [&str; 3]) -> Parts {
    let om = 2.0 * std::f64::consts::PI;
    let square = 1.0 + om * om;
    let (cos, sin) = (1.0 / square, om / square);
    let (of_cos, of_sin) = ((om * om - 1.0) / (square * square), -2.0 * om / (square * square));
    let wave = |cos: f64, sin: f64| json!([{ "cos": format!("{cos:.17}"), "sin": format!("{sin:.17}") }]);
    let waves = |cos: f64, sin: f64| json!([{ "cos": [format!("{cos:.17}")], "sin": [format!("{sin:.17}")] }]);
    Parts::scalar("-a*x + e + cos(2*pi*t)", "g*sin(2*pi*t) + x")
        .orbit(cos, sin, "2.6e-4", "2.9e-4")
        .forcing(0.0, cos, 1.0 + sin, "3e-4", "6e-4")
        .with("/witness/lyapunov/alpha", json!("0.8999"))
        .with("/plant/parameters", json!({ "a": interval(a), "g": interval(g) }))
        .with(
            "/witness/orbit/sensitivities",
            json!([{ "mean": ["0"], "harmonics": waves(of_cos, of_sin) }, { "mean": ["0"] }]),
        )
        .with(
            "/witness/forcing/sensitivities",
            json!([{ "mean": "0", "harmonics": wave(of_cos, of_sin) }, { "mean": "0", "harmonics": wave(0.0, 1.0) }]),
        )
        .bounds(&[
            ("f_x", "1", "0", "1.1001"),
            ("q_x", "2", "3", "1"),
            ("q_tx", "2", "3", "0"),
            ("rate", "2", "3", "0.8999"),
        ])
}

pub const A: [&str; 3] = ["1", "0.9", "1.1"];
pub const G: [&str; 3] = ["1", "0.5", "1.5"];

#[test]
fn a_family_is_proved_whole() {
    family(A, G).accepted();
    // The defect is `|p^2 x_1|`, at most 2.4705e-4 (p = a - 1); derivatives on the whole box give twice as much.
    let with_defect = |defect: &str| family(A, G).with("/witness/orbit/defect", json!(defect));
    with_defect("2.475e-4").accepted();
    with_defect("2.46e-4").refused(Invalid, "orbit", "/witness/orbit/defect");
    // The radius, and the radius times a with the defect.
    for (part, enough, less) in [("rest", "2.91e-4", "2.89e-4"), ("rest_t", "5.8e-4", "5.7e-4")] {
        let with = |value: &str| family(A, G).with(&format!("/witness/forcing/{part}"), json!(value));
        with(enough).accepted();
        assert_ne!(with(less).verdict().0, Valid);
    }
}

/// Each bound holds at the nominal values, and at one end it does not.
#[test]
fn a_bound_that_one_corner_breaks() {
    for (bound, value) in [("f_x", "1.099"), ("rate", "0.901")] {
        family(A, G).bounds(&[(bound, "1", "0", value)]).refused(Invalid, "bounds of the plant", "/witness/bounds/0");
    }
    family(A, G).with("/witness/lyapunov/alpha", json!("0.901")).refused(Invalid, "orbit", "/witness/lyapunov/alpha");
    // A wider interval in the plant, on either side; a narrower one.
    for a in [["1", "0.89", "1.1"], ["1", "0.9", "1.11"], ["1", "0.9", "1.2"]] {
        family(a, G).refused(Invalid, "orbit", "/witness/orbit");
    }
    family(["1", "0.95", "1.1"], ["1", "0.7", "1"]).accepted();
}

/// Both ends satisfy it, and what is between does not.
#[test]
fn a_bound_that_the_inside_breaks() {
    let hill = |value: &str| {
        family(A, G).with("/plant/q", json!("g*sin(2*pi*t) + x*(3 - g)*(g + 1)/4")).bounds(&[("q_x", "2", "3", value)])
    };
    // At g = 1/2 and 3/2 it is 15/16.
    let forced =
        |parts: Parts| parts.with("/witness/forcing/rest", json!("0.1")).with("/witness/forcing/rest_t", json!("1"));
    forced(hill("1.0001")).accepted();
    forced(hill("0.999")).refused(Invalid, "bounds of the plant", "/witness/bounds/0");
    // An end that is not the nominal value's: away from it, near no corner.
    let hump = |value: &str| {
        let parts = family(A, G).with("/plant/f/0", json!("-a*x + e/(1 + 100*(g - 1.2)^2) + cos(2*pi*t)"));
        parts.bounds(&[("f_e", "2", "3", value)])
    };
    hump("1.0001").accepted();
    hump("0.99").refused(Invalid, "bounds of the plant", "/witness/bounds/0");
}

/// Where x and its velocity are for all parameters counts: `x_0 = m`, and `x_0' = -a v` for `|v| <= r`.
#[test]
fn the_orbits_of_all_members_are_looked_at() {
    let with = |f: &str, p: Value, mean: &str| {
        Parts::scalar(f, "sin(2*pi*t) + x^2/2")
            .orbit(0.0, 0.0, "0", "0.05")
            .forcing(0.0, 0.0, 1.0, "0.6", "2")
            .with("/witness/lyapunov/alpha", json!("0.9"))
            .with("/plant/parameters", p)
            .with("/witness/orbit/sensitivities", json!([{ "mean": [mean] }]))
            .with("/witness/forcing/sensitivities", json!([{ "mean": "0" }]))
    };
    let away = with("-x + e + m", json!({ "m": interval(["0", "-1", "1"]) }), "1");
    away.clone().bounds(&[("q_x", "2", "3", "3.051")]).accepted();
    away.bounds(&[("q_x", "2", "3", "3.049")]).refused(Invalid, "bounds of the plant", "/witness/bounds/0");
    let fast = with("-a*x + e", json!({ "a": interval(["1", "1", "9"]) }), "0");
    fast.clone().bounds(&[("q_tx", "2", "3", "0.451")]).accepted();
    fast.bounds(&[("q_tx", "2", "3", "0.449")]).refused(Undecided, "bounds of the plant", "/witness/bounds/0");
}

/// (M) with `w_x = h = 1`: `2 sigma` is not below `(4 + 2a)/(4a - 1)`, which is 2.2308 at a = 0.9 and 2 at a = 1.
#[test]
fn an_inequality_at_every_member() {
    let with = |sigma: f64, a| family(a, G).inequality(["1", "1"], ["2", "3"], "0.001", sigma);
    with(1.12, A).accepted();
    with(1.11, A).refused(Invalid, "matrix inequality", "/witness/matrix_inequality");
    with(1.05, A).refused(Invalid, "matrix inequality", "/witness/matrix_inequality");
    with(1.05, ["1", "0.99", "1.1"]).accepted();
}

#[test]
fn every_sensitivity_counts() {
    for part in ["orbit", "forcing"] {
        let list = format!("/witness/{part}/sensitivities");
        let given = family(A, G).0.pointer(&list).unwrap().clone();
        let with = |list_of: Value| family(A, G).with(&list, list_of);
        // One left out, one too many, none, not in the order of the plant.
        for wrong in [json!([given[0]]), json!([given[0], given[1], given[1]]), json!([]), Value::Null] {
            with(wrong).refused(BadInput, "format", &list);
        }
        assert_eq!(with(json!([given[1], given[0]])).verdict().0, Invalid, "{part}");
        let opposite =
            family(A, G).0.pointer(&format!("{list}/0/harmonics/0/sin")).unwrap().to_string().replace('-', "");
        let turned: Value = serde_json::from_str(&opposite).unwrap();
        let turned = family(A, G).with(&format!("{list}/0/harmonics/0/sin"), turned);
        assert_eq!(turned.verdict().0, Invalid, "{part}");
        assert_eq!(
            family(A, G)
                .with(&format!("{list}/1/mean"), if part == "orbit" { json!(["0.01"]) } else { json!("0.01") })
                .verdict()
                .0,
            Invalid
        );
    }
    // Of constants there is none.
    family(["1", "1", "1"], ["1", "1", "1"]).refused(BadInput, "format", "/witness/orbit/sensitivities");
}

#[test]
fn an_interval_of_one_point_is_that_number() {
    let one = |parts: Parts| {
        let mut parts = parts;
        for part in ["orbit", "forcing"] {
            let list = parts.0.pointer_mut(&format!("/witness/{part}/sensitivities")).unwrap().as_array_mut().unwrap();
            list.remove(1);
        }
        parts
    };
    let fixed = one(family(A, ["1", "2/2", "1"]));
    fixed.accepted();
    // It may stand where numbers stand, and as a whole exponent.
    fixed.clone().with("/plant/period", json!("g")).with("/plant/f/0", json!("-a*x^g + e + cos(2*pi*t)")).accepted();
    // An interval may not.
    for (place, value) in [
        ("/plant/period", json!("g")),
        ("/plant/domain", json!({ "x": "5*g", "e": "5" })),
        ("/plant/initial_set", json!({ "kind": "at-rest", "X0": "g", "E0": "1" })),
        ("/plant/initial", json!({ "x": ["g"], "e": "1" })),
        ("/plant/internal_model/mu", json!("g")),
        ("/plant/internal_model/base_frequency", json!("2*pi*g")),
        ("/plant/parameters/b", json!("2*g")),
        ("/witness/orbit/defect", json!("g")),
    ] {
        family(A, G).with(place, value).refused(BadInput, "format", place);
    }
    // With one as the exponent, x has to be positive, which it is not.
    family(A, G).with("/plant/f/0", json!("-a*x^g + e + cos(2*pi*t)")).refused(Undecided, "smoothness", "/plant");
    // In a coefficient of t it is no period; beside it it is.
    family(A, G).with("/plant/q", json!("sin(2*pi*g*t) + x")).refused(Undecided, "periodicity", "/plant/q");
}

#[test]
fn intervals_that_are_none_are_refused() {
    for (value, at) in [
        (json!({ "nominal": "1", "low": "0.9" }), "/plant/parameters/a"),
        (json!({ "nominal": "1", "low": "0.9", "high": "1.1", "mean": "1" }), "/plant/parameters/a/mean"),
        (interval(["1", "0.9", "sqrt(2)"]), "/plant/parameters/a"),
        (interval(["pi/3", "0.9", "1.1"]), "/plant/parameters/a"),
        (interval(["1", "w", "1.1"]), "/plant/parameters/a/low"),
        (json!([1, 2, 3]), "/plant/parameters/a"),
    ] {
        family(A, G).with("/plant/parameters/a", value).refused(BadInput, "format", at);
    }
    for wrong in [["1", "1.01", "1.1"], ["1", "0.9", "0.99"], ["1", "1.1", "0.9"]] {
        family(wrong, G).refused(Invalid, "parameters", "/plant/parameters/a");
    }
    let many: serde_json::Map<String, Value> = (0..5).map(|i| (format!("k{i}"), interval(A))).collect();
    family(A, G).with("/plant/parameters", Value::Object(many)).refused(BadInput, "format", "/plant/parameters");
    for taken in ["t", "x", "e", "u", "sin", "pi"] {
        let at = format!("/plant/parameters/{taken}");
        family(A, G).with(&at, interval(A)).refused(BadInput, "format", &at);
    }
}

/// The largest of each coefficient's magnitude is at a corner, of which (low, high) may be the one.
#[test]
fn the_harmonics_are_those_of_the_worst_corner() {
    let parts = family(["1", "0.5", "3"], G)
        .with("/witness/forcing/mean", json!("-2"))
        .with("/witness/forcing/harmonics", json!([{ "cos": "3", "sin": "4" }]))
        .with(
            "/witness/forcing/sensitivities",
            json!([
                { "mean": "4", "harmonics": [{ "cos": "-2", "sin": "0" }, { "cos": "0", "sin": "8" }] },
                { "mean": "2", "harmonics": [{ "cos": "2", "sin": "2" }] },
            ]),
        );
    let (specification, _) = read(&parts.0).unwrap();
    let sizes = specification.q_0.unwrap().harmonics;
    let sizes: Vec<(bool, Rational)> = sizes
        .into_iter()
        .map(|size| match size {
            spec::Size::Number(value) => (false, value),
            spec::Size::Root(square) => (true, square),
            spec::Size::Constant(_) => panic!("a number"),
        })
        .collect();
    // -2 + 4*2 + 2/2; (3 + 2/2 + 2/2)^2 + (4 + 1)^2 at (low, high), over 4; (8*2)^2/4.
    let expected = [(false, 7, 1), (true, 50, 4), (true, 64, 1)];
    assert_eq!(sizes, expected.map(|(root, a, b)| (root, Rational::from((a, b)))));
}

#[test]
fn certificates_of_families_are_valid() {
    for (name, said) in [
        (
            "family",
            "every plant of these formulas with a constant 'a' of the file in [0.8, 1.25] and a constant 'g' of the file in [0.5, 1.5] has",
        ),
        ("family-example", "a constant 'c' of the file in [0, 0.2] and a constant 'k' of the file in [0.18, 0.22]"),
        ("family-joint", "a constant 'R' of the file in [590, 615] and a constant 's' of the file in [98, 102]"),
    ] {
        let report = changed(name, &[]);
        assert_eq!(report.verdict, Valid, "{name}: {}", report.text(true));
        let subject = report.subject.as_ref().unwrap();
        assert!(subject.statement.contains(said), "{}", subject.statement);
        assert!(
            subject.assumed.iter().any(|line| line.contains("formulas, with a constant ")),
            "{:?}",
            subject.assumed
        );
        assert!(report.steps < proofs_check::effort::LIMIT / 10, "{name}: {}", report.steps);
    }
}

/// The answer where the interval of a parameter is another one in the plant, in the claim, or in both.
fn moved(name: &str, parameter: &str, [nominal, low, high]: [&str; 3], [in_plant, in_claim]: [bool; 2]) -> Report {
    let (of_plant, of_claim) = (format!("/plant/parameters/{parameter}"), format!("/claim/parameters/{parameter}"));
    let new = interval([nominal, low, high]);
    let mut changes = Vec::new();
    if in_plant {
        changes.push((of_plant.as_str(), new.clone()));
    }
    if in_claim {
        changes.push((of_claim.as_str(), new));
    }
    changed(name, &changes)
}

#[test]
fn claim_and_plant_name_the_same_intervals() {
    for (name, parameter, wide) in [
        ("family", "a", ["1", "0.8", "1.5"]),
        ("family", "a", ["1", "0.7", "1.25"]),
        ("family", "g", ["1", "0.5", "1.6"]),
        ("family-example", "c", ["0.1", "0", "0.25"]),
        ("family-example", "k", ["0.2", "0.17", "0.22"]),
        ("family-joint", "R", ["600", "590", "700"]),
        ("family-joint", "s", ["100", "90", "102"]),
    ] {
        let in_claim = moved(name, parameter, wide, [false, true]);
        assert_eq!((in_claim.verdict, in_claim.finding.unwrap().rule), (Invalid, "parameters"), "{name} {parameter}");
        assert_eq!(moved(name, parameter, wide, [true, false]).verdict, Invalid, "{name} {parameter}");
        let both = moved(name, parameter, wide, [true, true]);
        assert_ne!(both.verdict, Valid, "{name} {parameter}");
        assert_ne!(both.finding.unwrap().rule, "parameters", "{name} {parameter}");
    }
    // Where the middle lies counts: the orbit is written about it.
    let elsewhere = moved("family", "a", ["1.01", "0.8", "1.25"], [true, true]);
    assert_eq!(elsewhere.verdict, Invalid, "{}", elsewhere.text(false));
    // A part of the family, which holds; of the plant alone, it does not.
    let narrow = moved("family", "a", ["1", "0.9", "1.2"], [true, false]);
    assert_eq!((narrow.verdict, narrow.finding.unwrap().rule), (Invalid, "parameters"));
    assert_eq!(moved("family", "a", ["1", "0.9", "1.2"], [true, true]).verdict, Valid);
    let c = "/claim/parameters";
    assert_refused(&changed("family", &[(c, Value::Null)]), Invalid, "parameters", "/claim");
    let linear = changed("linear", &[(c, json!({ "a": interval(A) }))]);
    assert_refused(&linear, Invalid, "parameters", c);
    assert_refused(&changed("family", &[("/claim/parameters/g", Value::Null)]), BadInput, "format", c);
    let more = changed("family", &[("/claim/parameters/w", interval(["1", "1", "1"]))]);
    assert_refused(&more, BadInput, "format", "/claim/parameters/w");
    let other = changed("family", &[("/claim/parameters/a/nominal", json!("1.01"))]);
    assert_refused(&other, Invalid, "parameters", "/claim/parameters/a/nominal");
    // The numbers of the claim are what the sentence says.
    let report = changed("family", &[("/claim/parameters/a/low", json!("4/5"))]);
    assert!(said(&report).contains("with a constant 'a' of the file in [4/5, 1.25]"), "{}", report.text(false));
}

#[test]
fn the_order_of_the_plant_is_that_of_the_sensitivities() {
    let parameters = stored("family")["plant"]["parameters"].clone();
    let turned = json!({ "g": parameters["g"], "a": parameters["a"], "w": parameters["w"] });
    let report = changed("family", &[("/plant/parameters", turned)]);
    assert_ne!(report.verdict, Valid);
}

#[test]
fn theorems_are_not_available() {
    for name in ALL {
        assert_refused_at(&stored(name).to_string(), Undecided, "/plant/parameters");
    }
}

#[test]
fn leaves_of_a_certificate_of_a_family() {
    mutate("plants/family.certificate", every(11));
}

/// A family without states, and one whose parameter is in no formula.
#[test]
fn families_of_little() {
    let idle = family(A, G).with("/plant/q", json!("sin(2*pi*t) + x"));
    assert_eq!(idle.verdict(), (Invalid, "forcing"));
    let still = json!([family(A, G).0["witness"]["forcing"]["sensitivities"][0], { "mean": "0" }]);
    idle.with("/witness/forcing/sensitivities", still).accepted();
    let lines = judged(&family(A, G).0).unwrap();
    assert!(lines.iter().any(|line| line.starts_with("orbit: defect by")), "{lines:?}");
}
