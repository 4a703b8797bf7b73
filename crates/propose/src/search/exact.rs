//! The search for exact regulation: the error box around the origin.

use super::candidate::AtSigma;
use super::error_box::best_error_box;
use super::model::FloatModel;
use super::obstacle::{Failing, Obstacle};
use super::root::crossing;
use sigmastar_exact::number::Portable;

/// Doublings of sigma at most.
const DOUBLINGS: usize = 200;

/// The width of the last bracket of ln sigma.
const WIDTH: f64 = 1e-11;

/// The error box of exact regulation in floating point, with its sigma as `threshold`.
///
/// `distances` are dX = X_0, dE = E_0, dZ = Z_0 + Nbar E_0 + z_oo, this one as [`FloatModel::weighed`] has it.
///
/// # Errors
/// The obstacle of the candidate that came closest, when none is feasible.
pub fn search_exact(model: &FloatModel, distances: [f64; 3]) -> Result<AtSigma, Obstacle> {
    let at = |sigma: f64| best_error_box(model, (0.0, 0.0), distances, sigma);
    // Without an input gain the threshold does not depend on sigma. With one it is not below that at the gain 0.
    let least = at(0.0)?;
    if model.input_gain.is_none() {
        return Ok(least);
    }
    let excess = |sigma: f64| at(sigma).map(|at| (at.threshold / sigma).portable_ln());
    let mut low = (least.threshold, excess(least.threshold)?);
    if low.1 <= 0.0 {
        return Ok(AtSigma { threshold: low.0, ..at(low.0)? });
    }
    let high = (0..DOUBLINGS).find_map(|_| {
        let next = 2.0 * low.0;
        match excess(next) {
            Ok(value) if value <= 0.0 => Some(Ok((next, value))),
            Ok(value) => {
                low = (next, value);
                None
            }
            Err(obstacle) => Some(Err(obstacle)),
        }
    });
    let high = high.unwrap_or(Err(Failing::NotFinite(None).into()))?;
    let [low, high] = [low, high].map(|(sigma, value)| (sigma.portable_ln(), value));
    let in_exponent = |t: f64| excess(t.portable_exp()).unwrap_or(f64::INFINITY);
    let sigma = crossing(in_exponent, low, high, WIDTH).portable_exp();
    Ok(AtSigma { threshold: sigma, ..at(sigma)? })
}
