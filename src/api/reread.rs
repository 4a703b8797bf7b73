//! A stored certificate, decided again.

use super::certificate::Certificate;
use super::certify::not_certified;
use super::error::{Error, ErrorKind};
use super::json_text;
use super::subject::Subject;
use sigmastar_lang::spec::{self, Document};
use sigmastar_prove::certificate::{embedded, is_stated, read_for, stated_by_count, stated_counts};
use sigmastar_prove::certify::Options;
use sigmastar_prove::reduction::{self as prove, Prepared, Run};

/// Reads a stored certificate and decides it again from its witness: nothing is searched for. `name` is what errors call it.
///
/// Guarantee: that of [`certify`](crate::certify), and the claim is the one that is stored. It is this library's word again;
/// [`check`](crate::check) has that of the independent checker. What comes back is made anew, without the comparison with the
/// repaired derivation, which a witness does not have.
///
/// # Errors
/// What is wrong with the certificate, at its place; [`NotCertified`](ErrorKind::NotCertified) where a condition is not proved;
/// [`Claim`](ErrorKind::Claim) where what is proved is not what is stored, as of a certificate that was altered, or that another
/// version made.
pub fn reread(name: &str, bytes: &[u8]) -> Result<Certificate, Error> {
    decided_again(name, &Document::from_bytes(name, bytes)?, |run, subject, stated| {
        let certificate = Certificate::new(run, subject, true).ok_or_else(|| not_certified(run))?;
        if !stated {
            let message = format!("{name}: the claim that is stored is not the one that its witness proves");
            let help = "`check` says what is wrong with it; `certify` makes a new certificate";
            return Err(Error::new(ErrorKind::Claim, message, help));
        }
        Ok(certificate)
    })
}

/// What the witness of a certificate proves, about the specification or plant in it, and whether that is what the certificate states.
///
/// # Errors
/// What is wrong with the certificate, at its place, and those of `then`.
pub(super) fn decided_again<T>(
    name: &str,
    document: &Document,
    then: impl FnOnce(&Run<'_>, &Subject, bool) -> Result<T, Error>,
) -> Result<T, Error> {
    let Some(copy) = embedded(&document.root()) else {
        let (kind, message) = (spec::ErrorKind::MissingField, "there is neither a `specification` nor a `plant` in it");
        let help = Some("name a certificate that `certify` wrote".to_owned());
        return Err(document.errors_at("", &(0..0), kind, message, help).into());
    };
    // A document of its own, so that it can be asked for whatever a file can be asked for.
    let kind = if document.at("/plant").is_some() { "plant" } else { "specification" };
    let subject = Subject::new(Document::parse(&format!("{kind} of {name}"), &json_text(&copy.to_json()))?)?;
    let subject = match subject.read.as_claimed(document) {
        Some(read) => Subject { read, ..subject },
        None => subject,
    };
    let witness = read_for(document, &subject.read)?;
    let of_another = witness.of_another;
    let prepared = Prepared::again(&subject.read, witness).map_err(|all| Error::documents(&all))?;
    let options = Options { compare: false, ..Options::default() };
    let mut run = prepared.certify(options).map_err(|all| Error::documents(&all))?;
    let no_rates = |reason| Error::no_rates(reason, "`n_o`");
    if let (Some(counts), prove::Subject::Plant(plant)) = (stated_by_count(document), &subject.read) {
        run.set_counts(plant, &counts);
    }
    run.prove_rates(&stated_counts(document)).map_err(no_rates)?;
    then(&run, &subject, !of_another && is_stated(&run, document))
}
