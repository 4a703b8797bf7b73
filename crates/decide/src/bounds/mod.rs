//! Bounds of a plant's formulas on a tube around an orbit (derivation, 11.1 and 11.3), decided with enclosures by subdivision.
//!
//! - [`Region`]: the coordinates L, the orbit xb(t), the radius r;
//! - [`Engine`]: decides an entry of a table of bounds, and smoothness;
//! - [`Engine::decide_majorant`]: decides a [`Majorant`], a polynomial in X and E;
//! - [`Engine::decide_inequality`], [`Engine::decide_existence`]: the matrix inequalities of stability and of existence;
//! - [`Engine::decide_joint`], [`Engine::decide_joint_stability`]: the joint inequalities of existence and of stability;
//! - [`Engine::decide_slopes`]: what rates for given n_o know of all derivatives together;
//! - [`Engine::decide_sampled`], [`Engine::decide_sampled_existence`]: the matrix inequalities of the regulator at samples;
//! - [`Engine::decide_forms`], [`Engine::decide_states`]: the inequalities of the tube theorem;
//! - [`Engine::explore`]: where a bound is large, for the next attempt; nothing rests on it.
//!
//! Within: `chart` (coordinates of boxes), `side` (their sides), `time_cell` (what depends on t alone), `extent` (the interval of a
//! component of the orbit), `centred` (values with slopes about the middle of a box), `quantity` (the formulas of each bound),
//! `requirement` (what a right side has to meet to be smooth), `metric_form` (the matrix of a metric), `definite` (definiteness on a box).

mod centred;
mod chart;
mod decide;
mod definite;
mod engine;
mod existence;
mod explore;
mod extent;
mod inequality;
mod joint;
mod majorant;
mod metric_form;
mod quantity;
mod region;
mod requirement;
mod sampled_inequality;
mod side;
mod slopes;
mod smooth;
mod time_cell;
mod tube;

pub use decide::Decision;
pub use engine::Engine;
pub use explore::Explored;
pub use majorant::{Majorant, Term};
pub use region::{Region, RegionError};
pub use sampled_inequality::WithinSample;
pub use smooth::SmoothnessFailure;
pub use tube::StatesForm;

/// The precision of the enclosures on boxes, in bits: a bound is wanted to a few digits, and boxes are many.
pub const PRECISION: u32 = 53;
