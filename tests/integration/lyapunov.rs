//! `sigmastar lyapunov`: which triple is chosen among those that a Jacobian admits.

use crate::support::{json, program, specification_text};
use serde_json::Value;

fn number(value: &Value) -> Option<f64> {
    value.as_str()?.parse().ok()
}

/// For a Jordan block the ratio p_up/p_low grows without bound as alpha nears its largest value: the smallest sigma* is in
/// between, and the steps around it are finer than elsewhere.
#[test]
fn rate_is_traded_against_the_ratio() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("spec.json");
    let text = specification_text("paper-example-rms-at-rest");
    let triple = r#"{ "p_low": "1", "p_up": "1.5512", "alpha": "0.58" }"#;
    assert!(text.contains(triple));
    std::fs::write(&file, text.replace(triple, r#"{ "jacobian": [["-1", "3"], ["0", "-1"]] }"#)).expect("written");
    let output = program().args(["lyapunov", file.to_str().expect("a plain name"), "--format", "json"]).output();
    let report = json(&output.expect("it runs").stdout);
    let candidates: Vec<(f64, f64, f64)> = report["candidates_estimates"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|one| {
            let sigma = number(&one["sigma_star"]).unwrap_or(f64::INFINITY);
            (number(&one["alpha"]).expect("alpha"), number(&one["ratio"]).expect("a ratio"), sigma)
        })
        .collect();
    assert!(candidates.windows(2).all(|pair| pair[0].0 >= pair[1].0 && pair[0].1 >= pair[1].1), "{candidates:?}");
    // The figures have three digits, and the proof gives up less than one percent.
    let proved = ["alpha", "p_up"].map(|name| number(&report[name]).expect("a number"));
    let apart = |at: &usize| (candidates[*at].0 / proved[0] - 1.0).abs();
    let chosen = (0..candidates.len()).min_by(|a, b| apart(a).total_cmp(&apart(b))).expect("some");
    let (alpha, ratio, sigma) = candidates[chosen];
    assert!(apart(&chosen) < 0.01 && (proved[1] / ratio - 1.0).abs() < 0.01, "{proved:?} {candidates:?}");
    assert!(candidates.iter().all(|other| other.2 >= sigma), "{proved:?} {candidates:?}");
    assert!(chosen > 0 && chosen + 1 < candidates.len(), "{proved:?} {candidates:?}");
    // Neither neighbour is far in rate or better by more than one percent would be.
    for (beside, _, other) in [candidates[chosen - 1], candidates[chosen + 1]] {
        assert!((beside / alpha - 1.0).abs() < 0.12 && other < 1.02 * sigma, "{candidates:?}");
    }
}
