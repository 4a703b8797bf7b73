//! The conditions of a claim, decided from its rational witness; the bounding functions; whether there is a plant at all.
//!
//! - [`decide()`], [`decide_exact`]: every condition, at a precision that rises while one is undecided;
//! - [`prove_on_domain`], [`prove_up_to`]: that the bounding functions are what the derivation needs;
//! - [`no_plant()`]: that no plant with a state satisfies the data.

mod bounding;
mod decide;
mod no_plant;
mod proof;

pub use bounding::{BoundingProblem, prove_on_domain, prove_up_to};
pub use decide::{Ladder, decide, decide_exact};
pub use no_plant::{ExceededBy, NoPlant, has_states, no_plant};
pub use proof::{Decidable, Decided, GivenWitness, Proof, RepairedProof, SampledProof, SharpProof, Witness};
