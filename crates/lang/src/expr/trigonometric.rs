//! Expressions in t that are trigonometric polynomials of a given period, recognised exactly.

use super::Expr;
use super::enclose::{binary, power, unary};
use super::fourier::Fourier;
use super::monomial::Monomial;
use super::syntax::{Argument, Binary, NodeKind, Unary};
use super::{Operations, PlantVariable, Walk};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use std::ops::Range;

/// The highest harmonic that is read.
pub const MAX_HARMONIC: usize = 32;

/// A trigonometric polynomial with enclosed coefficients.
pub type TrigonometricPolynomial = Fourier<Enclosure>;

/// Why an expression in t is not read as a trigonometric polynomial, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotTrigonometric {
    /// The bytes of the part at fault.
    pub span: Range<usize>,
    /// What is wrong with it, as a sentence without a final stop.
    pub reason: String,
}

/// A value on the way: exact where it can be, because only exact frequencies can be told to have the period.
#[derive(Clone, Debug)]
enum Term {
    /// `slope t + offset` with a slope that is not 0.
    Line { slope: Monomial, offset: Enclosure },
    /// A constant, with its exact form where there is one.
    Constant { value: Enclosure, exact: Option<Monomial> },
    /// Everything else.
    Polynomial(TrigonometricPolynomial),
}

impl TrigonometricPolynomial {
    /// The coefficients of `exp(i k w t)`, k = 0, 1, ..., as (real, imaginary); those of -k are their conjugates.
    fn complex(&self) -> Vec<[Enclosure; 2]> {
        let zero = Enclosure::zero(self.mean.precision());
        let halves = self.harmonics.iter().map(|[a, b]| [a / 2, (b / 2).negate()]);
        std::iter::once([self.mean.clone(), zero]).chain(halves).collect()
    }

    /// The product with a number.
    #[must_use]
    pub fn scaled(&self, factor: &Enclosure) -> TrigonometricPolynomial {
        self.map(|part| part * factor)
    }

    /// The derivative with respect to the angle w t.
    #[must_use]
    pub fn derivative(&self) -> TrigonometricPolynomial {
        let harmonics = self.harmonics.iter().zip(1_i64..).map(|([a, b], k)| [b * k, (a * k).negate()]).collect();
        TrigonometricPolynomial { mean: Enclosure::zero(self.mean.precision()), harmonics }
    }

    /// The sum of the two, the second multiplied by `sign`.
    #[must_use]
    pub fn plus(&self, other: &TrigonometricPolynomial, sign: i64) -> TrigonometricPolynomial {
        self.with(other, &Enclosure::zero(self.mean.precision()), |a, b| a + b * sign)
    }

    /// The product: the convolution of the complex coefficients.
    #[must_use]
    pub fn times(&self, other: &TrigonometricPolynomial) -> TrigonometricPolynomial {
        if other.harmonics.is_empty() {
            return self.scaled(&other.mean);
        }
        if self.harmonics.is_empty() {
            return other.scaled(&self.mean);
        }
        let (left, right) = (self.complex(), other.complex());
        let precision = self.mean.precision();
        let at = |list: &[[Enclosure; 2]], k: i64| {
            let [re, im] = list.get(k.unsigned_abs() as usize)?.clone();
            Some(if k < 0 { [re, im.negate()] } else { [re, im] })
        };
        let degree = (left.len() + right.len() - 2) as i64;
        let reach = left.len() as i64 - 1;
        let mut coefficients = (0..=degree).map(|k| {
            let mut sum = [Enclosure::zero(precision), Enclosure::zero(precision)];
            for j in -reach..=reach {
                if let (Some([a, b]), Some([c, d])) = (at(&left, j), at(&right, k - j)) {
                    sum = [&sum[0] + &a * &c - &b * &d, &sum[1] + &a * &d + &b * &c];
                }
            }
            sum
        });
        let mean = coefficients.next().map_or_else(|| Enclosure::zero(precision), |[re, _]| re);
        let harmonics = coefficients.map(|[re, im]| [re * 2, (im * 2).negate()]).collect();
        TrigonometricPolynomial { mean, harmonics }
    }

    /// An enclosure of the value where `w t` lies in `angle`.
    #[must_use]
    pub fn at(&self, angle: &Enclosure) -> Enclosure {
        self.harmonics.iter().zip(1_i64..).fold(self.mean.clone(), |sum, ([a, b], k)| {
            let angle = angle * k;
            sum + a * angle.cos() + b * angle.sin()
        })
    }
}

impl Expr {
    /// The expression in t as a trigonometric polynomial of the given period.
    ///
    /// Built from constants, `cos` and `sin` of `k 2 pi t/period + phase` with integer k (recognised exactly, so that the period
    /// is proved), sums, differences, products, whole powers, and quotients by constants. Guarantee: for every t the value
    /// of the expression is that of the polynomial with some coefficients in the enclosures, the same for all t; it is
    /// defined for every t.
    ///
    /// # Errors
    /// The first operation that leaves this form, a frequency that is not proved to be a multiple of 2 pi/period, and
    /// harmonics above [`MAX_HARMONIC`].
    pub fn trigonometric(
        &self,
        period: &Monomial,
        precision: u32,
    ) -> Result<TrigonometricPolynomial, NotTrigonometric> {
        let mut stack: Vec<Term> = Vec::new();
        for node in self.nodes.iter() {
            // The parser pushes a node only after its operands, so the stack holds them here.
            let mut pop = || stack.pop().expect("operands precede their operation");
            let value = match &node.kind {
                NodeKind::Number(number) => {
                    constant(Enclosure::from_rational(number, precision), Some(Monomial::rational(number.clone())))
                }
                NodeKind::Pi => constant(Enclosure::pi(precision), Some(Monomial::pi())),
                NodeKind::Variable(Argument::X) => {
                    let slope = Monomial::rational(Rational::from(1));
                    Ok(Term::Line { slope, offset: Enclosure::zero(precision) })
                }
                NodeKind::Variable(Argument::E) => Err("only t may occur here".to_owned()),
                NodeKind::Unary(operation) => apply(*operation, pop(), period, precision),
                NodeKind::Binary(operation) => {
                    let b = pop();
                    combine(*operation, pop(), b)
                }
                NodeKind::Power(exponent) => raise(pop(), *exponent),
            };
            let value = value.and_then(of_few_harmonics);
            stack.push(value.map_err(|reason| NotTrigonometric { span: node.span.clone(), reason })?);
        }
        // Every parsed expression leaves exactly one value.
        match stack.pop().expect("an expression has one value") {
            Term::Constant { value, .. } => Ok(TrigonometricPolynomial::constant(value)),
            Term::Polynomial(polynomial) => Ok(polynomial),
            Term::Line { .. } => {
                let reason = "t occurs outside of sin and cos, so this has no period".to_owned();
                Err(NotTrigonometric { span: 0..self.text.len(), reason })
            }
        }
    }
}

/// Evaluation of a plant's formulas at x = 0 and e = 0, with parameters in enclosures, as trigonometric polynomials in t.
struct AtOrigin<'a> {
    parameters: &'a [Enclosure],
    period: &'a Monomial,
    precision: u32,
}

impl AtOrigin<'_> {
    fn exact(&self, value: &Rational) -> Result<Term, String> {
        constant(Enclosure::from_rational(value, self.precision), Some(Monomial::rational(value.clone())))
    }
}

impl Operations for AtOrigin<'_> {
    type Value = Result<Term, String>;

    fn number(&mut self, value: &Rational) -> Self::Value {
        self.exact(value)
    }

    fn pi(&mut self) -> Self::Value {
        constant(Enclosure::pi(self.precision), Some(Monomial::pi()))
    }

    fn variable(&mut self, variable: PlantVariable) -> Self::Value {
        match variable {
            PlantVariable::Time => {
                let slope = Monomial::rational(Rational::from(1));
                Ok(Term::Line { slope, offset: Enclosure::zero(self.precision) })
            }
            PlantVariable::State(_) | PlantVariable::Error => self.exact(&Rational::new()),
            PlantVariable::Parameter(index) => match self.parameters.get(index) {
                Some(value) => constant(value.clone(), None),
                None => Err("a parameter has no interval".to_owned()),
            },
        }
    }

    fn unary(&mut self, operation: Unary, a: &Self::Value) -> Self::Value {
        apply(operation, a.clone()?, self.period, self.precision).and_then(of_few_harmonics)
    }

    fn binary(&mut self, operation: Binary, a: &Self::Value, b: &Self::Value) -> Self::Value {
        combine(operation, a.clone()?, b.clone()?).and_then(of_few_harmonics)
    }

    fn power(&mut self, base: &Self::Value, exponent: i32) -> Self::Value {
        raise(base.clone()?, exponent).and_then(of_few_harmonics)
    }

    fn step(&mut self, _: &Self::Value) -> Self::Value {
        Err("a step is not a trigonometric polynomial".to_owned())
    }
}

impl Walk {
    /// The formulas at x = 0 and e = 0 as trigonometric polynomials of the given period, with each parameter of which an interval is known
    /// anywhere in its enclosure.
    ///
    /// Guarantee: as for [`Expr::trigonometric`], for every choice of the parameters.
    ///
    /// # Errors
    /// Why one of them is none.
    pub fn trigonometric_at_origin(
        &self,
        parameters: &[Enclosure],
        period: &Monomial,
        precision: u32,
    ) -> Result<Vec<TrigonometricPolynomial>, String> {
        let values = self.evaluate(&mut AtOrigin { parameters, period, precision });
        values.into_iter().map(|value| polynomial(value?)).collect()
    }
}

/// A term without harmonics above [`MAX_HARMONIC`].
fn of_few_harmonics(term: Term) -> Result<Term, String> {
    match term {
        Term::Polynomial(polynomial) if polynomial.harmonics.len() > MAX_HARMONIC => {
            Err(format!("harmonics above {MAX_HARMONIC} are not read"))
        }
        term => Ok(term),
    }
}

/// A constant, which must have a bounded value.
fn constant(value: Enclosure, exact: Option<Monomial>) -> Result<Term, String> {
    match value.is_bounded() {
        true => Ok(Term::Constant { value, exact }),
        false => Err("this constant has no value that can be enclosed".to_owned()),
    }
}

/// The polynomial that a term is; a line is none.
fn polynomial(term: Term) -> Result<TrigonometricPolynomial, String> {
    match term {
        Term::Constant { value, .. } => Ok(TrigonometricPolynomial::constant(value)),
        Term::Polynomial(polynomial) => Ok(polynomial),
        Term::Line { .. } => Err("t occurs outside of sin and cos, so this is not periodic".to_owned()),
    }
}

fn apply(operation: Unary, a: Term, period: &Monomial, precision: u32) -> Result<Term, String> {
    match (operation, a) {
        (_, Term::Constant { value, exact }) => {
            let exact = exact.and_then(|exact| match operation {
                Unary::Neg => Some(exact.neg()),
                Unary::Sqrt => exact.sqrt(),
                _ => None,
            });
            constant(unary(operation, &value), exact)
        }
        (Unary::Neg, Term::Line { slope, offset }) => Ok(Term::Line { slope: slope.neg(), offset: offset.negate() }),
        (Unary::Neg, Term::Polynomial(p)) => {
            Ok(Term::Polynomial(TrigonometricPolynomial::constant(Enclosure::zero(precision)).plus(&p, -1)))
        }
        (Unary::Cos | Unary::Sin, Term::Line { slope, offset }) => {
            let turns = Monomial::rational(Rational::from(2)).mul(&Monomial::pi());
            let ratio = turns.and_then(|turns| slope.mul(period)?.div(&turns));
            let k = ratio.and_then(|ratio| ratio.as_rational().filter(|k| k.is_integer()).map(|k| k.numer().clone()));
            let Some(k) = k else {
                return Err("the frequency is not proved to be a multiple of 2 pi / period".to_owned());
            };
            let Some(harmonic) = k.clone().abs().to_usize().filter(|k| (1..=MAX_HARMONIC).contains(k)) else {
                return Err(format!("harmonics above {MAX_HARMONIC} are not read"));
            };
            let zero = Enclosure::zero(precision);
            let (cos, sin) = (offset.cos(), offset.sin());
            let sign = if k < 0 { -1_i64 } else { 1 };
            // cos(k wt + p) = cos p cos(k wt) - sin p sin(k wt); sin(k wt + p) = sin p cos(k wt) + cos p sin(k wt).
            let last = match operation {
                Unary::Cos => [cos, (sin * sign).negate()],
                _ => [sin, cos * sign],
            };
            let mut harmonics = vec![[zero.clone(), zero.clone()]; harmonic];
            harmonics[harmonic - 1] = last;
            Ok(Term::Polynomial(TrigonometricPolynomial { mean: zero, harmonics }))
        }
        _ => Err("this function of t is not a trigonometric polynomial".to_owned()),
    }
}

fn combine(operation: Binary, a: Term, b: Term) -> Result<Term, String> {
    match (operation, a, b) {
        (_, Term::Constant { value: a, exact: x }, Term::Constant { value: b, exact: y }) => {
            let exact = x.zip(y).and_then(|(x, y)| match operation {
                Binary::Add => x.add(&y),
                Binary::Sub => x.add(&y.neg()),
                Binary::Mul => x.mul(&y),
                Binary::Div => x.div(&y),
                _ => None,
            });
            constant(binary(operation, &a, &b), exact)
        }
        (Binary::Add, Term::Line { slope, offset }, Term::Constant { value, .. })
        | (Binary::Add, Term::Constant { value, .. }, Term::Line { slope, offset }) => {
            Ok(Term::Line { slope, offset: offset + value })
        }
        (Binary::Sub, Term::Line { slope, offset }, Term::Constant { value, .. }) => {
            Ok(Term::Line { slope, offset: offset - value })
        }
        (Binary::Sub, Term::Constant { value, .. }, Term::Line { slope, offset }) => {
            Ok(Term::Line { slope: slope.neg(), offset: value - offset })
        }
        (Binary::Add | Binary::Sub, Term::Line { slope, offset }, Term::Line { slope: other, offset: rest }) => {
            let minus = operation == Binary::Sub;
            let sum = slope.add(&if minus { other.neg() } else { other });
            let offset = if minus { offset - rest } else { offset + rest };
            match sum {
                Some(slope) if slope.as_rational().is_some_and(|slope| *slope == 0) => constant(offset, None),
                Some(slope) => Ok(Term::Line { slope, offset }),
                None => Err("this sum of multiples of t has no exact frequency".to_owned()),
            }
        }
        (Binary::Mul, Term::Line { slope, offset }, Term::Constant { value, exact })
        | (Binary::Mul, Term::Constant { value, exact }, Term::Line { slope, offset }) => {
            scaled(exact.and_then(|exact| slope.mul(&exact)), offset * value)
        }
        (Binary::Div, Term::Line { slope, offset }, Term::Constant { value, exact }) => {
            scaled(exact.and_then(|exact| slope.div(&exact)), offset / value)
        }
        (Binary::Div, Term::Polynomial(p), Term::Constant { value, .. }) => {
            let inverse = value.recip();
            if !inverse.is_bounded() {
                return Err("a division by a number that may be 0".to_owned());
            }
            Ok(Term::Polynomial(p.times(&TrigonometricPolynomial::constant(inverse))))
        }
        (Binary::Add, a, b) => Ok(Term::Polynomial(polynomial(a)?.plus(&polynomial(b)?, 1))),
        (Binary::Sub, a, b) => Ok(Term::Polynomial(polynomial(a)?.plus(&polynomial(b)?, -1))),
        (Binary::Mul, a, b) => Ok(Term::Polynomial(polynomial(a)?.times(&polynomial(b)?))),
        _ => Err("this operation on a function of t does not give a trigonometric polynomial".to_owned()),
    }
}

/// A multiple of t, whose slope must be known exactly; 0 t is 0.
fn scaled(slope: Option<Monomial>, offset: Enclosure) -> Result<Term, String> {
    match slope {
        Some(slope) if slope.as_rational().is_some_and(|slope| *slope == 0) => constant(offset, None),
        Some(slope) => Ok(Term::Line { slope, offset }),
        None => Err("the factor of t is not known exactly: write it in rational multiples of pi".to_owned()),
    }
}

fn raise(base: Term, exponent: i32) -> Result<Term, String> {
    match base {
        Term::Constant { value, exact } => {
            constant(power(&value, exponent), exact.and_then(|exact| exact.pow(exponent)))
        }
        Term::Polynomial(p) if (0..=MAX_HARMONIC as i32).contains(&exponent) => {
            let one = TrigonometricPolynomial::constant(Enclosure::one(p.mean.precision()));
            let mut product = one;
            for _ in 0..exponent {
                if product.harmonics.len() > MAX_HARMONIC {
                    break;
                }
                product = product.times(&p);
            }
            Ok(Term::Polynomial(product))
        }
        _ => Err("this power of a function of t is not a trigonometric polynomial".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Variables;

    fn polynomial_of(text: &str, period: &str) -> Result<TrigonometricPolynomial, NotTrigonometric> {
        let period = Expr::parse(period, Variables::None).unwrap().exact().unwrap();
        Expr::parse(text, Variables::Time).unwrap().trigonometric(&period, 128)
    }

    /// The polynomial and the expression agree at points all over the period.
    #[test]
    fn the_polynomial_is_the_expression() {
        for (text, period, degree) in [
            ("-1 + 0.2*cos(2*pi*t)", "1", 1),
            ("sqrt(3)*sin(-4*pi*t/3 + 1/2)^3 - cos(2*(pi*t - 1)/3)/exp(1)", "3", 6),
            ("(1 + cos(t))*(2 - sin(2*t))", "2*pi", 3),
            ("sin(3 - t)^2 + cos(t + t)", "2*pi", 2),
            ("cos(t - t) + sin(0*t + 1)", "5", 0),
            ("-cos(2*pi*t/0.1)", "0.1", 1),
            ("7/3", "1", 0),
        ] {
            let polynomial = polynomial_of(text, period).unwrap();
            assert_eq!(polynomial.harmonics.len(), degree, "{text}");
            let expr = Expr::parse(text, Variables::Time).unwrap();
            let period = Expr::parse(period, Variables::None).unwrap().enclose_constant(128);
            for step in 0..7 {
                let time = &period * step / 7;
                let angle = Enclosure::pi(128) * 2 * step / 7;
                let (direct, by_terms) = (expr.enclose(&time, &time), polynomial.at(&angle));
                assert!(direct.intersect(&by_terms).is_defined(), "{text} at {step}/7: {direct:?} {by_terms:?}");
                let width = by_terms.upper() - by_terms.lower();
                assert!(width <= 1e-25, "{text}: {width}");
            }
        }
    }

    #[test]
    fn what_is_not_a_polynomial_of_the_period_is_refused_in_its_place() {
        for (text, period, blamed, part) in [
            ("1 + cos(3*t)", "1", "cos(3*t)", "multiple of 2 pi"),
            ("cos(2*pi*t)", "1/3", "cos(2*pi*t)", "multiple of 2 pi"),
            ("cos(pi*t)", "1", "cos(pi*t)", "multiple of 2 pi"),
            ("cos(2*pi*t*exp(0))", "1", "2*pi*t*exp(0)", "exactly"),
            ("t*cos(2*pi*t)", "1", "t*cos(2*pi*t)", "outside"),
            ("2*t", "1", "2*t", "no period"),
            ("exp(cos(2*pi*t))", "1", "exp(cos(2*pi*t))", "function"),
            ("cos(cos(2*pi*t))", "1", "cos(cos(2*pi*t))", "function"),
            ("1/cos(2*pi*t)", "1", "1/cos(2*pi*t)", "operation"),
            ("cos(2*pi*t)/(1-1)", "1", "cos(2*pi*t)/(1-1)", "may be 0"),
            ("cos(2*pi*t)^-1", "1", "cos(2*pi*t)^-1", "power"),
            ("cos(66*pi*t)", "1", "cos(66*pi*t)", "harmonics"),
            ("cos(20*pi*t)^4", "1", "cos(20*pi*t)^4", "harmonics"),
            ("abs(sin(2*pi*t))", "1", "abs(sin(2*pi*t))", "function"),
            ("max(t, 1)", "1", "max(t, 1)", "operation"),
            ("1/0", "1", "1/0", "no value"),
        ] {
            let error = polynomial_of(text, period).unwrap_err();
            assert_eq!(&text[error.span.clone()], blamed);
            assert!(error.reason.contains(part), "{text}: {}", error.reason);
        }
        for text in ["X", "E", "1 + T", "s"] {
            assert!(Expr::parse(text, Variables::Time).is_err());
        }
        assert!(Expr::parse("t", Variables::XAndE).is_err());
    }
}
