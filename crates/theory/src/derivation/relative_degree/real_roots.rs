//! Whether all roots of a polynomial are real, by Sturm's theorem.

use rug::Rational;
use std::cmp::Ordering;

/// The remainder of `dividend` by `divisor` (coefficients from the constant term up, last ones nonzero).
fn remainder(dividend: &[Rational], divisor: &[Rational]) -> Vec<Rational> {
    let mut rest = dividend.to_vec();
    let Some((leading, others)) = divisor.split_last() else {
        return rest;
    };
    while rest.len() >= divisor.len() {
        // The loop condition and a nonempty divisor give a last element; without one there is nothing to reduce.
        let Some(top) = rest.pop() else { break };
        let factor = top / leading;
        let shift = rest.len() - others.len();
        for (target, coefficient) in rest[shift..].iter_mut().zip(others) {
            *target -= Rational::from(&factor * coefficient);
        }
    }
    while rest.last().is_some_and(Rational::is_zero) {
        rest.pop();
    }
    rest
}

/// Whether every complex root of `s^n + a_n s^{n-1} + ... + a_1` is real (n >= 1), decided exactly.
///
/// In the Sturm chain p, p', -rem(p, p'), ..., c gcd(p, p') the number of sign changes at -oo minus the number at +oo
/// is the number of distinct real roots; p has n - deg gcd(p, p') distinct complex roots.
pub(super) fn all_real(a: &[Rational]) -> bool {
    let mut polynomial = a.to_vec();
    polynomial.push(Rational::from(1));
    let derivative: Vec<Rational> = (1u32..).zip(&polynomial[1..]).map(|(k, c)| Rational::from(c * k)).collect();
    let (mut left, mut right) = (Vec::new(), Vec::new());
    let (mut current, mut next) = (polynomial, derivative);
    let degree_of_gcd = loop {
        let leading = current.last().map_or(Ordering::Equal, Rational::cmp0);
        right.push(leading);
        left.push(if current.len().is_multiple_of(2) { leading.reverse() } else { leading });
        if next.is_empty() {
            break current.len() - 1;
        }
        let mut rest = remainder(&current, &next);
        // Only signs matter: a positive factor keeps the numbers short.
        let scale = rest.last().map(|c| -Rational::from(c.abs_ref()));
        for coefficient in &mut rest {
            if let Some(scale) = &scale {
                *coefficient /= scale;
            }
        }
        current = std::mem::replace(&mut next, rest);
    };
    let changes = |signs: &[Ordering]| signs.windows(2).filter(|pair| pair[0] != pair[1]).count();
    changes(&left) == changes(&right) + a.len() - degree_of_gcd
}
