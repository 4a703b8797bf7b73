//! The T-periodic solution x_0(t) of x' = f(t, x, 0): found in floating point, proved; the harmonics of q(t, x_0, 0); and
//! coordinates in which the zero dynamics contract (derivation, 11.2, 11.4, 11.5).

mod collocation;
mod failure;
mod field;
mod find;
mod floquet;
mod series;
#[cfg(test)]
mod tests;

pub use failure::{OrbitFailure, OrbitNotProved};
pub use find::{FloatOrbit, find_orbit};
pub use series::FloatSeries;
