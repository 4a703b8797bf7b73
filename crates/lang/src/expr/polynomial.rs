//! Where parts of an expression are polynomials in one variable: their derivatives, factored exactly.
//!
//! A derivative that touches 0 inside a box, as that of `X^3 - 3*X^2 + 3*X` does at X = 1, is not seen to be nonnegative by
//! any enclosure with rounded ends. A polynomial with rational coefficients is known exactly: its derivative is
//! `leading f_1 f_2^2 f_3^3 ...` with square-free f_i (Yun's algorithm; the product is compared with the derivative), and
//! an even power is nonnegative on any box.

use super::syntax::{Algebra, Argument, Binary, Node, Unary, evaluate};
use rug::{Integer, Rational};
use sigmastar_exact::enclosure::Enclosure;

/// The highest degree that is looked at.
const MAX_DEGREE: usize = 32;

/// The most bits of all coefficients of a polynomial together.
const MAX_BITS: u64 = 8192;

/// A polynomial: the coefficient of the k-th power at k, the last one not 0; none for the polynomial 0.
type Coefficients = Vec<Rational>;

fn trimmed(mut p: Coefficients) -> Coefficients {
    while p.last().is_some_and(|last| *last == 0) {
        p.pop();
    }
    p
}

fn sum(a: &[Rational], b: &[Rational], sign: i32) -> Coefficients {
    let at = |p: &[Rational], k: usize| p.get(k).cloned().unwrap_or_default();
    trimmed((0..a.len().max(b.len())).map(|k| at(a, k) + at(b, k) * sign).collect())
}

fn product(a: &[Rational], b: &[Rational]) -> Coefficients {
    if a.is_empty() || b.is_empty() {
        return Vec::new();
    }
    let mut result = vec![Rational::new(); a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (k, y) in b.iter().enumerate() {
            result[i + k] += Rational::from(x * y);
        }
    }
    result
}

fn derivative(p: &[Rational]) -> Coefficients {
    p.iter().enumerate().skip(1).map(|(k, a)| Rational::from(a * k as u32)).collect()
}

/// Quotient and remainder by a polynomial that is not 0.
fn divide(a: &[Rational], b: &[Rational]) -> (Coefficients, Coefficients) {
    let (mut rest, degree) = (a.to_vec(), b.len() - 1);
    let mut quotient = vec![Rational::new(); a.len().saturating_sub(degree)];
    for shift in (0..quotient.len()).rev() {
        let factor = Rational::from(&rest[shift + degree] / &b[degree]);
        for (k, value) in b.iter().enumerate() {
            rest[shift + k] -= Rational::from(&factor * value);
        }
        quotient[shift] = factor;
    }
    (trimmed(quotient), trimmed(rest))
}

/// The greatest common divisor with leading coefficient 1; 0 where both are 0.
fn common(a: &[Rational], b: &[Rational]) -> Coefficients {
    let (mut a, mut b) = (a.to_vec(), b.to_vec());
    while !b.is_empty() {
        let rest = divide(&a, &b).1;
        a = monic(b);
        b = rest;
    }
    monic(a)
}

fn monic(p: Coefficients) -> Coefficients {
    let Some(leading) = p.last().cloned() else { return p };
    p.into_iter().map(|a| a / &leading).collect()
}

/// A derivative as `leading` times the product of the i-th factor to the power i.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FactoredDerivative {
    leading: Rational,
    factors: Vec<(Coefficients, i32)>,
}

impl FactoredDerivative {
    /// The factors of the derivative of a polynomial; `None` where plain evaluation sees its sign as well, because
    /// no two coefficients have different signs.
    fn new(polynomial: &[Rational]) -> Option<FactoredDerivative> {
        let whole = derivative(polynomial);
        let leading = whole.last()?.clone();
        if !(whole.iter().any(|a| *a > 0) && whole.iter().any(|a| *a < 0)) {
            return None;
        }
        let start = monic(whole.clone());
        let slope = derivative(&start);
        let shared = common(&start, &slope);
        let mut rest = divide(&start, &shared).0;
        let mut other = sum(&divide(&slope, &shared).0, &derivative(&rest), -1);
        let mut factors = Vec::new();
        let mut power = 1;
        while rest.len() > 1 {
            let factor = common(&rest, &other);
            rest = divide(&rest, &factor).0;
            other = sum(&divide(&other, &factor).0, &derivative(&rest), -1);
            if factor.len() > 1 {
                factors.push((factor, power));
            }
            power += 1;
        }
        let factored = FactoredDerivative { leading, factors };
        (factored.expanded() == whole).then_some(factored)
    }

    fn expanded(&self) -> Coefficients {
        let mut all = vec![self.leading.clone()];
        for (factor, power) in &self.factors {
            for _ in 0..*power {
                all = product(&all, factor);
            }
        }
        all
    }

    /// Contains the derivative at every point of a side.
    pub(super) fn enclose(&self, side: &Enclosure) -> Enclosure {
        let p = side.precision();
        let horner = |factor: &Coefficients| {
            let number = |a: &Rational| Enclosure::from_rational(a, p);
            factor.iter().rev().fold(Enclosure::zero(p), |value, a| value * side + number(a))
        };
        let start = Enclosure::from_rational(&self.leading, p);
        self.factors
            .iter()
            .fold(start, |value, (factor, power)| value * horner(factor).pow_integer(&Integer::from(*power)))
    }
}

/// What a node is as a sum of a polynomial in X, one in E and a rest.
#[derive(Clone, Debug)]
pub(super) enum Kind {
    /// There is no rest.
    Polynomial,
    /// A sum, difference or negative: the rest is that of the operands.
    Sum,
    /// There is no polynomial part.
    Rest,
}

/// The role of one node.
#[derive(Clone, Debug)]
pub(super) struct Role {
    pub(super) kind: Kind,
    /// The derivatives of the polynomial parts in X and in E where a sum ends and they have coefficients of both signs.
    pub(super) derivatives: [Option<FactoredDerivative>; 2],
}

/// The polynomial parts of a node, and its place.
struct Parts {
    at: usize,
    polynomials: [Coefficients; 2],
    pure: bool,
}

impl Parts {
    fn is_constant(&self) -> bool {
        self.pure && self.polynomials[0].len() <= 1 && self.polynomials[1].is_empty()
    }

    /// The variable that a polynomial without rest is about: the first one for a constant.
    fn only(&self) -> Option<usize> {
        match (self.pure, &self.polynomials) {
            (true, [_, e]) if e.is_empty() => Some(0),
            (true, [x, _]) if x.is_empty() => Some(1),
            _ => None,
        }
    }
}

fn fits(p: &[Rational]) -> bool {
    let bits = |a: &Rational| u64::from(a.numer().significant_bits()) + u64::from(a.denom().significant_bits());
    p.len() <= MAX_DEGREE + 1 && p.iter().map(bits).sum::<u64>() <= MAX_BITS
}

/// Finds the polynomial parts; constants belong to the part in X.
#[derive(Default)]
struct Finder {
    roles: Vec<Role>,
}

impl Finder {
    fn node(&mut self, kind: Kind, polynomials: [Coefficients; 2]) -> Parts {
        let fitting = polynomials.iter().all(|p| fits(p));
        let (kind, polynomials) = if fitting { (kind, polynomials) } else { (Kind::Rest, [Vec::new(), Vec::new()]) };
        let parts = Parts { at: self.roles.len(), polynomials, pure: matches!(kind, Kind::Polynomial) };
        self.roles.push(Role { kind, derivatives: [None, None] });
        parts
    }

    /// A sum ends here.
    fn end(&mut self, parts: &Parts) {
        // A polynomial in one power is nondecreasing or nonincreasing for all to see.
        self.roles[parts.at].derivatives = parts.polynomials.each_ref().map(|p| FactoredDerivative::new(p));
    }

    fn rest(&mut self, operands: &[&Parts]) -> Parts {
        operands.iter().for_each(|parts| self.end(parts));
        self.node(Kind::Rest, [Vec::new(), Vec::new()])
    }

    fn sum(&mut self, a: &Parts, b: &Parts, sign: i32) -> Parts {
        let kind = if a.pure && b.pure { Kind::Polynomial } else { Kind::Sum };
        let polynomials = [0, 1].map(|i| sum(&a.polynomials[i], &b.polynomials[i], sign));
        if polynomials.iter().all(|p| fits(p)) { self.node(kind, polynomials) } else { self.rest(&[a, b]) }
    }

    /// A polynomial in one variable.
    fn single(&mut self, along: usize, p: Coefficients) -> Parts {
        let mut polynomials = [Vec::new(), Vec::new()];
        // A constant is in the first part, so that the other one is empty without it.
        let place = if p.len() <= 1 { 0 } else { along };
        polynomials[place] = p;
        self.node(Kind::Polynomial, polynomials)
    }
}

impl Algebra for Finder {
    type Value = Parts;

    fn number(&mut self, value: &Rational) -> Parts {
        self.single(0, trimmed(vec![value.clone()]))
    }

    fn pi(&mut self) -> Parts {
        self.node(Kind::Rest, [Vec::new(), Vec::new()])
    }

    fn variable(&mut self, variable: Argument) -> Parts {
        let along = match variable {
            Argument::X => 0,
            Argument::E => 1,
        };
        self.single(along, vec![Rational::new(), Rational::from(1)])
    }

    fn unary(&mut self, operation: Unary, a: Parts) -> Parts {
        match operation {
            Unary::Neg => {
                let kind = if a.pure { Kind::Polynomial } else { Kind::Sum };
                self.node(kind, a.polynomials.map(|p| p.into_iter().map(|a| -a).collect()))
            }
            _ => self.rest(&[&a]),
        }
    }

    fn binary(&mut self, operation: Binary, a: Parts, b: Parts) -> Parts {
        match operation {
            Binary::Add => self.sum(&a, &b, 1),
            Binary::Sub => self.sum(&a, &b, -1),
            Binary::Mul => {
                let along = match (a.only(), b.only()) {
                    (Some(i), Some(k)) if i == k || b.is_constant() => i,
                    (Some(_), Some(k)) if a.is_constant() => k,
                    _ => return self.rest(&[&a, &b]),
                };
                let side = |parts: &Parts| {
                    if parts.is_constant() { parts.polynomials[0].clone() } else { parts.polynomials[along].clone() }
                };
                let (left, right) = (side(&a), side(&b));
                if left.len() + right.len() > MAX_DEGREE + 2 {
                    return self.rest(&[&a, &b]);
                }
                let p = product(&left, &right);
                if fits(&p) { self.single(along, p) } else { self.rest(&[&a, &b]) }
            }
            Binary::Div => match (a.only(), b.is_constant().then(|| b.polynomials[0].first()).flatten()) {
                (Some(along), Some(by)) => {
                    let p: Coefficients = a.polynomials[along].iter().map(|a| Rational::from(a / by)).collect();
                    if fits(&p) { self.single(along, p) } else { self.rest(&[&a, &b]) }
                }
                _ => self.rest(&[&a, &b]),
            },
            Binary::Pow | Binary::Min | Binary::Max => self.rest(&[&a, &b]),
        }
    }

    fn power(&mut self, base: Parts, exponent: i32) -> Parts {
        let (Some(along), Ok(exponent)) = (base.only(), usize::try_from(exponent)) else { return self.rest(&[&base]) };
        let p = &base.polynomials[along];
        if p.len().saturating_sub(1) * exponent > MAX_DEGREE || exponent > MAX_DEGREE {
            return self.rest(&[&base]);
        }
        let mut result = vec![Rational::from(1)];
        for _ in 0..exponent {
            result = product(&result, p);
            if !fits(&result) {
                return self.rest(&[&base]);
            }
        }
        self.single(along, result)
    }
}

/// The roles of all nodes, in their order; empty where no polynomial part has a derivative worth factoring.
pub(super) fn roles(nodes: &[Node]) -> Box<[Role]> {
    let mut finder = Finder::default();
    let whole = evaluate(nodes, &mut finder);
    finder.end(&whole);
    let useful = |role: &Role| role.derivatives.iter().any(Option::is_some);
    if finder.roles.iter().any(useful) { finder.roles.into() } else { Box::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Expr, Variables};

    fn whole(numbers: &[i32]) -> Coefficients {
        numbers.iter().map(|number| Rational::from(*number)).collect()
    }

    /// (X - 1)^2 (X - 2)^3 (X + 3), with a leading coefficient.
    #[test]
    fn factors_with_their_powers() {
        let (double, triple, simple) = (whole(&[-1, 1]), whole(&[-2, 1]), whole(&[3, 1]));
        let cube = product(&triple, &product(&triple, &triple));
        let all = product(&whole(&[-7]), &product(&product(&product(&double, &double), &cube), &simple));
        let mut integral = vec![Rational::new()];
        integral.extend(all.iter().enumerate().map(|(k, a)| Rational::from(a / (k as u32 + 1))));
        let factored = FactoredDerivative::new(&integral).unwrap();
        assert_eq!(factored.leading, -7);
        assert_eq!(factored.factors, [(simple, 1), (double, 2), (triple, 3)]);
        assert_eq!(factored.expanded(), all);
    }

    #[test]
    fn an_even_power_is_nonnegative_on_any_box() {
        // The zero 1/3 is no end of a box and no binary number.
        let factored = FactoredDerivative::new(&trimmed(vec![
            Rational::new(),
            Rational::from((1, 9)),
            Rational::from((-1, 3)),
            Rational::from((1, 3)),
        ]))
        .unwrap();
        let side = Enclosure::between(&Rational::from((1, 4)), &Rational::from((1, 2)), 64);
        let value = factored.enclose(&side);
        assert!(value.is_nonnegative().is_true() && value.upper_f64() < 0.2, "{value:?}");
    }

    #[test]
    fn polynomial_parts_of_sums_are_found() {
        let useful = |text: &str| {
            let expr = Expr::parse(text, Variables::XAndE).unwrap();
            let roles = roles(&expr.nodes);
            roles.iter().flat_map(|role| &role.derivatives).flatten().count()
        };
        for (text, count) in [
            ("X^3 - 3*X^2 + 3*X", 1),
            ("E + X^3 - 3*X^2 + atan(E) + 3*X", 1),
            ("(X^3 - 3*X^2 + 3*X)*(1 + E)", 1),
            ("X^3/2 - 3*X^2/2 + 3*X/2 + E^3 - 3*E^2 + 3*E", 2),
            ("sqrt(1 + X^3 - 3*X^2 + 3*X)", 1),
            ("-(3*X^2 - X^3) + 3*X", 1),
            ("(X - 1)^3 + 1", 1),
            ("X^3 + 3*X^2 + 3*X", 0),
            ("4.822 + X + atan(E*(X + 0.189))", 0),
            // Beyond the limits there is nothing to find, and nothing to pay for.
            ("X^40 - X^39", 0),
            ("(X - 1)^1000", 0),
        ] {
            assert_eq!(useful(text), count, "{text}");
        }
    }
}
