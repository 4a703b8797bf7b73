//! What each interval of a parameter, and that of the period, costs; at samples that of the input gain, too.

use super::cells::Cells;
use super::choice::{gain_near, with_search};
use super::coordinates::CoordinateSearch;
use super::proofs::{Along, Near};
use super::reduce::{Beside, reduce, whole, with_cells};
use super::sampled::{RestsOn, reduce_sampled};
use super::sampled_matrix::MatrixAtSamples;
use super::sampling::Sampling as Samples;
use super::watch::{Searches, Watch};
use crate::certify::certify_sampled;
use sigmastar_decide::conditions::Ladder;
use sigmastar_exact::parallel;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Sampling, Specification};
use sigmastar_propose::search::SampledProposal;

/// The gains of the families in which one of the intervals is closed to its nominal value, under the names of the parameters in the order
/// of the plant, and last of the `period`: estimates. Never above `sigma`, the gain of all of them, which serves each. None where there is
/// no gain.
///
/// As much smaller as the gain near the choice behind `sigma` becomes; where there is no such choice, or no gain near it, the whole way from
/// the formulas to proved bounds, without the decision.
pub(super) fn interval_costs(
    (plant, near): (&Plant, Option<&Near>),
    sigma: f64,
    watch: &dyn Watch,
) -> Vec<(String, Option<f64>)> {
    let gain = |closed: &Plant, watch: &dyn Watch| {
        let known = near.and_then(|near| Some(sigma * ratio(near, closed, watch)?));
        let found = known.or_else(|| reduce(closed, Beside::Nothing, watch).ok().map(|found| found.proposal.sigma));
        found.map(|found| found.min(sigma))
    };
    costs(closed(plant), gain, watch)
}

/// How many times the gain near the choice for a family is that of the family where a member or a smaller family stands in its place. `None`
/// where the orbit is not proved in these coordinates, or there is no such gain.
fn ratio(near: &Near, plant: &Plant, watch: &dyn Watch) -> Option<f64> {
    Some(sampled(near, plant, watch, |_, samples| gain_near(near, samples))? / near.gain)
}

/// How many times the gain of the regulator at samples near the choice for a family is that of the family, where a member or a smaller
/// family stands in its place. `None` where the orbit is not proved in these coordinates, or there is no such gain.
fn ratio_at_samples(near: &Near, plant: &Plant, sampling: &Sampling, watch: &dyn Watch) -> Option<f64> {
    let gain = |along: &Along, samples: &Samples<'_>| {
        let chosen = |search: &CoordinateSearch<'_>| search.with(near.start.shape(), Some(&near.start.proposal));
        let chosen = with_search(samples, near.path, chosen).ok()?;
        MatrixAtSamples::new(samples, (along, &chosen), sampling)?.estimate()
    };
    Some(sampled(near, plant, watch, gain)? / near.gain)
}

/// What is found from the orbits of a plant and the samples along them, in the coordinates of a choice.
fn sampled(
    near: &Near,
    plant: &Plant,
    watch: &dyn Watch,
    find: impl FnOnce(&Along, &Samples<'_>) -> Option<f64>,
) -> Option<f64> {
    let (whole, _) = whole(plant, watch).ok()?;
    let candidates = std::slice::from_ref(&near.coordinates);
    let cells = Cells::new(&whole, candidates, near.narrow, watch).ok()?;
    with_cells(plant, &cells, candidates, watch, |along, samples| Ok(find(along, samples))).ok()?
}

/// A plant with one of its intervals closed, under the name of that.
type Closed = (String, Option<Plant>);

fn closed(plant: &Plant) -> Vec<Closed> {
    let known = plant.parameters.list().iter().filter(|parameter| parameter.interval.is_some()).map(|parameter| {
        let closed = plant.with_parameters(&[(parameter.name.clone(), parameter.value.clone())]);
        (parameter.name.clone(), closed.ok())
    });
    let nominal = || ("period".to_owned(), Some(plant.at_period(plant.period.nominal())));
    known.chain(plant.period.interval().map(|_| nominal())).collect()
}

fn costs(
    closed: Vec<Closed>,
    gain: impl Fn(&Plant, &dyn Watch) -> Option<f64> + Sync,
    watch: &dyn Watch,
) -> Vec<(String, Option<f64>)> {
    let searches = Searches::new(closed.len(), watch);
    let cost = |(name, closed): &Closed| {
        let sigma = closed.as_ref().and_then(|closed| gain(closed, &searches));
        searches.one_is_done();
        (name.clone(), sigma)
    };
    parallel::map(&closed, cost)
}

/// The gains of the regulator at samples where one of the intervals is closed to its nominal value: first that of `input_gain`, then those
/// of the parameters in the order of the plant, last that of the `period`; a specification has no other interval than `input_gain`.
/// Estimates, never above `sigma`, the gain of all of them, which serves each. None where there is no gain.
pub(super) fn costs_at_samples(
    (spec, plant): (&Specification, Option<(&Plant, Option<&Near>)>),
    (sampling, sigma): (&Sampling, f64),
    ladder: Ladder,
    watch: &dyn Watch,
) -> Vec<(String, Option<f64>)> {
    let at_most = |proposal: SampledProposal| proposal.sigma.min(sigma);
    let uncertain = spec.input_gain.as_ref().filter(|gain| !gain.is_nominal()).map(|_| "input_gain".to_owned());
    let Some((plant, near)) = plant else {
        let of_spec = |name| {
            let known = Specification { input_gain: None, ..spec.clone() };
            let found = certify_sampled(&known, sampling, None, None, ladder).ok().and_then(|run| run.found);
            (name, found.map(|(proposal, _)| at_most(proposal)))
        };
        return uncertain.map(of_spec).into_iter().collect();
    };
    let known = uncertain.map(|name| (name, Some(Plant { input_gain: None, ..plant.clone() })));
    let of_plant = |plant: &Plant, watch: &dyn Watch| {
        let known = near.and_then(|near| Some(sigma * ratio_at_samples(near, plant, sampling, watch)?));
        let found = known.map(|found| found.min(sigma));
        let asked = (None, RestsOn::Either);
        found.or_else(|| reduce_sampled(plant, sampling, asked, watch).ok().map(|found| at_most(found.proposal)))
    };
    costs(known.into_iter().chain(closed(plant)).collect(), of_plant, watch)
}
