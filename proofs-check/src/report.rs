//! The answer about a file, as text and as JSON. Nothing is decided here.

use crate::certificate::Proved;
use proofs_core::verdict::{Finding, Verdict, escaped};

/// The answer about a file.
pub struct Report {
    /// The verdict on the claim.
    pub verdict: Verdict,
    /// Why it is not `valid`.
    pub finding: Option<Finding>,
    /// What a valid certificate says, and whether its figures agree.
    pub proved: Option<Proved>,
    /// The argument, line by line, as far as it went.
    pub lines: Vec<String>,
    /// The steps that the claim took ([`proofs_core::effort`]).
    pub steps: u64,
}

/// The most findings about figures that are written out in text.
const MAX_SHOWN: usize = 10;

impl Report {
    /// Whether the claim is proved and every figure agrees.
    pub fn is_flawless(&self) -> bool {
        self.proved.as_ref().is_some_and(|proved| proved.figures.findings.is_empty())
    }

    /// The report as text; with the argument if `verbose`.
    pub fn text(&self, verbose: bool) -> String {
        let mut text = String::new();
        if verbose {
            self.lines.iter().for_each(|line| text += &format!("{line}\n"));
        }
        match &self.proved {
            Some(proved) => {
                text += &format!("{}; figures: {}\n", self.verdict, proved.figures);
                text += &subject_text(proved);
            }
            None => text += &format!("{}\n", self.verdict),
        }
        self.finding.iter().for_each(|finding| text += &finding_text(finding));
        text
    }

    /// The report as JSON.
    pub fn json(&self) -> serde_json::Value {
        let mut json = serde_json::json!({
            "format": "sigmastar/check", "version": 1, "verdict": self.verdict.to_string(),
            "finding": self.finding.as_ref().map(finding_json), "argument": self.lines,
        });
        if let (Some(Proved { subject, figures }), Some(fields)) = (&self.proved, json.as_object_mut()) {
            let free: serde_json::Map<String, serde_json::Value> =
                subject.free_texts.iter().map(|(name, text)| ((*name).to_owned(), text.as_str().into())).collect();
            let findings: Vec<_> = figures.findings.iter().map(finding_json).collect();
            fields.insert("statement".to_owned(), subject.statement.as_str().into());
            fields.insert("also_proved".to_owned(), subject.also.as_deref().into());
            fields.insert(format!("{}_sha256", subject.about), subject.digest.as_str().into());
            fields.insert("assumed".to_owned(), subject.assumed.clone().into());
            fields.insert("free_texts".to_owned(), free.into());
            let figures = serde_json::json!({
                "verdict": figures.word(), "checked": figures.checked, "findings": findings,
            });
            fields.insert("figures".to_owned(), figures);
        }
        json
    }
}

fn subject_text(Proved { subject, figures }: &Proved) -> String {
    let mut text = format!("  proved:  {}\n", subject.statement);
    subject.also.iter().for_each(|also| text += &format!("  proved:  {also}\n"));
    subject.assumed.iter().for_each(|line| text += &format!("  assumed: {line}\n"));
    text += &format!("  {}: SHA-256 {}\n", subject.about, subject.digest);
    subject.free_texts.iter().for_each(|(name, free)| text += &format!("  {name} (free text): {free}\n"));
    if !figures.findings.is_empty() {
        text += "Figures on which no claim rests:\n";
    }
    figures.findings.iter().take(MAX_SHOWN).for_each(|finding| text += &finding_text(finding));
    if figures.findings.len() > MAX_SHOWN {
        text += &format!("  and {} more (--format json has all)\n", figures.findings.len() - MAX_SHOWN);
    }
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
