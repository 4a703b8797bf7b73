//! What is known of one number of oscillators that was asked about.

use super::bound::RateBound;
use super::noise::{NoNoiseBound, NoiseBound};

/// What was found for one n_o that was asked about.
#[derive(Clone, Debug)]
pub struct RateForCount {
    /// n_o.
    pub n_o: u32,
    /// The bound; `None` where none was proved, which says nothing either way.
    pub bound: Option<RateBound>,
    /// Bounds of what noise and disturbances do; `None` where the document has none.
    pub noise: Option<Result<NoiseBound, NoNoiseBound>>,
}
