//! What each interval of a parameter, and that of the period, costs; at samples that of the input gain, too.

use super::sampled::{RestsOn, reduce_sampled};
use super::watch::{Unwatched, Watch};
use crate::certify::{Ladder, certify_sampled};
use crate::search::SampledProposal;
use rayon::prelude::*;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Sampling, Specification};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The gains of the families in which one of the intervals is closed to its nominal value, under the names of the parameters in the order
/// of the plant, and last of the `period`: the whole way from the formulas to proved bounds for each, as `gain` goes it, without the
/// decision. None where there is no gain.
pub(super) fn interval_costs(
    plant: &Plant,
    gain: impl Fn(&Plant) -> Option<f64> + Sync,
    watch: &dyn Watch,
) -> Vec<(String, Option<f64>)> {
    let known = plant.parameters.list().iter().filter(|parameter| parameter.interval.is_some()).map(|parameter| {
        let closed = plant.with_parameters(&[(parameter.name.clone(), parameter.value.clone())]);
        (parameter.name.clone(), closed.ok())
    });
    let nominal = || ("period".to_owned(), Some(plant.at_period(plant.period.nominal())));
    let closed: Vec<_> = known.chain(plant.period.interval().map(|_| nominal())).collect();
    let (done, count) = (AtomicUsize::new(0), closed.len());
    let cost = |(name, closed): (String, Option<Plant>)| {
        let sigma = closed.and_then(|closed| gain(&closed));
        watch.part(done.fetch_add(1, Ordering::Relaxed) + 1, count);
        (name, sigma)
    };
    closed.into_par_iter().map(cost).collect()
}

/// The same for the regulator at samples, and first what it would be with the nominal `input_gain`; a specification has no other interval.
/// Never above `sigma`, the gain of all of them, which serves each.
pub(super) fn costs_at_samples(
    (spec, plant): (&Specification, Option<&Plant>),
    (sampling, sigma): (&Sampling, f64),
    ladder: Ladder,
    watch: &dyn Watch,
) -> Vec<(String, Option<f64>)> {
    let at_most = |proposal: SampledProposal| proposal.sigma.min(sigma);
    let of_plant = |plant: &Plant| {
        reduce_sampled(plant, sampling, (None, RestsOn::Either), &Unwatched).ok().map(|found| at_most(found.proposal))
    };
    let uncertain = spec.input_gain.as_ref().filter(|gain| !gain.is_nominal());
    let of_gain = uncertain.map(|_| {
        let sigma = match plant {
            Some(plant) => of_plant(&Plant { input_gain: None, ..plant.clone() }),
            None => {
                let known = Specification { input_gain: None, ..spec.clone() };
                let found = certify_sampled(&known, sampling, None, None, ladder).ok().and_then(|run| run.found);
                found.map(|(proposal, _)| at_most(proposal))
            }
        };
        ("input_gain".to_owned(), sigma)
    });
    of_gain.into_iter().chain(plant.map(|plant| interval_costs(plant, of_plant, watch)).into_iter().flatten()).collect()
}
