//! Which gains go with which sampling periods: certified pairs of the regulator at samples (derivation, 12).
//!
//! Nothing is monotone in either number, so a table lists pairs, each certified by itself, and says nothing between them.

mod certifier;
mod report;
mod round;
mod study;
mod unfit;

pub use certifier::{Certifier, OfPlant, OfSpecification, Pair};
pub use report::{SamplingReport, sampling_figure};
pub use round::RoundForm;
pub use study::{Asked, Row, SamplingStudy};
pub use unfit::Unfit;
