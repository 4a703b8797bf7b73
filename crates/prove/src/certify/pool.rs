//! What is proved of a subject, as members of one pool (derivation, 13.5): data, and a witness at the smallest gain that was found with them.
//! That witness proves its claim for every larger gain, too, and every search at a larger gain starts from it; so no answer about a larger
//! gain is worse than what the smallest one proves.

use super::limits::{FloatLimits, NEAR, ROOMS};
use super::options::{Limits, Options, TransferChoice};
use super::outcome::{Outcome, has_smaller_peak, is_better};
use super::round::{TransferKind, round_sharp};
use rug::Rational;
use sigmastar_decide::conditions::SharpProof;
use sigmastar_decide::conditions::decide;
use sigmastar_lang::spec::Specification;
use sigmastar_propose::search::{
    Failing, FloatModel, Goal, Obstacle, SharpProposal, largest_at, search_sharp, search_sharp_at, search_sharp_near,
};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::sharp::{SharpEvaluation, SharpWitness};
use sigmastar_theory::transfer::{TradeOff, TransferProof, serves_every_set};

/// How many of the last steps on the way to a gain are starts, in turn, until one leads to a proof.
const STARTS: usize = 3;

/// The gains over the least one at which the shape of the error box is sought on the way to a larger one.
const STEPS: [f64; 10] = [1.02, 1.1, 1.3, 1.6, 2.2, 3.0, 5.0, 10.0, 30.0, 100.0];

/// What is asked of a search.
#[derive(Clone, Copy, Default)]
pub struct Wanted<'w> {
    /// Free numbers that are known to be near.
    pub start: Option<&'w SharpProposal>,
    /// The gain, where it is not to be found.
    pub gain: Option<&'w Rational>,
    /// What is to be kept at the gain.
    pub limits: Option<&'w Limits>,
}

/// A specification whose data are proved, and what is found with them at the smallest gain.
pub struct Member<'s> {
    pub(super) spec: &'s Specification,
    pub(super) data: Data<'s>,
    options: Options,
    /// With each proof of the transfer bound that serves; at least one.
    least: Vec<Least>,
}

/// The smallest gain that is found with one kind of proof of the transfer bound.
struct Least {
    kind: TransferKind,
    model: FloatModel,
    proposal: Result<SharpProposal, Obstacle>,
    /// Its witness, proved or not; none where no numbers were finite.
    attempt: Option<SharpProof>,
}

/// The outcome, with the model and the proposal that it came from.
#[derive(Clone)]
pub(super) struct BestSharp {
    pub(super) model: FloatModel,
    pub(super) proposal: Option<SharpProposal>,
    pub(super) outcome: Outcome<SharpProof>,
    /// At a gain that is given, with noise or a disturbance, a proof whose error box has more room.
    pub(super) roomy: Option<Box<SharpProof>>,
    /// About the smallest gain, where another one was sought.
    pub(super) smallest_gain: Option<f64>,
}

impl<'s> Member<'s> {
    /// Searches for the smallest gain, near a proposal where one is known, and decides it.
    #[must_use]
    pub fn new(spec: &'s Specification, start: Option<&SharpProposal>, options: Options) -> Member<'s> {
        let data = Data::new(spec, options.ladder.start.max(53));
        let with = |kind| Least::new(&data, options, kind, start);
        // What is asked for every set of harmonics is sought with proofs that serve them.
        let every_set = spec.internal_model.asks_every_set();
        let matched = TransferProof::Matched { k: 1 };
        let least = match options.transfer {
            TransferChoice::Best if every_set && data.matched && serves_every_set(&data, &matched) => {
                vec![with(TransferKind::Matched), with(TransferKind::ClosedForm)]
            }
            _ if every_set => vec![with(TransferKind::ClosedForm)],
            TransferChoice::Best => {
                let sharper = if data.matched { TransferKind::Matched } else { TransferKind::Boxes };
                vec![with(sharper), with(TransferKind::ClosedForm)]
            }
            TransferChoice::Boxes => {
                let boxes = with(TransferKind::Boxes);
                // Where no proof by boxes is found within its effort, the closed form still proves something.
                if boxes.proved().is_some() { vec![boxes] } else { vec![with(TransferKind::ClosedForm)] }
            }
            TransferChoice::ClosedForm => vec![with(TransferKind::ClosedForm)],
        };
        Member { spec, data, options, least }
    }

    /// The same data about a specification that differs in what is to be kept alone.
    pub(super) fn about<'t>(&self, spec: &'t Specification) -> Member<'t> {
        Member::new(spec, self.least.iter().find_map(|least| least.proposal.as_ref().ok()), self.options)
    }

    /// The proof with the smallest gain.
    pub(super) fn smallest(&self) -> Option<&SharpProof> {
        let proofs = self.least.iter().filter_map(Least::proved);
        proofs.reduce(|first, second| if second.witness.sigma < first.witness.sigma { second } else { first })
    }

    /// What the pool has of the data: at the gain that is given, at the smallest one with which the limits are kept, or at the smallest one.
    pub(super) fn best(&self, Wanted { gain, limits, .. }: Wanted<'_>) -> BestSharp {
        let asked = FloatLimits::new(self.spec, limits.unwrap_or(&Limits::default()));
        let one = |least: &Least| match (&asked, gain) {
            (Some(asked), _) => least.within(&self.data, self.options, (gain, limits), asked),
            (None, Some(gain)) => least.at(&self.data, self.options, gain),
            (None, None) => least.smallest(),
        };
        let mut all = self.least.iter().map(one);
        // There is one at least.
        let first = all.next().unwrap_or_else(|| Least::none(&self.data));
        all.fold(first, |first, second| if second.is_better_than(&first) { second } else { first })
    }
}

impl Least {
    fn new(data: &Data<'_>, options: Options, kind: TransferKind, start: Option<&SharpProposal>) -> Least {
        let model = model(data, kind);
        let near = start.and_then(|known| search_sharp_near(&model, known).ok());
        let proposal = near.map_or_else(|| search_sharp(&model), Ok);
        let attempt = proposal.as_ref().ok();
        let attempt = attempt.and_then(|proposal| round_sharp(data, &model, proposal, (kind, None), options.ladder));
        Least { kind, model, proposal, attempt }
    }

    fn none(data: &Data<'_>) -> BestSharp {
        BestSharp::refused(model(data, TransferKind::ClosedForm), Failing::NotFinite(None).into())
    }

    fn proved(&self) -> Option<&SharpProof> {
        self.attempt.as_ref().filter(|proof| proof.truth().is_true())
    }

    fn smallest(&self) -> BestSharp {
        let outcome = match &self.proposal {
            Err(obstacle) => Outcome::NotFound(*obstacle),
            Ok(_) => self.attempt.clone().into(),
        };
        BestSharp { model: self.model.clone(), proposal: self.proposal.ok(), outcome, roomy: None, smallest_gain: None }
    }

    /// At a gain that is given: the witness with the smallest bound of |e|, of a new one and of the one of the smallest gain, whose claim is
    /// about every larger gain.
    fn at(&self, data: &Data<'_>, options: Options, gain: &Rational) -> BestSharp {
        let Least { kind, model, proposal, .. } = self;
        let refused = |obstacle: Obstacle| BestSharp::refused(model.clone(), obstacle);
        let least = match proposal {
            Err(obstacle) => return refused(*obstacle),
            Ok(least) => least,
        };
        let known = self.proved().filter(|proof| proof.witness.sigma <= *gain).map(|proof| {
            let witness = SharpWitness { sigma: gain.clone(), ..proof.witness.clone() };
            let there = SharpProposal { sigma: gain.to_f64(), ..*least };
            (model.clone(), there, decide(data.spec, witness, options.ladder))
        });
        if known.is_none() && least.sigma > gain.to_f64() {
            let smallest = Some((least.sigma, least.binding));
            return refused(Failing::Gain { given: gain.to_f64(), smallest }.into());
        }
        let is_proved = |found: &(FloatModel, SharpProposal, SharpProof)| found.2.truth().is_true();
        let starts = self.along(gain.to_f64(), least);
        // The claim of a step on the way is about every larger gain, too.
        let of_a_step = |start: &SharpProposal| {
            let (model, step) = (model.with_goal(Goal::Peak), Rational::from_f64(start.sigma)?);
            let proof = round_sharp(data, &model, start, (*kind, Some(&step)), options.ladder)?;
            let witness = SharpWitness { sigma: gain.clone(), ..proof.witness };
            let there = SharpProposal { sigma: gain.to_f64(), ..*start };
            Some((model, there, decide(data.spec, witness, options.ladder)))
        };
        let mut peaks = starts.iter().copied().rev().take(STARTS).chain([*least]).filter_map(|start| {
            let model = model.with_goal(Goal::Peak);
            let found = search_sharp_at(&model, gain.to_f64(), Some(&start)).ok()?;
            let proof = round_sharp(data, &model, &found, (*kind, Some(gain)), options.ladder)?;
            Some((model, found, proof))
        });
        let peak = peaks.find(is_proved).or_else(|| starts.iter().rev().filter_map(of_a_step).find(is_proved));
        let mut found: Vec<_> = peak.into_iter().chain(known).filter(is_proved).collect();
        let threshold = || {
            let found = search_sharp_at(model, gain.to_f64(), Some(least)).ok()?;
            let proof = round_sharp(data, model, &found, (*kind, Some(gain)), options.ladder)?;
            Some((model.clone(), found, proof))
        };
        // The box with which e goes the least far has no room for what noise and a disturbance add.
        let roomy = if data.spec.disturbances.any() { threshold().filter(is_proved) } else { None };
        let roomy = roomy.map(|(.., proof)| Box::new(proof));
        if found.is_empty() {
            found.extend(threshold());
        }
        let best = found.into_iter().reduce(|a, b| if has_smaller_peak(&b.2, &a.2) { b } else { a });
        match best {
            Some((model, proposal, proof)) => BestSharp {
                roomy,
                proposal: Some(proposal),
                outcome: Some(proof).into(),
                ..BestSharp::refused(model, Failing::NotFinite(None).into())
            },
            None => refused(Failing::NotFinite(None).into()),
        }
    }

    /// The proposals with the smallest bounds of |e| that are reached from the least gain in steps: the shape of the error box changes with the
    /// gain, and the search for it is local.
    fn along(&self, gain: f64, least: &SharpProposal) -> Vec<SharpProposal> {
        let model = self.model.with_goal(Goal::Peak);
        let mut found: Vec<SharpProposal> = Vec::new();
        for step in STEPS.iter().map(|step| step * least.sigma).take_while(|step| *step < gain) {
            found.extend(search_sharp_at(&model, step, Some(found.last().unwrap_or(least))));
        }
        found
    }

    /// At the smallest gain with which the limits are kept, or at the one that is given.
    fn within(
        &self,
        data: &Data<'_>,
        options: Options,
        (gain, asked): (Option<&Rational>, Option<&Limits>),
        limits: &FloatLimits,
    ) -> BestSharp {
        let Least { kind, model, .. } = self;
        let kind = *kind;
        let kept = |proof: &SharpProof| {
            let SharpEvaluation { periodic, peak, control, .. } = &proof.evaluation;
            asked.is_none_or(|limits| limits.kept([&periodic.e_per, peak], control))
        };
        let least = match (gain, &self.proposal) {
            (_, Err(obstacle)) => return BestSharp::refused(model.clone(), *obstacle),
            (None, Ok(least)) => *least,
            (Some(gain), Ok(_)) => {
                let known = self.at(data, options, gain);
                match known.proposal {
                    Some(proposal) if !known.outcome.proved().is_some_and(kept) => proposal,
                    _ => return known,
                }
            }
        };
        let smallest_gain = gain.is_none().then_some(least.sigma);
        let refused = |obstacle| BestSharp { smallest_gain, ..BestSharp::refused(model.clone(), obstacle) };
        // The smallest gain itself may do, but for rounding.
        let is_it = |proof: &SharpProof| proof.witness.sigma <= least.sigma * NEAR;
        if let Some(proof) = self.proved().filter(|proof| gain.is_none() && is_it(proof) && kept(proof)) {
            let outcome = Some(proof.clone()).into();
            return BestSharp { model: model.clone(), proposal: Some(least), outcome, roomy: None, smallest_gain };
        }
        let at = |goal: Goal, sigma: f64| {
            let model = model.with_goal(goal);
            let proposal = search_sharp_at(&model, sigma, Some(&least))?;
            largest_at(&model, &proposal).map(|largest| (proposal, largest))
        };
        let mut attempt = None;
        for room in ROOMS {
            let found = match limits.smallest([least.sigma, f64::INFINITY], (gain.is_some(), room), at) {
                Ok(found) => found,
                Err(obstacle) => return attempt.unwrap_or_else(|| refused(obstacle)),
            };
            let sigma = gain.cloned().or_else(|| found.sigma());
            let with = model.with_goal(found.goal);
            let proof = round_sharp(data, &with, &found.proposal, (kind, sigma.as_ref()), options.ladder);
            let outcome: Outcome<SharpProof> = match proof {
                // Nothing is claimed that does not keep to what was asked for.
                Some(proof) if !kept(&proof) => Outcome::NotFound(found.failing().into()),
                proof => proof.into(),
            };
            let proved = outcome.proved().is_some();
            attempt =
                Some(BestSharp { model: with, proposal: Some(found.proposal), outcome, roomy: None, smallest_gain });
            if proved {
                break;
            }
        }
        attempt.unwrap_or_else(|| refused(Failing::NotFinite(None).into()))
    }
}

impl BestSharp {
    fn refused(model: FloatModel, obstacle: Obstacle) -> BestSharp {
        BestSharp { model, proposal: None, outcome: Outcome::NotFound(obstacle), roomy: None, smallest_gain: None }
    }

    /// Whether it has a proof where the other has none, or one with a smaller gain, or at the same gain with a smaller bound of |e|.
    fn is_better_than(&self, other: &BestSharp) -> bool {
        match (self.outcome.proved(), other.outcome.proved()) {
            (Some(one), Some(other)) => is_better(one, other),
            (one, other) => one.is_some() && other.is_none(),
        }
    }
}

pub(super) fn model(data: &Data<'_>, kind: TransferKind) -> FloatModel {
    let trade_off = match kind {
        TransferKind::Matched => TradeOff::matched(data),
        TransferKind::Boxes => TradeOff::curve(data),
        TransferKind::ClosedForm => TradeOff::closed_form(data),
    };
    FloatModel::new(data, trade_off)
}
