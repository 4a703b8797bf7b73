//! The regulator as JSON.

use super::{Export, Provenance, continuous_law, notice, sampled_law};
use faer::Mat;
use serde_json::{Value, json as object};

/// The `format` of the file.
pub const FORMAT: &str = "sigmastar/controller";
/// The version that is written. In version 1 `discrete` was another law.
pub const VERSION: u64 = 2;
/// The versions that are read: the parameters of the regulator are the same in both.
pub const VERSIONS: [u64; 2] = [1, VERSION];

/// The regulator as JSON: parameters, matrices row by row, what is claimed and what is not, and the law at samples with the
/// spectral radius of its loop where there is one; with a delay Phi, Gamma, C, D are those of (z, s) and u_next. Every number is a double in the fewest digits that give it back.
#[must_use]
pub fn json(export: &Export<'_>) -> Value {
    let regulator = export.regulator;
    let discrete = export.discrete.map(|(discrete, sampled)| {
        let mut law = object!({
            "hold": "zero-order",
            "law": sampled_law(discrete.prediction.is_some(), regulator.nominal.is_some()),
            "step": discrete.step,
            "K": discrete.gain,
            "weight_sum": discrete.weight_sum,
            "decay": discrete.decay,
            "saturation": discrete.saturation,
            "Phi": rows(&discrete.transition()),
            "Gamma": discrete.input,
            "C": discrete.output,
            "D": discrete.feedthrough,
            "sampled_loop": {
                "plant": "e' = u", "spectral_radius": sampled.spectral_radius(), "verdict": sampled.verdict(),
            },
        });
        if let Some(product) = discrete.prediction {
            (law["delay_samples"], law["prediction"]) = (1.into(), product.into());
        }
        law
    });
    let certificate =
        export.certificate.map(|Provenance { sha256, sigma_star, one_gain, statement, scope, .. }| {
            let gain = if *one_gain { "sigma" } else { "sigma_star" };
            let covers = if scope.is_sampled() { "covers_law" } else { "covers_sigma" };
            object!({ "sha256": sha256, gain: sigma_star, "statement": statement, covers: scope.covers() })
        });
    let mut file = object!({
        "format": FORMAT, "version": VERSION,
        "name": export.name,
        "notice": notice(export),
        "certificate": certificate,
        "n_o": regulator.oscillators(),
        "sigma": regulator.sigma,
        "mu": regulator.mu,
        "frequencies": regulator.frequencies,
        "weights": regulator.weights,
        "start": if export.aligned { "z = M e" } else { "z = 0" },
        "law": continuous_law(regulator.nominal.is_some()),
        "Phi": rows(&regulator.phi()),
        "Gamma": regulator.gamma(),
        "M": regulator.m(),
        "N_diagonal": regulator.n_diagonal(),
        "discrete": discrete,
    });
    // The first n_o harmonics need no list.
    if export.oscillators.n_o().is_none() {
        file["harmonics"] = export.oscillators.all().collect();
    }
    // The gain of the actuator, where the document states one.
    if let Some(nominal) = regulator.nominal {
        file["input_gain"] = object!({ "nominal": nominal });
    }
    if let Some(actuator) = export.actuator {
        file["actuator"] = object!({ "max": actuator.limit() });
    }
    if let Some(middle) = export.middle {
        file["middle"] = middle.into();
    }
    file
}

fn rows(matrix: &Mat<f64>) -> Vec<Vec<f64>> {
    // -0 is a number of its own in JSON, and means nothing here.
    matrix.row_iter().map(|row| row.iter().map(|entry| entry + 0.0).collect()).collect()
}
