//! Plants that are linear in x and e with coefficients that do not depend on t (derivation, 14.3): their periodic solution for a given
//! number of oscillators, harmonic by harmonic, and what bounds the way to it; in continuous time and at samples (14.6).
//!
//! [`LinearPlant`] is read off the formulas; [`sizes`] bounds the periodic solution of every member of the family; [`Falling`] decides that
//! a quadratic form falls along every difference of two solutions, and says what follows.

mod falling;
mod held;
mod jet;
mod largest;
mod member;
mod plant;
mod steady;
mod supremum;

pub use falling::{Falling, FallingHeld, Peak, Start};
pub use largest::{Answers, sizes};
pub use member::{Clock, Member};
pub use plant::{LinearPlant, MAX_LINES};
pub(crate) use steady::Beyond;
pub use steady::{AtSamples, Loop, Sizes};
pub(crate) use supremum::{Fineness, Harmonics, supremum};

/// Bits of the enclosures.
pub const PRECISION: u32 = 53;
