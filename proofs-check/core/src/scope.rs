//! Rule: which oscillators a claim is about (docs/mathematics.md, section 14.7).
//!
//! Guarantee: a claim names every set exactly where it is about every set, in the words of its regulator. It does if the file asks for it, does
//! not if the file says `first`, and may otherwise, but for a period that is an interval.

use crate::json::Field;
use crate::period::Period;
use crate::verdict::{Outcome, bad, invalid};

/// The name of the rule.
pub const RULE: &str = "oscillators";

/// What a claim says of them in continuous time, and at samples.
const SETS: [&str; 2] = ["every finite set that contains 0", "every set below samples/2 that contains 0"];

/// The sets of harmonics at which the oscillators may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// 0, 1, ..., n_o, for every n_o.
    First,
    /// Every finite set that contains 0, at samples below half of them.
    EverySet,
}

impl Scope {
    /// Reads `harmonics` of `internal_model`; nothing is proved of every set for every period of an interval.
    pub fn read(field: &Field<'_>, period: &Period) -> Outcome<Scope> {
        match field.text()? {
            "first" => Ok(Scope::First),
            "every-set" => period.demand_exact(&field.pointer, "`every-set`").map(|_| Scope::EverySet),
            _ => bad(&field.pointer, "expected `first` or `every-set`"),
        }
    }

    /// That of a claim, which has this field or none.
    pub fn of_claim(claimed: Option<&Field<'_>>) -> Scope {
        if claimed.is_some() { Scope::EverySet } else { Scope::First }
    }

    /// What a claim is about, after `for`; `samples`: how many there are in a period, of a regulator at samples.
    pub fn in_words(self, samples: Option<u32>) -> String {
        let (sets, numbers) = match samples {
            None => ("finite set of harmonics".to_owned(), "n_o >= 0".to_owned()),
            Some(samples) => (format!("set of harmonics below {samples}/2"), format!("n_o < {samples}/2")),
        };
        let first = format!("every number of oscillators {numbers}");
        match self {
            Scope::First => first,
            Scope::EverySet => format!("oscillators at every {sets} that contains 0 (so for {first})"),
        }
    }
}

/// That the field `harmonics` of a claim, if it has one, is what the file lets it be.
pub fn agrees(
    (asked, period): (Option<Scope>, &Period),
    (claimed, at_samples): (Option<&Field<'_>>, bool),
    claim: &str,
) -> Outcome<()> {
    let Some(field) = claimed else {
        return match asked {
            Some(Scope::EverySet) => invalid(RULE, claim, "`harmonics` is missing: the file asks for every set"),
            Some(Scope::First) | None => Ok(()),
        };
    };
    let expected = SETS[usize::from(at_samples)];
    if field.text()? != expected {
        return invalid(RULE, &field.pointer, format!("it should read: {expected}"));
    }
    if asked == Some(Scope::First) {
        return invalid(RULE, &field.pointer, "the file says that the claim is about the `first` harmonics");
    }
    if period.exact().is_none() {
        return invalid(RULE, &field.pointer, "of a period that is an interval nothing is proved for every set");
    }
    Ok(())
}
