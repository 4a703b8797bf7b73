//! The transfer bound as a report: the certified pair, how much of it each n_o uses, and what the paper printed.

mod figure;
mod json;
mod printed;
mod sections;
mod sets;

pub use figure::transfer_figure;
pub use json::pair_failure_json;

use serde_json::Value;
use sigmastar_document::{Block, Readable, clean};
use sigmastar_theory::transfer::TransferStudy;

/// What is found of the transfer bound of a specification; what is only an estimate says so.
pub struct TransferReport<'s>(pub &'s TransferStudy<'s>);

impl Readable for TransferReport<'_> {
    fn blocks(&self) -> Vec<Block> {
        let TransferStudy { data, pair, uniformity, trade_off, matched, every_set, printed } = self.0;
        let mut blocks = vec![Block::Title(format!("{}: transfer bound", clean(&data.spec.name)))];
        blocks.extend(sections::pair(data, pair));
        blocks.extend(every_set.iter().flat_map(|sets| sets::section(self.0, sets)));
        blocks.extend(sections::uniformity(uniformity));
        blocks.push(Block::Drawing(transfer_figure(self.0)));
        blocks.push(Block::Detail);
        blocks.extend(sections::trade_off(data, trade_off));
        blocks.extend(matched.iter().flat_map(|matched| sections::matched(data, matched)));
        blocks.extend(printed::section(printed, data, pair));
        blocks
    }

    /// As JSON: `{"format": "sigmastar/transfer", "version": 1, ...}`.
    fn json(&self) -> Value {
        json::report(self.0)
    }
}
