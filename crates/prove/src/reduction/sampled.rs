//! The bounds of a plant at the arguments of a claim about the regulator at samples.

use super::choice::{best_by_norms, starts, with_search};
use super::coordinates::{Chosen, Start};
use super::entries::needed;
use super::proofs::{Along, Near, PRECISION, Proofs};
use super::proved_at_samples::{ReducedSampled, beyond, found_again};
use super::reduce::{FAR_BETTER, with_candidates, with_coordinates};
use super::refusal::PlantRefusal;
use super::sampled_matrix::{MatrixAtSamples, straight_by_matrix};
use super::sampling::Sampling;
use super::values::{ENLARGED, beyond_the_bounds};
use super::watch::{Unwatched, Watch};
use crate::search::{Failing, SampledSearch};
use rug::Rational;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{self, ProvedValues, Specification};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::paths::Path;
use sigmastar_theory::derivation::sampled::{SampledLaw, sampled_trade_off};

/// How much further the bounds are proved where these arguments were too small for a gain that is given: it cannot become larger
/// to make up for what proved values are above sampled ones.
const WIDER: [f64; 2] = [0.05, 0.2];

/// How much further they are proved where noise and disturbances are to have room in the error box, in turn: the first that serves is taken.
const ROOMY: [f64; 3] = [0.2, 0.1, 0.05];

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

/// What a claim may rest on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RestsOn {
    /// What serves for the smaller gain.
    Either,
    /// The same but for joint metrics, which take long, and which only make a gain smaller that is found without them.
    WithoutJoint,
    /// Norms of the error system, without which there are no rates.
    Norms,
}

/// The same for the regulator at samples: at the gain that is given, or at the smallest one that is found, by norms or, where that serves
/// for a smaller one and they are not asked for, by matrix inequalities over the derivatives.
///
/// # Errors
/// What could not be proved or found.
pub fn reduce_sampled(
    plant: &Plant,
    sampling: &spec::Sampling,
    (gain, on): (Option<&Rational>, RestsOn),
    watch: &dyn Watch,
) -> Result<ReducedSampled, PlantRefusal> {
    with_candidates(plant, watch, |candidates, sampled| {
        let starts = starts(candidates, sampled);
        let by_matrix = |straight: &(Along, Chosen), known: Option<f64>| {
            let (along, chosen) = straight;
            let found = MatrixAtSamples::new(sampled, (along, chosen), sampling)?.reduce(gain, known)?;
            let gain = found.proposal.sigma;
            let near = sampled.plant.is_family().then(|| Box::new(near(straight, sampled.cells.narrow, gain)));
            Some(ReducedSampled { near, ..found })
        };
        // Of the law with a delay nothing else is proved.
        let norms_alone = sampling.delayed || on == RestsOn::Norms;
        let of_rough = || {
            let (p, rough) = starts.as_ref().ok()?;
            let starts = with_search(sampled, Some(Path::Straight), |search| Ok(search.for_matrix(rough))).ok()?;
            straight_by_matrix(p, &starts, sampled)
        };
        let mut straight = None;
        if gain.is_none() && !norms_alone {
            straight = of_rough();
            // As in continuous time, norms are not worth their descent where a matrix inequality does far better from the same start.
            let rough = starts.as_ref().map_or(f64::INFINITY, |(_, rough)| rough.best.proposal.sigma);
            let far_better = straight.as_ref().filter(|(_, chosen)| chosen.proposal.sigma < FAR_BETTER * rough);
            if let Some(found) = far_better.and_then(|straight| by_matrix(straight, Some(rough))) {
                return Ok(found);
            }
        }
        let chosen = best_by_norms(candidates, &starts, sampled);
        let of_norms = chosen.as_ref().map_err(Clone::clone);
        let of_norms = of_norms
            .and_then(|(along, chosen)| SampledPairs::new(plant, along, sampled, chosen)?.reduce(sampling, gain));
        // What norms prove of a gain that is given is enough.
        if norms_alone || (gain.is_some() && of_norms.is_ok()) {
            return of_norms;
        }
        let near_norms = || {
            let (along, chosen) = chosen.as_ref().ok()?;
            straight_by_matrix(&along.coordinates.p, &[Start::from(chosen)], sampled)
        };
        let straight = straight.or_else(|| gain.and_then(|_| of_rough())).or_else(near_norms);
        let known = of_norms.as_ref().ok().map(|found| found.proposal.sigma);
        straight.and_then(|straight| by_matrix(&straight, known)).map_or(of_norms, Ok)
    })
}

/// The choice of a gain by matrix inequalities.
fn near((along, chosen): &(Along, Chosen), narrow: f64, gain: f64) -> Near {
    let (coordinates, start) = (along.coordinates.clone(), Start::from(chosen));
    Near { coordinates, start, path: Some(Path::Straight), narrow, gain }
}

/// The same for many pairs of a gain and a sampling period: the orbit and the coordinates are found once.
///
/// # Errors
/// What could not be proved or found of those.
pub fn with_sampled_pairs<T>(plant: &Plant, with: impl FnOnce(&SampledPairs<'_>) -> T) -> Result<T, PlantRefusal> {
    with_coordinates(plant, &Unwatched, |along, sampled, chosen| {
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
        let proofs = Proofs::new(self.along, self.sampled)?;
        let mut best: Option<ReducedSampled> = None;
        let mut refusal = PlantRefusal::NoGain(Failing::Bounds.into());
        let wider = WIDER.into_iter().filter(|_| given.is_some()).map(|enlarged| (enlarged, true));
        let roomy = ROOMY.into_iter().filter(|_| self.plant.disturbances.any()).map(|enlarged| (enlarged, true));
        for (enlarged, only_without) in roomy.chain(ENLARGED.map(|enlarged| (enlarged, false))).chain(wider) {
            let has_room = best.is_some() && self.plant.disturbances.any();
            if has_room || (only_without && best.is_some()) {
                break;
            }
            let at = needed(&self.chosen.model, &set, &at, enlarged, (self.along.second().is_some(), proposal.sigma))
                .ok_or(PlantRefusal::NoGain(Failing::NotFinite(None).into()))?;
            let [x, e] = at.largest();
            proofs.engine.smooth(&x, &e)?;
            let values = match proofs.values(&at) {
                Ok(values) => values,
                Err(error) => {
                    refusal = error;
                    continue;
                }
            };
            let spec = self.along.specification(self.plant, values)?;
            match found_again(&spec, sampling, &proposal, given) {
                Ok(found) if best.as_ref().is_none_or(|known| found.better_than(&known.proposal)) => {
                    best = Some(ReducedSampled { spec, proposal: found, near: None });
                }
                Ok(_) => {}
                Err(obstacle) => refusal = PlantRefusal::NoGain(beyond_the_bounds(obstacle)),
            }
        }
        best.ok_or(refusal)
    }
}
