//! The regulator as JSON.

use super::Export;
use ndarray::Array2;
use serde_json::{Value, json as object};

/// The `format` of the file.
pub const FORMAT: &str = "sigmastar/controller";
/// The version that is written.
pub const VERSION: u64 = 1;

/// The regulator as JSON: parameters, matrices row by row, and the discretisation with the
/// spectral radius of its loop where there is one. Every number is a double in the fewest digits that give it back.
#[must_use]
pub fn json(export: &Export<'_>) -> Value {
    let regulator = export.regulator;
    let discrete = export.discrete.map(|(discrete, sampled)| {
        object!({
            "hold": "zero-order",
            "step": discrete.step,
            "Phi": rows(&discrete.transition()),
            "Gamma": discrete.input,
            "sampled_loop": {
                "plant": "e' = u", "spectral_radius": sampled.spectral_radius(), "verdict": sampled.verdict(),
            },
        })
    });
    object!({
        "format": FORMAT, "version": VERSION,
        "name": export.name,
        "n_o": regulator.oscillators(),
        "sigma": regulator.sigma,
        "mu": regulator.mu,
        "frequencies": regulator.frequencies,
        "weights": regulator.weights,
        "law": "z' = Phi z + Gamma e, u = -sigma e + mu M'N(z - M e)",
        "Phi": rows(&regulator.phi()),
        "Gamma": regulator.gamma(),
        "M": regulator.m(),
        "N_diagonal": regulator.n_diagonal(),
        "discrete": discrete,
    })
}

fn rows(matrix: &Array2<f64>) -> Vec<Vec<f64>> {
    // -0 is a number of its own in JSON, and means nothing here.
    matrix.rows().into_iter().map(|row| row.iter().map(|entry| entry + 0.0).collect()).collect()
}
