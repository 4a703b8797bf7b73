//! What is certified: a bounding specification, or a plant by its formulas.

use super::proofs::{Near, ProvedData, Reduced};
use super::reduce::{Beside, reduce_by_norms_watched, reduce_without_joint};
use super::watch::{Stage, Unwatched, Watch};
use super::{ReducedSampled, RestsOn, reduce, reduce_sampled};
use crate::certify::{Alternatives, with_triple};
use rug::Rational;
use sigmastar_lang::plant::{self, Plant};
use sigmastar_lang::spec::{
    self, Actuator, AskedHarmonics, Constant, Disturbances, Document, ErrorKind, InputGain, InternalModel, KEPT_BY,
    Period, Sampling, SpecErrors, Specification, Value,
};
use sigmastar_propose::search::{SampledProposal, SharpProposal};

/// Where the search for a gain may start, and what it saw beside.
#[derive(Clone)]
pub(super) struct Sought {
    pub(super) proposal: SharpProposal,
    pub(super) alternatives: Alternatives,
    /// Other data, and where the search for their gains may start.
    pub(super) others: Vec<ProvedData>,
    /// The choice that the data were proved of.
    pub(super) near: Option<Box<Near>>,
}

/// Where the search for a gain at samples may start, and what it saw beside.
#[derive(Clone)]
pub(super) struct SoughtAtSamples {
    pub(super) proposal: SampledProposal,
    /// Other data at a gain that is given, and where the search for a witness may start.
    pub(super) others: Vec<(Specification, SampledProposal)>,
    /// The choice that the data were proved of.
    pub(super) near: Option<Box<Near>>,
}

/// Where documents have their sampling period.
pub const SAMPLING_PERIOD: &str = "/internal_model/sampling_period";

/// The document with another sampling period; itself where it has no internal model, for what is wrong with it is told as ever.
///
/// # Errors
/// A document that is too large with it.
pub fn at_samples(document: &Document, step: &Constant) -> Result<Document, SpecErrors> {
    document.with_field("/internal_model", "sampling_period", &step.text)
}

/// A document that asks for a claim about every set of harmonics (derivation, 14.7).
///
/// # Errors
/// A document that is too large with it.
pub fn for_every_set(document: &Document) -> Result<Document, SpecErrors> {
    document.with_field("/internal_model", "harmonics", "every-set")
}

/// Whether a document is to be read as a plant: by its `format`, or where that is neither by what else it has.
fn is_plant(value: &Value<'_>) -> bool {
    let format = value.member("format");
    match format.as_ref().and_then(Value::text) {
        Some(plant::FORMAT) => true,
        Some(spec::FORMAT) => false,
        _ => value.member("q").is_some() && value.member("bounds").is_none(),
    }
}

/// A document of either kind.
#[derive(Clone, Debug)]
pub enum Subject {
    /// A bounding specification.
    Specification(Box<Specification>),
    /// A plant.
    Plant(Box<Plant>),
}

impl Subject {
    /// Reads it, by its `format`; what is neither is told as a specification.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn read(document: &Document) -> Result<Subject, SpecErrors> {
        Subject::from_value(&document.root())
    }

    /// Reads it from a value of a document, such as the copy in a certificate; what is neither is told as a specification.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn from_value(value: &Value<'_>) -> Result<Subject, SpecErrors> {
        if is_plant(value) {
            return Ok(Subject::Plant(Box::new(Plant::from_value(value)?)));
        }
        Ok(Subject::Specification(Box::new(Specification::from_value(value)?)))
    }

    /// The subject whose claim is to keep to its actuator by the bounds for every number of oscillators, and the limit that it has by that; about the first n_o
    /// harmonics. `None` without an actuator, and where there are no such bounds: of bounding functions, without a matched base frequency, and for a claim that
    /// is asked to be about every set of harmonics.
    pub(super) fn kept_by_count(&self) -> Option<(Subject, Rational)> {
        let Subject::Plant(plant) = self else { return None };
        let mut plant = plant.clone();
        let actuator = plant.actuator.as_mut()?;
        actuator.by_count = true;
        let max = actuator.largest()?;
        let model = &mut plant.internal_model;
        if !model.matched || model.asks_every_set() {
            return None;
        }
        model.harmonics = Some(AskedHarmonics::First);
        Some((Subject::Plant(plant), max))
    }

    /// The subject as a certificate is about it that keeps to its actuator in that way.
    #[must_use]
    pub fn as_claimed(&self, certificate: &Document) -> Option<Subject> {
        certificate.at(&format!("/claim/actuator/{}", KEPT_BY[0]))?;
        self.kept_by_count().map(|(subject, _)| subject)
    }

    /// What it is called: `specification` or `plant`.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Subject::Specification(_) => "specification",
            Subject::Plant(_) => "plant",
        }
    }

    /// What both kinds have.
    fn part<T: ?Sized>(&self, of_specification: fn(&Specification) -> &T, of_plant: fn(&Plant) -> &T) -> &T {
        match self {
            Subject::Specification(spec) => of_specification(spec),
            Subject::Plant(plant) => of_plant(plant),
        }
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        self.part(|spec| &spec.name, |plant| &plant.name)
    }

    /// The document as it was read.
    #[must_use]
    pub fn document(&self) -> &serde_json::Value {
        self.part(|spec| &spec.document, |plant| &plant.document)
    }

    /// SHA-256, in hexadecimal, of the canonical form of the document.
    #[must_use]
    pub fn sha256(&self) -> &str {
        self.part(|spec| &spec.sha256, |plant| &plant.sha256)
    }

    /// The period.
    #[must_use]
    pub fn period(&self) -> &Period {
        self.part(|spec| &spec.period, |plant| &plant.period)
    }

    /// An error at a field of the document.
    pub(super) fn errors_at(&self, field: &str, kind: ErrorKind, message: String, help: &str) -> SpecErrors {
        let help = Some(help.to_owned());
        match self {
            Subject::Specification(spec) => spec.errors_at(field, &(0..0), kind, message, help),
            Subject::Plant(plant) => plant.errors_at(field, &(0..0), kind, message, help),
        }
    }

    /// The internal model of the regulator.
    #[must_use]
    pub fn internal_model(&self) -> &InternalModel {
        self.part(|spec| &spec.internal_model, |plant| &plant.internal_model)
    }

    /// Whether the regulator is asked to set z = M e at its first instant.
    #[must_use]
    pub fn starts_aligned(&self) -> bool {
        self.part(|spec| &spec.initial_set, |plant| &plant.initial_set).is_aligned()
    }

    /// Whether the document states E0 of the initial set; else it goes with the gain.
    #[must_use]
    pub fn states_e0(&self) -> bool {
        self.stated_sizes()[1]
    }

    /// Whether the document leaves a size of the initial set open, which then goes with the gain.
    #[must_use]
    pub fn leaves_sizes_open(&self) -> bool {
        let has_states = match self {
            Subject::Specification(_) => true,
            Subject::Plant(plant) => plant.states() > 0,
        };
        let [x0, e0] = self.stated_sizes();
        !e0 || !x0 && has_states
    }

    fn stated_sizes(&self) -> [bool; 2] {
        self.part(|spec| &spec.initial_set, |plant| &plant.initial_set).given().map(|size| size.is_some())
    }

    /// The gain of the actuator, where the document has one.
    #[must_use]
    pub fn input_gain(&self) -> Option<&InputGain> {
        self.part(|spec| &spec.input_gain, |plant| &plant.input_gain).as_ref()
    }

    /// What the actuator takes, where the document states it.
    #[must_use]
    pub fn actuator(&self) -> Option<&Actuator> {
        self.part(|spec| &spec.actuator, |plant| &plant.actuator).as_ref()
    }

    /// Noise, a disturbance and rounding that the document states.
    #[must_use]
    pub fn disturbances(&self) -> &Disturbances {
        self.part(|spec| &spec.disturbances, |plant| &plant.disturbances)
    }

    /// The samples that the regulator is asked for at, if any.
    #[must_use]
    pub fn sampling(&self) -> Option<&Sampling> {
        self.internal_model().sampling.as_ref()
    }

    /// Whether the base frequency is that of the period.
    #[must_use]
    pub fn is_matched(&self) -> bool {
        self.internal_model().matched
    }

    /// The specification with proved data, and where the search for a gain may start: the triple of a Jacobian is sought, the
    /// data of a plant are proved.
    ///
    /// # Errors
    /// What keeps the data from being proved, at its place; not empty.
    pub fn proved(self) -> Result<(Specification, Option<SharpProposal>), Vec<SpecErrors>> {
        let (spec, start) = self.proved_with_alternatives((Beside::Nothing, RestsOn::Either), &Unwatched)?;
        Ok((spec, start.map(|sought| sought.proposal)))
    }

    /// The specification with proved data, where the search for a gain may start, and what is proved of a plant beside, for larger gains and
    /// otherwise.
    pub(super) fn proved_with_alternatives(
        self,
        (beside, on): (Beside<'_>, RestsOn),
        watch: &dyn Watch,
    ) -> Result<(Specification, Option<Box<Sought>>), Vec<SpecErrors>> {
        match self {
            Subject::Specification(spec) => {
                watch.enter(Stage::Triple);
                let proved = with_triple(&spec, None).map_err(|refusal| refusal.errors(&spec))?;
                Ok((proved.into_owned(), None))
            }
            Subject::Plant(plant) => {
                let reduced = match on {
                    RestsOn::Either => reduce(&plant, beside, watch),
                    RestsOn::WithoutJoint => reduce_without_joint(&plant, watch),
                    RestsOn::Norms => reduce_by_norms_watched(&plant, watch),
                };
                let reduced = reduced.map_err(|refusal| refusal.errors(&plant))?;
                let Reduced { spec, proposal, alternatives, others, near } = reduced;
                Ok((spec, Some(Box::new(Sought { proposal, alternatives, others, near }))))
            }
        }
    }

    /// The specification with proved data for a claim about the regulator at samples, at the gain that is given or at the smallest one.
    ///
    /// # Errors
    /// Those of [`Subject::proved`].
    pub(super) fn proved_at_samples(
        self,
        sampling: &Sampling,
        asked: (Option<&Rational>, RestsOn),
        watch: &dyn Watch,
    ) -> Result<(Specification, Option<SoughtAtSamples>), Vec<SpecErrors>> {
        match self {
            Subject::Plant(plant) => {
                let reduced =
                    reduce_sampled(&plant, sampling, asked, watch).map_err(|refusal| refusal.errors(&plant))?;
                let ReducedSampled { spec, proposal, near, others } = reduced;
                Ok((spec, Some(SoughtAtSamples { proposal, others, near })))
            }
            specification @ Subject::Specification(_) => {
                watch.enter(Stage::Triple);
                Ok((specification.proved()?.0, None))
            }
        }
    }
}
