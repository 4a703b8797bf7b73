//! The whole way from a subject to a decided claim, of either regulator.

mod seeking;

use super::closer::closer;
use super::interval_costs::{costs_at_samples, interval_costs};
use super::proofs::{ProvedData, bounds_around};
use super::reduce::{Beside, reduce_by_norms_quickly, reduce_by_norms_watched};
use super::subject::{Sought, SoughtAtSamples};
use super::watch::{Searches, Stage, Unwatched, Watch};
use super::{FreeNumbers, RestsOn, Subject, Witness};
use crate::certify::{
    Alternatives, Certification, Limits, Member, NoRatesOfClaim, Options, Refusal, SampledCertification, Verdict,
    Wanted, certify_for, certify_member, certify_sampled_within, claimed_ball, recheck, recheck_sampled,
};
use crate::search::{Failing, SharpProposal};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::parallel;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::model::LyapunovSource;
use sigmastar_lang::spec::{Document, Sampling, SpecErrors, Specification};
use sigmastar_plants::bounds::{Engine, FloatSuprema};
use sigmastar_theory::derivation::condition::Condition;
use sigmastar_theory::derivation::initial_set::ClaimedSet;
use sigmastar_theory::derivation::sampled::SampledWitness;
use std::sync::OnceLock;

/// Where a search may start, of the regulator in continuous time or of the one at samples; or the numbers that stand in its place.
enum Start {
    Continuous(Option<Box<Sought>>),
    Sampled(Box<Sampling>, Option<SoughtAtSamples>),
    Given(FreeNumbers),
}

/// A subject whose data are proved, for one question.
pub struct Prepared {
    spec: Specification,
    start: Start,
    gain: Option<Rational>,
    limits: Limits,
    /// About the smallest gain, where `gain` was not given but found above it.
    found_above: Option<f64>,
    /// The plant, where it is one and the claim need not rest on norms.
    plant: Option<Box<Plant>>,
    /// The data of that plant by norms, where bounds are to be kept: of a larger gain than the least one they may say more.
    by_norms: Option<Box<ProvedData>>,
    /// The same in the coordinates that are proposed first, once the bound of |e| at the smallest gain is found to be far above the set.
    quick: OnceLock<Option<Box<ProvedData>>>,
    /// Those for a gain with which bounds are kept, once one is found.
    closer: OnceLock<Option<Box<ProvedData>>>,
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
    /// The same of a plant whose set is asked for as a ball: it contains that of all `|x - x_0|` up to this (derivation, 11.5).
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

    /// The same, while somebody waits.
    ///
    /// # Errors
    /// Those of [`Prepared::new`].
    pub fn watched(subject: Subject, gain: Option<Rational>, watch: &dyn Watch) -> Result<Prepared, Vec<SpecErrors>> {
        Prepared::resting(subject, Ask { gain, on: RestsOn::Either, rows: false }, watch)
    }

    /// The same of a claim that may be asked to rest on norms; in continuous time the data are those of the smallest gain then.
    pub(super) fn resting(
        subject: Subject,
        Ask { gain, on, rows }: Ask,
        watch: &dyn Watch,
    ) -> Result<Prepared, Vec<SpecErrors>> {
        let plant = match &subject {
            Subject::Plant(plant) if on == RestsOn::Either => Some(plant.clone()),
            _ => None,
        };
        match subject.sampling().cloned() {
            None => {
                let beside = match &gain {
                    Some(gain) => Beside::Gain(gain),
                    None if rows => Beside::Rows,
                    None => Beside::Nothing,
                };
                let (spec, start) = subject.proved_with_alternatives((beside, on), watch)?;
                Ok(Prepared { plant, ..Prepared::of(spec, Start::Continuous(start), gain) })
            }
            Some(sampling) => {
                let (spec, start) = subject.proved_at_samples(&sampling, (gain.as_ref(), on), watch)?;
                let start = Start::Sampled(Box::new(sampling), start);
                Ok(Prepared { plant, ..Prepared::of(spec, start, gain) })
            }
        }
    }

    fn of(spec: Specification, start: Start, gain: Option<Rational>) -> Prepared {
        let (limits, [quick, closer]) = (Limits::default(), [OnceLock::new(), OnceLock::new()]);
        Prepared { spec, start, gain, limits, found_above: None, plant: None, by_norms: None, quick, closer }
    }

    /// The data of a subject as the witness of a certificate has them, each proved again: nothing is searched for.
    ///
    /// # Errors
    /// What is not proved, at its place, and a witness of the other regulator or of other samples; not empty.
    pub fn again(subject: &Subject, witness: Witness) -> Result<Prepared, Vec<SpecErrors>> {
        let spec = witness.proved(subject)?;
        Ok(Prepared::of(spec, Start::Given(witness.numbers), None))
    }

    /// The same, for a claim that is to keep to limits at its gain: at the one that is given, or at the smallest one that is found with
    /// which it does.
    #[must_use]
    pub fn within(self, limits: Limits, watch: &dyn Watch) -> Prepared {
        let kept = !limits.is_empty() || self.spec.actuator.is_some();
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

    /// Searches, rounds and decides. Hypothesis: the options fit ([`Options::misfit`]).
    ///
    /// # Errors
    /// What the data are refused for, at its place; not empty.
    pub fn certify(&self, options: Options) -> Result<Run<'_>, Vec<SpecErrors>> {
        self.certify_watched(options, &Unwatched)
    }

    /// The same, while somebody waits.
    ///
    /// # Errors
    /// Those of [`Prepared::certify`].
    pub fn certify_watched(&self, options: Options, watch: &dyn Watch) -> Result<Run<'_>, Vec<SpecErrors>> {
        watch.enter(Stage::Witness);
        let (spec, gain) = (&self.spec, self.gain.as_ref());
        // Figures about the smallest gain say nothing about another one.
        let smallest = gain.is_none() && self.limits.is_empty() && spec.actuator.is_none();
        let run = match &self.start {
            Start::Continuous(start) => {
                let proposal = start.as_ref().map(|sought| &sought.proposal);
                let pool = self.pool(start.as_deref(), options, watch);
                let wanted = Wanted { start: None, gain, limits: Some(&self.limits) };
                // The data that were proved for the smallest gain know it best.
                let asked = if smallest { &pool[..1] } else { &pool[..] };
                let runs = asked.iter().map(|member| certify_member(member, options, wanted));
                let run = runs.reduce(|run, other| match (run, other) {
                    (Ok(run), Ok(other)) => Ok(better(run, other)),
                    (Err(_), other) => other,
                    (run, Err(_)) => run,
                });
                // There is a member at least.
                let run = run.unwrap_or_else(|| certify_for(spec, options, wanted));
                run.and_then(|run| self.closer(run, options, watch)).map(|mut run| {
                    watch.enter(Stage::Comparison);
                    run.smallest_gain =
                        run.smallest_gain.map(|least| proposal.map_or(least, |known| known.sigma.min(least)));
                    if options.compare {
                        run.set_gains(&pool);
                    }
                    let alternatives = start.as_ref().filter(|_| smallest).map(|sought| sought.alternatives);
                    if let Some(Alternatives { by_norms, aligned, nominal_gain }) = alternatives
                        && let Some(sigma) = run.sigma_star().map(Rational::to_f64)
                    {
                        // From few samples norms may seem to need less than they do.
                        run.alternatives.by_norms = by_norms.filter(|by_norms| *by_norms > sigma);
                        run.alternatives.aligned = run.alternatives.aligned.or(aligned);
                        let nominal_gain = run.alternatives.nominal_gain.or(nominal_gain);
                        run.alternatives.nominal_gain = nominal_gain.filter(|nominal| *nominal < sigma);
                    }
                    let compared = self.plant.as_ref().filter(|_| smallest && options.compare && run.claim().is_some());
                    if let (Some(plant), Some(sigma)) = (compared, run.sigma_star().map(Rational::to_f64)) {
                        let near = start.as_ref().and_then(|sought| sought.near.as_deref());
                        run.interval_costs = interval_costs((plant, near), sigma, watch);
                    }
                    if self.found_above.is_some() {
                        (run.given_gain, run.smallest_gain) = (None, self.found_above);
                    }
                    Run::Continuous(Box::new(run))
                })
            }
            Start::Sampled(sampling, start) => {
                let wanted = (gain, &self.limits);
                let near = start.as_ref().and_then(|sought| sought.near.as_deref());
                let others = start.as_ref().map_or(&[][..], |sought| &sought.others);
                let start = start.as_ref().map(|sought| &sought.proposal);
                let run = |spec, start| certify_sampled_within(spec, sampling, wanted, start, options.ladder);
                let others = others.iter().map(|(spec, proposal)| run(spec, Some(proposal)));
                let run = others.fold(run(spec, start), |known, other| match (known, other) {
                    (Ok(known), Ok(other)) => Ok(if other.is_better_than(&known) { other } else { known }),
                    (Err(_), other) => other,
                    (known, Err(_)) => known,
                });
                run.map(|mut run| {
                    let claimed = run.claim().map(|proof| proof.witness.sigma.to_f64());
                    if let Some(sigma) = claimed.filter(|_| options.compare && smallest) {
                        watch.enter(Stage::Comparison);
                        let subject = (spec, self.plant.as_deref().map(|plant| (plant, near)));
                        run.interval_costs = costs_at_samples(subject, (sampling, sigma), options.ladder, watch);
                    }
                    if options.compare {
                        run.set_gains(start, options.ladder);
                    }
                    if self.found_above.is_some() {
                        run.given_gain = None;
                    }
                    Run::Sampled(Box::new(run))
                })
            }
            Start::Given(FreeNumbers::Continuous(witness)) => {
                recheck(spec, witness, options).map(|run| Run::Continuous(Box::new(run)))
            }
            Start::Given(FreeNumbers::Sampled(witness)) => {
                recheck_sampled(spec, witness, options.ladder).map(|run| Run::Sampled(Box::new(run)))
            }
        };
        run.map_err(|refusal: Refusal| refusal.errors(spec))
    }
}

impl Prepared {
    /// All data, the first of them those for the smallest gain.
    fn pool<'s>(&'s self, start: Option<&'s Sought>, options: Options, watch: &dyn Watch) -> Vec<Member<'s>> {
        let others = start.map_or(&[][..], |sought| &sought.others);
        let others = others.iter().chain(self.by_norms.as_deref());
        let data: Vec<(&Specification, Option<&SharpProposal>)> =
            std::iter::once((&self.spec, start.map(|sought| &sought.proposal)))
                .chain(others.map(|(spec, proposal)| (spec, Some(proposal))))
                .collect();
        let mut pool = parallel::map(&data, |(spec, start)| Member::new(spec, *start, options));
        // Joint metrics, and the weights of a matrix inequality, are those of the smallest gain.
        let plant = self.plant.as_ref().filter(|plant| plant.initial_set.given()[0].is_none());
        let plant = plant.filter(|_| options.compare || self.gain.is_some());
        if let Some(plant) = plant.filter(|_| pool[0].goes_far() == Some(true)) {
            watch.enter(Stage::Comparison);
            let quick = || reduce_by_norms_quickly(plant).ok().map(|found| Box::new((found.spec, found.proposal)));
            if let Some((spec, proposal)) = self.quick.get_or_init(quick).as_deref() {
                pool.push(Member::new(spec, Some(proposal), options));
            }
        }
        pool
    }

    /// The run with a smaller gain that keeps to the limits by bounds that are proved for it, where there is one.
    fn closer<'s>(
        &'s self,
        run: Certification<'s>,
        options: Options,
        watch: &dyn Watch,
    ) -> Result<Certification<'s>, Refusal> {
        let gains = run.smallest_gain.zip(run.sigma_star().map(Rational::to_f64));
        let Some((plant, (least, found))) = self.plant.as_deref().filter(|_| self.gain.is_none()).zip(gains) else {
            return Ok(run);
        };
        let wanted = Wanted { limits: Some(&self.limits), ..Wanted::default() };
        let certified = |(spec, proposal): &'s ProvedData| {
            certify_member(&Member::new(spec, Some(proposal), options), options, wanted)
        };
        let gain = |(spec, proposal): &ProvedData| {
            let run = certify_member(&Member::new(spec, Some(proposal), options), options, wanted).ok()?;
            run.sigma_star().map(Rational::to_f64)
        };
        let data = self.closer.get_or_init(|| closer(plant, [least, found], gain, watch).map(Box::new));
        match data.as_deref() {
            Some(data) => Ok(better(run, certified(data)?)),
            None => Ok(run),
        }
    }
}

/// The one with the smaller gain of two runs, or at the same gain with the smaller bound of |e|, or with a gain at all; where neither has one, the
/// one that comes closer to what is asked for.
fn better<'s>(first: Certification<'s>, second: Certification<'s>) -> Certification<'s> {
    let takes_second = match (first.claim().is_some(), second.claim().is_some()) {
        (true, true) => second.is_better_than(&first),
        (false, false) => second.closer_to_limits_than(&first),
        (one, _) => !one,
    };
    let smallest_gain = [first.smallest_gain, second.smallest_gain].into_iter().flatten().reduce(f64::min);
    let taken = if takes_second { second } else { first };
    Certification { smallest_gain, ..taken }
}

/// What decides and samples bounds of the plant behind a specification, read from the copy of it that a certificate has.
fn around_again(spec: &Specification) -> Option<(Engine, FloatSuprema)> {
    let LyapunovSource::Plant(of_plant) = &spec.lyapunov else { return None };
    let document = Document::parse("the plant", &spec.document.to_string()).ok()?;
    let plant = Plant::from_value(&document.root()).ok()?;
    bounds_around(&plant, of_plant).ok()
}

impl Run<'_> {
    /// Proves rates for these numbers of oscillators at the gain of the claim, by norms or from the derivatives of the plant
    /// ([`Certification::prove_rates`], [`Certification::prove_rates_around`], [`SampledCertification::prove_rates`]). Where a least rate is to be
    /// kept and one of them is not proved to be as large there is no claim any more.
    ///
    /// # Errors
    /// Theirs.
    pub fn prove_rates(&mut self, counts: &[u32]) -> Result<(), NoRatesOfClaim> {
        match self {
            Run::Continuous(run) if !counts.is_empty() && run.matrix_arguments().is_some() => {
                let (engine, samples) = around_again(run.spec).ok_or(NoRatesOfClaim::OfFormulas)?;
                run.prove_rates_around(counts, (&engine, &samples))
            }
            Run::Continuous(run) => run.prove_rates(counts),
            Run::Sampled(run) => run.prove_rates(counts),
        }?;
        match self {
            Run::Continuous(run) => run.keep_to_rate(),
            Run::Sampled(run) => run.keep_to_rate(),
        }
        Ok(())
    }

    /// Takes the claim back because the independent checker does not come to it: it refuses the certificate, or gives up.
    pub fn is_not_decided_again(&mut self, refused: bool) {
        let reason = Failing::NotDecidedAgain { refused };
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
