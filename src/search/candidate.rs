//! Parts of a candidate that the derivations share, in floating point.

use super::model::FloatModel;
use super::scan;
use crate::derivation::existence::StateBounds;
use crate::derivation::stability::{DecayCondition, ErrorBox};

/// Strict inequalities that do not involve sigma are proposed with this much room, so that rounding to short rationals
/// cannot destroy them.
pub(super) const BELOW_ONE: f64 = 1.0 - 1e-6;

/// What stands in the way of a candidate; later ones come closer to a certificate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Obstacle {
    /// A number is beyond what the search can work with.
    Magnitude,
    /// A bounding function is not finite there.
    NotFinite,
    /// S1 or S2 fails (C1 or C3 in the repaired derivation).
    Existence,
    /// X_b leaves the domain.
    DomainX,
    /// E_b leaves the domain.
    DomainE,
    /// a_2 <= 0: the nonlinearity in the error box takes all of alpha.
    Curvature,
    /// (h/mu) k_x^2 >= 4 w_x a_2.
    Coupling,
    /// The gain is below the threshold of C5.
    Gain,
    /// C5h: the decay from sample to sample is not positive.
    Sampling,
    /// A proof was found, but the bounding functions are not proved up to its arguments.
    Bounds,
}

impl Obstacle {
    /// The condition that binds, for reports.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            Obstacle::Magnitude => {
                "a number of the specification, or a bounding function at X = E = 0, is beyond the range of double \
                 precision, in which the search works: use units in which the numbers are of ordinary size"
            }
            Obstacle::NotFinite => "the bounding functions are not finite at any arguments tried",
            Obstacle::Existence => "existence: no set was found that the map of the proof takes into itself",
            Obstacle::DomainX => "domain X: the error box around the initial set leaves it",
            Obstacle::DomainE => "domain E: the error box around the initial set leaves it",
            Obstacle::Curvature => "C5: a_2 <= 0, the nonlinearity over the error box takes all of the decay rate",
            Obstacle::Coupling => "C5: (h/mu) k_x^2 >= 4 w_x a_2",
            Obstacle::Gain => {
                "C5: the gain is below the threshold of the quadratic form for every error box that was tried"
            }
            Obstacle::Sampling => {
                "C5h: the decay from sample to sample is not positive for any error box that was tried, or h sigma would \
                 have to exceed 1"
            }
            Obstacle::Bounds => "the bounding functions are not proved up to the arguments of the proof that was found",
        }
    }
}

/// The error box of a candidate at one sigma.
#[derive(Clone, Copy, Debug)]
pub struct AtSigma {
    pub rho: f64,
    pub eta: f64,
    pub d_x: f64,
    pub dist_e: f64,
    pub dist_z: f64,
    /// What is made small: the right side of C5, or of the law at samples the radius of its forms, to be below 1.
    pub threshold: f64,
}

/// The larger one of the two shares of C1 and of a first entry of the contraction matrix below 1 (with room for rounding), to
/// be at most 1: k = c and `factor` 1 for the sharp derivation, K_alpha and 2 for the others.
pub fn demand(model: &FloatModel, state: &StateBounds<f64>, k: f64, factor: i64) -> f64 {
    let invariance = state.invariance_lhs(model, &k) / state.x_p;
    let contraction = state.contraction_xx(model, &k, factor) / BELOW_ONE;
    if invariance >= contraction || invariance.is_nan() { invariance } else { contraction }
}

/// The largest E with a demand of at most 1 at X.
pub fn largest_e(model: &FloatModel, x: f64, k: f64, factor: i64) -> Option<f64> {
    scan::largest(|e| demand(model, &StateBounds::new(model, x, e), k, factor), model.domain.1)
}

/// h with h dZ^2 = eta dE^2.
pub fn weight_h(eta: f64, dist_e: f64, dist_z: f64) -> f64 {
    eta * dist_e * dist_e / (dist_z * dist_z)
}

/// D_e^2 = w_x P_low D_x^2, at which both members of C4 are equal, for D_x = rho c dX and h dZ^2 = eta dE^2.
pub fn active_level(eta: f64, dist_e: f64, rho: f64) -> f64 {
    (1.0 + eta) * dist_e * dist_e / (1.0 - 1.0 / (rho * rho))
}

/// An error box with the level condition active: D_x = rho c dX, h from eta.
pub(super) struct Shape {
    pub(super) d_x: f64,
    pub(super) w_x: f64,
    /// h, or eta of the law at samples.
    pub(super) weight: f64,
    pub(super) error_box: ErrorBox<f64>,
}

impl Shape {
    /// The box, where it lies in the domain and the rate on it is positive.
    pub(super) fn new(
        model: &FloatModel,
        (x_per, e_per): (f64, f64),
        [dist_x, dist_e, dist_z]: [f64; 3],
        rho: f64,
        eta: f64,
    ) -> Result<Shape, Obstacle> {
        let d_x = rho * model.c * dist_x;
        let level = active_level(eta, dist_e, rho);
        let d_e = level.sqrt();
        if x_per + d_x > model.domain.0 * (1.0 - 1e-7) {
            return Err(Obstacle::DomainX);
        }
        if e_per + d_e > model.domain.1 * (1.0 - 1e-7) {
            return Err(Obstacle::DomainE);
        }
        let error_box = ErrorBox::new(model, &x_per, &e_per, &d_x, &d_e);
        let ErrorBox { rate, k_x, k_f, sector, .. } = &error_box;
        if ![rate, k_x, k_f, &sector.below, &sector.above].iter().all(|v| v.is_finite()) {
            return Err(Obstacle::NotFinite);
        }
        if *rate <= model.alpha * (1.0 - BELOW_ONE) {
            return Err(Obstacle::Curvature);
        }
        let w_x = level / (model.p_low * d_x * d_x);
        Ok(Shape { d_x, w_x, weight: weight_h(eta, dist_e, dist_z), error_box })
    }
}

/// D_x = rho c dX, h from eta, and the threshold of C5 with the level condition active.
pub fn error_box(
    model: &FloatModel,
    (x_per, e_per): (f64, f64),
    [dist_x, dist_e, dist_z]: [f64; 3],
    rho: f64,
    eta: f64,
) -> Result<AtSigma, Obstacle> {
    let Shape { d_x, w_x, weight, error_box } = Shape::new(model, (x_per, e_per), [dist_x, dist_e, dist_z], rho, eta)?;
    let decay = DecayCondition::new(model, &error_box, &w_x, &weight);
    let margin = decay.curvature - decay.coupling;
    if margin.is_nan() || margin <= (1.0 - BELOW_ONE) * 4.0 * w_x * model.alpha {
        return Err(Obstacle::Coupling);
    }
    if !decay.sigma_threshold.is_finite() {
        return Err(Obstacle::NotFinite);
    }
    Ok(AtSigma { rho, eta, d_x, dist_e, dist_z, threshold: decay.sigma_threshold })
}
