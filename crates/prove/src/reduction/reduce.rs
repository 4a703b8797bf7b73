//! The whole way from a plant to a specification whose data are proved, and decided again from a certificate.

use super::cells::{Cell, Cells, NARROW, in_cell};
use super::coordinates::{
    Chosen, CoordinateSearch, Density, Rough, SHAPE_STEP, Sampler, Shape, Start, best_shape_near, energy_in,
};
use super::cover::covers;
use super::entries::{Needed, decide_all, needed};
use super::joint::with_joint_metrics;
use super::proofs::{Along, PRECISION, Proofs, ProvenCell, Reduced, along, trade_off};
use super::refusal::{MAX_STATES, PlantRefusal};
use super::sampling::{Sampling, float_matrix, rational_matrix, rational_symmetric};
use super::watch::{Stage, Unwatched, Watch};
use crate::certify::Alternatives;
use crate::search::{
    AtSigma, Closest, Descent, Failing, FloatModel, Goal, Obstacle, ROOM, SharpParameters, SharpProposal, at_sigma,
    minimise, search_sharp_near,
};
use nalgebra::DMatrix;
use rayon::prelude::*;
use rug::Rational;
use sigmastar_exact::number::Portable;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::model::Constant;
use sigmastar_lang::spec::{OfPlant, Parameters, PeriodicMatrix, ProvedCell, ProvedOrbit, ProvedValues, Specification};
use sigmastar_plants::bounds::Asked;
use sigmastar_plants::orbit::{
    self, Coordinates, OrbitProof, SecondTriple, decide_forcing, decide_orbit, decide_second, find_orbit,
    propose_coordinates, prove_orbits, prove_second, round_orbit,
};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::paths::Path;

/// How far beyond the arguments of a proposal the bounds are proved, in turn: with room for what the proved values are larger than
/// the sampled ones, and close to the arguments.
pub(super) const ENLARGED: [f64; 2] = [1e-2, 1e-5];

/// The same for a gain that may become larger in return: the room between both sides of S1 and S2 that the proposal leaves (where the least
/// set ceases to be one, that of a somewhat larger gain has room for proved values), and how far beyond the arguments there, while the
/// proved values lead to no gain near the proposal.
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

/// A gain that in a period does no more than this needs not be smaller.
const AS_GOOD_AS_NONE: f64 = 1e-6;

/// What a path with a corner must take from the gain of the straight one: a splitting costs room in proofs and in certificates.
const WORTH_A_CORNER: f64 = 5e-3;

/// By what share of the gain of norms, at few samples, one by a matrix inequality is far better.
pub(super) const FAR_BETTER: f64 = 0.9;

/// What an aligned start must take from a gain to be worth a remark.
const WORTH_A_REMARK: f64 = 0.01;

/// A smaller gain than by this share is not worth another round of proofs.
const WORTH: f64 = 1e-4;

/// Proves the data that the sharp derivation needs, at the arguments where it will need them.
///
/// Guarantee: every value of the specification holds for the plant, relative to its orbit and in the coordinates of its
/// [`OfPlant`]; f and q have the period, and are smooth up to the largest arguments. That the gain comes out small is not
/// claimed. For a gain that is given and large enough without joint metrics none are sought, for they are those of the least gain and
/// bound the periodic solution of a larger one less well: the values are proved for the sets of that gain, where they can be.
///
/// # Errors
/// What could not be proved or found.
pub fn reduce(plant: &Plant, gain: Option<&Rational>, watch: &dyn Watch) -> Result<Reduced, PlantRefusal> {
    let (whole, candidates) = with_whole(plant, watch)?;
    let [narrow, narrower] = NARROW;
    let cells = Cells::new(&whole, &candidates, narrow)?;
    in_cells(plant, &cells, &candidates, gain, watch).or_else(|refusal| {
        // The tube may take what the initial set needs, and be too wide in other coordinates.
        let finer = refusal.may_be_of_tube().then(|| Cells::new(&whole, &candidates, narrower));
        match finer {
            Some(Ok(finer)) if finer.list.len() > cells.list.len() => {
                in_cells(plant, &finer, &candidates, gain, watch).map_err(|_| refusal)
            }
            _ => Err(refusal),
        }
    })
}

/// The data that [`reduce()`] proves, in these cells.
fn in_cells(
    plant: &Plant,
    cells: &Cells,
    candidates: &[Coordinates],
    gain: Option<&Rational>,
    watch: &dyn Watch,
) -> Result<Reduced, PlantRefusal> {
    with_cells(plant, cells, candidates, watch, |sampling| {
        let starts = starts(candidates, sampling);
        // A descent by norms is worth its time where a matrix inequality does not do far better from the same start.
        if let Ok((p, rough)) = &starts
            && let Ok(starts) = with_search(sampling, Some(Path::Straight), |search| Ok(search.for_matrix(rough)))
            && let Some(found) = best_by_matrix(p, &starts, sampling)
            && found.chosen.proposal.sigma < FAR_BETTER * rough.best.proposal.sigma
            && let Ok(proved) = found.proved(sampling, rough.best.proposal.sigma, gain)
        {
            return Ok(proved);
        }
        let (along, chosen) = best_by_norms(candidates, &starts, sampling)?;
        let by_matrix = best_by_matrix(&along.coordinates.p, &[Start::from(&chosen)], sampling);
        let by_matrix = by_matrix.and_then(|found| found.proved(sampling, chosen.proposal.sigma, gain).ok());
        match by_matrix {
            Some(found) if found.proposal.sigma < chosen.proposal.sigma => Ok(found),
            // What norms prove is above the samples.
            Some(found) => Ok(by_norms(&along, sampling, &chosen)
                .ok()
                .filter(|other| other.proposal.sigma < found.proposal.sigma)
                .unwrap_or(found)),
            None => by_norms(&along, sampling, &chosen),
        }
    })
}

/// The same with C5 by norms: what a bounding specification of the plant can have.
///
/// # Errors
/// What could not be proved or found.
pub fn reduce_by_norms(plant: &Plant) -> Result<Reduced, PlantRefusal> {
    with_coordinates(plant, by_norms)
}

/// The same in the coordinates that are proposed first where they lead to a gain: for rows beside a claim. The gain may be larger than that of
/// [`reduce_by_norms`], which improves them.
///
/// # Errors
/// What could not be proved or found.
pub fn reduce_by_norms_quickly(plant: &Plant) -> Result<Reduced, PlantRefusal> {
    with_candidates(plant, &Unwatched, |candidates, sampling| {
        let starts = starts(candidates, sampling);
        let as_proposed = starts.as_ref().map_err(Clone::clone).and_then(|(p, Rough { best, .. })| {
            with_constant(p, sampling, None, |search| search.with(best.shape(), Some(&best.proposal)))
        });
        let (along, chosen) = as_proposed.or_else(|_| best_by_norms(candidates, &starts, sampling))?;
        by_norms(&along, sampling, &chosen)
    })
}

/// The data of a choice, proved.
fn by_norms(along: &Along, sampling: &Sampling<'_>, chosen: &Chosen) -> Result<Reduced, PlantRefusal> {
    prove_bounds(&Proofs::new(along, sampling)?, chosen)
}

/// Finds and proves the orbit, chooses the coordinates by norms, and goes on from there.
pub(super) fn with_coordinates<T>(
    plant: &Plant,
    prove: impl FnOnce(&Along, &Sampling<'_>, &Chosen) -> Result<T, PlantRefusal>,
) -> Result<T, PlantRefusal> {
    with_candidates(plant, &Unwatched, |candidates, sampling| {
        let (along, chosen) = best_by_norms(candidates, &starts(candidates, sampling), sampling)?;
        prove(&along, sampling, &chosen)
    })
}

/// Finds the orbit, proposes coordinates, cuts the box of a family where its tube is wide, and goes on from there.
pub(super) fn with_candidates<T>(
    plant: &Plant,
    watch: &dyn Watch,
    prove: impl FnOnce(&[Coordinates], &Sampling<'_>) -> Result<T, PlantRefusal>,
) -> Result<T, PlantRefusal> {
    let (whole, candidates) = with_whole(plant, watch)?;
    let cells = Cells::new(&whole, &candidates, NARROW[0])?;
    with_cells(plant, &cells, &candidates, watch, |sampling| prove(&candidates, sampling))
}

/// The orbit, found for all members at once, and candidates for the coordinates: at least one.
fn with_whole(plant: &Plant, watch: &dyn Watch) -> Result<(Cell, Vec<Coordinates>), PlantRefusal> {
    watch.enter(Stage::Orbit);
    if plant.states() > MAX_STATES {
        return Err(PlantRefusal::TooManyStates { states: plant.states() });
    }
    plant.prove_periodic().map_err(PlantRefusal::NotPeriodic)?;
    let found = find_orbit(plant).map_err(PlantRefusal::NoOrbit)?;
    let curve = round_orbit(plant, &found).ok_or(PlantRefusal::NoOrbit(orbit::OrbitFailure::NotFinite))?;
    let whole = Cell { plant: plant.clone(), curve };
    // Cells may be smooth where the whole box is not.
    if !whole.can_be_cut() {
        whole.smooth()?;
    }
    let candidates = propose_coordinates(plant, &found, 0.0, 0.0).map_err(PlantRefusal::NoOrbit)?;
    if candidates.is_empty() { Err(PlantRefusal::NoContraction) } else { Ok((whole, candidates)) }
}

/// Proves the orbits of all cells, and goes on from there.
fn with_cells<T>(
    plant: &Plant,
    cells: &Cells,
    candidates: &[Coordinates],
    watch: &dyn Watch,
    prove: impl FnOnce(&Sampling<'_>) -> Result<T, PlantRefusal>,
) -> Result<T, PlantRefusal> {
    let first = candidates.first().ok_or(PlantRefusal::NoContraction)?;
    let along = along(&cells.list, first)?;
    let spec = along.specification(plant, ProvedValues::default())?;
    let data = Data::new(&spec, PRECISION);
    let model = FloatModel::new(&data, trade_off(&data));
    let sampling = Sampling::new(plant, cells, &model, watch, along.tube());
    watch.enter(Stage::Coordinates);
    prove(&sampling)
}

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

/// What was found by a matrix inequality.
struct FoundByMatrix {
    along: Along,
    chosen: Chosen,
    path: Path,
}

impl FoundByMatrix {
    /// The gain with what a corner has to take from it.
    fn cost(&self) -> f64 {
        let corner = if self.path == Path::Straight { 1.0 } else { 1.0 + WORTH_A_CORNER };
        self.chosen.proposal.sigma * corner
    }

    /// The data of it, proved, and what norms and an aligned start would give beside.
    fn proved(&self, sampling: &Sampling<'_>, by_norms: f64, gain: Option<&Rational>) -> Result<Reduced, PlantRefusal> {
        let FoundByMatrix { along, chosen, path } = self;
        let proofs = Proofs::new(along, sampling)?;
        let proved = prove_bounds(&proofs, chosen)?;
        let proved = match gain {
            Some(gain) if *gain >= proved.proposal.sigma => {
                proofs.for_gain(chosen, &proved, gain.to_f64()).unwrap_or(proved)
            }
            // Joint metrics are not proved for an uncertain input gain.
            _ if chosen.model.input_gain.is_some() => proved,
            _ => {
                sampling.watch.enter(Stage::Metrics);
                with_joint_metrics(&proofs, &chosen.model, &chosen.proposal, proved)
            }
        };
        // It is one of (M): beside joint metrics it may be larger than what they prove from another start.
        let lower = |aligned: &f64| *aligned < proved.proposal.sigma * (1.0 - WORTH_A_REMARK);
        let aligned = aligned(sampling, chosen, *path).filter(lower);
        let nominal_gain = with_nominal_gain(sampling, along, chosen, *path);
        Ok(Reduced { alternatives: Alternatives { by_norms: Some(by_norms), aligned, nominal_gain }, ..proved })
    }
}

/// The gain near a choice with an aligned start, in its coordinates.
fn aligned(sampling: &Sampling<'_>, chosen: &Chosen, path: Path) -> Option<f64> {
    let set = &sampling.plant.initial_set;
    if set.is_aligned() {
        return None;
    }
    let plant = Plant { initial_set: set.clone().aligned(), ..sampling.plant.clone() };
    let model = sampling.model.with_set(sampling.model.set.aligned());
    let sampling = Sampling::new(&plant, sampling.cells, &model, sampling.watch, sampling.tube.clone());
    let search = |search: &CoordinateSearch<'_>| Ok(search.estimate_near(&Start::from(chosen)));
    let sigma = with_search(&sampling, Some(path), search).ok().flatten()?;
    (sigma < chosen.proposal.sigma * (1.0 - WORTH_A_REMARK)).then_some(sigma)
}

/// The gain near a choice with the input gain known to be the nominal one, in its coordinates; none where it is.
fn with_nominal_gain(sampling: &Sampling<'_>, along: &Along, chosen: &Chosen, path: Path) -> Option<f64> {
    sampling.model.input_gain.as_ref()?;
    let plant = Plant { input_gain: None, ..sampling.plant.clone() };
    let spec = along.specification(&plant, ProvedValues::default()).ok()?;
    let data = Data::new(&spec, PRECISION);
    let model = FloatModel::new(&data, trade_off(&data));
    let sampling = Sampling::new(&plant, sampling.cells, &model, sampling.watch, sampling.tube.clone());
    let search = |search: &CoordinateSearch<'_>| Ok(search.estimate_near(&Start::from(chosen)));
    with_search(&sampling, Some(path), search).ok().flatten()
}

/// The best coordinates near one of these starts, and the gain with them, where stability is proved by a matrix
/// inequality; none where P moves, where there is nothing to gain, and where the gain is not smaller by what is worth it.
fn best_by_matrix(p: &PeriodicMatrix, starts: &[Start], sampling: &Sampling<'_>) -> Option<FoundByMatrix> {
    let is_small = |start: &Start| start.proposal.sigma * sampling.model.period < AS_GOOD_AS_NONE;
    if !p.harmonics.is_empty() || starts.iter().any(is_small) {
        return None;
    }
    let near = |start: &Start, path: Path| {
        let (along, chosen) = with_constant(p, sampling, Some(path), |search| search.choose_near(start)).ok()?;
        Some(FoundByMatrix { along, chosen, path })
    };
    let smaller = |a: &FoundByMatrix, b: &FoundByMatrix| a.cost().total_cmp(&b.cost());
    let found: Vec<Option<FoundByMatrix>> = match starts {
        [start] if !sampling.varies() => vec![near(start, Path::Straight)],
        [start] => Path::ALL.into_par_iter().map(|path| near(start, path)).collect(),
        // The straight one says which of the starts is the best.
        _ => {
            let straight: Vec<_> = starts.par_iter().filter_map(|start| near(start, Path::Straight)).collect();
            let best = straight.into_iter().min_by(smaller);
            if !sampling.varies() {
                return best;
            }
            let start = best.as_ref().map(|found| Start::from(&found.chosen)).or_else(|| starts.first().cloned())?;
            let others = Path::CHOICE.into_par_iter().map(|path| near(&start, path));
            others.chain(rayon::iter::once(best)).collect()
        }
    };
    found.into_iter().flatten().min_by(smaller)
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
    let at_origin = |l: &DMatrix<f64>| sampling.source(l, [None; 2], &Density::Rough)(0.0, 0.0, Asked::ALL);
    let l = rational_matrix(&sampling.turned(&chosen.l), at_origin).ok_or(PlantRefusal::NoContraction)?;
    let coordinates = Coordinates { l, p: p.clone(), rate: f64::NAN };
    let mut base = along_cells(sampling.cells, &coordinates)?;
    // The rounded L, which is L times a rotation, is the one that counts.
    let rounded = float_matrix(&coordinates.l);
    let rotation = chosen.l.clone().try_inverse().map(|inverse| inverse * &rounded);
    let turned = |second: &DMatrix<f64>| {
        let rotation = rotation.as_ref()?;
        rational_symmetric(&(rotation.transpose() * second * rotation))
    };
    if let Some(p) = chosen.second.as_ref().and_then(turned) {
        let with_second = Coordinates { l: coordinates.l.clone(), p, rate: f64::NAN };
        // Without a proof the P of stability serves.
        let of_one = |(cell, proven): (&Cell, &ProvenCell)| prove_second(&cell.plant, &proven.orbit, &with_second).ok();
        let triples = sampling.cells.list.par_iter().zip(&base.cells).map(of_one).collect::<Option<Vec<_>>>();
        base.existence = triples.and_then(SecondTriple::in_common).map(|triple| (with_second.p, triple));
    }
    let second = base.existence.as_ref().map(|(p, _)| float_matrix(&p.mean));
    let energy = rotation.as_ref().zip(chosen.energy.as_ref()).map(|(rotation, energy)| energy_in(energy, rotation));
    let both = Shape { l: &rounded, second: second.as_ref(), energy: energy.as_ref() };
    let in_tube = sampling.with_tube(base.tube());
    let chosen = with_search(&in_tube, by_matrix, |search| search.with(both, Some(&chosen.proposal)));
    Ok((base, chosen.map_err(PlantRefusal::NoGain)?))
}

/// A search with P = I in the coordinates y, and some P of existence.
pub(super) fn with_search<T>(
    sampling: &Sampling<'_>,
    by_matrix: Option<Path>,
    run: impl FnOnce(&CoordinateSearch<'_>) -> Result<T, Obstacle>,
) -> Result<T, Obstacle> {
    let sampler = |Shape { l, second, .. }: Shape<'_>, density: &Density| {
        let second = second.and_then(rational_symmetric);
        sampling.estimates(l, [None, second.as_ref()], density)
    };
    run(&CoordinateSearch { by_matrix, ..search(sampling, &sampler, 1.0) })
}

fn search<'a>(sampling: &'a Sampling<'a>, sampler: &'a Sampler<'a>, ratio: f64) -> CoordinateSearch<'a> {
    let frame = |l: &DMatrix<f64>, model: &FloatModel| in_frame(sampling.plant, l, model);
    let units = |l: &DMatrix<f64>| sampling.units(l);
    let (frame, units) = (Box::new(frame), Box::new(units));
    let count = Box::new(|| sampling.count());
    CoordinateSearch { base: sampling.model, sampler, frame, units, ratio, by_matrix: None, count }
}

/// The initial set and the domain in the norm of y.
fn in_frame(plant: &Plant, l: &DMatrix<f64>, model: &FloatModel) -> FloatModel {
    let values = if l.nrows() == 0 { None } else { Some(l.singular_values()) };
    let (largest, smallest) = values.map_or((1.0, 1.0), |values| (values.max(), values.min()));
    let mut model = model.clone();
    if let Some(ball) = &plant.ball {
        let covering = ball.to_f64() / smallest;
        model = model.with_set(plant.initial_set.map(Constant::to_f64).with_x0(covering));
    }
    if let Some(domain) = &plant.domain {
        model.domain = (domain.x.to_f64() / largest, domain.e.to_f64());
    }
    model
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
        let sampler =
            |Shape { l, .. }: Shape<'_>, density: &Density| sampling.estimates(l, [Some(&candidate.p), None], density);
        let search = search(sampling, &sampler, ratio);
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

/// Proves the bounds at the arguments of a proposal, looks for the best proposal with them, and once more near its arguments.
fn prove_bounds(proofs: &Proofs<'_>, chosen: &Chosen) -> Result<Reduced, PlantRefusal> {
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
            (with_values, Reduced { spec, proposal, alternatives: Alternatives::default(), without_joint: None })
        }))
    }
}

impl Proofs<'_> {
    /// The values proved at the sets of a gain above the least one, with the shape of the error box with which the error goes the least far
    /// there.
    fn for_gain(&self, Chosen { model, proposal, .. }: &Chosen, proved: &Reduced, gain: f64) -> Option<Reduced> {
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
            let (best, _) = minimise(cost, &start, &[SHAPE_STEP; 2], AT_GAIN)?;
            let there = SharpProposal { parameters: with(&best), sigma: gain, ..*proposal };
            let (_, found) = self.with_values(model, &there, 0.0, ENLARGED[0]).ok()?.ok()?;
            (found.proposal.sigma <= gain).then_some(found)
        })
    }
}

/// Where the values of a plant have none, they are not proved so far.
pub(super) fn beyond_the_bounds(obstacle: Obstacle) -> Obstacle {
    match obstacle.failing {
        Failing::NotFinite(Some(bound)) => Obstacle { failing: Failing::Unproved(bound), ..obstacle },
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

/// Proves again what a certificate says of a plant, without any search.
///
/// Guarantee: as for [`reduce()`].
///
/// # Errors
/// The first part that is not proved.
pub fn decide_again(plant: &Plant, of_plant: OfPlant, values: ProvedValues) -> Result<Specification, PlantRefusal> {
    if plant.states() > MAX_STATES {
        return Err(PlantRefusal::TooManyStates { states: plant.states() });
    }
    plant.prove_periodic().map_err(PlantRefusal::NotPeriodic)?;
    // Of the parameters of this plant, whichever the certificate was made for: an undivided orbit is about their nominal values.
    let own = |cell: &ProvedCell| match of_plant.undivided() {
        Some(_) => plant.parameters.clone(),
        None => plant.parameters.in_cell(&cell.parameters.named_ends()),
    };
    let boxes: Vec<Parameters> = of_plant.cells.iter().map(own).collect();
    if !covers(&boxes, &plant.parameters) {
        return Err(PlantRefusal::Uncovered { cells: boxes.len() });
    }
    let coordinates = Coordinates { l: of_plant.coordinates.clone(), p: of_plant.matrix.clone(), rate: f64::NAN };
    let rational = |constant: &Constant| constant.as_rational().cloned().unwrap_or_default();
    let [alpha, p_low, p_up] = [&of_plant.triple.alpha, &of_plant.triple.p_low, &of_plant.triple.p_up].map(rational);
    let second = of_plant.existence.as_deref().map(|(triple, matrix)| {
        let [alpha, p_low, p_up] = [&triple.alpha, &triple.p_low, &triple.p_up].map(rational);
        (matrix.clone(), SecondTriple { alpha, p_low, p_up })
    });
    let decided = |(ProvedCell { orbit, forcing, .. }, parameters): (&ProvedCell, &Parameters)| {
        let of_cell = in_cell(plant, parameters.clone());
        let ProvedOrbit { approximation, defect, tube, radius } = orbit.clone();
        let [alpha, p_low, p_up] = [&alpha, &p_low, &p_up].map(Rational::clone);
        let orbit = OrbitProof { orbit: approximation, defect, tube, radius, alpha, p_low, p_up };
        decide_orbit(&of_cell, &coordinates, &orbit)?;
        decide_forcing(&of_cell, &coordinates, &orbit, forcing)?;
        if let Some((matrix, triple)) = &second {
            let in_it = Coordinates { l: coordinates.l.clone(), p: matrix.clone(), rate: f64::NAN };
            decide_second(&of_cell, &orbit, &in_it, triple)?;
        }
        Ok(ProvenCell { parameters: parameters.clone(), orbit, forcing: forcing.clone() })
    };
    let cells = of_plant
        .cells
        .par_iter()
        .zip(&boxes)
        .map(decided)
        .collect::<Result<_, _>>()
        .map_err(PlantRefusal::OrbitNotProved)?;
    let along = Along { coordinates, cells, existence: second, why: None };
    let engine = along.engine(plant)?;
    if let Some([x, e]) = values.reach() {
        engine.smooth(&x, &e)?;
    }
    decide_all(&engine, &values, &plant.internal_model.mu)?;
    along.specification(plant, values)
}
