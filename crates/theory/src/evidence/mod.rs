//! What proofs are about and what they leave behind, as data: nothing here proposes, and nothing decides.
//!
//! - [`Entry`]: a number of a table of bounds; [`TABLE`] lists those that a certificate may have;
//! - [`Part`], [`Slopes`]: of the first derivatives together;
//! - [`Coordinates`], [`OrbitProof`]: the orbit and the coordinates around it;
//! - [`ProvedTriple`]: a P(t) with its rate.

mod entry;
mod orbit;
mod slopes;
mod triple;

pub use entry::{Entry, TABLE, of_table};
pub use orbit::{Coordinates, MAX_HARMONICS, MAX_STATES, OrbitProof};
pub use slopes::{Part, Slopes};
pub use triple::{ProvedTriple, ProvedTriples};
