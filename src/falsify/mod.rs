//! Trying to break a certificate: random plants inside its families, simulated a little above sigma*.
//!
//! Floating point decides nothing here: a trial that finds nothing proves nothing, and what it finds is a plant and an
//! initial condition that anyone can simulate again. The base frequency is part of the claim and stays; the number of
//! oscillators varies.

mod claim;
mod draw;
mod family;
mod report;
mod trial;

pub use claim::Claim;
pub use draw::{DrawnPlant, draw};
pub use family::{Family, Harmonic};
pub use report::{FORMAT, VERSION, counterexample_plant, json, text};
pub use trial::{Finding, Outcome, Settings, Trial, Violation, falsify};
