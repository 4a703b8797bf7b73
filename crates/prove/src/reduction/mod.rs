//! From a plant's formulas to a specification whose data are proved (derivation, 11).
//!
//! [`reduce()`] finds the orbit and coordinates, searches for a gain over sampled bounds, and proves the bounds at the arguments
//! that the conditions will use. What it returns goes through `certify` as any specification does. [`decide_again`] proves
//! what a certificate says of a plant. A [`Subject`] is either of both, and [`Prepared`] goes the whole way with it: by a search,
//! or with the [`Witness`] of a certificate.

mod again;
mod by_matrix;
mod cells;
mod choice;
mod closer;
mod coordinates;
mod cover;
mod energy;
mod entries;
mod estimates;
mod grid;
mod interval_costs;
mod joint;
mod proofs;
mod proved_at_samples;
mod reduce;
mod refusal;
mod run;
mod sampled;
mod sampled_matrix;
mod sampling;
mod shrunk;
mod specification;
mod study;
mod subject;
#[cfg(test)]
mod tests;
mod tube;
mod values;
mod watch;
mod witness;

pub use again::decide_again;
pub use proofs::{ProvedData, Reduced, bounds_around};
pub use proved_at_samples::ReducedSampled;
pub use reduce::{Beside, reduce, reduce_by_norms};
pub use refusal::{MAX_STATES, PlantRefusal};
use run::Ask;
pub use run::{AtGains, Certified, Checked, Prepared, Run, StateStart};
pub use sampled::{RestsOn, SampledPairs, reduce_sampled, with_sampled_pairs};
pub use shrunk::{INITIAL_SET, Shrunk, shrunk};
pub use specification::specification;
pub use study::{OrbitStudy, study};
pub use subject::{SAMPLING_PERIOD, Subject, at_samples, for_every_set};
pub use watch::{Stage, Unwatched, Watch};
pub use witness::{FreeNumbers, Witness, WitnessData};
