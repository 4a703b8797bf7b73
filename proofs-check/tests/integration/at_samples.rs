//! The matrix inequalities at samples: their questions about formulas against limits by hand, from the forms as they are written in
//! (x, e_k, y, G, w) and q_0.

use super::matrix_inequality::{PLACE, RULE, at_rest};
use super::plant_support::Parts;
use proofs_check::verdict::Verdict;
use serde_json::{Value, json};
use std::f64::consts::PI;

const EXISTENCE: &str = "existence inequality";
const EXISTENCE_PLACE: &str = "/witness/existence_inequality";

/// The law: sigma, K, the sum of weights, and the samples of a period.
const LAW: ([f64; 3], u32) = ([6.0, 0.9, 4.6], 40);

/// Numbers of a form: those of the law, the ends of b, p and p', w_x, and k_p, lambda, and what is taken: c_x, c_e of e_k, c_e of e(s),
/// c_y, gamma.
#[derive(Clone, Copy)]
struct Numbers {
    law: [f64; 3],
    ends: [f64; 2],
    samples: u32,
    period: f64,
    p: [f64; 2],
    w_x: f64,
    k_p: f64,
    lambda: f64,
    taken: [f64; 5],
}

impl Numbers {
    fn with_c_y(mut self, c_y: f64) -> Numbers {
        self.taken[3] = c_y;
        self
    }

    /// The largest c_y for which both forms hold at these derivatives.
    fn limit(self, derivatives: &[[f64; 4]]) -> f64 {
        largest(3.0, |c_y| self.with_c_y(c_y).hold(derivatives))
    }

    /// The form at (x, e_k, y, G, w, q_0), with the derivatives (J, g, r, d), the gain b, and s = h or s = 0.
    fn form(&self, [j, g, r, d]: [f64; 4], b: f64, at_end: bool, [x, e_k, y, slack, w, q_0]: [f64; 6]) -> f64 {
        let ([sigma, gain, sum], [p, p_rate]) = (self.law, self.p);
        let h = self.period / f64::from(self.samples);
        let s = if at_end { h } else { 0.0 };
        let theta = 1.0 / (1.0 - self.ends[1] * gain * h * sum / 2.0) - 1.0;
        let [k_p, lambda] = [self.k_p, self.lambda];
        let e = (1.0 - s * sigma) * e_k + s * y + slack;
        let q = r * x + d * e + q_0;
        let [c_x, c_start, c_e, c_y, gamma] = self.taken;
        -self.w_x * ((p_rate + 2.0 * p * j) * x * x + 2.0 * p * g * x * e) + sigma * (2.0 - h * sigma) * e_k * e_k
            - 2.0 * (1.0 - h * sigma) * e_k * y
            - h * y * y
            + k_p * (1.0 - theta / (1.0 + theta)) * y * y
            - k_p * y * (q + (1.0 - b) * sigma * e_k)
            + lambda * slack * slack
            + 2.0 * lambda * (h / PI) * w * q
            + lambda * w * w
            - c_x * x * x
            - c_start * e_k * e_k
            - c_e * e * e
            - c_y * y * y
            + gamma * q_0 * q_0
    }

    /// Whether both forms are positive definite at all of these derivatives; q_0 counts where gamma is not 0.
    fn hold(&self, derivatives: &[[f64; 4]]) -> bool {
        let order = if self.taken[4] == 0.0 { 5 } else { 6 };
        let unit = |i: usize, k: usize| std::array::from_fn(|l| f64::from(u8::from(l == i) + u8::from(l == k)));
        let [low, high] = self.ends;
        derivatives.iter().all(|at| {
            [(low, false), (low, true), (high, false), (high, true)].into_iter().all(|(b, end)| {
                let value = |i: usize, k: usize| self.form(*at, b, end, unit(i, k));
                let own = |i: usize| value(i, i) / 4.0;
                let mut rows: Vec<Vec<f64>> = (0..order)
                    .map(|i| {
                        let entry = |k: usize| if i == k { own(i) } else { (value(i, k) - own(i) - own(k)) / 2.0 };
                        (0..order).map(entry).collect()
                    })
                    .collect();
                (0..order).all(|k| {
                    let pivot = rows[k].clone();
                    for row in &mut rows[k + 1..] {
                        let factor = row[k] / pivot[k];
                        row.iter_mut().zip(&pivot).for_each(|(entry, of)| *entry -= factor * of);
                    }
                    pivot[k] > 0.0
                })
            })
        })
    }
}

/// The largest number below `end` for which it holds; it holds at 0.
fn largest(end: f64, holds: impl Fn(f64) -> bool) -> f64 {
    assert!(holds(0.0) && !holds(end));
    let (mut low, mut high) = (0.0, end);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if holds(middle) { low = middle } else { high = middle }
    }
    low
}

fn text(value: f64) -> String {
    format!("{value:.15}")
}

/// Stability, with P = 1.
fn stability() -> Numbers {
    let ([sigma, gain, sum], samples) = LAW;
    let (eta, lambda) = (0.4, 30.0);
    Numbers {
        law: [sigma, gain, sum],
        ends: [1.0; 2],
        samples,
        period: 1.0,
        p: [1.0, 0.0],
        w_x: 0.7,
        k_p: 2.0 * eta / gain,
        lambda,
        taken: [0.0014, 0.01, 0.0, 0.02, 0.0],
    }
}

/// The parts of a witness for these numbers, on `|x| <= X`, `|e| <= E`: c_x is 2 w_x rate.
fn parts(numbers: &Numbers, [x, e]: [&str; 2]) -> Value {
    let ([sigma, gain, sum], [c_x, c_start, _, c_y, _]) = (numbers.law, numbers.taken);
    json!({
        "sigma": text(sigma), "gain": text(gain), "weight_sum": text(sum), "samples": numbers.samples,
        "w_x": text(numbers.w_x), "h": text(numbers.k_p * gain / 2.0),
        "stability": {
            "X": x, "E": e, "lambda": text(numbers.lambda), "rate": text(c_x / (2.0 * numbers.w_x)), "c_e": text(c_start),
            "c_y": text(c_y),
        },
    })
}

/// The parts of a witness of existence, with its own P.
fn existence_parts(numbers: &Numbers, [x, e]: [&str; 2]) -> Value {
    let ([sigma, gain, sum], [c_x, _, c_e, c_y, gamma]) = (numbers.law, numbers.taken);
    json!({
        "sigma": text(sigma), "gain": text(gain), "weight_sum": text(sum), "samples": numbers.samples,
        "w_x": "1", "h": "1",
        "existence": {
            "X": x, "E": e, "P": [[text(numbers.p[0])]], "k_p": text(numbers.k_p), "lambda": text(numbers.lambda),
            "c_x": text(c_x), "c_e": text(c_e), "c_y": text(c_y), "gamma": text(gamma),
        },
    })
}

fn with(plant: &Parts, asked: Value) -> Parts {
    plant.clone().with("/at_samples", asked)
}

/// The nominal gain divides.
fn with_gain(plant: Parts, [low, high]: [f64; 2]) -> Parts {
    plant.with("/plant/input_gain", json!({ "nominal": "2", "low": text(2.0 * low), "high": text(2.0 * high) }))
}

/// Accepted a little below the largest c_y that the forms allow, refused a little above it.
#[track_caller]
fn decided(plant: &Parts, numbers: Numbers, region: [&str; 2], derivatives: &[[f64; 4]]) -> f64 {
    let of = |c_y: f64| numbers.with_c_y(c_y);
    let limit = numbers.limit(derivatives);
    with(plant, parts(&of(0.9999 * limit), region)).accepted();
    with(plant, parts(&of(1.0001 * limit), region)).refused(Verdict::Invalid, RULE, PLACE);
    limit
}

const LINEAR: [f64; 4] = [-2.0, 0.3, 0.5, -0.25];

fn linear() -> Parts {
    at_rest("-2*x + 3*e/10", "x/2 - e/4")
}

#[test]
fn stability_of_a_linear_plant() {
    let limit = decided(&linear(), stability(), ["1", "1"], &[LINEAR]);
    // Every number counts, of the law, of the witness and of the plant.
    let change = |edit: fn(&mut Numbers)| {
        let mut numbers = stability();
        edit(&mut numbers);
        let other = decided(&linear(), numbers, ["1", "1"], &[LINEAR]);
        assert!((other / limit - 1.0).abs() > 1e-3, "{other} {limit}");
    };
    change(|n| n.law[0] = 7.0);
    change(|n| n.law[1] = 1.2);
    change(|n| n.law[2] = 4.0);
    change(|n| n.samples = 25);
    change(|n| n.w_x = 0.2);
    change(|n| n.k_p *= 1.2);
    change(|n| n.lambda = 3.0);
    change(|n| n.taken[0] = 2.0);
    change(|n| n.taken[1] = 2.0);
    for (f, q, derivatives) in [
        ("-1.2*x + 3*e/10", "x/2 - e/4", [-1.2, 0.3, 0.5, -0.25]),
        ("-2*x - 3*e", "x/2 - e/4", [-2.0, -3.0, 0.5, -0.25]),
        ("-2*x + 3*e/10", "2*x - e/4", [-2.0, 0.3, 2.0, -0.25]),
        ("-2*x + 3*e/10", "x/2 + e/4", [-2.0, 0.3, 0.5, 0.25]),
    ] {
        let other = decided(&at_rest(f, q), stability(), ["1", "1"], &[derivatives]);
        assert!((other / limit - 1.0).abs() > 1e-3, "{f} {q}");
    }
}

/// Existence, with its own P.
fn existence() -> Numbers {
    let ([sigma, gain, sum], samples) = LAW;
    Numbers {
        law: [sigma, gain, sum],
        ends: [1.0; 2],
        samples,
        period: 1.0,
        p: [0.3, 0.0],
        w_x: 1.0,
        k_p: 0.8,
        lambda: 30.0,
        taken: [0.01, 0.0, 0.01, 0.0, 2.0],
    }
}

#[track_caller]
fn decided_of_existence(plant: &Parts, numbers: Numbers, region: [&str; 2], derivatives: &[[f64; 4]]) -> f64 {
    let of = |c_y: f64| numbers.with_c_y(c_y);
    let limit = numbers.limit(derivatives);
    with(plant, existence_parts(&of(0.9999 * limit), region)).accepted();
    with(plant, existence_parts(&of(1.0001 * limit), region)).refused(Verdict::Invalid, EXISTENCE, EXISTENCE_PLACE);
    limit
}

#[test]
fn existence_of_a_linear_plant() {
    let limit = decided_of_existence(&linear(), existence(), ["1", "1"], &[LINEAR]);
    let change = |edit: fn(&mut Numbers)| {
        let mut numbers = existence();
        edit(&mut numbers);
        let other = decided_of_existence(&linear(), numbers, ["1", "1"], &[LINEAR]);
        assert!((other / limit - 1.0).abs() > 1e-3, "{other} {limit}");
    };
    change(|n| n.law[0] = 7.0);
    change(|n| n.law[1] = 1.2);
    change(|n| n.law[2] = 4.0);
    change(|n| n.samples = 25);
    change(|n| n.p[0] = 0.2);
    change(|n| n.k_p = 1.0);
    change(|n| n.lambda = 3.0);
    change(|n| n.taken[0] = 0.8);
    change(|n| n.taken[2] = 2.0);
    change(|n| n.taken[4] = 0.5);
    // P may have any sign, but here its own block asks for a positive one.
    let mut negative = existence().with_c_y(0.01);
    negative.p[0] = -0.3;
    with(&linear(), existence_parts(&negative, ["1", "1"])).refused(Verdict::Invalid, EXISTENCE, EXISTENCE_PLACE);
}

/// At both ends of b, with theta of b_hi: which of them decides, by the slope of q.
#[test]
fn with_an_input_gain() {
    let mut seen = [0; 2];
    for (d, ends) in [(-0.25, [0.75, 1.125]), (-0.25, [0.9, 1.25]), (-4.0, [0.8, 1.5])] {
        let plant = with_gain(at_rest("-2*x + 3*e/10", &format!("x/2 + {d}*e")), ends);
        let slopes = [[-2.0, 0.3, 0.5, d]];
        let with_ends = |numbers: Numbers, ends| Numbers { ends, ..numbers };
        let limit = decided(&plant, with_ends(stability(), ends), ["1", "1"], &slopes);
        decided_of_existence(&plant, with_ends(existence(), ends), ["1", "1"], &slopes);
        // One end alone, and theta of the nominal gain, allow more.
        let nominal = with_ends(stability(), [1.0; 2]).limit(&slopes);
        let alone = ends.map(|end| with_ends(stability(), [end.min(1.0), end.max(1.0)]).limit(&slopes));
        assert!(limit < nominal.max(alone[0]).max(alone[1]) * (1.0 - 1e-4), "{limit} {nominal} {alone:?}");
        seen[usize::from(alone[1] < alone[0])] += 1;
    }
    assert!(seen.iter().all(|count| *count > 0), "{seen:?}");
    // One number, whatever it is: no gain.
    decided(&with_gain(linear(), [1.0; 2]), stability(), ["1", "1"], &[LINEAR]);
}

/// What stands in the square of e_k alone may be 0 or less: then nothing is proved.
#[test]
fn too_much_of_e_k() {
    // sigma (2 - h sigma) + lambda = 41.1 for s = 0.
    for (c_e, verdict) in [("41.1", Verdict::Undecided), ("41.2", Verdict::Invalid), ("1e6", Verdict::Invalid)] {
        let mut made = parts(&stability(), ["1", "1"]);
        made["stability"]["c_e"] = c_e.into();
        with(&linear(), made).refused(verdict, RULE, PLACE);
    }
}

/// The worst point is inside of the region, or at its end.
#[test]
fn over_the_region() {
    let at = |r: f64| [-2.0, 0.3, r, 0.0];
    // dq/dx = 1/2 + x.
    let bent = at_rest("-2*x + 3*e/10", "x/2 + x^2/2");
    for (x, end) in [("1/2", 0.5), ("1/4", 0.25)] {
        let both = [at(0.5 - end), at(0.5 + end)];
        decided(&bent, stability(), [x, "1"], &both);
        decided_of_existence(&bent, existence(), [x, "1"], &both);
    }
    // No damping is left at x = 9/10.
    let wild = at_rest("-2*x + x^3 + 3*e/10", "x/2");
    with(&wild, parts(&stability(), ["9/10", "1"])).refused(Verdict::Invalid, RULE, PLACE);
    // dq/de = -e^2/4: the ends in e, and 0.
    let cubic = at_rest("-2*x + 3*e/10", "x/2 - e^3/12");
    let slopes = |e: f64| [[-2.0, 0.3, 0.5, 0.0], [-2.0, 0.3, 0.5, -e * e / 4.0]];
    decided(&cubic, stability(), ["1", "3"], &slopes(3.0));
    decided_of_existence(&cubic, existence(), ["1", "2"], &slopes(2.0));
}

/// dq/de is -1/4 at e = 0 and at both ends, where samples look, and 1/4 between.
#[test]
fn what_holds_at_samples_alone_is_refused() {
    let wave = at_rest("-2*x + 3*e/10", "x/2 - e/4 + (1 - cos(2*pi*e))/(4*pi)");
    let at = |d: f64| [-2.0, 0.3, 0.5, d];
    let sampled = |numbers: Numbers| {
        let of = |c_y: f64| numbers.with_c_y(c_y);
        let few = numbers.limit(&[at(-0.25)]);
        assert!(!of(0.99 * few).hold(&[at(0.25)]));
        of(0.99 * few)
    };
    with(&wave, parts(&sampled(stability()), ["1", "1"])).refused(Verdict::Invalid, RULE, PLACE);
    with(&wave, existence_parts(&sampled(existence()), ["1", "1"])).refused(
        Verdict::Invalid,
        EXISTENCE,
        EXISTENCE_PLACE,
    );
}

/// P' counts, and P stands beside df/de.
#[test]
fn with_a_p_that_moves() {
    let moving = linear()
        .with("/witness/lyapunov/harmonics", json!([{ "cos": [["1/5"]], "sin": [["0"]] }]))
        .with("/witness/lyapunov/p_low", json!("0.79"))
        .with("/witness/lyapunov/p_up", json!("1.21"));
    let limit = |k: u32| {
        let (sin, cos) = (2.0 * PI * f64::from(k) / 2_000.0).sin_cos();
        let mut numbers = stability();
        numbers.p = [1.0 + 0.2 * cos, -0.4 * PI * sin];
        // The slack of x is 2 w_x rate P.
        numbers.taken[0] *= numbers.p[0];
        numbers.limit(&[LINEAR])
    };
    let least = (0..2_000).map(limit).fold(f64::INFINITY, f64::min);
    let of = |c_y: f64| with(&moving, parts(&stability().with_c_y(c_y), ["1", "1"]));
    of(0.9999 * least).accepted();
    of(1.0001 * least).refused(Verdict::Invalid, RULE, PLACE);
    assert!(least < 0.99 * stability().limit(&[LINEAR]));
}

/// What cannot be read.
#[test]
fn parts_that_are_none() {
    let made = [parts(&stability(), ["1", "1"]), existence_parts(&existence(), ["1", "1"])];
    for (made, part, place, positive) in [
        (&made[0], "stability", PLACE, vec!["lambda", "rate", "c_e", "c_y"]),
        (&made[1], "existence", EXISTENCE_PLACE, vec!["lambda", "k_p", "c_x", "c_e", "c_y", "gamma"]),
    ] {
        let mut made = made.clone();
        if part == "existence" {
            made[part]["c_y"] = "0.01".into();
        }
        with(&linear(), made.clone()).accepted();
        let bad = |name: &str, value: Value, at: &str| {
            let mut made = made.clone();
            made[part][name] = value;
            with(&linear(), made).refused(Verdict::BadInput, "format", &format!("{place}{at}"));
        };
        for name in &positive {
            for value in ["0", "-1", "x", "", "1e-5*2", "inf"] {
                bad(name, json!(value), &format!("/{name}"));
            }
        }
        for (name, value) in [("X", "-1"), ("E", "-1e-9"), ("X", "x"), ("E", "pi")] {
            bad(name, json!(value), &format!("/{name}"));
        }
        for name in ["sigma", "splitting", "w_x", "another"] {
            bad(name, json!("1"), "");
        }
        for name in positive.into_iter().chain(["X", "E"]) {
            let mut made = made.clone();
            made[part].as_object_mut().unwrap().remove(name);
            with(&linear(), made).refused(Verdict::BadInput, "format", place);
        }
    }
    for matrix in [json!([]), json!("1"), json!(["1"]), json!([["x"]]), json!([["1", "0"], ["0", "1"]])] {
        let mut made = existence_parts(&existence(), ["1", "1"]);
        made["existence"]["c_y"] = "0.01".into();
        made["existence"]["P"] = matrix;
        with(&linear(), made).refused(Verdict::BadInput, "format", &format!("{EXISTENCE_PLACE}/P"));
    }
}
