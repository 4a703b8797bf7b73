//! Claims about every set of harmonics at samples: (14.7a) in the place of s_j, and nothing by (S3) (section 14.7).

use super::sampled_formulas::{Float, close, laws, rational, with_law};
use crate::common::*;
use crate::sampled_support as of;
use proofs_check::rules::sampled::gains::Gains;
use proofs_check::rules::sampled::transfer::{self, Pair};
use proofs_check::scope::Scope;
use proofs_check::verdict::Verdict::{BadInput, Invalid};
use rug::Rational;
use serde_json::{Value, json};
use std::f64::consts::PI;

const EVERY: &str = "every set below samples/2 that contains 0";
const CLAIMED: &str = "/claim/harmonics";
const ASKED: &str = "/specification/internal_model/harmonics";

fn claimed(made: Value) -> Value {
    edited(made, &[(CLAIMED, EVERY.into())])
}

/// That of the paper with a gain that is large enough without (S3), too.
fn roomy() -> Value {
    edited(of::made(), &[("/claim/sigma", json!("61"))])
}

#[test]
fn what_rests_on_the_first_harmonics_is_refused() {
    for name in ["harmonics-at-rest", "jacobian", "motor-axis", "no-x", "paper-example", "plant-motor-axis", "rms"] {
        let made = parsed("sampled", name);
        accepted(&made);
        let report = judged(&claimed(made));
        assert_eq!(report.verdict, Invalid, "{name}");
        assert_eq!(open(&report).first().map(String::as_str), Some("S2"), "{name}");
    }
    // With an input gain, and with a delay, there is no (S3).
    for name in ["gain", "gain-family", "gain-inequalities", "paper-example-delay"] {
        accepted(&claimed(parsed("sampled", name)));
    }
}

#[test]
fn the_sentence_and_the_fields() {
    let with = |changes: &[(&str, Value)]| of::answer(roomy(), changes);
    let report = with(&[(CLAIMED, EVERY.into()), (ASKED, "every-set".into())]);
    let words = "for oscillators at every set of harmonics below 200/2 that contains 0 (so for every number of oscillators n_o < 200/2) and \
                 every phase of the sampling grid, with period";
    assert!(said(&report).contains(words), "{}", said(&report));
    let first = "for every number of oscillators n_o < 200/2 and every phase of the sampling grid, with period";
    assert_eq!(said(&report).replacen(words, first, 1), said(&with(&[])));
    assert_valid(&with(&[(CLAIMED, EVERY.into())]));
    assert_valid(&with(&[(ASKED, "first".into())]));
    let every = || Value::from(EVERY);
    for (asked, claimed, verdict, rule, pointer) in [
        ("first".into(), every(), Invalid, "oscillators", CLAIMED),
        ("every-set".into(), Value::Null, Invalid, "oscillators", "/claim"),
        ("every".into(), every(), BadInput, "format", ASKED),
        (Value::Null, "every finite set that contains 0".into(), Invalid, "oscillators", CLAIMED),
        (Value::Null, "every set below 200/2 that contains 0".into(), Invalid, "oscillators", CLAIMED),
    ] {
        assert_refused(&with(&[(ASKED, asked), (CLAIMED, claimed)]), verdict, rule, pointer);
    }
}

fn weight(l: u32) -> f64 {
    if l == 0 { 2.0 } else { f64::from(l).powf(-1.5) }
}

fn angle(float: &Float) -> f64 {
    PI / f64::from(float.samples)
}

/// The poles of a set, each with its share.
fn poles(set: &[u32]) -> impl Iterator<Item = (f64, f64)> {
    let of = |l: &u32| match l {
        0 => vec![(0.0, weight(0))],
        l => [1.0, -1.0].map(|sign| (sign * f64::from(*l), weight(*l) / 2.0)).to_vec(),
    };
    set.iter().flat_map(of)
}

/// `(wh/2)^2 sum c_l/sin^2((j-l) wh/2)` over the poles of a set without j.
fn sum(float: &Float, set: &[u32], j: u32) -> f64 {
    let x = angle(float);
    poles(set).map(|(l, c)| c * (x / ((f64::from(j) - l) * x).sin()).powi(2)).sum()
}

/// `T_d(j)` at the gain b in the units of `(1 + theta)^2/w^2`.
fn transfer_of(float: &Float, b: f64, set: &[u32], j: u32) -> f64 {
    let (x, gain) = (angle(float), b * float.gain);
    let w = 2.0 * PI / float.period;
    let scale = (w / float.growth).powi(2);
    if set.contains(&j) {
        return scale * 2.0 / (gain * gain * weight(j));
    }
    let loss = gain * float.h / 2.0;
    let kept = 1.0 - loss * poles(set).map(|(_, c)| c).sum::<f64>();
    let turned = loss * poles(set).map(|(l, c)| c / ((f64::from(j) - l) * x).tan()).sum::<f64>();
    let size = sum(float, set, j) * (float.h / 2.0 / x).powi(2);
    scale * size / (kept * kept + turned * turned)
}

fn all_but(float: &Float, j: u32) -> Vec<u32> {
    (0..float.samples.div_ceil(2)).filter(|l| *l != j).collect()
}

fn of_every_set() -> impl Iterator<Item = Float> {
    laws().into_iter().map(|float| Float { scope: Scope::EverySet, ..float })
}

/// Whether a pair is accepted.
fn accepts(float: &Float, pair: [f64; 2]) -> bool {
    let [k0, k1] = pair.map(rational);
    let mut answer = false;
    with_law(float, |law| answer = transfer::check(law, &k0, &k1, "").is_ok());
    answer
}

#[test]
fn the_pair_bounds_the_transfer_of_every_set() {
    let mut differ = 0;
    for (case, float) in of_every_set().step_by(every(4)).enumerate() {
        let (last, w) = (float.samples / 2, 2.0 * PI / float.period);
        let nu = float.least_mu() / w;
        let demanded = |j: u32| sum(&float, &all_but(&float, j), j).max(2.0 / (nu * nu * weight(j)));
        // Sets of every density, and those that leave j alone out.
        let mut draw = drawn(case as u64);
        for _ in 0..20 {
            let share = draw();
            let set: Vec<u32> = (0..float.samples.div_ceil(2)).filter(|l| *l == 0 || draw() < share).collect();
            for j in 1..=last {
                for set in [set.clone(), all_but(&float, j)] {
                    let truth = float.gains().map(|b| transfer_of(&float, b, &set, j)).fold(0.0, f64::max);
                    assert!(truth <= demanded(j) * (1.0 + 1e-9), "{set:?}, j = {j}: {truth}, {float:?}");
                }
            }
        }
        let speed = |j: u32| (float.frequency(j) / w).powi(2);
        let first = |j: u32| sum(&float, &(0..j).collect::<Vec<_>>(), j).max(2.0 / (nu * nu * weight(j)));
        let least = 1.0 / (nu * nu * 2.0);
        for k0 in [1.000_001, 1.7].map(|factor| least * factor) {
            let slope =
                |demanded: &dyn Fn(u32) -> f64| (1..=last).map(|j| (demanded(j) - k0) / speed(j)).fold(0.0, f64::max);
            let k1 = slope(&demanded);
            assert!(accepts(&float, [k0, k1 * (1.0 + 1e-9)]), "{float:?}");
            assert!(k1 == 0.0 || !accepts(&float, [k0, k1 * (1.0 - 1e-6)]), "{float:?}");
            // The least pair of the first harmonics, where that is another one.
            let of_first = slope(&first) * (1.0 + 1e-9);
            if of_first < k1 * (1.0 - 1e-6) {
                differ += 1;
                assert!(accepts(&Float { scope: Scope::First, ..float }, [k0, of_first]), "{float:?}");
                assert!(!accepts(&float, [k0, of_first]), "{float:?}");
            }
        }
    }
    assert!(differ > 10, "{differ}");
}

/// Each s_j, and the bounds of blocks of them.
#[test]
fn sums_and_blocks() {
    for samples in [2, 3, 10, 31, 64, 200] {
        let float = Float { scope: Scope::EverySet, ..Float::new(1.0, 1.0, samples, 0.5) };
        with_law(&float, |law| {
            let pair = Pair::new(law, &Rational::from(1), &Rational::from(1));
            let last = samples / 2;
            let sums: Vec<f64> = (1..=last).map(|j| sum(&float, &all_but(&float, j), j)).collect();
            (1..=last).for_each(|j| close("s_j", &pair.sum(j), sums[j as usize - 1], &float));
            for first in 1..=last {
                let mut most: f64 = 0.0;
                for end in first..=last {
                    most = most.max(sums[end as usize - 1]);
                    let bounds = pair.beyond(first, end).map(|bound| bound.lo().to_f64());
                    assert!(bounds.iter().all(|bound| *bound >= most), "{first} to {end}: {most}, {bounds:?}");
                }
            }
        });
    }
}

/// Without (S3) each harmonic of y is at most 1 + theta times that of q.
#[test]
fn gains_of_every_set() {
    for float in of_every_set().filter(|float| float.ends == [1.0; 2]) {
        with_law(&float, |law| {
            let gains = Gains::new(law);
            let all = |of: &dyn Fn(u32) -> f64| (1..float.samples).map(of).sum::<f64>().sqrt() * float.growth;
            let size = |j: u32| float.sigma.powi(2) + float.a * float.frequency(j).powi(2);
            close("bt", &gains.sup, all(&|j| 1.0 / size(j)), &float);
            close("tau", &gains.sup_t, all(&|j| 1.0 / (size(j) * float.frequency(j).powi(2))), &float);
            close("rms", &gains.rms, float.growth / size(1).sqrt(), &float);
            close("rms_t", &gains.rms_t, float.growth / size(1).sqrt() / float.frequency(1), &float);
        });
    }
}

/// As many samples as there may be, where some harmonics have to be looked at by themselves: a few terms do, or all are added where they do not.
#[test]
fn many_samples() {
    let float = Float { scope: Scope::EverySet, ..Float::new(1.0, 100.0, 65_536, 0.1) };
    let limit = proofs_check::effort::LIMIT;
    let answer = |pair| proofs_check::effort::limited(limit, || accepts(&float, pair));
    let largest = (1..100).map(|j| sum(&float, &all_but(&float, j), j)).fold(0.0, f64::max);
    let (accepted, steps) = answer([largest * (1.0 + 1e-3), 0.01]);
    assert!(accepted && steps < limit / 20, "{steps}");
    let (accepted, steps) = answer([largest * (1.0 + 1e-7), 0.01]);
    assert!(accepted && steps < limit, "{steps}");
    // It is that of the first harmonic, whose room is k0 + k1, and the terms beyond the first few are worth 4e-7.
    assert!(largest == sum(&float, &all_but(&float, 1), 1));
    let (accepted, steps) = answer([largest - 1e-8 - 0.01, 0.01]);
    assert!(!accepted && steps < limit, "{steps}");
}
