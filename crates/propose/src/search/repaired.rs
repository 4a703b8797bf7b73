//! The search of the repaired derivation: X, E, L, h that make sigma* small.

use super::candidate::{BELOW_ONE, demand, largest_e, weight_h};
use super::minimise::minimise;
use super::model::FloatModel;
use super::obstacle::{Closest, Failing, Obstacle};
use super::scan;
use sigmastar_exact::number::Portable;
use sigmastar_exact::parallel;
use sigmastar_theory::data::Problem;
use sigmastar_theory::derivation::existence::{LeastSigma, PeriodicBounds};
use sigmastar_theory::derivation::gains::{beta, k_alpha};
use sigmastar_theory::derivation::initial_set::distances;
use sigmastar_theory::derivation::lyapunov_matrix::{LyapunovMatrix, LyapunovPoint};
use std::cmp::Ordering;

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
}

fn k_of(model: &FloatModel) -> f64 {
    k_alpha(&model.c, &model.alpha, &model.period)
}

/// All quantities for given X, E and eta with h dZ^2 = eta dE^2.
fn evaluate(model: &FloatModel, x: f64, e: f64, eta: f64) -> Result<RepairedProposal, Obstacle> {
    let bounds = PeriodicBounds::new(model, x, e);
    if demand(model, &bounds.state, k_of(model), 2).partial_cmp(&1.0).is_none_or(Ordering::is_gt) {
        return Err(Failing::Existence.at(x, e));
    }
    let pair = model.trade_off.best(1.0, 1.0);
    let [kappa_0, kappa_1] = model.numbers().kappas(&pair.0, &pair.1);
    let z = bounds.z_squared_printed(model, &kappa_0, &kappa_1).sqrt();
    let start = model.required_set(x, e, z);
    let [dist_x, dist_e, dist_z] = distances(model, &start, [&x, &e, &z]);
    let h = weight_h(eta, dist_e, dist_z.max(1e-6 * model.n_bar * dist_e));
    let level = model.p_up * dist_x * dist_x + (1.0 + eta) * dist_e * dist_e;
    let (x_b, e_b) = (x + (level / model.p_low).sqrt(), e + level.sqrt());
    model.contains([x_b, e_b])?;
    let lyapunov = LyapunovMatrix::new(model, &LyapunovPoint { x, e, x_b, e_b, h }, false);
    let curvature = lyapunov.curvature;
    if curvature.is_nan() || curvature <= (1.0 - BELOW_ONE) * model.alpha * model.p_low {
        return Err(Failing::Curvature.at(x_b, e_b));
    }
    let least = LeastSigma::repaired(model, &bounds);
    let sigma = least.by_size.max(least.by_contraction * (1.0 + 1e-9)).max(lyapunov.sigma_a);
    if !sigma.is_finite() {
        return Err(model.not_finite(x_b, e_b));
    }
    Ok(RepairedProposal { x, e, h, sigma })
}

/// The largest E with C1 and the first diagonal entry of the contraction matrix below 1.
#[must_use]
pub fn largest_e_repaired(model: &FloatModel, x: f64) -> Option<f64> {
    largest_e(model, x, k_of(model), 2)
}

/// Weights p_x, p_e for C3 at sigma.
#[must_use]
pub fn perron_repaired(model: &FloatModel, x: f64, e: f64, sigma: f64) -> [f64; 2] {
    let matrix = PeriodicBounds::new(model, x, e).contraction(model, &k_of(model), 2, &beta(&sigma, &model.period));
    matrix.perron_weights(&x.recip(), &e.recip())
}

/// Searches for the smallest sigma of the repaired derivation.
///
/// # Errors
/// The obstacle of the candidate that came closest, when none is feasible.
pub fn search_repaired(model: &FloatModel) -> Result<RepairedProposal, Obstacle> {
    const ETAS: [f64; 5] = [1e-6, 1e-3, 0.1, 1.0, 30.0];
    model.in_range()?;
    let effort = model.effort();
    let xs = scan::x_values(model.domain.0, effort.x_step);
    let columns = parallel::map(&xs, |&x| {
        let e_max = largest_e_repaired(model, x).ok_or(Failing::Existence.at(x, 0.0))?;
        let found = scan::e_depths(effort.e_step).flat_map(|depth| {
            ETAS.map(|eta| evaluate(model, x, e_max * (-depth).portable_exp(), eta).map(|found| (found, eta)))
        });
        Closest::least(found, |(found, _)| found.sigma)
    });
    let mut closest = Closest::default();
    let mut found = Vec::new();
    for column in columns {
        match column {
            Ok(candidate) => found.push(candidate),
            Err(obstacle) => closest.record(obstacle),
        }
    }
    found.sort_by(|a, b| a.0.sigma.total_cmp(&b.0.sigma));
    found.truncate(4);
    let refined = parallel::map(&found, |(start, eta)| {
        let decode = |p: &[f64]| {
            let x = scan::in_range(p[0].portable_exp())?;
            let e = largest_e_repaired(model, x)? * (-depth_of(p[1])).portable_exp();
            evaluate(model, x, e, p[2].portable_exp()).ok()
        };
        let depth = (largest_e_repaired(model, start.x)? / start.e).portable_ln().max(1e-9);
        let first = [start.x.portable_ln(), parameter_of(depth), eta.portable_ln()];
        let (best, _) = minimise(
            &|p| decode(p).map(|f| f.sigma.portable_ln() + scan::preference(f.x) + scan::preference(f.e)),
            &first,
            &[0.3, 0.5, 0.5],
            effort.descent(6),
        )?;
        decode(&best)
    });
    // Where the refinement of every column fails, what the scan found serves.
    let refined = refined.into_iter().flatten().min_by(|a, b| a.sigma.total_cmp(&b.sigma));
    closest.or(refined.or(found.first().map(|(start, _)| *start)))
}

/// A depth below the largest E_p from an unbounded parameter: logarithmic near 0, linear beyond 1.
pub(super) fn depth_of(parameter: f64) -> f64 {
    if parameter < 0.0 { parameter.portable_exp() } else { 1.0 + parameter }
}

/// The inverse of [`depth_of`].
pub(super) fn parameter_of(depth: f64) -> f64 {
    if depth < 1.0 { depth.portable_ln() } else { depth - 1.0 }
}
