//! Where each bounding function is taken: with functions that tell all arguments apart, against floating point.

use crate::common::{BOXES, PAPER, certificate};
use proofs_check::data::Data;
use proofs_check::interval::Interval;
use proofs_check::json::{Field, parse};
use proofs_check::rules::paths::{Path, Paths};
use proofs_check::rules::stability::ErrorBox;
use proofs_check::rules::transfer::{self, Proof};
use proofs_check::scope::Scope;
use proofs_check::spec::Specification;
use rug::Rational;
use serde_json::{Value, json};

fn specification(document: &Value) -> Specification {
    let (json, none) = (parse(document.to_string().as_bytes()).unwrap(), parse(b"{}").unwrap());
    let field = |json| Field { json, pointer: String::new() };
    Specification::read(&field(&json), &mut field(&none).fields().unwrap()).unwrap_or_else(|e| panic!("{e:?}"))
}

/// The paper's specification with T = 1, P_low = 1, P_up = 4, alpha = 1/2, and a bounding function for each letter.
fn apart() -> Specification {
    let mut document = certificate(PAPER)["specification"].clone();
    document["lyapunov"] = json!({ "p_low": "1", "p_up": "4", "alpha": "1/2" });
    document["bounds"] = json!({
        "f": "1 + 2*X + 3*E", "f_e": "2 + 3*X + 5*E", "f_xx": "3 + 5*X + 7*E", "f_ex": "5 + 7*X + 11*E",
        "q": "7 + 11*X + 13*E", "q_e": "11 + 13*X + 17*E", "q_x": "13 + 17*X + 19*E", "q_t": "17 + 19*X + 23*E",
        "q_rms": "1 + X + 2*E", "q_t_rms": "2 + 3*X + E"
    });
    specification(&document)
}

#[track_caller]
fn close(value: &Interval, expected: f64) {
    let (lo, hi) = (value.lo().to_f64(), value.hi().to_f64());
    assert!((lo - expected).abs() + (hi - expected).abs() <= 1e-12 * expected.abs(), "[{lo}, {hi}], not {expected}");
}

/// The arguments of df/dx and dq/dx, and of df/de and dq/de, on each path; f and q each have their own.
#[test]
fn error_box() {
    let spec = apart();
    let d = Data::new(&spec, 128);
    let (x, e, dx, de) = (0.25, 0.125, 0.5, 1.0);
    let periodic = [&d.ratio(1, 4), &d.ratio(1, 8)];
    let (x_b, e_b) = (x + dx, e + de);
    // The e of d/dx and the x of d/de.
    let places = [(Path::StateFirst, e, x_b), (Path::ErrorFirst, e_b, x), (Path::Straight, e_b, x_b)];
    for (f, e_f, x_f) in places {
        for (q, e_q, x_q) in places {
            let error_box = ErrorBox::new(&d, Paths { f, q }, periodic, [&d.ratio(1, 2), &d.int(1)]);
            let bends = (3.0 + 5.0 * x) * x + (3.0 + 5.0 * x_b + 7.0 * e_f) * dx / 2.0;
            close(&error_box.rate, 0.5 - 2.0 * (bends + (5.0 + 7.0 * x + 11.0 * e_f) * e_f));
            close(&error_box.k_f, 2.0 + 3.0 * x_f + 5.0 * e_b);
            close(&error_box.k_x, 13.0 + 17.0 * x_b + 19.0 * e_q);
            close(&error_box.k_e, 11.0 + 13.0 * x_q + 17.0 * e_b);
            close(&error_box.x_b, x_b);
            close(&error_box.e_b, e_b);
        }
    }
}

/// The scalar test of the boxes, with s = A_m0 - k0 > 0 (mu = 20, k0 = 1) and with s = 0 (mu = 1, k0 = 20).
#[test]
fn scalar_test() {
    for (mu, k0) in [(20, 1), (1, 20)] {
        let mut document = certificate(BOXES)["specification"].clone();
        document["internal_model"]["mu"] = json!(mu);
        let spec = specification(&document);
        let d = Data::new(&spec, 128);
        let (k1, m0) = (1000, 3);
        let breaks: Vec<Rational> = (0..=160).map(|j| Rational::from((j, 64))).collect();
        let proof = Proof::Boxes { m0, n0: 4, breaks: vec![breaks; 4] };
        let pair = [k0, k1].map(Rational::from);
        let steps = transfer::check(&d, pair.each_ref(), (&proof, Scope::First), "").unwrap();
        let pi = std::f64::consts::PI;
        let (m, nu, n_0, n_1) = (f64::from(m0), f64::from(mu) / (2.0 * pi), 2.0, 1.0);
        let (k0, k1) = (f64::from(k0), f64::from(k1));
        let (n_m, left) = (m.powf(-1.5), m - 0.5);
        let slope = (pi * pi - 4.0) / 2.0 * n_1 + (n_0 - n_1 / 2.0) / (left * left);
        let s = f64::max(slope - k0, 0.0);
        let sum = (n_0 + n_1 * (2.35 + 1.5 * m.ln())) / left + n_1 / (m * (4.0 * m - 1.0));
        let distance = (m * n_m / (2.0 * m * (k1 * left * left - s))).sqrt();
        let at_pole = 2.0 / (m * m * n_m) * (1.0 / (nu * nu) + sum * sum) + s / (m * m);
        let step = |name: &str| steps.iter().find(|step| step.what.contains(name)).unwrap();
        close(&step("twice the distance").lhs, 2.0 * distance);
        close(&step("at the pole").lhs, at_pole);
        close(&step("at the pole").rhs, k1 * (1.0 - distance / m).powi(2));
    }
}
