//! Where `controller` takes its regulator from: a specification, a plant, or a certificate of one.

use super::failure::Failure;
use rug::Rational;
use sigmastar_exact::enclosure::{DEFAULT_PRECISION, Enclosure};
use sigmastar_exact::number::write_exact;
use sigmastar_lang::spec::{Constant, Document, InternalModel, SampledGain, Sampling};
use sigmastar_prove::certificate::{FORMAT as CERTIFICATE, read_numbers};
use sigmastar_prove::reduction::{FreeNumbers, Subject};
use sigmastar_regulator::export::{Provenance, Scope};

/// A certificate, as far as a regulator goes. What it says is taken as it is.
pub struct Given {
    sha256: String,
    sigma_star: Rational,
    /// The sampling period, K and Nb2, where it is about the regulator at samples: sigma* then is its only gain.
    sampled: Option<(Sampling, SampledGain)>,
    /// Whether it is about its gain alone because of an actuator.
    with_actuator: bool,
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
        let (sigma_star, sampled) = match read_numbers(document)? {
            FreeNumbers::Sampled(witness) => (witness.sigma, Some((witness.sampling, witness.law))),
            FreeNumbers::Continuous(witness) => (witness.witness.sigma.clone(), None),
        };
        let text = |pointer: &str| document.at(pointer).and_then(|value| value.text().map(str::to_owned));
        let statement = text("/claim/statement").ok_or_else(|| {
            Failure::call("the certificate has no `claim.statement`", "take a certificate that `certify -o` wrote")
        })?;
        let made_for = ["/specification_sha256", "/plant_sha256"].map(text);
        let with_actuator = document.at("/claim/actuator").is_some();
        Ok(Given { sha256: document.root().sha256(), sigma_star, sampled, with_actuator, statement, made_for })
    }

    /// sigma*, rounded up to a double: the gain that is exported is certified too. Of the regulator at samples, and with an actuator,
    /// exactly its gain.
    pub fn gain(&self) -> Option<Constant> {
        if self.sampled.is_some() || self.with_actuator {
            return Some(Constant::rational(&self.sigma_star));
        }
        let up = Enclosure::from_rational(&self.sigma_star, DEFAULT_PRECISION).upper_f64();
        Rational::from_f64(up).map(|gain| Constant::rational(&gain))
    }

    /// The sampling period, where it is about the regulator at samples.
    pub fn step(&self) -> Option<&Constant> {
        self.sampled.as_ref().map(|(sampling, _)| &sampling.step)
    }

    /// Whether its law has a delay, where it is about the regulator at samples.
    pub fn delayed(&self) -> Option<bool> {
        self.sampled.as_ref().map(|(sampling, _)| sampling.delayed)
    }

    /// Whether this regulator is the one at samples that it is about: the same gain, sampling period, delay, K and Nb2, exactly, and few
    /// enough oscillators. `None` where it is about the regulator in continuous time.
    fn covers_samples(&self, regulator: &Asked<'_>) -> Option<bool> {
        let (sampling, law) = self.sampled.as_ref()?;
        let same_step = regulator.step.is_some_and(|step| sampling.is(step)) && regulator.delayed == sampling.delayed;
        let same_law = regulator.step.and_then(|step| regulator.model.sampled_gain(step)).as_ref() == Some(law);
        let same_gain = regulator.sigma.as_rational() == Some(&self.sigma_star);
        Some(same_step && same_law && same_gain && 2 * u64::from(regulator.n_o) < u64::from(sampling.samples))
    }

    /// What it is called where it was made for something else.
    pub fn not_about(&self, subject: &Subject) -> Option<&'static str> {
        let same = self.made_for.iter().flatten().any(|digest| *digest == subject.sha256());
        (!same).then_some(subject.kind())
    }

    /// Its part in the export of a regulator.
    pub fn provenance(&self, regulator: &Asked<'_>) -> Provenance {
        let sigma = regulator.sigma;
        let covers_sigma = || match sigma.as_rational() {
            Some(sigma) => *sigma >= self.sigma_star,
            None => {
                let sigma_star = Enclosure::from_rational(&self.sigma_star, DEFAULT_PRECISION);
                sigma.enclose(DEFAULT_PRECISION).ge(&sigma_star).is_true()
            }
        };
        Provenance {
            sha256: self.sha256.clone(),
            sigma_star: write_exact(&self.sigma_star),
            one_gain: self.sampled.is_some() || self.with_actuator,
            statement: self.statement.clone(),
            scope: match self.covers_samples(regulator) {
                Some(true) => Scope::Samples,
                Some(false) => Scope::OtherSamples,
                None if self.with_actuator => match sigma.as_rational() {
                    Some(sigma) if *sigma == self.sigma_star => Scope::Continuous,
                    _ => Scope::OtherGain,
                },
                None if covers_sigma() => Scope::Continuous,
                None => Scope::BelowSigmaStar,
            },
        }
    }
}

/// The regulator that is asked for.
pub struct Asked<'a> {
    /// The internal model.
    pub model: &'a InternalModel,
    /// The gain.
    pub sigma: &'a Constant,
    /// The sampling period, if any.
    pub step: Option<&'a Constant>,
    /// Whether its law at samples has a delay.
    pub delayed: bool,
    /// The number of oscillators.
    pub n_o: u32,
}

/// Reads what a regulator is asked for; of a certificate, what it was made for, and the certificate.
///
/// # Errors
/// What is wrong with the document.
pub fn read(document: &Document) -> Result<(Subject, Option<Given>), Failure> {
    if document.at("/format").is_none_or(|format| format.text() != Some(CERTIFICATE)) {
        return Ok((Subject::read(document)?, None));
    }
    let given = Given::read(document)?;
    let embedded = ["/plant", "/specification"].into_iter().find_map(|pointer| document.at(pointer));
    let embedded = embedded.ok_or_else(|| {
        let help = "take a certificate that `certify -o` wrote";
        Failure::call("the certificate embeds neither a specification nor a plant", help)
    })?;
    let subject = Subject::from_value(&embedded)?;
    if let Some(kind) = given.not_about(&subject) {
        let message = format!("the {kind} in the certificate is not the one that its digest is of");
        return Err(Failure::call(message, "the file was changed; `sigmastar check` says more"));
    }
    Ok((subject, Some(given)))
}
