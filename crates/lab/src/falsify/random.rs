//! Random numbers for plants.

use super::shape::Number;
use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use sigmastar_exact::number::Portable;

/// The source of a trial: the same seed and number give the same plant on every machine.
#[derive(Clone, Debug)]
pub struct Random(Xoshiro256PlusPlus);

impl Random {
    /// The source of trial `number`. Seeds and numbers are mixed, so that neighbouring trials share nothing.
    #[must_use]
    pub fn new(seed: u64, number: u64) -> Random {
        Random(Xoshiro256PlusPlus::seed_from_u64(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ number))
    }

    /// A number from 0 to 1.
    pub(super) fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * 2.0_f64.portable_powi(-53)
    }

    /// Whether something of this probability happens.
    pub(super) fn chance(&mut self, probability: f64) -> bool {
        self.uniform() < probability
    }

    /// A whole number from `low` to `high`, both included.
    pub(super) fn whole(&mut self, low: u32, high: u32) -> u32 {
        low + (self.uniform() * f64::from(high - low + 1)) as u32
    }

    /// A share of what is allowed: all of it in a third of the cases.
    pub(super) fn share(&mut self) -> f64 {
        (1.5 * self.uniform()).min(1.0)
    }

    /// A vector with a norm of at most 1, and hardly less.
    pub(super) fn direction(&mut self, n: usize) -> Vec<Number> {
        loop {
            let parts: Vec<f64> = (0..n).map(|_| 2.0 * self.uniform() - 1.0).collect();
            let norm = parts.iter().map(|part| part * part).sum::<f64>().sqrt();
            if n == 0 || norm > 0.1 {
                // Nine digits are exact to 5e-9.
                return parts.iter().map(|part| Number::new(part / norm * (1.0 - 1e-7))).collect();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_and_whole_numbers() {
        let mut random = Random::new(1, 2);
        let mut seen = [0; 4];
        for _ in 0..200 {
            for n in 0..4 {
                let norm = random.direction(n).iter().map(|part| part.value().powi(2)).sum::<f64>().sqrt();
                assert!(n == 0 || (1.0 - 1e-6 < norm && norm < 1.0), "{norm}");
            }
            seen[random.whole(0, 3) as usize] += 1;
            assert!((0.0..=1.0).contains(&random.share()));
        }
        assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
    }
}
