//! The specification in floating point, for searches only.

use super::effort::Effort;
use crate::data::{Bound, Data};
use crate::expr::FloatExpr;
use crate::number::Portable;
use crate::spec::model::InitialSet;
use crate::transfer::TradeOff;

/// A datum of the specification whose influence on sigma* is reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Datum {
    /// alpha (a larger value helps).
    Alpha,
    /// The ratio P_up/P_low, through P_up.
    PUp,
    /// One of the bounding functions.
    Bound(Bound),
}

impl Datum {
    /// Every datum that the sharp derivation uses.
    pub const ALL: [Datum; 11] = [
        Datum::Alpha,
        Datum::PUp,
        Datum::Bound(Bound::F),
        Datum::Bound(Bound::Fe),
        Datum::Bound(Bound::Fxx),
        Datum::Bound(Bound::Fex),
        Datum::Bound(Bound::Qe),
        Datum::Bound(Bound::Qx),
        Datum::Bound(Bound::QRms),
        Datum::Bound(Bound::QtRms),
        Datum::Bound(Bound::Q),
    ];

    /// Its name in a specification.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Datum::Alpha => "alpha",
            Datum::PUp => "p_up",
            Datum::Bound(Bound::F) => "f",
            Datum::Bound(Bound::Fe) => "f_e",
            Datum::Bound(Bound::Fxx) => "f_xx",
            Datum::Bound(Bound::Fex) => "f_ex",
            Datum::Bound(Bound::Q) => "q",
            Datum::Bound(Bound::Qe) => "q_e",
            Datum::Bound(Bound::Qx) => "q_x",
            Datum::Bound(Bound::Qt) => "q_t",
            Datum::Bound(Bound::QRms) => "q_rms (or q)",
            Datum::Bound(Bound::QtRms) => "q_t_rms (or q_t)",
        }
    }
}

/// The initial set in floating point.
#[derive(Clone, Copy, Debug)]
pub enum FloatSet {
    /// The paper's set.
    Paper,
    /// Controller at rest; the user's X_0, E_0 where given.
    AtRest(Option<f64>, Option<f64>),
    /// The user's box.
    Box(f64, f64, f64),
}

/// A bounding function, times a factor for sensitivities.
#[derive(Clone, Debug)]
struct ScaledBound {
    function: FloatExpr,
    factor: f64,
    /// A bound that serves where it is smaller.
    supremum: Option<Bound>,
}

/// All data in floating point.
#[derive(Clone, Debug)]
pub struct FloatModel {
    /// T.
    pub period: f64,
    /// P_low.
    pub p_low: f64,
    /// P_up.
    pub p_up: f64,
    /// alpha.
    pub alpha: f64,
    /// mu.
    pub mu: f64,
    /// w.
    pub base_frequency: f64,
    /// Nbar.
    pub n_bar: f64,
    /// The largest X and E allowed, infinite without a domain.
    pub domain: (f64, f64),
    /// The initial set.
    pub set: FloatSet,
    /// The admissible pairs (k0, k1).
    pub trade_off: TradeOff,
    bounds: Vec<ScaledBound>,
}

const ORDER: [Bound; 10] =
    [Bound::F, Bound::Fe, Bound::Fxx, Bound::Fex, Bound::Q, Bound::Qe, Bound::Qx, Bound::Qt, Bound::QRms, Bound::QtRms];

impl FloatModel {
    /// Converts the data; `trade_off` says which pairs (k0, k1) may be proposed.
    #[must_use]
    pub fn new(data: &Data<'_>, trade_off: TradeOff) -> FloatModel {
        let float = |constant: &crate::spec::model::Constant| constant.to_f64();
        let spec = data.spec;
        FloatModel {
            period: data.period.midpoint_f64(),
            p_low: data.p_low.midpoint_f64(),
            p_up: data.p_up.midpoint_f64(),
            alpha: data.alpha.midpoint_f64(),
            mu: data.mu.midpoint_f64(),
            base_frequency: data.base_frequency.midpoint_f64(),
            n_bar: data.n_bar.midpoint_f64(),
            domain: spec
                .domain
                .as_ref()
                .map_or((f64::INFINITY, f64::INFINITY), |domain| (float(&domain.x), float(&domain.e))),
            set: match &spec.initial_set {
                InitialSet::Paper => FloatSet::Paper,
                InitialSet::AtRest { x0, e0 } => FloatSet::AtRest(x0.as_ref().map(float), e0.as_ref().map(float)),
                InitialSet::Box { x0, e0, z0 } => FloatSet::Box(float(x0), float(e0), float(z0)),
            },
            trade_off,
            bounds: ORDER
                .iter()
                .map(|which| ScaledBound {
                    function: which.of(spec).to_float(),
                    factor: 1.0,
                    supremum: which.supremum(spec),
                })
                .collect(),
        }
    }

    /// How thoroughly this model is searched.
    #[must_use]
    pub fn effort(&self) -> Effort {
        Effort::new(self.bounds.iter().map(|bound| bound.function.operations()).sum())
    }

    /// Whether every number, and every bounding function at X = E = 0, is one that doubles can work with.
    #[must_use]
    pub fn is_in_range(&self) -> bool {
        let numbers = [self.period, self.p_low, self.p_up, self.alpha, self.mu, self.base_frequency, self.n_bar];
        let set = match self.set {
            FloatSet::Paper => [0.0; 3],
            FloatSet::AtRest(x0, e0) => [x0.unwrap_or(0.0), e0.unwrap_or(0.0), 0.0],
            FloatSet::Box(x0, e0, z0) => [x0, e0, z0],
        };
        numbers.iter().all(|value| value.is_normal())
            && set.iter().all(|value| value.is_finite())
            && self.bounds.iter().all(|bound| bound.function.eval(0.0, 0.0) != f64::INFINITY)
    }

    /// The same model with one datum improved by the relative amount `by` (alpha up, everything else down).
    #[must_use]
    pub fn improved(&self, datum: Datum, by: f64) -> FloatModel {
        let mut model = self.clone();
        match datum {
            Datum::Alpha => model.alpha *= 1.0 + by,
            Datum::PUp => model.p_up = (model.p_up * (1.0 - by)).max(model.p_low),
            Datum::Bound(which) => {
                for (bound, _) in model.bounds.iter_mut().zip(ORDER).filter(|(_, name)| *name == which) {
                    bound.factor *= 1.0 - by;
                }
            }
        }
        model
    }

    /// The same model with another initial set.
    #[must_use]
    pub fn with_set(&self, set: FloatSet) -> FloatModel {
        FloatModel { set, ..self.clone() }
    }

    /// c = sqrt(P_up/P_low).
    #[must_use]
    pub fn c(&self) -> f64 {
        (self.p_up / self.p_low).sqrt()
    }

    /// The value of a bounding function: the positive part of its expression, NaN where that is undefined.
    #[must_use]
    pub fn bound(&self, which: Bound, x: f64, e: f64) -> f64 {
        // ORDER lists the variants in the order of their declaration.
        let bound = &self.bounds[which as usize];
        let value = bound.factor * bound.function.eval(x, e);
        let value = if value < 0.0 { 0.0 } else { value };
        match bound.supremum.map(|supremum| self.bound(supremum, x, e)) {
            Some(supremum) if supremum < value => supremum,
            _ => value,
        }
    }

    /// X_0, E_0, Z_0 for given X_p, E_p, Z.
    #[must_use]
    pub fn required_set(&self, x_p: f64, e_p: f64, z: f64) -> (f64, f64, f64) {
        match self.set {
            FloatSet::Paper => (2.0 * x_p, 2.0 * e_p, 2.0 * (z + self.n_bar * e_p)),
            FloatSet::AtRest(x0, e0) => (x0.unwrap_or(2.0 * x_p), e0.unwrap_or(2.0 * e_p), 0.0),
            FloatSet::Box(x0, e0, z0) => (x0, e0, z0),
        }
    }

    /// beta_s(sigma).
    #[must_use]
    pub fn beta_s(&self, sigma: f64) -> f64 {
        (self.period / (2.0 * sigma) / (sigma * self.period / 2.0).portable_tanh()).sqrt()
    }

    /// tau(sigma).
    #[must_use]
    pub fn tau(&self, sigma: f64) -> f64 {
        let y = sigma * self.period;
        let ratio = if y < 0.1 {
            1.0 / 720.0 - y * y / 30_240.0 + y.powi(4) / 1_209_600.0
        } else {
            (1.0 / 12.0 - 1.0 / (2.0 * y * (y / 2.0).portable_tanh()) + 1.0 / (y * y)) / (y * y)
        };
        self.period * self.period * ratio.max(0.0).sqrt()
    }

    /// The smallest sigma with `gain(sigma) <= level`, for a decreasing gain; infinite when there is none.
    #[must_use]
    pub fn inverse(&self, gain: impl Fn(f64) -> f64, level: f64) -> f64 {
        if level.is_nan() || level <= 0.0 {
            return f64::INFINITY;
        }
        if level.is_infinite() {
            return 0.0;
        }
        // The logarithm of the gain against that of sigma T, over everything a double can hold: nearly straight at both
        // ends, so that the secant of a bracket (halving the value at an end that stays, Illinois) needs a dozen steps.
        let sigma = |exponent: f64| exponent.portable_exp() / self.period;
        let excess = |exponent: f64| (gain(sigma(exponent)) / level).portable_ln().clamp(-LARGEST, LARGEST);
        let mut low = (-640.0, excess(-640.0));
        let mut high = (640.0, excess(640.0));
        // NaN, from a gain of infinity over infinity, is no level reached.
        if high.1.is_nan() || high.1 > 0.0 {
            return f64::INFINITY;
        }
        if low.1 <= 0.0 {
            return 0.0;
        }
        let mut kept = 0_i32;
        let mut nudge = None;
        for _ in 0..STEPS {
            let secant = low.0 + (high.0 - low.0) * (low.1 / (low.1 - high.1));
            let middle = 0.5 * (low.0 + high.0);
            let inside = |at: &f64| *at > low.0 && *at < high.0;
            let Some(at) = [nudge.take().unwrap_or(secant), middle].into_iter().find(inside) else { break };
            let value = excess(at);
            if value <= 0.0 {
                high = (at, value);
                if value > -NEAR {
                    break;
                }
                low.1 *= if kept > 0 { 0.5 } else { 1.0 };
                kept = 1;
            } else {
                // So near that a little more is enough.
                nudge = (value < NEAR).then_some(at + 4.0 * NEAR);
                low = (at, value);
                high.1 *= if kept < 0 { 0.5 } else { 1.0 };
                kept = -1;
            }
        }
        sigma(high.0)
    }
}

/// Relative accuracy of [`FloatModel::inverse`], where rounding allows it: far below the first slack of a rounded witness.
const NEAR: f64 = 1e-14;
/// The logarithm of a ratio of gains is cut off here.
const LARGEST: f64 = 1e4;
/// Steps of [`FloatModel::inverse`] at most.
const STEPS: usize = 100;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gains_are_inverted() {
        let text = include_str!("../../specs/linear.json");
        let spec = crate::spec::Specification::from_json("linear", text).unwrap();
        let data = Data::new(&spec, 64);
        for period in [1e-40, 1e-30, 1e-3, 1.0, 70.0, 1e30] {
            let model = FloatModel { period, ..FloatModel::new(&data, TradeOff::closed_form(&data)) };
            for exponent in -120..=120 {
                let sigma = 10f64.portable_pow(f64::from(exponent) / 4.0) / period;
                let found = model.inverse(|s| model.beta_s(s), model.beta_s(sigma));
                assert!((found / sigma - 1.0).abs() < 1e-12, "beta_s: T = {period}, sigma = {sigma}: {found}");
                // For small sigma T tau hardly depends on sigma, and its closed form cancels.
                let found = model.inverse(|s| model.tau(s), model.tau(sigma));
                assert!(model.tau(found) <= model.tau(sigma) * (1.0 + 1e-8), "tau: {period} {sigma} {found}");
                assert!(exponent < 8 || (found / sigma - 1.0).abs() < 1e-11, "tau: {period} {sigma} {found}");
            }
            assert_eq!(model.inverse(|s| model.beta_s(s), f64::INFINITY), 0.0);
            assert_eq!(model.inverse(|s| model.beta_s(s), 0.0), f64::INFINITY);
            assert_eq!(model.inverse(|s| model.tau(s), period * period), 0.0);
        }
    }

    #[test]
    fn bounds_are_addressed_by_their_declaration_order() {
        for (index, which) in ORDER.into_iter().enumerate() {
            assert_eq!(which as usize, index);
        }
    }
}
