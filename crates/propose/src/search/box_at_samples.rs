//! The error box for stability at samples by the matrix inequality (Ms), proposed in floating point (derivation, 13.7).

use super::at_samples::BySampledMatrix;
use super::candidate::{AtSigma, active_level, shape_of_weights, weight_h};
use super::model::FloatModel;
use super::obstacle::{Failing, Obstacle};
use sigmastar_theory::derivation::paths::{Path, Paths};

/// Of the shape (rho, eta), or with the weights that are proved: the error box with the level condition active, and the radius there.
pub(super) fn error_box_at_samples(
    by_matrix: &BySampledMatrix,
    model: &FloatModel,
    (x_per, e_per): (f64, f64),
    distances: [f64; 3],
    (shape, sigma): ((f64, f64), f64),
) -> Result<AtSigma, Obstacle> {
    let [dist_x, dist_e, dist_z] = distances;
    let (rho, eta) = match by_matrix {
        BySampledMatrix::Sampled(_) => shape,
        BySampledMatrix::Proved(known) => shape_of_weights(model, [known.w_x.to_f64(), known.eta.to_f64()], distances),
    };
    let d_x = rho * model.c * dist_x;
    let level = active_level(eta, dist_e, rho);
    let at = [x_per + d_x, e_per + level.sqrt()];
    model.contains(at)?;
    let weights = [level / (model.p_low * d_x * d_x), weight_h(eta, dist_e, dist_z)];
    let radius = by_matrix.radius(at, weights, sigma).map_err(|failing| failing.at(at[0], at[1]))?;
    if !radius.is_finite() {
        return Err(Failing::Coupling.at(at[0], at[1]));
    }
    // Where nothing is coupled the radius is 0, which has no logarithm.
    let threshold = radius.max(1e-300);
    Ok(AtSigma::new((rho, eta), d_x, distances, Paths::both(Path::Straight), threshold))
}
