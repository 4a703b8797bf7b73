//! A matrix inequality of existence (derivation, 13.7, (E)) in a search for coordinates: whether one helps, and which.

use super::coordinates::{CoordinateSearch, NEAR, Shape, Start, Varied};
use super::estimates::Density;
use sigmastar_exact::parallel;
use sigmastar_propose::bounds::EnergyWeights;
use sigmastar_propose::search::{FloatModel, Obstacle, PeriodicSet, SharpParameters, SharpProposal};
use sigmastar_theory::derivation::harmonics::AtOrigin;

/// The shares of a gain at which the threshold of an inequality of existence is tried, first and later.
pub(super) const FIRST_THRESHOLDS: [f64; 4] = [0.15, 0.3, 0.6, 0.9];
pub(super) const THRESHOLDS: [f64; 3] = [0.6, 0.8, 1.0];

/// By what share it has to make the periodic solution smaller.
const WORTH_AN_ENERGY: f64 = 0.05;

/// A gain that is so many times that without an inequality is none.
const FAR: f64 = 1.3;

/// The gains on whose sets an inequality is sought, in turn, as multiples of a known one: the set of the least gain that norms know may be too
/// large for any.
const FACTORS: [f64; 3] = [1.0, 2.0, 8.0];

/// A least set with a periodic solution, and the points that were looked at.
struct SampledSet {
    set: PeriodicSet,
    density: Density,
}

impl CoordinateSearch<'_> {
    /// Whether a matrix inequality of existence makes the periodic solution that is proved smaller by a share that matters.
    pub(super) fn energy_helps(&self, at: &Start) -> bool {
        let at_larger = |factor: f64| self.sampled(at, factor).map(|sampled| (factor, sampled));
        let Some((factor, sampled)) = FACTORS.into_iter().find_map(at_larger) else { return false };
        let SampledSet { set, density } = &sampled;
        let Some(energy) = self.energy(at, &sampled, 1.0) else { return false };
        let model = self.model(Shape { energy: Some(&energy), ..at.shape() }, density).with_room(at.room);
        least_set(&model, &at.proposal, factor).is_ok_and(|smaller| {
            let sizes = |set: &PeriodicSet| [set.x_per, set.e_per, set.z];
            sizes(set).into_iter().zip(sizes(&smaller)).any(|(size, smaller)| smaller < size * (1.0 - WORTH_AN_ENERGY))
        })
    }

    /// The least set of a start, at so many times its gain.
    fn sampled(&self, at: &Start, factor: f64) -> Option<SampledSet> {
        let density = self.focus(at.shape(), &at.proposal).map_or(Density::Coarse, Density::Focused);
        let model = self.model(at.shape(), &density).with_room(at.room);
        Some(SampledSet { set: least_set(&model, &at.proposal, factor).ok()?, density })
    }

    /// An inequality of existence on that set, with this share of the gain as its threshold.
    fn energy(&self, at: &Start, SampledSet { set, density }: &SampledSet, share: f64) -> Option<EnergyWeights> {
        self.estimates(at.shape(), density).propose_energy([set.x_p, set.e_p], share * at.proposal.sigma)
    }

    /// The start with another matrix inequality of existence, where the gain is smaller with it after the shape of the error box has been
    /// sought again; else the start itself.
    pub(super) fn with_energy(&self, at: &Start, shares: &[f64]) -> Start {
        let on_set = |factor: f64| {
            let sampled = self.sampled(at, factor)?;
            let with = |share: &f64| {
                let energy = self.energy(at, &sampled, *share)?;
                self.descend(&Start { energy: Some(energy), ..at.clone() }, Varied::Shape)
            };
            let found = parallel::map(shares, with);
            found.into_iter().flatten().min_by(|a, b| a.proposal.sigma.total_cmp(&b.proposal.sigma))
        };
        let least = FACTORS.into_iter().find_map(on_set);
        least.filter(|found| found.proposal.sigma < at.proposal.sigma * FAR).unwrap_or_else(|| at.clone())
    }
}

/// The least set of a model at so many times the gain of a proposal.
fn least_set(model: &FloatModel, proposal: &SharpProposal, factor: f64) -> Result<PeriodicSet, Obstacle> {
    let SharpParameters { form, floors, .. } = proposal.parameters;
    let sigma = factor * proposal.sigma * (1.0 + NEAR);
    PeriodicSet::least(model, &AtOrigin::new(model), sigma, (form, floors), model.effort().room)
}
