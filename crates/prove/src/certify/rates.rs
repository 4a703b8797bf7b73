//! Rates for given numbers of oscillators, as a part of a claim in continuous time (derivation, 13.6).

use super::certification::Certification;
use super::proof::Proof;
use crate::rate::bound::{MAX_COUNTS, MAX_OSCILLATORS, Place, RateBound, RateForCount, bound};
use crate::rate::by_matrices::{Tube, bounds};
use rayon::prelude::*;
use rug::Rational;
use sigmastar_exact::number::write_exact;
use sigmastar_plants::bounds::{Engine, FloatSuprema};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::initial_set::claimed_distances;

/// Why a claim can have no rates for given numbers of oscillators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoRatesOfClaim {
    /// It is about the regulator at samples.
    AtSamples,
    /// It rests on the derivatives of a plant, which could not be had again from its formulas.
    OfFormulas,
    /// So many numbers were asked for.
    TooMany(usize),
    /// This number is beyond the largest one.
    Beyond(u32),
}

impl NoRatesOfClaim {
    /// What is wrong; `option` is the list of numbers as the user writes it.
    #[must_use]
    pub fn message(self, option: &str) -> String {
        match self {
            NoRatesOfClaim::AtSamples => {
                format!(
                    "{option}: not available for the regulator at samples: rates for given n_o are of continuous time"
                )
            }
            NoRatesOfClaim::OfFormulas => {
                format!(
                    "{option}: the claim rests on the derivatives of a plant, and they could not be had again from its formulas"
                )
            }
            NoRatesOfClaim::TooMany(count) => {
                format!("{option}: {count} numbers of oscillators; at most {MAX_COUNTS} go into one certificate")
            }
            NoRatesOfClaim::Beyond(n_o) => {
                format!(
                    "{option}: n_o = {n_o} is beyond {MAX_OSCILLATORS}, the largest of which a certificate has a rate"
                )
            }
        }
    }

    /// What to try.
    #[must_use]
    pub fn help(self) -> &'static str {
        match self {
            NoRatesOfClaim::AtSamples => "leave it or the sampling period out",
            NoRatesOfClaim::OfFormulas => {
                "leave it out; a bounding specification of the plant (`sigmastar bound`) has a claim by norms"
            }
            NoRatesOfClaim::TooMany(_) => "ask for fewer, or write several certificates",
            NoRatesOfClaim::Beyond(_) => {
                "ask for smaller numbers; `sigmastar rate` goes further, without a certificate"
            }
        }
    }
}

/// The numbers in order, each once.
///
/// # Errors
/// More than [`MAX_COUNTS`] different ones, and one beyond [`MAX_OSCILLATORS`].
pub fn rate_counts(asked: &[u32]) -> Result<Vec<u32>, NoRatesOfClaim> {
    let mut counts = asked.to_vec();
    counts.sort_unstable();
    counts.dedup();
    match (counts.len(), counts.last()) {
        (_, Some(last)) if *last > MAX_OSCILLATORS => Err(NoRatesOfClaim::Beyond(*last)),
        (count, _) if count > MAX_COUNTS => Err(NoRatesOfClaim::TooMany(count)),
        _ => Ok(counts),
    }
}

impl Certification<'_> {
    /// X and E of the inequality by which stability is proved, (M) or (Jm): the error box lies inside, and the first derivatives are known
    /// there together. None where the claim rests on norms, and without one.
    #[must_use]
    pub fn matrix_arguments(&self) -> Option<[&Rational; 2]> {
        let Proof { witness, .. } = self.sharp.proved().filter(|_| self.claim().is_some())?;
        let values = self.spec.bounds.proved_values();
        if let Some(joint) = values.joint_stability() {
            return Some([&joint.inequality.x, &joint.inequality.e]);
        }
        let inequality = values.inequality().filter(|known| known.w_x == witness.w_x && known.h == witness.h)?;
        Some([&inequality.x, &inequality.e])
    }

    /// Proves rates for these numbers of oscillators at the gain of the claim, and makes them a part of it; without a claim there are none.
    ///
    /// Guarantee: for each bound that is proved, with so many oscillators, at the claimed gain and no other, every solution from the
    /// claimed set has `|e(t) - e_per(t)| <= factor exp(-rate (t - t_0))`.
    ///
    /// # Errors
    /// Those of [`rate_counts`], and a claim that does not rest on norms, of which [`Certification::prove_rates_around`] has rates.
    pub fn prove_rates(&mut self, asked: &[u32]) -> Result<(), NoRatesOfClaim> {
        let counts = rate_counts(asked)?;
        if !counts.is_empty() && self.matrix_arguments().is_some() {
            return Err(NoRatesOfClaim::OfFormulas);
        }
        self.for_n_o = self.rates_of(&counts, |data, place| {
            let of = |n_o: &u32| bound(data, place, *n_o);
            counts.par_iter().map(of).collect()
        });
        Ok(())
    }

    /// The same of a claim that rests on the derivatives of a plant, by what decides and samples them around its orbit.
    ///
    /// Guarantee: that of [`Certification::prove_rates`], where the engine is one of the plant and the orbit of the claim.
    ///
    /// # Errors
    /// Those of [`rate_counts`].
    pub fn prove_rates_around(
        &mut self,
        asked: &[u32],
        (engine, samples): (&Engine, &FloatSuprema),
    ) -> Result<(), NoRatesOfClaim> {
        let counts = rate_counts(asked)?;
        let Some(at) = self.matrix_arguments() else { return self.prove_rates(asked) };
        let found = self.rates_of(&counts, |data, Place { sigma, distances, .. }| {
            bounds(data, &Tube { engine, samples, at, sigma, distances: *distances }, &counts)
        });
        self.for_n_o = found;
        Ok(())
    }

    /// What is found for each number; nothing without a claim.
    fn rates_of(
        &self,
        counts: &[u32],
        find: impl FnOnce(&Data<'_>, &Place<'_>) -> Vec<Option<RateBound>>,
    ) -> Vec<RateForCount> {
        let (Some(_), Some(Proof { witness, evaluation, precision })) = (self.claim(), self.sharp.proved()) else {
            return Vec::new();
        };
        if counts.is_empty() {
            return Vec::new();
        }
        let data = Data::new(self.spec, *precision);
        let periodic = [&evaluation.periodic.x_per, &evaluation.periodic.e_per, &evaluation.z];
        let distances = claimed_distances(&data, &witness.set, periodic);
        let place = Place { sigma: &witness.sigma, error_box: &evaluation.error_box, distances: distances.each_ref() };
        let found = find(&data, &place);
        counts.iter().zip(found).map(|(n_o, bound)| RateForCount { n_o: *n_o, bound }).collect()
    }

    /// The sentences of the claim about them, each with a space before it.
    #[must_use]
    pub fn rates_in_words(&self) -> String {
        let Some(sigma) = self.sigma_star().map(write_exact) else { return String::new() };
        let sentence = |RateBound { n_o, witness, factor, .. }: &RateBound| {
            format!(
                " With n_o = {n_o} and sigma = {sigma} exactly also |e(t) - e_per(t)| <= {} exp(-{} (t - t_0)) for these solutions, e_per \
                 that of the periodic solution and t_0 the initial time.",
                write_exact(factor),
                write_exact(&witness.rate),
            )
        };
        self.for_n_o.iter().filter_map(|found| found.bound.as_ref()).map(sentence).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_few_small_and_different() {
        assert_eq!(rate_counts(&[4, 0, 50, 4]), Ok(vec![0, 4, 50]));
        assert_eq!(rate_counts(&[]), Ok(Vec::new()));
        assert_eq!(rate_counts(&[1, 51]), Err(NoRatesOfClaim::Beyond(51)));
        assert_eq!(rate_counts(&[0, 1, 2, 3, 4, 5, 6, 7, 8]), Err(NoRatesOfClaim::TooMany(9)));
        assert!(rate_counts(&[7; 20]).is_ok());
    }
}
