//! Coordinates for a plant, chosen by norms or for a P that is given, rounded, and proved along the orbit.

use super::cells::{Cell, Cells};
use super::coordinates::{Chosen, CoordinateSearch, Rough, Shape, Start, energy_in};
use super::estimates::Density;
use super::proofs::{Along, Near, ProvenCell, along};
use super::refusal::PlantRefusal;
use super::sampling::{Sampling, float_matrix, rational_matrix, rational_symmetric};
use super::watch::Stage;
use crate::attempt::{prove_orbits, prove_second};
use nalgebra::DMatrix;
use rug::Rational;
use sigmastar_exact::parallel;
use sigmastar_lang::spec::PeriodicMatrix;
use sigmastar_propose::bounds::Asked;
use sigmastar_propose::search::Obstacle;
use sigmastar_theory::derivation::paths::Path;
use sigmastar_theory::evidence::Coordinates;
use sigmastar_theory::evidence::ProvedTriple;

/// What those candidates with a constant P promise by norms, and that P.
pub(super) fn starts(
    candidates: &[Coordinates],
    sampling: &Sampling<'_>,
) -> Result<(PeriodicMatrix, Rough), PlantRefusal> {
    let constant: Vec<&Coordinates> = candidates.iter().filter(|candidate| candidate.p.harmonics.is_empty()).collect();
    let first = constant.first().ok_or(PlantRefusal::NoContraction)?;
    let matrices: Vec<DMatrix<f64>> = constant.iter().map(|candidate| float_matrix(&candidate.l)).collect();
    let rough = with_search(sampling, None, |search| search.rough(&matrices)).map_err(PlantRefusal::NoGain)?;
    Ok((first.p.clone(), rough))
}

/// The best coordinates by norms, rounded, and proved along the orbit: with a constant P, and a P of existence where one helps; where
/// none leads to a gain, one that moves may.
pub(super) fn best_by_norms(
    candidates: &[Coordinates],
    starts: &Result<(PeriodicMatrix, Rough), PlantRefusal>,
    sampling: &Sampling<'_>,
) -> Result<(Along, Chosen), PlantRefusal> {
    sampling.watch.enter(Stage::Coordinates);
    let by_constant = starts.as_ref().map_err(Clone::clone);
    let by_constant =
        by_constant.and_then(|(p, rough)| with_constant(p, sampling, None, |search| search.choose(rough)));
    let moving: Vec<&Coordinates> = candidates.iter().filter(|candidate| !candidate.p.harmonics.is_empty()).collect();
    match by_constant {
        Err(_) if !moving.is_empty() => {
            let (coordinates, chosen) = best_periodic(&moving, sampling)?;
            Ok((along_cells(sampling.cells, &coordinates)?, chosen))
        }
        found => found,
    }
}

/// What is proved in all cells.
fn along_cells(cells: &Cells, coordinates: &Coordinates) -> Result<Along, PlantRefusal> {
    Ok(Along { why: cells.why.clone(), ..along(&cells.list, coordinates)? })
}

/// A choice for the constant P that is given, rounded, and proved along the orbit.
pub(super) fn with_constant(
    p: &PeriodicMatrix,
    sampling: &Sampling<'_>,
    by_matrix: Option<Path>,
    choose: impl FnOnce(&CoordinateSearch<'_>) -> Result<Chosen, Obstacle>,
) -> Result<(Along, Chosen), PlantRefusal> {
    let chosen = with_search(sampling, by_matrix, choose).map_err(PlantRefusal::NoGain)?;
    let at_origin = |l: &DMatrix<f64>| sampling.estimates(l, [None; 2], &Density::Rough).bounds(0.0, 0.0, Asked::ALL);
    let l = rational_matrix(&sampling.turned(&chosen.l), at_origin).ok_or(PlantRefusal::NoContraction)?;
    let coordinates = Coordinates { l, p: p.clone() };
    let mut base = along_cells(sampling.cells, &coordinates)?;
    // The rounded L, which is L times a rotation, is the one that counts.
    let rounded = float_matrix(&coordinates.l);
    let rotation = chosen.l.clone().try_inverse().map(|inverse| inverse * &rounded);
    let turned = |second: &DMatrix<f64>| {
        let rotation = rotation.as_ref()?;
        rational_symmetric(&(rotation.transpose() * second * rotation))
    };
    if let Some(p) = chosen.second.as_ref().and_then(turned) {
        let with_second = Coordinates { l: coordinates.l.clone(), p };
        // Without a proof the P of stability serves.
        let of_one = |(cell, proven): (&Cell, &ProvenCell)| prove_second(&cell.plant, &proven.orbit, &with_second).ok();
        let cells: Vec<_> = sampling.cells.list.iter().zip(&base.cells).collect();
        let triples = parallel::map(&cells, |&cell| of_one(cell)).into_iter().collect::<Option<Vec<_>>>();
        base.existence = triples.and_then(ProvedTriple::in_common);
    }
    let second = base.second().map(|p| float_matrix(&p.mean));
    let energy = rotation.as_ref().zip(chosen.energy.as_ref()).map(|(rotation, energy)| energy_in(energy, rotation));
    let both = Shape { l: &rounded, second: second.as_ref(), energy: energy.as_ref() };
    let in_tube = sampling.with_tube(base.tube());
    let chosen = with_search(&in_tube, by_matrix, |search| search.with(both, Some(&chosen.proposal)));
    Ok((base, chosen.map_err(PlantRefusal::NoGain)?))
}

/// A choice for the family that is sampled. `None` of a plant without an interval, where P moves, and where there is no gain near it.
pub(super) fn near(sampling: &Sampling<'_>, along: &Along, chosen: &Chosen, path: Option<Path>) -> Option<Near> {
    let coordinates = along.coordinates.clone();
    if !sampling.plant.is_family() || !coordinates.p.harmonics.is_empty() {
        return None;
    }
    let (start, narrow) = (Start::from(chosen), sampling.cells.narrow);
    let mut near = Near { coordinates, start, path, narrow, gain: f64::NAN };
    near.gain = gain_near(&near, &sampling.with_tube(along.tube()))?;
    Some(near)
}

/// The gain near a choice, in its coordinates or near them and without joint metrics, from samples of the derivatives: an estimate.
pub(super) fn gain_near(near: &Near, sampling: &Sampling<'_>) -> Option<f64> {
    let gain = |search: &CoordinateSearch<'_>| match near.path {
        Some(_) => Ok(search.estimate_around(&near.start)),
        None => search.with(near.start.shape(), Some(&near.start.proposal)).map(|found| Some(found.proposal.sigma)),
    };
    with_search(sampling, near.path, gain).ok().flatten()
}

/// A search with P = I in the coordinates y, and some P of existence.
pub(super) fn with_search<T>(
    sampling: &Sampling<'_>,
    by_matrix: Option<Path>,
    run: impl FnOnce(&CoordinateSearch<'_>) -> Result<T, Obstacle>,
) -> Result<T, Obstacle> {
    run(&CoordinateSearch { sampling, p: None, ratio: 1.0, by_matrix })
}

/// The best of the candidates with a P(t).
fn best_periodic(candidates: &[&Coordinates], sampling: &Sampling<'_>) -> Result<(Coordinates, Chosen), PlantRefusal> {
    let mut best: Option<(Coordinates, Chosen)> = None;
    let mut failure = PlantRefusal::NoContraction;
    for candidate in candidates {
        let proved = match prove_orbits(&sampling.cells.curves(), candidate).map(|orbits| orbits.into_iter().next()) {
            Ok(Some(proved)) => proved,
            Ok(None) => continue,
            Err(error) => {
                failure = PlantRefusal::OrbitNotProved(error);
                continue;
            }
        };
        let ratio = Rational::from(&proved.p_up / &proved.p_low).to_f64();
        let search = CoordinateSearch { sampling, p: Some(&candidate.p), ratio, by_matrix: None };
        match search.with(Shape { l: &float_matrix(&candidate.l), second: None, energy: None }, None) {
            Ok(chosen) if best.as_ref().is_none_or(|(_, known)| chosen.proposal.sigma < known.proposal.sigma) => {
                best = Some(((*candidate).clone(), chosen));
            }
            Ok(_) => {}
            Err(obstacle) => failure = PlantRefusal::NoGain(obstacle),
        }
    }
    best.ok_or(failure)
}
