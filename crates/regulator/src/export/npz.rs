//! The regulator as a NumPy archive.

use super::{Export, notice, numbers};
use faer::Mat;
use std::io::{Cursor, Write as _};
use zip::result::ZipResult;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// The regulator as a NumPy `.npz` archive (stored, no time stamps): `sigma`, `mu`, `nominal` (the gain of the actuator, by which u is
/// divided, where there is one), `middle` (of the range of the actuator, which is added to u, where it is not 0), `frequencies`, `weights`, `Phi`,
/// `Gamma`, `M`, `N`, `aligned` (whether z = M e at the first instant; else z = 0 there), `notice` (what is claimed and what is not:
/// bytes of UTF-8) and, with a discretisation, `step`, `K`,
/// `weight_sum`, `decay`, `Phi_d`, `Gamma_d`, `C_d`, `D_d`, `saturation` where u is clipped, with a delay `delay_samples` and `prediction`
/// (h sigma; the matrices then are those of (z, s)), and of the sampled loop on e' = u
/// `spectral_radius` and `unstable` (a Boolean).
///
/// # Errors
/// None is known: the archive is written to memory.
pub fn npz(export: &Export<'_>) -> ZipResult<Vec<u8>> {
    let regulator = export.regulator;
    let weights = regulator.n_diagonal();
    let weights = Mat::from_fn(weights.len(), weights.len(), |i, j| if i == j { weights[i] } else { 0.0 });
    let mut archive = Archive(ZipWriter::new(Cursor::new(Vec::new())));
    archive.number("sigma", regulator.sigma)?;
    archive.number("mu", regulator.mu)?;
    if let Some(nominal) = regulator.nominal {
        archive.number("nominal", nominal)?;
    }
    if let Some(middle) = export.middle {
        archive.number("middle", middle)?;
    }
    archive.vector("frequencies", &regulator.frequencies)?;
    archive.vector("weights", &regulator.weights)?;
    archive.matrix("Phi", &regulator.phi())?;
    archive.vector("Gamma", &regulator.gamma())?;
    archive.vector("M", &regulator.m())?;
    archive.matrix("N", &weights)?;
    archive.add("aligned", "|b1", &[], &[u8::from(export.aligned)])?;
    let notice = notice(export).join("\n");
    archive.add("notice", "|u1", &[notice.len()], notice.as_bytes())?;
    if let Some((discrete, sampled)) = export.discrete {
        archive.number("spectral_radius", sampled.spectral_radius())?;
        archive.add("unstable", "|b1", &[], &[u8::from(sampled.is_unstable())])?;
        let delayed = discrete.prediction.map(|product| [("delay_samples", 1.0), ("prediction", product)]);
        let further = discrete.saturation.map(|limit| ("saturation", limit));
        for (name, value) in numbers(discrete).into_iter().chain(delayed.into_iter().flatten()).chain(further) {
            archive.number(name, value)?;
        }
        archive.vector("C_d", &discrete.output)?;
        archive.matrix("Phi_d", &discrete.transition())?;
        archive.vector("Gamma_d", &discrete.input)?;
    }
    Ok(archive.0.finish()?.into_inner())
}

/// A zip archive of arrays in NumPy's format 1.0.
struct Archive(ZipWriter<Cursor<Vec<u8>>>);

impl Archive {
    fn number(&mut self, name: &str, value: f64) -> ZipResult<()> {
        self.doubles(name, &[], [value])
    }

    fn vector(&mut self, name: &str, values: &[f64]) -> ZipResult<()> {
        self.doubles(name, &[values.len()], values.iter().copied())
    }

    fn matrix(&mut self, name: &str, matrix: &Mat<f64>) -> ZipResult<()> {
        let (rows, columns) = matrix.shape();
        let entries = (0..rows).flat_map(|i| (0..columns).map(move |j| matrix[(i, j)]));
        self.doubles(name, &[rows, columns], entries)
    }

    fn doubles(&mut self, name: &str, shape: &[usize], values: impl IntoIterator<Item = f64>) -> ZipResult<()> {
        let bytes: Vec<u8> = values.into_iter().flat_map(f64::to_le_bytes).collect();
        self.add(name, "<f8", shape, &bytes)
    }

    /// Adds `<name>.npy`: magic and version, the length of the header in two bytes, the header padded so that the data
    /// start at a multiple of 64, and the data row by row.
    fn add(&mut self, name: &str, descr: &str, shape: &[usize], data: &[u8]) -> ZipResult<()> {
        const BEFORE_THE_HEADER: usize = 10;
        let shape: String = shape.iter().map(|length| format!("{length}, ")).collect();
        let mut header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({}), }}", shape.trim_end());
        let end = (BEFORE_THE_HEADER + header.len() + 1).next_multiple_of(64);
        header.extend(std::iter::repeat_n(' ', end - BEFORE_THE_HEADER - header.len() - 1));
        header.push('\n');
        let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
        self.0.start_file(format!("{name}.npy"), stored.last_modified_time(DateTime::default()))?;
        self.0.write_all(b"\x93NUMPY\x01\x00")?;
        // The shape has at most two numbers: the header is far shorter than 2^16 bytes.
        self.0.write_all(&(header.len() as u16).to_le_bytes())?;
        self.0.write_all(header.as_bytes())?;
        Ok(self.0.write_all(data)?)
    }
}
