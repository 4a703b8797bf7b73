//! Forged certificates: each breaks exactly the condition that it is named after.

use crate::common::{folder, names, text};
use proofs_check::check;
use proofs_check::verdict::Verdict;

/// C1b has no forged certificate of its own: C3 implies (c/alpha) b_fxx X_p < 1, so whoever breaks C1b breaks C3.
const CONDITIONS: [&str; 24] = [
    "sharp-set",
    "sharp-domain",
    "sharp-T",
    "sharp-C1",
    "sharp-C2",
    "sharp-C3",
    "sharp-C3b",
    "sharp-C4",
    "sharp-C5",
    "sharp-C5b",
    "repaired-set",
    "repaired-domain",
    "repaired-T",
    "repaired-C1",
    "repaired-C2",
    "repaired-C3",
    "repaired-C3b",
    "repaired-C4",
    "repaired-C5",
    "repaired-C5b",
    "regulation-C4",
    "regulation-C5b",
    "lmi",
    "lyapunov",
];

#[test]
fn every_condition_has_a_forged_certificate() {
    for condition in CONDITIONS {
        let forged = |name: &String| *name == condition || name.starts_with(&format!("{condition}-"));
        assert!(names("forged").iter().any(forged), "{condition} in {}", folder("forged").display());
    }
}

#[test]
fn each_is_refused_for_that_condition_alone() {
    for name in names("forged").iter().filter(|name| kind(name).is_none()) {
        let report = check(text("forged", name).as_bytes());
        assert_eq!(report.verdict, Verdict::Invalid, "{name}");
        let id = name.split('-').nth(1).unwrap();
        let finding = report.finding.as_ref().unwrap();
        assert!(finding.message.contains(&format!(": {id}, ")), "{name}: {}", finding.message);
        assert!(finding.sides.is_some(), "{name}: both sides and the gap");
        for line in report.lines.iter().filter(|line| line.contains(" FAILS: ")) {
            assert!(line.trim_start().starts_with(&format!("{id} ")), "{name} also breaks {line}");
        }
        // Where C5 fails, the threshold of C5b has no meaning; nothing else may be left open.
        for line in report.lines.iter().filter(|line| line.contains(" undecided: ")) {
            assert!(id == "C5" && line.trim_start().starts_with("C5b "), "{name}: {line}");
        }
    }
}

/// The rule and the field of forged certificates that break no comparison.
fn kind(name: &str) -> Option<(&'static str, &'static str)> {
    match name.split('-').next() {
        Some("boxes") => Some(("transfer bound", "/witness/transfer")),
        // The claim rests on the closed form of C5, and stands; the second proof is a figure.
        Some("lmi") => Some(("matrix inequality of C5", "/witness/lmi")),
        Some("lyapunov") => Some(("Lyapunov triple", "/witness/lyapunov")),
        _ => None,
    }
}

#[test]
fn forged_boxes_multipliers_and_triples_are_not_accepted() {
    let mut seen = 0;
    for name in names("forged") {
        let Some((rule, pointer)) = kind(&name) else { continue };
        let report = check(text("forged", &name).as_bytes());
        let finding = match report.proved {
            Some(proved) if name.starts_with("lmi-") && proved.figures.findings.len() == 1 => {
                proved.figures.findings[0].clone()
            }
            _ => report.finding.expect("refused"),
        };
        // A box that is too coarse is not proved; that refutes nothing.
        let verdict = if name == "boxes-coarse" { Verdict::Undecided } else { Verdict::Invalid };
        assert_eq!((finding.rule, finding.verdict), (rule, verdict), "{name}: {}", finding.message);
        assert!(finding.pointer.starts_with(pointer), "{name}: {}", finding.pointer);
        seen += 1;
    }
    assert_eq!(seen, 14);
}
