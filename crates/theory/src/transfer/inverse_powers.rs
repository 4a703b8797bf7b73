//! The powers l^-p of the integers, for sums over many poles.

use rug::Float;
use rug::float::Round;
use rug::ops::Pow;
use sigmastar_exact::enclosure::Enclosure;
use std::borrow::Cow;
use std::sync::OnceLock;

/// log2 of the size of the first block that is kept.
const FIRST_BLOCK: u32 = 6;
/// log2 of the number of powers that are kept.
const KEPT: u32 = 16;

/// l^-p for one p > 0. Powers below 2^16 are kept, in blocks that double in size and are filled when first asked for.
///
/// l^-p is completely multiplicative, so only primes cost a power; a composite number is a product of at most log2(l)
/// factors and loses as many units in the last place.
#[derive(Debug)]
pub(super) struct InversePowers {
    exponent: Enclosure,
    blocks: Vec<OnceLock<Vec<Enclosure>>>,
}

impl InversePowers {
    /// Prepares the powers for an exponent, at its precision.
    pub(super) fn new(exponent: Enclosure) -> InversePowers {
        let blocks = (FIRST_BLOCK..=KEPT).map(|_| OnceLock::new()).collect();
        InversePowers { exponent, blocks }
    }

    /// p.
    pub(super) fn exponent(&self) -> &Enclosure {
        &self.exponent
    }

    /// l^-p for l >= 1. Guarantee: holds for every p in the enclosure of the exponent.
    pub(super) fn get(&self, l: u64) -> Cow<'_, Enclosure> {
        // Block 0 is [0, 2^6), block b >= 1 is [2^(b+5), 2^(b+6)).
        let block = (u64::BITS - l.leading_zeros()).saturating_sub(FIRST_BLOCK) as usize;
        match self.blocks.get(block) {
            Some(cell) => {
                let powers = cell.get_or_init(|| self.fill(block as u32));
                let first = if block == 0 { 0 } else { 1 << (block as u32 + FIRST_BLOCK - 1) };
                powers.get((l - first) as usize).map_or_else(|| Cow::Owned(self.power(l)), Cow::Borrowed)
            }
            None => Cow::Owned(self.power(l)),
        }
    }

    fn fill(&self, block: u32) -> Vec<Enclosure> {
        if block == 0 {
            // The entry 0 stands for no power and is never multiplied.
            let mut powers = vec![Enclosure::undefined(self.exponent.precision())];
            for l in 1..1_u64 << FIRST_BLOCK {
                let power = match smallest_factor(l) {
                    Some(factor) => &powers[factor as usize] * &powers[(l / factor) as usize],
                    None => self.power(l),
                };
                powers.push(power);
            }
            return powers;
        }
        // Both factors of a composite number lie in earlier blocks.
        let first = 1_u64 << (block + FIRST_BLOCK - 1);
        let one = |l: u64| match smallest_factor(l) {
            Some(factor) => self.get(factor).as_ref() * self.get(l / factor).as_ref(),
            None => self.power(l),
        };
        (first..2 * first).map(one).collect()
    }

    /// l^-p, l >= 1, by itself: two correctly rounded powers, since it does not increase in p.
    pub(super) fn power(&self, l: u64) -> Enclosure {
        let precision = self.exponent.precision().max(u64::BITS);
        let base = Float::with_val(precision, l);
        let at = |p: &Float, round| {
            Float::with_val_round(precision, Pow::pow(&base, &Float::with_val(p.prec(), -p)), round).0
        };
        Enclosure::new(at(&self.exponent.upper(), Round::Down), at(&self.exponent.lower(), Round::Up))
    }
}

/// The smallest prime factor of a composite number, `None` for 0, 1 and primes.
fn smallest_factor(l: u64) -> Option<u64> {
    (2..l).take_while(|factor| factor * factor <= l).find(|factor| l.is_multiple_of(*factor))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rug::Rational;

    #[test]
    fn powers_contain_the_truth_and_are_narrow() {
        let p = Enclosure::from_rational(&Rational::from((7, 5)), 160);
        let powers = InversePowers::new(p);
        let finer = Enclosure::from_rational(&Rational::from((-7, 5)), 400);
        for l in (1..200).chain([255, 256, 257, 4096, 30030, 65535, 65536, 65537, 1 << 40, u64::MAX]) {
            let value = powers.get(l).into_owned();
            let truth = Enclosure::from_rational(&Rational::from(l), 400).pow(&finer);
            assert!(value.lower() <= truth.lower() && truth.upper() <= value.upper(), "{l}");
            let width = Float::with_val(64, value.upper() - value.lower()) / value.lower();
            assert!(width < 2f64.powi(-148), "{l}: {width}");
        }
    }

    #[test]
    fn smallest_factors() {
        let found: Vec<_> = [0, 1, 2, 3, 4, 9, 35, 97, 65535].map(smallest_factor).into();
        assert_eq!(found, [None, None, None, None, Some(2), Some(3), Some(5), None, Some(3)]);
    }
}
