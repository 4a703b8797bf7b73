//! Relative degree r > 1: what a bound on e says about the regulated output xi_1.
//!
//! With `e = xi_r + a_{r-1} xi_{r-1} + ... + a_1 xi_1` and `xi_i' = xi_{i+1}`, the output xi_1 is the response of
//! `1/p` to e (derivation, section 6; paper, section "Higher-Relative Degree Case via Partial-State Feedback"), where
//!
//! ```text
//! p(s) = s^{r-1} + a_{r-1} s^{r-2} + ... + a_2 s + a_1.
//! ```
//!
//! If p is Hurwitz, then, with g the impulse response of 1/p,
//!
//! ```text
//! limsup |xi_1| <= k_inf limsup |e|,    k_inf = integral_0^oo |g(t)| dt,                     (k_infinity)
//! int_0^T xi_1^2 <= k_2 int_0^T e^2 for T-periodic e and xi_1,   k_2 = sup_w 1/|p(i w)|^2.   (k_2)
//! ```
//!
//! The first because `xi_1 = (a term that decays) + g * e`; the second by Parseval, harmonic by harmonic. The paper
//! prints the coefficients of p in the opposite order, `s^{r-1} + a_1 s^{r-2} + ... + a_{r-1}` (erratum E14):
//! [`printed_polynomial`] tests that one, so that the difference can be shown.
//!
//! # Conventions
//! The slice `a` holds a_1, ..., a_{r-1}, in this order: 1 to [`MAX_COEFFICIENTS`] exact rationals of any size (so
//! r <= 4). The unit of a_i is 1/time^{r-i}; k_inf has the unit of 1/a_1 and k_2 that of 1/a_1^2.
//!
//! # Guarantees
//! Everything is decided by exact rational arithmetic or by enclosures; an enclosure that is returned contains the
//! constant, whatever its width. Effort is bounded by fixed counts, so results are deterministic.

mod impulse;
mod peak;
#[cfg(test)]
mod tests;

pub use impulse::k_infinity;
pub use peak::k_2;

use rug::Rational;
use thiserror::Error;

/// The largest number r - 1 of coefficients accepted: up to relative degree 4 the impulse response has few enough terms for
/// formulas.
pub const MAX_COEFFICIENTS: usize = 3;

/// Why a constant of the relative-degree filter was not computed.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum RelativeDegreeError {
    /// There are no coefficients, or more than [`MAX_COEFFICIENTS`].
    #[error(
        "{count} coefficients a_1, ..., a_(r-1); between 1 and {MAX_COEFFICIENTS} are accepted (relative degree 2 to 4)"
    )]
    Count {
        /// The number that was given.
        count: usize,
    },
    /// The polynomial has a root with nonnegative real part. This is a proof, not a failure to decide.
    #[error("the polynomial is not Hurwitz: {0}")]
    NotHurwitz(NotHurwitz),
    /// No finite bound was proved within the bounded effort; nothing is claimed.
    #[error("undecided: {0}")]
    Undecided(Undecided),
}

/// The entry of the Routh array that refutes "p is Hurwitz".
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("entry {row} of the first column of its Routh array is {entry}, not positive (entries before it are)")]
pub struct NotHurwitz {
    /// The row of the Routh array, counted from 0 for the row of s^{r-1}; so between 1 and r - 1.
    pub row: usize,
    /// The first entry of that row: negative or zero.
    pub entry: Rational,
}

/// What a bounded effort did not reach.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum Undecided {
    /// The fastest and the slowest time scale are too far apart: the sum for k_inf has no finite enclosure.
    #[error("the L1 norm of the impulse response was not enclosed, its time scales are too far apart")]
    TimeScales,
    /// No positive lower bound of |p(i w)|^2 was proved at the highest precision: p has a root extremely close to
    /// the imaginary axis.
    #[error("the resonance peak is too high to be bounded at the highest precision")]
    Resonance,
}

/// Whether `s^{r-1} + a_{r-1} s^{r-2} + ... + a_1` is Hurwitz, by [`check_hurwitz`]. Both answers are proofs for 1 to
/// [`MAX_COEFFICIENTS`] coefficients; for any other number of them the answer is `false` (not accepted).
#[must_use]
pub fn is_hurwitz(a: &[Rational]) -> bool {
    check_hurwitz(a).is_ok()
}

/// Decides exactly whether all roots of `s^{r-1} + a_{r-1} s^{r-2} + ... + a_1` have negative real parts.
///
/// Routh's test in rational arithmetic: the polynomial is Hurwitz if and only if the first column of its Routh array is positive.
/// Below the 1 of s^{r-1} it holds a_1 (degree 1); a_2, a_1 (degree 2); a_3, a_2 - a_1/a_3, a_1 (degree 3). The first entry that
/// is zero or negative refutes.
///
/// # Errors
/// [`RelativeDegreeError::NotHurwitz`] with the first entry that is not positive; [`RelativeDegreeError::Count`].
pub fn check_hurwitz(a: &[Rational]) -> Result<(), RelativeDegreeError> {
    let positive = |row: usize, entry: Rational| {
        if entry > 0 { Ok(()) } else { Err(RelativeDegreeError::NotHurwitz(NotHurwitz { row, entry })) }
    };
    match a {
        [a_1] => positive(1, a_1.clone()),
        [a_1, a_2] => positive(1, a_2.clone()).and_then(|()| positive(2, a_1.clone())),
        [a_1, a_2, a_3] => {
            positive(1, a_3.clone())?;
            positive(2, a_2 - Rational::from(a_1 / a_3))?;
            positive(3, a_1.clone())
        }
        _ => Err(RelativeDegreeError::Count { count: a.len() }),
    }
}

/// The test of [`check_hurwitz`] for the polynomial as the paper prints it, `s^{r-1} + a_1 s^{r-2} + ... + a_{r-1}`.
///
/// This says nothing about the dynamics (erratum E14): for a = (10, 1, 1) the printed polynomial s^3 + 10 s^2 + s + 1
/// is Hurwitz, while the dynamics has the characteristic polynomial s^3 + s^2 + s + 10, which is not.
///
/// # Errors
/// As [`check_hurwitz`].
pub fn printed_polynomial(a: &[Rational]) -> Result<(), RelativeDegreeError> {
    let reversed: Vec<Rational> = a.iter().rev().cloned().collect();
    check_hurwitz(&reversed)
}
