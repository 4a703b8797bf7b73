//! Matrix inequalities of the regulator at samples that were proved from a plant's formulas (derivation, 13.7, (Ms), and (E) at
//! samples). Each is about one gain and one sampling period.

use super::sampling::SampledGain;
use rug::Rational;

/// What such an inequality is about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SampledLoop {
    /// sigma.
    pub sigma: Rational,
    /// T/h.
    pub samples: u32,
    /// K and Nb2.
    pub law: SampledGain,
}

/// `F_{h,s} - diag(2 w_x rate P, c_e, c_y, 0, 0)` of the derivation, 13.7 (Ms), with the P of stability times `w_x`, is positive
/// semidefinite for s = 0 and for s = h, for the derivatives (J, g, r, d) of f and q at every t and every point of `|x| <= X`, `|e| <= E`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SampledInequality {
    /// X >= 0.
    pub x: Rational,
    /// E >= 0.
    pub e: Rational,
    /// w_x > 0.
    pub w_x: Rational,
    /// eta > 0, the weight of zeta.
    pub eta: Rational,
    /// The weight of what moves within a sample, above 0.
    pub lambda: Rational,
    /// The rate that x keeps, above 0, in 1/time.
    pub rate: Rational,
    /// What e_k keeps, above 0.
    pub c_e: Rational,
    /// What y keeps, above 0.
    pub c_y: Rational,
    /// The gain and the law.
    pub at: SampledLoop,
}

/// `F0_{h,s} - c_x |x|^2 - c_e e(s)^2 - c_y y^2 + gamma q0^2` of the derivation, 13.7 (E) at samples, is nonnegative in
/// (x, e_k, y, G, w, q0) for s = 0 and for s = h, for the derivatives at every t and every point of `|x| <= X`, `|e| <= E`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SampledExistence {
    /// X >= 0.
    pub x: Rational,
    /// E >= 0.
    pub e: Rational,
    /// P by rows: symmetric, of any sign.
    pub matrix: Vec<Vec<Rational>>,
    /// k_p > 0.
    pub k_p: Rational,
    /// c_x > 0.
    pub c_x: Rational,
    /// c_e > 0.
    pub c_e: Rational,
    /// c_y > 0.
    pub c_y: Rational,
    /// gamma > 0.
    pub gamma: Rational,
    /// The weight of what moves within a sample, above 0.
    pub lambda: Rational,
    /// The gain and the law.
    pub at: SampledLoop,
}
