//! Gains near a choice that is known, of plants that differ little from the one that it was made for: estimates, nothing is proved.

use super::cells::{Cells, NARROW};
use super::choice::with_search;
use super::coordinates::{Chosen, CoordinateSearch, Start};
use super::proofs::Along;
use super::reduce::{whole, with_cells};
use super::sampled_matrix::MatrixAtSamples;
use super::sampling::Sampling;
use super::watch::Watch;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec;
use sigmastar_plants::orbit::Coordinates;
use sigmastar_theory::derivation::paths::Path;

/// A choice for a family of plants, with a constant P.
pub(super) struct Near {
    /// Its coordinates, as they were rounded.
    coordinates: Coordinates,
    /// The free numbers, in these.
    start: Start,
    /// The path of the matrix inequality that it rests on; norms without.
    path: Option<Path>,
    /// The gain near it of the family itself.
    gain: f64,
}

impl Near {
    /// A choice for the plant that is sampled. `None` where that has no interval, or P moves, or there is no gain near it.
    pub(super) fn new(sampling: &Sampling<'_>, along: &Along, chosen: &Chosen, path: Option<Path>) -> Option<Near> {
        let coordinates = along.coordinates.clone();
        if !sampling.plant.is_family() || !coordinates.p.harmonics.is_empty() {
            return None;
        }
        let mut near = Near { coordinates, start: Start::from(chosen), path, gain: f64::NAN };
        near.gain = near.gain_of(&sampling.with_tube(along.tube()))?;
        Some(near)
    }

    /// The same for the regulator at samples, of which this gain was found by matrix inequalities.
    pub(super) fn at_samples(sampling: &Sampling<'_>, (along, chosen): &(Along, Chosen), gain: f64) -> Option<Near> {
        let (coordinates, start) = (along.coordinates.clone(), Start::from(chosen));
        sampling.plant.is_family().then_some(Near { coordinates, start, path: Some(Path::Straight), gain })
    }

    /// How many times the gain near the choice is that of the family where a plant stands in its place: in the coordinates of the choice and
    /// without joint metrics, from samples of the derivatives. `None` where the orbit is not proved in these coordinates, or there is no such
    /// gain.
    pub(super) fn ratio(&self, plant: &Plant, watch: &dyn Watch) -> Option<f64> {
        Some(self.sampled(plant, watch, |_, sampled| self.gain_of(sampled))? / self.gain)
    }

    /// The same of the gains of the regulator at samples.
    pub(super) fn ratio_at_samples(&self, plant: &Plant, sampling: &spec::Sampling, watch: &dyn Watch) -> Option<f64> {
        let gain = |along: &Along, sampled: &Sampling<'_>| {
            let near = |search: &CoordinateSearch<'_>| search.with(self.start.shape(), Some(&self.start.proposal));
            let chosen = with_search(sampled, self.path, near).ok()?;
            MatrixAtSamples::new(sampled, (along, &chosen), sampling)?.estimate()
        };
        Some(self.sampled(plant, watch, gain)? / self.gain)
    }

    /// What a gain is found from: the orbit and the samples of a plant, in these coordinates.
    fn sampled(
        &self,
        plant: &Plant,
        watch: &dyn Watch,
        gain: impl FnOnce(&Along, &Sampling<'_>) -> Option<f64>,
    ) -> Option<f64> {
        let (whole, _) = whole(plant, watch).ok()?;
        let candidates = std::slice::from_ref(&self.coordinates);
        let cells = Cells::new(&whole, candidates, NARROW[0], watch).ok()?;
        with_cells(plant, &cells, candidates, watch, |along, sampled| Ok(gain(along, sampled))).ok()?
    }

    fn gain_of(&self, sampling: &Sampling<'_>) -> Option<f64> {
        let gain = |search: &CoordinateSearch<'_>| match self.path {
            Some(_) => Ok(search.estimate_around(&self.start)),
            None => search.with(self.start.shape(), Some(&self.start.proposal)).map(|found| Some(found.proposal.sigma)),
        };
        with_search(sampling, self.path, gain).ok().flatten()
    }
}
