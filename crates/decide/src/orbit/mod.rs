//! The T-periodic solution x_0 of x' = f(t, x, 0), and the harmonics of q(t, x_0, 0), decided (derivation, 11.2, 11.4).
//!
//! - `recurrences`, `taylor`, `cells`, `curve`: Taylor series of formulas along a curve, over enclosures;
//! - `members`: the members of a family of plants along it;
//! - `defect`, `rate`, `around`: what the orbit and its coordinates have to satisfy;
//! - `decide`: an orbit and its numbers, or a second P, decided;
//! - `forcing`: the harmonics of q, decided;
//! - `linear`: matrices and norms of enclosures;
//! - `not_proved`: why an orbit is not proved.

mod around;
mod cells;
mod curve;
mod decide;
mod defect;
mod forcing;
mod linear;
mod members;
pub(crate) mod model;
pub(crate) mod models;
mod not_proved;
mod rate;
mod recurrences;
mod taylor;

pub use around::Around;
pub use decide::{decide_orbit, decide_second, least_radius};
pub use forcing::{decide_forcing, rests};
pub use not_proved::OrbitNotProved;
