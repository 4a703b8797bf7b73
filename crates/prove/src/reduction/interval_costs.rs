//! What each interval of a parameter costs.

use super::reduce::reduce;
use rayon::prelude::*;
use sigmastar_lang::plant::Plant;

/// The gains of the families in which one of the intervals is closed to its nominal value, under the names of the parameters in the order
/// of the plant: the whole way from the formulas to proved bounds for each, without the decision. None where there is no gain.
pub(super) fn interval_costs(plant: &Plant) -> Vec<(String, Option<f64>)> {
    let known = plant.parameters.list().iter().filter(|parameter| parameter.interval.is_some());
    known
        .collect::<Vec<_>>()
        .par_iter()
        .map(|parameter| {
            let closed = plant.with_parameters(&[(parameter.name.clone(), parameter.value.clone())]);
            let gain = closed.ok().and_then(|closed| reduce(&closed, None).ok()).map(|found| found.proposal.sigma);
            (parameter.name.clone(), gain)
        })
        .collect()
}
