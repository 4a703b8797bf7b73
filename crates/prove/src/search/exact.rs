//! The search for exact regulation: the error box around the origin.

use super::candidate::AtSigma;
use super::error_box::best_error_box;
use super::model::FloatModel;
use super::obstacle::Obstacle;

/// The error box of exact regulation in floating point, with its sigma as `threshold`.
///
/// `distances` are dX = X_0, dE = E_0, dZ = Z_0 + Nbar E_0 + z_oo.
///
/// # Errors
/// The obstacle of the candidate that came closest, when none is feasible.
pub fn search_exact(model: &FloatModel, distances: [f64; 3]) -> Result<AtSigma, Obstacle> {
    best_error_box(model, (0.0, 0.0), distances)
}
