//! The answer about a file, as text and as JSON. Nothing is decided here.

use crate::subject::Subject;
use proofs_core::verdict::{Finding, Verdict, escaped};

/// The answer about a file.
pub struct Report {
    /// The verdict on the claim.
    pub verdict: Verdict,
    /// Why it is not `valid`.
    pub finding: Option<Finding>,
    /// What a valid certificate is about.
    pub subject: Option<Subject>,
    /// The argument, line by line, as far as it went.
    pub lines: Vec<String>,
    /// The steps that the answer took ([`proofs_core::effort`]).
    pub steps: u64,
}

impl Report {
    /// Whether the claim is proved.
    pub fn is_valid(&self) -> bool {
        self.verdict == Verdict::Valid
    }

    /// The report as text; with the argument if `verbose`.
    pub fn text(&self, verbose: bool) -> String {
        let mut text = String::new();
        if verbose {
            self.lines.iter().for_each(|line| text += &format!("{line}\n"));
        }
        text += &format!("{}\n", self.verdict);
        self.subject.iter().for_each(|subject| text += &subject_text(subject));
        self.finding.iter().for_each(|finding| text += &finding_text(finding));
        text
    }

    /// The report as JSON.
    pub fn json(&self) -> serde_json::Value {
        let mut json = serde_json::json!({
            "format": "sigmastar/check", "version": 1, "verdict": self.verdict.to_string(),
            "finding": self.finding.as_ref().map(finding_json), "argument": self.lines,
        });
        if let (Some(subject), Some(fields)) = (&self.subject, json.as_object_mut()) {
            let free: serde_json::Map<String, serde_json::Value> =
                subject.free_texts.iter().map(|(name, text)| ((*name).to_owned(), text.as_str().into())).collect();
            fields.insert("statement".to_owned(), subject.statement.as_str().into());
            fields.insert("also_proved".to_owned(), subject.also.as_deref().into());
            fields.insert(format!("{}_sha256", subject.about), subject.digest.as_str().into());
            fields.insert("assumed".to_owned(), subject.assumed.clone().into());
            fields.insert("free_texts".to_owned(), free.into());
        }
        json
    }
}

fn subject_text(subject: &Subject) -> String {
    let mut text = format!("  proved:  {}\n", subject.statement);
    subject.also.iter().for_each(|also| text += &format!("  proved:  {also}\n"));
    subject.assumed.iter().for_each(|line| text += &format!("  assumed: {line}\n"));
    text += &format!("  {}: SHA-256 {}\n", subject.about, subject.digest);
    subject.free_texts.iter().for_each(|(name, free)| text += &format!("  {name} (free text): {free}\n"));
    text
}

fn finding_text(finding: &Finding) -> String {
    // Keys and figures of a file stand in them.
    let [pointer, message] = [&finding.pointer, &finding.message].map(|text| escaped(text));
    let mut text = format!("  rule:  {}\n  field: {pointer}\n  {message}\n", finding.rule);
    if let Some([lhs, rhs, gap]) = finding.sides.as_ref().map(|sides| sides.each_ref().map(|side| escaped(side))) {
        text += &format!("  left:  {lhs}\n  right: {rhs}\n  gap:   {gap}\n");
    }
    text
}

fn finding_json(finding: &Finding) -> serde_json::Value {
    let side = |i: usize| finding.sides.as_ref().map(|sides| escaped(&sides[i]));
    serde_json::json!({
        "verdict": finding.verdict.to_string(), "rule": finding.rule, "field": escaped(&finding.pointer),
        "message": escaped(&finding.message), "left": side(0), "right": side(1), "gap": side(2),
    })
}
