//! Rule: the Lyapunov triple of a specification with a Jacobian.

use super::families::interval;
use crate::common::{assert_refused, assert_valid, certificate, changed, drawn, every, with};
use proofs_check::check;
use proofs_check::jacobian::{self, Witness};
use proofs_check::json::{Field, parse};
use proofs_check::period::Period;
use proofs_check::plants::jacobian::prove;
use proofs_check::verdict::Verdict::{self, BadInput, Invalid, Undecided};
use serde_json::{Value, json};

const RULE: &str = "Lyapunov triple";
const INTERVALS: &str = "paper-example-jacobian.sharp";
const PERIODIC: &str = "periodic-jacobian.sharp";

/// The answer about a Jacobian of this period and a witness.
fn verdict_of(period: &Value, jacobian: &Value, witness: &Value) -> Result<String, Verdict> {
    let file = json!({ "period": period, "jacobian": jacobian, "witness": witness }).to_string();
    let json = parse(file.as_bytes()).unwrap();
    let proved = || {
        let mut fields = Field { json: &json, pointer: String::new() }.fields()?;
        let period = Period::read(&mut fields, &[])?;
        let jacobian = jacobian::read(&fields.required("jacobian")?, &period)?;
        let (witness, _) = Witness::read(&fields.required("witness")?, jacobian.len())?;
        prove(&jacobian, &period, &witness)
    };
    proved().map_err(|finding| finding.verdict)
}

/// The verdict on a triple for the period 1.
fn verdict(jacobian: &Value, witness: &Value) -> Result<String, Verdict> {
    verdict_of(&json!("1"), jacobian, witness)
}

fn scalar(p_low: &str, p_up: &str, alpha: &str) -> Value {
    json!({ "P": [["1"]], "p_low": p_low, "p_up": p_up, "alpha": alpha })
}

#[track_caller]
fn holds(jacobian: &Value, witness: &Value) {
    assert_eq!(verdict(jacobian, witness).err(), None);
}

#[track_caller]
fn fails(jacobian: &Value, witness: &Value, expected: Verdict) {
    assert_eq!(verdict(jacobian, witness).err(), Some(expected));
}

#[test]
fn a_constant_rate_up_to_its_value() {
    let f = json!([["-1/3"]]);
    holds(&f, &scalar("0.99", "1.01", "0.333333"));
    fails(&f, &scalar("0.99", "1.01", "0.333334"), Invalid);
    fails(&f, &scalar("1.01", "1.02", "0.1"), Invalid);
    fails(&f, &scalar("0.98", "0.99", "0.1"), Invalid);
    // Equality is enough.
    holds(&f, &scalar("1", "1.01", "0.1"));
    holds(&f, &scalar("0.99", "1.01", "1/3"));
    for alpha in ["0", "-1"] {
        fails(&f, &scalar("0.99", "1.01", alpha), Invalid);
    }
}

/// [[-1, d], [0, -1]] with P = I has the rate 1 - |d|/2; with P = diag(1, 4) and d = 1 it is 1 - 1/4.
#[test]
fn matrices() {
    let f = |d: &str| json!([["-1", d], ["0", "-1"]]);
    let w = |p: &str, p_up: &str, alpha: &str| json!({ "P": [["1", "0"], ["0", p]], "p_low": "0.99", "p_up": p_up, "alpha": alpha });
    holds(&f("1"), &w("1", "1.01", "0.499"));
    fails(&f("1"), &w("1", "1.01", "0.501"), Invalid);
    holds(&f("1"), &w("4", "4.01", "0.749"));
    fails(&f("1"), &w("4", "4.01", "0.751"), Invalid);
    fails(&f("1"), &w("4", "3.99", "0.5"), Invalid);
    // Transposed, the other diagonal is the good one: P F and not F P.
    let transposed = json!([["-1", "0"], ["1", "-1"]]);
    fails(&transposed, &w("4", "4.01", "0.749"), Invalid);
    fails(&transposed, &w("4", "4.01", "1/1000"), Invalid);
    // P has an off-diagonal part: eigenvalues 1/2 and 3/2.
    let p = |p_low: &str, p_up: &str| json!({ "P": [["1", "1/2"], ["1/2", "1"]], "p_low": p_low, "p_up": p_up, "alpha": "1/2" });
    holds(&f("0"), &p("0.499", "1.501"));
    fails(&f("0"), &p("0.501", "1.501"), Invalid);
    fails(&f("0"), &p("0.499", "1.499"), Invalid);
    let odd = json!({ "P": [["1", "1/2"], ["0", "1"]], "p_low": "0.1", "p_up": "3", "alpha": "1/10" });
    fails(&f("0"), &odd, Invalid);
    for p in [json!([["1"]]), json!([["1", "0"]]), json!([["1", "0"], ["0"]]), json!([])] {
        fails(&f("0"), &json!({ "P": p, "p_low": "0.1", "p_up": "3", "alpha": "1/10" }), BadInput);
    }
}

#[test]
fn every_vertex_of_the_intervals_counts() {
    let w = |alpha: &str| json!({ "P": [["1", "0"], ["0", "1"]], "p_low": "0.99", "p_up": "1.01", "alpha": alpha });
    for ends in [["-1", "0"], ["0", "1"], ["-1", "1"], ["1/2", "1"]] {
        let f = json!([["-1", ends], ["0", "-1"]]);
        holds(&f, &w("0.499"));
        fails(&f, &w("0.501"), Invalid);
    }
    // Two entries at once: 1 - (|d| + |e|)/2.
    for (d, e) in [(["0", "1/2"], ["0", "1"]), (["-1/2", "0"], ["-1", "0"]), (["-1/2", "1/2"], ["0", "1"])] {
        let f = json!([["-1", d], [e, "-1"]]);
        holds(&f, &w("0.249"));
        fails(&f, &w("0.251"), Invalid);
    }
    let diagonal = json!([[["-2", "-1"], "0"], ["0", ["-3", "-1/2"]]]);
    holds(&diagonal, &w("0.499"));
    fails(&diagonal, &w("0.501"), Invalid);
}

#[test]
fn beyond_six_intervals_a_ball() {
    let off = json!(["-1/10", "1/10"]);
    let f = json!([["-1", off, off], [off, ["-1.1", "-0.9"], off], [off, off, "-1"]]);
    let w = |p_up: &str, alpha: &str| json!({ "P": [["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]], "p_low": "0.99", "p_up": p_up, "alpha": alpha });
    // 1 - p_up sqrt(7)/10; a failure refutes nothing.
    holds(&f, &w("1.001", "0.735"));
    fails(&f, &w("1.001", "0.736"), Undecided);
    fails(&f, &w("2", "0.735"), Undecided);
}

/// x' = (-2 + sin a) x with P = 1 + cos(a)/2, a = 2 pi t: P' = -pi sin a, so that the rate is 2 - sin a + pi sin a/(2 + cos a).
#[test]
fn a_periodic_matrix() {
    let rate = |a: f64| 2.0 - a.sin() + std::f64::consts::PI * a.sin() / (2.0 + a.cos());
    let least = (0..100_000).map(|k| rate(f64::from(k) * 6.283_185_3e-5)).fold(f64::INFINITY, f64::min);
    let f = json!([["-2 + sin(2*pi*t)"]]);
    let w = |p_low: &str, p_up: &str, alpha: f64| {
        let harmonics = json!([{ "cos": [["1/2"]], "sin": [["0"]] }]);
        json!({ "P": [["1"]], "harmonics": harmonics, "p_low": p_low, "p_up": p_up, "alpha": format!("{alpha:.6}") })
    };
    holds(&f, &w("0.49", "1.51", least - 1e-3));
    fails(&f, &w("0.49", "1.51", least + 1e-3), Invalid);
    fails(&f, &w("0.51", "1.51", 0.5), Invalid);
    fails(&f, &w("0.49", "1.49", 0.5), Invalid);
}

/// Functions of t are one function in whatever way they are written; entries that are not of the period or not read are refused.
#[test]
fn functions_of_t() {
    let w = scalar("0.99", "1.01", "0.9");
    for text in [
        "-2 + cos(2*pi*t)",
        "-1 - 2*sin(pi*t)^2",
        "-(2 - sin(2*pi*t + 1)/1)",
        "-2 + 2*sin(2*pi*t)*cos(2*pi*t)",
        "-2 + cos(2*pi*t)*abs(0-1)",
        "-2 + sin(2*pi*t)^1 + 0*t",
        "-2 + (cos(2*pi*t)^2)^2",
        "-2 + 1/(2 + cos(2*pi*t))",
    ] {
        holds(&json!([[text]]), &w);
        fails(&json!([[text]]), &scalar("0.99", "1.01", "1.1"), Invalid);
    }
    for text in ["-2 + cos(pi*t)", "-2 + t/10", "-2 + sin(6*t)/10"] {
        fails(&json!([[text]]), &w, Invalid);
    }
    // Equal at all sevenths of a period, and not proved to have it.
    for text in ["-2 + t*sin(14*pi*t)/10", "-2 + sin(14*pi*t)*cos(pi*t)/10", "-2 + sin(7*t*(2*pi)*(1 + 0*t))/10*t"] {
        fails(&json!([[text]]), &w, Undecided);
    }
    // Both factors change their signs, or the line has no slope.
    for text in ["-2 + sin(pi*t)*cos(3*pi*t)/2", "-2 + cos(pi*t - t*pi + 1)/2", "-2 - sin(pi*(1 - 2*t)/1)/2"] {
        holds(&json!([[text]]), &w);
    }
    // Only what is smooth is followed.
    for text in
        ["-2 + abs(sin(2*pi*t))", "log(t - t)", "-2 + 0/(1 - 1)", "-2 + 0*sqrt(cos(2*pi*t) - 2)", "-2 + 0/sin(2*pi*t)"]
    {
        fails(&json!([[text]]), &w, Undecided);
    }
}

/// A dip between the sampled ends: on t in [0, 1] the ends and the middle are fine.
#[test]
fn a_dip_between_the_ends_of_a_cell() {
    let f = json!([["-2 + sin(8*pi*t)^2"]]);
    holds(&f, &scalar("0.99", "1.01", "0.99"));
    fails(&f, &scalar("0.99", "1.01", "1.001"), Invalid);
    let f = json!([["-2 + sin(8*pi*t)^60"]]);
    fails(&f, &scalar("0.99", "1.01", "1.001"), Invalid);
}

/// The curvature of a product is in the product of the slopes: around its zero, which no cell ends at, sin^2 is small on an
/// interval much narrower than the first cells with good ends.
#[test]
fn a_narrow_dip_of_a_product() {
    for square in ["sin(2*pi*t + 1)*sin(2*pi*t + 1)", "sin(2*pi*t + 1)^2"] {
        let f = json!([[format!("-1 - {square}")]]);
        holds(&f, &scalar("0.99", "1.01", "0.9999"));
        fails(&f, &scalar("0.99", "1.01", "1.000001"), Invalid);
    }
}

#[test]
fn bounded_effort() {
    // The margin vanishes at one time that no cell ends at, which is seen; or everywhere, which is not.
    holds(&json!([["-2 + cos(2*pi*t + 1)"]]), &scalar("0.99", "1.01", "1"));
    let f = json!([["-2 + cos(2*pi*t + 1)^2 + sin(2*pi*t + 1)^2"]]);
    fails(&f, &scalar("0.99", "1.01", "1"), Undecided);
}

#[test]
fn the_claim_uses_the_proved_triple() {
    for name in [INTERVALS, PERIODIC, "paper-example-jacobian.sharp"] {
        assert_valid(&check(certificate(name).to_string().as_bytes()));
        for (field, factor) in [("p_low", 0.999), ("p_up", 1.001), ("alpha", 0.999)] {
            let pointer = format!("/witness/lyapunov/{field}");
            let value: f64 = certificate(name).pointer(&pointer).unwrap().as_str().unwrap().parse().unwrap();
            let report = changed(name, &pointer, format!("{:.9}", value * factor));
            assert_eq!(report.verdict, Invalid, "{name} {field}");
            assert_ne!(report.finding.unwrap().rule, RULE, "{name} {field}");
            let report = changed(name, &pointer, format!("{:.9}", value * (2.0 - factor.powi(20))));
            assert_eq!(report.verdict, Invalid, "{name} {field}");
        }
    }
}

#[test]
fn fields() {
    let lyapunov = "/witness/lyapunov";
    let mut without = certificate(INTERVALS);
    without["witness"].as_object_mut().unwrap().remove("lyapunov");
    assert_refused(&check(without.to_string().as_bytes()), BadInput, "format", "/witness");
    assert_refused(&with(INTERVALS, lyapunov, "beta", "1"), BadInput, "format", lyapunov);
    // Where the user gives the triple there is nothing to prove, and both at once are refused.
    let part = certificate(INTERVALS)["witness"]["lyapunov"].clone();
    assert_refused(&with("linear.sharp", "/witness", "lyapunov", part), BadInput, "format", lyapunov);
    let given = with(INTERVALS, "/specification/lyapunov", "alpha", "1/2");
    assert_refused(&given, BadInput, "format", "/specification/lyapunov/alpha");
    let at = "/specification/lyapunov/jacobian";
    for jacobian in [json!([]), json!([["-1"], ["-1"]]), json!([["-1", "0"]]), json!([["-1", ["0"]], ["0", "-1"]])] {
        assert_refused(&changed(INTERVALS, at, jacobian), BadInput, "format", at);
    }
    let twisted = json!([["-1", ["1", "0"]], ["0", "-1"]]);
    assert_refused(&changed(INTERVALS, at, twisted), Invalid, "specification", at);
    for text in ["X", "E", "t*", "x", "cos(t"] {
        assert_refused(&changed(PERIODIC, at, json!([[text]])), BadInput, "format", at);
    }
    let many: Vec<Value> = vec![json!({ "cos": [["0"]], "sin": [["0"]] }); 65];
    assert_refused(&with(PERIODIC, lyapunov, "harmonics", many), BadInput, "format", "/witness/lyapunov/harmonics");
}

/// A random Jacobian of order 2 with P(t), each entry `mean + cos cos(2 pi t) + sin sin(2 pi t)`; of F one entry is between two
/// numbers. In every other case the period is an interval, and `v = T_nom/T` lies between the two of `clocks`.
struct Drawn {
    clocks: [f64; 2],
    f: [[[f64; 3]; 2]; 2],
    between: [f64; 2],
    p: [[f64; 3]; 3],
}

impl Drawn {
    fn new(case: u64) -> Drawn {
        let mut next = drawn(case);
        let mut entry = |mean: f64, size: f64| [mean, 0.0, 0.0].map(|mean| mean + size * (2.0 * next() - 1.0));
        let f = [[entry(-2.0, 0.5), entry(0.0, 1.0)], [entry(0.0, 1.0), entry(-1.5, 0.5)]];
        let p = [entry(1.0, 0.2), entry(0.0, 0.2), entry(1.2, 0.2)];
        let low = next() - 0.5;
        let clocks = if case % 2 == 1 { [0.75, 1.6] } else { [1.0; 2] };
        Drawn { clocks, f, between: [low, low + next()], p }
    }

    fn at([mean, cos, sin]: &[f64; 3], t: f64) -> [f64; 2] {
        let (s, c) = (std::f64::consts::TAU * t).sin_cos();
        [mean + cos * c + sin * s, std::f64::consts::TAU * (sin * c - cos * s)]
    }

    /// The least and the largest eigenvalue of P, and the least alpha, over times and all ends.
    fn sampled(&self) -> [f64; 3] {
        let mut found = [f64::INFINITY, 0.0, f64::INFINITY];
        for t in (0..4000).map(|k| f64::from(k) / 4000.0) {
            let [[a, da], [b, db], [d, dd]] = self.p.each_ref().map(|entry| Drawn::at(entry, t));
            let (middle, radius) = ((a + d) / 2.0, ((a - d) / 2.0).hypot(b));
            found = [found[0].min(middle - radius), found[1].max(middle + radius), found[2]];
            for (end, v) in self.between.into_iter().flat_map(|end| self.clocks.map(|v| (end, v))) {
                let f = |i: usize, j: usize| if (i, j) == (0, 1) { end } else { Drawn::at(&self.f[i][j], t)[0] };
                let [g, h, k] = [
                    -(v * da + 2.0 * (a * f(0, 0) + b * f(1, 0))),
                    -(v * db + a * f(0, 1) + b * f(1, 1) + f(0, 0) * b + f(1, 0) * d),
                    -(v * dd + 2.0 * (b * f(0, 1) + d * f(1, 1))),
                ];
                // det(G - 2 alpha P) = 0, the lesser root.
                let [x, y, z] = [a * d - b * b, g * d + k * a - 2.0 * h * b, g * k - h * h];
                found[2] = found[2].min((y - (y * y - 4.0 * x * z).max(0.0).sqrt()) / (4.0 * x));
            }
        }
        found
    }

    fn verdict(&self, [p_low, p_up, alpha]: [f64; 3]) -> Result<String, Verdict> {
        let text = |[mean, cos, sin]: &[f64; 3]| format!("({mean}) + ({cos})*cos(phase) + ({sin})*sin(phase)");
        let f = json!([
            [text(&self.f[0][0]), [self.between[0].to_string(), self.between[1].to_string()]],
            [text(&self.f[1][0]), text(&self.f[1][1])]
        ]);
        let rows = |part: usize| {
            let [a, b, d] = self.p.map(|entry| entry[part].to_string());
            json!([[a, b.clone()], [b, d]])
        };
        let harmonics = json!([{ "cos": rows(1), "sin": rows(2) }]);
        let [p_low, p_up, alpha] = [p_low, p_up, alpha].map(|number| number.to_string());
        let witness = json!({ "P": rows(0), "harmonics": harmonics, "p_low": p_low, "p_up": p_up, "alpha": alpha });
        let [slow, fast] = self.clocks.map(|v| format!("1/{v}"));
        verdict_of(&interval(["1", &fast, &slow]), &f, &witness)
    }
}

/// `P = 1 + cos(phase)/10`, `F = -1 + k sin(phase)`: P' is v dP/ds, and what it adds is largest at one end of v or at the other.
#[test]
fn a_period_that_is_an_interval() {
    let om = std::f64::consts::TAU;
    // The least over the phase of `1 - k sin + v (om/20) sin/(1 + cos/10)`.
    let rate = |k: f64, v: f64| {
        let at = |phase: f64| 1.0 - k * phase.sin() + v * om / 20.0 * phase.sin() / (1.0 + phase.cos() / 10.0);
        (0..100_000).map(|i| at(f64::from(i) * om / 100_000.0)).fold(f64::INFINITY, f64::min)
    };
    let both = interval(["1", "0.8", "1.25"]);
    let witness = |alpha: f64| {
        json!({ "P": [["1"]], "harmonics": [{ "cos": [["0.1"]], "sin": [["0"]] }], "p_low": "0.89", "p_up": "1.11",
            "alpha": format!("{alpha:.9}") })
    };
    for (k, v) in [(0.0, 1.25), (0.5, 0.8)] {
        let f = json!([[format!("-1 + {k}*sin(phase)")]]);
        for (period, most) in [(&both, rate(k, v)), (&json!("1"), rate(k, 1.0))] {
            assert!(verdict_of(period, &f, &witness(most - 1e-6)).is_ok(), "{k}");
            assert_eq!(verdict_of(period, &f, &witness(most + 1e-6)).err(), Some(Invalid), "{k}");
        }
    }
    // Of the time itself nothing is known, nor of what has another period in the phase.
    for (period, entry, expected) in [
        (&both, "-1 + sin(2*pi*t)/10", Some(BadInput)),
        (&both, "-1 + 0*t", Some(BadInput)),
        (&both, "-1 + sin(phase/2)/10", Some(Invalid)),
        (&both, "-1 + sin(phase/2)^2/10", None),
        (&json!("1"), "-1 + sin(phase - 4*pi*t)/10", None),
        (&json!("1"), "-1 + sin(phase - pi*t)/10", Some(Invalid)),
    ] {
        let plain = scalar("1", "1", "0.8");
        assert_eq!(verdict_of(period, &json!([[entry]]), &plain).err(), expected, "{entry}");
    }
}

/// A number that a sampled time contradicts is never proved; one with a little room is.
#[test]
fn random_triples_that_are_false_at_some_time() {
    let mut seen = [0, 0];
    for case in 0..240 / every(6) as u64 {
        let drawn = Drawn::new(case);
        let [low, up, alpha] = drawn.sampled();
        if low < 0.2 || alpha < 0.1 {
            continue;
        }
        seen[0] += 1;
        seen[1] += usize::from(drawn.verdict([low * 0.98, up * 1.02, alpha * 0.98]).is_ok());
        for wrong in [[low * 1.000_001, up * 1.02, alpha * 0.9], [low * 0.98, up * 0.999_999, alpha * 0.9]] {
            assert!(drawn.verdict(wrong).is_err(), "{case}");
        }
        assert!(drawn.verdict([low * 0.98, up * 1.02, alpha * 1.000_001]).is_err(), "{case}: {alpha}");
    }
    assert!(seen[0] >= 10 && seen[1] == seen[0], "{seen:?}");
}
