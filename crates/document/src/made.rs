//! A report that outlives what it was made from.

use super::{Block, Readable};
use serde_json::Value;

/// The blocks and the JSON of a report, made once.
#[derive(Clone, Debug)]
pub struct Made {
    blocks: Vec<Block>,
    json: Value,
}

impl Made {
    /// A report of these.
    #[must_use]
    pub fn new(blocks: Vec<Block>, json: Value) -> Made {
        Made { blocks, json }
    }

    /// That of a report, with the same content in every format.
    #[must_use]
    pub fn of(report: &dyn Readable) -> Made {
        Made { blocks: report.blocks(), json: report.json() }
    }

    /// Its blocks as a section of another report.
    #[must_use]
    pub fn as_section(&self) -> Vec<Block> {
        let one = |block: Block| match block {
            Block::Title(text) => Block::Heading(text),
            block => block,
        };
        self.blocks().into_iter().map(one).collect()
    }
}

impl Readable for Made {
    fn blocks(&self) -> Vec<Block> {
        self.blocks.clone()
    }

    fn json(&self) -> Value {
        self.json.clone()
    }
}
