//! Numbers by the number of oscillators of a plant that is linear in x and e, with a law at samples (docs/mathematics.md, section 14.6): of drawn loops,
//! against a simulation of the law.

use super::by_n_o_plants::made;
use crate::by_n_o_held::{Law, numbers};
use crate::by_n_o_support::{Loop, Numbers};
use crate::common::every;
use proofs_check::verdict::Outcome;
use proofs_check::verdict::Verdict::{BadInput, Invalid, Undecided};
use serde_json::{Value, json};

const RULE: &str = "by n_o";

/// A loop with a law: of every second case there is a delay.
fn drawn(case: u64) -> (Loop, Law) {
    let mut of = made(case, case as usize % 3);
    let samples = [8, 12, 20, 50][case as usize % 4];
    // h sigma below 1/2, and K h Nb2 well below what a delay allows.
    of.sigma = of.sigma.min(0.45 * samples as f64);
    // Those with one state have a family and a gain in an interval.
    (of.factor, of.gain) = if case % 3 == 1 { ([0.97, 1.03], [0.95, 1.05]) } else { ([1.0; 2], [1.0; 2]) };
    let delayed = case % 2 == 1;
    let gain = of.mu.min(0.04 * samples as f64);
    (of, Law { samples, gain, delayed })
}

fn place(which: usize) -> String {
    match which {
        5 => "/witness/by_n_o/linear/sizes/0/y".to_owned(),
        _ => Numbers::place(which),
    }
}

/// What is said of bounds times some factors.
fn judged(of: &Loop, law: &Law, entry: &Value, (form, bounds, factors): (&Value, &[f64; 6], [f64; 6])) -> Outcome<()> {
    let terms = law.terms(of, bounds[5] * factors[5]);
    of.judged_at_samples(form, entry, &numbers(bounds, factors), &terms).map(|_| ())
}

/// What lies between samples is bounded with some room.
const ROOM: [f64; 6] = [1.02, 1.02, 1.003, 1.003, 1.003, 1.003];

/// The bounds are accepted with little room, refused where one is 1 % too small, and no solution that is simulated exceeds one.
#[test]
fn bounds_of_drawn_loops() {
    let stride = every(5);
    let mut close = [0.0_f64; 6];
    for case in (0..25).step_by(stride) {
        let (of, law) = drawn(case);
        let form = law.written(&of, law.found(&of));
        for (own, entry) in [
            (vec![0], json!({ "n_o": 0 })),
            (vec![0, 1], json!({ "n_o": 1 })),
            (vec![0, 2], json!({ "harmonics": [0, 2] })),
        ] {
            let (bounds, between) = law.bounds(&of, &own);
            let judge = |factors: [f64; 6]| judged(&of, &law, &entry, (&form, &bounds, factors));
            if let Err(finding) = judge(ROOM) {
                panic!("case {case}, {entry}, {bounds:?}, {between}: {finding:?}");
            }
            for which in (0..6).filter(|which| bounds[*which] > 1e-9) {
                let mut factors = ROOM;
                factors[which] = 0.99;
                let finding = judge(factors).expect_err("it is too small");
                assert!(finding.rule == RULE && finding.pointer == place(which), "case {case}, {entry}: {finding:?}");
                // What is a bound alone is not refuted, and of |e| little is known where the samples are few.
                let refuted = matches!(which, 2 | 3) || which == 0 && between < 0.005 * bounds[0];
                if refuted || matches!(which, 1 | 4 | 5) {
                    let verdict = if refuted { Invalid } else { Undecided };
                    assert_eq!(finding.verdict, verdict, "case {case}, {entry}, {which}: {finding:?}");
                }
            }
            // What the values at the samples say is not enough.
            let mut factors = ROOM;
            factors[0] = (bounds[0] - between) / bounds[0];
            if factors[0] < 0.99 {
                assert_eq!(judge(factors).unwrap_err().pointer, place(0), "case {case}, {entry}");
            }
            for member in [[of.factor[0], of.gain[1]], [of.factor[1], of.gain[0]]] {
                let seen = law.largest(&of, &own, member);
                for (which, (seen, bound)) in seen.iter().zip(&bounds).enumerate() {
                    if (law.delayed || which < 5) && *bound > 1e-9 {
                        assert!(*seen <= bound * (1.0 + 1e-6), "case {case}, {entry}, {which}: {seen} {bound}");
                        close[which] = close[which].max(seen / bound);
                    }
                }
            }
        }
    }
    assert!(close.iter().all(|close| *close > 0.9), "{close:?}");
}

/// Where all harmonics of the plant have an oscillator, e vanishes at the samples; between them it does not.
#[test]
fn what_is_left_between_samples() {
    for case in [2, 3, 5, 8] {
        let (of, law) = drawn(case);
        let form = law.written(&of, law.found(&of));
        let last = of.q_0.len();
        let own: Vec<usize> = (0..=last).collect();
        let (bounds, between) = law.bounds(&of, &own);
        assert!((bounds[0] / between - 1.0).abs() < 1e-6, "{bounds:?}, {between}");
        let with = |entry: Value, factors: [f64; 6]| judged(&of, &law, &entry, (&form, &bounds, factors));
        for entry in [json!({ "n_o": last }), json!({ "n_o": last, "or_more": true })] {
            with(entry.clone(), ROOM).unwrap();
            for which in (0..5).filter(|which| bounds[*which] > 1e-9) {
                let mut factors = ROOM;
                factors[which] = 0.98;
                assert_eq!(with(entry.clone(), factors).unwrap_err().pointer, place(which), "case {case}");
            }
        }
        // Of the largest number that the samples tell apart it holds, and of one fewer than the harmonics it is not said.
        let most = (law.samples - 1) / 2;
        with(json!({ "n_o": most }), ROOM).unwrap();
        let finding = with(json!({ "n_o": last - 1, "or_more": true }), [1e3; 6]).unwrap_err();
        assert_eq!((finding.verdict, finding.pointer.as_str()), (Undecided, "/claim/by_n_o/0/or_more"));
        for entry in [json!({ "n_o": most + 1 }), json!({ "harmonics": [0, most + 1] })] {
            let name = if entry.get("n_o").is_some() { "n_o" } else { "harmonics" };
            let finding = with(entry, [1e3; 6]).unwrap_err();
            assert_eq!((finding.verdict, finding.rule), (Invalid, RULE), "{finding:?}");
            assert_eq!(finding.pointer, format!("/claim/by_n_o/0/{name}"));
        }
    }
}

/// In a wide family what is left between samples shows with little room in small boxes alone, and a number below it in none.
#[test]
fn what_is_left_between_samples_in_a_wide_family() {
    for case in [1, 4, 7] {
        let (mut of, law) = drawn(case);
        (of.factor, of.gain) = ([0.1, 2.5], [0.6, 1.4]);
        let form = law.written(&of, law.found(&of));
        let last = of.q_0.len();
        let (bounds, between) = law.bounds(&of, &(0..=last).collect::<Vec<_>>());
        assert!((bounds[0] / between - 1.0).abs() < 1e-6, "{bounds:?}, {between}");
        let with =
            |of_e: f64| judged(&of, &law, &json!({ "n_o": last }), (&form, &bounds, [of_e, 2.0, 2.0, 2.0, 2.0, 2.0]));
        assert!(with(ROOM[0]).is_ok(), "case {case}: {:?}", with(ROOM[0]));
        let finding = with(0.98).unwrap_err();
        assert_eq!((finding.verdict, finding.pointer), (Undecided, place(0)), "case {case}");
    }
}

/// The forms that a search finds fall, by the form as section 14.6 writes it; where it is not definite they are refused, and K counts and not mu.
#[test]
fn forms_that_do_not_fall() {
    let stride = every(2);
    for case in (0..12).step_by(stride) {
        let (of, law) = drawn(case);
        let found = law.found(&of);
        let bounds = [1e9; 6];
        let judge = |law: &Law, numbers: [f64; 4]| {
            judged(&of, law, &json!({ "n_o": 0 }), (&law.written(&of, numbers), &bounds, [1.0; 6]))
        };
        judge(&law, found).unwrap();
        let mut seen = 0;
        let count = if law.delayed { 4 } else { 3 };
        for (which, factor) in
            (0..count).flat_map(|which| [0.01, 0.3, 0.7, 1.5, 4.0, 100.0].map(|factor| (which, factor)))
        {
            let mut numbers = found;
            numbers[which] *= factor;
            let least = law.least(&of, numbers);
            let answer = judge(&law, numbers);
            if least.abs() > 1e-6 {
                assert_eq!(answer.is_ok(), least > 0.0, "case {case}, {which} times {factor}, {least}: {answer:?}");
            }
            if let Err(finding) = answer {
                seen += 1;
                assert!(finding.pointer.starts_with("/witness/by_n_o/linear/forms/0"), "{finding:?}");
            }
        }
        assert!(seen > 0, "case {case}: {seen}");
        // A gain that leaves less of theta, and samples that are further apart.
        for other in [Law { gain: law.gain * 9.0, ..law.clone() }, Law { samples: law.samples / 3, ..law.clone() }] {
            if other.least(&of, found) < -1e-6 {
                assert!(judge(&other, found).is_err(), "case {case}");
            }
        }
    }
}

/// With too few samples for the forcing nothing is proved.
#[test]
fn harmonics_that_samples_do_not_tell_apart() {
    let (of, _) = drawn(4);
    let last = of.q_0.len();
    let slow = Law { samples: 2 * last, gain: 0.01, delayed: false };
    let mut calm = of.clone();
    (calm.sigma, calm.d, calm.c[0]) = (1.0, -0.1, 0.01);
    let form = slow.written(&calm, slow.found(&calm));
    let judge = |law: &Law| judged(&calm, law, &json!({ "n_o": 0 }), (&form, &[1e9; 6], [1.0; 6]));
    let finding = judge(&slow).unwrap_err();
    assert_eq!((finding.verdict, finding.rule, finding.pointer.as_str()), (Undecided, RULE, "/plant"), "{finding:?}");
    judge(&Law { samples: 2 * last + 1, ..slow.clone() }).unwrap();
}

/// A form and sizes at samples have fields of their own, which there are none of in continuous time.
#[test]
fn fields_of_the_witness() {
    for case in [2, 3] {
        let (of, law) = drawn(case);
        let form = law.written(&of, law.found(&of));
        let (entry, numbers) = (json!({ "n_o": 0 }), Numbers::large());
        let judge = |form: &Value, law: &Law, y: f64| of.judged_at_samples(form, &entry, &numbers, &law.terms(&of, y));
        judge(&form, &law, 1e9).unwrap();
        let names = if law.delayed { &["lambda", "gm", "k_p", "w"][..] } else { &["lambda", "k_p", "w"] };
        for name in names {
            let mut changed = form.clone();
            changed.as_object_mut().unwrap().remove(*name);
            let finding = judge(&changed, &law, 1e9).unwrap_err();
            assert_eq!((finding.verdict, finding.rule), (BadInput, "format"), "{name}");
            for value in ["0", "-1"] {
                changed[*name] = value.into();
                let finding = judge(&changed, &law, 1e9).unwrap_err();
                assert_eq!((finding.verdict, finding.rule), (Invalid, "signs"), "{name}");
                assert_eq!(finding.pointer, format!("/witness/by_n_o/linear/forms/0/{name}"));
            }
        }
        // g_m and y with a delay, and without it neither.
        let other = Law { delayed: !law.delayed, ..law.clone() };
        let finding = judge(&form, &other, 1e9).unwrap_err();
        assert_eq!((finding.verdict, finding.rule), (BadInput, "format"), "{finding:?}");
        let mut terms = law.terms(&of, 1e9);
        terms.y = if law.delayed { None } else { Some(1.0) };
        let finding = of.judged_at_samples(&form, &entry, &numbers, &terms).unwrap_err();
        assert_eq!((finding.verdict, finding.rule), (BadInput, "format"), "{finding:?}");
        if law.delayed {
            let finding = judge(&form, &law, -1.0).unwrap_err();
            assert_eq!((finding.verdict, finding.pointer.as_str()), (Invalid, "/witness/by_n_o/linear/sizes/0/y"));
        }
        // In continuous time they are not known.
        let finding = of.judged(&form, 0, false, &numbers).unwrap_err();
        assert_eq!((finding.verdict, finding.rule), (BadInput, "format"), "{finding:?}");
    }
}
