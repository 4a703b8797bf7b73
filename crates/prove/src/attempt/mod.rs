//! From a proposal in floating point to numbers that are decided: each rounds what samples say, gives up as little of it as the proof
//! needs, and has it decided.

mod existence;
mod forcing;
mod orbit;
mod sampled_existence;
mod slopes;
mod splitting;
mod triple;
mod value;

#[cfg(test)]
mod bound_tests;
#[cfg(test)]
mod orbit_tests;

pub use existence::prove_existence;
pub use forcing::prove_forcing;
pub use orbit::{prove_orbit, prove_orbit_at, prove_orbits, prove_second, without_value};
pub use sampled_existence::prove_sampled_existence;
pub use slopes::prove_slopes;
pub use splitting::prove_inequality;
pub use triple::{first_proved, prove_candidate};
pub use value::{ProvedValue, prove_value};
