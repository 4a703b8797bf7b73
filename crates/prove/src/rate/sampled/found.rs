//! What is known of one number of oscillators that was asked about, at samples.

use super::bound::SampledRateBound;
use super::noise::SampledNoiseBound;
use crate::rate::noise::NoNoiseBound;

/// What was found for one n_o that was asked about.
#[derive(Clone, Debug)]
pub struct SampledRateForCount {
    /// n_o.
    pub n_o: u32,
    /// The bound; `None` where none was proved, which says nothing either way.
    pub bound: Option<SampledRateBound>,
    /// Bounds of what noise and disturbances do; `None` where the document has none.
    pub noise: Option<Result<SampledNoiseBound, NoNoiseBound>>,
}
