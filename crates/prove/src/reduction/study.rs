//! The zero dynamics of a plant by themselves: the orbit, and in which coordinates they contract along it.

use super::refusal::{MAX_STATES, PlantRefusal};
use crate::attempt::prove_orbit;
use sigmastar_lang::plant::Plant;
use sigmastar_propose::orbit::{OrbitFailure, Rated, find_orbit, propose_coordinates, round_orbit};
use sigmastar_theory::evidence::{Coordinates, OrbitProof};

/// What was found and proved of the zero dynamics `x' = f(t,x,0)`.
#[derive(Clone, Debug)]
pub struct OrbitStudy {
    /// The coordinates of the proof: those with the largest rate.
    pub coordinates: Coordinates,
    /// The orbit, with the rate along it.
    pub orbit: OrbitProof,
    /// What was tried, the largest rate first; floating point.
    pub candidates: Vec<Rated>,
    /// Floquet exponents along the orbit (real and imaginary part, in 1/time); floating point.
    pub floquet: Vec<[f64; 2]>,
}

/// Finds the orbit of a plant, proposes coordinates, and proves the first of them that can be proved.
///
/// Guarantee: the orbit is proved in these coordinates (derivation, 11.2). Another choice may lead to a smaller gain:
/// [`reduce()`](super::reduce()) looks for that.
///
/// # Errors
/// What could not be found or proved.
pub fn study(plant: &Plant) -> Result<OrbitStudy, PlantRefusal> {
    if plant.states() > MAX_STATES {
        return Err(PlantRefusal::TooManyStates { states: plant.states() });
    }
    plant.prove_periodic().map_err(PlantRefusal::NotPeriodic)?;
    let found = find_orbit(plant).map_err(PlantRefusal::NoOrbit)?;
    let curve = round_orbit(plant, &found).ok_or(PlantRefusal::NoOrbit(OrbitFailure::NotFinite))?;
    let mut candidates = propose_coordinates(plant, &found, 0.0, 0.0).map_err(PlantRefusal::NoOrbit)?;
    candidates.sort_by(|a, b| b.rate.total_cmp(&a.rate));
    let mut refusal = PlantRefusal::NoContraction;
    for Rated { coordinates, .. } in &candidates {
        match prove_orbit(plant, &curve, coordinates) {
            Ok(orbit) => {
                let coordinates = coordinates.clone();
                return Ok(OrbitStudy { coordinates, orbit, candidates, floquet: found.floquet });
            }
            Err(error) => refusal = PlantRefusal::OrbitNotProved(error),
        }
    }
    Err(refusal)
}
