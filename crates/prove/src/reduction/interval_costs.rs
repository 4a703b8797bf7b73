//! What each interval of a parameter, and that of the period, costs.

use super::reduce::reduce;
use rayon::prelude::*;
use sigmastar_lang::plant::Plant;

/// The gains of the families in which one of the intervals is closed to its nominal value, under the names of the parameters in the order
/// of the plant, and last of the `period`: the whole way from the formulas to proved bounds for each, without the decision. None where there
/// is no gain.
pub(super) fn interval_costs(plant: &Plant) -> Vec<(String, Option<f64>)> {
    let known = plant.parameters.list().iter().filter(|parameter| parameter.interval.is_some()).map(|parameter| {
        let closed = plant.with_parameters(&[(parameter.name.clone(), parameter.value.clone())]);
        (parameter.name.clone(), closed.ok())
    });
    let nominal = || ("period".to_owned(), Some(plant.at_period(plant.period.nominal())));
    let closed: Vec<_> = known.chain(plant.period.interval().map(|_| nominal())).collect();
    closed
        .into_par_iter()
        .map(|(name, closed)| {
            let gain = closed.and_then(|closed| reduce(&closed, None).ok()).map(|found| found.proposal.sigma);
            (name, gain)
        })
        .collect()
}
