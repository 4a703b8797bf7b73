//! An independent checker of the certificates of `sigmastar`.
//!
//! It decides a certificate's claim again from the embedded specification and the witness: no search, no solver, no
//! floating point, and not a line of the program that wrote it. One rule a file; every rule names the section of
//! docs/mathematics.md that proves it. What a certificate stores besides, figures on which no claim rests, is not looked at.

// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod certificate;
pub mod coq;
pub mod report;
pub mod subject;

pub use proofs_core::{
    bound, constant, data, effort, exact, expr, input_gain, interval, jacobian, json, matrix, monotone, period, plant,
    propose, range, rules, scope, sha256, spec, verdict, weights,
};
pub use proofs_plants as plants;
pub use report::Report;
use std::io::Read;
use verdict::{Finding, Verdict};

/// Checks the bytes of a certificate file.
pub fn check(bytes: &[u8]) -> Report {
    check_against(bytes, None)
}

/// Checks the bytes of a certificate file, and whether it is about the data of `specification`, the bytes of a specification file: if not,
/// it is `invalid`.
pub fn check_against(bytes: &[u8], specification: Option<&[u8]>) -> Report {
    check_within(bytes, specification, effort::LIMIT)
}

/// Checks a certificate with another limit than [`effort::LIMIT`] on the steps that the answer may take.
pub fn check_within(bytes: &[u8], specification: Option<&[u8]>, limit: u64) -> Report {
    let mut lines = Vec::new();
    let (result, steps) = effort::limited(limit, || {
        let asked = specification.map(asked_for).transpose()?;
        let result = json::parse(bytes).and_then(|json| certificate::check(&json, asked.as_ref(), &mut lines));
        // What an undefined interval made of a rule says nothing about the file; proposals that were cut short prove nothing less.
        match result {
            Ok(_) if effort::spent() => Err(exhausted()),
            Err(_) if effort::exhausted() => Err(exhausted()),
            result => result,
        }
    });
    lines.push(format!("effort: {steps} of {limit} steps of interval arithmetic"));
    let (subject, finding) = match result {
        Ok(subject) => (Some(subject), None),
        Err(finding) => (None, Some(*finding)),
    };
    let verdict = finding.as_ref().map_or(Verdict::Valid, |finding| finding.verdict);
    Report { verdict, finding, subject, lines, steps }
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
