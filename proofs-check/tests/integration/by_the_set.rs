//! Entries of `by_n_o` about one set of harmonics (docs/mathematics.md, section 14.7): of plants that are linear in x and e, and by trials.

use super::by_n_o_plants::made;
use super::trials_gain::of_gain;
use super::trials_x_first::{GROWING, along, level};
use crate::by_n_o_support::Numbers;
use crate::common::*;
use crate::rates::refused;
use crate::trials_support::{Case, FORMULAS, asks_for_a_tube_inside, asks_for_every_number, expected, peaks, text};
use proofs_check::verdict::Verdict::{BadInput, Invalid, Undecided};
use serde_json::{Value, json};

const RULE: &str = "by n_o";
const CLAIM: &str = "/claim/by_n_o";
const SETS: [&[usize]; 5] = [&[0, 2], &[0, 3], &[0, 1, 3], &[0, 2, 3, 7], &[0, 50]];

/// Of a loop with oscillators at the harmonics of a set, solved apart, the exact answers are accepted with 1 % room, and refused where one is 1 % too small.
#[test]
fn answers_of_drawn_loops() {
    let stride = every(3);
    let mut others = 0;
    for case in (0..30).step_by(stride) {
        let of = made(case, case as usize % 3);
        let form = of.form();
        for own in [SETS[case as usize % 5], SETS[(case as usize + 2) % 5]] {
            let exact = of.largest_of(own);
            let judged = |factors: [f64; 5]| of.judged_of_set(&form, own, &exact.times(factors));
            if let Err(finding) = judged([1.01; 5]) {
                panic!("case {case}, {own:?}: {finding:?}");
            }
            for which in (0..5).filter(|which| exact.all()[*which] > 1e-12) {
                let mut factors = [1.01; 5];
                factors[which] = 0.99;
                let finding = judged(factors).expect_err("it is too small");
                let verdict = if which == 4 { Undecided } else { Invalid };
                assert_eq!((finding.verdict, finding.rule), (verdict, RULE), "case {case}, {own:?}: {finding:?}");
                assert_eq!(finding.pointer, Numbers::place(which), "case {case}, {own:?}");
            }
            // Of as many oscillators, or up to the same harmonic, something is less.
            for n_o in [own.len() - 1, *own.last().unwrap()] {
                let other = of.largest(n_o).times([1.01; 5]);
                if other.all().iter().zip(exact.all()).any(|(other, own)| own > 1e-9 && *other < 0.97 * own) {
                    assert!(of.judged_of_set(&form, own, &other).is_err(), "case {case}, {own:?}, n_o = {n_o}");
                    others += 1;
                }
            }
            let [bound, largest] = of.oscillators_of(own, 1.0, 1.0);
            assert!(largest <= bound * (1.0 + 1e-9), "case {case}, {own:?}: {largest} > {bound}");
        }
    }
    assert!(others * stride >= 30, "{others}");
}

/// No error is left where all harmonics of the plant are in the set, and only there.
#[test]
fn all_harmonics_of_the_plant() {
    // Three harmonics.
    let of = made(2, 1);
    let form = of.form();
    for (own, vanishes) in [
        (&[0, 1, 2, 3][..], true),
        (&[0, 1, 2, 3, 9], true),
        (&[0, 1, 2], false),
        (&[0, 2, 3], false),
        (&[0, 1, 3, 4], false),
    ] {
        let exact = of.largest_of(own);
        let without = exact.times([0.0, 0.0, 1.01, 0.0, 1.01]);
        let judged = of.judged_of_set(&form, own, &without);
        assert_eq!(judged.is_ok(), vanishes, "{own:?}: {judged:?}");
        assert_eq!(exact.all()[0] < 1e-9, vanishes, "{own:?}");
    }
}

/// With defects of a size that counts.
fn coarse(own: &[usize], mu: f64) -> Case {
    Case::of_set(own, mu, FORMULAS).trial("/defect_x", "1e-3").trial("/defect_q", "2e-3")
}

#[test]
fn the_solution_itself_is_a_trial() {
    for own in SETS {
        let case = Case::of_set(own, 1.0, FORMULAS);
        case.accepted();
        case.steady_alone().accepted();
        // Of another mu it is none.
        case.part("/plant/internal_model/mu", "1.001").refused(Invalid, "/defect_q");
    }
    let case = Case::of_set(&[0, 2], 1.0, FORMULAS);
    // One more where the trial's e is not zero, and one fewer where the regulator does not put out what it has.
    for own in [json!([0, 1, 2]), json!([0, 2, 3])] {
        case.entry("/harmonics", own).refused(Invalid, "/e");
    }
    for own in [json!([0]), json!([0, 4])] {
        case.entry("/harmonics", own).refused(Invalid, "/defect_q");
    }
    // One that nothing has.
    case.entry("/harmonics", json!([0, 2, 4])).refused(Invalid, "/defect_q");
    // Any size of a harmonic that has an oscillator.
    for part in ["cos", "sin"] {
        case.trial(&format!("/e/harmonics/1/{part}"), "1e-30").refused(Invalid, "/e");
    }
}

#[test]
fn every_number_of_the_claim_is_bounded() {
    for (own, mu) in [(SETS[0], 1.0), (SETS[1], 0.3), (SETS[2], 1.0), (SETS[3], 4.0), (SETS[4], 1.0), (&[0, 2], 12.0)] {
        let case = coarse(own, mu);
        asks_for_every_number(&case);
        asks_for_a_tube_inside(&case.steady_alone());
    }
}

/// `kappa_H` has the sum of the weights for the harmonics without an oscillator: the numbers with what stands there for the first n_o are too small.
#[test]
fn kappa_of_the_first_harmonics_is_not_that_of_a_set() {
    let case = coarse(&[0, 2], 12.0);
    let of_set = expected(&case);
    let mut first = case.clone();
    first.entry.as_object_mut().unwrap().remove("harmonics");
    let of_first = expected(&first);
    for (at, own, other) in [
        ("/steady/u", of_set.steady[2], of_first.steady[2]),
        ("/largest/u", of_set.largest[1], of_first.largest[1]),
        ("/largest/e", of_set.largest[0], of_first.largest[0]),
    ] {
        assert!(other < own * (1.0 - 1e-6), "{at}: {other} {own}");
        case.entry(at, text((own + other) / 2.0)).refused(Invalid, &format!(":/claim/by_n_o/0{at}"));
    }
}

/// With a gain in an interval `Nbar_H^2/Omega^2` is not over `b_lo^2`, what the poles have is.
#[test]
fn a_gain_in_an_interval() {
    for (own, mu) in [(&[0, 1, 2, 3][..], 20.0), (&[0, 1, 2, 3, 8], 1.0), (&[0, 1, 2, 3, 60], 9.0)] {
        let case = of_gain(&Case::of_set(own, mu, FORMULAS), 3);
        let expected = expected(&case);
        for (at, number) in [
            ("/steady/e", expected.steady[0]),
            ("/steady/u", expected.steady[2] / 4.0),
            ("/largest/e", expected.largest[0]),
            ("/largest/u", expected.largest[1] / 4.0),
        ] {
            case.entry(at, text(number * (1.0 + 1e-7))).accepted();
            case.entry(at, text(number * (1.0 - 1e-7))).refused(Invalid, &format!(":/claim/by_n_o/0{at}"));
        }
    }
}

/// Along x first, where nothing else says which solution it is, with the sum of the weights of the set.
#[test]
fn along_x_first() {
    for own in [SETS[0], SETS[2]] {
        let case = Case::of_set(own, 1.0, GROWING).trial("/defect_x", "1e-3").trial("/defect_q", "2e-3");
        let case = along(&Case { error_box: ["0.1", "0.1"].map(str::to_owned), ..case });
        let bounds = peaks(&case, level(&case), [1.0, 0.4]);
        for (at, number) in [("/largest/e", bounds[0]), ("/largest/u", bounds[1])] {
            case.entry(at, text(number * (1.0 + 1e-7))).accepted();
            case.entry(at, text(number * (1.0 - 1e-7))).refused(Invalid, &format!(":/claim/by_n_o/0{at}"));
        }
    }
}

/// A stored certificate whose claim is about every set, with these entries after its own, each with what proves that of another entry.
fn with_sets(name: &str, sets: &[(Value, usize)]) -> Value {
    let mut made = parsed("by-n-o", name);
    made["claim"]["harmonics"] = "every finite set that contains 0".into();
    for (set, from) in sets {
        let mut entry = made["claim"]["by_n_o"][from].clone();
        ["n_o", "or_more"].iter().for_each(|name| drop(entry.as_object_mut().unwrap().remove(*name)));
        entry["harmonics"] = set.clone();
        made["claim"]["by_n_o"].as_array_mut().unwrap().push(entry);
        for list in ["linear/sizes", "trials"] {
            if let Some(Value::Array(list)) = made.pointer_mut(&format!("/witness/by_n_o/{list}")) {
                list.push(list[*from].clone());
            }
        }
    }
    made
}

#[test]
fn sets_in_a_certificate() {
    let sets = [(json!([0]), 0), (json!([0, 1]), 1), (json!([0, 1, 2]), 2), (json!([0, 1, 2, 100]), 2)];
    let made = with_sets("family-gain", &sets);
    let report = accepted(&made);
    let u = made["claim"]["by_n_o"][6]["steady"]["u"].as_str().unwrap();
    let sentence = format!(
        " With oscillators at the harmonics 0, 1, 2, 100 and sigma = 0.185552 exactly, |e| <= 0 (root mean square <= 0) and |u/2| <= {u} along the \
         T-periodic solution, and |e| <= "
    );
    assert!(said(&report).contains(&sentence), "{}", said(&report));
    let line = "by n_o: oscillators at the harmonics 0, 1: |e| <= ";
    assert!(report.lines.iter().any(|found| found.starts_with(line)), "{:?}", report.lines);
    assert_words_are_ignored(&made, "With oscillators at no harmonic the error is 0.");
    // The second harmonic of the plant has none of these oscillators.
    let missing = with_sets("family-gain", &[(json!([0, 1, 3]), 2)]);
    refused(missing, Invalid, RULE, "/claim/by_n_o/3/steady/e");
    // The numbers of fewer.
    refused(with_sets("family-gain", &[(json!([0]), 1)]), Invalid, RULE, "/claim/by_n_o/3");

    // Trials; the last of them is of two or more, and has what one of a set does not have.
    let made = with_sets("trials", &[(json!([0, 1]), 1)]);
    let report = accepted(&made);
    assert!(said(&report).contains(" With oscillators at the harmonics 0, 1 and sigma = 3 exactly, |e| <= "));
    let line = "by n_o: oscillators at the harmonics 0, 1: the periodic solution near the trial, by ";
    assert!(report.lines.iter().any(|found| found.starts_with(line)), "{:?}", report.lines);
    refused(with_sets("trials", &[(json!([0, 1]), 2)]), BadInput, "format", "/witness/by_n_o/trials/3");
    refused(with_sets("trials", &[(json!([0, 2]), 1)]), Invalid, RULE, "/witness/by_n_o/trials/3");
}

#[test]
fn entries_have_a_form() {
    let place = format!("{CLAIM}/3/harmonics");
    for (set, at) in [
        (json!([]), ""),
        (json!(2), ""),
        (json!("0, 1"), ""),
        (json!([1, 2]), "/0"),
        (json!([2, 1, 0]), "/0"),
        (json!([0, 2, 1]), "/2"),
        (json!([0, 1, 1]), "/2"),
        (json!([0, 101]), "/1"),
        (json!([0, -1]), "/1"),
        (json!([0, "1"]), "/1"),
        (json!([0, 1.5]), "/1"),
        (json!((0..102).collect::<Vec<_>>()), ""),
    ] {
        refused(with_sets("family-gain", &[(set, 2)]), BadInput, "format", &format!("{place}{at}"));
    }
    // Each set once, also where it is not the one before; a set is not an n_o.
    let twice = [(json!([0, 1]), 1), (json!([0]), 0), (json!([0, 1]), 1)];
    refused(with_sets("family-gain", &twice), BadInput, "format", "/claim/by_n_o/5/harmonics");
    let made = with_sets("family-gain", &[(json!([0, 1]), 1)]);
    accepted(&made);
    for (field, value) in [("n_o", json!(1)), ("or_more", json!(true))] {
        let both = edited(made.clone(), &[(format!("{CLAIM}/3/{field}"), value)]);
        refused(both, BadInput, "format", &format!("{CLAIM}/3/{field}"));
    }
    refused(deleted(&made, &place), BadInput, "format", &format!("{CLAIM}/3"));
    // After those with n_o.
    let mut between = made.clone();
    between["claim"]["by_n_o"].as_array_mut().unwrap().swap(2, 3);
    refused(between, BadInput, "format", "/claim/by_n_o/3/n_o");
    // More than one with `or_more`, or not the last one.
    refused(
        edited(made.clone(), &[("/claim/by_n_o/1/or_more", json!(true))]),
        BadInput,
        "format",
        "/claim/by_n_o/1/or_more",
    );
    // Only of a claim about every set.
    refused(deleted(&made, "/claim/harmonics"), BadInput, "format", &place);
    let words = edited(made.clone(), &[("/claim/harmonics", json!("every set"))]);
    refused(words, Invalid, "oscillators", "/claim/harmonics");
    // One for each.
    refused(deleted(&made, "/witness/by_n_o/linear/sizes/3"), BadInput, "format", "/witness/by_n_o/linear/sizes");
    // Sets alone.
    let mut alone = made;
    for list in ["/claim/by_n_o", "/witness/by_n_o/linear/sizes"] {
        drop(alone.pointer_mut(list).unwrap().as_array_mut().unwrap().drain(..3));
    }
    accepted(&alone);
    // Together no more than 64.
    let many: Vec<(Value, usize)> = (1..63).map(|k| (json!([0, 1, 2, 3 + k]), 2)).collect();
    refused(with_sets("family-gain", &many), BadInput, "format", CLAIM);
}
