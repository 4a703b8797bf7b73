//! Trying to break a certificate: random plants inside its families, simulated a little above sigma*.
//!
//! That a plant lies within the families is proved; the simulation is floating point and decides nothing: a trial that
//! finds nothing proves nothing, and what it finds is a plant and an initial condition that anyone can simulate again.
//! A claim about the law at samples is tried with exactly its gain and sampling time, at different phases of the sampling grid.
//! Of a family of plants the corners are tried first, then members inside. The number of oscillators varies, or sets of harmonics are chosen for it. The base frequency and the
//! period are part of the claim and stay; other base
//! frequencies are claims of their own, which [`with_base_frequency`] makes.

mod checks;
mod claim;
mod contraction;
mod counterexample;
mod disturbed;
mod draw;
mod edge;
mod family;
mod figures;
mod finding;
mod fit;
mod forcing;
mod frame;
mod frequency;
mod jacobian;
mod joint;
mod limits;
mod linear;
mod members;
mod membership;
mod oscillators;
mod random;
mod report;
mod run;
mod sampled_claim;
mod sampled_trial;
mod shape;
mod start;
mod trial;

pub use claim::TriedClaim;
pub use counterexample::{counterexample_plant, flags};
pub use draw::draw;
pub use edge::{Edge, ProvedBounds, Shown, from_the_edge};
pub use family::{Family, FamilyBound, Harmonic};
pub use figures::{LoopFigures, nominal_figures};
pub use finding::{Falsification, Finding, Trial, TrialSettings, TriedPlant, Violation};
pub use frame::OwnPlant;
pub use frequency::{FrequencyError, with_base_frequency};
pub use limits::SectorEnd;
pub use linear::linear_member;
pub use members::ParameterError;
pub use membership::respects;
pub use oscillators::OscillatorsError;
pub use random::Random;
pub use report::FalsificationReport;
pub use sampled_claim::SampledClaim;
pub use shape::{Factor, Number, Shape};
pub use trial::falsify;
