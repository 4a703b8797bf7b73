//! What a certificate says, to be decided again of a subject without any search.

use super::{PlantRefusal, Subject, decide_again};
use crate::certify::with_triple;
use sigmastar_decide::conditions::GivenWitness;
use sigmastar_lang::spec::{ErrorKind, OfPlant, ProvedValues, Sampling, SpecErrors, Specification};
use sigmastar_theory::derivation::sampled::SampledWitness;
use sigmastar_theory::evidence::ProvedTriples;

/// The witness of a certificate.
#[derive(Clone, Debug)]
pub struct Witness {
    /// The free numbers of the claim.
    pub numbers: FreeNumbers,
    /// What it says of the data of the subject that it is tried on.
    pub data: WitnessData,
    /// Whether it was made for another subject than that.
    pub of_another: bool,
}

/// The free numbers, of either regulator.
#[derive(Clone, Debug)]
pub enum FreeNumbers {
    /// Of the regulator in continuous time.
    Continuous(GivenWitness),
    /// Of the regulator at samples.
    Sampled(Box<SampledWitness>),
}

/// What a certificate says of data that a subject does not give.
#[derive(Clone, Debug)]
pub enum WitnessData {
    /// The subject gives all of them.
    Given,
    /// The triples of a Jacobian.
    Triples(Box<ProvedTriples>),
    /// Orbit, coordinates and bounds of a plant.
    OfPlant(Box<(OfPlant, ProvedValues)>),
}

impl Witness {
    /// The specification with the data of this witness, each proved again.
    ///
    /// # Errors
    /// What is not proved of the subject, at its place, and a regulator that is not the one of the subject; not empty.
    pub(super) fn proved(&self, subject: &Subject) -> Result<Specification, Vec<SpecErrors>> {
        let step = "/internal_model/sampling_period";
        match (&self.numbers, subject.sampling()) {
            (FreeNumbers::Continuous(_), None) => {}
            (FreeNumbers::Continuous(_), Some(_)) => {
                let message =
                    "the regulator at samples is asked for, and the certificate is about the one in continuous time";
                return Err(told(subject, step, message.to_owned(), "leave the sampling period out"));
            }
            (FreeNumbers::Sampled(witness), asked) => same_samples(subject, &witness.sampling, asked)?,
        }
        match (subject, &self.data) {
            (Subject::Plant(plant), WitnessData::OfPlant(parts)) => {
                let (of_plant, values) = parts.as_ref().clone();
                decide_again(plant, of_plant, values).map_err(|refusal| {
                    let another = || PlantRefusal::OfAnother(Box::new(refusal.clone()));
                    if self.of_another { another() } else { refusal }.errors(plant)
                })
            }
            (Subject::Plant(_), _) => {
                let message = "the certificate says nothing of the orbit and the bounds of a plant".to_owned();
                Err(told(subject, "/f", message, "give a certificate of this plant"))
            }
            (Subject::Specification(spec), data) => {
                let triples = match data {
                    WitnessData::Triples(triples) => Some(triples.as_ref()),
                    // Without it one would be searched for.
                    WitnessData::Given | WitnessData::OfPlant(_) if spec.lyapunov.triple().is_none() => {
                        let message = "the certificate says nothing of the triple of a Jacobian".to_owned();
                        return Err(told(subject, "/lyapunov", message, "give a certificate of this specification"));
                    }
                    WitnessData::Given | WitnessData::OfPlant(_) => None,
                };
                let proved = with_triple(spec, triples).map_err(|refusal| refusal.errors(spec))?;
                Ok(proved.into_owned())
            }
        }
    }
}

/// The samples of a witness have to be those of the subject's period, and of its own sampling period.
fn same_samples(subject: &Subject, stated: &Sampling, asked: Option<&Sampling>) -> Result<(), Vec<SpecErrors>> {
    let step = stated.text();
    if asked.is_some_and(|asked| !asked.is(&stated.step)) {
        let message = format!("another sampling period is asked for than {step}, which the certificate is about");
        return Err(told(subject, "/internal_model/sampling_period", message, SEARCH));
    }
    if asked.is_some_and(|asked| asked.delayed != stated.delayed) {
        let with = |delayed: bool| if delayed { "with a delay" } else { "without a delay" };
        let message = format!(
            "the law {} is asked for, and the certificate is about the one {}",
            with(!stated.delayed),
            with(stated.delayed)
        );
        return Err(told(subject, "/internal_model/delay_samples", message, SEARCH));
    }
    match Sampling::new(subject.period().nominal(), stated.step.clone()) {
        Some(real) if real.samples == stated.samples && subject.is_matched() => Ok(()),
        Some(_) | None => {
            let message = format!(
                "the certificate is about {} samples of {step} in a period at a matched base frequency, and that is not so here",
                stated.samples
            );
            Err(told(subject, "/period", message, SEARCH))
        }
    }
}

const SEARCH: &str = "search for a witness of this one (without --witness)";

fn told(subject: &Subject, field: &str, message: String, help: &str) -> Vec<SpecErrors> {
    vec![subject.errors_at(field, ErrorKind::Range, message, help)]
}
