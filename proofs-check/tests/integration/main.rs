//! The integration tests: one program, so that the libraries are linked once.

#![allow(clippy::disallowed_methods, reason = "what is compared need not be the same on every machine")]

mod aligned;
mod arguments;
mod at_samples;
mod at_samples_certificate;
mod claim;
mod common;
mod control;
mod coq;
mod coq_plants;
mod coq_support;
mod existence_inequality;
mod forged;
mod formulas;
mod fuzz;
mod hostile;
mod input_gain;
mod input_gain_formulas;
mod intervals;
mod joint_formulas;
mod joint_inequality;
mod joint_leaves;
mod linear_plants;
mod lmi;
mod lyapunov;
mod matrix_inequality;
mod mean_squares;
mod monotone;
mod mutations;
mod parameters;
mod plant_certificates;
mod plant_corners;
mod plant_mutations;
mod plant_paper;
mod plant_rules;
mod plant_support;
mod sampled_certificates;
mod sampled_claims;
mod sampled_formulas;
mod sampled_plants;
mod sampled_rules;
mod sampled_support;
mod specification;
mod splitting;
mod transfer;
