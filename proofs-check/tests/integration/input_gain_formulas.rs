//! What an input gain changes in the formulas, against what it is to bound; the questions about formulas against thresholds by hand.

use super::matrix_inequality::at_rest;
use super::plant_support::Parts;
use crate::common::{BOXES, PAPER, certificate, drawn};
use proofs_check::data::Data;
use proofs_check::input_gain::Gain;
use proofs_check::interval::Interval;
use proofs_check::json::{Field, decimal, parse};
use proofs_check::rules::inequality::{Inequality, Kind};
use proofs_check::rules::paths::{Path, Paths};
use proofs_check::rules::stability::ErrorBox;
use proofs_check::rules::transfer::{self, Proof};
use proofs_check::scope::Scope;
use proofs_check::spec::Specification;
use proofs_check::verdict::{Condition, Verdict};
use rug::Rational;
use serde_json::{Value, json};

fn number(value: f64) -> Interval {
    Interval::rational(&Rational::from_f64(value).unwrap(), 128)
}

fn gain([low, high]: [f64; 2]) -> Gain {
    Gain { low: number(low), high: number(high) }
}

const GAINS: [[f64; 2]; 6] = [[0.8, 1.25], [0.4, 1.5], [1.0, 6.0], [0.1, 1.0], [0.5, 1.0], [0.9, 40.0]];

/// b from its least to its largest.
fn between([low, high]: [f64; 2], share: f64) -> f64 {
    low + share * (high - low)
}

/// What is not above a bound, and comes near it.
#[track_caller]
fn sharp(what: &str, largest: f64, bound: &Interval, near: f64) {
    let bound = bound.hi().to_f64();
    assert!(largest <= bound * (1.0 + 1e-12) && largest >= near * bound, "{what}: {largest}, {bound}");
}

/// The largest of e_j, om e_j, y_j sqrt(1 + Y^2) and (y_j - b mu s_j) over q_j, over Y, om and b, with kap.
#[test]
fn responses_to_a_harmonic() {
    let scale = |i: i32| (f64::from(i) / 25.0).sinh();
    for (ends, sigma) in GAINS.into_iter().flat_map(|ends| [(ends, 1.0), (ends, 7.0)]) {
        let gain = gain(ends);
        let mut largest = [0.0_f64; 4];
        for (b, om) in (0..=8).flat_map(|i| (1..=160).map(move |j| (f64::from(i) / 8.0, scale(j)))) {
            let b = between(ends, b);
            for y in (-160..=160).map(scale) {
                // y_j over q_j, which is that of e_j in the units of 1/sqrt(sigma^2 + om^2); y (1 + i Y) = q + (1-b) sigma e = y - b mu s.
                let size = (b * sigma - y * om).hypot(om + y * sigma);
                let of_y = sigma.hypot(om) / size;
                let through = of_y * y.hypot(1.0);
                let all = [of_y, om / size, through, through * through / b];
                largest.iter_mut().zip(all).for_each(|(known, value)| *known = known.max(value));
            }
        }
        sharp("e", largest[0], &gain.of_error().recip(), 0.9);
        sharp("om e", largest[1], &gain.of_slope(), 0.9);
        sharp("y", largest[2], &gain.of_answer().recip(), 0.9);
        assert!(largest[3] <= 1.0 / gain.of_swing().lo().to_f64() * (1.0 + 1e-12), "{ends:?}");
        for kap in [0.01, 0.5, 1.0, 1.9 * sigma, 3.0, 20.0] {
            let value = gain.damped(&number(sigma), &number(kap));
            let mut most = 0.0_f64;
            for (om, y) in (0..=200).flat_map(|i| (-200..=200).map(move |j| (scale(i), scale(j)))) {
                let size = (ends[0] * sigma + kap - y * om).hypot(om + y * sigma);
                most = most.max(1.0 / size);
            }
            sharp("g_k", most, &value, 0.95);
            // It decreases in b and in sigma.
            let larger = self::gain([ends[0].max(0.9), ends[1]]).damped(&number(sigma), &number(kap));
            assert!(larger.lo() <= value.hi() && gain.damped(&number(1.1 * sigma), &number(kap)).lo() <= value.hi());
        }
    }
}

/// Whether `x'A x > 0` for three variables, by Sylvester.
fn definite([a, b, c, d, e, f]: [f64; 6]) -> bool {
    // [[a, b, c], [., d, e], [., ., f]].
    let two = a * d - b * b;
    let three = a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d);
    a > 0.0 && two > 0.0 && three > 0.0
}

/// Where C5 holds at sigma, U falls at sigma and at every larger one, for every b and every slope; and without C5 it need not.
#[test]
fn the_closed_form_of_c5() {
    let mut draw = drawn(31);
    let (mut cases, mut refuted, mut damped) = (0, 0, 0);
    while cases < 400 {
        let ends = GAINS[(draw() * 6.0) as usize];
        let gain = gain(ends);
        let (ht, sigma, k_l) = ((4.0 * draw() - 3.0).exp(), (4.0 * draw() - 1.0).exp(), 4.0 * draw());
        let most = k_l * (2.0 * draw() - 1.0);
        let (a, k_x, k_f) = (1.0 + draw(), draw(), draw());
        let [below, above] = gain.sector([&number(ht), &number(sigma)], [&number(k_l), &number(most)]);
        let (below, above) = (below.hi().to_f64(), above.hi().to_f64());
        let size = (1.0 + ht * above).abs().max((1.0 - ht * below).abs());
        let room = 4.0 * a - ht * k_x * k_x;
        let threshold = size * size / (4.0 * ht) + (k_f + k_x * size / 2.0).powi(2) / room;
        let falls = |factor: f64| {
            let (sigma, ht) = (sigma * factor, ht / factor);
            (0..=4).all(|i| {
                let b = between(ends, f64::from(i) / 4.0);
                (0..=8).all(|j| {
                    let delta = -k_l + f64::from(j) / 8.0 * (most + k_l);
                    [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].into_iter().all(|[of_x, of_f]| {
                        // 2 A xi^2 - 2 k_f xi e + 2 sigma e^2 - 2 e y + 2 ht y^2 - 2 ht y (k_x xi + (delta + (1-b) sigma) e).
                        let cross = -(1.0 + ht * (delta + (1.0 - b) * sigma));
                        definite([2.0 * a, of_f * k_f, -of_x * ht * k_x, 2.0 * sigma, cross, 2.0 * ht])
                    })
                })
            })
        };
        if room <= 0.0 {
            continue;
        }
        if threshold < sigma {
            cases += 1;
            damped += usize::from(most < 0.0 && (above - most - (1.0 - ends[0]) * sigma).abs() < 1e-12);
            for factor in [1.0, 1.01, 1.3, 2.0, 7.0, 100.0, 1e4] {
                assert!(falls(factor), "{ends:?} {ht} {sigma} {k_l} {most} {factor}");
            }
        } else if !falls(1.0) {
            refuted += 1;
        }
    }
    assert!(refuted > 100 && damped > 10, "{refuted} {damped}");
}

/// The paper's example with this gain.
fn specification(ends: [f64; 2]) -> Specification {
    let mut document = certificate(PAPER)["specification"].clone();
    document["input_gain"] = json!({ "nominal": "1", "low": ends[0], "high": ends[1] });
    document["internal_model"]["mu"] = json!("1/2");
    let (json, none) = (parse(document.to_string().as_bytes()).unwrap(), parse(b"{}").unwrap());
    let field = |json| Field { json, pointer: String::new() };
    Specification::read(&field(&json), &mut field(&none).fields().unwrap()).unwrap_or_else(|e| panic!("{e:?}"))
}

fn read<T>(part: &Value, read: impl Fn(&Field<'_>) -> T) -> T {
    let json = parse(part.to_string().as_bytes()).unwrap();
    read(&Field { json: &json, pointer: String::new() })
}

/// Whatever its proof is, the transfer bound is that of b_lo nu: the constants of the least gain, and no smaller ones.
#[test]
fn transfer_constants_of_the_least_gain() {
    let check = |ends, pair: [f64; 2], proof: &Proof| {
        let spec = specification(ends);
        let pair = pair.map(|value| Rational::from_f64(value).unwrap());
        let about = (proof, Scope::First);
        transfer::check(&Data::new(&spec, 256), pair.each_ref(), about, "/witness/transfer").is_ok()
    };
    let inverse = |low: f64| (2.0 * std::f64::consts::PI / (0.5 * low)).powi(2);
    let tail = (std::f64::consts::PI.powi(2) - 4.0) / 2.0;
    for ends in [[0.8, 1.25], [0.4, 1.0], [1.0, 1.5]] {
        let inverse = inverse(ends[0]);
        let closed = [tail + f64::max((inverse + 1.0) / 2.0, 6.0), 8.0 * (inverse + (4.0 + 1.0_f64 / 3.0).powi(2))];
        for (proof, least) in
            [(Proof::ClosedForm, closed), (Proof::Matched(3), [inverse / 2.0, 2.0 * inverse - inverse / 2.0])]
        {
            let scaled = |of_0: f64, of_1: f64| [least[0] * (1.0 + of_0), least[1] * (1.0 + of_1)];
            assert!(check(ends, scaled(1e-9, 1e-9), &proof), "{ends:?} {proof:?}");
            assert!(!check(ends, scaled(-1e-9, 1e-9), &proof), "{ends:?} {proof:?}");
            assert!(!check(ends, scaled(1e-9, -1e-8), &proof), "{ends:?} {proof:?}");
        }
    }
    let boxes = certificate(BOXES);
    let witness = &boxes["witness"];
    let proof = read(&witness["transfer"], Proof::read).unwrap();
    // mu = 1 there, twice that of `specification`.
    let pair = ["k0", "k1"].map(|name| decimal(witness[name].as_str().unwrap()).unwrap().to_f64());
    let large = pair.map(|value| 4.0 * value);
    assert!(check([1.0, 1.5], large, &proof) && !check([0.9, 1.0], large, &proof));
}

/// C5B and E4 say that a form of e and y is definite, or not negative, for every b.
#[test]
fn the_forms_without_a_slope() {
    let mut draw = drawn(32);
    let mut seen = [0; 4];
    for _ in 0..300 {
        let ends = GAINS[(draw() * 6.0) as usize];
        let spec = specification(ends);
        let d = Data::new(&spec, 128);
        let (k_p, sigma, share) = ((4.0 * draw() - 2.0).exp(), (4.0 * draw() - 2.0).exp(), draw());
        let c_y = share * k_p;
        let least = |corner: f64| {
            let of_b = |i: i32| {
                let side = 1.0 + k_p / 2.0 * (1.0 - between(ends, f64::from(i) / 64.0)) * sigma;
                2.0 * sigma * corner - side * side
            };
            (0..=64).map(of_b).fold(f64::INFINITY, f64::min)
        };
        let text = |value: f64| format!("{value:.17e}");
        // h = k_p mu/2.
        let part = json!({ "X": "9", "E": "9", "rate": "1", "sigma": text(sigma) });
        let weights = [&Rational::from(1), &decimal(&text(k_p / 4.0)).unwrap()];
        let inequality = read(&part, |field| Inequality::read(field, Kind::Matrix, weights, None)).unwrap();
        let (zero, one) = (d.int(0), d.int(1));
        let paths = Paths { f: Path::Straight, q: Path::Straight };
        let error_box = ErrorBox::new(&d, paths, [&zero, &zero], [&one, &one]);
        let conditions =
            inequality.conditions(&d, (paths, [&zero, &zero], &error_box), (&Rational::from(100), "sigma"));
        let of = |id: &str, conditions: &[Condition]| conditions.iter().find(|one| one.id == id).unwrap().truth();
        assert_eq!(of("C5B", &conditions), Some(least(k_p) > 0.0), "{ends:?} {k_p} {sigma}");
        let part = json!({
            "X": "9", "E": "9", "P": [["1"]], "k_p": text(k_p), "c_x": "1", "c_y": text(c_y), "sigma": text(sigma),
        });
        let existence = read(&part, |field| Inequality::read(field, Kind::Existence, weights, None)).unwrap();
        let conditions = existence.enough(&d, (&Rational::from(100), "sigma"));
        let ids: Vec<&str> = conditions.iter().map(|condition| condition.id).collect();
        assert_eq!(ids, ["E3", "E4"]);
        assert_eq!(of("E4", &conditions), Some(least(k_p - c_y) >= 0.0), "{ends:?} {k_p} {c_y} {sigma}");
        seen[usize::from(least(k_p) > 0.0)] += 1;
        seen[2 + usize::from(least(k_p - c_y) >= 0.0)] += 1;
        // What is said of rms(e) has e in it alone through y.
        let answer = existence.answer(&d, &Rational::from(100), &one);
        assert!(!answer.rms_e.is_defined() && answer.rms_y.is_defined() && answer.rms_x.is_defined());
    }
    assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
}

/// The form of (M) at a threshold tau holds, with L, at every larger sigma; and so does that of (E), with what it leaves.
#[test]
fn a_threshold_serves_every_larger_gain() {
    let mut draw = drawn(33);
    let mut cases = [0; 2];
    while cases.iter().any(|count| *count < 300) {
        let ends = GAINS[(draw() * 6.0) as usize];
        let (k_p, tau) = ((4.0 * draw() - 2.0).exp(), (4.0 * draw() - 2.0).exp());
        let mut slope = || 2.0 * draw() - 1.0;
        let (j, g, r, d) = (-1.0 - slope().abs(), slope(), slope(), 2.0 * slope());
        let (rate, c_x, c_y) = (0.01, 0.01, 0.3 * k_p * slope().abs());
        let form = |b: f64, [sigma, k_p]: [f64; 2], [of_x, of_y]: [f64; 2]| {
            let side = -1.0 - k_p / 2.0 * (d + (1.0 - b) * sigma);
            [-2.0 * j - of_x, -g, -k_p / 2.0 * r, 2.0 * sigma, side, k_p - of_y]
        };
        let all = |holds: &dyn Fn(f64) -> bool| (0..=4).all(|i| holds(between(ends, f64::from(i) / 4.0)));
        let of_both = |holds: &dyn Fn(f64) -> bool| ends.into_iter().all(holds);
        let left = |b: f64, corner: f64| 2.0 * tau * corner - (1.0 + k_p / 2.0 * (1.0 - b) * tau).powi(2);
        for (which, margins) in [[2.0 * rate, 0.0], [c_x, c_y]].into_iter().enumerate() {
            let proved = |b: f64| definite(form(b, [tau, k_p], margins)) && left(b, k_p - margins[1]) > 0.0;
            if !of_both(&proved) {
                continue;
            }
            cases[which] += 1;
            for factor in [1.0, 1.0001, 1.2, 3.0, 50.0, 1e4] {
                let larger = |b: f64| {
                    definite(form(b, [tau * factor, k_p / factor], [margins[0], margins[1] / factor * (1.0 - 1e-9)]))
                };
                assert!(all(&larger), "{which}: {ends:?} {k_p} {tau} {j} {g} {r} {d} {factor}");
            }
        }
    }
}

/// The least sigma with `F >= 0` at both ends, for one state and mu = 1, found by halving; in it
/// `(k b_x^2 - 2 c b_x b_y + a b_y^2)/2 <= sigma (a k - c^2)`.
fn least([a, c, k]: [f64; 3], b_x: f64, of_y: &dyn Fn(f64, f64) -> f64, ends: [f64; 2]) -> f64 {
    let holds = |sigma: f64| {
        ends.into_iter().all(|b| {
            let b_y = of_y(b, sigma);
            (k * b_x * b_x - 2.0 * c * b_x * b_y + a * b_y * b_y) / 2.0 <= sigma * (a * k - c * c)
        })
    };
    let start = (1..4000).map(|i| f64::from(i) / 100.0).find(|sigma| holds(*sigma)).expect("there is one");
    let (mut low, mut high) = (start - 0.01, start);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if holds(middle) { high = middle } else { low = middle }
    }
    high
}

fn with_gain(parts: Parts, ends: [f64; 2]) -> Parts {
    // The nominal gain divides.
    let gain = json!({ "nominal": "2", "low": (2.0 * ends[0]).to_string(), "high": (2.0 * ends[1]).to_string() });
    parts.with("/plant/input_gain", gain)
}

/// Accepted a little above the threshold, refused a little below; where b is 1 or one end is, another threshold.
#[test]
fn matrix_inequalities_of_a_linear_plant() {
    let (w_x, h, rate, p) = (0.7, 0.6, 0.001, 1.0);
    let (j, g, r) = (-2.0, 0.3, 0.5);
    for (d, binding) in [(0.5, 0), (-1.5, 0), (-2.5, 1)] {
        let (f, q) = ("-2*x + 3*e/10".to_owned(), format!("x/2 + {d}*e"));
        let of_y = |b: f64, sigma: f64| -1.0 - h * (d + (1.0 - b) * sigma);
        let entries = [-w_x * 2.0 * p * (j + rate), -h * r, 2.0 * h];
        let at = |ends: [f64; 2]| least(entries, -w_x * p * g, &of_y, ends);
        let ends = [0.75, 1.5];
        let own = at(ends);
        let alone = ends.map(|end| at([end; 2]));
        assert!((own / alone[binding] - 1.0).abs() < 1e-6, "{own} {alone:?}");
        let made = |sigma: f64| with_gain(at_rest(&f, &q), ends).inequality(["0.7", "0.6"], ["1", "1"], "0.001", sigma);
        made(1.0001 * own).accepted();
        made(0.9999 * own).refused(Verdict::Invalid, "matrix inequality", "/witness/matrix_inequality");
        // With mu: h/mu in the place of h.
        let made = |sigma: f64| {
            let with = made(sigma).with("/plant/internal_model/mu", json!("1/2"));
            with.with("/inequality/h", json!("0.3"))
        };
        made(1.0001 * own).accepted();
        made(0.9999 * own).refused(Verdict::Invalid, "matrix inequality", "/witness/matrix_inequality");
    }
    // (1-b) sigma grows, and in the end outgrows what sigma gives.
    let large = with_gain(at_rest("-2*x + 3*e/10", "x/2"), [0.5, 1.0]);
    large.clone().inequality(["0.7", "0.6"], ["1", "1"], "0.001", 3.0).accepted();
    let large = large.inequality(["0.7", "0.6"], ["1", "1"], "0.001", 300.0);
    large.refused(Verdict::Invalid, "matrix inequality", "/witness/matrix_inequality");
}

#[test]
fn existence_inequalities_of_a_linear_plant() {
    let (p, k_p, c_x, c_y) = (0.7, 0.6, 0.1, 0.2);
    let (j, g, r) = (-2.0, 0.3, 0.5);
    for (d, binding) in [(0.5, 0), (-6.0, 1)] {
        let (f, q) = ("-2*x + 3*e/10".to_owned(), format!("x/2 + {d}*e"));
        let of_y = |b: f64, sigma: f64| -1.0 - k_p / 2.0 * (d + (1.0 - b) * sigma);
        let entries = [-2.0 * p * j - c_x, -k_p / 2.0 * r, k_p - c_y];
        let at = |ends: [f64; 2]| least(entries, -p * g, &of_y, ends);
        let ends = [0.875, 1.25];
        let own = at(ends);
        let alone = ends.map(|end| at([end; 2]));
        assert!((own / alone[binding] - 1.0).abs() < 1e-6, "{own} {alone:?}");
        let made = |sigma: f64| {
            let [p, k_p, c_x, c_y] = [p, k_p, c_x, c_y].map(|value| value.to_string());
            let part = json!({
                "X": "1", "E": "1", "P": [[p]], "k_p": k_p, "c_x": c_x, "c_y": c_y, "sigma": format!("{sigma:.12}"),
            });
            with_gain(at_rest(&f, &q), ends).with("/existence", part)
        };
        made(1.0001 * own).accepted();
        made(0.9999 * own).refused(Verdict::Invalid, "existence inequality", "/witness/existence_inequality");
    }
}
