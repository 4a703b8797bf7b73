//! What a simulation may cost, in operations, so that the answer does not depend on the machine; and what was spent.

use std::sync::atomic::{AtomicU64, Ordering};

/// Elementary operations that a steady state, a long run and a run with noise may take each: some ten seconds.
pub const MAX_OPERATIONS: u64 = 10_000_000_000;

/// Numbers that one integration, or a long run, may keep: 256 MiB.
pub const MAX_NUMBERS: usize = 1 << 25;

/// The most fixed steps of a period.
pub const MAX_FIXED_STEPS: u32 = 1_000_000;

/// The operations that were spent. One closed loop is simulated by one thread, so the count does not depend on how many
/// threads there are.
#[derive(Debug, Default)]
pub(super) struct Effort(pub(super) AtomicU64);

impl Effort {
    pub(super) fn spent(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}
