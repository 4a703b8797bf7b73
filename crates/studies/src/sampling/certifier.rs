//! Certifying one pair of a gain and a sampling period, of a specification or of a plant.

use rug::Rational;
use sigmastar_decide::conditions::Ladder;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::{InternalModel, Sampling, Specification};
use sigmastar_propose::search::{
    Closest, Extreme, Failing, FloatModel, Obstacle, SampledLimit, SampledSearch, search_sharp,
};
use sigmastar_prove::certify::{Outcome, SampledCertification, certify_sampled, sampled_model};
use sigmastar_prove::reduction::{PlantRefusal, RestsOn, SampledPairs};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::sampled::SampledLaw;
use sigmastar_theory::transfer::TradeOff;

/// Bits at which the numbers of a search are enclosed before they are rounded to doubles.
const PRECISION: u32 = 64;

/// A certified pair.
#[derive(Clone, Debug)]
pub struct Pair {
    /// h, with the samples in a period.
    pub sampling: Sampling,
    /// sigma.
    pub sigma: Rational,
    /// K.
    pub gain: Rational,
    /// h sigma.
    pub product: Enclosure,
    /// theta.
    pub theta: Enclosure,
    /// What limits it, and about how far the forms are from where they fail.
    pub limit: Option<(SampledLimit, f64)>,
}

impl Pair {
    /// The pair of a run that certified one.
    fn new(run: &SampledCertification<'_>) -> Result<Pair, Obstacle> {
        let Some(proof) = run.claim() else {
            return Err(match &run.outcome {
                Outcome::NotFound(obstacle) => *obstacle,
                _ => Failing::Bounds.into(),
            });
        };
        let law = &proof.evaluation.law;
        Ok(Pair {
            sampling: run.sampling.clone(),
            sigma: proof.witness.sigma.clone(),
            gain: proof.witness.law.gain.clone(),
            product: proof.evaluation.product.clone(),
            theta: &law.enlarged - Enclosure::one(proof.precision),
            limit: run.found.map(|(proposal, limit)| (limit, 1.0 - proposal.radius)),
        })
    }
}

/// That the law has no numbers for this sampling period.
fn beyond(sampling: &Sampling) -> Obstacle {
    Failing::Magnitude(Extreme::Number("the sampling period", sampling.step.to_f64())).into()
}

/// What a table asks.
pub trait Certifier {
    /// About the smallest gain of the regulator in continuous time, in floating point.
    ///
    /// # Errors
    /// What stands in the way.
    fn continuous(&self) -> Result<f64, Obstacle>;

    /// The pair of a sampling period and a gain, or the smallest gain that is found.
    ///
    /// # Errors
    /// What stands in the way.
    fn pair(&self, sampling: &Sampling, gain: Option<&Rational>) -> Result<Pair, Obstacle>;

    /// Whether a search in floating point finds a witness.
    ///
    /// # Errors
    /// What stands in the way.
    fn promise(&self, sampling: &Sampling, gain: f64) -> Result<(), Obstacle>;

    /// The internal model.
    fn model(&self) -> &InternalModel;
}

/// A specification whose data are given or proved.
pub struct OfSpecification<'s> {
    /// The specification.
    pub spec: &'s Specification,
}

impl Certifier for OfSpecification<'_> {
    fn continuous(&self) -> Result<f64, Obstacle> {
        let data = Data::new(self.spec, PRECISION);
        search_sharp(&FloatModel::new(&data, TradeOff::matched(&data))).map(|found| found.sigma)
    }

    fn pair(&self, sampling: &Sampling, gain: Option<&Rational>) -> Result<Pair, Obstacle> {
        let run = certify_sampled(self.spec, sampling, gain, None, Ladder::default());
        run.map_err(|_| Obstacle::from(Failing::Bounds)).and_then(|run| Pair::new(&run))
    }

    fn promise(&self, sampling: &Sampling, gain: f64) -> Result<(), Obstacle> {
        let law = self.spec.internal_model.sampled_gain(&sampling.step).ok_or_else(|| beyond(sampling))?;
        let data = Data::new(self.spec, PRECISION);
        let model = sampled_model(&data, sampling, &law);
        SampledSearch::new(&model, SampledLaw::new(&data, sampling, &law).to_f64()).at_gain(gain).map(drop)
    }

    fn model(&self) -> &InternalModel {
        &self.spec.internal_model
    }
}

/// A plant whose orbit is proved and whose coordinates are chosen.
pub struct OfPlant<'p> {
    /// The pairs of the plant.
    pub pairs: &'p SampledPairs<'p>,
}

/// What keeps a plant from a pair.
fn obstacle(refusal: PlantRefusal) -> Obstacle {
    match refusal {
        PlantRefusal::NoGain(obstacle) => obstacle,
        _ => Failing::Bounds.into(),
    }
}

impl Certifier for OfPlant<'_> {
    fn continuous(&self) -> Result<f64, Obstacle> {
        self.pairs.continuous().map_err(obstacle)
    }

    fn pair(&self, sampling: &Sampling, gain: Option<&Rational>) -> Result<Pair, Obstacle> {
        let reduced = self.pairs.reduce(sampling, (gain, RestsOn::Either)).map_err(obstacle)?;
        let first = (&reduced.spec, &reduced.proposal);
        let all = std::iter::once(first).chain(reduced.others.iter().map(|(spec, proposal)| (spec, proposal)));
        let mut closest = Closest::default();
        let mut best: Option<SampledCertification<'_>> = None;
        for (spec, proposal) in all {
            match certify_sampled(spec, sampling, gain, Some(proposal), Ladder::default()) {
                Ok(run) if best.as_ref().is_none_or(|known| run.is_better_than(known)) => best = Some(run),
                Ok(_) => {}
                Err(_) => closest.record(Failing::Bounds.into()),
            }
        }
        closest.or(best).and_then(|run| Pair::new(&run))
    }

    fn promise(&self, sampling: &Sampling, gain: f64) -> Result<(), Obstacle> {
        let found = self.pairs.search(sampling, |search| search.at_gain(gain).map(drop)).map_err(obstacle)?;
        found.unwrap_or_else(|| Err(beyond(sampling)))
    }

    fn model(&self) -> &InternalModel {
        self.pairs.internal_model()
    }
}
