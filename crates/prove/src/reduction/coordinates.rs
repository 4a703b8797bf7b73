//! Which coordinates y, `x = x_0 + L y`, give the smallest gain: a search in floating point over L.
//!
//! With a constant P nothing is lost by P = I in the coordinates y (derivation, 11.5), so L stands for P. Rotations of y change
//! nothing: L varies as `L exp(S)` with symmetric S. The existence of the periodic solution may rest on a P of its own, `exp(S')`.

use super::estimates::{Density, Estimates};
use super::grid::{Grid, RATE, RATE_EXISTENCE, functions};
use super::sampling::{Sampling, rational_symmetric};
use nalgebra::{DMatrix, SymmetricEigen};
use sigmastar_exact::number::Portable;
use sigmastar_exact::parallel;
use sigmastar_lang::spec::PeriodicMatrix;
use sigmastar_propose::bounds::{Asked, EnergyAt, EnergyWeights, FloatWeights, Focus};
use sigmastar_propose::search::{
    ByEnergy, ByMatrix, Closest, Descent, EnergyMargin, FloatModel, Obstacle, PeriodicSet, ROOMY, SharpParameters,
    SharpProposal, Threshold, active_level, at_sigma, minimise, search_sharp, search_sharp_near, weight_h,
};
use sigmastar_theory::derivation::harmonics::AtOrigin;
use sigmastar_theory::derivation::paths::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// L, and in its coordinates the P of existence, where it is not that of stability.
#[derive(Clone, Copy, Debug)]
pub struct Shape<'a> {
    /// L.
    pub l: &'a DMatrix<f64>,
    /// The other P.
    pub second: Option<&'a DMatrix<f64>>,
    /// What existence rests on beside it, in its coordinates.
    pub energy: Option<&'a EnergyWeights>,
}

/// The ratio of neighbouring nodes of a rough grid.
const ROUGH: f64 = 2.5;

/// That of a coarse one.
const COARSE: f64 = 1.6;

/// That of a fine one.
const FINE: f64 = 1.12;

/// That of every grid without states, where a node costs next to nothing.
const ALONE: f64 = 1.02;

/// The first step of S.
const STEP: f64 = 0.15;

/// A descent over L and the like; a relative change of sigma* by the tolerance is none.
const DESCENT: Descent = Descent { restarts: 0, iterations: 60, tolerance: 1e-3 };

/// How many descents there are, and how far apart in the list of candidates they start: what looks smallest at few samples need not
/// be so at many.
const DESCENTS: usize = 3;
const APART: usize = 3;

/// How often a descent looks again for the points that matter.
pub(super) const TURNS: usize = 2;

/// The share of the rate along the orbit that x keeps in a matrix inequality.
const KEPT: f64 = 1e-6;

/// The first steps of ln (rho - 1) and of ln eta.
pub(super) const SHAPE_STEP: f64 = 0.4;

/// The shares of rho - 1 and of eta from which it is sought, in turn.
const SHARES: [[f64; 2]; 8] =
    [[1.0, 1.0], [0.5, 1.0], [0.2, 1.0], [0.2, 0.1], [1.0, 0.1], [1.0, 10.0], [0.05, 0.1], [0.05, 0.01]];

/// A descent over the shape as well.
const TOGETHER: Descent = Descent { restarts: 1, iterations: 120, tolerance: 1e-3 };

/// How far above a gain the arguments are taken.
pub(super) const NEAR: f64 = 1e-9;

/// The gains at which the points that matter are looked for, over that of a proposal, in turn: what few points promise need not be there at
/// more.
const WHERE_IT_MATTERS: [f64; 5] = [1.0, 1.05, 1.25, 2.0, 4.0];

/// What a P of existence must take from sigma* to be worth its room in a certificate.
const WORTH: f64 = 1e-3;

/// Beyond so many states L is taken as it is proposed: the numbers in S are too many.
pub(super) const MOST_STATES: usize = 4;

/// A search for coordinates.
pub struct CoordinateSearch<'a> {
    /// What samples the bounds, and the model but for what depends on L.
    pub(super) sampling: &'a Sampling<'a>,
    /// The P in the coordinates y; the identity without.
    pub(super) p: Option<&'a PeriodicMatrix>,
    /// P_up/P_low of it.
    pub(super) ratio: f64,
    /// The path of the matrix inequality by which stability is sought; by norms without.
    pub(super) by_matrix: Option<Path>,
}

/// Coordinates, the model in them, and the smallest gain that was found.
pub struct Chosen {
    /// L.
    pub l: DMatrix<f64>,
    /// The P of existence, where it is another one.
    pub second: Option<DMatrix<f64>>,
    /// What existence rests on beside it, if anything.
    pub energy: Option<EnergyWeights>,
    /// The model with finely sampled bounds.
    pub model: FloatModel,
    /// The free numbers.
    pub proposal: SharpProposal,
}

/// Where a descent is: L, the P of existence where it is another one, and the free numbers.
#[derive(Clone)]
pub struct Start {
    /// L.
    pub l: DMatrix<f64>,
    /// The P of existence.
    pub second: Option<DMatrix<f64>>,
    /// What existence rests on beside it, if anything.
    pub energy: Option<EnergyWeights>,
    /// The free numbers.
    pub proposal: SharpProposal,
    /// The room between both sides of S1 and S2 with which the gain is sought, relatively, in continuous time.
    pub room: f64,
}

/// What candidates promise at few samples: all of them, from where descents by norms start, which are all where L is not varied, and the
/// best.
pub struct Rough {
    /// All.
    pub all: Vec<Start>,
    /// The starts.
    pub starts: Vec<Start>,
    /// The best one.
    pub best: Start,
}

impl From<&Chosen> for Start {
    fn from(chosen: &Chosen) -> Self {
        Start {
            l: chosen.l.clone(),
            second: chosen.second.clone(),
            energy: chosen.energy.clone(),
            proposal: chosen.proposal,
            room: ROOMY,
        }
    }
}

impl Start {
    pub(super) fn shape(&self) -> Shape<'_> {
        Shape { l: &self.l, second: self.second.as_ref(), energy: self.energy.as_ref() }
    }
}

/// What a descent varies, beside the shape of the error box, which it does with a matrix inequality.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Varied {
    /// Nothing else.
    Shape,
    /// L.
    Coordinates,
    /// L and the P of existence.
    Both,
}

impl CoordinateSearch<'_> {
    /// What is sampled for a given L.
    pub(super) fn estimates(&self, Shape { l, second, .. }: Shape<'_>, density: &Density) -> Estimates {
        let second = second.and_then(rational_symmetric);
        self.sampling.estimates(l, [self.p, second.as_ref()], density)
    }

    /// The model for a given L.
    #[must_use]
    pub fn model(&self, shape: Shape<'_>, density: &Density) -> FloatModel {
        let Shape { l, second, energy } = shape;
        let ratio = match density {
            _ if l.nrows() == 0 => ALONE,
            Density::Rough => ROUGH,
            Density::Coarse | Density::Focused(_) => COARSE,
            Density::Fine(_) => FINE,
        };
        let estimates = Arc::new(self.estimates(shape, density));
        let at_origin = estimates.bounds(0.0, 0.0, Asked::ALL);
        let units = self.sampling.units(l);
        let of_bounds = estimates.clone();
        let bounds = move |x: f64, e: f64, asked: Asked| of_bounds.bounds(x, e, asked);
        let bounds = functions(bounds, units, ratio, second.is_some());
        let mut model = self.sampling.model.with_bounds(bounds).with_triple(self.ratio, at_origin[RATE]);
        if let Some(second) = second {
            let values = second.clone().symmetric_eigenvalues();
            model = model.with_existence_triple(values.max() / values.min(), at_origin[RATE_EXISTENCE]);
        }
        if let Some(path) = self.by_matrix {
            let of_matrix = estimates.clone();
            let threshold: Arc<Threshold> = Arc::new(move |at, weights| of_matrix.threshold(at, weights));
            model.by_matrix = Some(ByMatrix::Sampled { path, threshold, rate: KEPT * at_origin[RATE] });
        }
        if let Some(energy) = energy {
            let weights = Arc::new(energy.clone());
            let (known, k_p) = (weights.clone(), weights.k_p);
            let least = move |points: Vec<EnergyAt>| {
                let least =
                    move |value: f64| points.iter().map(|point| point.margin(k_p, value)).fold(f64::INFINITY, f64::min);
                Remembered::new(least)
            };
            let grid = Grid::new(move |x, e| least(estimates.energy_at([x, e], &known)), units, ratio);
            let margin: Arc<EnergyMargin> =
                Arc::new(move |at, value| grid.at(at, |node| node.at(value)).unwrap_or(f64::NAN));
            model.by_energy = Some(ByEnergy::Sampled { weights, margin });
        }
        let model = self.sampling.in_frame(l, model);
        if matches!(density, Density::Fine(_)) { model } else { model.rough() }
    }

    /// What some candidates promise at few samples.
    ///
    /// # Errors
    /// The obstacle of the candidate that came closest.
    pub fn rough(&self, candidates: &[DMatrix<f64>]) -> Result<Rough, Obstacle> {
        // The first one that has a gain leads to those of the others by local steps.
        let mut closest = Closest::default();
        let first = candidates.iter().find_map(|l| {
            self.sampling.count();
            let found = search_sharp(&self.model(alone(l), &Density::Rough));
            found.map_err(|obstacle| closest.record(obstacle)).ok()
        });
        let first = closest.or(first)?;
        let near = |l: &DMatrix<f64>| {
            self.sampling.count();
            search_sharp_near(&self.model(alone(l), &Density::Coarse), &first)
        };
        let found: Vec<Result<SharpProposal, Obstacle>> = parallel::map(candidates, near);
        let mut closest = Closest::default();
        let mut best: Option<(SharpProposal, usize)> = None;
        let (mut starts, mut all) = (Vec::new(), Vec::new());
        for (at, found) in found.into_iter().enumerate() {
            match found {
                Ok(found) => {
                    starts.push(at);
                    all.push(Start {
                        l: candidates[at].clone(),
                        second: None,
                        energy: None,
                        proposal: found,
                        room: ROOMY,
                    });
                    if best.as_ref().is_none_or(|(known, _)| found.sigma < known.sigma) {
                        best = Some((found, at));
                    }
                }
                Err(obstacle) => closest.record(obstacle),
            }
        }
        let (proposal, at) = closest.or(best)?;
        // Where L is not varied, each of them may be the best.
        if candidates[at].nrows() <= MOST_STATES {
            starts.retain(|other| other.abs_diff(at).is_multiple_of(APART));
            starts.sort_by_key(|other| (other.abs_diff(at), *other));
            starts.truncate(DESCENTS);
        }
        let start =
            |at: &usize| Start { l: candidates[*at].clone(), second: None, energy: None, proposal, room: ROOMY };
        Ok(Rough { all, starts: starts.iter().map(start).collect(), best: start(&at) })
    }

    /// The best of these starts, each improved by a local search: the smallest gain at many samples.
    ///
    /// # Errors
    /// The obstacle, where no gain is found.
    pub fn choose(&self, rough: &Rough) -> Result<Chosen, Obstacle> {
        let Rough { starts, best, .. } = rough;
        if !(2..=MOST_STATES).contains(&best.l.nrows()) {
            return self.with(best.shape(), Some(&best.proposal));
        }
        let descents: Vec<Option<Chosen>> = parallel::map(starts, |from| {
            let mut at = from.clone();
            for _ in 0..TURNS {
                at = self.descend(&at, Varied::Coordinates)?;
            }
            self.with(at.shape(), Some(&at.proposal)).ok()
        });
        let smallest = descents.into_iter().flatten().min_by(|a, b| a.proposal.sigma.total_cmp(&b.proposal.sigma));
        let single = match smallest {
            Some(single) => single,
            None => self.with(best.shape(), Some(&best.proposal))?,
        };
        Ok(self.with_second(single))
    }

    /// Whether the inequality of existence of a model says anything of the set of a proposal.
    fn energy_serves(&self, model: &FloatModel, proposal: &SharpProposal) -> bool {
        let SharpParameters { form, floors, .. } = proposal.parameters;
        let (origin, sigma) = (AtOrigin::new(model), proposal.sigma * (1.0 + NEAR));
        let set = PeriodicSet::least(model, &origin, sigma, (form, floors), model.effort().room);
        let Some((known, set)) = model.by_energy.as_ref().zip(set.ok()) else { return false };
        known.bounds([set.x_p, set.e_p], &origin, sigma).is_ok()
    }

    /// The best that is reached from there, at the points that are the most extreme ones there; `None` where there is no gain.
    pub(super) fn descend(&self, from: &Start, varied: Varied) -> Option<Start> {
        let Start { l, second, energy, proposal, room } = from;
        let energy = energy.as_ref();
        let n = l.nrows();
        let of_matrix = if (2..=MOST_STATES).contains(&n) { n * (n + 1) / 2 - 1 } else { 0 };
        let [of_l, of_second] = match varied {
            Varied::Shape => [0, 0],
            Varied::Coordinates => [of_matrix, 0],
            Varied::Both => [of_matrix, of_matrix],
        };
        // The P of stability as another one, to begin with.
        let second = second.clone().or_else(|| (of_second > 0).then(|| DMatrix::identity(n, n)));
        let focus = self.focus_near(Shape { l, second: second.as_ref(), energy }, proposal).ok()?;
        let density = focus.map_or(Density::Coarse, Density::Focused);
        let of_shape = if self.by_matrix.is_some() { 2 } else { 0 };
        // Where L stays, what was sampled serves again.
        let same =
            (of_l == 0).then(|| self.model(Shape { l, second: second.as_ref(), energy }, &density).with_room(*room));
        let with = |p: &[f64]| {
            self.sampling.count();
            let (shape, matrices) = p.split_at(of_shape);
            let mut parameters = proposal.parameters;
            if let [rho, eta] = shape {
                parameters = SharpParameters { rho: 1.0 + rho.portable_exp(), eta: eta.portable_exp(), ..parameters };
            }
            let turn = |entries: &[f64]| match entries {
                [] => DMatrix::identity(n, n),
                entries => exponential(n, entries),
            };
            let (first, other) = (turn(&matrices[..of_l]), turn(&matrices[of_l..]));
            // The P of existence stays what it is in the coordinates x, but for what is varied of it.
            let second = second.as_ref().map(|second| &other * &first * second * &first * &other);
            let energy = energy.map(|energy| energy_in(energy, &first));
            let l = l * &first;
            let shape = Shape { l: &l, second: second.as_ref(), energy: energy.as_ref() };
            let other = same.is_none().then(|| self.model(shape, &density).with_room(*room));
            let model = same.as_ref().or(other.as_ref())?;
            let found = search_sharp_near(model, &SharpProposal { parameters, ..*proposal }).ok()?;
            Some(Start { l, second, energy, proposal: found, room: *room })
        };
        let cost = |p: &[f64]| with(p).map(|found| found.proposal.sigma.portable_ln());
        // The box of the norms may be too large.
        let start = |[of_rho, of_eta]: [f64; 2]| -> Vec<f64> {
            let SharpParameters { rho, eta, .. } = proposal.parameters;
            let shape = [((rho - 1.0) * of_rho).portable_ln(), (eta * of_eta).portable_ln()];
            shape.into_iter().take(of_shape).chain(std::iter::repeat_n(0.0, of_l + of_second)).collect()
        };
        let shares = if of_shape > 0 { &SHARES[..] } else { &SHARES[..1] };
        let start = shares.iter().map(|share| start(*share)).find(|start| cost(start).is_some())?;
        let steps: Vec<f64> = (0..start.len()).map(|i| if i < of_shape { SHAPE_STEP } else { STEP }).collect();
        let descent = if of_shape > 0 { TOGETHER } else { DESCENT };
        let best = minimise(&cost, &start, &steps, descent).map_or(start, |(best, _)| best);
        with(&best)
    }

    /// The points that matter near a proposal.
    pub(super) fn focus(&self, shape: Shape<'_>, known: &SharpProposal) -> Result<Focus, Obstacle> {
        let model = self.model(shape, &Density::Coarse);
        let estimates = self.estimates(shape, &Density::Coarse);
        let near =
            |model: &FloatModel| at_sigma(model, &known.parameters, known.sigma * (1.0 + NEAR), model.effort().room);
        // What norms promise need not be there by the matrix inequality.
        let by_norms = |_| {
            let mut model = model.clone();
            model.by_matrix = None;
            near(&model)
        };
        let (set, at) = near(&model).or_else(by_norms)?;
        let level = active_level(at.eta, at.dist_e, at.rho);
        let weights = FloatWeights {
            w_x: level / (model.p_low * at.d_x * at.d_x),
            k_p: 2.0 * weight_h(at.eta, at.dist_e, at.dist_z) / model.mu,
            rate: 0.0,
        };
        let error_box = [set.x_per + at.d_x, set.e_per + level.sqrt()];
        let inequality =
            self.by_matrix.map(|path| (ByMatrix::arguments(path, [set.x_per, set.e_per], error_box), weights));
        Ok(estimates.extreme(&[[set.x_p, set.e_p], error_box], inequality))
    }

    /// The points that matter near a proposal, at the first of a few gains at which there are such points; none where every point is looked at
    /// instead.
    ///
    /// # Errors
    /// The obstacle, where there are none and pairs of points would have to be sought anew for every candidate, which takes minutes.
    fn focus_near(&self, shape: Shape<'_>, known: &SharpProposal) -> Result<Option<Focus>, Obstacle> {
        let mut first = None;
        for more in WHERE_IT_MATTERS {
            match self.focus(shape, &SharpProposal { sigma: known.sigma * more, ..*known }) {
                Ok(focus) => return Ok(Some(focus)),
                Err(obstacle) => first = first.or(Some(obstacle)),
            }
        }
        let in_pairs = self.by_matrix.is_some_and(|path| path != Path::Straight);
        first.filter(|_| in_pairs).map_or(Ok(None), Err)
    }

    /// The choice with a P of existence of its own, where that is worth it.
    pub(super) fn with_second(&self, single: Chosen) -> Chosen {
        if !(2..=MOST_STATES).contains(&single.l.nrows()) {
            return single;
        }
        let mut at = Start::from(&single);
        for _ in 0..TURNS {
            match self.descend(&at, Varied::Both) {
                Some(next) => at = next,
                None => return single,
            }
        }
        let worth = |found: &Chosen| found.proposal.sigma < single.proposal.sigma * (1.0 - WORTH);
        let pair = self.with(at.shape(), Some(&at.proposal)).ok();
        pair.filter(worth).unwrap_or(single)
    }

    /// The proposal for given coordinates.
    ///
    /// # Errors
    /// The obstacle, where no gain is found.
    pub fn with(&self, shape: Shape<'_>, near: Option<&SharpProposal>) -> Result<Chosen, Obstacle> {
        let focus = near.map_or(Ok(None), |known| self.focus_near(shape, known))?;
        let model = self.model(shape, &Density::Fine(focus.and_then(|focus| focus.corners)));
        let reshaped = |known: &SharpProposal, [of_rho, of_eta]: [f64; 2]| {
            let SharpParameters { rho, eta, .. } = known.parameters;
            let parameters = SharpParameters { rho: 1.0 + (rho - 1.0) * of_rho, eta: eta * of_eta, ..known.parameters };
            search_sharp_near(&model, &SharpProposal { parameters, ..*known })
        };
        let proposal = match near {
            // A scan of all shapes takes minutes there.
            Some(known) if self.by_matrix.is_some() => {
                let [same, others @ ..] = SHARES;
                reshaped(known, same).or_else(|obstacle| {
                    let found = others.into_iter().filter_map(|share| reshaped(known, share).ok());
                    found.min_by(|a, b| a.sigma.total_cmp(&b.sigma)).ok_or(obstacle)
                })?
            }
            // What few samples promise may be far from what there is, and without states a search takes next to nothing.
            Some(known) if shape.l.nrows() > 0 => search_sharp_near(&model, known).or_else(|_| search_sharp(&model))?,
            _ => search_sharp(&model)?,
        };
        let proposal = best_shape_near(&model, proposal);
        let Shape { l, second, energy } = shape;
        // Where it says nothing of the set, the search has gone on without it.
        let energy = energy.filter(|_| self.energy_serves(&model, &proposal));
        let mut model = model;
        model.by_energy = model.by_energy.filter(|_| energy.is_some());
        Ok(Chosen { l: l.clone(), second: second.cloned(), energy: energy.cloned(), model, proposal })
    }
}

/// A function that knows its last argument and value: the threshold stays as it is while a set is sought.
struct Remembered<F> {
    of: F,
    last: Mutex<[f64; 2]>,
}

impl<F: Fn(f64) -> f64> Remembered<F> {
    fn new(of: F) -> Remembered<F> {
        Remembered { of, last: Mutex::new([f64::NAN; 2]) }
    }

    fn at(&self, argument: f64) -> f64 {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if last[0] != argument {
            *last = [argument, (self.of)(argument)];
        }
        last[1]
    }
}

/// The proposal with the shape of the error box that is best beside it.
pub(super) fn best_shape_near(model: &FloatModel, proposal: SharpProposal) -> SharpProposal {
    if model.by_matrix.is_none() {
        return proposal;
    }
    let SharpParameters { rho, eta, .. } = proposal.parameters;
    let with = |model: &FloatModel, p: &[f64]| {
        let parameters =
            SharpParameters { rho: 1.0 + p[0].portable_exp(), eta: p[1].portable_exp(), ..proposal.parameters };
        search_sharp_near(model, &SharpProposal { parameters, ..proposal }).ok()
    };
    let rough = model.clone().rough().with_room(model.effort().room);
    let cost = |p: &[f64]| with(&rough, p).map(|found| found.sigma.portable_ln());
    let start = [(rho - 1.0).portable_ln(), eta.portable_ln()];
    let best = minimise(&cost, &start, &[0.5 * SHAPE_STEP; 2], DESCENT);
    let best = best.and_then(|(best, _)| with(model, &best));
    best.filter(|found| found.sigma < proposal.sigma).unwrap_or(proposal)
}

/// The shape with L alone: stability and existence have one P, and existence has no matrix inequality.
pub(super) fn alone(l: &DMatrix<f64>) -> Shape<'_> {
    Shape { l, second: None, energy: None }
}

/// The weights of existence in the coordinates in which y is `change` times the new one.
#[must_use]
pub fn energy_in(energy: &EnergyWeights, change: &DMatrix<f64>) -> EnergyWeights {
    let n = change.nrows();
    let p = DMatrix::from_fn(n, n, |i, j| energy.p[i][j]);
    let p = change.transpose() * p * change;
    let smallest = if n == 0 { 1.0 } else { change.singular_values().min() };
    let rows = (0..n).map(|i| (0..n).map(|j| 0.5 * (p[(i, j)] + p[(j, i)])).collect()).collect();
    EnergyWeights { p: rows, c_x: energy.c_x * smallest * smallest, ..energy.clone() }
}

/// exp(S) for the symmetric S of trace 0 with these entries: the diagonal but for its last, then what is above it.
fn exponential(n: usize, entries: &[f64]) -> DMatrix<f64> {
    let mut s = DMatrix::zeros(n, n);
    let mut entries = entries.iter().copied();
    for (i, value) in (0..n - 1).zip(&mut entries) {
        s[(i, i)] = value;
        s[(n - 1, n - 1)] -= value;
    }
    for i in 0..n {
        for j in 0..i {
            let value = entries.next().unwrap_or(0.0);
            s[(i, j)] = value;
            s[(j, i)] = value;
        }
    }
    let eigen = SymmetricEigen::new(s);
    let values = eigen.eigenvalues.map(Portable::portable_exp);
    &eigen.eigenvectors * DMatrix::from_diagonal(&values) * eigen.eigenvectors.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// It is evaluated where the argument is another one, and only there.
    #[test]
    fn the_last_value_is_remembered() {
        let count = std::cell::Cell::new(0);
        let square = Remembered::new(|x: f64| {
            count.set(count.get() + 1);
            x * x
        });
        let found = [2.0, 2.0, 3.0, 2.0, 2.0, f64::NAN].map(|x| square.at(x));
        assert_eq!(found[..5], [4.0, 4.0, 9.0, 4.0, 4.0]);
        assert!(found[5].is_nan() && count.get() == 4);
    }

    /// Symmetric, positive, of determinant 1, and with all of its parameters.
    #[test]
    fn exponentials_of_symmetric_matrices() {
        for n in 1..=4 {
            let entries: Vec<f64> = (0..n * (n + 1) / 2 - 1).map(|k| 0.3 - 0.17 * k as f64).collect();
            let m = exponential(n, &entries);
            assert!((m.determinant() - 1.0).abs() < 1e-12);
            assert!((&m - m.transpose()).norm() < 1e-12);
            assert!(SymmetricEigen::new(m.clone()).eigenvalues.min() > 0.0);
            let opposite: Vec<f64> = entries.iter().map(|value| -value).collect();
            assert!((m * exponential(n, &opposite) - DMatrix::identity(n, n)).norm() < 1e-12);
        }
    }
}
