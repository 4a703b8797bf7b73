//! The two joint metrics: their questions about formulas against what is left for c_e by hand, for stability and for existence.

use super::common::{PAPER, certificate, drawn};
use super::existence_inequality::number;
use super::matrix_inequality::{at_rest, stored};
use super::plant_support::Parts;
use crate::common::judged;
use proofs_check::data::Data;
use proofs_check::json::{Field, Json, parse};
use proofs_check::rules::inequality::{Inequality, Kind};
use proofs_check::spec::Specification;
use proofs_check::verdict::Verdict;
use rug::Rational;
use serde_json::{Value, json};

/// Where the metrics stand: the part of the test, its place in a certificate, and the rule.
const PLACES: [(&str, &str, &str); 2] = [
    ("joint", "/witness/joint_inequality", "joint inequality"),
    ("existence", "/witness/existence_inequality", "existence inequality"),
];

/// The numbers of two metrics of one state: P, w, k_p, c_x, c_y of each, p, and sigma.
#[derive(Clone, Copy)]
struct Pair {
    near: [f64; 5],
    far: [f64; 5],
    p: f64,
    sigma: f64,
}

/// Numbers for which both matrices are definite at all derivatives that the tests have.
const SOME: Pair = Pair { near: [0.7, 1.1, 0.6, 0.1, 0.05], far: [0.5, 0.9, 0.8, 0.2, 0.03], p: 0.15, sigma: 3.0 };

impl Pair {
    /// The largest c_e of the near and of the far metric at j, g, r, d, by the Schur complement of (x, y); `None` where that is not definite.
    fn most(&self, [j, g, r, d]: [f64; 4]) -> [Option<f64>; 2] {
        let Pair { near: [p_1, w_1, k_1, x_1, y_1], far: [p_2, w_2, k_2, x_2, y_2], p, sigma } = *self;
        let left = |x: f64, y: f64, beside: f64, [v_x, v_y]: [f64; 2], e: f64| {
            let det = x * y - beside * beside;
            let taken = (y * v_x * v_x - 2.0 * beside * v_x * v_y + x * v_y * v_y) / det;
            (x > 0.0 && det > 0.0).then_some(e - taken)
        };
        [
            left(
                -2.0 * p_1 * j - x_1,
                k_1 - y_1,
                -p - k_1 / 2.0 * r,
                [-(p_1 * g - sigma * p) - j * p, -w_1 - k_1 / 2.0 * d],
                2.0 * sigma * w_1 - 2.0 * p * g,
            ),
            left(
                -2.0 * p_2 * j - x_2,
                k_2 - y_2,
                -k_2 / 2.0 * r,
                [-(p_2 * g - sigma * p), -w_2 - k_2 / 2.0 * d],
                2.0 * sigma * (w_1 + w_2),
            ),
        ]
    }

    /// The part with these c_e.
    fn part(&self, c_e: [f64; 2], [x, e]: [&str; 2]) -> Value {
        let metric = |[p, w, k_p, c_x, c_y]: [f64; 5], c_e: f64| {
            let [p, w, k_p, c_x, c_y, c_e] = [p, w, k_p, c_x, c_y, c_e].map(|value| format!("{value:.15}"));
            json!({ "P": [[p]], "w": w, "k_p": k_p, "c_x": c_x, "c_e": c_e, "c_y": c_y })
        };
        let mut near = metric(self.near, c_e[0]);
        near["p"] = json!([self.p.to_string()]);
        json!({ "X": x, "E": e, "sigma": self.sigma.to_string(), "near": near, "far": metric(self.far, c_e[1]) })
    }

    fn with(&self, parts: &Parts, place: usize, c_e: [f64; 2], at: [&str; 2]) -> Parts {
        let mut part = self.part(c_e, at);
        if place == 0 {
            for metric in ["near", "far"] {
                for extent in ["P_up", "x_low", "e_low"] {
                    part[metric][extent] = "1".into();
                }
            }
        }
        parts.clone().with(&format!("/{}", PLACES[place].0), part)
    }

    /// Accepted a little below what is left at the worst derivatives, refused a little above it for either metric.
    #[track_caller]
    fn decided(&self, parts: &Parts, at: [&str; 2], worst: &[[f64; 4]]) {
        let least = |which: usize| worst.iter().map(|of| self.most(*of)[which].unwrap()).fold(f64::MAX, f64::min);
        let most = [least(0), least(1)];
        assert!(most[0] > 0.0 && most[1] > 0.0, "{most:?}");
        for (place, (_, pointer, rule)) in PLACES.into_iter().enumerate() {
            let scaled = |[near, far]: [f64; 2]| [near * most[0], far * most[1]];
            self.with(parts, place, scaled([0.9999, 0.9999]), at).accepted();
            for beyond in [[1.0001, 0.9999], [0.9999, 1.0001]] {
                self.with(parts, place, scaled(beyond), at).refused(Verdict::Invalid, rule, pointer);
            }
        }
    }
}

/// Every number of the metrics and of the derivatives is where it belongs; mu and the P of stability are nowhere.
#[test]
fn against_what_is_left_by_hand() {
    let mut draw = drawn(17);
    let mut cases = 0;
    while cases < 40 {
        let mut metric =
            || [0.2 + 2.0 * draw(), 0.1 + 2.0 * draw(), 0.3 + 2.0 * draw(), 0.05 + draw() / 4.0, 0.05 + draw() / 4.0];
        let (near, far) = (metric(), metric());
        let pair = Pair { near, far, p: draw() - 0.5, sigma: 1.0 + 9.0 * draw() };
        let [j, g, r, d] =
            [-1.0 - draw(), draw() - 0.5, draw() - 0.5, draw() - 0.5].map(|value| (value * 64.0).round() / 64.0);
        let most = pair.most([j, g, r, d]);
        if most.iter().any(|most| most.is_none_or(|most| most < 0.1)) {
            continue;
        }
        cases += 1;
        let parts = at_rest(&format!("{j}*x + {g}*e"), &format!("{r}*x + {d}*e"));
        let parts = parts.with("/plant/internal_model/mu", json!(if cases % 2 == 0 { "7" } else { "1" }));
        pair.decided(&parts, ["1", "1"], &[[j, g, r, d]]);
    }
}

/// The worst point is at an end of the region, or beyond it.
#[test]
fn over_the_region() {
    let at = |j: f64, r: f64, d: f64| [j, 0.3, r, d];
    let steep = at_rest("-2*x - x^3 + 3*e/10", "x/2");
    SOME.decided(&steep, ["1/2", "1"], &[at(-2.0, 0.5, 0.0), at(-2.75, 0.5, 0.0)]);
    let bent = at_rest("-2*x + 3*e/10", "x/2 + x^2/4");
    SOME.decided(&bent, ["1/2", "1"], &[at(-2.0, 0.25, 0.0), at(-2.0, 0.75, 0.0)]);
    let of_e = at_rest("-2*x + 3*e/10", "x/2 + e^2/4");
    for (e, slope) in [("1/2", 0.25), ("1", 0.5)] {
        SOME.decided(&of_e, ["1", e], &[at(-2.0, 0.5, slope), at(-2.0, 0.5, -slope)]);
    }
}

/// dq/de is -1/4 at e = 0, half way and at both ends, where samples look, and larger between.
#[test]
fn what_holds_at_samples_alone_is_refused() {
    let wave = at_rest("-2*x + 3*e/10", "x/2 - e/4 + (1 - cos(2*pi*e))/(4*pi)");
    let at = |d: f64| SOME.most([-2.0, 0.3, 0.5, d]).map(Option::unwrap);
    let (sampled, true_) = (at(-0.25), at(0.25));
    for (place, (_, pointer, rule)) in PLACES.into_iter().enumerate() {
        for which in 0..2 {
            let mut c_e = true_.map(|most| 0.99 * most);
            SOME.with(&wave, place, c_e, ["1", "1"]).accepted();
            c_e[which] = 0.999 * sampled[which];
            assert!(c_e[which] > true_[which]);
            SOME.with(&wave, place, c_e, ["1", "1"]).refused(Verdict::Invalid, rule, pointer);
        }
    }
    SOME.decided(&wave, ["1", "1"], &[[-2.0, 0.3, 0.5, 0.25], [-2.0, 0.3, 0.5, -0.75]]);
}

/// With x = L y they are about y.
#[test]
fn in_the_coordinates() {
    let parts = at_rest("-2*x + 3*e/5", "x/2 - e/4").with("/witness/coordinates", json!([["1/4"]]));
    let (own, others) = ([-2.0, 2.4, 0.125, -0.25], [-2.0, 0.6, 0.5, -0.25]);
    assert!((0..2).all(|i| (SOME.most(own)[i].unwrap() / SOME.most(others)[i].unwrap() - 1.0).abs() > 0.01));
    SOME.decided(&parts, ["1", "1"], &[own]);
}

/// Formulas are smooth up to X and E of the metrics, not only up to what the claim uses.
#[test]
fn smooth_as_far_as_it_is_asked() {
    let parts = at_rest("-2*x + 3*e/10", "x/2 + abs(e - 2)/10 - 1/5");
    for place in 0..2 {
        SOME.with(&parts, place, [1.0, 1.0], ["1", "1"]).accepted();
        SOME.with(&parts, place, [1.0, 1.0], ["1", "3"]).refused(Verdict::Undecided, "", "");
    }
}

fn field(json: &Json) -> Field<'_> {
    Field { json, pointer: String::new() }
}

/// What the two say of a periodic solution: the larger of what either says, whatever the gain is.
#[test]
fn what_they_say_of_a_solution() {
    let made = certificate(PAPER);
    let [document, none] =
        [made["specification"].to_string(), "{}".to_owned()].map(|text| parse(text.as_bytes()).unwrap());
    let spec = Specification::read(&field(&document), &mut field(&none).fields().unwrap()).unwrap();
    let d = Data::new(&spec, 128);
    let mut draw = drawn(29);
    let mut larger = [[0; 2]; 3];
    let none = Rational::new();
    for _ in 0..40 {
        let mut metric = || [1.0, 1.0, 0.1 + draw(), 0.1 + draw(), 0.1 + draw()];
        let pair = Pair { near: metric(), far: metric(), p: 0.1, sigma: 3.0 };
        let (c_e, oscillation) = ([0.1 + draw(), 0.1 + draw()], 0.1 + draw());
        let part = parse(pair.part(c_e, ["1", "1"]).to_string().as_bytes()).unwrap();
        let existence = Inequality::read(&field(&part), Kind::Existence, [&none, &none], None).unwrap();
        let number = |value: f64| d.number(&Rational::from_f64(value).unwrap());
        let answer = existence.answer(&d, &Rational::from(3), &number(oscillation));
        let of = |[_, _, k_p, c_x, c_y]: [f64; 5], c_e: f64| {
            let by = |weight: f64| k_p * oscillation / (2.0 * (weight * c_y).sqrt());
            [by(c_x), by(c_e), k_p * oscillation / c_y]
        };
        let (near, far) = (of(pair.near, c_e[0]), of(pair.far, c_e[1]));
        for (i, said) in [answer.rms_x, answer.rms_e, answer.rms_y].into_iter().enumerate() {
            larger[i][usize::from(far[i] > near[i])] += 1;
            assert!((said.hi().to_f64() / near[i].max(far[i]) - 1.0).abs() < 1e-9, "{i}");
        }
    }
    assert!(larger.iter().flatten().all(|count| *count > 5), "{larger:?}");
}

/// What the two prove at sigma they prove at every larger gain: there the metric between them is as good a near one, with the
/// numbers between theirs.
#[test]
fn the_metric_between_serves_a_larger_gain() {
    let mut draw = drawn(23);
    let derivatives = [-2.0, 0.3, 0.5, -0.25];
    let parts = at_rest("-2*x + 3*e/10", "x/2 - e/4");
    for _ in 0..20 {
        let share = 0.02 + 0.98 * draw();
        let between = |near: f64, far: f64| share * near + (1.0 - share) * far;
        let [near, far] = [SOME.near, SOME.far];
        let other = Pair {
            far,
            near: [0, 1, 2, 3, 4].map(|i| between(near[i], far[i])),
            p: share * SOME.p,
            sigma: SOME.sigma / share,
        };
        let [c_near, c_far] = SOME.most(derivatives).map(|most| 0.999 * most.unwrap());
        for place in 0..2 {
            other.with(&parts, place, [between(c_near, c_far), c_far], ["1", "1"]).accepted();
        }
    }
    // The near one by itself is not, nor is it the far one that was left out.
    let alone = Pair { sigma: 100.0 * SOME.sigma, ..SOME };
    assert!(alone.most(derivatives)[0].unwrap() < 0.0);
}

/// The two sides of a level, of another certificate, whose mu is 2 and whose sizes are known to 12 digits; whatever else there is wrong with
/// these metrics.
#[test]
fn levels_by_hand() {
    let mut made = stored("splitting");
    made["witness"].as_object_mut().unwrap().remove("matrix_inequality");
    let metric = |diagonal: &str, [w, k_p, p_up, x_low, e_low]: [&str; 5]| {
        json!({
            "P": [[diagonal, "0"], ["0", diagonal]], "w": w, "k_p": k_p, "c_x": "1", "c_e": "1", "c_y": "1",
            "P_up": p_up, "x_low": x_low, "e_low": e_low,
        })
    };
    let (of_near, of_far) = (["1.5", "1.25", "40", "7", "0.75"], ["0.875", "0.5", "23", "9", "0.125"]);
    let (mut near, far) = (metric("30", of_near), metric("20", of_far));
    near["p"] = json!(["3", "-1"]);
    made["witness"]["joint_inequality"] = json!({ "X": "1", "E": "2", "sigma": "1", "near": near, "far": far });
    let report = judged(&made);
    let of = |at: &str| number(made.pointer(at).unwrap());
    let start = |name: &str| of(&format!("/claim/periodic_solution/{name}"));
    let set = |name: &str| of(&format!("/claim/initial_set/{name}"));
    // z = zeta + M e.
    let n_bar = (start("z") - start("zeta")) / start("e");
    let (x, e) = (set("X0") + start("x"), set("E0") + start("e"));
    let z = set("Z0") + n_bar * set("E0") + start("zeta");
    let (d_x, d_e, mu) = (of("/witness/D_x"), of("/witness/D_e"), 2.0);
    for (id, numbers, size) in [("C4", of_near, 10.0_f64.sqrt()), ("C4f", of_far, 0.0)] {
        let [w, k_p, p_up, x_low, e_low] = numbers.map(|value| number(&json!(value)));
        let sides = [
            p_up * x * x + 2.0 * size * x * e + w * e * e + k_p * mu / 2.0 * z * z,
            (x_low * d_x * d_x).min(e_low * d_e * d_e),
        ];
        let line = report.lines.iter().find(|line| line.split_whitespace().next() == Some(id)).unwrap();
        let shown = line.rsplit(": ").next().unwrap().split_once(", margin").unwrap().0;
        let (left, right) = shown.split_once(" < ").unwrap();
        for (side, shown) in sides.into_iter().zip([left, right]) {
            let shown: f64 = shown.parse().unwrap();
            assert!((shown / side - 1.0).abs() < 1e-8, "{id}: {shown} and {side}");
        }
    }
}
