//! The error box where stability is proved by the matrix inequality (M), in floating point (derivation, 13.7).

use super::candidate::{AtSigma, active_level, weight_h};
use super::model::FloatModel;
use super::obstacle::{Failing, Obstacle};
use super::threshold::ByMatrix;
use rug::Rational;
use sigmastar_plants::bounds::FloatWeights;
use sigmastar_theory::derivation::paths::Paths;

/// A proved inequality ends where it ends: a search stays so far inside that rounding does not lead beyond.
const EDGE: f64 = 1.0 - 1e-6;

/// Of the shape (rho, eta), or with the weights that are proved: the error box with the level condition active, and the threshold
/// there.
pub(super) fn error_box_by_matrix(
    by_matrix: &ByMatrix,
    model: &FloatModel,
    (x_per, e_per): (f64, f64),
    [dist_x, dist_e, dist_z]: [f64; 3],
    shape: (f64, f64),
) -> Result<AtSigma, Obstacle> {
    let (rho, eta) = match by_matrix {
        ByMatrix::Sampled { .. } => shape,
        ByMatrix::Proved(inequality) => {
            // D_e^2 is the level, and w_x P_low D_x^2 = D_e^2.
            let (w_x, of_zeta) = (inequality.w_x.to_f64(), inequality.h.to_f64() * dist_z * dist_z);
            let own = w_x * model.p_up * dist_x * dist_x;
            let level = own + dist_e * dist_e + of_zeta;
            ((level / own).sqrt(), of_zeta / (dist_e * dist_e))
        }
    };
    let d_x = rho * model.c * dist_x;
    let level = active_level(eta, dist_e, rho);
    let at = [x_per + d_x, e_per + level.sqrt()];
    model.contains(at)?;
    let threshold = match by_matrix {
        ByMatrix::Sampled { threshold, rate } => {
            let (w_x, h) = (level / (model.p_low * d_x * d_x), weight_h(eta, dist_e, dist_z));
            threshold(at, FloatWeights { w_x, k_p: 2.0 * h / model.mu, rate: *rate })
        }
        ByMatrix::Proved(inequality) => {
            let within = |at: f64, end: &Rational| at <= end.to_f64() * EDGE;
            if !(within(at[0], &inequality.x) && within(at[1], &inequality.e)) {
                return Err(Failing::Bounds.at(at[0], at[1]));
            }
            inequality.value.to_f64()
        }
    };
    if !threshold.is_finite() {
        return Err(Failing::Curvature.at(at[0], at[1]));
    }
    Ok(AtSigma { rho, eta, d_x, dist_e, dist_z, paths: Paths::STRAIGHT, threshold })
}
