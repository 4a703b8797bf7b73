//! The whole way from a subject to a decided claim, of either regulator.

mod at_gains;
mod deciding;
mod seeking;
mod with_counts;

pub use at_gains::AtGains;
pub use deciding::Checked;

use super::proofs::{ProvedData, bounds_around};
use super::reduce::{Beside, reduce_by_norms_watched};
use super::subject::{Sought, SoughtAtSamples};
use super::watch::{Searches, Stage, Unwatched, Watch};
use super::{FreeNumbers, RestsOn, Subject, Witness};
use crate::certify::{
    BoundsOfCount, Certification, Limits, NoRatesOfClaim, SaidOfCount, SampledCertification, UnderNoise, Verdict,
    claimed_ball, plant_of, said_of,
};
use rug::Rational;
use sigmastar_decide::bounds::Engine;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::model::LyapunovSource;
use sigmastar_lang::spec::{Oscillators, Sampling, SpecErrors, Specification};
use sigmastar_propose::bounds::FloatSuprema;
use sigmastar_propose::search::{Failing, SampledProposal};
use sigmastar_theory::derivation::condition::Condition;
use sigmastar_theory::derivation::initial_set::ClaimedSet;
use sigmastar_theory::derivation::sampled::SampledWitness;
use std::sync::{Arc, OnceLock};

/// Where a search may start, of the regulator in continuous time or of the one at samples; or the numbers that stand in its place.
#[derive(Clone)]
enum Start {
    Continuous(Option<Box<Sought>>),
    Sampled(Box<Sampling>, Option<SoughtAtSamples>),
    Given(FreeNumbers),
}

/// A subject whose data are proved, for one question.
#[derive(Clone)]
pub struct Prepared {
    spec: Specification,
    start: Start,
    gain: Option<Rational>,
    limits: Limits,
    /// The numbers of oscillators that are asked about, and sets of harmonics.
    counts: Vec<u32>,
    sets: Vec<Oscillators>,
    /// About the smallest gain, where `gain` was not given but found above it.
    found_above: Option<f64>,
    /// The plant, where it is one: bounds by the number of oscillators are from its formulas.
    formulas: Option<Box<Plant>>,
    /// The plant, where it is one and the claim need not rest on norms.
    plant: Option<Box<Plant>>,
    /// The data of that plant by norms, where bounds are to be kept: of a larger gain than the least one they may say more.
    by_norms: Option<Box<ProvedData>>,
    /// The data by norms in the coordinates that are proposed first, once the bound of |e| at the smallest gain is found to be far above the
    /// set; copies share them.
    quick: Arc<OnceLock<Option<Box<ProvedData>>>>,
    /// About the gain at which norms prove a claim at samples, where this one rests on a matrix inequality and rates are asked for.
    norms_from: Option<f64>,
    /// Those for a gain with which bounds are kept, once one is found.
    closer: OnceLock<Option<Box<ProvedData>>>,
    /// Data by norms, once the independent checker gives up on the claims of all others.
    last: OnceLock<Option<Last>>,
}

/// Data by norms, of the regulator in continuous time or of the one at samples.
#[derive(Clone)]
enum Last {
    Continuous(Box<ProvedData>),
    Sampled(Box<Specification>, SampledProposal),
}

/// What data are wanted of a subject.
pub(super) struct Ask {
    /// The gain, where it is given.
    pub(super) gain: Option<Rational>,
    /// What a claim may rest on.
    pub(super) on: RestsOn,
    /// Whether data for larger gains are wanted beside; they are where the gain is given.
    pub(super) rows: bool,
}

/// What a run found out. What it claims is about the regulator at samples where the subject asks for that.
#[derive(Clone, Debug)]
pub enum Run<'s> {
    /// Of the regulator in continuous time.
    Continuous(Box<Certification<'s>>),
    /// Of the regulator at samples.
    Sampled(Box<SampledCertification<'s>>),
}

/// What X0 of a claim bounds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StateStart {
    /// `|x|`, of a specification.
    State,
    /// `|L^-1 (x - x_0)|`, of a plant.
    Coordinates,
    /// `|L^-1 (x - x_0)|`, of a plant whose set is asked for as a ball: the set contains that of all `|x - x_0|` up to this (derivation, 11.5).
    Ball(Rational),
}

/// What a certified run claims, of either regulator.
#[derive(Clone, Debug)]
pub struct Certified<'r> {
    /// The gain: the smallest one of the claim, or at samples the only one.
    pub sigma: &'r Rational,
    /// The samples, where it is about the regulator at samples.
    pub sampling: Option<&'r Sampling>,
    /// The set of the starts.
    pub set: &'r ClaimedSet,
    /// What its X0 bounds.
    pub start: StateStart,
    /// Upper bounds of |x|, |e|, |zeta|_N and |z|_N along the periodic solution.
    pub periodic: [Enclosure; 4],
    /// Whether it is proved that no plant with a state has these data.
    pub no_plant: bool,
}

impl Prepared {
    /// Proves the data of a subject, for a gain that is given or for the smallest one.
    ///
    /// # Errors
    /// What keeps the data from being proved, at its place; not empty.
    pub fn new(subject: Subject, gain: Option<Rational>) -> Result<Prepared, Vec<SpecErrors>> {
        Prepared::watched(subject, gain, &Unwatched)
    }

    /// Proves the data of a subject as [`Prepared::new`] does, while `watch` hears of the stages.
    ///
    /// # Errors
    /// Those of [`Prepared::new`].
    pub fn watched(subject: Subject, gain: Option<Rational>, watch: &dyn Watch) -> Result<Prepared, Vec<SpecErrors>> {
        Prepared::resting(subject, Ask { gain, on: RestsOn::Either, rows: false }, watch)
    }

    /// Proves the data of a subject for a claim that may be asked to rest on norms; in continuous time the data are those of the smallest
    /// gain then.
    pub(super) fn resting(
        subject: Subject,
        Ask { gain, on, rows }: Ask,
        watch: &dyn Watch,
    ) -> Result<Prepared, Vec<SpecErrors>> {
        let formulas = match &subject {
            Subject::Plant(plant) => Some(plant.clone()),
            Subject::Specification(_) => None,
        };
        let plant = formulas.clone().filter(|_| on == RestsOn::Either);
        match subject.sampling().cloned() {
            None => {
                let beside = match &gain {
                    Some(gain) => Beside::Gain(gain),
                    None if rows => Beside::Rows,
                    None => Beside::Nothing,
                };
                let (spec, start) = subject.proved_with_alternatives((beside, on), watch)?;
                Ok(Prepared { formulas, plant, ..Prepared::of(spec, Start::Continuous(start), gain) })
            }
            Some(sampling) => {
                let (spec, start) = subject.proved_at_samples(&sampling, (gain.as_ref(), on), watch)?;
                let start = Start::Sampled(Box::new(sampling), start);
                Ok(Prepared { formulas, plant, ..Prepared::of(spec, start, gain) })
            }
        }
    }

    fn of(spec: Specification, start: Start, gain: Option<Rational>) -> Prepared {
        Prepared {
            spec,
            start,
            gain,
            limits: Limits::default(),
            counts: Vec::new(),
            sets: Vec::new(),
            found_above: None,
            formulas: None,
            plant: None,
            by_norms: None,
            quick: Arc::default(),
            norms_from: None,
            closer: OnceLock::new(),
            last: OnceLock::new(),
        }
    }

    /// The data of a subject as the witness of a certificate has them, each proved again: nothing is searched for.
    ///
    /// # Errors
    /// What is not proved, at its place, and a witness of the other regulator or of other samples; not empty.
    pub fn again(subject: &Subject, witness: Witness) -> Result<Prepared, Vec<SpecErrors>> {
        let spec = witness.proved(subject)?;
        Ok(Prepared::of(spec, Start::Given(witness.numbers), None))
    }

    /// The prepared subject with sets of harmonics, of whose oscillators bounds are wanted, too.
    #[must_use]
    pub fn with_sets(self, sets: Vec<Oscillators>) -> Prepared {
        Prepared { sets, ..self }
    }

    /// These sets.
    #[must_use]
    pub fn sets(&self) -> &[Oscillators] {
        &self.sets
    }

    /// The prepared subject for a claim that is to keep to limits at its gain: at the one that is given, or at the smallest one that is found
    /// with which it does.
    #[must_use]
    pub fn within(self, limits: Limits, watch: &dyn Watch) -> Prepared {
        let kept = limits.are_of_conditions() || limits.rate.is_some() || self.spec.actuator.is_some();
        let sought = kept && self.gain.is_none() && matches!(self.start, Start::Continuous(_));
        let plant = self.plant.as_ref().filter(|_| sought);
        let by_norms = |plant: &Plant| {
            watch.enter(Stage::Limits);
            reduce_by_norms_watched(plant, &Searches::new(1, watch)).ok()
        };
        let reduced = plant.and_then(|plant| by_norms(plant));
        let by_norms = reduced.map(|reduced| Box::new((reduced.spec, reduced.proposal)));
        Prepared { limits, by_norms, ..self }
    }
}

/// What decides and samples bounds of the plant behind a specification, read from the copy of it that a certificate has.
fn around_again(spec: &Specification) -> Option<(Engine, FloatSuprema)> {
    let LyapunovSource::Plant(of_plant) = &spec.lyapunov else { return None };
    bounds_around(&plant_of(spec)?, of_plant).ok()
}

impl Run<'_> {
    /// Proves rates for these oscillators at the gain of the claim, by norms or from the derivatives of the plant
    /// ([`Certification::prove_rates`], [`Certification::prove_rates_around`], [`SampledCertification::prove_rates`]). Where a least rate is to be
    /// kept and one of them is not proved to be as large there is no claim any more; nor where the steady error with some of them is not kept, or an actuator
    /// is not that is to be kept to by the number of oscillators.
    ///
    /// # Errors
    /// Theirs.
    pub fn prove_rates(&mut self, asked: &[Oscillators]) -> Result<(), NoRatesOfClaim> {
        match self {
            Run::Continuous(run) if !asked.is_empty() && run.matrix_arguments().is_some() => {
                let (engine, samples) = around_again(run.spec).ok_or(NoRatesOfClaim::OfFormulas)?;
                run.prove_rates_around(asked, (&engine, &samples))
            }
            Run::Continuous(run) => run.prove_rates(asked),
            Run::Sampled(run) => run.prove_rates(asked),
        }?;
        match self {
            Run::Continuous(run) => {
                run.keep_to_rate();
                run.keep_to_counts();
            }
            Run::Sampled(run) => {
                run.keep_to_rate();
                run.keep_to_counts();
            }
        }
        self.keep_to_actuator();
        Ok(())
    }

    /// Takes the claim back where the independent checker does not come to it.
    pub fn answered(&mut self, checked: Checked) {
        if checked == Checked::Decided {
            return;
        }
        let sigma = self.certified().map_or(f64::NAN, |claim| claim.sigma.to_f64());
        let reason = Failing::NotDecidedAgain { refused: checked == Checked::Refused, sigma };
        match self {
            Run::Continuous(run) => run.take_back(reason),
            Run::Sampled(run) => run.take_back(reason),
        }
    }

    /// The rates of the claim, of each number of oscillators that was asked about; none where it is not proved.
    #[must_use]
    pub fn rates(&self) -> Vec<(u32, Option<&Rational>)> {
        match self {
            Run::Continuous(run) => run.rates().collect(),
            Run::Sampled(run) => run.rates().collect(),
        }
    }

    /// What is proved for all oscillators that were asked about, where a rate is.
    #[must_use]
    pub fn of_counts(&self) -> Vec<SaidOfCount<'_>> {
        match self {
            Run::Continuous(run) => run.for_n_o.iter().filter_map(said_of).collect(),
            Run::Sampled(run) => run.for_n_o.iter().filter_map(said_of).collect(),
        }
    }

    /// What is proved with given oscillators, which the claim is about, and which of it is in the certificate; `None` where nothing is certified.
    #[must_use]
    pub fn bounds_of(&self, oscillators: &Oscillators) -> Option<BoundsOfCount> {
        match self {
            Run::Continuous(run) => run.bounds_of(oscillators),
            Run::Sampled(run) => run.bounds_of(oscillators),
        }
    }

    /// Whether noise, a disturbance or rounding of the document disturbs the regulator that the claim is about, and is of a kind of which something may be
    /// proved: not with an actuator, and not with a delay.
    #[must_use]
    pub fn counts_noise(&self) -> bool {
        let (at_samples, delayed) = match self {
            Run::Continuous(_) => (false, false),
            Run::Sampled(run) => (true, run.sampling.delayed),
        };
        self.spec().disturbances.disturb(at_samples) && self.spec().actuator.is_none() && !delayed
    }

    /// What is proved with oscillators that were asked about in the loop with noise; `None` where nothing is, or the document has none.
    #[must_use]
    pub fn under_noise(&self, oscillators: &Oscillators) -> Option<UnderNoise> {
        match self {
            Run::Continuous(run) => run.under_noise(oscillators),
            Run::Sampled(run) => run.under_noise(oscillators),
        }
    }

    /// The verdict.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        match self {
            Run::Continuous(run) => run.verdict,
            Run::Sampled(run) => run.verdict,
        }
    }

    /// The specification whose data were proved.
    #[must_use]
    pub fn spec(&self) -> &Specification {
        match self {
            Run::Continuous(run) => run.spec,
            Run::Sampled(run) => run.spec,
        }
    }

    /// What is claimed; `None` where nothing is certified.
    #[must_use]
    pub fn certified(&self) -> Option<Certified<'_>> {
        let (sigma, sampling, set, periodic, no_plant) = match self {
            Run::Continuous(run) => {
                (run.sigma_star()?, None, run.claimed_set()?, run.periodic_solution()?, run.no_plant.is_some())
            }
            Run::Sampled(run) => {
                let SampledWitness { sigma, sampling, set, .. } = &run.claim()?.witness;
                (sigma, Some(sampling), set, run.periodic_solution()?, run.no_plant.is_some())
            }
        };
        let start = match self.spec().plant() {
            None => StateStart::State,
            Some(plant) => match claimed_ball(plant, &set.x0).filter(|_| plant.ball.is_some()) {
                Some(ball) => StateStart::Ball(ball),
                None => StateStart::Coordinates,
            },
        };
        Some(Certified { sigma, sampling, set, start, periodic, no_plant })
    }

    /// The conditions of the derivation that was asked about, proved or not.
    #[must_use]
    pub fn conditions(&self) -> &[Condition] {
        match self {
            Run::Continuous(run) => run.conditions(),
            Run::Sampled(run) => run.conditions(),
        }
    }

    /// The bounding functions that were neither proved nor refuted, as errors at their places.
    #[must_use]
    pub fn unproved(&self) -> Vec<SpecErrors> {
        let problems = match self {
            Run::Continuous(run) => &run.unproved_bounds,
            Run::Sampled(run) => &run.unproved_bounds,
        };
        problems.iter().map(|problem| problem.errors(self.spec())).collect()
    }
}
