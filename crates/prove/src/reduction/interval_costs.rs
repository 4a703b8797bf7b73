//! What each interval of a parameter, and that of the period, costs; at samples that of the input gain, too.

use super::near::Near;
use super::reduce::reduce;
use super::sampled::{RestsOn, reduce_sampled};
use super::watch::{Searches, Watch};
use crate::certify::{Ladder, certify_sampled};
use crate::search::SampledProposal;
use rayon::prelude::*;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Sampling, Specification};

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
        let known = near.and_then(|near| Some(sigma * near.ratio(closed, watch)?));
        let found = known.or_else(|| reduce(closed, None, watch).ok().map(|found| found.proposal.sigma));
        found.map(|found| found.min(sigma))
    };
    costs(closed(plant), gain, watch)
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
    let cost = |(name, closed): Closed| {
        let sigma = closed.and_then(|closed| gain(&closed, &searches));
        searches.one_is_done();
        (name, sigma)
    };
    closed.into_par_iter().map(cost).collect()
}

/// The same for the regulator at samples, and first what it would be with the nominal `input_gain`; a specification has no other interval.
/// Never above `sigma`, the gain of all of them, which serves each.
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
        let known = near.and_then(|near| Some(sigma * near.ratio_at_samples(plant, sampling, watch)?));
        let found = known.map(|found| found.min(sigma));
        let asked = (None, RestsOn::Either);
        found.or_else(|| reduce_sampled(plant, sampling, asked, watch).ok().map(|found| at_most(found.proposal)))
    };
    costs(known.into_iter().chain(closed(plant)).collect(), of_plant, watch)
}
