//! What noise and a disturbance do at larger gains, beside those of a claim (derivation, 13.6): the deviation is neither rising nor falling in the
//! gain, as more of the noise goes through and less of the disturbance.

use super::certification::Certification;
use super::gain_row::{GainRow, RowNoise, RowProof};
use super::rates::{by_sampled_matrix, for_n_o, for_n_o_at_samples, matrix_arguments};
use super::sampled::SampledCertification;
use sigmastar_exact::parallel;
use sigmastar_lang::spec::Oscillators;

impl Certification<'_> {
    /// Proves what noise does at the gain of every row that rests on norms, for these oscillators.
    pub(super) fn set_noise_of_rows(&mut self, asked: &[Oscillators]) {
        if !self.spec.disturbances.any() {
            return;
        }
        let of_row = |row: &GainRow| {
            let RowProof::Continuous(proof, other) = &row.proof else { return Vec::new() };
            let spec = other.as_deref().unwrap_or(self.spec);
            match matrix_arguments(spec, proof) {
                Some(_) => Vec::new(),
                None => RowNoise::of(&row.sigma, for_n_o(spec, (proof, None), asked)),
            }
        };
        self.noise_of_rows = parallel::map(&self.gains, of_row).into_iter().flatten().collect();
    }
}

impl SampledCertification<'_> {
    /// The same at samples.
    pub(super) fn set_noise_of_rows(&mut self, asked: &[Oscillators]) {
        if !self.spec.disturbances.any_at_samples() {
            return;
        }
        let of_row = |row: &GainRow| match &row.proof {
            RowProof::Sampled(proof) if !by_sampled_matrix(self.spec, proof) => {
                RowNoise::of(&row.sigma, for_n_o_at_samples(self.spec, (proof, None), asked))
            }
            _ => Vec::new(),
        };
        self.noise_of_rows = parallel::map(&self.gains, of_row).into_iter().flatten().collect();
    }
}
