//! Which values a case has: a full grid, or a Latin hypercube.

use super::values::{Scalar, Values};
use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use rug::Rational;

/// Places within a stratum: a drawn share is a decimal fraction of a stratum, so that values stay short.
const PLACES: u64 = 1000;

/// How the values are combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Design {
    /// Every combination; the last parameter changes fastest.
    Grid,
    /// In each of `count` equal parts of each parameter one value, combined at random.
    Latin {
        /// The number of cases.
        count: u32,
        /// The seed of the random numbers.
        seed: u64,
    },
}

/// The values of all parameters, from which a case takes its own.
#[derive(Clone, Debug)]
pub(super) struct Combinations {
    levels: Vec<Vec<Scalar>>,
    grid: bool,
}

impl Combinations {
    /// The combinations of a design; the index of a parameter whose values coincide after rounding otherwise.
    pub(super) fn new(design: Design, values: &[&Values]) -> Result<Combinations, usize> {
        let level = |(index, values): (usize, &&Values)| {
            let levels = match design {
                Design::Grid => values.levels(),
                Design::Latin { count, seed } => latin(values, count, Source::new(seed, index as u64)),
            };
            levels.ok_or(index)
        };
        let levels = values.iter().enumerate().map(level).collect::<Result<_, _>>()?;
        Ok(Combinations { levels, grid: design == Design::Grid })
    }

    /// How many there are. The reader has refused more than the limit on cases.
    pub(super) fn count(&self) -> u64 {
        let sizes = self.levels.iter().map(|levels| levels.len() as u64);
        if self.grid { sizes.product() } else { sizes.min().unwrap_or(0) }
    }

    /// The values of a case.
    pub(super) fn case(&self, index: u64) -> Vec<&Scalar> {
        let mut rest = index;
        let mut values: Vec<&Scalar> = self
            .levels
            .iter()
            .rev()
            .filter_map(|levels| {
                let size = levels.len() as u64;
                let at = if self.grid { rest % size } else { index };
                rest /= size;
                levels.get(usize::try_from(at).ok()?)
            })
            .collect();
        values.reverse();
        values
    }
}

/// One value in each of `count` parts of the range, in a random order.
fn latin(values: &Values, count: u32, mut random: Source) -> Option<Vec<Scalar>> {
    let places = PLACES * u64::from(count);
    let draw = |stratum: u32| Rational::from((PLACES * u64::from(stratum) + random.below(PLACES), places));
    let shares: Vec<Rational> = (0..count).map(draw).collect();
    let mut drawn = values.at(shares.into_iter())?;
    // Fisher and Yates.
    for last in (1..drawn.len()).rev() {
        drawn.swap(last, random.below(last as u64 + 1) as usize);
    }
    Some(drawn)
}

/// The random numbers of one parameter: the same on every machine.
struct Source(Xoshiro256PlusPlus);

impl Source {
    /// Seeds and parameters are mixed, so that neighbours share nothing.
    fn new(seed: u64, parameter: u64) -> Source {
        Source(Xoshiro256PlusPlus::seed_from_u64(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ parameter))
    }

    /// A whole number below `bound`; uneven by less than bound/2^64.
    fn below(&mut self, bound: u64) -> u64 {
        ((u128::from(self.0.next_u64()) * u128::from(bound)) >> 64) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::super::values::Range;
    use super::*;

    fn list(texts: &[&str]) -> Values {
        Values::List(texts.iter().map(|text| Scalar((*text).into())).collect())
    }

    fn texts(all: &Combinations) -> Vec<String> {
        (0..all.count())
            .map(|case| all.case(case).iter().map(|value| value.text()).collect::<Vec<_>>().join(" "))
            .collect()
    }

    #[test]
    fn a_grid_has_every_combination_once() {
        let grid = Combinations::new(Design::Grid, &[&list(&["1", "2"]), &list(&["a", "b", "c"])]).unwrap();
        assert_eq!(texts(&grid), ["1 a", "1 b", "1 c", "2 a", "2 b", "2 c"]);
    }

    #[test]
    fn a_latin_hypercube_has_one_value_in_each_part() {
        let range = Range { from: Rational::new(), to: Rational::from(10), count: 10 };
        let (linear, list) = (Values::Linear(range), list(&["a", "b"]));
        let design = |seed| Combinations::new(Design::Latin { count: 10, seed }, &[&linear, &linear, &list]).unwrap();
        let all = design(7);
        assert_eq!(all.count(), 10);
        for parameter in 0..2 {
            let mut parts: Vec<u32> =
                (0..10).map(|case| all.case(case)[parameter].text().parse::<f64>().unwrap() as u32).collect();
            assert!(!parts.is_sorted());
            parts.sort_unstable();
            assert_eq!(parts, (0..10).collect::<Vec<_>>());
        }
        let halves = (0..10).filter(|case| all.case(*case)[2].text() == "a").count();
        assert_eq!(halves, 5);
        assert_eq!(texts(&all), texts(&design(7)));
        assert_ne!(texts(&all), texts(&design(8)));
    }
}
