//! What a search knows of a matrix inequality of existence (derivation, 13.7, (E)).

use super::obstacle::Failing;
use crate::bounds::EnergyWeights;
use rug::Rational;
use sigmastar_lang::spec::{ExistenceInequality, JointInequality};
use sigmastar_theory::derivation::energy::{EnergyBounds, EnergyNumbers, MetricNumbers};
use sigmastar_theory::derivation::harmonics::AtOrigin;
use std::sync::Arc;

/// A proved inequality ends where it ends: a search stays so far inside that rounding does not lead beyond.
const EDGE: f64 = 1.0 - 1e-6;

/// c_y as a function of (X, E) and the threshold.
pub type EnergyMargin = dyn Fn([f64; 2], f64) -> f64 + Send + Sync;

/// The share of a gain that is the threshold of the inequality at it.
pub const SHARE: f64 = 0.995;

/// Where the bounds of a matrix inequality come from.
#[derive(Clone)]
pub enum ByEnergy {
    /// Samples, for given weights.
    Sampled {
        /// The weights; the threshold is [`SHARE`] of each sigma that is looked at, whatever they say.
        weights: Arc<EnergyWeights>,
        /// c_y as a function of (X, E) and the threshold.
        margin: Arc<EnergyMargin>,
    },
    /// One that is proved.
    Proved(Arc<ExistenceInequality>),
    /// A joint one, which is proved or to be proved.
    Joint(Arc<JointInequality>),
}

impl ByEnergy {
    /// The bounds on `|x| <= X_p`, `|e| <= E_p`.
    ///
    /// # Errors
    /// That the inequality is not proved there, does not hold there, or needs a larger sigma.
    pub fn bounds(
        &self,
        [x_p, e_p]: [f64; 2],
        origin: &AtOrigin<f64>,
        sigma: f64,
    ) -> Result<EnergyBounds<f64>, Failing> {
        let within = |x: &Rational, e: &Rational| x_p <= x.to_f64() * EDGE && e_p <= e.to_f64() * EDGE;
        let numbers = match self {
            ByEnergy::Joint(joint) => {
                if !within(&joint.x, &joint.e) {
                    return Err(Failing::Bounds);
                }
                if sigma < joint.value.to_f64() {
                    return Err(Failing::Existence);
                }
                let [near, far] = joint.metrics().map(|metric| MetricNumbers::of(metric, Rational::to_f64));
                return Ok(EnergyBounds::of_metrics([&near, &far], origin));
            }
            ByEnergy::Sampled { weights, margin } => {
                let EnergyWeights { k_p, c_x, .. } = **weights;
                let value = SHARE * sigma;
                EnergyNumbers { k_p, c_x, c_y: margin([x_p, e_p], value), value }
            }
            ByEnergy::Proved(known) => {
                let ExistenceInequality { x, e, k_p, c_x, c_y, value, .. } = known.as_ref();
                if !within(x, e) {
                    return Err(Failing::Bounds);
                }
                let [k_p, c_x, c_y, value] = [k_p, c_x, c_y, value].map(Rational::to_f64);
                EnergyNumbers { k_p, c_x, c_y, value }
            }
        };
        if numbers.c_y > 0.0 && numbers.value < sigma * EDGE {
            Ok(EnergyBounds::new(&numbers, origin, &sigma))
        } else {
            Err(Failing::Existence)
        }
    }
}
