//! The loop at samples in words.

use super::digital_loop::DigitalLoop;
use crate::simulate::figures::regulator_words;
use crate::simulate::report::number;

/// The regulator with its law at samples.
pub(super) fn loop_words(digital: &DigitalLoop) -> String {
    format!("{}, at samples h = {}", regulator_words(&digital.regulator), number(digital.step()))
}

/// What stands between the law and the plant; nothing where that is nothing.
pub(super) fn converter_words(digital: &DigitalLoop) -> Vec<String> {
    let mut words = Vec::new();
    let converters = &digital.converters;
    if converters.delay > 0.0 {
        words.push(format!("each control acts {} after its sample", number(converters.delay)));
    }
    if let Some(quantum) = converters.measured {
        words.push(format!("e is measured in multiples of {}", number(quantum)));
    }
    if let Some(quantum) = converters.put_out {
        words.push(format!("u is put out in multiples of {}", number(quantum)));
    }
    if let Some(limit) = digital.discrete.saturation {
        words.push(format!("u is clipped to |u| <= {}", number(limit)));
    }
    words
}
