//! The search for the free numbers, in floating point. It proposes and claims nothing; what it finds is rounded and decided elsewhere.
//!
//! Everything here is deterministic: candidates are generated in a fixed order, evaluated in parallel, and compared in
//! that order, so that the number of threads does not change the result.

mod at_samples;
mod binding;
mod box_at_samples;
mod by_energy;
mod by_matrix;
mod candidate;
mod decay;
mod effort;
mod error_box;
mod exact;
mod float_bound;
mod floors;
mod form_radius;
mod goal;
mod minimise;
mod model;
mod obstacle;
mod periodic;
mod printed;
mod reach;
mod repaired;
mod root;
mod sampled;
mod sampled_limit;
mod scan;
mod sharp;
mod smaller_set;
mod threshold;

pub use at_samples::{AtSamples, BySampledEnergy, BySampledMatrix, SampledEnergyAt, SampledRadiusAt};
pub use binding::Binding;
pub use by_energy::{ByEnergy, EnergyMargin, SHARE};
pub use candidate::{AtSigma, PastShare, active_level, weight_h};
pub use effort::{ROOM, ROOMY};
pub use exact::search_exact;
pub use float_bound::FloatBound;
pub use goal::Goal;
pub use minimise::{Descent, minimise};
pub use model::{Datum, FloatModel, OptionalDatum};
pub use obstacle::{Closest, Extreme, Failing, Known, Limited, Obstacle};
pub use periodic::{ExistenceForm, Floors, PeriodicSet};
pub use printed::{PrintedProposal, search_printed};
pub use reach::{Largest, start_distances};
pub use repaired::{RepairedProposal, largest_e_repaired, perron_repaired, search_repaired};
pub use sampled::{SampledProposal, SampledSearch, ScanPoint};
pub use sampled_limit::SampledLimit;
pub use sharp::{
    SharpParameters, SharpProposal, at_sigma, largest_at, search_sharp, search_sharp_at, search_sharp_near,
    sensitivities, without_optional_data,
};
pub use smaller_set::smaller_set;
pub use threshold::{ByMatrix, Threshold};
