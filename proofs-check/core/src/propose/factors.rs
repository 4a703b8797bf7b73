//! Square-free factors of a polynomial (Yun).

use crate::monotone::polynomials::{Factor, Polynomial, derivative, plus, scaled, trimmed};
use rug::Rational;

/// The square-free factors of a polynomial with their exponents, in the order of these.
pub fn square_free(p: &Polynomial) -> Vec<Factor> {
    let Some(constant) = p.last() else { return Vec::new() };
    let d = derivative(p);
    let shared = common(p, &d);
    if shared.len() <= 1 {
        return vec![(monic(p), 1)];
    }
    let (mut bare, mut slope) =
        (divided(&monic(p), &shared).0, divided(&scaled(&d, &Rational::from(constant.recip_ref())), &shared).0);
    let mut factors = Vec::new();
    let mut exponent = 1;
    while bare.len() > 1 {
        let left = plus(&slope, &scaled(&derivative(&bare), &Rational::from(-1)));
        let factor = common(&bare, &left);
        (bare, slope) = (divided(&bare, &factor).0, divided(&left, &factor).0);
        if factor.len() > 1 {
            factors.push((factor, exponent));
        }
        exponent += 1;
    }
    factors
}

/// Quotient and remainder by a polynomial other than 0.
fn divided(p: &Polynomial, q: &Polynomial) -> (Polynomial, Polynomial) {
    let Some(lead) = q.last() else { return (Vec::new(), p.clone()) };
    let (mut quotient, mut rest) = (Vec::new(), p.clone());
    while rest.len() >= q.len() {
        let factor = rest.pop().unwrap_or_default() / lead;
        let shift = rest.len() + 1 - q.len();
        for (k, b) in q[..q.len() - 1].iter().enumerate() {
            rest[shift + k] -= Rational::from(&factor * b);
        }
        quotient.push(factor);
    }
    quotient.reverse();
    (trimmed(quotient), trimmed(rest))
}

/// The greatest common divisor, with leading coefficient 1.
fn common(p: &Polynomial, q: &Polynomial) -> Polynomial {
    let (mut p, mut q) = (monic(p), monic(q));
    while !q.is_empty() {
        let (_, rest) = divided(&p, &q);
        (p, q) = (q, monic(&rest));
    }
    p
}

fn monic(p: &Polynomial) -> Polynomial {
    p.last().map_or_else(Vec::new, |lead| scaled(p, &Rational::from(lead.recip_ref())))
}
