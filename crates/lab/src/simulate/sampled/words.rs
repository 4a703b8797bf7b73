//! The loop at samples in words.

use super::sampled_loop::SampledLoop;
use crate::simulate::figures::regulator_words;
use crate::simulate::report::number;

/// The regulator with its law at samples.
pub(super) fn loop_words(sampled: &SampledLoop) -> String {
    format!("{}, at samples $`h = {}`$", regulator_words(&sampled.regulator, sampled.period()), number(sampled.step()))
}

/// What stands between the law and the plant; nothing where that is nothing.
pub(super) fn converter_words(sampled: &SampledLoop) -> Vec<String> {
    let mut words = Vec::new();
    let converters = &sampled.converters;
    if sampled.discrete.prediction.is_some() {
        words.push(
            "each control is computed in the sample before the one in which it acts (delay_samples: 1)".to_owned(),
        );
    } else if converters.delay > 0.0 {
        words.push(format!("each control acts {} after its sample", number(converters.delay)));
    }
    if let Some(quantum) = converters.measured {
        words.push(format!("$`e`$ is measured in multiples of {}", number(quantum)));
    }
    if let Some(quantum) = converters.put_out {
        words.push(format!("$`u`$ is put out in multiples of {}", number(quantum)));
    }
    if let Some(limit) = sampled.discrete.saturation {
        words.push(format!("$`u`$ is clipped to $`|u| <= {}`$", number(limit)));
    }
    words
}
