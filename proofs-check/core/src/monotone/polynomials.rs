//! The polynomials inside an expression, whose derivatives are factored exactly.
//!
//! A derivative that touches 0 inside a box, as 3 (X - 1)^2 of X^3 - 3 X^2 + 3 X does, is never seen to be nonnegative in
//! rounded arithmetic. So every sum is split into p(X) + q(E) + rest with exact rational polynomials, and p' and q' into
//! c g_1 g_2^2 g_3^3 ..., factors that somebody proposes: the product is multiplied out and compared. An even power is
//! nonnegative whatever the box is.

use crate::expr::{Expr, Op};
use crate::interval::Interval;
use rug::Rational;

/// The highest degree, and the most bits of the coefficients of a polynomial, that are looked at.
const MAX_DEGREE: usize = 32;
const MAX_BITS: u32 = 8192;

/// Coefficients from the constant term up, the last one not 0; empty for the polynomial 0.
pub type Polynomial = Vec<Rational>;
/// A factor with its exponent.
pub type Factor = (Polynomial, u32);
/// Proposes the factors of a polynomial with leading coefficients 1; what multiplies them is its leading coefficient.
pub type Propose<'a> = dyn Fn(&Polynomial) -> Vec<Factor> + 'a;

/// c g_1 g_2^2 ...: the nonconstant factors with their exponents.
#[derive(Clone, Debug)]
struct Factored {
    constant: Rational,
    factors: Vec<Factor>,
}

/// What is left of an operation when its polynomials are taken away.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rest {
    /// Nothing.
    Nothing,
    /// What is left of its operands: it is a sum.
    Operands,
    /// Everything: it has no polynomials.
    Everything,
}

/// One operation's place in the sums of an expression.
#[derive(Clone, Debug)]
struct Place {
    rest: Rest,
    /// The derivatives of its polynomials in X and in E, where a sum ends and a factor is repeated.
    derivatives: [Option<Factored>; 2],
}

/// What is known of all operations of an expression.
pub(super) struct Polynomials {
    places: Vec<Place>,
}

/// A part as p(X) + q(E) + rest; constants belong to p.
#[derive(Clone)]
struct Split {
    at: usize,
    polynomials: [Polynomial; 2],
    rest: bool,
}

impl Split {
    /// The axis, if it is a polynomial in one variable.
    fn single(&self) -> Option<usize> {
        match (self.rest, self.polynomials[0].is_empty(), self.polynomials[1].is_empty()) {
            (false, _, true) => Some(0),
            (false, true, _) => Some(1),
            _ => None,
        }
    }

    fn constant(&self) -> Option<Rational> {
        let alone = !self.rest && self.polynomials[1].is_empty() && self.polynomials[0].len() <= 1;
        alone.then(|| self.polynomials[0].first().cloned().unwrap_or_default())
    }
}

impl Polynomials {
    pub(super) fn new(expr: &Expr, factor: &Propose<'_>) -> Polynomials {
        let mut places: Vec<Place> = Vec::new();
        let root = expr.fold(|op, a: Option<Split>, b: Option<Split>| {
            let found = split(op, &a, &b).filter(|(polynomials, _)| polynomials.iter().all(is_moderate));
            // A sum ends where something else is made of it.
            if found.is_none() {
                [&a, &b].into_iter().flatten().for_each(|part| finish(&mut places, part, factor));
            }
            let rest = match &found {
                Some((_, false)) => Rest::Nothing,
                Some((_, true)) => Rest::Operands,
                None => Rest::Everything,
            };
            places.push(Place { rest, derivatives: [None, None] });
            let (polynomials, _) = found.unwrap_or_default();
            Split { at: places.len() - 1, polynomials, rest: rest != Rest::Nothing }
        });
        root.iter().for_each(|part| finish(&mut places, part, factor));
        Polynomials { places }
    }

    /// What is left of the operation at this position without its polynomials.
    pub(super) fn rest(&self, at: usize) -> Rest {
        self.places[at].rest
    }

    /// The slopes along an axis of the polynomials in the sum that ends at this position, if they are worth a look.
    pub(super) fn slopes(&self, at: usize, along: usize, side: &Interval) -> Option<Interval> {
        let Factored { constant, factors } = self.places[at].derivatives[along].as_ref()?;
        let p = side.precision();
        let value =
            |g: &Polynomial| g.iter().rev().fold(Interval::int(0, p), |sum, a| sum * side + Interval::rational(a, p));
        let all = |product, (g, exponent): &Factor| product * value(g).powi(*exponent as i32);
        Some(factors.iter().fold(Interval::rational(constant, p), all))
    }
}

fn finish(places: &mut [Place], part: &Split, factor: &Propose<'_>) {
    places[part.at].derivatives = part.polynomials.each_ref().map(|p| factored(&derivative(p), factor));
}

fn is_moderate(p: &Polynomial) -> bool {
    let bits = |a: &Rational| a.numer().significant_bits().saturating_add(a.denom().significant_bits());
    p.len() <= MAX_DEGREE + 1 && p.iter().fold(0_u32, |sum, a| sum.saturating_add(bits(a))) <= MAX_BITS
}

/// The polynomials of an operation, and whether a rest is left, which only a sum may have; `None` where it is no sum and no
/// polynomial.
fn split(op: &Op, a: &Option<Split>, b: &Option<Split>) -> Option<([Polynomial; 2], bool)> {
    let one = |along: usize, p: Polynomial| {
        let mut polynomials = [Vec::new(), Vec::new()];
        let place = if p.len() <= 1 { 0 } else { along };
        polynomials[place] = p;
        Some((polynomials, false))
    };
    match (op, a, b) {
        (Op::Number(value), ..) => one(0, trimmed(vec![value.clone()])),
        (Op::Variable(along @ (0 | 1)), ..) => one(*along, vec![Rational::new(), Rational::from(1)]),
        (Op::Neg, Some(a), _) => Some((a.polynomials.each_ref().map(|p| scaled(p, &Rational::from(-1))), a.rest)),
        (Op::Add | Op::Sub, Some(a), Some(b)) => {
            let sign = Rational::from(if *op == Op::Add { 1 } else { -1 });
            let sum = |i: usize| plus(&a.polynomials[i], &scaled(&b.polynomials[i], &sign));
            Some(([sum(0), sum(1)], a.rest || b.rest))
        }
        (Op::Mul, Some(a), Some(b)) => {
            let (along, other) = (a.single()?, b.single()?);
            match (a.constant(), b.constant()) {
                (Some(c), _) => one(other, scaled(&b.polynomials[other], &c)),
                (_, Some(c)) => one(along, scaled(&a.polynomials[along], &c)),
                _ if along == other => {
                    let (p, q) = (&a.polynomials[along], &b.polynomials[along]);
                    (p.len() + q.len() <= MAX_DEGREE + 2).then(|| times(p, q)).and_then(|p| one(along, p))
                }
                _ => None,
            }
        }
        (Op::Div, Some(a), Some(b)) => {
            let divisor = b.constant().filter(|c| *c != 0)?;
            let along = a.single()?;
            one(along, scaled(&a.polynomials[along], &divisor.recip()))
        }
        (Op::Power(n), Some(a), _) => {
            let (along, n) = (a.single()?, usize::try_from(*n).ok()?);
            let p = &a.polynomials[along];
            let fits = n <= MAX_DEGREE && p.len().saturating_sub(1) * n <= MAX_DEGREE;
            let mut power = vec![Rational::from(1)];
            for _ in 0..if fits { n } else { return None } {
                power = times(&power, p);
                if !is_moderate(&power) {
                    return None;
                }
            }
            one(along, power)
        }
        _ => None,
    }
}

/// Without leading zeros.
pub fn trimmed(mut p: Polynomial) -> Polynomial {
    while p.last().is_some_and(|last| *last == 0) {
        p.pop();
    }
    p
}

/// The product with a number.
pub fn scaled(p: &Polynomial, factor: &Rational) -> Polynomial {
    trimmed(p.iter().map(|a| Rational::from(a * factor)).collect())
}

/// The sum.
pub fn plus(p: &Polynomial, q: &Polynomial) -> Polynomial {
    let coefficient = |p: &Polynomial, k: usize| p.get(k).cloned().unwrap_or_default();
    trimmed((0..p.len().max(q.len())).map(|k| coefficient(p, k) + coefficient(q, k)).collect())
}

/// The product.
pub fn times(p: &Polynomial, q: &Polynomial) -> Polynomial {
    let mut product = vec![Rational::new(); (p.len() + q.len()).saturating_sub(1)];
    for (i, a) in p.iter().enumerate() {
        for (j, b) in q.iter().enumerate() {
            product[i + j] += Rational::from(a * b);
        }
    }
    trimmed(product)
}

/// The derivative.
pub fn derivative(p: &Polynomial) -> Polynomial {
    p.iter().enumerate().skip(1).map(|(k, a)| Rational::from(a * k as u32)).collect()
}

/// The factors that are proposed for a polynomial, where one of them is repeated; checked by multiplying out.
fn factored(p: &Polynomial, factor: &Propose<'_>) -> Option<Factored> {
    let constant = p.last()?.clone();
    let factors = factor(p);
    let moderate = factors.iter().all(|(_, exponent)| (1..=MAX_DEGREE as u32).contains(exponent));
    if !moderate || factors.iter().all(|(_, exponent)| *exponent < 2) {
        return None;
    }
    let power = |(g, exponent): &Factor| (0..*exponent).fold(vec![Rational::from(1)], |all, _| times(&all, g));
    let product = factors.iter().fold(vec![constant.clone()], |all, factor| times(&all, &power(factor)));
    (product == *p).then_some(Factored { constant, factors })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::ARGUMENTS;
    use crate::propose::square_free;

    fn integers(coefficients: &[i32]) -> Polynomial {
        coefficients.iter().map(|a| Rational::from(*a)).collect()
    }

    #[test]
    fn square_free_factors() {
        // -2 (X + 1) (X - 1)^2 (X - 3)^3
        let cube = times(&integers(&[-3, 1]), &times(&integers(&[-3, 1]), &integers(&[-3, 1])));
        let p = times(&times(&integers(&[-2, -2]), &integers(&[1, -2, 1])), &cube);
        let found = factored(&p, &square_free).unwrap();
        assert_eq!(found.constant, -2);
        let expected = [(integers(&[1, 1]), 1), (integers(&[-1, 1]), 2), (integers(&[-3, 1]), 3)];
        assert_eq!(found.factors, expected);
        for simple in [&[][..], &[5], &[0, 1], &[-1, 0, 1]] {
            assert!(factored(&integers(simple), &square_free).is_none(), "{simple:?}");
        }
    }

    #[test]
    fn wrong_factors_are_refused() {
        // (X - 1)^2, and what is said of it.
        let p = integers(&[1, -2, 1]);
        for factors in [
            vec![],
            vec![(integers(&[-1, 1]), 1)],
            vec![(integers(&[-1, 1]), 1), (integers(&[-1, 1]), 1)],
            vec![(integers(&[-1, 1]), 3)],
            vec![(integers(&[1, 1]), 2)],
            vec![(integers(&[-1, 1]), 2), (integers(&[5]), 1)],
            vec![(integers(&[-1, 1]), 2), (integers(&[5, 1]), 0)],
            vec![(integers(&[-1, 1]), 2), (integers(&[]), 1)],
            vec![(integers(&[-1, 1]), u32::MAX)],
        ] {
            assert!(factored(&p, &|_| factors.clone()).is_none(), "{factors:?}");
        }
        assert!(factored(&p, &|_| vec![(integers(&[-1, 1]), 2)]).is_some());
    }

    #[test]
    fn sums_are_split_where_they_end() {
        let count = |text: &str| {
            let found = Polynomials::new(&Expr::parse(text, ARGUMENTS).unwrap(), &square_free);
            found.places.iter().flat_map(|place| &place.derivatives).flatten().count()
        };
        for (text, expected) in [
            ("X^3 - 3*X^2 + 3*X", 1),
            ("X^3 + atan(E) - 3*X^2 + E + 3*X", 1),
            ("(X^3 - 3*X^2 + 3*X)*(1 + E)", 1),
            ("sqrt(X^3 - 3*X^2 + 3*X + 7) + E^3/3 - E^2 + E", 2),
            ("(X - 1)^3 + 1", 1),
            ("X^3 + X^2 + X", 0),
            // That of X^3 alone.
            ("pi*X^3 - 3*X^2 + 3*X", 1),
            ("(X - 1)^1000", 0),
            ("(1e4000*X - 1)^3", 0),
        ] {
            assert_eq!(count(text), expected, "{text}");
        }
    }
}
