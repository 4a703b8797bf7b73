//! The independent checker.

use super::report::Report as Rendered;
use super::subject::Subject;
use proofs_check::Report;
use sigmastar_document::{Block, Made};

pub use proofs_check::json::MAX_BYTES as MAX_CERTIFICATE;
pub use proofs_check::verdict::Verdict as CheckVerdict;

/// What the independent checker says about a certificate.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct CheckReport {
    verdict: CheckVerdict,
    statement: Option<String>,
    sha256: Option<String>,
    assumed: Vec<String>,
    text: String,
    report: Rendered,
}

/// Decides the claim of a certificate again, with none of the code that wrote it: no search, no floating point.
///
/// It never fails and never panics, whatever the text, and its effort is bounded. It does not say that the certificate is
/// about *your* specification: [`check_against`] does.
#[must_use]
pub fn check(certificate: &str) -> CheckReport {
    check_bytes(certificate.as_bytes(), None, false)
}

/// Decides the claim of a certificate again as [`check`] does; a certificate about other data than those of the specification or plant is invalid.
#[must_use]
pub fn check_against(certificate: &str, subject: impl Into<Subject>) -> CheckReport {
    check_bytes(certificate.as_bytes(), Some(subject.into().to_json().as_bytes()), false)
}

/// Decides the claim in the bytes of a certificate, about the data in those of a specification or plant where there are some; with every line
/// of the argument in what it says, or not.
#[must_use]
pub fn check_bytes(certificate: &[u8], subject: Option<&[u8]>, verbose: bool) -> CheckReport {
    CheckReport::new(&proofs_check::check_against(certificate, subject), verbose)
}

/// The answer alone, within all that the checker spends on a certificate divided by `share`.
pub(super) fn verdict_within(share: u64, certificate: &str) -> CheckVerdict {
    proofs_check::check_within(certificate.as_bytes(), None, proofs_check::effort::LIMIT / share).verdict
}

impl CheckReport {
    fn new(report: &Report, verbose: bool) -> CheckReport {
        let subject = report.subject.as_ref();
        CheckReport {
            verdict: report.verdict,
            statement: subject.map(|subject| subject.statement.clone()),
            sha256: subject.map(|subject| subject.digest.clone()),
            assumed: subject.map_or_else(Vec::new, |subject| subject.assumed.clone()),
            text: report.text(verbose),
            report: Rendered::new(Made::new(vec![Block::Code(report.text(verbose))], report.json())),
        }
    }

    /// The answer.
    #[must_use]
    pub fn verdict(&self) -> CheckVerdict {
        self.verdict
    }

    /// Whether the claim is proved.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        self.verdict == CheckVerdict::Valid
    }

    /// The claim that is proved, in words; `None` where none is.
    #[must_use]
    pub fn statement(&self) -> Option<&str> {
        self.statement.as_deref()
    }

    /// SHA-256 of the specification that the proved claim is about; `None` where none is proved.
    #[must_use]
    pub fn specification_sha256(&self) -> Option<&str> {
        self.sha256.as_deref()
    }

    /// What the proved claim assumes of the plant, in sentences.
    #[must_use]
    pub fn assumed(&self) -> &[String] {
        &self.assumed
    }

    /// The report of `sigmastar check`, in every form.
    #[must_use]
    pub fn report(&self) -> &Rendered {
        &self.report
    }

    /// The report for people, as `sigmastar check` prints it: the rule and the field where something is wrong.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }
}
