//! Routh's array of the filter polynomial, in the normalised form that also gives an energy function.

use super::{MAX_COEFFICIENTS, NotHurwitz, RelativeDegreeError};
use rug::Rational;

/// The numbers b_1, ..., b_n of a Hurwitz polynomial p of degree n, all positive.
///
/// Split p by parity, `p = R + b_1 q_{n-1}`, with R monic of the parity of n and q_{n-1} monic of the other one, and
/// divide as in Euclid's algorithm by monic polynomials q_k of degree k with the parity of k:
///
/// ```text
/// R = s q_{n-1} + b_2 q_{n-2},   q_k = s q_{k-1} + b_{n-k+2} q_{k-2}  (k = n-1, ..., 2),   q_1 = s,   q_0 = 1.
/// ```
///
/// These are the rows of the Routh array divided by their first entries R_0 = 1, R_1 = b_1, R_k = b_k R_{k-2}. So p is
/// Hurwitz if and only if all b_k > 0 (Routh's theorem), and the first b_k <= 0 is met after positive entries only.
#[derive(Clone, Debug)]
pub(super) struct Routh {
    /// b_1, ..., b_n; all positive.
    pub(super) b: Vec<Rational>,
}

impl Routh {
    /// The numbers b_k for `s^n + a_n s^{n-1} + ... + a_1`, or the proof that it is not Hurwitz.
    pub(super) fn new(a: &[Rational]) -> Result<Routh, RelativeDegreeError> {
        let n = a.len();
        if n == 0 || n > MAX_COEFFICIENTS {
            return Err(RelativeDegreeError::Count { count: n });
        }
        // Coefficients of s^n, s^{n-2}, ... and of s^{n-1}, s^{n-3}, ...
        let mut upper: Vec<Rational> = vec![Rational::from(1)];
        upper.extend(a.iter().rev().skip(1).step_by(2).cloned());
        let mut lower: Vec<Rational> = a.iter().rev().step_by(2).cloned().collect();
        let mut b: Vec<Rational> = Vec::with_capacity(n);
        // First entries of the two latest rows of the array: R_{k-2} and R_{k-1}; R_{-1} = 1 makes R_1 = b_1.
        let (mut before, mut latest) = (Rational::from(1), Rational::from(1));
        for row in 1..=n {
            let pivot = lower.first().cloned().unwrap_or_default();
            let entry = Rational::from(&pivot * &before);
            if pivot <= 0 {
                return Err(RelativeDegreeError::NotHurwitz(NotHurwitz { row, entry }));
            }
            for coefficient in &mut lower {
                *coefficient /= &pivot;
            }
            // upper - s * lower: the leading terms, both 1, cancel.
            let mut next = upper;
            for (coefficient, other) in next.iter_mut().zip(&lower) {
                *coefficient -= other;
            }
            next.remove(0);
            upper = lower;
            lower = next;
            b.push(pivot);
            before = latest;
            latest = entry;
        }
        Ok(Routh { b })
    }
}
