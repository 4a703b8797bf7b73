//! Factors of rates that rest on how large the periodic solution is by the number of oscillators (docs/mathematics.md, sections 13.6 and 14): stored
//! certificates of a plant that is linear in x and e, and of one with trials.

use crate::common::{accepted, deleted, edited, every, parsed, without};
use crate::rates::{refused, times};
use proofs_check::verdict::Verdict::{self, BadInput, Invalid, Undecided};
use serde_json::{Value, json};

const CLAIM: &str = "/claim/by_n_o";
const WITNESS: &str = "/witness/by_n_o";
const FOR_N_O: &str = "/claim/for_n_o";

fn linear() -> Value {
    parsed("rates", "by-n-o-linear")
}

fn trials() -> Value {
    parsed("rates", "by-n-o-trials")
}

/// The last rate of each is of a number above that of the last entry, which is about more, too.
#[test]
fn stored_ones_are_accepted_and_no_smaller_factor() {
    for stored in [linear(), trials()] {
        accepted(&stored);
        let last = stored["claim"]["by_n_o"].as_array().unwrap().last().unwrap();
        let rates = stored["claim"]["for_n_o"].as_array().unwrap();
        assert!(last["or_more"] == true && rates.last().unwrap()["n_o"].as_u64() > last["n_o"].as_u64());
        for index in 0..rates.len() {
            let place = format!("{FOR_N_O}/{index}/factor");
            let smaller = edited(stored.clone(), &[(&place, times(&stored, &place, 0.99))]);
            refused(smaller, Invalid, "rates", &place);
        }
    }
}

/// Without what is known by n_o starts are as far as the bounds for every number of oscillators say.
#[test]
fn without_what_is_known_the_factor_is_too_small() {
    let factor = format!("{FOR_N_O}/0/factor");
    for stored in [linear(), trials()] {
        refused(without(&stored, [CLAIM, WITNESS]), Invalid, "rates", &factor);
    }
    refused(deleted(&trials(), &format!("{WITNESS}/trials/0/sizes")), Invalid, "rates", &factor);
}

/// What the factors rest on is itself proved.
#[test]
fn sizes_that_are_too_small_are_refused() {
    let small = |stored: &Value, place: &str, factor: f64, verdict: Verdict| {
        refused(edited(stored.clone(), &[(place, times(stored, place, factor))]), verdict, "by n_o", place);
    };
    // With the factor as it is, and with the smaller one that would follow.
    let (linear, trials) = (linear(), trials());
    small(&linear, &format!("{WITNESS}/linear/sizes/0/zeta"), 0.9, Undecided);
    small(&linear, &format!("{WITNESS}/linear/sizes/0/x"), 0.9, Invalid);
    let last = trials["claim"]["by_n_o"].as_array().unwrap().len() - 1;
    for index in (0..=last).step_by(every(last)) {
        for size in ["x", "zeta"] {
            small(&trials, &format!("{WITNESS}/trials/{index}/sizes/{size}"), 0.9, Invalid);
        }
    }
    let smaller = edited(
        trials.clone(),
        &[
            (format!("{WITNESS}/trials/0/sizes/zeta"), json!("0")),
            (format!("{FOR_N_O}/0/factor"), times(&trials, &format!("{FOR_N_O}/0/factor"), 0.95)),
        ],
    );
    refused(smaller, Invalid, "by n_o", &format!("{WITNESS}/trials/0/sizes/zeta"));
}

/// Sizes with another number of oscillators do not serve: without those of n_o = 1 there are none.
#[test]
fn sizes_of_another_number_do_not_serve() {
    let stored = trials();
    let mut other = stored.clone();
    other["claim"]["by_n_o"].as_array_mut().unwrap().remove(1);
    other["witness"]["by_n_o"]["trials"].as_array_mut().unwrap().remove(1);
    refused(other, Invalid, "rates", &format!("{FOR_N_O}/1/factor"));
    // Those of so many or more serve every larger number, and no other if they are about theirs alone.
    let last = stored["claim"]["by_n_o"].as_array().unwrap().len() - 1;
    let mut alone = stored.clone();
    alone["claim"]["by_n_o"][last].as_object_mut().unwrap().remove("or_more");
    for more in ["defect_q_t", "q_tx", "q_te", "f_x", "f_e"] {
        alone["witness"]["by_n_o"]["trials"][last].as_object_mut().unwrap().remove(more).unwrap();
    }
    let above = stored["claim"]["for_n_o"].as_array().unwrap().len() - 1;
    refused(alone, Invalid, "rates", &format!("{FOR_N_O}/{above}/factor"));
}

#[test]
fn sizes_are_read_as_they_are() {
    let sizes = format!("{WITNESS}/trials/0/sizes");
    for (value, place) in [
        (json!({ "x": "1" }), sizes.clone()),
        (json!({ "zeta": "1" }), sizes.clone()),
        (json!([]), sizes.clone()),
        (json!({ "x": "1", "zeta": "1", "y": "1" }), format!("{sizes}/y")),
    ] {
        refused(edited(trials(), &[(&sizes, value)]), BadInput, "format", &place);
    }
    for size in ["x", "zeta"] {
        let place = format!("{sizes}/{size}");
        refused(edited(trials(), &[(&place, json!("-1"))]), BadInput, "format", &place);
    }
}

/// What noise adds rests on them, too: the start counts by its distance from the periodic solution of that n_o. The plant is not linear, and its bounds by n_o
/// are about the loop without noise.
#[test]
fn noise_rests_on_what_is_known_of_that_number() {
    let stored = parsed("by-n-o", "with-noise");
    accepted(&stored);
    let statement = stored["claim"]["statement"].as_str().unwrap();
    let entries = stored["claim"]["by_n_o"].as_array().unwrap().len();
    assert_eq!(statement.matches(" without noise, disturbance and rounding, |e| <=").count(), entries);
    let peak = |index: usize| format!("{FOR_N_O}/{index}/noise/peak");
    for index in [0, 1] {
        refused(
            edited(stored.clone(), &[(peak(index), times(&stored, &peak(index), 0.999))]),
            Invalid,
            "rates",
            &peak(index),
        );
    }
    // With the sizes for every number starts are further away: with factors that allow for that the peak is what is too low.
    let factors = [0, 1].map(|index| (format!("{FOR_N_O}/{index}/factor"), json!("1000")));
    accepted(&edited(stored.clone(), &factors));
    refused(edited(without(&stored, [CLAIM, WITNESS]), &factors), Invalid, "rates", &peak(0));
    let size = format!("{WITNESS}/trials/0/sizes");
    refused(edited(deleted(&stored, &size), &factors), Invalid, "rates", &peak(0));
}
