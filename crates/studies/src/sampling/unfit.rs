//! What cannot be asked about samples.

use sigmastar_lang::spec::{Constant, MAX_SAMPLES};
use thiserror::Error;

/// Why there is nothing to certify for a question about samples.
#[derive(Clone, Debug, Error)]
pub enum Unfit {
    /// The base frequency is not asserted to be 2 pi / period.
    #[error("the regulator at samples needs a base frequency of 2 pi / period")]
    NotMatched,
    /// A sampling period of which the period is no whole multiple.
    #[error("the period {} is no whole multiple, from 2 to {MAX_SAMPLES}, of the sampling period {step}", .period.text)]
    NoWholeMultiple {
        /// The period.
        period: Constant,
        /// The sampling period, as it is written.
        step: String,
    },
}

impl Unfit {
    /// What to do about it.
    #[must_use]
    pub fn help(&self) -> String {
        match self {
            Unfit::NotMatched => "set `\"matched\": true` in the internal model, with that base frequency".to_owned(),
            Unfit::NoWholeMultiple { period, .. } => {
                let share = period.divided_by(100).map_or_else(String::new, |share| share.text);
                format!("write fractions of the period, such as `{share}`")
            }
        }
    }
}
