//! Which oscillators a trial has: a number of them that is drawn, or sets of harmonics that were chosen.

use super::claim::TriedClaim;
use super::random::Random;
use super::sampled_claim::SampledClaim;
use sigmastar_lang::spec::Oscillators;
use thiserror::Error;

/// The numbers of oscillators that are tried.
const TRIED_N_O: [u32; 6] = [0, 1, 2, 3, 5, 8];

/// Oscillators for which there is no claim.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum OscillatorsError {
    /// A set with gaps, of a claim about the first n_o harmonics.
    #[error("the claim is about oscillators at the first n_o harmonics, and says nothing of {0}")]
    Gaps(Oscillators),
    /// A harmonic that the samples do not tell from another one.
    #[error("the claim is about harmonics below {samples}/2, half of the samples in a period, and {largest} is not")]
    BeyondSamples {
        /// The largest harmonic of the set.
        largest: u32,
        /// The samples in a period.
        samples: u32,
    },
}

impl OscillatorsError {
    /// What to try.
    #[must_use]
    pub fn help(&self) -> &'static str {
        match self {
            OscillatorsError::Gaps(_) => {
                "make the certificate with `\"harmonics\": \"every-set\"` in `internal_model`, or see with `simulate` what happens"
            }
            OscillatorsError::BeyondSamples { .. } => "take smaller harmonics",
        }
    }
}

impl TriedClaim {
    /// This claim, tried with oscillators at these sets of harmonics alone, one trial after the other; none chooses nothing.
    ///
    /// # Errors
    /// [`OscillatorsError`].
    pub fn with_oscillators(mut self, sets: &[Oscillators]) -> Result<TriedClaim, OscillatorsError> {
        for set in sets {
            if !self.every_set && set.n_o().is_none() {
                return Err(OscillatorsError::Gaps(set.clone()));
            }
            if let Some(SampledClaim { samples, .. }) = self.sampled
                && 2 * u64::from(set.largest()) >= u64::from(samples)
            {
                return Err(OscillatorsError::BeyondSamples { largest: set.largest(), samples });
            }
        }
        self.sets = sets.to_vec();
        Ok(self)
    }

    /// The oscillators of a trial in continuous time: of the chosen sets the next one, else a number that is drawn.
    pub(super) fn oscillators(&self, number: u64, random: &mut Random) -> Oscillators {
        if let Some(chosen) = in_turn(&self.sets, number) {
            return chosen.clone();
        }
        let all = self.tried_n_o(&TRIED_N_O);
        Oscillators::first(all[random.whole(0, all.len() as u32 - 1) as usize])
    }

    /// Those of a trial of the law at samples: of the chosen sets, or of the numbers that are tried, the next one.
    pub(super) fn oscillators_at_samples(&self, law: &SampledClaim, number: u64) -> Oscillators {
        match in_turn(&self.sets, number) {
            Some(chosen) => chosen.clone(),
            // From the first trial on, so that the ends are tried whatever the number of trials is.
            None => Oscillators::first(in_turn(&law.tried_n_o(), number).copied().unwrap_or(0)),
        }
    }
}

/// The flag that chooses a set.
pub(super) fn harmonics_flag(set: &Oscillators) -> String {
    let all: Vec<String> = set.all().map(|k| k.to_string()).collect();
    format!("--harmonics {}", all.join(","))
}

/// What trial `number`, from 1, has of a list that begins again at its end.
fn in_turn<T>(all: &[T], number: u64) -> Option<&T> {
    all.get((number.saturating_sub(1) % all.len().max(1) as u64) as usize)
}
