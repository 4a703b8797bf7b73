//! The T-periodic solution x_0(t) of x' = f(t, x, 0): found in floating point, proved; the harmonics of q(t, x_0, 0); and
//! coordinates in which the zero dynamics contract (derivation, 11.2, 11.4, 11.5).
//!
//! - `balance`, `modes`: units and axes that do not depend on how a plant is written;
//! - `field`, `series`, `collocation`, `floquet`, `drift`, `find`: the orbit in doubles;
//! - `undefined`, `failure`, `words`: what has no value along it, and how it is told;
//! - `round`, `shape`, `least_gain`, `coordinates`, `sampled`: short rationals for it, L and P(t), and what to ask of the proofs;
//! - `recurrences`, `taylor`, `cells`, `curve`: Taylor series of formulas along a curve, over enclosures;
//! - `members`: the members of a family of plants along it;
//! - `defect`, `rate`, `prove`: the orbit, proved;
//! - `forcing`: the harmonics of q, proposed and proved.

mod balance;
mod cells;
mod collocation;
mod coordinates;
mod curve;
mod defect;
mod drift;
mod failure;
mod field;
mod find;
mod floquet;
mod forcing;
mod least_gain;
mod linear;
mod members;
mod modes;
mod prove;
mod rate;
mod recurrences;
mod round;
mod sampled;
mod series;
mod shape;
mod taylor;
#[cfg(test)]
mod tests;
mod undefined;
mod words;

pub use coordinates::lower_triangular;
pub use coordinates::{Coordinates, propose_coordinates};
pub use curve::MAX_HARMONICS;
pub use failure::{MAX_STATES, OrbitFailure, OrbitNotProved};
pub use find::{FloatOrbit, find_orbit};
pub use forcing::{decide_forcing, prove_forcing};
pub use prove::{
    OrbitProof, decide_orbit, decide_second, prove_orbit, prove_orbit_at, prove_orbits, prove_second, without_value,
};
pub use round::round_orbit;
pub use sampled::defects_by_parameter;
pub use series::FloatSeries;
pub use undefined::Undefined;
pub(crate) use undefined::{instead, otherwise};
