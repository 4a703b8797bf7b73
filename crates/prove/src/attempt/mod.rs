//! From a proposal in floating point to numbers that are decided. Each attempt rounds what samples say, gives up as little of it as the
//! proof needs, and has it decided; what it returns has been decided true.
//!
//! - `orbit`, `forcing`, `triple`: the orbit, the harmonics of q along it, and P(t) for a Jacobian;
//! - `value`: a bound of the table;
//! - `splitting`, `existence`, `sampled_existence`: the matrix inequalities (M), (E), and (E) at samples;
//! - `slopes`: the ball (D) of all first derivatives.

mod existence;
mod forcing;
mod orbit;
mod sampled_existence;
mod slopes;
mod splitting;
mod triple;
mod value;

#[cfg(test)]
pub(crate) mod bound_tests;
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
