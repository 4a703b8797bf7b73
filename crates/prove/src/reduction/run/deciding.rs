//! From data that are proved to a decided claim: of all that the pool certifies the best that the independent checker decides, too.

use super::{Last, Prepared, Run, Start};
use crate::certify::{
    Alternatives, ByCount, Certification, Member, Options, Outcome, Refusal, Wanted, certify_member,
    certify_sampled_within, recheck, recheck_sampled,
};
use crate::reduction::closer::closer;
use crate::reduction::interval_costs::{costs_at_samples, interval_costs};
use crate::reduction::proofs::ProvedData;
use crate::reduction::reduce::{reduce_by_norms_quickly, reduce_by_norms_watched};
use crate::reduction::subject::{Sought, SoughtAtSamples};
use crate::reduction::{FreeNumbers, RestsOn, Stage, Unwatched, Watch, reduce_sampled};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::parallel;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Oscillators, Sampling, SpecErrors, Specification};
use sigmastar_propose::search::{Failing, Limited, SharpProposal};

/// What the independent checker says of the certificate of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Checked {
    /// It decides the claim.
    Decided,
    /// It gives up within its effort.
    GivenUp,
    /// It refuses it.
    Refused,
}

/// Claims, best first: those of the first batch; where none of these is taken, those of the next.
#[derive(Clone, Copy)]
enum Batch {
    /// What answers the question best.
    First,
    /// Other members of the pool.
    Others,
    /// Data by norms that are proved where the checker gives up on all of these.
    Last,
}

impl Prepared {
    /// Searches, rounds and decides; no checker is asked. Hypothesis: the options fit ([`Options::misfit`]).
    ///
    /// # Errors
    /// What the data are refused for, at its place; not empty.
    pub fn certify(&self, options: Options) -> Result<Run<'_>, Vec<SpecErrors>> {
        self.certify_checked(options, &|_| Checked::Decided, &Unwatched)
    }

    /// Searches, rounds and decides, and has a checker decide the claims again: the best claim that it decides, and none where it decides
    /// none. Hypothesis: that of [`Prepared::certify`]. A claim that is to keep to its actuator by the number of oscillators is one only once
    /// [`Run::prove_rates`] has judged that, without numbers too: before, it may be a claim that does not, of which the checker was not asked.
    ///
    /// # Errors
    /// Those of [`Prepared::certify`].
    pub fn certify_checked(
        &self,
        options: Options,
        check: &dyn Fn(&Run<'_>) -> Checked,
        watch: &dyn Watch,
    ) -> Result<Run<'_>, Vec<SpecErrors>> {
        watch.enter(Stage::Witness);
        let counted = |run: &mut Run<'_>, besides: &[Oscillators]| {
            let plant = self.formulas.as_deref();
            if let Some(plant) = plant.filter(|_| options.compare || self.limits.by_count.is_some()) {
                run.set_counts(plant, besides);
            }
        };
        let asked: Vec<Oscillators> =
            self.counts.iter().copied().map(Oscillators::first).chain(self.sets.iter().cloned()).collect();
        let counts = Counts { of: &counted, asked: &asked, keep: true };
        let run = match &self.start {
            Start::Continuous(start) => {
                let pool = self.pool(start.as_deref(), options, watch);
                let claims = |batch: Batch| self.claims(&pool, options, batch, watch);
                let run = first_decided(claims, &counts, check);
                run.map(|run| self.compared(run, &pool, start.as_deref(), options, watch))
            }
            Start::Sampled(sampling, start) => {
                let claims = |batch: Batch| self.claims_at_samples(sampling, start.as_ref(), options, batch, watch);
                let run = first_decided(claims, &counts, check);
                run.map(|run| self.compared_at_samples(run, sampling, start.as_ref(), options, watch))
            }
            Start::Given(numbers) => {
                let claims = |batch: Batch| Ok(self.given(numbers, options, batch)?.into_iter().collect());
                first_decided(claims, &Counts { of: &|_, _| (), asked: &[], keep: false }, check)
            }
        };
        run.map_err(|refusal: Refusal| refusal.errors(&self.spec))
    }

    /// Whether it is the smallest gain that is sought: figures about it say nothing about another one.
    fn seeks_smallest(&self) -> bool {
        self.gain.is_none() && self.limits.is_empty() && self.spec.actuator.is_none()
    }

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
            if options.compare {
                watch.enter(Stage::Comparison);
            }
            let quick = || reduce_by_norms_quickly(plant).ok().map(|found| Box::new((found.spec, found.proposal)));
            if let Some((spec, proposal)) = self.quick.get_or_init(quick).as_deref() {
                pool.push(Member::new(spec, Some(proposal), options));
            }
        }
        pool
    }

    /// What the members of the pool certify, best first.
    fn claims<'s>(
        &'s self,
        pool: &[Member<'s>],
        options: Options,
        batch: Batch,
        watch: &dyn Watch,
    ) -> Result<Vec<Run<'s>>, Refusal> {
        let wanted = Wanted { start: None, gain: self.gain.as_ref(), limits: Some(&self.limits) };
        // The data that were proved for the smallest gain know it best.
        let own = if self.seeks_smallest() { 1 } else { pool.len() };
        let certified = |member: &Member<'s>| certify_member(member, options, wanted);
        let runs: Vec<_> = match batch {
            Batch::First => pool[..own].iter().map(certified).collect(),
            Batch::Others => pool[own..].iter().map(certified).collect(),
            Batch::Last => {
                let plant = self.plant.as_deref().filter(|_| self.by_norms.is_none());
                let by_norms = |plant| {
                    let found = reduce_by_norms_watched(plant, watch).ok()?;
                    Some(Last::Continuous(Box::new((found.spec, found.proposal))))
                };
                match self.last.get_or_init(|| plant.and_then(by_norms)) {
                    Some(Last::Continuous(data)) => {
                        vec![certified(&Member::new(&data.0, Some(&data.1), options))]
                    }
                    _ => Vec::new(),
                }
            }
        };
        let mut runs = served(runs)?;
        if let (Batch::First, Some(run)) = (batch, runs.first()) {
            runs.extend(self.closer(run, options, watch)?);
        }
        let smallest = runs.iter().filter_map(|run| run.smallest_gain).reduce(f64::min);
        let mut runs: Vec<Run<'_>> = runs
            .into_iter()
            .map(|run| Run::Continuous(Box::new(Certification { smallest_gain: smallest, ..run })))
            .collect();
        best_first(&mut runs);
        Ok(runs)
    }

    /// The run with a smaller gain that keeps to the limits by bounds that are proved for it, where there is one.
    fn closer<'s>(
        &'s self,
        run: &Certification<'s>,
        options: Options,
        watch: &dyn Watch,
    ) -> Result<Option<Certification<'s>>, Refusal> {
        let gains = run.smallest_gain.zip(run.sigma_star().map(Rational::to_f64));
        let plant = self.plant.as_deref().filter(|_| self.gain.is_none());
        let Some((plant, (least, found))) = plant.zip(gains) else { return Ok(None) };
        let wanted = Wanted { limits: Some(&self.limits), ..Wanted::default() };
        let gain = |(spec, proposal): &ProvedData| {
            let run = certify_member(&Member::new(spec, Some(proposal), options), options, wanted).ok()?;
            run.sigma_star().map(Rational::to_f64)
        };
        let data = self.closer.get_or_init(|| closer(plant, [least, found], gain, watch).map(Box::new));
        let certified =
            |data: &'s ProvedData| certify_member(&Member::new(&data.0, Some(&data.1), options), options, wanted);
        data.as_deref().map(certified).transpose()
    }

    /// The run with what is said beside the claim.
    fn compared<'s>(
        &self,
        run: Run<'s>,
        pool: &[Member<'_>],
        start: Option<&Sought>,
        options: Options,
        watch: &dyn Watch,
    ) -> Run<'s> {
        let Run::Continuous(mut run) = run else { return run };
        if options.compare {
            watch.enter(Stage::Comparison);
        }
        // The data that were proved for the smallest gain know it best.
        let proposal = start.map(|sought| &sought.proposal);
        run.smallest_gain = run.smallest_gain.map(|least| proposal.map_or(least, |known| known.sigma.min(least)));
        if options.compare {
            run.set_gains(pool, &self.counts);
            if let Some(plant) = self.formulas.as_deref() {
                run.set_counts_of_rows(plant);
            }
        }
        let smallest = self.seeks_smallest();
        let alternatives = start.filter(|_| smallest).map(|sought| sought.alternatives);
        if let Some(Alternatives { by_norms, aligned, nominal_gain }) = alternatives
            && let Some(sigma) = run.sigma_star().map(Rational::to_f64)
        {
            // From few samples norms may seem to need less than they do.
            run.alternatives.by_norms = by_norms.filter(|by_norms| *by_norms > sigma);
            run.alternatives.aligned = run.alternatives.aligned.or(aligned).filter(|aligned| *aligned < sigma);
            let nominal_gain = run.alternatives.nominal_gain.or(nominal_gain);
            run.alternatives.nominal_gain = nominal_gain.filter(|nominal| *nominal < sigma);
        }
        let plant = self.plant.as_ref().filter(|_| smallest && options.compare && run.claim().is_some());
        if let (Some(plant), Some(sigma)) = (plant, run.sigma_star().map(Rational::to_f64)) {
            let near = start.and_then(|sought| sought.near.as_deref());
            run.interval_costs = interval_costs((plant, near), sigma, watch);
        }
        if self.found_above.is_some() {
            (run.given_gain, run.smallest_gain) = (None, self.found_above);
        }
        Run::Continuous(run)
    }

    /// What is certified of the regulator at samples, best first.
    fn claims_at_samples<'s>(
        &'s self,
        sampling: &Sampling,
        start: Option<&'s SoughtAtSamples>,
        options: Options,
        batch: Batch,
        watch: &dyn Watch,
    ) -> Result<Vec<Run<'s>>, Refusal> {
        let wanted = (self.gain.as_ref(), &self.limits);
        let run = |spec, start| certify_sampled_within(spec, sampling, wanted, start, options.ladder);
        let runs = match batch {
            Batch::First => {
                let others = start.map_or(&[][..], |sought| &sought.others);
                let own = run(&self.spec, start.map(|sought| &sought.proposal));
                std::iter::once(own).chain(others.iter().map(|(spec, proposal)| run(spec, Some(proposal)))).collect()
            }
            Batch::Others => Vec::new(),
            Batch::Last => {
                let by_norms = |plant| {
                    let found = reduce_sampled(plant, sampling, (self.gain.as_ref(), RestsOn::Norms), watch).ok()?;
                    Some(Last::Sampled(Box::new(found.spec), found.proposal))
                };
                match self.last.get_or_init(|| self.plant.as_deref().and_then(by_norms)) {
                    Some(Last::Sampled(spec, proposal)) => vec![run(spec, Some(proposal))],
                    _ => Vec::new(),
                }
            }
        };
        let mut runs: Vec<Run<'_>> = served(runs)?.into_iter().map(|run| Run::Sampled(Box::new(run))).collect();
        best_first(&mut runs);
        Ok(runs)
    }

    /// The run at samples with what is said beside the claim.
    fn compared_at_samples<'s>(
        &self,
        run: Run<'s>,
        sampling: &Sampling,
        start: Option<&SoughtAtSamples>,
        options: Options,
        watch: &dyn Watch,
    ) -> Run<'s> {
        let Run::Sampled(mut run) = run else { return run };
        let claimed = run.claim().map(|proof| proof.witness.sigma.to_f64());
        if let Some(sigma) = claimed.filter(|_| options.compare && self.seeks_smallest()) {
            watch.enter(Stage::Comparison);
            let near = start.and_then(|sought| sought.near.as_deref());
            let subject = (&self.spec, self.plant.as_deref().map(|plant| (plant, near)));
            run.interval_costs = costs_at_samples(subject, (sampling, sigma), options.ladder, watch);
        }
        run.norms_from = self.norms_from;
        if options.compare {
            run.set_gains(start.map(|sought| &sought.proposal), options.ladder);
            if let Some(plant) = self.formulas.as_deref() {
                run.set_counts_of_rows(plant);
            }
        }
        if self.found_above.is_some() {
            run.given_gain = None;
        }
        Run::Sampled(run)
    }

    /// The witness that is given, decided again.
    fn given(&self, numbers: &FreeNumbers, options: Options, batch: Batch) -> Result<Option<Run<'_>>, Refusal> {
        let Batch::First = batch else { return Ok(None) };
        Ok(Some(match numbers {
            FreeNumbers::Continuous(witness) => Run::Continuous(Box::new(recheck(&self.spec, witness, options)?)),
            FreeNumbers::Sampled(witness) => {
                Run::Sampled(Box::new(recheck_sampled(&self.spec, witness, options.ladder)?))
            }
        }))
    }
}

/// What adds to a claim what its certificate says by the number of oscillators, of given oscillators besides, and those that are asked for.
struct Counts<'c, 's> {
    of: &'c dyn Fn(&mut Run<'s>, &[Oscillators]),
    asked: &'c [Oscillators],
    /// Whether a claim that keeps to its actuator by them is to be judged.
    keep: bool,
}

impl<'s> Counts<'_, 's> {
    /// A claim that is to keep to its actuator by what it says by the number of oscillators, with that, and the answer of the checker: where that takes too
    /// much what is asked for is left out. One that does not keep to it the checker is not asked about: whether it does is judged with the limits
    /// ([`Run::prove_rates`]).
    fn kept(&self, mut run: Run<'s>, check: &dyn Fn(&Run<'_>) -> Checked) -> (Run<'s>, Checked) {
        let mut answer = Checked::Decided;
        for asked in [self.asked, &[]] {
            (self.of)(&mut run, asked);
            answer = if run.keeps_actuator() { check(&run) } else { Checked::Decided };
            if answer != Checked::GivenUp || self.asked.is_empty() {
                break;
            }
        }
        (run, answer)
    }

    /// A claim that the checker decides with what its certificate says by the number of oscillators, as far as the checker decides that: where it does not,
    /// first what is asked for is left out, then all of it.
    fn added(&self, mut run: Run<'s>, check: &dyn Fn(&Run<'_>) -> Checked) -> Run<'s> {
        (self.of)(&mut run, self.asked);
        let has_more = |run: &Run<'_>| run.by_count().is_some() && check(run) != Checked::Decided;
        let mut is_too_much = has_more(&run);
        if is_too_much && !self.asked.is_empty() {
            (self.of)(&mut run, &[]);
            is_too_much = has_more(&run);
        }
        if let Some(found) = run.by_count_mut().filter(|_| is_too_much) {
            found.checked = false;
        }
        run
    }
}

/// The first claim that the checker decides; where there is none, the best run with its claim taken back. What takes long to find is added to a claim that
/// is decided alone.
fn first_decided<'s>(
    claims: impl Fn(Batch) -> Result<Vec<Run<'s>>, Refusal>,
    counts: &Counts<'_, 's>,
    check: &dyn Fn(&Run<'_>) -> Checked,
) -> Result<Run<'s>, Refusal> {
    let mut best: Option<Run<'s>> = None;
    let mut answer = Checked::Decided;
    for batch in [Batch::First, Batch::Others, Batch::Last] {
        // What takes whole searches is for claims that the checker does not come to.
        if matches!(batch, Batch::Last) && answer == Checked::Decided {
            break;
        }
        for run in claims(batch)? {
            if run.certified().is_none() {
                best = best.or(Some(run));
                continue;
            }
            let by_count = counts.keep && run.spec().actuator.as_ref().is_some_and(|actuator| actuator.by_count);
            let (run, answered) = match by_count {
                true => counts.kept(run, check),
                false => {
                    let answered = check(&run);
                    (run, answered)
                }
            };
            match answered {
                Checked::Decided if by_count => return Ok(run),
                Checked::Decided => return Ok(counts.added(run, check)),
                // The first claim, in the place of a run without one.
                other if answer == Checked::Decided => (best, answer) = (Some(run), other),
                _ => {}
            }
        }
    }
    // A first batch has a run, or says why there is none.
    let mut best = best.ok_or_else(|| Refusal::Bounds(Vec::new()))?;
    best.answered(answer);
    Ok(best)
}

/// The runs that there are; where there is none, the first refusal.
fn served<R>(runs: Vec<Result<R, Refusal>>) -> Result<Vec<R>, Refusal> {
    let (runs, mut refusals): (Vec<_>, Vec<_>) = runs.into_iter().partition(Result::is_ok);
    if runs.is_empty() && !refusals.is_empty() {
        return Err(refusals.swap_remove(0).err().unwrap_or(Refusal::Sampled));
    }
    Ok(runs.into_iter().filter_map(Result::ok).collect())
}

/// Best first; of runs that are as good the first stays first.
fn best_first(runs: &mut [Run<'_>]) {
    runs.sort_by(|a, b| b.is_better_than(a).cmp(&a.is_better_than(b)));
}

impl Run<'_> {
    /// Finds bounds by the number of oscillators at the gain of the claim, of those `besides`, too, where the plant has some
    /// ([`Certification::set_counts`]): the certificate of the run then has them, for a checker to decide.
    pub fn set_counts(&mut self, plant: &Plant, besides: &[Oscillators]) {
        match self {
            Run::Continuous(run) => run.set_counts(plant, besides),
            Run::Sampled(run) => run.set_counts(plant, besides),
        }
        if let Some(found) = self.by_count_mut() {
            found.checked = true;
        }
    }

    /// Takes the claim back where it is to keep to its actuator by what is proved for every number of oscillators, and does not.
    pub(super) fn keep_to_actuator(&mut self) {
        let Some(sigma) = self.certified().map(|claim| claim.sigma.to_f64()).filter(|_| !self.keeps_actuator()) else {
            return;
        };
        let asked = self.spec().actuator.as_ref().map_or(f64::NAN, |actuator| actuator.max.to_f64());
        let least = self.stated_control().map_or(f64::INFINITY, |found| found.upper_f64());
        self.take_back(Failing::Limit { which: Limited::Actuator, asked, beside: None, least, sigma, proved: true });
    }

    /// Of a run without a claim, by how much the limit is missed that keeps it from one; infinite where that is none.
    pub(super) fn missed_share(&self) -> f64 {
        let failing = match self {
            Run::Continuous(run) => match &run.sharp {
                Outcome::NotFound(obstacle) => Some(&obstacle.failing),
                _ => None,
            },
            Run::Sampled(run) => match &run.outcome {
                Outcome::NotFound(obstacle) => Some(&obstacle.failing),
                _ => None,
            },
        };
        match failing {
            // No gain and no bound helps.
            Some(Failing::Start { .. }) => 0.0,
            Some(Failing::Limit { asked, least, .. }) => least / asked,
            _ => f64::INFINITY,
        }
    }

    /// Of what is put out at all times with every number of oscillators, as the certificate has it; none where it says nothing of that.
    fn stated_control(&self) -> Option<Enclosure> {
        self.by_count().filter(|found| found.checked).and_then(ByCount::stated_control)
    }

    /// Whether what is proved for every number of oscillators keeps to the actuator, where a claim is to keep to it by that.
    fn keeps_actuator(&self) -> bool {
        let Some(actuator) = self.spec().actuator.as_ref().filter(|actuator| actuator.by_count) else { return true };
        let upper = self.stated_control().and_then(|found| found.upper_rational());
        upper.zip(actuator.largest()).is_some_and(|(upper, largest)| upper <= largest)
    }

    fn take_back(&mut self, reason: Failing) {
        match self {
            Run::Continuous(run) => run.take_back(reason),
            Run::Sampled(run) => run.take_back(reason),
        }
    }

    /// Whether its certificate says something by the number of oscillators.
    #[must_use]
    pub fn says_by_count(&self) -> bool {
        self.by_count().is_some_and(|found| found.checked)
    }

    pub(super) fn by_count(&self) -> Option<&ByCount> {
        match self {
            Run::Continuous(run) => run.by_count.as_ref(),
            Run::Sampled(run) => run.by_count.as_ref(),
        }
    }

    fn by_count_mut(&mut self) -> Option<&mut ByCount> {
        match self {
            Run::Continuous(run) => run.by_count.as_mut(),
            Run::Sampled(run) => run.by_count.as_mut(),
        }
    }

    /// Whether it has a claim and the other one has none, or a better one; where neither has one, whether it comes closer to what was asked for.
    fn is_better_than(&self, other: &Run<'_>) -> bool {
        match (self.certified().is_some(), other.certified().is_some(), self, other) {
            (true, false, ..) => true,
            (false, true, ..) => false,
            (true, true, Run::Continuous(one), Run::Continuous(other)) => one.is_better_than(other),
            (true, true, Run::Sampled(one), Run::Sampled(other)) => one.is_better_than(other),
            (false, false, Run::Continuous(one), Run::Continuous(other)) => one.closer_to_limits_than(other),
            _ => false,
        }
    }
}
