//! Random cases of what proofs rest on, against values at points: an ordinary run has some thousand in all, and
//! `SIGMASTAR_FUZZ=100000 cargo test --release --test integration fuzz` (or `FIRST..LAST`) as many of each as are asked for.
//!
//! Case N of a fuzzer is the same in every run, so that `SIGMASTAR_FUZZ=N..N+1` repeats a failure, whose message names it.

mod bounds;
mod intervals;
mod monotone;
mod orbits;
mod periodicity;
mod plants;

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::ops::Range;

/// The cases that were asked for; of an ordinary run so many.
fn cases(ordinary: u64) -> Range<u64> {
    let Ok(asked) = std::env::var("SIGMASTAR_FUZZ") else { return 0..ordinary };
    let number = |text: &str| text.parse().expect("SIGMASTAR_FUZZ is COUNT or FIRST..LAST");
    match asked.split_once("..") {
        Some((first, last)) => number(first)..number(last),
        None => 0..number(&asked),
    }
}

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
