//! What a search for the law at samples knows of matrix inequalities over a plant's derivatives (derivation, 13.7, (Ms), and (E) at
//! samples).

use super::obstacle::Failing;
use rug::Rational;
use sigmastar_lang::spec::{SampledExistence, SampledInequalities, SampledInequality, SampledLoop};
use sigmastar_theory::derivation::energy::EnergyBounds;
use sigmastar_theory::derivation::harmonics::AtOrigin;
use sigmastar_theory::derivation::sampled::SampledEnergyNumbers;
use std::sync::Arc;

/// A proved inequality ends where it ends: a search stays so far inside that rounding does not lead beyond.
const EDGE: f64 = 1.0 - 1e-6;

/// The radius that stands for an inequality which is proved: below 1.
const PROVED: f64 = 0.5;

/// The radius of the inequality of stability on (X, E) for the weights w_x and eta at sigma.
pub type SampledRadiusAt = dyn Fn([f64; 2], [f64; 2], f64) -> f64 + Send + Sync;

/// The numbers of the inequality of existence on (X, E) at sigma.
pub type SampledEnergyAt = dyn Fn([f64; 2], f64) -> SampledEnergyNumbers<f64> + Send + Sync;

/// Where the inequalities come from; none of them where norms serve.
#[derive(Clone, Default)]
pub struct AtSamples {
    /// That of stability.
    pub stability: Option<BySampledMatrix>,
    /// That of existence.
    pub existence: Option<BySampledEnergy>,
}

/// Where the inequality of stability comes from.
#[derive(Clone)]
pub enum BySampledMatrix {
    /// Samples, for any weights.
    Sampled(Arc<SampledRadiusAt>),
    /// One that is proved, for its own weights and gain.
    Proved(Arc<SampledInequality>),
}

/// Where the inequality of existence comes from.
#[derive(Clone)]
pub enum BySampledEnergy {
    /// Samples, for given weights.
    Sampled(Arc<SampledEnergyAt>),
    /// One that is proved, for its own gain.
    Proved(Arc<SampledExistence>),
}

impl From<&SampledInequalities> for AtSamples {
    fn from(SampledInequalities { stability, existence }: &SampledInequalities) -> AtSamples {
        AtSamples {
            stability: stability.as_ref().map(|known| BySampledMatrix::Proved(Arc::new(known.clone()))),
            existence: existence.as_ref().map(|known| BySampledEnergy::Proved(Arc::new(known.clone()))),
        }
    }
}

impl AtSamples {
    /// The one gain of what is proved, where something is.
    #[must_use]
    pub fn gain(&self) -> Option<&Rational> {
        match (&self.stability, &self.existence) {
            (Some(BySampledMatrix::Proved(known)), _) => Some(&known.at.sigma),
            (_, Some(BySampledEnergy::Proved(known))) => Some(&known.at.sigma),
            _ => None,
        }
    }

    /// The weights w_x and eta, where they are given.
    #[must_use]
    pub fn weights(&self) -> Option<[&Rational; 2]> {
        match &self.stability {
            Some(BySampledMatrix::Proved(known)) => Some([&known.w_x, &known.eta]),
            _ => None,
        }
    }
}

/// Whether a gain is the one of an inequality.
fn is_about(known: &SampledLoop, sigma: f64) -> bool {
    known.sigma.to_f64().total_cmp(&sigma).is_eq()
}

fn is_within([x, e]: [f64; 2], [end_x, end_e]: [&Rational; 2]) -> bool {
    x <= end_x.to_f64() * EDGE && e <= end_e.to_f64() * EDGE
}

impl BySampledEnergy {
    /// The bounds on `|x| <= X_p`, `|e| <= E_p` at sigma; `None` where samples say nothing.
    ///
    /// # Errors
    /// That an inequality which a claim has to use is not proved there.
    pub(super) fn bounds(
        &self,
        at: [f64; 2],
        origin: &AtOrigin<f64>,
        sigma: f64,
    ) -> Result<Option<EnergyBounds<f64>>, Failing> {
        match self {
            BySampledEnergy::Sampled(numbers) => {
                let numbers = numbers(at, sigma);
                Ok((numbers.gamma.is_finite() && numbers.gamma > 0.0).then(|| numbers.bounds(origin)))
            }
            BySampledEnergy::Proved(known) => {
                let SampledExistence { x, e, c_x, c_e, c_y, gamma, at: about, .. } = known.as_ref();
                if !is_within(at, [x, e]) || !is_about(about, sigma) {
                    return Err(Failing::Bounds);
                }
                let [c_x, c_e, c_y, gamma] = [c_x, c_e, c_y, gamma].map(Rational::to_f64);
                Ok(Some(SampledEnergyNumbers { c_x, c_e, c_y, gamma }.bounds(origin)))
            }
        }
    }
}

impl BySampledMatrix {
    /// The radius on (X, E) for the weights w_x and eta at sigma.
    ///
    /// # Errors
    /// That an inequality which a claim has to use is not proved there.
    pub(super) fn radius(&self, at: [f64; 2], weights: [f64; 2], sigma: f64) -> Result<f64, Failing> {
        match self {
            BySampledMatrix::Sampled(radius) => Ok(radius(at, weights, sigma)),
            BySampledMatrix::Proved(known) if is_within(at, [&known.x, &known.e]) && is_about(&known.at, sigma) => {
                Ok(PROVED)
            }
            BySampledMatrix::Proved(_) => Err(Failing::Bounds),
        }
    }
}
