//! How much work a proof may take.

use sigmastar_exact::enclosure::{DEFAULT_PRECISION, MAX_PRECISION};

/// How much work a proof may take.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProofSettings {
    /// Boxes left undecided before giving up.
    pub max_boxes: usize,
    /// Operations of the expression before giving up, over all its executions: one counts once for every 128 bits of
    /// precision, and `FUNCTION_WEIGHT` times where it is a function such as exp.
    pub max_operations: u64,
    /// Bisections that may lead to one box.
    pub max_depth: u32,
    /// Bits of the first attempts.
    pub precision: u32,
    /// Bits of the last attempts, on boxes that stay undecided.
    pub max_precision: u32,
    /// Whether values may be negative: the expression does not bound a norm.
    pub signed: bool,
}

impl Default for ProofSettings {
    fn default() -> ProofSettings {
        ProofSettings {
            max_boxes: 20_000,
            max_operations: 600_000,
            max_depth: 160,
            precision: DEFAULT_PRECISION,
            max_precision: MAX_PRECISION,
            signed: false,
        }
    }
}
