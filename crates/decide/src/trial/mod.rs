//! A periodic solution for one number of oscillators and one gain as exactly as one likes (derivation, 14.4): a trial, its defects, and what
//! the tube theorem says of the solution near it; the peaks that follow (14.5).
//!
//! With `e + ehat(t)` in the place of e the trial is a curve of the states at e = 0, as an orbit is: what decides bounds around an orbit decides
//! those around a trial. Of a family each member has its own trial, a polynomial in what it differs by from the nominal one.

mod conclude;
mod curves;
mod defects;
mod held;
mod peak;

pub use conclude::{Concluded, Known, OfAllCounts, OrMore, TubeProof, XFirst};
pub use curves::Trial;
pub use peak::Peaks;
