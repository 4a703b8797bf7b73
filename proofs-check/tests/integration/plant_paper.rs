//! The paper's example from its formulas: bounds with little room, and what it takes to decide them.

use super::plant_support::{Parts, judged, stored};
use crate::common::every;
use proofs_check::verdict::Verdict;

#[test]
fn the_bounds_of_the_example_are_decided() {
    let parts = stored("paper-example");
    let lines = judged(&parts).expect("they are true, with 0.3 % of room");
    // Eighteen bounds, and the rate in the tube. A tenth of what an answer may take is far more than is needed.
    assert_eq!(lines.iter().filter(|line| line.starts_with("bounds of the plant: ")).count(), 18);
    let steps = lines.last().and_then(|line| line.strip_suffix(" steps")).and_then(|steps| steps.parse::<u64>().ok());
    assert!(steps.is_some_and(|steps| steps < proofs_check::effort::LIMIT / 10), "{lines:#?}");
}

#[test]
fn bounds_just_below_the_suprema_are_not_accepted() {
    let parts = Parts(stored("paper-example"));
    let count = parts.0["witness"]["bounds"].as_array().map_or(0, Vec::len);
    for index in (0..count).step_by(2 * every(4)) {
        let at = format!("/witness/bounds/{index}");
        let mut entry = parts.0.pointer(&at).unwrap().clone();
        // The room is 0.3 % of the supremum: 0.4 % less is below it.
        let factor = if entry["bound"] == "rate" { 1.004 } else { 0.996 };
        let value = entry["value"].as_str().unwrap().parse::<f64>().unwrap() * factor;
        entry["value"] = format!("{value:.9}").into();
        let alone = parts.clone().with("/witness/bounds", serde_json::json!([entry]));
        // So little below it may stay open.
        let (verdict, rule) = alone.verdict();
        assert!(verdict != Verdict::Valid && rule == "bounds of the plant", "{}", alone.0["witness"]["bounds"]);
    }
}
