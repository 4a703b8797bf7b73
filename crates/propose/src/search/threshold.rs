//! Where the threshold of the matrix inequality (M) comes from in a search (derivation, 13.7).

use crate::bounds::{FloatWeights, MatrixArguments};
use rug::Rational;
use sigmastar_lang::spec::{JointStability, MatrixInequality};
use sigmastar_theory::derivation::paths::Path;
use std::sync::Arc;

/// The least sigma of (M) at given arguments for given weights; infinite where there is none.
pub type Threshold = dyn Fn(MatrixArguments, FloatWeights) -> f64 + Send + Sync;

/// A proved inequality ends where it ends: a search stays so far inside that rounding does not lead beyond.
pub(super) const EDGE: f64 = 1.0 - 1e-6;

/// Where the threshold of (M) comes from.
#[derive(Clone)]
pub enum ByMatrix {
    /// Samples, for any weights.
    Sampled {
        /// The path of f and of q.
        path: Path,
        /// The threshold.
        threshold: Arc<Threshold>,
        /// The rate that x keeps.
        rate: f64,
    },
    /// One inequality that is proved: the weights are its own.
    Proved(Arc<MatrixInequality>),
    /// A joint one that is proved: it has an error box of its own.
    Joint(Arc<JointStability>),
}

impl ByMatrix {
    /// Where the derivatives are taken on a path.
    #[must_use]
    pub fn arguments(path: Path, [x_per, e_per]: [f64; 2], [x_b, e_b]: [f64; 2]) -> MatrixArguments {
        MatrixArguments {
            apart: path != Path::Straight,
            states: [x_b, *path.e_of_dx(&e_per, &e_b)],
            error: [*path.x_of_de(&x_per, &x_b), e_b],
        }
    }

    /// The threshold; `None` where nothing is proved at these arguments.
    pub(super) fn threshold(&self, at: MatrixArguments, weights: FloatWeights) -> Option<f64> {
        let inequality = match self {
            ByMatrix::Sampled { threshold, .. } => return Some(threshold(at, weights)),
            ByMatrix::Proved(inequality) => inequality,
            // It stands in the place of the level condition, too.
            ByMatrix::Joint(_) => return None,
        };
        let within =
            |[x, e]: [f64; 2], [end_x, end_e]: [&Rational; 2]| x <= end_x.to_f64() * EDGE && e <= end_e.to_f64() * EDGE;
        let [of_states, of_error] = inequality.arguments();
        (within(at.states, of_states) && within(at.error, of_error)).then(|| inequality.value.to_f64())
    }

    /// The rate that x keeps.
    pub(super) fn rate(&self) -> f64 {
        match self {
            ByMatrix::Sampled { rate, .. } => *rate,
            ByMatrix::Proved(inequality) => inequality.rate.to_f64(),
            ByMatrix::Joint(_) => 0.0,
        }
    }

    /// The paths on which there may be a threshold.
    #[must_use]
    pub fn paths(&self) -> Vec<Path> {
        match self {
            ByMatrix::Sampled { path, .. } => vec![*path],
            ByMatrix::Proved(inequality) if inequality.splitting.is_some() => Path::CHOICE.to_vec(),
            ByMatrix::Proved(_) | ByMatrix::Joint(_) => vec![Path::Straight],
        }
    }

    /// The weights w_x and h, where they are given.
    #[must_use]
    pub fn weights(&self) -> Option<[&Rational; 2]> {
        match self {
            ByMatrix::Sampled { .. } | ByMatrix::Joint(_) => None,
            ByMatrix::Proved(inequality) => Some([&inequality.w_x, &inequality.h]),
        }
    }
}
