//! Stability by the matrix inequality (M) in floating point (derivation, 13.7), in the place of C5.

use super::candidate::{AtSigma, active_level, weight_h};
use super::model::FloatModel;
use super::obstacle::{Failing, Obstacle};
use rug::Rational;
use sigmastar_lang::spec::MatrixInequality;
use sigmastar_plants::bounds::FloatWeights;
use sigmastar_theory::derivation::paths::Paths;
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

/// A proved inequality ends where it ends: a search stays so far inside that rounding does not lead beyond.
const EDGE: f64 = 1.0 - 1e-6;

impl ByMatrix {
    /// Of the shape (rho, eta), or with the weights that are proved: the error box with the level condition active, and the
    /// threshold there.
    pub(super) fn error_box(
        &self,
        model: &FloatModel,
        (x_per, e_per): (f64, f64),
        [dist_x, dist_e, dist_z]: [f64; 3],
        shape: (f64, f64),
    ) -> Result<AtSigma, Obstacle> {
        let (rho, eta) = match self {
            ByMatrix::Sampled { .. } => shape,
            ByMatrix::Proved(inequality) => {
                // D_e^2 is the level, and w_x P_low D_x^2 = D_e^2.
                let (w_x, of_zeta) = (inequality.w_x.to_f64(), inequality.h.to_f64() * dist_z * dist_z);
                let own = w_x * model.p_up * dist_x * dist_x;
                let level = own + dist_e * dist_e + of_zeta;
                ((level / own).sqrt(), of_zeta / (dist_e * dist_e))
            }
        };
        let d_x = rho * model.c * dist_x;
        let level = active_level(eta, dist_e, rho);
        let at = [x_per + d_x, e_per + level.sqrt()];
        model.contains(at)?;
        let threshold = match self {
            ByMatrix::Sampled { threshold, rate } => {
                let (w_x, h) = (level / (model.p_low * d_x * d_x), weight_h(eta, dist_e, dist_z));
                threshold(at, FloatWeights { w_x, k_p: 2.0 * h / model.mu, rate: *rate })
            }
            ByMatrix::Proved(inequality) => {
                let within = |at: f64, end: &Rational| at <= end.to_f64() * EDGE;
                if !(within(at[0], &inequality.x) && within(at[1], &inequality.e)) {
                    return Err(Failing::Bounds.at(at[0], at[1]));
                }
                inequality.value.to_f64()
            }
        };
        if !threshold.is_finite() {
            return Err(Failing::Curvature.at(at[0], at[1]));
        }
        Ok(AtSigma { rho, eta, d_x, dist_e, dist_z, paths: Paths::STRAIGHT, threshold })
    }

    /// The weights w_x and h, where they are given.
    #[must_use]
    pub fn weights(&self) -> Option<[&Rational; 2]> {
        match self {
            ByMatrix::Sampled { .. } => None,
            ByMatrix::Proved(inequality) => Some([&inequality.w_x, &inequality.h]),
        }
    }
}
