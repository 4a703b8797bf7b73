//! The error box where stability is proved by the matrix inequality (M), in floating point (derivation, 13.7).

use super::candidate::{AtSigma, active_level, shape_of_weights, weight_h};
use super::model::FloatModel;
use super::obstacle::{Failing, Obstacle};
use super::threshold::ByMatrix;
use sigmastar_plants::bounds::FloatWeights;
use sigmastar_theory::derivation::paths::{Path, Paths};

/// Of the shape (rho, eta), or with the weights that are proved: the error box with the level condition active, and the threshold
/// there.
pub(super) fn error_box_by_matrix(
    by_matrix: &ByMatrix,
    model: &FloatModel,
    (x_per, e_per): (f64, f64),
    distances: [f64; 3],
    shape: (f64, f64),
) -> Result<AtSigma, Obstacle> {
    let [dist_x, dist_e, dist_z] = distances;
    let (rho, eta) = match by_matrix {
        ByMatrix::Sampled { .. } => shape,
        ByMatrix::Proved(inequality) => {
            shape_of_weights(model, [inequality.w_x.to_f64(), inequality.h.to_f64()], distances)
        }
    };
    let d_x = rho * model.c * dist_x;
    let level = active_level(eta, dist_e, rho);
    let at = [x_per + d_x, e_per + level.sqrt()];
    model.contains(at)?;
    let weights = FloatWeights {
        w_x: level / (model.p_low * d_x * d_x),
        k_p: 2.0 * weight_h(eta, dist_e, dist_z) / model.mu,
        rate: by_matrix.rate(),
    };
    let on_path = |path: Path| {
        let arguments = ByMatrix::arguments(path, [x_per, e_per], at);
        by_matrix.threshold(arguments, weights).map(|threshold| (path, threshold))
    };
    // None where nothing is proved of them.
    let found = by_matrix.paths().into_iter().find_map(on_path);
    let (path, threshold) = found.ok_or_else(|| Failing::Bounds.at(at[0], at[1]))?;
    if !threshold.is_finite() {
        return Err(Failing::Curvature.at(at[0], at[1]));
    }
    Ok(AtSigma { rho, eta, d_x, dist_e, dist_z, paths: Paths::both(path), threshold })
}
