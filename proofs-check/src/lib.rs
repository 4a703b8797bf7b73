//! An independent checker of the certificates of `sigmastar`.
//!
//! It decides a certificate's claim again from the embedded specification and the witness: no search, no solver, no
//! floating point, and not a line of the program that wrote it. One rule a file; every rule names the section of
//! docs/mathematics.md that proves it. What a certificate stores besides, figures on which no claim rests, is computed
//! again apart ([`figures`]) and has an answer of its own.

pub mod certificate;
pub mod data;
pub mod effort;
pub mod exact;
pub mod expr;
pub mod figures;
pub mod interval;
pub mod json;
pub mod matrix;
pub mod monotone;
pub mod rules;
pub mod sha256;
pub mod spec;
pub mod subject;
pub mod verdict;
pub mod weights;

use certificate::Proved;
use std::io::Read;
use verdict::{Finding, Verdict};

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
    /// The steps that the claim took ([`effort`]).
    pub steps: u64,
}

/// Checks the bytes of a certificate file.
pub fn check(bytes: &[u8]) -> Report {
    check_against(bytes, None)
}

/// The same, and whether the certificate is about the data of `specification`, the bytes of a specification file: if not,
/// it is `invalid`.
pub fn check_against(bytes: &[u8], specification: Option<&[u8]>) -> Report {
    check_within(bytes, specification, effort::LIMIT)
}

/// The same with another limit than [`effort::LIMIT`] on the steps that the claim may take, and again the figures.
pub fn check_within(bytes: &[u8], specification: Option<&[u8]>, limit: u64) -> Report {
    let mut lines = Vec::new();
    let (result, steps) = effort::limited(limit, || {
        let asked = specification.map(asked_for).transpose()?;
        let result = json::parse(bytes).and_then(|json| certificate::check(&json, asked.as_ref(), limit, &mut lines));
        // What an undefined interval made of a rule says nothing about the file.
        if effort::exhausted() { result.map_err(|_| exhausted()) } else { result }
    });
    lines.push(format!("effort: {steps} of {limit} steps of interval arithmetic"));
    let (proved, finding) = match result {
        Ok(proved) => (Some(proved), None),
        Err(finding) => (None, Some(*finding)),
    };
    let verdict = finding.as_ref().map_or(Verdict::Valid, |finding| finding.verdict);
    Report { verdict, finding, proved, lines, steps }
}

fn exhausted() -> Box<Finding> {
    let message = "not decided within the steps of interval arithmetic that an answer may take";
    verdict::finding(Verdict::Undecided, "effort", "", message)
}

/// Reads a specification to compare with; editors may have put a byte order mark before it.
fn asked_for(bytes: &[u8]) -> verdict::Outcome<json::Json> {
    json::parse(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)).map_err(|mut finding| {
        finding.message = format!("the specification to compare with: {}", finding.message);
        finding
    })
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
            fields.insert("specification_sha256".to_owned(), subject.digest.as_str().into());
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
    text += &format!("  specification: SHA-256 {}\n", subject.digest);
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
    let mut text = format!("  rule:  {}\n  field: {}\n  {}\n", finding.rule, finding.pointer, finding.message);
    if let Some([lhs, rhs, gap]) = &finding.sides {
        text += &format!("  left:  {lhs}\n  right: {rhs}\n  gap:   {gap}\n");
    }
    text
}

fn finding_json(finding: &Finding) -> serde_json::Value {
    let side = |i: usize| finding.sides.as_ref().map(|sides| sides[i].clone());
    serde_json::json!({
        "verdict": finding.verdict.to_string(), "rule": finding.rule, "field": finding.pointer,
        "message": finding.message, "left": side(0), "right": side(1), "gap": side(2),
    })
}

/// Reads at most what is accepted, and checks it; `specification` as in [`check_against`].
///
/// # Errors
/// A stream that cannot be read.
pub fn check_reader(certificate: &mut dyn Read, specification: Option<&mut dyn Read>) -> std::io::Result<Report> {
    let read = |source: &mut dyn Read| {
        let mut bytes = Vec::new();
        source.take(json::MAX_BYTES as u64 + 1).read_to_end(&mut bytes).map(|_| bytes)
    };
    let specification = specification.map(read).transpose()?;
    Ok(check_against(&read(certificate)?, specification.as_deref()))
}
