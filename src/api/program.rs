//! What the program asks the front door for beside its page: the same functions of documents that were read, with the names of flags, figures
//! in the place of files, and somebody who waits. No part of the interface.

pub use super::bound::bounds_of;
pub use super::certify::{Afterwards, decided, not_told_apart};
pub use super::check::{MAX_CERTIFICATE, check_bytes};
pub use super::constants::constants_of;
pub use super::design::{DesignNames, design_of};
#[cfg(feature = "lab")]
pub use super::edge::{Drawn, FIGURE_FILES};
#[cfg(feature = "lab")]
pub use super::falsify::{Attempt, TrialSettings};
pub use super::lyapunov::lyapunov_of;
pub use super::options::Options;
#[cfg(feature = "lab")]
pub use super::page::page;
pub use super::report::report_of;
pub use super::sampling::{PairsPart, pairs_of};
#[cfg(feature = "lab")]
pub use super::simulate::{Wanted, run_loop, run_sampled_loop};
pub use super::transfer::{PairError, transfer_of};
pub use super::tune::tune_watched;

use super::error::Error;
use rug::Rational;
use sigmastar_lang::spec::{Constant, Document, any_constant, nonnegative_constant};

/// The value of a flag that is an exact positive constant, as in a specification.
///
/// # Errors
/// What is wrong with the constant, in its place.
pub fn positive(flag: &str, text: &str) -> Result<Constant, Error> {
    super::positive(flag, text)
}

/// The value of a flag that is an exact constant which is not negative.
///
/// # Errors
/// What is wrong with the constant, in its place.
pub fn nonnegative(flag: &str, text: &str) -> Result<Constant, Error> {
    super::constant(flag, text, nonnegative_constant)
}

/// The value of a flag that is an exact constant.
///
/// # Errors
/// What is wrong with the constant, in its place.
pub fn real(flag: &str, text: &str) -> Result<Constant, Error> {
    super::constant(flag, text, any_constant)
}

/// The document with the sampling period of a flag in the place of its own, or itself where it has no internal model.
///
/// # Errors
/// Those of [`positive`], and a sampling period that does not go with the document, at the flag.
pub fn with_sampling_period(document: &Document, flag: &str, text: &str) -> Result<Document, Error> {
    super::with_sampling_period(document, flag, text)
}

/// The value of a flag that is a positive rational number.
///
/// # Errors
/// Those of [`positive`], and a constant that is not rational.
pub fn rational(flag: &str, text: &str) -> Result<Rational, Error> {
    super::rational(flag, text)
}

/// The value of a flag that bounds the error along the periodic solution.
///
/// # Errors
/// Those of [`rational`]; of 0 with what may be asked for in its place.
pub fn steady_error(flag: &str, text: &str) -> Result<Rational, Error> {
    super::steady_error(flag, text)
}
