//! The squared H-infinity norm k_2 = sup_w 1/|p(i w)|^2 of 1/p, for p of degree 1 to 3.

use super::{RelativeDegreeError, Undecided, check_hurwitz};
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, MAX_PRECISION};

/// Bits of the minimum: with a root at the relative distance z of the imaginary axis it is smaller than its terms by z^2.
const WORKING_PRECISION: u32 = 4096;

/// An enclosure of k_2, with int_0^T xi_1^2 <= k_2 int_0^T e^2 for T-periodic signals (derivation, section 6).
///
/// `f(W) = |p(i sqrt W)|^2` is a polynomial in W = w^2 with exact rational coefficients f_0 = a_1^2, f_1, f_2, ..., monic of
/// degree r - 1 <= 3; k_2 = 1/min f over W >= 0. A Hurwitz p makes f positive there. The minimum is at W = 0 or where f' = 0:
/// ```text
/// degree 2:   W = -f_1/2, if f_1 < 0;
/// degree 3:   W = (sqrt(f_2^2 - 3 f_1) - f_2)/3 (the greater zero of f', a local minimum), if it is real and positive, which
///             it is if f_1 < 0, or if f_2 < 0 and f_2^2 >= 3 f_1.
/// ```
///
/// # Guarantee
/// The enclosure contains k_2. It is exact up to rounding except for polynomials with roots so close to the imaginary axis
/// that `WORKING_PRECISION` does not tell them from one on it.
///
/// # Errors
/// [`RelativeDegreeError::Count`] and [`RelativeDegreeError::NotHurwitz`] for unusable coefficients,
/// [`RelativeDegreeError::Undecided`] when no positive lower bound of f was found.
pub fn k_2(a: &[Rational], precision: u32) -> Result<Enclosure, RelativeDegreeError> {
    check_hurwitz(a)?;
    let output = precision.clamp(64, MAX_PRECISION);
    let f = squared_modulus(a);
    let Some(place) = local_minimum(&f) else {
        return Ok(Enclosure::from_rational(&Rational::from(f[0].recip_ref()), output));
    };
    let enclosed = |x: &Rational| Enclosure::from_rational(x, WORKING_PRECISION);
    let local = f.iter().rev().fold(Enclosure::zero(WORKING_PRECISION), |sum, c| sum * &place + enclosed(c));
    if local.is_positive().is_true() {
        Ok(local.min(&enclosed(&f[0])).recip().at_precision(output))
    } else {
        Err(RelativeDegreeError::Undecided(Undecided::Resonance))
    }
}

/// The place of the local minimum of f over W > 0, if there is one. In the formula for degree 3 nothing cancels.
fn local_minimum(f: &[Rational]) -> Option<Enclosure> {
    let enclosed = |x: &Rational| Enclosure::from_rational(x, WORKING_PRECISION);
    match f {
        [_, f_1, _] if *f_1 < 0 => Some(enclosed(f_1) / -2),
        [_, f_1, f_2, _] if *f_1 < 0 || *f_2 < 0 => {
            let discriminant = Rational::from(f_2.square_ref()) - Rational::from(f_1 * 3u32);
            (discriminant >= 0).then(|| {
                let root = enclosed(&discriminant).sqrt();
                if *f_2 < 0 { (root - enclosed(f_2)) / 3 } else { -enclosed(f_1) / (root + enclosed(f_2)) }
            })
        }
        _ => None,
    }
}

/// The coefficients of |p(i w)|^2 in powers of W = w^2, from the constant term up.
///
/// With p(i w) = E(W) + i w O(W), E(W) = sum (-W)^k p_{2k}, O(W) = sum (-W)^k p_{2k+1}: f = E^2 + W O^2.
pub(super) fn squared_modulus(a: &[Rational]) -> Vec<Rational> {
    let one = Rational::from(1);
    let signed = |(k, c): (usize, &Rational)| if k % 2 == 0 { c.clone() } else { Rational::from(-c) };
    let coefficients: Vec<&Rational> = a.iter().chain([&one]).collect();
    let even: Vec<Rational> = coefficients.iter().step_by(2).copied().enumerate().map(signed).collect();
    let odd: Vec<Rational> = coefficients.iter().skip(1).step_by(2).copied().enumerate().map(signed).collect();
    let mut f = vec![Rational::new(); a.len() + 1];
    for (part, shift) in [(&even, 0), (&odd, 1)] {
        for (i, x) in part.iter().enumerate() {
            for (j, y) in part.iter().enumerate() {
                f[i + j + shift] += Rational::from(x * y);
            }
        }
    }
    f
}
