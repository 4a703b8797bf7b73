//! What a certificate says of each number of oscillators, and what proves it (derivation, 14).

use super::json::{exact, object, rows};
use super::write::with_room;
use crate::certify::{ByCount, CountBounds, CountProof};
use serde_json::{Value, json};
use sigmastar_decide::linear::Falling;

/// The name of both parts.
pub(super) const BY_N_O: &str = "by_n_o";

/// The part of the claim; none where nothing is claimed.
pub(super) fn claimed_counts(found: Option<&ByCount>) -> Option<(&'static str, Value)> {
    let one = |bounds: &CountBounds| {
        let CountBounds { n_o, or_more, steady_error, mean_square, peak_error, control } = bounds;
        let steady = [("e", steady_error), ("e_rms", mean_square), ("u", &control.steady)];
        let largest = [("e", peak_error), ("u", &(&control.steady + &control.transient))];
        let numbers = |numbers: &[(&'static str, &_)]| object(numbers.iter().map(|(name, value)| (*name, with_room(value))));
        let mut part = json!({ "n_o": n_o });
        if *or_more {
            part["or_more"] = true.into();
        }
        (part["steady"], part["largest"]) = (numbers(&steady), numbers(&largest));
        part
    };
    found.filter(|found| found.checked).map(|found| (BY_N_O, found.counts.iter().map(one).collect()))
}

/// The part of the witness.
pub(super) fn count_witness(found: Option<&ByCount>) -> Option<(&'static str, Value)> {
    let CountProof { forms, sizes } = &found.filter(|found| found.checked)?.proof;
    let form = |Falling { matrix, p_up, weight, k_p }: &Falling| {
        object([("P", rows(matrix)), ("p_up", exact(p_up)), ("w", exact(weight)), ("k_p", exact(k_p))])
    };
    let has_states = forms.iter().any(|form| !form.matrix.is_empty());
    let size = |[states, zeta]: &[_; 2]| {
        let states = has_states.then(|| ("x", with_room(states)));
        object(states.into_iter().chain([("zeta", with_room(zeta))]))
    };
    let linear = object([("forms", forms.iter().map(form).collect()), ("sizes", sizes.iter().map(size).collect())]);
    Some((BY_N_O, object([("linear", linear)])))
}
