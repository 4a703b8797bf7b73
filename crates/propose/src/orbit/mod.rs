//! The T-periodic solution x_0(t) of x' = f(t, x, 0) in floating point; the harmonics of q(t, x_0, 0); and
//! coordinates in which the zero dynamics contract (derivation, 11.2, 11.4, 11.5).
//!
//! - `balance`, `modes`: units and axes that do not depend on how a plant is written;
//! - `field`, `series`, `collocation`, `floquet`, `drift`, `find`: the orbit in doubles;
//! - `failure`: why there is none;
//! - `round`, `shape`, `least_gain`, `coordinates`, `sampled`: short rationals for it, L and P(t), and the numbers to be decided for them;
//! - `forcing`: the harmonics of q.

mod balance;
mod collocation;
mod coordinates;
mod drift;
mod failure;
mod field;
mod find;
mod floquet;
mod forcing;
mod least_gain;
mod modes;
mod round;
mod sampled;
mod series;
mod shape;

pub use coordinates::{Rated, lower_triangular, propose_coordinates};
pub use failure::OrbitFailure;
pub(crate) use field::Field;
pub use find::{FloatOrbit, find_orbit};
pub use forcing::{propose_forcing, sampled_rests};
pub use round::round_orbit;
pub use sampled::{Sampled, defects_by_parameter, doubles};
pub use series::FloatSeries;
