//! Bounds of a plant's formulas on a tube around an orbit (derivation, 11.1 and 11.3): proposed in doubles, decided with
//! enclosures.
//!
//! - [`Region`]: the coordinates L, the orbit xb(t), the radius r;
//! - [`Engine`]: decides an [`Entry`] of a table of bounds, and smoothness, by subdivision;
//! - [`Engine::decide_majorant`]: the same of a [`Majorant`], a polynomial in X and E;
//! - [`FloatSuprema`]: the same bounds by sampling, for searches;
//! - [`Engine::decide_inequality`]: the matrix inequality of stability;
//! - [`Engine::decide_slopes`]: what rates for given n_o know of all derivatives together;
//! - [`Engine::decide_sampled`], [`Engine::decide_sampled_existence`]: those of the regulator at samples;
//! - [`Engine::prove_value`]: from a sampled supremum, and what boxes show beyond it, to a decided bound a little above.
//!
//! Within: `chart` (coordinates of boxes), `time_cell` (what depends on t alone), `centred` (values with slopes about the
//! middle of a box), `quantity` (the formulas of each bound), `definite` (semidefiniteness on a box).

mod centred;
mod chart;
mod climb;
mod decide;
mod definite;
mod directions;
mod eigen;
mod energy_program;
mod engine;
mod entry;
mod existence;
mod explore;
mod extent;
mod float_waves;
mod inequality;
mod joint;
mod joint_program;
mod majorant;
mod metric_form;
mod narrow;
mod place;
mod points;
mod pointwise;
mod prove_value;
mod quantity;
mod region;
mod requirement;
mod sampled_form;
mod sampled_inequality;
mod sampled_pairs;
mod sampled_point;
mod sampled_program;
mod sampled_threshold;
mod side;
mod slopes;
mod smooth;
mod splitting;
mod suprema;
#[cfg(test)]
mod tests;
mod time_cell;
mod weights;

pub use decide::Decision;
pub use directions::Directions;
pub use engine::Engine;
pub use entry::{Entry, TABLE};
pub use float_waves::FloatCurve;
pub use joint_program::{FloatLevel, FloatMetric, LevelAsked, LookedAt};
pub use majorant::{Majorant, Term};
pub use place::{Place, Places};
pub use pointwise::Asked;
pub use prove_value::ProvedValue;
pub use quantity::Part;
pub use region::{Region, RegionError};
pub use sampled_form::LoopNumbers;
pub use sampled_pairs::{Corners, MatrixArguments};
pub use sampled_point::{SampledEnergy, SampledRadius, SampledWeights};
pub use sampled_threshold::Focus;
pub use slopes::{FloatSlopes, Slopes};
pub use smooth::SmoothnessFailure;
pub use suprema::FloatSuprema;
pub use weights::{EnergyAt, EnergyWeights, FloatWeights};

/// The precision of the enclosures on boxes, in bits: a bound is wanted to a few digits, and boxes are many.
const PRECISION: u32 = 53;
