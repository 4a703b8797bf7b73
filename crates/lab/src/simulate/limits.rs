//! What a simulation may cost, in operations, so that the answer does not depend on the machine.

/// Elementary operations that a steady state, a long run and a run with noise may take each: some ten seconds.
pub const MAX_OPERATIONS: u64 = 10_000_000_000;

/// Numbers that one integration, or a long run, may keep: 256 MiB.
pub const MAX_NUMBERS: usize = 1 << 25;

/// The most fixed steps of a period.
pub const MAX_FIXED_STEPS: u32 = 1_000_000;
