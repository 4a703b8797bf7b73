//! The search for exact regulation: the error box around the origin.

use super::candidate::{AtSigma, Obstacle, error_box};
use super::minimise::minimise;
use super::model::FloatModel;
use crate::number::Portable;

/// The error box of exact regulation in floating point, with its sigma as `threshold`.
///
/// `distances` are dX = X_0, dE = E_0, dZ = Z_0 + Nbar E_0 + z_oo.
///
/// # Errors
/// The obstacle of the candidate that came closest, when none is feasible.
pub fn search_exact(model: &FloatModel, distances: [f64; 3]) -> Result<AtSigma, Obstacle> {
    let evaluate = |rho: f64, eta: f64| error_box(model, (0.0, 0.0), distances, rho, eta);
    let mut closest = Obstacle::NotFinite;
    let mut best: Option<AtSigma> = None;
    for rho_exponent in -10..=4 {
        for eta_exponent in -24..=12 {
            let (rho, eta) = (1.0 + 2f64.powi(rho_exponent), 10f64.portable_pow(f64::from(eta_exponent) / 2.0));
            match evaluate(rho, eta) {
                Ok(at) if best.is_none_or(|b| at.threshold < b.threshold) => best = Some(at),
                Ok(_) => {}
                Err(obstacle) => closest = closest.max(obstacle),
            }
        }
    }
    let start = best.ok_or(closest)?;
    let effort = model.effort();
    let decode = |p: &[f64]| evaluate(1.0 + p[0].portable_exp().max(1e-6), p[1].portable_exp()).ok();
    let first = [(start.rho - 1.0).portable_ln(), start.eta.portable_ln()];
    let refined = minimise(|p| decode(p).map(|at| at.threshold.portable_ln()), &first, &[0.4, 0.4], effort.descent(8));
    Ok(refined.and_then(|(best, _)| decode(&best)).filter(|at| at.threshold <= start.threshold).unwrap_or(start))
}
