//! From a specification to a decided claim: the triple of a Jacobian, search, rounding, rigorous decision.
//!
//! [`with_triple`] and [`certify`] are the whole way; [`recheck`] decides given free numbers, without any search. What either
//! refuses is a [`Refusal`].

mod ball;
mod by_count;
mod certification;
mod consequences;
mod constants;
mod gain_row;
mod gain_to_use;
mod gains;
mod jacobian;
pub(crate) mod kept;
mod least_limit;
mod limits;
mod matrix_checks;
mod nominal_ball;
mod options;
mod outcome;
mod pool;
mod precision;
mod produce;
mod rates;
mod refusal;
mod room;
mod round;
mod row_noise;
mod row_rates;
mod sampled;
mod scale;
mod sensitivity;
mod smaller;
mod start;
mod trials;
mod under_noise;
mod verdict;

pub use ball::{claimed_ball, covers_ball, inverse_norm, within_ball};
pub use certification::{Alternatives, Certification, Constants, ExactClaim, PrintedFigure, RelativeDegreeGains};
pub(crate) use gain_row::CLAIM_DIGITS;
pub use gain_row::{ByCount, CountBounds, CountProof, GainRow, Largest, LoopSizes, RowNoise};
pub use gain_to_use::{Transient, gain_to_use};
pub use gains::{ROWS, unit_of_gains};
pub use jacobian::{MAX_SEARCHES, Resolution, resolve, resolve_with, with_triple};
pub use kept::{BoundsOfCount, Stated};
pub use matrix_checks::{ContractionCheck, MatrixChecks, SylvesterCheck};
pub use nominal_ball::nominal_ball;
pub use options::{Limits, Options, TransferChoice};
pub use outcome::Outcome;
pub use pool::{Member, Wanted};
pub use produce::{certify, certify_for, certify_member, recheck};
pub(crate) use rates::said_of;
pub use rates::{NoRatesOfClaim, SaidOfCount, apart, rate_counts, rates_in_words};
pub use refusal::Refusal;
pub(crate) use room::plant_of;
pub use sampled::{SampledCertification, certify_sampled, certify_sampled_within, recheck_sampled, sampled_model};
pub use scale::unusual;
pub use smaller::SmallerChoice;
pub use start::FarStart;
pub use under_noise::UnderNoise;
pub use verdict::{Verdict, verdict_of_errors};
