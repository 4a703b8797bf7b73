//! Where `controller` takes its regulator from: a specification, a plant, or a certificate of one.

use super::failure::Failure;
use sigmastar::certificate::{FORMAT as CERTIFICATE, read_witness};
use sigmastar::enclosure::{DEFAULT_PRECISION, Enclosure};
use sigmastar::number::write_exact;
use sigmastar::plant::{self, Plant};
use sigmastar::regulator::export::Provenance;
use sigmastar::spec::{Constant, Document, InternalModel, Specification, Value};

use rug::Rational;

/// A specification or a plant, as far as its regulator goes.
pub struct Source {
    /// Its name.
    pub name: String,
    /// The internal model.
    pub model: InternalModel,
    kind: &'static str,
    sha256: String,
}

impl Source {
    /// Reads it, by its `format`; what is neither is told as a specification.
    fn read(value: &Value<'_>, format: Option<&str>) -> Result<Source, Failure> {
        if format == Some(plant::FORMAT) {
            let Plant { name, internal_model: model, sha256, .. } = Plant::from_value(value)?;
            return Ok(Source { name, model, kind: "plant", sha256 });
        }
        let Specification { name, internal_model: model, sha256, .. } = Specification::from_value(value)?;
        Ok(Source { name, model, kind: "specification", sha256 })
    }
}

/// A certificate, as far as a regulator goes. What it says is taken as it is.
pub struct Given {
    sha256: String,
    sigma_star: Rational,
    statement: String,
    /// The digests that it states, of a specification and of a plant.
    made_for: [Option<String>; 2],
}

impl Given {
    /// Reads sigma*, the statement and the digests.
    ///
    /// # Errors
    /// What cannot be read, in its place.
    pub fn read(document: &Document) -> Result<Given, Failure> {
        let sigma_star = read_witness(document)?.sigma().clone();
        let text = |pointer: &str| document.at(pointer).and_then(|value| value.text().map(str::to_owned));
        let statement = text("/claim/statement").ok_or_else(|| {
            Failure::call("the certificate has no `claim.statement`", "take a certificate that `certify -o` wrote")
        })?;
        let made_for = ["/specification_sha256", "/plant_sha256"].map(text);
        Ok(Given { sha256: document.root().sha256(), sigma_star, statement, made_for })
    }

    /// sigma*, rounded up to a double: the gain that is exported is certified too.
    pub fn gain(&self) -> Option<Constant> {
        let up = Enclosure::from_rational(&self.sigma_star, DEFAULT_PRECISION).upper_f64();
        Rational::from_f64(up).map(|gain| Constant::rational(&gain))
    }

    /// What it is called where it was made for something else.
    pub fn not_about(&self, source: &Source) -> Option<&'static str> {
        let same = self.made_for.iter().flatten().any(|digest| *digest == source.sha256);
        (!same).then_some(source.kind)
    }

    /// Its part in the export of a regulator with this gain.
    pub fn provenance(&self, sigma: &Constant) -> Provenance {
        let covers_sigma = match sigma.as_rational() {
            Some(sigma) => *sigma >= self.sigma_star,
            None => {
                let sigma_star = Enclosure::from_rational(&self.sigma_star, DEFAULT_PRECISION);
                sigma.enclose(DEFAULT_PRECISION).ge(&sigma_star).is_true()
            }
        };
        Provenance {
            sha256: self.sha256.clone(),
            sigma_star: write_exact(&self.sigma_star),
            statement: self.statement.clone(),
            covers_sigma,
        }
    }
}

/// Reads what a regulator is asked for; of a certificate, what it was made for, and the certificate.
///
/// # Errors
/// What is wrong with the document.
pub fn read(document: &Document) -> Result<(Source, Option<Given>), Failure> {
    let format = |pointer: &str| document.at(pointer).and_then(|value| value.text());
    if format("/format") != Some(CERTIFICATE) {
        return Ok((Source::read(&document.root(), format("/format"))?, None));
    }
    let given = Given::read(document)?;
    let embedded = ["/plant", "/specification"].into_iter().find_map(|pointer| document.at(pointer));
    let embedded = embedded.ok_or_else(|| {
        let help = "take a certificate that `certify -o` wrote";
        Failure::call("the certificate embeds neither a specification nor a plant", help)
    })?;
    let source = Source::read(&embedded, format(&format!("{}/format", embedded.pointer())))?;
    if given.not_about(&source).is_some() {
        let message = format!("the {} in the certificate is not the one that its digest is of", source.kind);
        return Err(Failure::call(message, "the file was changed; `sigmastar check` says more"));
    }
    Ok((source, Some(given)))
}
