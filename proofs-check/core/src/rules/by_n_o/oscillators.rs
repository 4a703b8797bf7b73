//! At which harmonics the oscillators are that something is said of: at the first n_o, or at those of a set (docs/mathematics.md, section 14.7).
//!
//! Guarantee: they are in rising order, each once, 0 is among them, and none is above 100.

use crate::json::{Field, Fields};
use crate::verdict::{Outcome, bad, demand};

/// The largest n_o, and the largest harmonic of a set.
const LARGEST: u32 = 100;

/// The fields in which they stand.
const NUMBER: &str = "n_o";
const SET: &str = "harmonics";

/// The harmonics.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Oscillators {
    harmonics: Vec<u32>,
    /// Whether they are named one by one.
    are_named: bool,
}

impl Oscillators {
    /// 0, 1, ..., n_o.
    pub fn first(n_o: u32) -> Oscillators {
        Oscillators { harmonics: (0..=n_o).collect(), are_named: false }
    }

    /// Takes them out of an object: the set `harmonics`, or `n_o`.
    pub fn take(fields: &mut Fields<'_>) -> Outcome<Oscillators> {
        if let Some(set) = fields.part(SET, Oscillators::read_set)? {
            return Ok(set);
        }
        let field = fields.required(NUMBER)?;
        let n_o = field.whole()?;
        if n_o > LARGEST {
            bad(&field.pointer, format!("expected at most {LARGEST}"))
        } else {
            Ok(Oscillators::first(n_o))
        }
    }

    /// Reads a set.
    pub fn read_set(field: &Field<'_>) -> Outcome<Oscillators> {
        let list = field.elements()?;
        if list.is_empty() || list.len() > LARGEST as usize + 1 {
            return bad(&field.pointer, format!("expected 1 to {} harmonics", LARGEST + 1));
        }
        let mut harmonics = Vec::new();
        for field in list {
            let k = field.whole()?;
            match harmonics.last() {
                None if k != 0 => return bad(&field.pointer, "expected 0, the first harmonic of a set"),
                Some(before) if k <= *before => {
                    return bad(&field.pointer, "expected each harmonic once, in rising order");
                }
                _ if k > LARGEST => return bad(&field.pointer, format!("expected at most {LARGEST}")),
                _ => harmonics.push(k),
            }
        }
        Ok(Oscillators { harmonics, are_named: true })
    }

    /// n_o, where they are the first ones.
    pub fn n_o(&self) -> Option<u32> {
        if self.are_named { None } else { self.harmonics.last().copied() }
    }

    /// The place of the field in which they stand in the object at this place.
    pub fn place(&self, pointer: &str) -> String {
        format!("{pointer}/{}", if self.are_named { SET } else { NUMBER })
    }

    /// Demands their place in a list behind those `before`: each n_o once, in rising order, and then each set once.
    pub fn demand_order<'o>(
        &self,
        before: impl Iterator<Item = &'o Oscillators> + Clone,
        pointer: &str,
    ) -> Outcome<()> {
        let wrong = match (before.clone().last().map(Oscillators::n_o), self.n_o()) {
            (Some(None), Some(_)) => Some("expected before the entries with `harmonics`"),
            (Some(Some(least)), Some(n_o)) if least >= n_o => Some("expected each n_o once, in rising order"),
            (_, None) if before.into_iter().any(|other| other == self) => Some("expected each set once"),
            _ => None,
        };
        wrong.map_or(Ok(()), |message| bad(&self.place(pointer), message))
    }

    /// Demands that so many samples in a period tell them apart: the largest harmonic is below half of them.
    pub fn demand_apart(&self, samples: u32, rule: &'static str, pointer: &str) -> Outcome<()> {
        let apart = 2 * self.largest() < samples;
        let what = || format!("{} is below {samples}/2: the samples tell these oscillators apart", self.largest());
        if apart { Ok(()) } else { demand(Some(false), rule, &self.place(pointer), what()) }
    }

    /// The largest harmonic.
    pub fn largest(&self) -> u32 {
        self.harmonics.last().copied().unwrap_or(0)
    }

    /// How many there are, the integrator among them: 2 states for each but that one.
    pub fn count(&self) -> usize {
        self.harmonics.len()
    }

    /// All of them, 0 first.
    pub fn harmonics(&self) -> &[u32] {
        &self.harmonics
    }

    /// Whether there is one at the harmonic k.
    pub fn contains(&self, k: usize) -> bool {
        u32::try_from(k).is_ok_and(|k| self.harmonics.binary_search(&k).is_ok())
    }

    /// k_H: the least k >= 1 without an oscillator.
    pub fn next(&self) -> u32 {
        let gap = (0..).zip(&self.harmonics).find(|(place, k)| place != *k).map(|(place, _)| place);
        gap.unwrap_or(self.harmonics.len() as u32)
    }

    /// As a claim says it of these alone.
    pub fn about(&self) -> String {
        self.in_words(false, None)
    }

    /// As a claim says it; `or_more`: of the first n_o, every larger number too, of which those below half of the samples count.
    pub fn in_words(&self, or_more: bool, samples: Option<u32>) -> String {
        match self.n_o() {
            Some(n_o) if or_more => {
                let below = samples.map_or_else(String::new, |samples| format!(" below {samples}/2"));
                format!("every n_o >= {n_o}{below}")
            }
            Some(n_o) => format!("n_o = {n_o}"),
            None => {
                let harmonics: Vec<String> = self.harmonics.iter().map(u32::to_string).collect();
                format!("oscillators at the harmonics {}", harmonics.join(", "))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::json::parse;

    fn read(text: &str) -> Result<Oscillators, String> {
        let json = parse(text.as_bytes()).unwrap();
        let read = Oscillators::read_set(&Field { json: &json, pointer: String::new() });
        read.map_err(|finding| finding.pointer)
    }

    #[test]
    fn what_is_in_a_set() {
        for (text, next) in [("[0]", 1), ("[0, 2]", 1), ("[0, 1, 5]", 2), ("[0, 1, 2, 3]", 4), ("[0, 100]", 1)] {
            let set = read(text).unwrap();
            assert_eq!((set.next(), set.n_o()), (next, None), "{text}");
            let within: Vec<usize> = (0..200).filter(|k| set.contains(*k)).collect();
            assert_eq!(format!("{within:?}"), text);
        }
        let first = Oscillators::first(3);
        assert_eq!((first.next(), first.n_o(), first.harmonics()), (4, Some(3), &[0, 1, 2, 3][..]));
        assert!(first != read("[0, 1, 2, 3]").unwrap());
        assert_eq!([false, true].map(|or_more| first.in_words(or_more, None)), ["n_o = 3", "every n_o >= 3"]);
        let at_samples = [false, true].map(|or_more| first.in_words(or_more, Some(9)));
        assert_eq!(at_samples, ["n_o = 3", "every n_o >= 3 below 9/2"]);
        assert_eq!(read("[0, 1, 5]").unwrap().in_words(false, Some(20)), "oscillators at the harmonics 0, 1, 5");
    }

    #[test]
    fn what_is_no_set() {
        for (text, place) in [
            ("[]", ""),
            ("3", ""),
            ("[1]", "/0"),
            ("[1, 0]", "/0"),
            ("[0, 5, 1]", "/2"),
            ("[0, 1, 1]", "/2"),
            ("[0, 0]", "/1"),
            ("[0, 101]", "/1"),
            ("[0, 1.5]", "/1"),
            ("[0, \"1\"]", "/1"),
            ("[-1, 0]", "/0"),
        ] {
            assert_eq!(read(text).unwrap_err(), place, "{text}");
        }
        let all = |count: u32| format!("{:?}", (0..count).collect::<Vec<_>>());
        assert!(read(&all(101)).is_ok());
        assert_eq!(read(&all(102)).unwrap_err(), "");
    }
}
