//! Which coordinates y, `x = x_0 + L y`, give the smallest gain: a search in floating point over L.
//!
//! With a constant P nothing is lost by P = I in the coordinates y (derivation, 11.5), so L stands for P. Rotations of y change
//! nothing: L varies as `L exp(S)` with symmetric S.

use super::grid::{Grid, Source};
use crate::number::Portable;
use crate::search::{Descent, FloatModel, Obstacle, SharpProposal, minimise, search_sharp, search_sharp_near};
use nalgebra::{DMatrix, SymmetricEigen};
use rayon::prelude::*;
use std::sync::Arc;

/// How densely suprema are sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Density {
    /// To find a gain at all.
    Rough,
    /// To compare coordinates.
    Coarse,
    /// For the coordinates that are taken.
    Fine,
}

/// Estimates of the bounds for given coordinates.
pub type Sampler<'a> = dyn Fn(&DMatrix<f64>, Density) -> Arc<Source> + Sync + 'a;

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

/// The first step of S.
const STEP: f64 = 0.15;

/// The descent over S; a relative change of sigma* by the tolerance is none.
const DESCENT: Descent = Descent { restarts: 1, iterations: 40, tolerance: 1e-4 };

/// That of three states and more, where a step costs more.
const SHORT: Descent = Descent { restarts: 0, iterations: 40, tolerance: 1e-3 };

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
}

/// Coordinates, the model in them, and the smallest gain that was found.
pub struct Chosen {
    /// L.
    pub l: DMatrix<f64>,
    /// The model with finely sampled bounds.
    pub model: FloatModel,
    /// The free numbers.
    pub proposal: SharpProposal,
}

impl CoordinateSearch<'_> {
    /// The model for a given L.
    #[must_use]
    pub fn model(&self, l: &DMatrix<f64>, density: Density) -> FloatModel {
        let ratio = match density {
            Density::Rough => ROUGH,
            Density::Coarse => COARSE,
            Density::Fine => FINE,
        };
        let source = (self.sampler)(l, density);
        let alpha = source(0.0, 0.0)[super::grid::RATE];
        let grid = Grid::new(source, (self.units)(l), ratio);
        (self.frame)(l, &self.base.with_bounds(grid.functions()).with_triple(self.ratio, alpha))
    }

    /// The best of the candidates, improved by a local search.
    ///
    /// # Errors
    /// The obstacle of the candidate that came closest.
    pub fn choose(&self, candidates: &[DMatrix<f64>]) -> Result<Chosen, Obstacle> {
        // The first one that has a gain leads to those of the others by local steps.
        let mut closest = Obstacle::NotFinite;
        let first = candidates.iter().find_map(|l| {
            let found = search_sharp(&self.model(l, Density::Rough));
            found.map_err(|obstacle| closest = closest.max(obstacle)).ok()
        });
        let first = first.ok_or(closest)?;
        let near = |l: &DMatrix<f64>| search_sharp_near(&self.model(l, Density::Coarse), &first);
        let found: Vec<Option<SharpProposal>> = candidates.par_iter().map(near).collect();
        let mut best: Option<(SharpProposal, &DMatrix<f64>)> = None;
        for (l, found) in candidates.iter().zip(found) {
            if let Some(found) = found
                && best.as_ref().is_none_or(|(known, _)| found.sigma < known.sigma)
            {
                best = Some((found, l));
            }
        }
        let (start, l) = best.ok_or(closest)?;
        let l = if l.nrows() <= MOST_STATES { self.improved(l, &start) } else { l.clone() };
        self.with(l, Some(&start))
    }

    /// The proposal for given coordinates.
    ///
    /// # Errors
    /// The obstacle, where no gain is found.
    pub fn with(&self, l: DMatrix<f64>, near: Option<&SharpProposal>) -> Result<Chosen, Obstacle> {
        let model = self.model(&l, Density::Fine);
        let near = near.and_then(|known| search_sharp_near(&model, known));
        let proposal = near.map_or_else(|| search_sharp(&model), Ok)?;
        Ok(Chosen { l, model, proposal })
    }

    fn improved(&self, l: &DMatrix<f64>, start: &SharpProposal) -> DMatrix<f64> {
        let n = l.nrows();
        // The multiples of I change nothing.
        let freedom = (n * (n + 1) / 2).saturating_sub(1);
        if freedom == 0 {
            return l.clone();
        }
        let cost = |s: &[f64]| {
            let model = self.model(&(l * exponential(n, s)), Density::Coarse);
            search_sharp_near(&model, start).map(|found| found.sigma.portable_ln())
        };
        let (zero, steps) = (vec![0.0; freedom], vec![STEP; freedom]);
        match minimise(cost, &zero, &steps, if n > 2 { SHORT } else { DESCENT }) {
            Some((best, _)) => l * exponential(n, &best),
            None => l.clone(),
        }
    }
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
