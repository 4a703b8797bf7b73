//! An independent checker of the certificates of `sigmastar`.
//!
//! It decides a certificate's claim again from the embedded specification and the witness: no search, no solver, no
//! floating point, and not a line of the program that wrote it. One rule a file; every rule names the section of
//! derivation.md (in the repository: docs/mathematics.md) that proves it.

pub mod certificate;
pub mod data;
pub mod exact;
pub mod expr;
pub mod interval;
pub mod json;
pub mod matrix;
pub mod monotone;
pub mod rules;
pub mod sha256;
pub mod spec;
pub mod verdict;
pub mod weights;

use std::io::Read;
use verdict::{Finding, Verdict};

/// The answer about a file.
#[derive(Clone, Debug)]
pub struct Report {
    /// The verdict.
    pub verdict: Verdict,
    /// Why it is not `valid`.
    pub finding: Option<Finding>,
    /// The argument, line by line, as far as it went.
    pub lines: Vec<String>,
}

/// Checks the bytes of a certificate file.
pub fn check(bytes: &[u8]) -> Report {
    let mut lines = Vec::new();
    let result = json::parse(bytes).and_then(|json| certificate::check(&json, &mut lines));
    let finding = result.err().map(|finding| *finding);
    let verdict = finding.as_ref().map_or(Verdict::Valid, |finding| finding.verdict);
    Report { verdict, finding, lines }
}

impl Report {
    /// The report as text; with the argument if `verbose`.
    pub fn text(&self, verbose: bool) -> String {
        let mut text = String::new();
        if verbose {
            self.lines.iter().for_each(|line| text += &format!("{line}\n"));
        }
        text += &format!("{}\n", self.verdict);
        if let Some(finding) = &self.finding {
            text += &format!("  rule:  {}\n  field: {}\n  {}\n", finding.rule, finding.pointer, finding.message);
            if let Some([lhs, rhs, gap]) = &finding.sides {
                text += &format!("  left:  {lhs}\n  right: {rhs}\n  gap:   {gap}\n");
            }
        }
        text
    }

    /// The report as JSON.
    pub fn json(&self) -> serde_json::Value {
        let finding = self.finding.as_ref().map(|finding| {
            let side = |i: usize| finding.sides.as_ref().map(|sides| sides[i].clone());
            serde_json::json!({
                "rule": finding.rule, "field": finding.pointer, "message": finding.message,
                "left": side(0), "right": side(1), "gap": side(2),
            })
        });
        serde_json::json!({
            "format": "sigmastar/check", "version": 1, "verdict": self.verdict.to_string(),
            "finding": finding, "argument": self.lines,
        })
    }
}

/// Reads at most what is accepted, and checks it.
///
/// # Errors
/// A stream that cannot be read.
pub fn check_reader(reader: impl Read) -> std::io::Result<Report> {
    let mut bytes = Vec::new();
    reader.take(json::MAX_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    Ok(check(&bytes))
}
