//! The bounds of a plant at the arguments of a claim about the regulator at samples.

use super::choice::{best_by_norms, starts, with_search};
use super::coordinates::{Chosen, Rough, Start};
use super::entries::needed;
use super::proofs::{Along, Near, PRECISION, Proofs};
use super::proved_at_samples::{ReducedSampled, beyond, found_again};
use super::reduce::{FAR_BETTER, with_candidates};
use super::refusal::PlantRefusal;
use super::sampled_matrix::{MatrixAtSamples, straight_by_matrix};
use super::sampling::Sampling;
use super::values::{ENLARGED, beyond_the_bounds};
use super::watch::{Unwatched, Watch};
use rug::Rational;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{self, PeriodicMatrix, ProvedValues, Specification};
use sigmastar_propose::search::{Failing, SampledSearch};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::paths::Path;
use sigmastar_theory::derivation::sampled::{SampledLaw, sampled_trade_off};
use sigmastar_theory::evidence::Coordinates;
use std::sync::OnceLock;

/// How much further the bounds are proved where these arguments were too small for a gain that is given: it cannot become larger
/// to make up for what proved values are above sampled ones.
const WIDER: [f64; 2] = [0.05, 0.2];

/// How much further they are proved where noise and disturbances are to have room in the error box, in turn: the first that serves is taken.
const ROOMY: [f64; 3] = [0.2, 0.1, 0.05];

/// The room in S1 and S2 of the arguments.
const ROOM: f64 = 1e-9;

/// A plant whose orbit is proved: one pair of a gain and a sampling period after the other. The coordinates are chosen once.
pub struct SampledPairs<'p> {
    plant: &'p Plant,
    candidates: &'p [Coordinates],
    sampled: &'p Sampling<'p>,
    /// Where descents over coordinates start.
    starts: Result<(PeriodicMatrix, Rough), PlantRefusal>,
    by_norms: OnceLock<Result<ByNorms, PlantRefusal>>,
    /// The coordinates of the matrix inequality, on the straight path near the starts, and near those by norms.
    of_rough: OnceLock<Option<(Along, Chosen)>>,
    near_norms: OnceLock<Option<(Along, Chosen)>>,
    without_norms: OnceLock<Option<(Along, Chosen)>>,
}

/// The coordinates of norms.
struct ByNorms {
    along: Along,
    chosen: Chosen,
    /// The specification without any proved value.
    empty: Specification,
}

/// What a claim may rest on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RestsOn {
    /// What serves for the smaller gain.
    Either,
    /// What serves for the smaller gain, but no joint metrics: they take long, and only make a gain smaller that is found without them.
    WithoutJoint,
    /// Norms of the error system, without which there are no rates.
    Norms,
}

/// Proves the data of a plant for the regulator at samples: at the gain that is given, or at the smallest one that is found. They are by
/// norms, or by matrix inequalities over the derivatives where these serve for a smaller gain and norms are not asked for.
///
/// # Errors
/// What could not be proved or found.
pub fn reduce_sampled(
    plant: &Plant,
    sampling: &spec::Sampling,
    asked: (Option<&Rational>, RestsOn),
    watch: &dyn Watch,
) -> Result<ReducedSampled, PlantRefusal> {
    with_candidates(plant, watch, |candidates, sampled| {
        SampledPairs::new(plant, candidates, sampled).reduce(sampling, asked)
    })
}

/// What is missing where a gain is given with h sigma certainly above 1: no gain is certified so, whatever else a search fails at.
fn beyond_the_hold(sampling: &spec::Sampling, gain: Option<&Rational>) -> Option<PlantRefusal> {
    let sigma = gain.filter(|gain| sampling.fits(gain).is_false())?.to_f64();
    Some(PlantRefusal::NoGain(Failing::Hold { sigma, largest: sampling.step.to_f64().recip(), given: true }.into()))
}

/// The choice of a gain by matrix inequalities.
fn near((along, chosen): &(Along, Chosen), narrow: f64, gain: f64) -> Near {
    let (coordinates, start) = (along.coordinates.clone(), Start::from(chosen));
    Near { coordinates, start, path: Some(Path::Straight), narrow, gain }
}

/// Calls `with` for the proofs at many pairs of a gain and a sampling period: the orbit and the coordinates are found once.
///
/// # Errors
/// What could not be proved or found of those; that of norms, without which nothing is said of the regulator in continuous time.
pub fn with_sampled_pairs<T>(plant: &Plant, with: impl FnOnce(&SampledPairs<'_>) -> T) -> Result<T, PlantRefusal> {
    with_candidates(plant, &Unwatched, |candidates, sampled| {
        let pairs = SampledPairs::new(plant, candidates, sampled);
        pairs.by_norms()?;
        Ok(with(&pairs))
    })
}

impl<'p> SampledPairs<'p> {
    fn new(plant: &'p Plant, candidates: &'p [Coordinates], sampled: &'p Sampling<'p>) -> SampledPairs<'p> {
        let [of_rough, near_norms, without_norms] = [OnceLock::new(), OnceLock::new(), OnceLock::new()];
        let starts = starts(candidates, sampled);
        SampledPairs {
            plant,
            candidates,
            sampled,
            starts,
            by_norms: OnceLock::new(),
            of_rough,
            near_norms,
            without_norms,
        }
    }

    fn by_norms(&self) -> Result<&ByNorms, PlantRefusal> {
        let found = self.by_norms.get_or_init(|| {
            let (along, chosen) = best_by_norms(self.candidates, &self.starts, self.sampled)?;
            let empty = along.specification(self.plant, ProvedValues::default())?;
            Ok(ByNorms { along, chosen, empty })
        });
        found.as_ref().map_err(Clone::clone)
    }

    fn of_rough(&self) -> Option<&(Along, Chosen)> {
        let found = self.of_rough.get_or_init(|| {
            let (p, rough) = self.starts.as_ref().ok()?;
            let starts = with_search(self.sampled, Some(Path::Straight), |search| Ok(search.for_matrix(rough))).ok()?;
            straight_by_matrix(p, &starts, self.sampled, true)
        });
        found.as_ref()
    }

    /// Also where it is worth no proof in continuous time, if norms prove nothing.
    fn near_norms(&self, beside_norms: bool) -> Option<&(Along, Chosen)> {
        let found = if beside_norms { &self.near_norms } else { &self.without_norms };
        let found = found.get_or_init(|| {
            let ByNorms { along, chosen, .. } = self.by_norms().ok()?;
            straight_by_matrix(&along.coordinates.p, &[Start::from(chosen)], self.sampled, beside_norms)
        });
        found.as_ref()
    }

    /// About the smallest gain of the regulator in continuous time, by norms.
    ///
    /// # Errors
    /// What could not be proved or found.
    pub fn continuous(&self) -> Result<f64, PlantRefusal> {
        Ok(self.by_norms()?.chosen.proposal.sigma)
    }

    /// The internal model of the plant.
    #[must_use]
    pub fn internal_model(&self) -> &spec::InternalModel {
        &self.plant.internal_model
    }

    /// The search for a sampling period by norms, over bounds that are sampled and not proved; `None` where the law has no numbers for it.
    ///
    /// # Errors
    /// What could not be proved or found of the coordinates.
    pub fn search<T>(
        &self,
        sampling: &spec::Sampling,
        with: impl FnOnce(&SampledSearch<'_>) -> T,
    ) -> Result<Option<T>, PlantRefusal> {
        let ByNorms { chosen, empty, .. } = self.by_norms()?;
        let Some(law) = self.plant.internal_model.sampled_gain(&sampling.step) else { return Ok(None) };
        let data = Data::new(empty, PRECISION);
        let enclosed = SampledLaw::new(&data, sampling, &law);
        let model = chosen.model.with_trade_off(sampled_trade_off(&data, &enclosed));
        Ok(Some(with(&SampledSearch::new(&model, enclosed.to_f64()))))
    }

    /// The data of a claim at the gain that is given, or at the smallest one that is found; at one that is given with others that serve there, too.
    ///
    /// # Errors
    /// What could not be proved or found.
    pub fn reduce(
        &self,
        sampling: &spec::Sampling,
        (gain, on): (Option<&Rational>, RestsOn),
    ) -> Result<ReducedSampled, PlantRefusal> {
        let by_matrix = |straight: &(Along, Chosen), known: Option<f64>| {
            let (along, chosen) = straight;
            let found = MatrixAtSamples::new(self.sampled, (along, chosen), sampling)?.reduce(gain, known)?;
            let gain = found.proposal.sigma;
            let near = self.plant.is_family().then(|| Box::new(near(straight, self.sampled.cells.narrow, gain)));
            Some(ReducedSampled { near, ..found })
        };
        // Of the law with a delay nothing else is proved.
        let norms_alone = sampling.delayed || on == RestsOn::Norms;
        if gain.is_none() && !norms_alone {
            // As in continuous time, norms are not worth their descent where a matrix inequality does far better from the same start.
            let rough = self.starts.as_ref().map_or(f64::INFINITY, |(_, rough)| rough.best.proposal.sigma);
            let far_better = self.of_rough().filter(|(_, chosen)| chosen.proposal.sigma < FAR_BETTER * rough);
            if let Some(found) = far_better.and_then(|straight| by_matrix(straight, Some(rough))) {
                return Ok(found);
            }
        }
        let of_norms = match gain {
            None => self.reduce_by_norms(sampling, None),
            Some(gain) => self.reduce_by_norms_at(sampling, gain),
        };
        if norms_alone {
            return of_norms.map_err(|refusal| beyond_the_hold(sampling, gain).unwrap_or(refusal));
        }
        let straight = self.of_rough().or_else(|| self.near_norms(true));
        let straight = straight.or_else(|| if of_norms.is_err() { self.near_norms(false) } else { None });
        let known = of_norms.as_ref().ok().filter(|_| gain.is_none()).map(|found| found.proposal.sigma);
        match (straight.and_then(|straight| by_matrix(straight, known)), of_norms) {
            (None, Ok(of_norms)) => Ok(of_norms),
            (None, Err(refusal)) => Err(beyond_the_hold(sampling, gain).unwrap_or(refusal)),
            (Some(found), Ok(of_norms)) if gain.is_some() => {
                let others = std::iter::once((of_norms.spec, of_norms.proposal)).chain(of_norms.others).collect();
                Ok(ReducedSampled { others, ..found })
            }
            (Some(found), _) => Ok(found),
        }
    }

    /// The data by norms that are proved for a gain, and those for the smallest one, which hold at every gain.
    fn reduce_by_norms_at(&self, sampling: &spec::Sampling, gain: &Rational) -> Result<ReducedSampled, PlantRefusal> {
        let least = self.reduce_by_norms(sampling, None);
        let serves = |least: &ReducedSampled| least.proposal.sigma <= gain.to_f64();
        match (self.reduce_by_norms(sampling, Some(gain)), least.ok().filter(serves)) {
            (Ok(found), Some(least)) => Ok(ReducedSampled { others: vec![(least.spec, least.proposal)], ..found }),
            (Ok(found), None) => Ok(found),
            (Err(_), Some(least)) => Ok(least),
            (Err(refusal), None) => Err(refusal),
        }
    }

    /// Finds a proposal with sampled bounds, proves the bounds at its arguments with less and less room, and looks again.
    fn reduce_by_norms(
        &self,
        sampling: &spec::Sampling,
        gain: Option<&Rational>,
    ) -> Result<ReducedSampled, PlantRefusal> {
        let ByNorms { along, chosen, .. } = self.by_norms()?;
        let given = gain.map(Rational::to_f64);
        let found = self.search(sampling, |search| {
            let proposal = given.map_or_else(|| search.smallest(), |gain| search.at_gain(gain))?;
            // The gain may come out larger with the proved bounds, and its arguments then are no larger than these.
            let near = Some((proposal.rho, proposal.eta));
            let (set, at) = search.at(proposal.sigma, proposal.floors, near, ROOM)?;
            Ok((proposal, set, at))
        })?;
        let found = found.unwrap_or_else(|| Err(beyond(sampling)));
        let (proposal, set, at) = found.map_err(PlantRefusal::NoGain)?;
        let proofs = Proofs::new(along, self.sampled)?;
        let mut best: Option<ReducedSampled> = None;
        let mut refusal = PlantRefusal::NoGain(Failing::Bounds.into());
        let wider = WIDER.into_iter().filter(|_| given.is_some()).map(|enlarged| (enlarged, true));
        let roomy = ROOMY.into_iter().filter(|_| self.plant.disturbances.any()).map(|enlarged| (enlarged, true));
        for (enlarged, only_without) in roomy.chain(ENLARGED.map(|enlarged| (enlarged, false))).chain(wider) {
            let has_room = best.is_some() && self.plant.disturbances.any();
            if has_room || (only_without && best.is_some()) {
                break;
            }
            let at = needed(&chosen.model, &set, &at, enlarged, (along.second().is_some(), proposal.sigma))
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
            let spec = along.specification(self.plant, values)?;
            match found_again(&spec, sampling, &proposal, given) {
                Ok(found) if best.as_ref().is_none_or(|known| found.better_than(&known.proposal)) => {
                    best = Some(ReducedSampled { spec, proposal: found, near: None, others: Vec::new() });
                }
                Ok(_) => {}
                Err(obstacle) => refusal = PlantRefusal::NoGain(beyond_the_bounds(obstacle)),
            }
        }
        best.ok_or(refusal)
    }
}
