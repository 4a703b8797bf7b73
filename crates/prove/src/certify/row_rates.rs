//! The rates at larger gains, beside those of a claim (derivation, 13.6).

use super::certification::Certification;
use super::gain_row::{GainRow, RowProof};
use super::rates::{distances, distances_at_samples, matrix_arguments};
use super::sampled::SampledCertification;
use crate::rate::bound::{Place, bound};
use crate::rate::by_matrices::{Start, again};
use crate::rate::sampled::bound as at_samples;
use rug::Rational;
use sigmastar_decide::conditions::SharpProof;
use sigmastar_exact::parallel;
use sigmastar_lang::spec::{Oscillators, Specification};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::sampled::matrix_inequality;
use sigmastar_theory::evidence::Slopes;

type Rates = Vec<(u32, Option<Rational>)>;

impl Certification<'_> {
    /// Proves the rates of every row for these numbers of oscillators: of one that rests on a matrix inequality, of a plant with so many states, from
    /// what is proved of the derivatives for the claim. It is about the arguments of that inequality, which the error box of every row is within.
    pub(super) fn set_rates_of_rows(&mut self, counts: &[u32], states: Option<usize>) {
        let own: Rates = self.rates().map(|(n_o, rate)| (n_o, rate.cloned())).collect();
        let slopes: Vec<Option<&[Slopes]>> = self
            .for_n_o
            .iter()
            .filter(|found| found.oscillators.n_o().is_some())
            .map(|found| found.bound.as_ref().and_then(|bound| bound.proof.by.as_ref()).map(|by| by.slopes.as_slice()))
            .collect();
        let of_row = |row: &GainRow| {
            let RowProof::Continuous(proof, other) = &row.proof else { return Vec::new() };
            if other.is_none() && Some(&row.sigma) == self.sigma_star() {
                return own.clone();
            }
            let spec = other.as_deref().unwrap_or(self.spec);
            match (matrix_arguments(spec, proof), states) {
                (None, _) => by_norms(spec, proof, counts),
                (Some(_), Some(states)) if other.is_none() => by_matrices(spec, proof, (states, &slopes), counts),
                (Some(_), _) => counts.iter().map(|n_o| (*n_o, None)).collect(),
            }
        };
        let rates: Vec<Rates> = parallel::map(&self.gains, of_row);
        for (row, rates) in self.gains.iter_mut().zip(rates) {
            row.rates = rates;
        }
    }
}

fn by_norms(spec: &Specification, proof: &SharpProof, counts: &[u32]) -> Rates {
    let data = Data::new(spec, proof.precision);
    let distances = distances(&data, proof);
    let error_box = &proof.evaluation.error_box;
    let place = Place { sigma: &proof.witness.sigma, error_box, distances: distances.each_ref() };
    let rate = |n_o: u32| bound(&data, &place, &Oscillators::first(n_o)).map(|bound| bound.rate);
    counts.iter().map(|n_o| (*n_o, rate(*n_o))).collect()
}

fn by_matrices(
    spec: &Specification,
    proof: &SharpProof,
    (states, slopes): (usize, &[Option<&[Slopes]>]),
    counts: &[u32],
) -> Rates {
    let data = Data::new(spec, proof.precision);
    let distances = distances(&data, proof);
    let start = Start { sigma: &proof.witness.sigma, distances: &|_| distances.clone() };
    let rate = |(n_o, slopes): (&u32, &Option<&[Slopes]>)| {
        let bound = slopes.and_then(|slopes| again(&data, (states, &start), slopes, &Oscillators::first(*n_o)));
        (*n_o, bound.map(|bound| bound.rate))
    };
    counts.iter().zip(slopes).map(rate).collect()
}

impl SampledCertification<'_> {
    /// The same at samples, of the rows by norms.
    pub(super) fn set_rates_of_rows(&mut self, counts: &[u32]) {
        let own: Rates = self.rates().map(|(n_o, rate)| (n_o, rate.cloned())).collect();
        let claimed = self.claim().map(|proof| proof.witness.sigma.clone());
        let of_row = |row: &GainRow| {
            let RowProof::Sampled(proof) = &row.proof else { return Vec::new() };
            if Some(&row.sigma) == claimed.as_ref() {
                return own.clone();
            }
            let data = Data::new(self.spec, proof.precision);
            if matrix_inequality::proved_for(&data, &proof.witness).is_some() {
                return counts.iter().map(|n_o| (*n_o, None)).collect();
            }
            let distances = distances_at_samples(&data, proof);
            let error_box = &proof.evaluation.error_box;
            let place = Place { sigma: &proof.witness.sigma, error_box, distances: distances.each_ref() };
            let law = &proof.evaluation.law;
            let bound = |n_o: u32| at_samples::bound(&data, law, &place, &Oscillators::first(n_o));
            counts.iter().map(|n_o| (*n_o, bound(*n_o).map(|bound| bound.rate))).collect()
        };
        let rates: Vec<Rates> = parallel::map(&self.gains, of_row);
        for (row, rates) in self.gains.iter_mut().zip(rates) {
            row.rates = rates;
        }
    }
}
