//! Random cases of what proofs rest on, against values at points: an ordinary run has some thousand in all, and
//! `SIGMASTAR_CASES=100000 cargo test --release --test integration fuzz` (or `FIRST..END`) as many of each as are asked for.
//!
//! Case N of a fuzzer is the same in every run, so that `SIGMASTAR_CASES=N..N+1` repeats a failure, whose message names it.

mod bounds;
mod intervals;
mod monotone;
mod orbits;
mod periodicity;
mod plants;

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// The random numbers of one case of one fuzzer.
fn random(fuzzer: u64, case: u64) -> StdRng {
    StdRng::seed_from_u64((fuzzer << 48) + case)
}

/// One of some.
fn any<'a, T>(random: &mut StdRng, of: &'a [T]) -> &'a T {
    &of[random.random_range(0..of.len())]
}

/// A number with so many decimals between two.
fn decimal(random: &mut StdRng, decimals: usize, low: f64, high: f64) -> String {
    format!("{:.decimals$}", random.random_range(low..=high))
}
