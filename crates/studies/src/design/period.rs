//! The longest sampling period that is certified with a gain of a design table.

use crate::sampling::{Asked, SamplingStudy};
use rug::Rational;
use sigmastar_lang::spec::Sampling;

/// Sampling periods with which the regulator at samples is certified, for every number of oscillators, with the gain of a row. Each is a claim of its own.
#[derive(Clone, Debug)]
pub struct LongestPeriod {
    /// The longest that was found.
    pub longest: Sampling,
    /// The longest round one, where one was found.
    pub round: Option<Sampling>,
}

impl LongestPeriod {
    /// Of a study that was asked about this gain; `None` where nothing is certified with it.
    #[must_use]
    pub fn of(study: &SamplingStudy, sigma: &Rational) -> Option<LongestPeriod> {
        let of_gain = study.by_gain.iter().find(|row| matches!(&row.asked, Asked::Gain(asked) if asked == sigma))?;
        let longest = of_gain.found.as_ref().ok()?.sampling.clone();
        let round = study.round.iter().find(|row| matches!(&row.asked, Asked::Round(asked, _) if asked == sigma));
        let round = round.and_then(|row| row.found.as_ref().ok()).map(|pair| pair.sampling.clone());
        Some(LongestPeriod { longest, round })
    }

    /// The round one where there is one, as it is written in a file.
    #[must_use]
    pub fn text(&self) -> String {
        self.round.as_ref().unwrap_or(&self.longest).text()
    }
}
