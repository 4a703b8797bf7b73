//! What a claim rests on, and nothing else: exact numbers and intervals, the reader, specifications, and the rules, one a
//! file. Every rule names the section of docs/mathematics.md that proves it. A plant is here what a claim needs of it
//! ([`plant`]); that it is so is proved in the crate `proofs-plants`.

// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod actuator;
pub mod bound;
pub mod constant;
pub mod data;
pub mod effort;
pub mod exact;
pub mod expr;
pub mod input_gain;
pub mod interval;
pub mod jacobian;
pub mod json;
pub mod matrix;
pub mod monotone;
pub mod noise;
pub mod period;
pub mod plant;
pub mod propose;
pub mod range;
pub mod rules;
pub mod scope;
pub mod sha256;
pub mod spec;
pub mod verdict;
pub mod wave;
pub mod weights;
