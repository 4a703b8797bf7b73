//! The regulator as a NumPy archive.

use super::{Export, notice};
use ndarray::{Array0, Array1, Array2};
use ndarray_npy::{NpzWriter, WriteNpzError};
use std::io::Cursor;

/// The regulator as a NumPy `.npz` archive (stored, no time stamps): `sigma`, `mu`, `frequencies`, `weights`, `Phi`,
/// `Gamma`, `M`, `N`, `notice` (what is claimed and what is not: bytes of UTF-8) and, with a discretisation, `step`, `K`,
/// `weight_sum`, `decay`, `Phi_d`, `Gamma_d`, `C_d`, `D_d`, `saturation` where u is clipped, and of the sampled loop on e' = u
/// `spectral_radius` and `unstable` (a Boolean).
///
/// # Errors
/// None is known: the archive is written to memory.
pub fn npz(export: &Export<'_>) -> Result<Vec<u8>, WriteNpzError> {
    let regulator = export.regulator;
    let mut archive = NpzWriter::new(Cursor::new(Vec::new()));
    let vector = |values: &[f64]| Array1::from(values.to_vec());
    archive.add_array("sigma", &Array0::from_elem((), regulator.sigma))?;
    archive.add_array("mu", &Array0::from_elem((), regulator.mu))?;
    archive.add_array("frequencies", &vector(&regulator.frequencies))?;
    archive.add_array("weights", &vector(&regulator.weights))?;
    archive.add_array("Phi", &regulator.phi())?;
    archive.add_array("Gamma", &vector(&regulator.gamma()))?;
    archive.add_array("M", &vector(&regulator.m()))?;
    archive.add_array("N", &Array2::from_diag(&vector(&regulator.n_diagonal())))?;
    archive.add_array("notice", &Array1::from(notice(export).join("\n").into_bytes()))?;
    if let Some((discrete, sampled)) = export.discrete {
        archive.add_array("spectral_radius", &Array0::from_elem((), sampled.spectral_radius()))?;
        archive.add_array("unstable", &Array0::from_elem((), sampled.is_unstable()))?;
        let numbers = [
            ("step", discrete.step),
            ("K", discrete.gain),
            ("weight_sum", discrete.weight_sum),
            ("decay", discrete.decay),
            ("D_d", discrete.feedthrough),
        ];
        for (name, value) in numbers.into_iter().chain(discrete.saturation.map(|limit| ("saturation", limit))) {
            archive.add_array(name, &Array0::from_elem((), value))?;
        }
        archive.add_array("C_d", &vector(&discrete.output))?;
        archive.add_array("Phi_d", &discrete.transition())?;
        archive.add_array("Gamma_d", &vector(&discrete.input))?;
    }
    Ok(archive.finish()?.into_inner())
}
