//! The claim of a certificate at another base frequency: certified again.

use super::claim::TriedClaim;
use rug::Rational;
use sigmastar_lang::expr::Monomial;
use sigmastar_lang::spec::{Constant, Document, Period, SpecErrors, Specification};
use sigmastar_prove::certificate::certificate_json;
use sigmastar_prove::certify::{Options, certify};
use thiserror::Error;

/// Why there is no claim at a base frequency.
#[derive(Debug, Error)]
pub enum FrequencyError {
    /// The specification with this base frequency is not one.
    #[error(transparent)]
    Specification(#[from] SpecErrors),
    /// No certificate was found.
    #[error("no certificate was found at the base frequency {frequency}")]
    NotCertified {
        /// The base frequency.
        frequency: String,
    },
}

/// Certifies the specification of a claim with another base frequency, by the same derivation, and reads the new claim.
///
/// The base frequency counts as matched where it is proved to be 2 pi/T, whatever the specification says about its own.
/// A triple that was proved for a Jacobian is kept.
///
/// # Errors
/// [`FrequencyError`].
pub fn with_base_frequency(claim: &TriedClaim, frequency: &Constant) -> Result<TriedClaim, FrequencyError> {
    let mut document = claim.spec.document.clone();
    document["internal_model"]["base_frequency"] = frequency.text.clone().into();
    document["internal_model"]["matched"] = is_matched(frequency, &claim.spec.period).into();
    let document = Document::parse("base frequency", &document.to_string())?;
    let mut spec = Specification::from_value(&document.root())?;
    spec.lyapunov = claim.spec.lyapunov.clone();
    let options = Options { compare: false, ..Options::default() };
    let run = certify(&spec, options).ok();
    let certificate = run.as_ref().and_then(certificate_json);
    let Some(certificate) = certificate else {
        return Err(FrequencyError::NotCertified { frequency: frequency.text.clone() });
    };
    Ok(TriedClaim::from_document(&Document::parse("certificate", &certificate.to_string())?)?)
}

/// Whether w T = 2 pi, exactly.
fn is_matched(frequency: &Constant, period: &Period) -> bool {
    let exact = period.nominal().exact.as_ref().filter(|_| period.interval().is_none());
    let product = frequency.exact.as_ref().zip(exact).and_then(|(w, period)| w.mul(period));
    let turn = Monomial::pi().mul(&Monomial::rational(Rational::from(2)));
    product.zip(turn).is_some_and(|(product, turn)| product.equals(&turn).is_true())
}
