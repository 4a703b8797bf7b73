//! Tuning: values of the numbers that are free in a specification or plant for which something certified is smallest.
//!
//! A [`Parameter`] is such a number with its range; [`tune`] proposes short exact values for them, certifies each proposal as
//! `certify` does, and keeps the best; [`TuningReport`] says what it brings and what it costs. What is kept is certified; that
//! nothing better exists is not claimed.

mod descent;
mod figures;
mod parameter;
mod ranges;
mod report;

pub use descent::{MAX_TRIES, Settings, Tried, Tuning, tune};
pub use figures::{Figures, Goal};
pub use parameter::{Parameter, TuneError, parameters, with_values};
pub use report::TuningReport;
