//! A certificate with trials (docs/mathematics.md, sections 14.4 and 14.5): one entry with what is said of the periodic solution alone, one with the
//! peaks besides, and one about so many oscillators or more. Its plant has a state, a domain, and an input gain that is known.

use super::plant_mutations::mutate;
use crate::common::{accepted, assert_words_are_ignored, deleted, edited, every, parsed};
use crate::rates::refused;
use proofs_check::json::decimal;
use proofs_check::verdict::Verdict::{BadInput, Invalid};
use serde_json::{Value, json};

const RULE: &str = "by n_o";
const CLAIM: &str = "/claim/by_n_o";
const TRIALS: &str = "/witness/by_n_o/trials";

fn stored() -> Value {
    parsed("by-n-o", "trials")
}

#[test]
fn a_stored_one_is_accepted() {
    let stored = stored();
    let report = accepted(&stored);
    let statement = &report.subject.as_ref().unwrap().statement;
    let [e, u] = ["/1/largest/e", "/1/largest/u"].map(|at| stored.pointer(&format!("{CLAIM}{at}")).unwrap());
    let peaks = format!("and |e| <= {} and |u/2| <= {} at all times", e.as_str().unwrap(), u.as_str().unwrap());
    assert!(statement.contains(&peaks) && statement.matches("at all times").count() == 2, "{statement}");
    let [e, u] = ["/2/steady/e", "/2/steady/u"].map(|at| stored.pointer(&format!("{CLAIM}{at}")).unwrap());
    let (e, u) = (e.as_str().unwrap(), u.as_str().unwrap());
    assert!(statement.contains(&format!("With every n_o >= 2 and sigma = 3 exactly, |e| <= {e} (")), "{statement}");
    assert!(statement.contains(&format!("and |u/2| <= {u} along the T-periodic solution, and")), "{statement}");
    for about in ["n_o = 0", "n_o = 1", "every n_o >= 2"] {
        let line = format!("by n_o: {about}: the periodic solution near the trial, by ");
        assert!(report.lines.iter().any(|found| found.starts_with(&line)), "{:?}", report.lines);
    }
    assert_words_are_ignored(&stored, "With one oscillator the error is 0.");
}

/// The error of the periodic solution is known to five digits and more, what rests on forms to the two that were given.
#[test]
fn smaller_numbers_are_refused() {
    for (at, factor) in [
        ("/0/steady/e", 0.99999),
        ("/0/steady/e_rms", 0.99999),
        ("/0/steady/u", 0.99999),
        ("/1/steady/e", 0.99999),
        ("/1/steady/e_rms", 0.99999),
        ("/1/steady/u", 0.99999),
        ("/1/largest/e", 0.98),
        ("/1/largest/u", 0.98),
        ("/2/steady/e", 0.9999),
        ("/2/steady/e_rms", 0.9999),
        ("/2/steady/u", 0.9999),
        ("/2/largest/e", 0.9999),
        ("/2/largest/u", 0.9999),
    ] {
        let place = format!("{CLAIM}{at}");
        let number = decimal(stored().pointer(&place).unwrap().as_str().unwrap()).unwrap().to_f64();
        refused(edited(stored(), &[(&place, format!("{:e}", number * factor).into())]), Invalid, RULE, &place);
    }
}

#[test]
fn each_entry_has_its_own_trial() {
    let trials = stored().pointer(TRIALS).unwrap().clone();
    let place = |at: &str| format!("{TRIALS}/{at}");
    let last = &trials[2];
    refused(edited(stored(), &[(TRIALS, json!([trials[1], trials[0], last]))]), Invalid, RULE, &place("1/e"));
    // That of one oscillator answers another q without it: kappa counts in the control.
    let of_u = format!("{CLAIM}/0/steady/u");
    refused(edited(stored(), &[(TRIALS, json!([trials[1], trials[1], last]))]), Invalid, RULE, &of_u);
    for list in
        [json!([]), json!([trials[0]]), json!([trials[0], trials[1]]), json!([trials[0], trials[1], last, last])]
    {
        refused(edited(stored(), &[(TRIALS, list)]), BadInput, "format", TRIALS);
    }
    refused(deleted(&stored(), "/witness/by_n_o"), BadInput, "format", "/witness/by_n_o");
    refused(deleted(&stored(), CLAIM), BadInput, "format", "/witness/by_n_o");
    refused(deleted(&stored(), TRIALS), BadInput, "format", "/witness/by_n_o");
    let linear = parsed("by-n-o", "family-gain").pointer("/witness/by_n_o/linear").unwrap().clone();
    let mut both = stored();
    both["witness"]["by_n_o"]["linear"] = linear;
    refused(both, BadInput, "format", &format!("{CLAIM}/0"));
}

/// That of the last number is one of every larger number, with k0 and k1 as the claim proves them.
#[test]
fn so_many_oscillators_or_more() {
    let last = |at: &str| format!("{TRIALS}/2/{at}");
    for (name, value) in [("defect_q_t", "0.00001866"), ("f_x", "1.9219"), ("f_e", "0.4999"), ("defect_q", "9.902e-7")]
    {
        let at = last(name);
        refused(edited(stored(), &[(&at, value.into())]), Invalid, RULE, &at);
    }
    // It is one alone, too, but not of one oscillator or more: it has a harmonic that one would answer.
    let [entry, trial] = [CLAIM, TRIALS].map(|list| json!([stored().pointer(&format!("{list}/2")).unwrap()]));
    let alone = edited(stored(), &[(CLAIM, entry), (TRIALS, trial)]);
    accepted(&alone);
    refused(edited(alone, &[(&format!("{CLAIM}/0/n_o"), 1.into())]), Invalid, RULE, &format!("{TRIALS}/0/u"));
    // No entry comes after it.
    let mut before = stored();
    before["claim"]["by_n_o"][1]["or_more"] = true.into();
    refused(before, BadInput, "format", &format!("{CLAIM}/1/or_more"));
    refused(deleted(&stored(), &format!("{CLAIM}/2/or_more")), BadInput, "format", &last("defect_q_t"));
    // A smaller k1 is not proved.
    refused(edited(stored(), &[("/witness/k1", "47".into())]), Invalid, "transfer bound", "/witness/transfer");
}

/// The error box of the claim is that of its witness: the two periodic solutions have to be in it together.
#[test]
fn the_error_box_is_that_of_the_claim() {
    let of = |name: &str| decimal(stored()["claim"]["periodic_solution"][name].as_str().unwrap()).unwrap().to_f64();
    let [x, e] = ["x", "e"].map(of);
    // Larger bounds of the periodic solution are true, too, and say less.
    let with = |x: f64, e: f64| {
        let places = [("/claim/periodic_solution/x", x), ("/claim/periodic_solution/e", e)];
        places.iter().fold(stored(), |all, (at, size)| edited(all, &[(at, format!("{size:e}").into())]))
    };
    accepted(&with(x + 0.01, e + 0.01));
    // Where solutions from the set may leave the box of the trial nothing else says which solution it is.
    let small = |x: f64, e: f64| edited(with(x, e), &[(&format!("{TRIALS}/0/box/e"), "0.05".into())]);
    accepted(&small(x + 0.01, e + 0.01));
    for claim in [small(1.0, e), small(x, 1.0)] {
        refused(claim, Invalid, RULE, &format!("{TRIALS}/0"));
    }
    accepted(&with(1.0, e));
}

/// The example of the paper, whose solutions from the set leave the boxes of their trials: with `x_first`, of one oscillator and of eight or more.
#[test]
fn one_along_x_first() {
    let stored = || parsed("by-n-o", "x-first");
    accepted(&stored());
    let number = |at: &str| decimal(stored().pointer(at).unwrap().as_str().unwrap()).unwrap().to_f64();
    let scaled = |at: &str, factor: f64| edited(stored(), &[(at, format!("{:e}", number(at) * factor).into())]);
    for entry in 0..2 {
        for name in ["largest/e", "largest/u"] {
            let at = format!("{CLAIM}/{entry}/{name}");
            refused(scaled(&at, 0.99999), Invalid, RULE, &at);
        }
        let first = format!("{TRIALS}/{entry}/x_first");
        // Without it the function of the claim says less.
        refused(deleted(&stored(), &first), Invalid, RULE, &format!("{CLAIM}/{entry}/largest/e"));
        for (name, factor) in
            [("box/x", 0.9), ("box/e", 0.9), ("E", 1e6), ("forms/1/P_up", 0.99), ("forms/0/x_low", 1.01)]
        {
            let at = format!("{first}/{name}");
            refused(scaled(&at, factor), Invalid, RULE, &at);
        }
    }
    let form = format!("{TRIALS}/0/x_first/forms/0");
    for factor in [0.95, 1.02] {
        refused(scaled(&format!("{form}/S/2/2"), factor), Invalid, RULE, &form);
    }
}

#[test]
fn leaves_of_it() {
    mutate("by-n-o/trials", every(23));
    mutate("by-n-o/x-first", every(211));
}
