//! The free numbers of a claim about the regulator at samples.

use crate::data::Data;
use crate::derivation::control::{self, Reach};
use crate::derivation::initial_set::ClaimedSet;
use crate::derivation::mean_squares::MeanSquares;
use crate::derivation::paths::Paths;
use crate::derivation::stability::level_condition;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::{SampledGain, SampledLoop, Sampling};

/// The free numbers of a claim about the regulator at samples, exactly.
#[derive(Clone, Debug)]
pub struct SampledWitness {
    /// The gain.
    pub sigma: Rational,
    /// h, with T/h samples.
    pub sampling: Sampling,
    /// K and Nb2.
    pub law: SampledGain,
    /// X_p > 0.
    pub x_p: Rational,
    /// E_p > 0.
    pub e_p: Rational,
    /// r_x > 0.
    pub r_x: Rational,
    /// r_e > 0.
    pub r_e: Rational,
    /// r_d > 0.
    pub r_d: Rational,
    /// D_x > 0.
    pub d_x: Rational,
    /// D_e > 0.
    pub d_e: Rational,
    /// w_x > 0.
    pub w_x: Rational,
    /// eta > 0, the weight of zeta.
    pub eta: Rational,
    /// k0, in units of omega/w.
    pub k0: Rational,
    /// k1, in units of omega/w.
    pub k1: Rational,
    /// The initial set to be covered.
    pub set: ClaimedSet,
    /// Along which paths f and q are split on the error box.
    pub paths: Paths,
    /// What a delay adds: with one exactly where `sampling` says so.
    pub delay: Option<DelayWitness>,
}

/// What a delay adds to them (derivation, 13.4).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DelayWitness {
    /// gm > 0, the weight of h y_{k-1}^2.
    pub gm: Rational,
    /// Y_0: |e_0 - et_0| <= h Y_0 at the start.
    pub y_0: Rational,
}

impl SampledWitness {
    /// r_x, r_e, r_d.
    #[must_use]
    pub fn squares(&self) -> MeanSquares<&Rational> {
        MeanSquares { x: &self.r_x, e: &self.r_e, e_rate: &self.r_d }
    }

    /// How far |e| and the control are from those of the periodic solution, of every solution that begins at these distances from it in x, e and zeta: by the function
    /// of 12.3 that falls along their differences, of a law without a delay.
    ///
    /// Hypotheses: the conditions of stability are proved for this witness, and solutions that begin so stay in the error box. Guarantee: the bounds hold from that
    /// instant on, for oscillators whose Nbar is at most that of `data`.
    #[must_use]
    pub fn reach(&self, data: &Data<'_>, distances: [&Enclosure; 3]) -> Reach<Enclosure> {
        let number = |value: &Rational| data.rational(value);
        let [sigma, gain, w_x, eta, d_x, d_e] =
            [&self.sigma, &self.law.gain, &self.w_x, &self.eta, &self.d_x, &self.d_e].map(number);
        let (start, _) = level_condition(data, distances, [&d_x, &d_e, &w_x, &eta]);
        // At the gain b the weight of zeta is b eta, and the level no larger than at b_hi.
        let least = data.input_gain.as_ref().map_or_else(|| eta.clone(), |gain| &gain.low * &eta);
        control::reach(data, [&sigma, &gain], &least, (&start, None))
    }

    /// What a delay adds; zeros, with which nothing is proved, where there should be some and is none.
    pub(super) fn delay_numbers(&self) -> DelayWitness {
        self.delay.clone().unwrap_or_else(|| DelayWitness { gm: Rational::new(), y_0: Rational::new() })
    }

    /// The gain and the law, which a matrix inequality is about.
    #[must_use]
    pub fn about(&self) -> SampledLoop {
        let SampledWitness { sigma, sampling, law, .. } = self;
        SampledLoop { sigma: sigma.clone(), samples: sampling.samples, law: law.clone() }
    }
}
