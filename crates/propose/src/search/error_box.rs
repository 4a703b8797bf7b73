//! The error box in floating point: rho and eta that make the threshold of C5 (or what the law at samples has in its place)
//! small, for given distances.

use super::by_matrix::error_box_by_matrix;
use super::candidate::{AtSigma, error_box_by_norms};
use super::minimise::minimise;
use super::model::FloatModel;
use super::obstacle::{Closest, Obstacle};
use sigmastar_exact::number::Portable;

/// Powers of two of rho - 1 in the scan.
const RHO_EXPONENTS: std::ops::RangeInclusive<i32> = -10..=4;

/// Half decades of eta in the scan.
const ETA_EXPONENTS: std::ops::RangeInclusive<i32> = -24..=12;

/// Beyond these, larger values are tried while they help: where a distance is far smaller than what the box may be.
const FAR: usize = 60;

/// So many values in a row that do not help end that.
const PATIENCE: usize = 3;

/// The error box of a shape, and the threshold of C5, or of what stands in its place, at a sigma, which it contains where there is an
/// input gain.
///
/// # Errors
/// What stands in the way.
pub(super) fn error_box(
    model: &FloatModel,
    periodic: (f64, f64),
    distances: [f64; 3],
    (shape, sigma): ((f64, f64), f64),
) -> Result<AtSigma, Obstacle> {
    match &model.by_matrix {
        Some(by_matrix) => error_box_by_matrix(by_matrix, model, periodic, distances, shape),
        None => error_box_by_norms(model, periodic, distances, (shape, sigma)),
    }
}

/// The best error box around a periodic solution of size (x_per, e_per), for distances dX, dE, dZ: a scan over many orders of
/// magnitude, then a local minimisation.
///
/// # Errors
/// The obstacle of the candidate that came closest, when none is feasible.
pub fn best_error_box(
    model: &FloatModel,
    periodic: (f64, f64),
    distances: [f64; 3],
    sigma: f64,
) -> Result<AtSigma, Obstacle> {
    best_shape(model, |rho, eta| error_box(model, periodic, distances, ((rho, eta), sigma)))
}

/// The best rho and eta of any boxes.
///
/// # Errors
/// The obstacle of the candidate that came closest, when none is feasible.
pub fn best_shape(
    model: &FloatModel,
    evaluate: impl Fn(f64, f64) -> Result<AtSigma, Obstacle>,
) -> Result<AtSigma, Obstacle> {
    let step = model.effort().shape_step;
    let rhos: Vec<f64> = RHO_EXPONENTS.step_by(step).map(|k| 1.0 + 2f64.portable_powi(k)).collect();
    let far_rhos = (1..=FAR).map(|k| 1.0 + 2f64.portable_powi(4 + 5 * k as i32));
    let etas: Vec<f64> = ETA_EXPONENTS.step_by(step).map(|k| 10f64.portable_pow(f64::from(k) / 2.0)).collect();
    let far_etas: Vec<f64> = (1..=FAR).map(|k| 10f64.portable_powi(6 + 2 * k as i32)).collect();
    let at_rho = |rho: f64| scan(&etas, far_etas.iter().copied(), |eta| evaluate(rho, eta));
    refine(model, &evaluate, scan(&rhos, far_rhos, at_rho)?)
}

/// The smallest cost over all of the values and over those of `far` that help, one after the other.
fn scan(
    near: &[f64],
    far: impl Iterator<Item = f64>,
    evaluate: impl Fn(f64) -> Result<AtSigma, Obstacle>,
) -> Result<AtSigma, Obstacle> {
    let mut closest = Closest::default();
    let mut best: Option<AtSigma> = None;
    let mut look = |value: f64| match evaluate(value) {
        Ok(at) if best.is_none_or(|b| at.cost < b.cost) => {
            best = Some(at);
            true
        }
        Ok(_) => false,
        Err(obstacle) => {
            closest.record(obstacle);
            false
        }
    };
    for value in near {
        look(*value);
    }
    let mut idle = 0;
    for value in far {
        idle = if look(value) { 0 } else { idle + 1 };
        if idle >= PATIENCE {
            break;
        }
    }
    closest.or(best)
}

/// The best shape that local minimisation reaches from a known one; `None` where that is not feasible here.
pub fn shape_near(
    model: &FloatModel,
    evaluate: impl Fn(f64, f64) -> Result<AtSigma, Obstacle>,
    (rho, eta): (f64, f64),
) -> Option<AtSigma> {
    refine(model, &evaluate, evaluate(rho, eta).ok()?).ok()
}

fn refine(
    model: &FloatModel,
    evaluate: &impl Fn(f64, f64) -> Result<AtSigma, Obstacle>,
    start: AtSigma,
) -> Result<AtSigma, Obstacle> {
    // rho too close to 1 would leave no room between the two members of C4.
    let decode = |p: &[f64]| evaluate(1.0 + p[0].portable_exp().max(1e-6), p[1].portable_exp()).ok();
    let first = [(start.rho - 1.0).portable_ln(), start.eta.portable_ln()];
    let cost = |p: &[f64]| decode(p).map(|at| at.cost.portable_ln());
    let refined = minimise(&cost, &first, &[0.4, 0.4], model.effort().descent(8));
    Ok(refined.and_then(|(best, _)| decode(&best)).filter(|at| at.cost <= start.cost).unwrap_or(start))
}
