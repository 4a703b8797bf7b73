//! One candidate of the sharp derivation in floating point.

use super::model::FloatModel;
use super::root::crossing;
use super::scan;
use crate::derivation::existence::{LeastSigma, PeriodicBounds, PeriodicSolution, StateBounds, kappas};
use crate::derivation::gains;
use crate::derivation::initial_set::distances;
use crate::derivation::stability::{DecayCondition, ErrorBox};
use crate::number::Portable;

/// The four numbers that remain when C4 is active in both members (derivation, section 5).
#[derive(Clone, Copy, Debug)]
pub struct SharpParameters {
    /// X_p.
    pub x_p: f64,
    /// E_p.
    pub e_p: f64,
    /// rho > 1 with D_x = rho c dX.
    pub rho: f64,
    /// eta > 0 with h dZ^2 = eta dE^2.
    pub eta: f64,
}

/// Strict inequalities that do not involve sigma are proposed with this much room, so that rounding to short rationals
/// cannot destroy them.
pub(super) const BELOW_ONE: f64 = 1.0 - 1e-6;

/// The share of the smallest rate in the data below which a gain is as good as none.
const NEGLIGIBLE: f64 = 1e-20;

/// What stands in the way of a candidate; later ones come closer to a certificate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Obstacle {
    /// A number is beyond what the search can work with.
    Magnitude,
    /// A bounding function is not finite there.
    NotFinite,
    /// C1 or C3 fails for every sigma.
    Existence,
    /// X_b leaves the domain.
    DomainX,
    /// E_b leaves the domain.
    DomainE,
    /// gam >= alpha: the nonlinearity in the error box takes all of alpha.
    Curvature,
    /// (h/mu) k_x^2 >= 4 w_x (alpha - gam).
    Coupling,
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
            Obstacle::Existence => "C1 or C3: no X_p, E_p tried admits a periodic solution by contraction",
            Obstacle::DomainX => "domain X: the error box around the initial set leaves it",
            Obstacle::DomainE => "domain E: the error box around the initial set leaves it",
            Obstacle::Curvature => "C5: gam >= alpha, the nonlinearity over the error box takes all of the decay rate",
            Obstacle::Coupling => "C5: (h/mu) k_x^2 >= 4 w_x (alpha - gam)",
            Obstacle::Bounds => "the bounding functions are not proved up to the arguments of the proof that was found",
        }
    }
}

/// The part of a candidate that does not depend on sigma, rho and eta.
#[derive(Clone, Debug)]
pub struct Existence {
    bounds: PeriodicBounds<f64>,
    least: LeastSigma<f64>,
    /// Z.
    pub z: f64,
    /// k0, k1 and K.
    pub pair: (f64, f64, u32),
    /// The smallest sigma with C2 and C3.
    pub sigma_least: f64,
}

/// The error box of a candidate at one sigma.
#[derive(Clone, Copy, Debug)]
pub struct AtSigma {
    pub rho: f64,
    pub eta: f64,
    pub d_x: f64,
    pub dist_e: f64,
    pub dist_z: f64,
    /// The right side of C5.
    pub threshold: f64,
}

/// The smallest distance of the initial set from the periodic solution, as a share of the latter's size.
const FLOOR: f64 = 1e-6;

impl Existence {
    /// C1-C3 and Z at (X_p, E_p).
    pub fn new(model: &FloatModel, x_p: f64, e_p: f64) -> Result<Existence, Obstacle> {
        if x_p > model.domain.0 {
            return Err(Obstacle::DomainX);
        }
        if e_p > model.domain.1 {
            return Err(Obstacle::DomainE);
        }
        let bounds = PeriodicBounds::new(model, x_p, e_p);
        let PeriodicBounds { state, q_e, q_x, q_rms, q_rate_rms } = &bounds;
        if ![&state.f_xx, &state.f_e, &state.f_ex, q_e, q_x, q_rms, q_rate_rms].iter().all(|v| v.is_finite()) {
            return Err(Obstacle::NotFinite);
        }
        let admitted = demand(model, state, model.c, 1) <= 1.0 && state.quadratic_share(model, &model.c) < 1.0;
        if !admitted {
            return Err(Obstacle::Existence);
        }
        // What a unit of k0 and of k1 adds to Z^2.
        let (size, rate) = kappas(model, &(q_rms * q_rms), &(q_rate_rms * q_rate_rms));
        let pair = model.trade_off.best(size, rate);
        let (kappa_0, kappa_1) = kappas(model, &pair.0, &pair.1);
        let z = bounds.z_squared_sharp(model, &kappa_0, &kappa_1).sqrt();
        let least = LeastSigma::sharp(model, &bounds);
        let sigma_least = least.by_size.max(least.by_contraction * (1.0 + 1e-9));
        if !sigma_least.is_finite() || !z.is_finite() {
            return Err(Obstacle::Existence);
        }
        Ok(Existence { bounds, least, z, pair, sigma_least })
    }

    /// E_p.
    pub fn e_p(&self) -> f64 {
        self.bounds.state.e_p
    }

    /// Whether C2, rather than C3, sets the least sigma.
    pub fn bound_by_size(&self) -> bool {
        self.least.by_size >= self.least.by_contraction
    }

    /// Weights p_x, p_e for C3.
    pub fn perron(&self, model: &FloatModel, sigma: f64) -> [f64; 2] {
        let matrix = self.bounds.contraction(model, &model.c, 1, &gains::beta_s(&sigma, &model.period));
        matrix.perron_weights(&self.bounds.state.x_p.recip(), &self.bounds.state.e_p.recip())
    }

    /// The error box and the threshold of C5 at sigma.
    pub fn at_sigma(&self, model: &FloatModel, rho: f64, eta: f64, sigma: f64) -> Result<AtSigma, Obstacle> {
        let PeriodicSolution { x_per, e_per, .. } = PeriodicSolution::new(model, &self.bounds, &sigma);
        let [x0, e0, z0] = model.required_set(self.bounds.state.x_p, self.bounds.state.e_p, self.z);
        let [dist_x, dist_e, dist_z] = distances(model, [&x0, &e0, &z0], [&x_per, &e_per, &self.z]);
        // Floors keep the box open where a distance is 0; a larger distance only strengthens C4.
        let dist_x = dist_x.max(FLOOR * self.bounds.state.x_p);
        let dist_e = dist_e.max(FLOOR * self.bounds.state.e_p);
        let dist_z = dist_z.max(FLOOR * model.n_bar * dist_e);
        error_box(model, (x_per, e_per), [dist_x, dist_e, dist_z], rho, eta)
    }

    /// No sigma below this one is sought with this eta, whatever rho: less than C2 and C3 need, and than the first term
    /// 1/(4 ht) of C5 with the largest h; nor any that is negligible beside every rate in the data, since where nothing in
    /// them needs a gain the infimum is 0.
    pub fn least(&self, model: &FloatModel, eta: f64) -> f64 {
        let (x_p, e_p) = (self.bounds.state.x_p, self.bounds.state.e_p);
        let [_, e0, z0] = model.required_set(x_p, e_p, self.z);
        // The largest dE and the smallest dZ of `at_sigma`.
        let dist_e = (e0 + e_p).max(FLOOR * e_p);
        let dist_z = (z0 + model.n_bar * e0 + self.z).max(FLOOR * model.n_bar * e0.max(FLOOR * e_p));
        let h_over_mu = weight_h(eta, dist_e, dist_z) / model.mu;
        let rates = [model.period.recip(), model.alpha, model.mu, model.base_frequency];
        let negligible = NEGLIGIBLE * rates.into_iter().fold(f64::INFINITY, f64::min);
        // Half of it leaves room for rounding, and a bracket for the bisection.
        self.sigma_least.max(negligible).max(0.5 / (4.0 * h_over_mu)).min(1e290)
    }

    /// The smallest sigma for given rho and eta, to the relative tolerance.
    pub fn sigma(&self, model: &FloatModel, rho: f64, eta: f64, tolerance: f64) -> Result<f64, Obstacle> {
        let needed = |sigma: f64| self.at_sigma(model, rho, eta, sigma).map(|at| at.threshold.max(self.sigma_least));
        let excess = |sigma: f64| needed(sigma).map(|needed| (needed / sigma).portable_ln());
        let least = self.least(model, eta);
        let mut low = (least, excess(least));
        if matches!(low.1, Ok(value) if value <= 0.0) {
            return Ok(least);
        }
        let high = loop {
            // The threshold hardly depends on sigma: where that is near, what it asks for here is enough.
            let asked = low.1.map_or(0.0, |value| low.0 * value.portable_exp() * (1.0 + 1e-9));
            let leap = if low.0 > 1e12 * least { 4e6 } else { 4.0 };
            let next = if asked > low.0 && asked < low.0 * leap { asked } else { low.0 * leap };
            let found = (next, excess(next));
            match found.1 {
                Ok(value) if value <= 0.0 => break (next, value),
                // The obstacle at the largest sigma is the one that counts: e_per, x_per are smallest there.
                Err(obstacle) if next > 1e200 => return Err(obstacle),
                Ok(_) if next > 1e280 => return Err(Obstacle::Coupling),
                _ => low = found,
            }
        };
        let at = |exponent: f64| least * exponent.portable_exp();
        let exponent = |sigma: f64| (sigma / least).portable_ln();
        let ends = [(exponent(low.0), low.1.unwrap_or(f64::INFINITY)), (exponent(high.0), high.1)];
        let found = at(crossing(|t| excess(at(t)).unwrap_or(f64::INFINITY), ends[0], ends[1], tolerance));
        Ok(found.min(high.0))
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

/// D_x = rho c dX, h from eta, and the threshold of C5 with the level condition active.
pub fn error_box(
    model: &FloatModel,
    (x_per, e_per): (f64, f64),
    [dist_x, dist_e, dist_z]: [f64; 3],
    rho: f64,
    eta: f64,
) -> Result<AtSigma, Obstacle> {
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
    let ErrorBox { gamma, k_x, k_e, k_f, .. } = &error_box;
    if ![gamma, k_x, k_e, k_f].iter().all(|v| v.is_finite()) {
        return Err(Obstacle::NotFinite);
    }
    if *gamma >= model.alpha * BELOW_ONE {
        return Err(Obstacle::Curvature);
    }
    let w_x = level / (model.p_low * d_x * d_x);
    let decay = DecayCondition::new(model, &error_box, &w_x, &weight_h(eta, dist_e, dist_z));
    let margin = decay.curvature - decay.coupling;
    if margin.is_nan() || margin <= (1.0 - BELOW_ONE) * 4.0 * w_x * model.alpha {
        return Err(Obstacle::Coupling);
    }
    if !decay.sigma_threshold.is_finite() {
        return Err(Obstacle::NotFinite);
    }
    Ok(AtSigma { rho, eta, d_x, dist_e, dist_z, threshold: decay.sigma_threshold })
}
