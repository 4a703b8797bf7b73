//! Bounds of a plant's formulas by sampling, and programs over samples (derivation, 11.3, 13.6, 13.7): for searches.
//!
//! - [`FloatSuprema`]: the bounds of the table on samples of a tube;
//! - [`FloatWeights`], [`EnergyWeights`], [`SampledEnergy`]: the free numbers of (M), (E) and their forms at samples;
//! - [`FloatMetric`], [`FloatLevel`]: joint metrics by semidefinite programs;
//! - [`PeakProgram`], [`FallingForm`], [`HeldForm`]: quadratic forms that fall, for small peaks;
//! - [`FloatSlopes`]: the matrix ball of all derivatives together;
//! - [`Directions`]: the directions along which the derivatives change.
//!
//! Within: `pointwise` (the quantities at a point), `place`, `points` and `narrow` (where they are looked at), `climb` (local searches),
//! `energy_program`, `sampled_program` and `splitting` (semidefinite programs for (E), for (E) at samples and for a splitting of (M)).

mod climb;
mod directions;
mod energy_program;
mod float_waves;
mod joint_program;
mod narrow;
mod peak_points;
mod peak_program;
mod place;
mod points;
mod pointwise;
mod sampled_pairs;
mod sampled_peak;
mod sampled_point;
mod sampled_program;
mod sampled_threshold;
mod slopes;
mod splitting;
mod suprema;
mod weights;

pub use directions::Directions;
pub use float_waves::FloatCurve;
pub use joint_program::{FloatLevel, FloatMetric, LevelAsked, LookedAt};
pub use peak_points::PeakBox;
pub use peak_program::{FallingForm, PeakOf, PeakProgram};
pub use place::{Place, Places};
pub use pointwise::{Asked, Derivatives, MatrixAt, Slopes as PointSlopes};
pub use sampled_pairs::{Corners, MatrixArguments};
pub use sampled_peak::{HeldForm, HeldGoal, HeldProgram};
pub use sampled_point::{SampledEnergy, SampledRadius, SampledWeights};
pub use sampled_threshold::{Focus, thresholds};
pub use slopes::{FloatSlopes, matrix_of};
pub use suprema::FloatSuprema;
pub use weights::{Column, EnergyAt, EnergyWeights, FloatWeights, Root, Thresholds};
