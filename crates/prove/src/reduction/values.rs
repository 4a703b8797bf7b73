//! The bounds of a plant proved at the arguments of a proposal, and the best proposal with what is proved there.

use super::coordinates::{Chosen, SHAPE_STEP, best_shape_near};
use super::entries::{Needed, needed};
use super::proofs::{PRECISION, Proofs, Reduced, trade_off};
use super::refusal::PlantRefusal;
use crate::certify::Alternatives;
use sigmastar_exact::number::Portable;
use sigmastar_propose::search::{
    AtSigma, Closest, Descent, Failing, FloatModel, Goal, Obstacle, ROOM, SharpParameters, SharpProposal, at_sigma,
    minimise, search_sharp_near,
};
use sigmastar_theory::data::Data;

/// How far beyond the arguments of a proposal the bounds are proved, in turn: with room for what the proved values are larger than
/// the sampled ones, and close to the arguments.
pub(super) const ENLARGED: [f64; 2] = [1e-2, 1e-5];

/// The room between both sides of S1 and S2 that the proposal leaves, and how far beyond its arguments the bounds are proved, in turn, for a
/// gain that may become larger in return. They are tried while the proved values lead to no gain near the proposal. Where the least set
/// ceases to be one, that of a somewhat larger gain has room for proved values.
const FURTHER: [(f64, f64); 6] =
    [(ROOM, 5e-3), (ROOM, 1e-2), (2e-2, 5e-3), (5e-2, 1.25e-2), (0.1, 2.5e-2), (0.3, 7.5e-2)];

/// How often the arguments are taken again between the gain of samples and that of proved values, first half way, and how far beyond, in
/// turn; the share by which the gains have to be apart for less than half of the way to be tried where that is too far.
const AGAIN: usize = 4;
const APART: f64 = 1.02;
const CLOSE: [f64; 2] = [1e-4, 2e-3];

/// The search for the shape of the error box at a gain that is given, and what stays between samples and proofs, in turn: the
/// room in S1, S2 and the box, and the share of the gain that the threshold is at most.
const AT_GAIN: Descent = Descent { restarts: 1, iterations: 120, tolerance: 1e-3 };
const BELOW_GAIN: [(f64, f64); 4] = [(ROOM, 0.99), (2e-2, 0.97), (0.1, 0.9), (0.2, 0.7)];

/// A gain from proved values that is at most so many times the proposal is near it.
const NEAR: f64 = 1.1;

/// How far above the gain of a proposal the arguments are taken: close to the least gain at which there is a set, a little room
/// in its inequalities takes more than the same share of the gain, and the first that has a set is used.
const ABOVE: [f64; 7] = [1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3];

/// A smaller gain than by this share is not worth another round of proofs.
const WORTH: f64 = 1e-4;

/// Proves the bounds at the arguments of a proposal, looks for the best proposal with them, and once more near its arguments.
pub(super) fn prove_bounds(proofs: &Proofs<'_>, chosen: &Chosen) -> Result<Reduced, PlantRefusal> {
    let (model, proposal) = (&chosen.model, &chosen.proposal);
    let (mut best, mut closest): (Option<(FloatModel, Reduced)>, _) = (None, Closest::default());
    let mut refused = None;
    for (room, enlarged) in FURTHER {
        let model = &model.clone().with_room(room);
        // None that leaves more room may be near.
        let roomy = search_sharp_near(model, proposal).map_or(*proposal, |roomy| best_shape_near(model, roomy));
        match proofs.with_values(model, &roomy, 0.0, enlarged) {
            Ok(Ok(found)) if smaller(&found.1, best.as_ref()) => best = Some(found),
            Ok(Ok(_)) => {}
            Ok(Err(obstacle)) => closest.record(beyond_the_bounds(obstacle)),
            Err(refusal) => refused = refused.or(Some(refusal)),
        }
        if best.as_ref().is_some_and(|(_, found)| found.proposal.sigma < proposal.sigma * NEAR) {
            break;
        }
    }
    let mut way = 0.5;
    for _ in 0..AGAIN {
        let Some((values, found)) = &best else { break };
        let whole = (proposal.sigma / found.proposal.sigma).min(1.0).portable_ln();
        let between = (way * whole).portable_exp() - 1.0;
        let closer = CLOSE.into_iter().find_map(|close| {
            let closer = proofs.with_values(values, &found.proposal, between, close).ok()?.ok()?;
            smaller(&closer.1, best.as_ref()).then_some(closer)
        });
        match closer {
            Some(closer) => best = Some(closer),
            None if found.proposal.sigma > proposal.sigma * APART => way *= 0.5,
            None => break,
        }
    }
    let best = best.map(|(_, found)| found);
    if let (None, Some(refusal)) = (&best, refused) {
        return Err(refusal);
    }
    closest.or(best).map_err(PlantRefusal::NoGain)
}

/// Whether a gain is smaller by what is worth it.
fn smaller(found: &Reduced, best: Option<&(FloatModel, Reduced)>) -> bool {
    best.is_none_or(|(_, known)| found.proposal.sigma < known.proposal.sigma * (1.0 - WORTH))
}

impl Proofs<'_> {
    /// The best proposal with the values proved at the arguments of a proposal, and these values as a model.
    fn with_values(
        &self,
        model: &FloatModel,
        proposal: &SharpProposal,
        above: f64,
        enlarged: f64,
    ) -> Result<Result<(FloatModel, Reduced), Obstacle>, PlantRefusal> {
        let at = arguments(model, proposal, above, enlarged, self.along.second().is_some())?;
        let (with_values, spec) = self.with_needed(&at, |values| values)?;
        Ok(search_sharp_near(&with_values, proposal).map(|proposal| {
            (
                with_values,
                Reduced { spec, proposal, alternatives: Alternatives::default(), others: Vec::new(), near: None },
            )
        }))
    }

    /// The values proved at the sets of a gain above the least one, with the shape of the error box with which the error goes the least far
    /// there.
    pub(super) fn for_gain(
        &self,
        Chosen { model, proposal, .. }: &Chosen,
        proved: &Reduced,
        gain: f64,
    ) -> Option<Reduced> {
        // With the weights that are proved the threshold is the same at every gain.
        let data = Data::new(&proved.spec, PRECISION);
        let inequality = FloatModel::new(&data, trade_off(&data)).by_matrix;
        let known = model.with_inequalities(inequality, model.by_energy.clone());
        let (_, AtSigma { rho, eta, .. }) = at_sigma(&known, &proved.proposal.parameters, gain, ROOM).ok()?;
        let with = |p: &[f64]| SharpParameters {
            rho: 1.0 + p[0].portable_exp(),
            eta: p[1].portable_exp(),
            ..proposal.parameters
        };
        let start = [(rho - 1.0).portable_ln(), eta.portable_ln()];
        BELOW_GAIN.into_iter().find_map(|(room, below)| {
            let model = &model.clone().with_room(room);
            let peak = model.with_goal(Goal::Peak);
            let cost = |p: &[f64]| {
                let (_, at) = at_sigma(&peak, &with(p), gain, room).ok()?;
                (at.threshold <= gain * below).then(|| at.cost.portable_ln())
            };
            let (best, _) = minimise(&cost, &start, &[SHAPE_STEP; 2], AT_GAIN)?;
            let there = SharpProposal { parameters: with(&best), sigma: gain, ..*proposal };
            let (_, found) = self.with_values(model, &there, 0.0, ENLARGED[0]).ok()?.ok()?;
            (found.proposal.sigma <= gain).then_some(found)
        })
    }
}

/// Where the values of a plant have none, they are not proved so far.
pub(super) fn beyond_the_bounds(obstacle: Obstacle) -> Obstacle {
    match obstacle.failing {
        Failing::Beyond { bound, .. } => Obstacle { failing: Failing::Unproved(bound), ..obstacle },
        _ => obstacle,
    }
}

/// The arguments of a proposal at so much larger a gain, enlarged.
fn arguments(
    model: &FloatModel,
    proposal: &SharpProposal,
    above: f64,
    enlarged: f64,
    second: bool,
) -> Result<Needed, PlantRefusal> {
    let mut last = PlantRefusal::NoGain(Failing::NotFinite(None).into());
    for little in ABOVE {
        match at_sigma(model, &proposal.parameters, proposal.sigma * (1.0 + above + little), model.effort().room) {
            Ok((set, at)) => return needed(model, &set, &at, enlarged, (second, proposal.sigma)).ok_or(last),
            Err(obstacle) => last = PlantRefusal::NoGain(obstacle),
        }
    }
    Err(last)
}
