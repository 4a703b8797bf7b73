//! Parts of a candidate that the derivations share, in floating point.

#[cfg(doc)]
use super::goal::Goal;
use super::model::FloatModel;
use super::obstacle::{Closest, Failing, Obstacle};
use super::scan;
use sigmastar_theory::derivation::existence::StateBounds;
use sigmastar_theory::derivation::paths::Paths;
use sigmastar_theory::derivation::stability::{DecayCondition, ErrorBox};

/// Strict inequalities that do not involve sigma are proposed with this much room, so that rounding to short rationals
/// cannot destroy them.
pub(super) const BELOW_ONE: f64 = 1.0 - 1e-6;

/// The error box of a candidate at one sigma.
#[derive(Clone, Copy, Debug)]
pub struct AtSigma {
    /// D_x/(c dX), above 1.
    pub rho: f64,
    /// h dZ^2/dE^2.
    pub eta: f64,
    /// D_x.
    pub d_x: f64,
    /// dE.
    pub dist_e: f64,
    /// dZ, with an input gain times sqrt(b_hi): the weight in C4 is b_hi h.
    pub dist_z: f64,
    /// The paths of f and of q.
    pub paths: Paths,
    /// What of eta is stored in the last y, of the law at samples with a delay (derivation, 13.4).
    pub past: Option<PastShare>,
    /// The right side of C5, or of the law at samples the radius of its forms, to be below 1.
    pub threshold: f64,
    /// What is made small: the threshold, or what a [`Goal`] has in its place.
    pub cost: f64,
}

impl AtSigma {
    /// Of the shape (rho, eta) at the distances dX, dE, dZ, without a delay; its cost is the threshold.
    pub(super) fn new(
        (rho, eta): (f64, f64),
        d_x: f64,
        [_, dist_e, dist_z]: [f64; 3],
        paths: Paths,
        threshold: f64,
    ) -> AtSigma {
        AtSigma { rho, eta, d_x, dist_e, dist_z, paths, past: None, threshold, cost: threshold }
    }
}

/// The weight of the last y, gm h y^2 = share eta dE^2 at the distance.
#[derive(Clone, Copy, Debug)]
pub struct PastShare {
    /// The share of eta, between 0 and 1; the rest is that of zeta.
    pub share: f64,
    /// sqrt(h) (Y_0 + y_per).
    pub distance: f64,
}

impl PastShare {
    /// gm.
    #[must_use]
    pub fn weight(&self, eta: f64, dist_e: f64) -> f64 {
        weight_h(self.share * eta, dist_e, self.distance)
    }
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

/// The shape (rho, eta) of the error box with these w_x and h for which the level condition is active.
pub(super) fn shape_of_weights(
    model: &FloatModel,
    [w_x, h]: [f64; 2],
    [dist_x, dist_e, dist_z]: [f64; 3],
) -> (f64, f64) {
    // D_e^2 is the level, and w_x P_low D_x^2 = D_e^2.
    let of_zeta = h * dist_z * dist_z;
    let own = w_x * model.p_up * dist_x * dist_x;
    let level = own + dist_e * dist_e + of_zeta;
    ((level / own).sqrt(), of_zeta / (dist_e * dist_e))
}

/// An error box with the level condition active: D_x = rho c dX, h from eta.
#[derive(Clone)]
pub(super) struct Shape {
    pub(super) d_x: f64,
    pub(super) w_x: f64,
    /// h, or eta of the law at samples.
    pub(super) weight: f64,
    pub(super) paths: Paths,
    pub(super) error_box: ErrorBox<f64>,
}

impl Shape {
    /// That of a candidate, along its paths.
    pub(super) fn of(model: &FloatModel, (x_per, e_per): (f64, f64), at: &AtSigma) -> Shape {
        let AtSigma { rho, eta, d_x, dist_e, dist_z, paths, past, .. } = *at;
        let level = active_level(eta, dist_e, rho);
        let error_box = ErrorBox::new(model, paths, [&x_per, &e_per], [&d_x, &level.sqrt()]);
        let weight = weight_h(eta * past.map_or(1.0, |past| 1.0 - past.share), dist_e, dist_z);
        Shape { d_x, w_x: level / (model.p_low * d_x * d_x), weight, paths, error_box }
    }

    /// What `evaluate` makes of the box along the paths for which that is least; the box lies in the domain, and the rates on it
    /// are positive.
    pub(super) fn best(
        model: &FloatModel,
        (x_per, e_per): (f64, f64),
        [dist_x, dist_e, dist_z]: [f64; 3],
        (rho, eta): (f64, f64),
        evaluate: impl Fn(Shape) -> Result<AtSigma, Obstacle>,
    ) -> Result<AtSigma, Obstacle> {
        let d_x = rho * model.c * dist_x;
        let level = active_level(eta, dist_e, rho);
        let d_e = level.sqrt();
        let (x_b, e_b) = (x_per + d_x, e_per + d_e);
        model.contains([x_b, e_b])?;
        let (w_x, weight) = (level / (model.p_low * d_x * d_x), weight_h(eta, dist_e, dist_z));
        let on_paths = ErrorBox::on_paths(model, [&x_per, &e_per], [&d_x, &d_e]);
        let outcomes = on_paths.map(|(paths, error_box)| {
            let ErrorBox { rate, k_x, k_f, sector, .. } = &error_box;
            if ![rate, k_x, k_f, &sector.below, &sector.above].iter().all(|v| v.is_finite()) {
                Err(model.not_finite(x_b, e_b))
            } else if *rate <= model.alpha * (1.0 - BELOW_ONE) {
                Err(Failing::Curvature.at(x_b, e_b))
            } else {
                evaluate(Shape { d_x, w_x, weight, paths, error_box })
            }
        });
        Closest::least(outcomes, |at| at.threshold)
    }
}

/// D_x = rho c dX, h from eta, and the threshold of C5 at a sigma with the level condition active.
pub(super) fn error_box_by_norms(
    model: &FloatModel,
    periodic: (f64, f64),
    distances: [f64; 3],
    ((rho, eta), sigma): ((f64, f64), f64),
) -> Result<AtSigma, Obstacle> {
    Shape::best(model, periodic, distances, (rho, eta), |Shape { d_x, w_x, weight, paths, error_box }| {
        let decay = DecayCondition::new(model, &error_box, [&w_x, &weight], &sigma);
        let (x_b, e_b) = (error_box.x_b, error_box.e_b);
        let margin = decay.curvature - decay.coupling;
        if margin.is_nan() || margin <= (1.0 - BELOW_ONE) * 4.0 * w_x * model.alpha {
            return Err(Failing::Coupling.at(x_b, e_b));
        }
        if !decay.sigma_threshold.is_finite() {
            return Err(model.not_finite(x_b, e_b));
        }
        Ok(AtSigma::new((rho, eta), d_x, distances, paths, decay.sigma_threshold))
    })
}
