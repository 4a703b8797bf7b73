//! The transfer bound as a report: the certified pair, how much of it each n_o uses, and what the paper printed.

mod figure;
mod json;
mod printed;
mod sections;

pub use figure::transfer_figure;
pub use json::pair_failure_json;

use super::document::{Block, Readable, clean};
use crate::transfer::TransferStudy;
use serde_json::Value;

/// What is only an estimate says so.
impl Readable for TransferStudy<'_> {
    fn blocks(&self) -> Vec<Block> {
        let TransferStudy { data, pair, uniformity, trade_off, matched, printed } = self;
        let mut blocks = vec![Block::Title(format!("{}: transfer bound", clean(&data.spec.name)))];
        blocks.extend(sections::pair(data, pair));
        blocks.extend(sections::uniformity(uniformity));
        blocks.push(Block::Drawing(transfer_figure(self)));
        blocks.push(Block::Detail);
        blocks.extend(sections::trade_off(data, trade_off));
        blocks.extend(matched.iter().flat_map(|matched| sections::matched(data, matched)));
        blocks.extend(printed::section(printed, data, pair));
        blocks
    }

    /// As JSON: `{"format": "sigmastar/transfer", "version": 1, ...}`.
    fn json(&self) -> Value {
        json::report(self)
    }
}
