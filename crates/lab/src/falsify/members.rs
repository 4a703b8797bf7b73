//! Which member of a family a trial is about, and with which gain of the actuator (derivation, 13.1 and 13.2): the corners first,
//! then the inside.

use super::claim::TriedClaim;
use super::random::Random;
use rug::Rational;
use sigmastar_exact::number::{Direction, round_f64, write_exact};
use sigmastar_lang::spec::{Constant, nearest};
use std::borrow::Cow;
use thiserror::Error;

/// Significant digits of a value that is drawn inside.
const DIGITS: u32 = 9;

/// What differs from one member of a family to another.
#[derive(Clone, Debug, Default)]
pub(super) struct Member {
    /// The parameters with intervals, in the order of the plant.
    values: Vec<Rational>,
    /// The true gain of the actuator, of a claim for an interval of them.
    pub(super) input_gain: Option<f64>,
}

/// A value of a parameter for which there is no claim.
#[derive(Debug, Error)]
pub enum ParameterError {
    /// No interval of this name.
    #[error("the claim is about no interval of a parameter `{name}`")]
    Unknown {
        /// The name.
        name: String,
        /// The intervals that there are.
        known: Vec<String>,
    },
    /// A value outside.
    #[error("the value of `{name}` is outside of [{low}, {high}]: nothing is claimed there")]
    Outside {
        /// The name.
        name: String,
        /// The least value of the claim.
        low: String,
        /// The largest.
        high: String,
    },
}

impl ParameterError {
    /// What to try.
    #[must_use]
    pub fn help(&self) -> String {
        match self {
            ParameterError::Unknown { known, .. } if known.is_empty() => {
                "leave --parameter out: this claim has no parameters in intervals".to_owned()
            }
            ParameterError::Unknown { name, known } => match nearest(name, known.iter().map(String::as_str)) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("the intervals are those of {}", known.join(", ")),
            },
            ParameterError::Outside { .. } => "choose a value inside, or see with `simulate` what happens".to_owned(),
        }
    }
}

impl TriedClaim {
    /// This claim, tried with these values of parameters alone.
    ///
    /// # Errors
    /// [`ParameterError`].
    pub fn with_parameters(mut self, given: &[(String, Rational)]) -> Result<TriedClaim, ParameterError> {
        let parameters = self.own.as_ref().map(|own| own.plant.parameters.clone()).unwrap_or_default();
        self.chosen.resize(parameters.intervals().count(), None);
        for (name, value) in given {
            let Some((at, (_, interval))) = parameters.named_intervals().enumerate().find(|(_, (own, _))| own == name)
            else {
                let known = parameters.named_intervals().map(|(name, _)| name.to_owned()).collect();
                return Err(ParameterError::Unknown { name: name.clone(), known });
            };
            if *value < interval.low || *value > interval.high {
                let [low, high] = [&interval.low, &interval.high].map(write_exact);
                return Err(ParameterError::Outside { name: name.clone(), low, high });
            }
            self.chosen[at] = Some(value.clone());
        }
        Ok(self)
    }

    /// The member of a trial. Trials 1, 2, ... are about the corners, the gain of the actuator changing first; the others are drawn inside.
    pub(super) fn member(&self, number: u64, random: &mut Random) -> Member {
        let gain = self.spec.input_gain.as_ref();
        let parameters = self.own.as_ref().map(|own| &own.plant.parameters);
        let intervals: Vec<_> = parameters.into_iter().flat_map(|all| all.intervals()).collect();
        let chosen = |at: usize| self.chosen.get(at).and_then(Option::as_ref);
        // The clock of a plant is among its intervals; plants that are drawn have a period of their own.
        let drawn = usize::from(self.own.is_none() && self.spec.period.interval().is_some());
        let free =
            (0..intervals.len()).filter(|at| chosen(*at).is_none()).count() + usize::from(gain.is_some()) + drawn;
        let mut bits = number.saturating_sub(1);
        let is_corner = free < 63 && bits < 1 << free;
        let mut next_bit = || {
            let bit = bits & 1 == 1;
            bits >>= 1;
            bit
        };
        // Between the ends, which may depend on the values of the parameters.
        let share = gain.map(|_| match is_corner {
            true => f64::from(u8::from(next_bit())),
            false => random.uniform(),
        });
        let values = intervals.iter().enumerate().map(|(at, interval)| match chosen(at) {
            Some(value) => value.clone(),
            None if is_corner => (if next_bit() { &interval.high } else { &interval.low }).clone(),
            None => {
                let [low, high] = [&interval.low, &interval.high].map(Rational::to_f64);
                let drawn = round_f64(low + (high - low) * random.uniform(), DIGITS, Direction::Nearest);
                // Rounding may lead out of a narrow interval.
                drawn.unwrap_or_else(|| interval.nominal.clone()).clamp(&interval.low, &interval.high)
            }
        });
        let values: Vec<Rational> = values.collect();
        let input_gain = gain.zip(share).map(|(gain, share)| {
            let [low, high] = gain.ends_at(&values).map(|end| end.to_f64());
            if share == 1.0 { high } else { low + (high - low) * share }
        });
        Member { values, input_gain }
    }

    /// The period of a trial of drawn plants, of a claim for an interval of them: the ends with both of the input gain first, then inside.
    pub(super) fn period(&self, number: u64, random: &mut Random) -> Option<Constant> {
        let [shortest, longest] = self.spec.period.interval()?;
        match number.saturating_sub(1) >> u32::from(self.spec.input_gain.is_some()) {
            0 => Some(shortest.clone()),
            1 => Some(longest.clone()),
            _ => {
                let (low, high) = (shortest.to_f64(), longest.to_f64());
                Rational::from_f64(low + (high - low) * random.uniform()).map(|period| Constant::rational(&period))
            }
        }
    }

    /// The claim about this member of the family alone.
    pub(super) fn about(&self, member: &Member) -> Cow<'_, TriedClaim> {
        if member.values.is_empty() {
            return Cow::Borrowed(self);
        }
        let mut claim = self.clone();
        claim.own = self.own.as_ref().map(|own| own.member(&member.values));
        Cow::Owned(claim)
    }

    /// The values of a member under the names of its parameters, exactly.
    pub(super) fn named(&self, member: &Member) -> Vec<(String, String)> {
        let Some(own) = &self.own else { return Vec::new() };
        let names = own.plant.parameters.named_intervals().map(|(name, _)| name.to_owned());
        names.zip(member.values.iter().map(write_exact)).collect()
    }
}
