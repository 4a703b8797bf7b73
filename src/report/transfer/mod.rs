//! The transfer bound as a report: the certified pair, how much of it each n_o uses, and what the paper printed.

mod json;
mod plot;
mod printed;
mod sections;

use super::document::{Block, Readable, clean};
use crate::transfer::{OscillatorCount, TransferStudy};
use serde_json::Value;

/// The report on the transfer bound of a specification.
pub struct TransferReport<'s> {
    study: TransferStudy<'s>,
}

impl<'s> TransferReport<'s> {
    /// The report; what is only an estimate says so.
    #[must_use]
    pub fn new(study: TransferStudy<'s>) -> TransferReport<'s> {
        TransferReport { study }
    }

    /// T_N under the envelope as an SVG picture, for the n_o of the table.
    ///
    /// # Errors
    /// The plotting library's reason, as text.
    pub fn plot(&self) -> Result<String, String> {
        let counts: Vec<OscillatorCount> = self.study.uniformity.iter().map(|entry| entry.sup.n_o).collect();
        plot::svg(&self.study.data, &self.study.pair, &counts)
    }
}

impl Readable for TransferReport<'_> {
    fn blocks(&self) -> Vec<Block> {
        let TransferStudy { data, pair, uniformity, trade_off, matched, printed } = &self.study;
        let mut blocks = vec![Block::Title(format!("{}: transfer bound", clean(&data.spec.name)))];
        blocks.extend(sections::pair(data, pair));
        blocks.extend(sections::uniformity(uniformity));
        blocks.extend(sections::trade_off(data, trade_off));
        blocks.extend(matched.iter().flat_map(|matched| sections::matched(data, matched)));
        blocks.extend(printed::section(printed, data, pair));
        blocks
    }

    /// As JSON: `{"format": "sigmastar/transfer", "version": 1, ...}`.
    fn json(&self) -> Value {
        json::report(&self.study)
    }
}
