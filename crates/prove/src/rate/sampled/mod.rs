//! Rates of the law at samples for a given number of oscillators (derivation, 13.6, Proposition R_h).
//!
//! - [`noise`]: what noise of the measurement and a disturbance do to the error, by the same inequality with inputs;
//! - [`rounding`]: what the rounding of the exported law adds to it;
//! - [`bound`]: from a decay to `|e - e_per| <= C exp(-rate (t - t_0))` at the sampling instants, as a certificate has it.

pub mod bound;
pub mod noise;
pub mod rounding;

#[cfg(test)]
mod control_tests;
#[cfg(test)]
mod form_tests;
