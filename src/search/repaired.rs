//! The search of the repaired derivation: X, E, L, h that make sigma* small.

use super::candidate::{BELOW_ONE, Obstacle, SharpParameters};
use super::minimise::minimise;
use super::model::FloatModel;
use super::scan;
use super::sharp::{depth_of, parameter_of};
use crate::data::Bound;
use crate::number::Portable;

/// The free numbers of the repaired derivation in floating point.
#[derive(Clone, Copy, Debug)]
pub struct RepairedProposal {
    /// X.
    pub x: f64,
    /// E.
    pub e: f64,
    /// h.
    pub h: f64,
    /// The smallest sigma found.
    pub sigma: f64,
    /// rho and eta with which the same level, D_x and h are those of a sharp candidate with w_x = 1.
    shape: (f64, f64),
}

impl RepairedProposal {
    /// The same free numbers as a candidate of the sharp derivation.
    #[must_use]
    pub fn as_sharp(&self) -> SharpParameters {
        SharpParameters { x_p: self.x, e_p: self.e, rho: self.shape.0, eta: self.shape.1 }
    }
}

/// K_alpha.
fn k_alpha(model: &FloatModel) -> f64 {
    let c = model.c();
    c * (1.0 + (c - 1.0) * (-model.alpha * model.period).portable_exp())
}

/// All quantities for given X, E and eta with h dZ^2 = eta dE^2.
fn evaluate(model: &FloatModel, x: f64, e: f64, eta: f64) -> Result<RepairedProposal, Obstacle> {
    let at = |which| model.bound(which, x, e);
    let gain = k_alpha(model) / model.alpha;
    let f_xx = model.bound(Bound::Fxx, x, 0.0);
    let (f, f_e, f_ex) = (at(Bound::F), at(Bound::Fe), at(Bound::Fex));
    let (q, q_e, q_x, q_t) = (at(Bound::Q), at(Bound::Qe), at(Bound::Qx), at(Bound::Qt));
    let (a, b) = (gain * (f_ex * e + 2.0 * f_xx * x), gain * f_e);
    if gain * (f_e * e + f_xx * x * x / 2.0) > x || a >= BELOW_ONE {
        return Err(Obstacle::Existence);
    }
    let w2 = model.base_frequency * model.base_frequency;
    let pair = model.trade_off.best(1.0, 1.0);
    let (kappa_0, kappa_1) = (pair.0 / w2, pair.1 / (w2 * w2));
    let z = ((model.period / model.mu + kappa_0 + 54.0 * kappa_1 * q_e * q_e) * q * q
        + 3.0 * kappa_1 * (q_t * q_t + q_x * q_x * f * f))
        .sqrt();
    let contraction = q_e * (1.0 - a) + b * q_x;
    let beta = |s: f64| 2.0 * model.beta_s(s);
    let by_contraction = if contraction > 0.0 { model.inverse(beta, (1.0 - a) / contraction) } else { 0.0 };
    let sigma_p = model.inverse(|s| beta(s) * q, e).max(by_contraction * (1.0 + 1e-9));

    let (x0, e0, z0) = model.required_set(x, e, z);
    let (dist_x, dist_e) = (x0 + x, e0 + e);
    let dist_z = (z0 + model.n_bar * e0 + z).max(1e-6 * model.n_bar * dist_e);
    let h = eta * dist_e * dist_e / (dist_z * dist_z);
    let level = model.p_up * dist_x * dist_x + (1.0 + eta) * dist_e * dist_e;
    let (x_b, e_b) = (x + (level / model.p_low).sqrt(), e + level.sqrt());
    if x_b > model.domain.0 * (1.0 - 1e-7) {
        return Err(Obstacle::DomainX);
    }
    if e_b > model.domain.1 * (1.0 - 1e-7) {
        return Err(Obstacle::DomainE);
    }
    let rho_0 =
        model.p_up * (model.bound(Bound::Fxx, x, e) * x + f_ex * e + model.bound(Bound::Fxx, x_b, e) * (x_b + x) / 2.0);
    let (q_x_b, q_e_b) = (model.bound(Bound::Qx, x_b, e_b), model.bound(Bound::Qe, x_b, e_b));
    let curvature = model.alpha * model.p_low - rho_0 - h / model.mu * q_x_b * q_x_b;
    if curvature.is_nan() || curvature <= (1.0 - BELOW_ONE) * model.alpha * model.p_low {
        return Err(Obstacle::Curvature);
    }
    let rho_12 = model.p_up * model.bound(Bound::Fe, x_b, e_b) + q_x_b;
    let rho_22 = q_e_b + h / model.mu * q_e_b * q_e_b;
    let sigma = sigma_p.max(rho_22 + model.mu / (2.0 * h) + rho_12 * rho_12 / (4.0 * curvature));
    if !sigma.is_finite() {
        return Err(Obstacle::NotFinite);
    }
    // D_x = sqrt(L/P_low) = rho c dX.
    let rho = (level / model.p_up).sqrt() / dist_x;
    Ok(RepairedProposal { x, e, h, sigma, shape: (rho, eta) })
}

/// The largest E with C1 and the first diagonal entry of the contraction matrix below 1.
#[must_use]
pub fn largest_e_repaired(model: &FloatModel, x: f64) -> Option<f64> {
    let gain = k_alpha(model) / model.alpha;
    let f_xx = model.bound(Bound::Fxx, x, 0.0);
    let admissible = |e: f64| {
        gain * (model.bound(Bound::Fe, x, e) * e + f_xx * x * x / 2.0) <= x
            && gain * (model.bound(Bound::Fex, x, e) * e + 2.0 * f_xx * x) < BELOW_ONE
    };
    scan::largest(admissible, model.domain.1)
}

/// Weights p_x, p_e for C3 at sigma: the solution of (I - Y') p = (1/X, 1/E), positive where Y is a contraction.
#[must_use]
pub fn perron_repaired(model: &FloatModel, x: f64, e: f64, sigma: f64) -> (f64, f64) {
    let at = |which| model.bound(which, x, e);
    let gain = k_alpha(model) / model.alpha;
    let beta = 2.0 * model.beta_s(sigma);
    let a = gain * (at(Bound::Fex) * e + 2.0 * model.bound(Bound::Fxx, x, 0.0) * x);
    let (b, c, d) = (gain * at(Bound::Fe), beta * at(Bound::Qx), beta * at(Bound::Qe));
    let det = (1.0 - a) * (1.0 - d) - b * c;
    let (u, v) = (1.0 / x, 1.0 / e);
    (((1.0 - d) * u + c * v) / det, (b * u + (1.0 - a) * v) / det)
}

/// Searches for the smallest sigma of the repaired derivation.
///
/// # Errors
/// The obstacle of the candidate that came closest, when none is feasible.
pub fn search_repaired(model: &FloatModel) -> Result<RepairedProposal, Obstacle> {
    const ETAS: [f64; 5] = [1e-6, 1e-3, 0.1, 1.0, 30.0];
    if !model.is_in_range() {
        return Err(Obstacle::Magnitude);
    }
    let effort = model.effort();
    let xs = scan::x_values(model.domain.0, effort.x_step);
    let columns = scan::evaluate_all(&xs, |&x| {
        let mut closest = Obstacle::Existence;
        let mut best: Option<(RepairedProposal, f64)> = None;
        let e_max = largest_e_repaired(model, x).ok_or(closest)?;
        for depth in scan::e_depths(effort.e_step) {
            for eta in ETAS {
                match evaluate(model, x, e_max * (-depth).portable_exp(), eta) {
                    Ok(found) if best.is_none_or(|(least, _)| found.sigma < least.sigma) => best = Some((found, eta)),
                    Ok(_) => {}
                    Err(obstacle) => closest = closest.max(obstacle),
                }
            }
        }
        best.ok_or(closest)
    });
    let mut closest = Obstacle::NotFinite;
    let mut found = Vec::new();
    for column in columns {
        match column {
            Ok(candidate) => found.push(candidate),
            Err(obstacle) => closest = closest.max(obstacle),
        }
    }
    found.sort_by(|a, b| a.0.sigma.total_cmp(&b.0.sigma));
    found.truncate(4);
    let refined = scan::evaluate_all(&found, |(start, eta)| {
        let decode = |p: &[f64]| {
            let x = scan::in_range(p[0].portable_exp())?;
            let e = largest_e_repaired(model, x)? * (-depth_of(p[1])).portable_exp();
            evaluate(model, x, e, p[2].portable_exp()).ok()
        };
        let depth = (largest_e_repaired(model, start.x)? / start.e).portable_ln().max(1e-9);
        let first = [start.x.portable_ln(), parameter_of(depth), eta.portable_ln()];
        let (best, _) = minimise(
            |p| decode(p).map(|f| f.sigma.portable_ln() + scan::preference(f.x) + scan::preference(f.e)),
            &first,
            &[0.3, 0.5, 0.5],
            effort.restarts(6),
            effort.iterations,
        )?;
        decode(&best)
    });
    refined.into_iter().flatten().min_by(|a, b| a.sigma.total_cmp(&b.sigma)).ok_or(closest)
}
