//! Claims about every finite set of harmonics in continuous time: what proves their transfer bound, and what says so in the claim (section 14.7).

use crate::common::*;
use proofs_check::data::Data;
use proofs_check::json::{Field, parse};
use proofs_check::rules::transfer::{self, Proof};
use proofs_check::rules::{every_set, mean_squares};
use proofs_check::scope::Scope;
use proofs_check::spec::Specification;
use proofs_check::verdict::Verdict::{BadInput, Invalid, Undecided, Valid};
use rug::Rational;
use serde_json::{Value, json};
use std::f64::consts::PI;

const TRANSFER: &str = "transfer bound";
const OSCILLATORS: &str = "oscillators";
const EVERY: &str = "every finite set that contains 0";
const ASKED: &str = "/specification/internal_model/harmonics";
const CLAIMED: &str = "/claim/harmonics";

/// A certificate with another claim, or another specification.
fn made(name: &str, changes: &[(&str, Value)]) -> Value {
    let mut made = edited(certificate(name), changes);
    rehash(&mut made);
    made
}

#[test]
fn the_sentence_of_a_claim_about_every_set() {
    for name in [PAPER, "paper-example.closed-form", "harmonics.means", "explicit-weights.sharp", "no-x.sharp"] {
        let own = certificate(name);
        let report = accepted(&made(name, &[(CLAIMED, EVERY.into())]));
        let first = "For every number of oscillators n_o >= 0 and every gain";
        let words = "For oscillators at every finite set of harmonics that contains 0 (so for every number of oscillators n_o >= 0) and every gain";
        assert_eq!(said(&report), said(&judged(&own)).replacen(first, words, 1));
        assert!(said(&report).starts_with(words));
    }
}

#[test]
fn the_file_may_ask_for_it_or_against_it() {
    for (asked, claimed, verdict, rule, pointer) in [
        (Value::Null, Value::Null, Valid, "", ""),
        (Value::Null, EVERY.into(), Valid, "", ""),
        ("first".into(), Value::Null, Valid, "", ""),
        ("first".into(), EVERY.into(), Invalid, OSCILLATORS, CLAIMED),
        ("every-set".into(), Value::Null, Invalid, OSCILLATORS, "/claim"),
        ("every-set".into(), EVERY.into(), Valid, "", ""),
        ("every".into(), EVERY.into(), BadInput, "format", ASKED),
        (json!(true), EVERY.into(), BadInput, "format", ASKED),
        (json!([0, 1]), EVERY.into(), BadInput, "format", ASKED),
        (Value::Null, "every set below samples/2 that contains 0".into(), Invalid, OSCILLATORS, CLAIMED),
        (Value::Null, "every finite set".into(), Invalid, OSCILLATORS, CLAIMED),
        (Value::Null, "".into(), Invalid, OSCILLATORS, CLAIMED),
        (Value::Null, json!([0, 1]), BadInput, "format", CLAIMED),
    ] {
        let report = judged(&made(PAPER, &[(ASKED, asked.clone()), (CLAIMED, claimed.clone())]));
        if verdict == Valid {
            assert_valid(&report);
        } else {
            assert_refused(&report, verdict, rule, pointer);
        }
    }
}

/// Nothing is said of every set for every period of an interval, by the closed form neither.
#[test]
fn a_period_that_is_an_interval() {
    let own = parsed("periods", "motor-axis");
    assert_eq!(own["witness"]["transfer"]["proof"], json!("closed-form"));
    let with = |changes: &[(&str, Value)]| {
        let mut made = edited(own.clone(), changes);
        rehash(&mut made);
        judged(&made)
    };
    let asked = "/plant/internal_model/harmonics";
    assert_refused(&with(&[(asked, "every-set".into()), (CLAIMED, EVERY.into())]), BadInput, "format", asked);
    assert_valid(&with(&[(asked, "first".into())]));
    assert_refused(&with(&[(CLAIMED, EVERY.into())]), Invalid, OSCILLATORS, CLAIMED);
}

#[test]
fn boxes_are_about_the_first_harmonics() {
    let claimed = [(CLAIMED, EVERY.into())];
    assert_refused(&judged(&made(BOXES, &claimed)), Invalid, TRANSFER, "/witness/transfer");
    // The closed form is about every frequency.
    let unmatched = [
        (CLAIMED, EVERY.into()),
        ("/specification/internal_model/matched", json!(false)),
        ("/witness/exact_regulation", Value::Null),
    ];
    accepted(&made("paper-example.closed-form", &unmatched));
    assert_refused(&judged(&made(BOXES, &unmatched)), Invalid, TRANSFER, "/witness/transfer");
    assert_refused(&judged(&made(PAPER, &unmatched)), Invalid, TRANSFER, "/witness/transfer");
}

/// That of the paper with other weights of the power family and nu, and perhaps an input gain.
fn document(n_0: &str, epsilon: &str, nu: f64) -> Value {
    let mut document = certificate(PAPER)["specification"].clone();
    let model = &mut document["internal_model"];
    model["weights"] = json!({ "family": "power", "n0": n_0, "epsilon": epsilon });
    // w is 2 pi.
    model["mu"] = format!("{}", Rational::from_f64(nu * 2.0 * PI).unwrap()).into();
    document
}

fn read(document: &Value) -> Specification {
    let [document, witness] = [document.to_string(), "{}".to_owned()].map(|text| parse(text.as_bytes()).unwrap());
    let field = |json| Field { json, pointer: String::new() };
    Specification::read(&field(&document), &mut field(&witness).fields().unwrap()).unwrap()
}

fn specification(n_0: &str, epsilon: &str, nu: f64) -> Specification {
    read(&document(n_0, epsilon, nu))
}

/// The power family in doubles.
#[derive(Clone, Copy)]
struct Weights(f64, f64);

impl Weights {
    fn n(self, l: usize) -> f64 {
        if l == 0 { self.0 } else { (l as f64).powf(-1.0 - self.1) }
    }

    /// g_H(k) and g_H'(k) of a set without k, pole by pole.
    fn sums(self, set: &[usize], k: usize) -> [f64; 2] {
        let poles = set.iter().flat_map(|l| {
            let (of, n) = (*l as f64, self.n(*l));
            if *l == 0 { vec![(0.0, n)] } else { vec![(of, n / 2.0), (-of, n / 2.0)] }
        });
        poles.fold([0.0; 2], |[g, slope], (l, c)| {
            let apart = l - k as f64;
            [g + c / apart, slope + c / (apart * apart)]
        })
    }

    /// `n_k s_k/2 - max{gamma_k, 0}^2`, from so many terms and what is beyond them.
    fn room(self, k: usize) -> f64 {
        let (most, own) = (4 * k + 64, k as f64);
        let all: Vec<usize> = (0..=most).filter(|l| *l != k).collect();
        let above: Vec<usize> = (k + 1..=most).collect();
        let (last, beyond) = (self.n(most + 1), (most - k) as f64);
        let slope = self.sums(&all, k)[1] + last / beyond;
        let pull = self.n(0) / own - self.sums(&above, k)[0] - last * own / (beyond + 1.0);
        self.n(k) * slope / 2.0 - pull.max(0.0).powi(2)
    }

    /// `T_H(k)`.
    fn transfer(self, set: &[usize], k: usize, nu: f64) -> f64 {
        let [g, slope] = self.sums(set, k);
        slope / (1.0 + (nu * g).powi(2))
    }
}

/// Of a family whose first weights are hardly different: up to this nu (14.7b) holds, and no further.
fn largest(weights: Weights) -> f64 {
    let most = (1..200).map(|k| weights.room(k)).fold(0.0, f64::max);
    most.sqrt().recip()
}

const FLAT: (&str, &str, Weights) = ("1.01", "0.01", Weights(1.01, 0.01));

#[test]
fn the_rule_is_that_of_the_section() {
    let (n_0, epsilon, weights) = FLAT;
    let largest = largest(weights);
    assert!((2.0..4.0).contains(&largest), "{largest}");
    let holds = |nu: f64| every_set::holds(&Data::new(&specification(n_0, epsilon, nu), 128));
    assert!(holds(largest * (1.0 - 1e-9)) && !holds(largest * (1.0 + 1e-9)), "{largest}");
    assert!(!holds(2.0 * largest) && !holds(20.0) && holds(0.1));
    // Each of its numbers.
    let spec = specification(n_0, epsilon, 1.5);
    let steps = every_set::steps(&Data::new(&spec, 128)).unwrap();
    let count = steps.len();
    assert!(count > 3);
    for (place, (what, lhs, _)) in steps.iter().enumerate().take(count - 1) {
        let expected = 1.5_f64.powi(2) * weights.room(place + 1);
        assert!((lhs.to_f64() - expected).abs() < 1e-12, "{what}: {expected}");
    }
    // The last one is about every k from the first K with (14.7c).
    let total = (1..2_000_000).map(|l| weights.n(l)).sum::<f64>() + 2_000_000_f64.powf(-0.01) / 0.01 + weights.n(0);
    let settled = |k: usize| {
        let near = 4.0 * total / (k * k) as f64;
        1.5_f64.powi(2) * weights.n(k) / 2.0 * (near + PI * PI / 6.0 * weights.n(k / 2 + 1))
    };
    assert!(settled(count) <= 1.0 && settled(count - 1) > 1.0, "{count}");
    let (what, lhs, _) = &steps[count - 1];
    assert!(what.starts_with(&format!("every k >= {count}:")), "{what}");
    assert!((lhs.to_f64() - settled(count)).abs() < 1e-5 * settled(count), "{what}");
}

/// Where it holds `T_H(k) <= 2/(nu^2 n_k)` of every set that is drawn; where it does not, some sets have more, though no first n_o has.
#[test]
fn what_it_says_of_sets() {
    let (_, _, weights) = FLAT;
    let most = largest(weights);
    let bound = |k: usize, nu: f64| 2.0 / (nu * nu * weights.n(k));
    let ratio = |set: &[usize], nu: f64| {
        let of = |k: usize| weights.transfer(set, k, nu) / bound(k, nu);
        (1..30).filter(|k| !set.contains(k)).map(of).fold(0.0, f64::max)
    };
    for case in 0..2000 {
        let mut draw = drawn(case);
        let share = draw();
        let set: Vec<usize> = (0..60).filter(|l| *l == 0 || draw() < share).collect();
        assert!(ratio(&set, most) <= 1.0 && ratio(&set, most * draw()) <= 1.0, "{set:?}");
    }
    let gap: Vec<usize> = (0..200).filter(|l| *l == 0 || *l > 2).collect();
    assert!(ratio(&gap, 6.0) > 1.0, "{}", ratio(&gap, 6.0));
    for n_o in 0..29 {
        assert!(ratio(&(0..=n_o).collect::<Vec<_>>(), 6.0) <= 1.0);
    }
}

#[test]
fn a_matched_pair_needs_it() {
    let (n_0, epsilon, weights) = FLAT;
    let check = |document: &Value, scope| {
        let (spec, proof) = (read(document), Proof::Matched(1));
        let d = Data::new(&spec, 128);
        // 1/(nu^2 n_0) and 2/(nu^2 n_1), and a little more.
        let pair = [&d.n_0, &(&d.n_1 / 2)].map(|n| ((d.nu.sqr() * n).recip() * 2).upper().unwrap());
        let answer = transfer::check(&d, pair.each_ref(), (&proof, scope), "/witness/transfer");
        answer.map(drop).map_err(|finding| (finding.verdict, finding.message))
    };
    let at = |nu: f64| document(n_0, epsilon, nu);
    let largest = largest(weights);
    for nu in [0.5 * largest, largest * (1.0 - 1e-9), largest * (1.0 + 1e-9), 6.0] {
        assert_eq!(check(&at(nu), Scope::First), Ok(()));
        let answer = check(&at(nu), Scope::EverySet);
        if nu < largest {
            assert_eq!(answer, Ok(()));
        } else {
            let (verdict, message) = answer.unwrap_err();
            assert!(verdict == Invalid && message.contains("nu^2 (n_k s_k/2 - max{gamma_k, 0}^2) <= 1"), "{message}");
        }
    }
    // With an input gain nu is that of the least gain.
    let with_gain = |nu: f64| {
        let mut document = at(nu);
        document["input_gain"] = json!({ "nominal": "1", "low": "0.5", "high": "2" });
        check(&document, Scope::EverySet).is_ok()
    };
    assert!(with_gain(2.0 * largest * (1.0 - 1e-9)) && !with_gain(2.0 * largest * (1.0 + 1e-9)));
    // No K is seen where nu is very large.
    let (verdict, message) = check(&document("2", "1/2", 1e9), Scope::EverySet).unwrap_err();
    assert!(verdict == Undecided && message.contains("4096"), "{message}");
}

/// `2/(nu^2 n_k)` in the form with `q_0` is proved of every set by (14.7b), also where the pair is proved by the closed form.
#[test]
fn poles_of_the_form_with_harmonics() {
    let with_q_0 = |nu: f64, matched: bool| {
        let mut document = document(FLAT.0, FLAT.1, nu);
        document["q_0"] = json!({ "harmonics": ["1", "1", "1/2"], "rest_rms": "0", "rest_t_rms": "0" });
        document["bounds"]["q_tx"] = "1".into();
        document["bounds"]["q_te"] = "1".into();
        document["internal_model"]["matched"] = matched.into();
        read(&document)
    };
    let largest = largest(FLAT.2);
    for (nu, matched, closed_form, at_poles, of_first) in [
        (largest * (1.0 - 1e-9), true, true, true, true),
        (largest * (1.0 + 1e-9), true, true, false, true),
        (largest * (1.0 + 1e-9), true, false, true, true),
        (0.5, false, true, false, false),
    ] {
        let spec = with_q_0(nu, matched);
        let (d, proof) = (Data::new(&spec, 128), if closed_form { Proof::ClosedForm } else { Proof::Matched(1) });
        assert_eq!(transfer::at_poles(&d, &proof, Scope::EverySet), at_poles, "{nu}");
        assert_eq!(transfer::at_poles(&d, &proof, Scope::First), of_first, "{nu}");
        // What it is worth.
        let pair = transfer::closed_form(&d);
        let w = mean_squares::Witness {
            r: [(); 3].map(|()| Rational::from((1, 1_000_000))),
            kap: Rational::new(),
            refined: None,
        };
        let size = |at_poles: bool| {
            let pair = ([&pair[0], &pair[1]], at_poles);
            let sizes = [d.ratio(1, 1000), d.ratio(1, 1000)];
            let kappa = proofs_check::rules::gains::kappas(&d, pair.0[0], pair.0[1]);
            let solution = mean_squares::evaluate(&d, (&w, None), &Rational::from(40), sizes.each_ref(), pair, &kappa);
            solution.z_squared.to_f64()
        };
        assert!(size(true) < size(false), "{} {}", size(true), size(false));
    }
}
