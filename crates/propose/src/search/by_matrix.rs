//! The error box for stability by the matrix inequality (M), proposed in floating point (derivation, 13.7).

use super::candidate::{AtSigma, active_level, shape_of_weights, weight_h};
use super::model::FloatModel;
use super::obstacle::{Failing, Obstacle};
use super::threshold::{ByMatrix, EDGE};
use crate::bounds::FloatWeights;
use rug::Rational;
use sigmastar_lang::spec::JointStability;
use sigmastar_theory::derivation::joint;
use sigmastar_theory::derivation::paths::{Path, Paths};

/// How far beyond its arguments a sampled inequality is taken, as a share of the room in S1 and S2.
const SHARE_OF_ROOM: f64 = 0.25;

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
        ByMatrix::Joint(joint) => return joint_error_box(joint, model, (x_per, e_per), [dist_x, dist_e, dist_z]),
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
    // Near the edge of where (M) holds at all a little of the box takes much of the gain.
    let beyond = match by_matrix {
        ByMatrix::Sampled { .. } => 1.0 + SHARE_OF_ROOM * model.effort().room,
        ByMatrix::Proved(_) | ByMatrix::Joint(_) => 1.0,
    };
    let on_path = |path: Path| {
        let arguments = ByMatrix::arguments(path, [x_per * beyond, e_per * beyond], at.map(|end| end * beyond));
        by_matrix.threshold(arguments, weights).map(|threshold| (path, threshold))
    };
    // None where nothing is proved of them.
    let found = by_matrix.paths().into_iter().find_map(on_path);
    let (path, threshold) = found.ok_or_else(|| Failing::Bounds.at(at[0], at[1]))?;
    if !threshold.is_finite() {
        return Err(Failing::Curvature.at(at[0], at[1]));
    }
    Ok(AtSigma::new((rho, eta), d_x, distances, Paths::both(path), threshold))
}

/// What is kept between both members of C4, for rounding.
const ROOM_OF_LEVEL: f64 = 1.0 - 1e-9;

/// The error box of a joint inequality: as large as it is proved, with the shape that it has.
fn joint_error_box(
    joint: &JointStability,
    model: &FloatModel,
    (x_per, e_per): (f64, f64),
    [dist_x, dist_e, dist_z]: [f64; 3],
) -> Result<AtSigma, Obstacle> {
    let JointStability { inequality, levels } = joint;
    let [x_b, e_b] = [&inequality.x, &inequality.e].map(|end| end.to_f64() * EDGE);
    model.contains([x_b, e_b])?;
    let (d_x, d_e) = (x_b - x_per, e_b - e_per);
    let (rho, level) = (d_x / (model.c * dist_x), d_e * d_e);
    // h dZ^2 is what the level leaves beside e and x.
    let eta = level * (1.0 - 1.0 / (rho * rho)) / (dist_e * dist_e) - 1.0;
    let inside = |metric| {
        let (start, exit) =
            joint::level_condition(model, metric, Rational::to_f64, [&dist_x, &dist_e, &dist_z], [&d_x, &d_e]);
        start < exit * ROOM_OF_LEVEL
    };
    let metrics = inequality.metrics().into_iter().zip(levels);
    if rho > 1.0 && eta > 0.0 && metrics.into_iter().all(inside) {
        let (paths, threshold) = (Paths::both(Path::Straight), inequality.value.to_f64());
        return Ok(AtSigma::new((rho, eta), d_x, [dist_x, dist_e, dist_z], paths, threshold));
    }
    Err(Failing::Bounds.at(x_b, e_b))
}
