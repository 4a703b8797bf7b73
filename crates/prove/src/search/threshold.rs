//! Where the threshold of the matrix inequality (M) comes from in a search (derivation, 13.7).

use rug::Rational;
use sigmastar_lang::spec::MatrixInequality;
use sigmastar_plants::bounds::FloatWeights;
use std::fmt;
use std::sync::Arc;

/// The least sigma of (M) at (X_b, E_b) for given weights; infinite where there is none.
pub type Threshold = dyn Fn([f64; 2], FloatWeights) -> f64 + Send + Sync;

/// Where the threshold of (M) comes from.
#[derive(Clone)]
pub enum ByMatrix {
    /// Samples, for any weights.
    Sampled {
        /// The threshold.
        threshold: Arc<Threshold>,
        /// The rate that x keeps.
        rate: f64,
    },
    /// One inequality that is proved: the weights are its own.
    Proved(Arc<MatrixInequality>),
}

impl fmt::Debug for ByMatrix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            ByMatrix::Sampled { .. } => "a sampled matrix inequality",
            ByMatrix::Proved(_) => "a proved matrix inequality",
        })
    }
}

impl ByMatrix {
    /// The weights w_x and h, where they are given.
    #[must_use]
    pub fn weights(&self) -> Option<[&Rational; 2]> {
        match self {
            ByMatrix::Sampled { .. } => None,
            ByMatrix::Proved(inequality) => Some([&inequality.w_x, &inequality.h]),
        }
    }
}
