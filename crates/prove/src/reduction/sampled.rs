//! The bounds of a plant at the arguments of a claim about the regulator at samples.

use super::coordinates::Chosen;
use super::entries::{needed, prove_all};
use super::proofs::{Along, PRECISION};
use super::reduce::{ENLARGED, beyond_the_bounds, with_coordinates};
use super::refusal::PlantRefusal;
use super::sampling::Sampling;
use crate::certify::sampled_model;
use crate::search::{Extreme, Failing, Obstacle, SampledProposal, SampledSearch};
use rug::Rational;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{self, ProvedValues, Specification};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::sampled::{SampledLaw, sampled_trade_off};

/// A specification whose data were proved from a plant's formulas, and where the search for a witness may start.
pub struct ReducedSampled {
    /// The specification.
    pub spec: Specification,
    /// Free numbers for it, in floating point.
    pub proposal: SampledProposal,
}

/// How much further the bounds are proved where these arguments were too small for a gain that is given: it cannot become larger
/// to make up for what proved values are above sampled ones.
const WIDER: [f64; 2] = [0.05, 0.2];

/// The room in S1 and S2 of the arguments.
const ROOM: f64 = 1e-9;

/// A plant whose orbit is proved and whose coordinates are chosen: one pair of a gain and a sampling period after the other.
pub struct SampledPairs<'p> {
    plant: &'p Plant,
    along: &'p Along,
    sampled: &'p Sampling<'p>,
    chosen: &'p Chosen,
    /// The specification without any proved value.
    empty: Specification,
}

/// The same for the regulator at samples: at the gain that is given, or at the smallest one that is found.
///
/// # Errors
/// What could not be proved or found.
pub fn reduce_sampled(
    plant: &Plant,
    sampling: &spec::Sampling,
    gain: Option<&Rational>,
) -> Result<ReducedSampled, PlantRefusal> {
    with_sampled_pairs(plant, |pairs| pairs.reduce(sampling, gain))?
}

/// The same for many pairs of a gain and a sampling period: the orbit and the coordinates are found once.
///
/// # Errors
/// What could not be proved or found of those.
pub fn with_sampled_pairs<T>(plant: &Plant, with: impl FnOnce(&SampledPairs<'_>) -> T) -> Result<T, PlantRefusal> {
    if plant.is_family() {
        return Err(PlantRefusal::FamilyAtSamples);
    }
    with_coordinates(plant, |along, sampled, chosen| {
        SampledPairs::new(plant, along, sampled, chosen).map(|pairs| with(&pairs))
    })
}

impl<'p> SampledPairs<'p> {
    fn new(
        plant: &'p Plant,
        along: &'p Along,
        sampled: &'p Sampling<'p>,
        chosen: &'p Chosen,
    ) -> Result<SampledPairs<'p>, PlantRefusal> {
        let empty = along.specification(plant, ProvedValues::default())?;
        Ok(SampledPairs { plant, along, sampled, chosen, empty })
    }

    /// About the smallest gain of the regulator in continuous time.
    #[must_use]
    pub fn continuous(&self) -> f64 {
        self.chosen.proposal.sigma
    }

    /// The internal model of the plant.
    #[must_use]
    pub fn internal_model(&self) -> &spec::InternalModel {
        &self.plant.internal_model
    }

    /// The search for a sampling period, over bounds that are sampled and not proved.
    pub fn search<T>(&self, sampling: &spec::Sampling, with: impl FnOnce(&SampledSearch<'_>) -> T) -> Option<T> {
        let law = self.plant.internal_model.sampled_gain(&sampling.step)?;
        let data = Data::new(&self.empty, PRECISION);
        let enclosed = SampledLaw::new(&data, sampling, &law);
        let model = self.chosen.model.with_trade_off(sampled_trade_off(&data, &enclosed));
        Some(with(&SampledSearch::new(&model, enclosed.to_f64())))
    }

    /// Finds a proposal with sampled bounds, proves the bounds at its arguments with less and less room, and looks again.
    ///
    /// # Errors
    /// What could not be proved or found.
    pub fn reduce(&self, sampling: &spec::Sampling, gain: Option<&Rational>) -> Result<ReducedSampled, PlantRefusal> {
        let given = gain.map(Rational::to_f64);
        let found = self.search(sampling, |search| {
            let proposal = given.map_or_else(|| search.smallest(), |gain| search.at_gain(gain))?;
            // The gain may come out larger with the proved bounds, and its arguments then are no larger than these.
            let near = Some((proposal.rho, proposal.eta));
            let (set, at) = search.at(proposal.sigma, proposal.floors, near, ROOM)?;
            Ok((proposal, set, at))
        });
        let found = found.unwrap_or_else(|| Err(beyond(sampling)));
        let (proposal, set, at) = found.map_err(PlantRefusal::NoGain)?;
        let engine = self.along.engine(self.plant)?;
        let suprema = self.along.suprema(self.sampled);
        let mut best: Option<ReducedSampled> = None;
        let mut refusal = PlantRefusal::NoGain(Failing::Bounds.into());
        let wider = WIDER.into_iter().filter(|_| given.is_some()).map(|enlarged| (enlarged, true));
        for (enlarged, only_without) in ENLARGED.map(|enlarged| (enlarged, false)).into_iter().chain(wider) {
            if only_without && best.is_some() {
                break;
            }
            let at = needed(&self.chosen.model, &set, &at, enlarged, (self.along.second().is_some(), proposal.sigma))
                .ok_or(PlantRefusal::NoGain(Failing::NotFinite(None).into()))?;
            let [x, e] = at.largest();
            engine.smooth(&x, &e)?;
            let values = match prove_all(&engine, &suprema, &at, &self.plant.internal_model.mu) {
                Ok(values) => values,
                Err(error) => {
                    refusal = error;
                    continue;
                }
            };
            let spec = self.along.specification(self.plant, values)?;
            match found_again(&spec, sampling, &proposal, given) {
                Ok(found) if best.as_ref().is_none_or(|known| found.better_than(&known.proposal)) => {
                    best = Some(ReducedSampled { spec, proposal: found });
                }
                Ok(_) => {}
                Err(obstacle) => refusal = PlantRefusal::NoGain(beyond_the_bounds(obstacle)),
            }
        }
        best.ok_or(refusal)
    }
}

/// That the law has no numbers for this sampling period.
fn beyond(sampling: &spec::Sampling) -> Obstacle {
    Failing::Magnitude(Extreme::Number("the sampling period", sampling.step.to_f64())).into()
}

/// The proposal with proved bounds in the place of sampled ones.
fn found_again(
    spec: &Specification,
    sampling: &spec::Sampling,
    proposal: &SampledProposal,
    gain: Option<f64>,
) -> Result<SampledProposal, Obstacle> {
    let law = spec.internal_model.sampled_gain(&sampling.step).ok_or_else(|| beyond(sampling))?;
    let data = Data::new(spec, PRECISION);
    let model = sampled_model(&data, sampling, &law);
    SampledSearch::new(&model, SampledLaw::new(&data, sampling, &law).to_f64()).near(proposal, gain)
}
