//! At which harmonics the oscillators are (derivation, 14.7): at the first n_o, or at any finite set that contains 0.

use super::document::Value;
use super::error::{ErrorKind, Errors, Reported};
use super::object::choose;
use super::period::Period;
use std::fmt;
use thiserror::Error;

/// Of which oscillators a claim is to be: `harmonics` of the internal model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AskedHarmonics {
    /// At the first n_o harmonics, for every n_o.
    First,
    /// At every finite set of harmonics that contains 0.
    EverySet,
}

/// Reads `harmonics`; `period`, where it was read, is held against it.
///
/// # Errors
/// A text that is neither `first` nor `every-set`; the latter with a period that is known to an interval.
pub(super) fn read_asked(
    value: &Value<'_>,
    period: Option<&Period>,
    errors: &mut Errors,
) -> Result<AskedHarmonics, Reported> {
    if value.text().is_none() {
        let error = value
            .error(ErrorKind::Type, format!("{} says of which sets of harmonics the claim is to be", value.name()));
        let help = "write `\"every-set\"`, and name the set of a regulator with `--harmonics`";
        return Err(errors.report(error.expected("expected `first` or `every-set`").help(help)));
    }
    if choose(value, "set of harmonics", &["first", "every-set"], errors)? == "first" {
        return Ok(AskedHarmonics::First);
    }
    match period.and_then(Period::interval) {
        None => Ok(AskedHarmonics::EverySet),
        Some(_) => {
            let message = "of a period that is known to an interval it is proved for the first n_o harmonics alone";
            let help = "write `first`, or leave `harmonics` out";
            Err(errors.report(value.error(ErrorKind::Range, message).help(help)))
        }
    }
}

/// Oscillators at a finite set of harmonics that contains 0, that of the integrator.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Oscillators {
    /// The harmonics of the oscillators, rising, without 0.
    beyond_mean: Vec<u32>,
}

/// Why numbers are no such set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum NoSet {
    /// Without 0 there is no integrator.
    #[error("0 is not among the harmonics: without it there is no integrator, and no claim is about such a regulator")]
    WithoutZero,
    /// A number stands twice.
    #[error("harmonic {0} is there twice")]
    Twice(u32),
}

impl Oscillators {
    /// The first n_o harmonics.
    #[must_use]
    pub fn first(n_o: u32) -> Oscillators {
        Oscillators { beyond_mean: (1..=n_o).collect() }
    }

    /// The set of these harmonics, in any order.
    ///
    /// # Errors
    /// A list without 0, and a number that is there twice.
    pub fn at(harmonics: &[u32]) -> Result<Oscillators, NoSet> {
        let mut sorted = harmonics.to_vec();
        sorted.sort_unstable();
        if let Some(pair) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(NoSet::Twice(pair[0]));
        }
        match sorted.first() {
            Some(0) => Ok(Oscillators { beyond_mean: sorted.split_off(1) }),
            _ => Err(NoSet::WithoutZero),
        }
    }

    /// The harmonics of the oscillators, rising, without 0.
    #[must_use]
    pub fn beyond_mean(&self) -> &[u32] {
        &self.beyond_mean
    }

    /// All harmonics, 0 the first.
    pub fn all(&self) -> impl Iterator<Item = u32> + '_ {
        std::iter::once(0).chain(self.beyond_mean.iter().copied())
    }

    /// How many oscillators there are, beside the integrator.
    #[must_use]
    pub fn count(&self) -> usize {
        self.beyond_mean.len()
    }

    /// The largest harmonic.
    #[must_use]
    pub fn largest(&self) -> u32 {
        self.beyond_mean.last().copied().unwrap_or(0)
    }

    /// Whether k is one of the harmonics.
    #[must_use]
    pub fn has(&self, k: u32) -> bool {
        k == 0 || self.beyond_mean.binary_search(&k).is_ok()
    }

    /// Whether harmonic k of a signal meets an oscillator: [`Oscillators::has`] of an index.
    #[must_use]
    pub fn meets(&self, k: usize) -> bool {
        u32::try_from(k).is_ok_and(|k| self.has(k))
    }

    /// `k_H = min{k >= 1 : k not in H}` (derivation, 14.7).
    #[must_use]
    pub fn first_missing(&self) -> u32 {
        (1..)
            .zip(&self.beyond_mean)
            .find(|(k, own)| k != *own)
            .map_or_else(|| self.largest().saturating_add(1), |(k, _)| k)
    }

    /// n_o, where they are at the first n_o harmonics.
    #[must_use]
    pub fn n_o(&self) -> Option<u32> {
        (self.largest() as usize == self.count()).then(|| self.largest())
    }
}

impl From<u32> for Oscillators {
    fn from(n_o: u32) -> Oscillators {
        Oscillators::first(n_o)
    }
}

impl fmt::Display for Oscillators {
    /// `n_o = 3`, or `oscillators at the harmonics 0, 1, 5`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.n_o() {
            Some(n_o) => write!(f, "n_o = {n_o}"),
            None => {
                let all: Vec<String> = self.all().map(|k| k.to_string()).collect();
                write!(f, "oscillators at the harmonics {}", all.join(", "))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_contains_0_and_nothing_twice() {
        let set = Oscillators::at(&[5, 0, 1]).unwrap();
        assert_eq!(set.all().collect::<Vec<_>>(), [0, 1, 5]);
        assert_eq!((set.count(), set.largest(), set.first_missing(), set.n_o()), (2, 5, 2, None));
        assert!(set.has(0) && set.has(5) && !set.has(2) && !set.has(6));
        assert_eq!(set.to_string(), "oscillators at the harmonics 0, 1, 5");
        assert_eq!(Oscillators::at(&[1, 5]), Err(NoSet::WithoutZero));
        assert_eq!(Oscillators::at(&[]), Err(NoSet::WithoutZero));
        assert_eq!(Oscillators::at(&[0, 5, 5]), Err(NoSet::Twice(5)));
        assert_eq!(Oscillators::at(&[0, 0]), Err(NoSet::Twice(0)));
    }

    #[test]
    fn the_first_harmonics_are_a_set() {
        for n_o in [0, 1, 4] {
            let first = Oscillators::first(n_o);
            assert_eq!(Oscillators::at(&first.all().collect::<Vec<_>>()).unwrap(), first);
            assert_eq!((first.n_o(), first.first_missing(), first.largest()), (Some(n_o), n_o + 1, n_o));
            assert_eq!(first.to_string(), format!("n_o = {n_o}"));
        }
        assert_eq!(Oscillators::at(&[0, 2]).unwrap().first_missing(), 1);
    }
}
