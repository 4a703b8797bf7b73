//! Bounding specifications: reading them strictly, and the numbers in them.
//!
//! A document comes from a stranger, and a claim rests on every number in it. So nothing is guessed and nothing is
//! rounded: [`Document`] reads JSON (or TOML) strictly and keeps numbers as written, [`Object`] refuses unknown fields,
//! constants become exact numbers or enclosures, ranges and the conditions on the [`Weights`] are proved, and every
//! error names its place ([`SpecError`]). What cannot be decided at the highest precision is an error of its own kind
//! and no answer. [`Specification::from_json`] does all of it; the reader of documents serves certificates and
//! witness files as well.

mod actuator;
mod bound;
mod bounding;
mod comments;
mod constant;
mod disturbances;
mod document;
mod error;
mod existence_inequality;
mod initial_set;
mod input_gain;
mod interval;
mod jacobian;
mod joint_inequality;
mod json;
mod limits;
mod matrix_inequality;
mod meant;
pub mod model;
mod notation;
mod object;
mod of_plant;
mod oscillators;
mod parameters;
mod parts;
mod period;
mod power_tail;
mod proved_values;
mod quantity;
mod range;
mod read;
mod render;
mod sampled_inequality;
mod sampling;
mod source;
mod toml;
mod visible;
pub mod weights;
mod weights_proof;
mod weights_read;

pub use actuator::{Actuator, ActuatorRange, KEPT_BY, read_actuator, read_claimed_actuator};
pub use bound::Bound;
pub use bounding::Bounds;
pub use constant::{any_constant, any_constant_in, nonnegative_constant, positive_constant, positive_constant_in};
pub use disturbances::{Arithmetic, Disturbances, read_disturbances};
pub use document::{Document, Value};
pub use error::nearest;
pub use error::{ErrorKind, Errors, MAX_ERRORS, Reported, SpecError, SpecErrors};
pub use existence_inequality::ExistenceInequality;
pub use initial_set::read_with_ball;
pub use input_gain::{InputGain, read_input_gain};
pub use jacobian::MAX_STATES;
pub use joint_inequality::{JointInequality, JointStability, Level, Metric};
pub use limits::{MAX_BYTES, MAX_NESTING, MAX_VALUES};
pub use matrix_inequality::{MatrixInequality, Splitting};
pub use meant::{in_another_unit, matched_frequency, rounded_from};
pub use model::{
    Constant, Domain, InitialSet, InternalModel, Jacobian, JacobianEntry, Lyapunov, LyapunovSource, OrbitCurve,
    PeriodicMatrix, RelativeDegree, SIZES, Specification, StartSizes, TrigonometricVector,
};
pub use notation::Notation;
pub use object::{MAX_UNKNOWN, Object};
pub use object::{choose, report};
pub use of_plant::{OfPlant, ProvedCell, ProvedForcing, ProvedOrbit, Wave};
pub use oscillators::{AskedHarmonics, NoSet, Oscillators};
pub use parameters::{Interval, MAX_PARAMETERS, Parameter, Parameters, read_parameters};
pub use period::{Period, read_period};
pub use power_tail::power_tail;
pub use proved_values::{ProvedValue, ProvedValues, SampledInequalities};
pub use read::read_internal_model;
pub use read::{FORMAT, MAX_HARMONICS, MAX_RELATIVE_DEGREE_COEFFICIENTS, VERSIONS};
pub use sampled_inequality::{SampledExistence, SampledInequality, SampledLoop};
pub use sampling::{MAX_SAMPLES, SampledGain, Sampling, read_delay};
pub use weights::Weights;
pub use weights_read::MAX_WEIGHTS;
