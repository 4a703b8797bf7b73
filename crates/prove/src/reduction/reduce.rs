//! The whole way from a plant to a specification whose data are proved.

use super::cells::{Cell, Cells, NARROW};
use super::choice::{best_by_norms, near, starts, with_constant, with_search};
use super::coordinates::{Chosen, CoordinateSearch, Rough, Start};
use super::joint::with_joint_metrics;
use super::proofs::{Along, PRECISION, Proofs, Reduced, along, trade_off};
use super::refusal::{MAX_STATES, PlantRefusal};
use super::sampling::Sampling;
use super::values::prove_bounds;
use super::watch::{Stage, Unwatched, Watch};
use crate::certify::{Alternatives, ROWS, unit_of_gains};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::parallel;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{PeriodicMatrix, ProvedValues};
use sigmastar_propose::orbit;
use sigmastar_propose::orbit::{FloatOrbit, find_orbit, propose_coordinates, round_orbit};
use sigmastar_propose::search::FloatModel;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::paths::Path;
use sigmastar_theory::evidence::Coordinates;

/// A gain that in a period does no more than this needs not be smaller.
const AS_GOOD_AS_NONE: f64 = 1e-6;

/// What a path with a corner must take from the gain of the straight one: a splitting costs room in proofs and in certificates.
const WORTH_A_CORNER: f64 = 5e-3;

/// How far above the gain of the straight path one with a corner may be before it has been looked at closely.
const FURTHER: f64 = 1.02;

/// By what share of the gain of norms, at few samples, one by a matrix inequality is far better.
pub(super) const FAR_BETTER: f64 = 0.9;

/// A proved gain that is less than so many times the one of samples is near it.
const NEAR_SAMPLES: f64 = 1.1;

/// What an aligned start must take from a gain to be worth a remark.
const WORTH_A_REMARK: f64 = 0.01;

/// What is proved at last, from what norms, or a matrix inequality on a path, prove with the least gain.
pub(super) type Last<'l> = dyn Fn(&Proofs<'_>, (&Chosen, Option<Path>), Reduced) -> Reduced + 'l;

/// The larger gains of which data are proved beside those of the smallest one: each data bound the periodic solution, and how far solutions go,
/// at the gain that they are for and above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Beside<'g> {
    /// None.
    Nothing,
    /// Those of a table of larger gains.
    Rows,
    /// Those of a table of larger gains, and those of one that is given.
    Gain(&'g Rational),
}

/// A gain that is given has data of its own where it is not within this share of one of the table.
const OWN: f64 = 1e-2;

impl Beside<'_> {
    /// The gains, where the smallest one is this.
    fn gains(self, smallest: f64, period: &Enclosure) -> Vec<f64> {
        let unit = Rational::from_f64(smallest).map_or(smallest, |smallest| unit_of_gains(&smallest, period).to_f64());
        let rows = || ROWS.map(|tenths| unit * f64::from(tenths) / 10.0);
        match self {
            Beside::Nothing => Vec::new(),
            Beside::Rows => rows().to_vec(),
            Beside::Gain(gain) => {
                let gain = gain.to_f64();
                let own = rows().iter().all(|row| (row / gain - 1.0).abs() > OWN) && gain > smallest;
                rows().into_iter().chain(own.then_some(gain)).collect()
            }
        }
    }
}

/// Proves the data that the sharp derivation needs, at the arguments where it will need them.
///
/// Guarantee: every value of each specification holds for the plant, relative to its orbit and in the coordinates of its
/// [`OfPlant`](sigmastar_lang::spec::OfPlant); f and q have the period, and are smooth up to the largest arguments. That the gain comes out
/// small is not claimed. What is found does not depend on the gains beside, but for their own data.
///
/// # Errors
/// What could not be proved or found.
pub fn reduce(plant: &Plant, beside: Beside<'_>, watch: &dyn Watch) -> Result<Reduced, PlantRefusal> {
    let last = |proofs: &Proofs<'_>, (chosen, path): (&Chosen, Option<Path>), proved: Reduced| {
        let period = plant.period.nominal().enclose(PRECISION);
        let for_gains = |smallest: f64| {
            // The data of a smaller gain are the base of those of larger ones.
            let gains: Vec<f64> =
                beside.gains(smallest, &period).into_iter().filter(|gain| *gain > proved.proposal.sigma).collect();
            let data = parallel::map(&gains, |gain| proofs.for_gain(chosen, &proved, *gain));
            data.into_iter().flatten().map(|data| (data.spec, data.proposal)).collect::<Vec<_>>()
        };
        // Joint metrics are not proved for an uncertain input gain, and lower a gain by a matrix inequality.
        if chosen.model.input_gain.is_some() || path.is_none() {
            let others = for_gains(proved.proposal.sigma);
            return Reduced { others, ..proved };
        }
        watch.enter(Stage::Metrics);
        let joint = with_joint_metrics(proofs, &chosen.model, &chosen.proposal, &proved);
        match joint {
            Some(found) => {
                let larger = for_gains(found.proposal.sigma);
                let others = std::iter::once((proved.spec, proved.proposal)).chain(larger).collect();
                Reduced { others, ..found }
            }
            None => Reduced { others: for_gains(proved.proposal.sigma), ..proved },
        }
    };
    reduce_to(plant, &last, watch)
}

/// Proves the data of the smallest gain without joint metrics, which may be larger than with them.
///
/// Guarantee: that of [`reduce`].
///
/// # Errors
/// Those of [`reduce`].
pub(super) fn reduce_without_joint(plant: &Plant, watch: &dyn Watch) -> Result<Reduced, PlantRefusal> {
    reduce_to(plant, &|_, _, proved| proved, watch)
}

/// Proves the data that the sharp derivation needs, and has `last` prove what is proved at last. Guarantee: that of [`reduce`], where
/// `last` keeps it.
pub(super) fn reduce_to(plant: &Plant, last: &Last<'_>, watch: &dyn Watch) -> Result<Reduced, PlantRefusal> {
    let (whole, candidates) = with_whole(plant, watch)?;
    let [narrow, narrower] = NARROW;
    let cells = Cells::new(&whole, &candidates, narrow, watch)?;
    in_cells(plant, &cells, &candidates, last, watch).or_else(|refusal| {
        // The tube may take what the initial set needs, and be too wide in other coordinates.
        let finer = refusal.may_be_of_tube().then(|| Cells::new(&whole, &candidates, narrower, watch));
        match finer {
            Some(Ok(finer)) if finer.list.len() > cells.list.len() => {
                in_cells(plant, &finer, &candidates, last, watch).map_err(|_| refusal)
            }
            _ => Err(refusal),
        }
    })
}

/// The data that [`reduce_to`] proves, in these cells.
fn in_cells(
    plant: &Plant,
    cells: &Cells,
    candidates: &[Coordinates],
    last: &Last<'_>,
    watch: &dyn Watch,
) -> Result<Reduced, PlantRefusal> {
    with_cells(plant, cells, candidates, watch, |_, sampling| {
        let starts = starts(candidates, sampling);
        // A descent by norms is worth its time where a matrix inequality does not do far better from the same start.
        let far_better = starts.as_ref().ok().and_then(|(p, rough)| {
            let starts = with_search(sampling, Some(Path::Straight), |search| Ok(search.for_matrix(rough))).ok()?;
            let found = best_by_matrix(p, &starts, sampling)?;
            let known = rough.best.proposal.sigma;
            (found.chosen.proposal.sigma < FAR_BETTER * known).then(|| found.proved(sampling, Some(known)).ok())?
        });
        let far_better = match far_better {
            // What is proved may be far above what the samples promise; without a choice of coordinates norms take no descent.
            Some(found) if found.is_near() && plant.states() > 1 => return found.finished(sampling, last),
            found => found,
        };
        let (along, chosen) = match best_by_norms(candidates, &starts, sampling) {
            Ok(found) => found,
            Err(refusal) => return far_better.map_or(Err(refusal), |found| found.finished(sampling, last)),
        };
        let by_matrix = best_by_matrix(&along.coordinates.p, &[Start::from(&chosen)], sampling);
        let by_matrix = by_matrix.and_then(|found| found.proved(sampling, Some(chosen.proposal.sigma)).ok());
        let mut all: Vec<Proved> = by_matrix.into_iter().chain(far_better).collect();
        // What norms prove is above the samples.
        let least = chosen.proposal.sigma;
        if all.iter().all(|found| found.gain() >= least) {
            match (Found { along, chosen, path: None }.proved(sampling, None)) {
                Ok(found) => all.push(found),
                Err(refusal) if all.is_empty() => return Err(refusal),
                Err(_) => {}
            }
        }
        // Of those that are as good the first stays first.
        all.sort_by(|a, b| a.gain().total_cmp(&b.gain()));
        let mut all = all.into_iter();
        let best = all.next().ok_or(PlantRefusal::NoContraction)?;
        // What is proved at last may do more for the one that is a little behind.
        let behind = all.next().filter(|other| other.gain() < NEAR_SAMPLES * best.gain());
        let best = best.finished(sampling, last)?;
        let behind = behind.and_then(|other| other.finished(sampling, last).ok());
        Ok(behind.filter(|other| other.proposal.sigma < best.proposal.sigma).unwrap_or(best))
    })
}

/// Proves the data that the sharp derivation needs with C5 by norms: what a bounding specification of the plant can have.
///
/// Guarantee: that of [`reduce`].
///
/// # Errors
/// What could not be proved or found.
pub fn reduce_by_norms(plant: &Plant) -> Result<Reduced, PlantRefusal> {
    reduce_by_norms_watched(plant, &Unwatched)
}

/// Proves the data with C5 by norms as [`reduce_by_norms`] does, while `watch` hears of the stages.
///
/// # Errors
/// Those of [`reduce_by_norms`].
pub(super) fn reduce_by_norms_watched(plant: &Plant, watch: &dyn Watch) -> Result<Reduced, PlantRefusal> {
    with_coordinates(plant, watch, |along, sampling, chosen| {
        Ok(Found { along, chosen, path: None }.proved(sampling, None)?.reduced)
    })
}

/// Proves the data with C5 by norms in the coordinates that are proposed first, where they lead to a gain: for rows beside a claim. The gain
/// may be larger than that of [`reduce_by_norms`], which improves the coordinates.
///
/// Guarantee: that of [`reduce`].
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
        Ok(Found { along, chosen, path: None }.proved(sampling, None)?.reduced)
    })
}

/// Finds and proves the orbit, chooses the coordinates by norms, and goes on from there.
pub(super) fn with_coordinates<T>(
    plant: &Plant,
    watch: &dyn Watch,
    prove: impl FnOnce(Along, &Sampling<'_>, Chosen) -> Result<T, PlantRefusal>,
) -> Result<T, PlantRefusal> {
    with_candidates(plant, watch, |candidates, sampling| {
        let (along, chosen) = best_by_norms(candidates, &starts(candidates, sampling), sampling)?;
        prove(along, sampling, chosen)
    })
}

/// Finds the orbit, proposes coordinates, cuts the box of a family where its tube is wide, and goes on from there.
pub(super) fn with_candidates<T>(
    plant: &Plant,
    watch: &dyn Watch,
    prove: impl FnOnce(&[Coordinates], &Sampling<'_>) -> Result<T, PlantRefusal>,
) -> Result<T, PlantRefusal> {
    let (whole, candidates) = with_whole(plant, watch)?;
    let cells = Cells::new(&whole, &candidates, NARROW[0], watch)?;
    with_cells(plant, &cells, &candidates, watch, |_, sampling| prove(&candidates, sampling))
}

/// The orbit, found for all members at once, and candidates for the coordinates: at least one.
fn with_whole(plant: &Plant, watch: &dyn Watch) -> Result<(Cell, Vec<Coordinates>), PlantRefusal> {
    let (whole, found) = whole(plant, watch)?;
    let candidates = propose_coordinates(plant, &found, 0.0, 0.0).map_err(PlantRefusal::NoOrbit)?;
    let candidates: Vec<Coordinates> = candidates.into_iter().map(|rated| rated.coordinates).collect();
    if candidates.is_empty() { Err(PlantRefusal::NoContraction) } else { Ok((whole, candidates)) }
}

/// The orbit, found for all members at once: rounded, and as it was found.
pub(super) fn whole(plant: &Plant, watch: &dyn Watch) -> Result<(Cell, FloatOrbit), PlantRefusal> {
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
    Ok((whole, found))
}

/// Proves the orbits of all cells in the first coordinates, and goes on from there.
pub(super) fn with_cells<T>(
    plant: &Plant,
    cells: &Cells,
    candidates: &[Coordinates],
    watch: &dyn Watch,
    prove: impl FnOnce(&Along, &Sampling<'_>) -> Result<T, PlantRefusal>,
) -> Result<T, PlantRefusal> {
    let first = candidates.first().ok_or(PlantRefusal::NoContraction)?;
    let along = along(&cells.list, first)?;
    let spec = along.specification(plant, ProvedValues::default())?;
    let data = Data::new(&spec, PRECISION);
    let model = FloatModel::new(&data, trade_off(&data));
    let sampling = Sampling::new(plant, cells, &model, watch, along.tube());
    watch.enter(Stage::Coordinates);
    prove(&along, &sampling)
}

/// What was found in floating point.
struct Found {
    along: Along,
    chosen: Chosen,
    /// The path of the matrix inequality of stability; norms without.
    path: Option<Path>,
}

/// What was found in floating point, with its data proved.
struct Proved {
    found: Found,
    reduced: Reduced,
    /// About the gain by norms, beside one by a matrix inequality.
    by_norms: Option<f64>,
}

impl Found {
    /// The gain with what a corner has to take from it.
    fn cost(&self) -> f64 {
        let corner = if self.path == Some(Path::Straight) { 1.0 } else { 1.0 + WORTH_A_CORNER };
        self.chosen.proposal.sigma * corner
    }

    fn proved(self, sampling: &Sampling<'_>, by_norms: Option<f64>) -> Result<Proved, PlantRefusal> {
        let Found { along, chosen, path } = &self;
        let proved = prove_bounds(&Proofs::new(along, sampling)?, chosen)?;
        let reduced = Reduced { near: near(sampling, along, chosen, *path).map(Box::new), ..proved };
        Ok(Proved { found: self, reduced, by_norms })
    }
}

impl Proved {
    fn gain(&self) -> f64 {
        self.reduced.proposal.sigma
    }

    /// Whether the proved gain is near the one that samples promise.
    fn is_near(&self) -> bool {
        self.gain() < NEAR_SAMPLES * self.found.chosen.proposal.sigma
    }

    /// With what is proved at last, and what norms and an aligned start would give beside.
    fn finished(self, sampling: &Sampling<'_>, last: &Last<'_>) -> Result<Reduced, PlantRefusal> {
        let Proved { found: Found { along, chosen, path }, reduced, by_norms } = self;
        let near = reduced.near;
        let proofs = Proofs::new(&along, sampling)?;
        let proved = last(&proofs, (&chosen, path), Reduced { near: None, ..reduced });
        let Some(path) = path else { return Ok(Reduced { near, ..proved }) };
        // It is one of (M): beside joint metrics it may be larger than what they prove from another start.
        let lower = |aligned: &f64| *aligned < proved.proposal.sigma * (1.0 - WORTH_A_REMARK);
        let aligned = aligned(sampling, &chosen, path).filter(lower);
        let nominal_gain = with_nominal_gain(sampling, &along, &chosen, path);
        let alternatives = Alternatives { by_norms, aligned, nominal_gain };
        Ok(Reduced { alternatives, near, ..proved })
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
fn best_by_matrix(p: &PeriodicMatrix, starts: &[Start], sampling: &Sampling<'_>) -> Option<Found> {
    let is_small = |start: &Start| start.proposal.sigma * sampling.model.period < AS_GOOD_AS_NONE;
    if !p.harmonics.is_empty() || starts.iter().any(is_small) {
        return None;
    }
    let near = |start: &Start, path: Path, limit: f64| {
        let choose = |search: &CoordinateSearch<'_>| search.choose_near(start, start.proposal.sigma, limit);
        let (along, chosen) = with_constant(p, sampling, Some(path), choose).ok()?;
        Some(Found { along, chosen, path: Some(path) })
    };
    let smaller = |a: &Found, b: &Found| a.cost().total_cmp(&b.cost());
    // The straight one says which of the starts is the best.
    let straight: Vec<_> = parallel::map(starts, |start| near(start, Path::Straight, f64::INFINITY));
    let straight = straight.into_iter().flatten().min_by(smaller);
    if !sampling.varies() {
        return straight;
    }
    let start = match (starts, &straight) {
        ([_, _, ..], Some(found)) => Start::from(&found.chosen),
        _ => starts.first()?.clone(),
    };
    let limit = straight.as_ref().map_or(f64::INFINITY, |found| FURTHER * found.chosen.proposal.sigma);
    let others: Vec<_> = parallel::map(&Path::CHOICE, |&path| near(&start, path, limit));
    others.into_iter().flatten().chain(straight).min_by(smaller)
}
