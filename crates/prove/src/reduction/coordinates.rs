//! Which coordinates y, `x = x_0 + L y`, give the smallest gain: a search in floating point over L.
//!
//! With a constant P nothing is lost by P = I in the coordinates y (derivation, 11.5), so L stands for P. Rotations of y change
//! nothing: L varies as `L exp(S)` with symmetric S. The existence of the periodic solution may rest on a P of its own, `exp(S')`.

use super::grid::{Grid, RATE, RATE_EXISTENCE, Source};
use crate::search::{
    Binding, ByMatrix, Closest, Descent, Failing, FloatModel, Obstacle, SharpParameters, SharpProposal, Threshold,
    active_level, at_sigma, minimise, search_sharp, search_sharp_near, weight_h,
};
use nalgebra::{DMatrix, SymmetricEigen};
use rayon::prelude::*;
use sigmastar_exact::number::Portable;
use sigmastar_lang::spec::Bound;
use sigmastar_plants::bounds::{Asked, Corners, FloatWeights, Focus, MatrixArguments};
use sigmastar_theory::derivation::paths::Path;
use std::sync::Arc;

/// How densely suprema are sampled.
#[derive(Clone, Debug)]
pub enum Density {
    /// To find a gain at all.
    Rough,
    /// To compare coordinates.
    Coarse,
    /// To compare coordinates near some, at the points that are the most extreme ones there.
    Focused(Focus),
    /// For the coordinates that are taken; with the corners of the matrix inequality near a proposal, where it is sought.
    Fine(Option<Corners>),
}

/// L, and in its coordinates the P of existence, where it is not that of stability.
#[derive(Clone, Copy, Debug)]
pub struct Shape<'a> {
    /// L.
    pub l: &'a DMatrix<f64>,
    /// The other P.
    pub second: Option<&'a DMatrix<f64>>,
}

/// Estimates for given coordinates.
pub struct Estimates {
    /// Of the bounds.
    pub bounds: Arc<Source>,
    /// Of the threshold of the matrix inequality.
    pub threshold: Arc<Threshold>,
    /// Where they are the most extreme ones.
    pub extreme: Arc<Extreme>,
}

/// The points that are the most extreme ones on some `G(X, E)`, and of the matrix inequality.
pub type Extreme = dyn Fn(&[[f64; 2]], Option<(MatrixArguments, FloatWeights)>) -> Focus + Send + Sync;

/// What estimates.
pub type Sampler<'a> = dyn Fn(Shape<'_>, &Density) -> Estimates + Sync + 'a;

/// What depends on the coordinates beside the bounds: the initial set and the domain.
pub type Frame<'a> = dyn Fn(&DMatrix<f64>, &FloatModel) -> FloatModel + Sync + 'a;

/// Ordinary sizes of |y| and |e|.
pub type Units<'a> = dyn Fn(&DMatrix<f64>) -> [f64; 2] + Sync + 'a;

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

/// A descent over S or S'; a relative change of sigma* by the tolerance is none.
const DESCENT: Descent = Descent { restarts: 0, iterations: 40, tolerance: 1e-3 };

/// How many descents there are, and how far apart in the list of candidates they start: what looks smallest at few samples need not
/// be so at many.
const DESCENTS: usize = 3;
const APART: usize = 3;

/// The share of the rate along the orbit that x keeps in a matrix inequality.
const KEPT: f64 = 1e-6;

/// The first steps of ln (rho - 1) and of ln eta.
const SHAPE_STEP: f64 = 0.4;

/// The shares of rho - 1 from which it is sought.
const SHARES: [f64; 3] = [1.0, 0.5, 0.2];

/// A descent over L and the shape together.
const TOGETHER: Descent = Descent { restarts: 1, iterations: 120, tolerance: 1e-3 };

/// A gain by a matrix inequality is at most this share of what is known, to be worth its proof.
const WORTH_A_MATRIX: f64 = 0.99;

/// A gain that is so many times that of norms is not sought further, before the shape is sought and after; one that existence sets
/// if it is so near.
const TOO_FAR: f64 = 3.0;
const FAR: f64 = 1.3;
const NEARLY: f64 = 0.98;

/// How far above a gain the arguments are taken.
const NEAR: f64 = 1e-9;

/// What a P of existence must take from sigma* to be worth its room in a certificate.
const WORTH: f64 = 1e-3;

/// Beyond so many states L is taken as it is proposed: the numbers in S are too many.
const MOST_STATES: usize = 4;

/// A search for coordinates.
pub struct CoordinateSearch<'a> {
    /// The model, but for what depends on L.
    pub base: &'a FloatModel,
    /// The bounds.
    pub sampler: &'a Sampler<'a>,
    /// The rest.
    pub frame: Box<Frame<'a>>,
    /// Ordinary sizes of |y| and |e| where L is a given matrix.
    pub units: Box<Units<'a>>,
    /// P_up/P_low of the P in the coordinates y.
    pub ratio: f64,
    /// The path of the matrix inequality by which stability is sought; by norms without.
    pub by_matrix: Option<Path>,
}

/// Coordinates, the model in them, and the smallest gain that was found.
pub struct Chosen {
    /// L.
    pub l: DMatrix<f64>,
    /// The P of existence, where it is another one.
    pub second: Option<DMatrix<f64>>,
    /// The model with finely sampled bounds.
    pub model: FloatModel,
    /// The free numbers.
    pub proposal: SharpProposal,
}

impl CoordinateSearch<'_> {
    /// The model for a given L.
    #[must_use]
    pub fn model(&self, shape: Shape<'_>, density: &Density) -> FloatModel {
        let Shape { l, second } = shape;
        let ratio = match density {
            _ if l.nrows() == 0 => ALONE,
            Density::Rough => ROUGH,
            Density::Coarse | Density::Focused(_) => COARSE,
            Density::Fine(_) => FINE,
        };
        let Estimates { bounds, threshold, .. } = (self.sampler)(shape, density);
        let at_origin = bounds(0.0, 0.0, Asked::ALL);
        let grid = Grid::new(bounds, (self.units)(l), ratio);
        let bounds = self.base.with_bounds(grid.functions(second.is_some()));
        let mut model = bounds.with_triple(self.ratio, at_origin[RATE]);
        if let Some(second) = second {
            let values = second.clone().symmetric_eigenvalues();
            model = model.with_existence_triple(values.max() / values.min(), at_origin[RATE_EXISTENCE]);
        }
        if let Some(path) = self.by_matrix {
            model.by_matrix = Some(ByMatrix::Sampled { path, threshold, rate: KEPT * at_origin[RATE] });
        }
        let model = (self.frame)(l, &model);
        if matches!(density, Density::Fine(_)) { model } else { model.rough() }
    }

    /// The best of some candidates, each improved by a local search: the smallest gain at many samples.
    ///
    /// # Errors
    /// The obstacle of the candidate that came closest.
    pub fn choose(&self, candidates: &[DMatrix<f64>]) -> Result<Chosen, Obstacle> {
        // The first one that has a gain leads to those of the others by local steps.
        let mut closest = Closest::default();
        let first = candidates.iter().find_map(|l| {
            let found = search_sharp(&self.model(alone(l), &Density::Rough));
            found.map_err(|obstacle| closest.record(obstacle)).ok()
        });
        let first = closest.or(first)?;
        let near = |l: &DMatrix<f64>| search_sharp_near(&self.model(alone(l), &Density::Coarse), &first);
        let found: Vec<Result<SharpProposal, Obstacle>> = candidates.par_iter().map(near).collect();
        let mut closest = Closest::default();
        let mut best: Option<(SharpProposal, usize)> = None;
        let mut starts = Vec::new();
        for (at, found) in found.into_iter().enumerate() {
            match found {
                Ok(found) => {
                    starts.push(at);
                    if best.as_ref().is_none_or(|(known, _)| found.sigma < known.sigma) {
                        best = Some((found, at));
                    }
                }
                Err(obstacle) => closest.record(obstacle),
            }
        }
        let (start, at) = closest.or(best)?;
        let l = &candidates[at];
        if !(2..=MOST_STATES).contains(&l.nrows()) {
            return self.with(alone(l), Some(&start));
        }
        starts.retain(|other| other.abs_diff(at).is_multiple_of(APART));
        starts.sort_by_key(|other| (other.abs_diff(at), *other));
        starts.truncate(DESCENTS);
        let descents = starts.par_iter().map(|from| {
            let improved = self.improved(&candidates[*from], &start);
            self.with(alone(&improved), Some(&start)).ok()
        });
        let descents: Vec<Option<Chosen>> = descents.collect();
        let smallest = descents.into_iter().flatten().min_by(|a, b| a.proposal.sigma.total_cmp(&b.proposal.sigma));
        let single = match smallest {
            Some(single) => single,
            None => self.with(alone(l), Some(&start))?,
        };
        Ok(self.with_second(single))
    }

    /// The best choice near a known one, of another search for the same plant: L and the shape of the error box are sought together,
    /// at the points that are the most extreme ones. The P of existence stays what it is in the coordinates x.
    ///
    /// # Errors
    /// The obstacle, where no gain is found, or none that is smaller by what is worth it.
    pub fn choose_near(&self, Chosen { l, second, proposal: known, .. }: &Chosen) -> Result<Chosen, Obstacle> {
        let n = l.nrows();
        let freedom = if (2..=MOST_STATES).contains(&n) { n * (n + 1) / 2 - 1 } else { 0 };
        let (mut l, mut second, mut start) = (l.clone(), second.clone(), *known);
        // First the shape alone.
        for freedom in [0, freedom, freedom] {
            let shape = Shape { l: &l, second: second.as_ref() };
            let density = self.focus(shape, &start).map_or(Density::Coarse, Density::Focused);
            let with = |p: &[f64]| {
                let parameters =
                    SharpParameters { rho: 1.0 + p[0].portable_exp(), eta: p[1].portable_exp(), ..start.parameters };
                let turn = if freedom == 0 { DMatrix::identity(n, n) } else { exponential(n, &p[2..]) };
                let l = &l * &turn;
                let second = second.as_ref().map(|second| &turn * second * &turn);
                let model = self.model(Shape { l: &l, second: second.as_ref() }, &density);
                let found = search_sharp_near(&model, &SharpProposal { parameters, ..start });
                found.ok().map(|found| (l, second, found))
            };
            let cost = |p: &[f64]| with(p).map(|(.., found)| found.sigma.portable_ln());
            // The box of the norms may be too large.
            let from = |share: f64| -> Vec<f64> {
                let shape = [((start.parameters.rho - 1.0) * share).portable_ln(), start.parameters.eta.portable_ln()];
                shape.into_iter().chain(std::iter::repeat_n(0.0, freedom)).collect()
            };
            let from = SHARES.map(from).into_iter().find_map(|from| Some((cost(&from)?, from)));
            let Some((_, from)) = from.filter(|(cost, _)| cost.portable_exp() < TOO_FAR * known.sigma) else {
                return Err(Failing::Gain { given: known.sigma, smallest: None }.into());
            };
            let steps: Vec<f64> = (0..freedom + 2).map(|i| if i < 2 { SHAPE_STEP } else { STEP }).collect();
            if let Some((best, _)) = minimise(cost, &from, &steps, TOGETHER)
                && let Some(found) = with(&best)
            {
                (l, second, start) = found;
            }
            let hopeless = start.binding == Binding::Existence && start.sigma > NEARLY * known.sigma;
            if hopeless || start.sigma > FAR * known.sigma {
                return Err(Failing::Gain { given: known.sigma, smallest: None }.into());
            }
        }
        if start.sigma > WORTH_A_MATRIX * known.sigma {
            return Err(Failing::Gain { given: known.sigma, smallest: None }.into());
        }
        let found = self.with(Shape { l: &l, second: second.as_ref() }, Some(&start))?;
        Ok(if second.is_some() { found } else { self.with_second(found) })
    }

    /// The points that matter near a proposal.
    fn focus(&self, shape: Shape<'_>, known: &SharpProposal) -> Result<Focus, Obstacle> {
        let model = self.model(shape, &Density::Coarse);
        let estimates = (self.sampler)(shape, &Density::Coarse);
        let (set, at) = at_sigma(&model, &known.parameters, known.sigma * (1.0 + NEAR), NEAR)?;
        let level = active_level(at.eta, at.dist_e, at.rho);
        let weights = FloatWeights {
            w_x: level / (model.p_low * at.d_x * at.d_x),
            k_p: 2.0 * weight_h(at.eta, at.dist_e, at.dist_z) / model.mu,
            rate: 0.0,
        };
        let error_box = [set.x_per + at.d_x, set.e_per + level.sqrt()];
        let inequality =
            self.by_matrix.map(|path| (ByMatrix::arguments(path, [set.x_per, set.e_per], error_box), weights));
        Ok((estimates.extreme)(&[[set.x_p, set.e_p], error_box], inequality))
    }

    /// The choice with a P of existence beside it, where that is worth it.
    fn with_second(&self, single: Chosen) -> Chosen {
        if !(2..=MOST_STATES).contains(&single.l.nrows()) {
            return single;
        }
        let worth = |sigma: f64| sigma < single.proposal.sigma * (1.0 - WORTH);
        let second = self.second(&single).filter(|(_, share)| *share < 1.0 - WORTH);
        let pair = second.and_then(|(second, _)| self.together(&single, second));
        pair.filter(|pair| worth(pair.proposal.sigma)).unwrap_or(single)
    }

    /// The proposal for given coordinates.
    ///
    /// # Errors
    /// The obstacle, where no gain is found.
    pub fn with(&self, shape: Shape<'_>, near: Option<&SharpProposal>) -> Result<Chosen, Obstacle> {
        let focus = near.and_then(|known| self.focus(shape, known).ok());
        let model = self.model(shape, &Density::Fine(focus.and_then(|focus| focus.corners)));
        let near = near.and_then(|known| search_sharp_near(&model, known).ok());
        let proposal = near.map_or_else(|| search_sharp(&model), Ok)?;
        Ok(Chosen { l: shape.l.clone(), second: shape.second.cloned(), model, proposal })
    }

    /// The best P of existence for the L of a choice, as the entries of its logarithm, and the gain with it as a share of the gain
    /// without: its rate is sampled at the X_p of the choice alone, and all else stays.
    fn second(&self, single: &Chosen) -> Option<(Vec<f64>, f64)> {
        let Chosen { l, proposal, .. } = single;
        let n = l.nrows();
        let model = &single.model.clone().rough();
        let asked = Asked::only(Bound::RateExistence);
        let freedom = n * (n + 1) / 2 - 1;
        let x_p = at_sigma(model, &proposal.parameters, proposal.sigma * (1.0 + NEAR), NEAR).ok()?.0.x_p;
        let cost = |s: &[f64]| {
            let second = exponential(n, s);
            let values = second.clone().symmetric_eigenvalues();
            let rate = (self.sampler)(Shape { l, second: Some(&second) }, &Density::Coarse);
            let rate = (rate.bounds)(x_p, 0.0, asked)[RATE_EXISTENCE];
            let model = model.with_existence_triple(values.max() / values.min(), rate).with_rate_of_existence(rate);
            search_sharp_near(&model, proposal).ok().map(|found| found.sigma.portable_ln())
        };
        let (best, found) = minimise(cost, &vec![0.0; freedom], &vec![STEP; freedom], DESCENT)?;
        let one = search_sharp_near(model, proposal).ok()?;
        Some((best, found.portable_exp() / one.sigma))
    }

    /// L and the P of existence, from a choice with one P and entries of the logarithm of the other; varied together for two
    /// states.
    fn together(&self, single: &Chosen, mut second: Vec<f64>) -> Option<Chosen> {
        let n = single.l.nrows();
        let mut l = single.l.clone();
        if n == 2 {
            let freedom = second.len();
            let cost = |s: &[f64]| {
                let second = exponential(n, &s[freedom..]);
                let shape = Shape { l: &(&single.l * exponential(n, &s[..freedom])), second: Some(&second) };
                let found = search_sharp_near(&self.model(shape, &Density::Coarse), &single.proposal);
                found.ok().map(|found| found.sigma.portable_ln())
            };
            let from: Vec<f64> = std::iter::repeat_n(0.0, freedom).chain(second.iter().copied()).collect();
            if let Some((best, _)) = minimise(cost, &from, &vec![STEP; 2 * freedom], DESCENT) {
                l = &l * exponential(n, &best[..freedom]);
                second = best[freedom..].to_vec();
            }
        }
        self.with(Shape { l: &l, second: Some(&exponential(n, &second)) }, Some(&single.proposal)).ok()
    }

    fn improved(&self, l: &DMatrix<f64>, start: &SharpProposal) -> DMatrix<f64> {
        let n = l.nrows();
        // The multiples of I change nothing.
        let freedom = (n * (n + 1) / 2).saturating_sub(1);
        if freedom == 0 {
            return l.clone();
        }
        let cost = |s: &[f64]| {
            let model = self.model(alone(&(l * exponential(n, s))), &Density::Coarse);
            search_sharp_near(&model, start).ok().map(|found| found.sigma.portable_ln())
        };
        let (zero, steps) = (vec![0.0; freedom], vec![STEP; freedom]);
        match minimise(cost, &zero, &steps, DESCENT) {
            Some((best, _)) => l * exponential(n, &best),
            None => l.clone(),
        }
    }
}

/// The same P for both.
fn alone(l: &DMatrix<f64>) -> Shape<'_> {
    Shape { l, second: None }
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
