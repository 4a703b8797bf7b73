//! Exact proof that an expression of a plant is periodic in t (derivation, 11.1).

use super::exact::Constants;
use super::monomial::Monomial;
use super::syntax::{Algebra, Binary, Node, NodeKind, Unary, evaluate};
use super::{PlantExpr, PlantVariable};
use rug::Rational;
use std::ops::Range;
use thiserror::Error;

/// Why an expression is not proved to be periodic in t.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum PeriodicityReason {
    /// t is used by something else than what may be done with it.
    #[error("t stands outside of sin, cos, tan, or is not added to terms without t there")]
    Outside,
    /// The coefficient of t is no exact constant.
    #[error("the coefficient of t is not an exact constant: write it in rational multiples of pi")]
    Coefficient,
    /// The frequency is another.
    #[error("the coefficient of t times the period is not a whole multiple of 2 pi")]
    Frequency,
    /// The frequency is another, as one in degrees.
    #[error(
        "the coefficient of t times the period is a whole multiple of 360, not of 2 pi: angles are in radians, with 2*pi in the place of 360"
    )]
    Degrees,
    /// Nothing can be compared with the period.
    #[error("the period is not known exactly: write it in rational multiples of pi")]
    Period,
}

/// Which part of an expression is not proved to be periodic in t, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotPeriodic {
    /// The bytes of the part at fault.
    pub span: Range<usize>,
    /// The reason.
    pub reason: PeriodicityReason,
}

/// What is known of a part of the expression.
enum Part {
    /// Without t; with its exact value where it is a constant that has one.
    Free(Option<Monomial>),
    /// `A t + B` with B free of t: the exact A.
    Line(Monomial),
    /// Periodic, and t occurs in it.
    Wave,
    /// Something in it was refused.
    Refused,
}

struct Prover<'a> {
    period: &'a Monomial,
    /// Why the operation just met was refused.
    reason: Option<PeriodicityReason>,
    failure: Option<NotPeriodic>,
    /// Of each value that waits for its operation, where it is a line, the term in which t stands.
    terms: Vec<Option<Range<usize>>>,
}

impl Prover<'_> {
    fn refuse(&mut self, reason: PeriodicityReason) -> Part {
        self.reason = Some(reason);
        Part::Refused
    }

    fn line(&mut self, slope: Option<Monomial>) -> Part {
        match slope {
            Some(slope) => Part::Line(slope),
            None => self.refuse(PeriodicityReason::Coefficient),
        }
    }

    /// Whether `slope T` is a whole multiple of a turn, 2 pi or another number.
    fn fits(&self, slope: &Monomial, turn: Option<Monomial>) -> bool {
        let turns = turn.and_then(|turn| slope.mul(self.period)?.div(&turn));
        turns.is_some_and(|turns| turns.as_rational().is_some_and(Rational::is_integer))
    }

    /// A sine, cosine or tangent of a line.
    fn wave(&mut self, slope: &Monomial) -> Part {
        let number = |value: u32| Monomial::rational(Rational::from(value));
        match [number(2).mul(&Monomial::pi()), Some(number(360))].map(|turn| self.fits(slope, turn)) {
            [true, _] => Part::Wave,
            [false, true] => self.refuse(PeriodicityReason::Degrees),
            [false, false] => self.refuse(PeriodicityReason::Frequency),
        }
    }
}

impl Algebra<PlantVariable> for Prover<'_> {
    type Value = Part;

    fn number(&mut self, value: &Rational) -> Part {
        Part::Free(Some(Monomial::rational(value.clone())))
    }

    fn pi(&mut self) -> Part {
        Part::Free(Some(Monomial::pi()))
    }

    fn variable(&mut self, variable: PlantVariable) -> Part {
        match variable {
            PlantVariable::Time => Part::Line(Monomial::rational(Rational::from(1))),
            PlantVariable::State(_) | PlantVariable::Error | PlantVariable::Parameter(_) => Part::Free(None),
        }
    }

    fn unary(&mut self, operation: Unary, a: Part) -> Part {
        match (operation, a) {
            (_, Part::Refused) => Part::Refused,
            (_, Part::Free(exact)) => Part::Free(Algebra::<PlantVariable>::unary(&mut Constants, operation, exact)),
            (_, Part::Wave) => Part::Wave,
            (Unary::Neg, Part::Line(slope)) => Part::Line(slope.neg()),
            (Unary::Sin | Unary::Cos | Unary::Tan, Part::Line(slope)) => self.wave(&slope),
            (_, Part::Line(_)) => self.refuse(PeriodicityReason::Outside),
        }
    }

    fn binary(&mut self, operation: Binary, a: Part, b: Part) -> Part {
        match (operation, a, b) {
            (_, Part::Refused, _) | (_, _, Part::Refused) => Part::Refused,
            (_, Part::Free(a), Part::Free(b)) => {
                Part::Free(Algebra::<PlantVariable>::binary(&mut Constants, operation, a, b))
            }
            (_, Part::Wave | Part::Free(_), Part::Wave | Part::Free(_)) => Part::Wave,
            (Binary::Add | Binary::Sub, Part::Line(slope), Part::Free(_))
            | (Binary::Add, Part::Free(_), Part::Line(slope)) => Part::Line(slope),
            (Binary::Sub, Part::Free(_), Part::Line(slope)) => Part::Line(slope.neg()),
            (Binary::Add, Part::Line(a), Part::Line(b)) => self.line(a.add(&b)),
            (Binary::Sub, Part::Line(a), Part::Line(b)) => self.line(a.add(&b.neg())),
            (Binary::Mul, Part::Line(slope), Part::Free(factor))
            | (Binary::Mul, Part::Free(factor), Part::Line(slope)) => {
                self.line(factor.and_then(|factor| slope.mul(&factor)))
            }
            (Binary::Div, Part::Line(slope), Part::Free(divisor)) => {
                self.line(divisor.and_then(|divisor| slope.div(&divisor)))
            }
            _ => self.refuse(PeriodicityReason::Outside),
        }
    }

    fn power(&mut self, base: Part, exponent: i32) -> Part {
        match base {
            Part::Refused => Part::Refused,
            Part::Free(exact) => Part::Free(Algebra::<PlantVariable>::power(&mut Constants, exact, exponent)),
            Part::Wave => Part::Wave,
            Part::Line(_) => self.refuse(PeriodicityReason::Outside),
        }
    }

    fn note(&mut self, node: &Node<PlantVariable>, value: &Part) {
        let operands = match node.kind {
            NodeKind::Number(_) | NodeKind::Pi | NodeKind::Variable(_) => 0,
            NodeKind::Unary(_) | NodeKind::Power(_) => 1,
            NodeKind::Binary(_) => 2,
        };
        let mut lines = self.terms.split_off(self.terms.len().saturating_sub(operands)).into_iter().flatten();
        // Of a sum the term at fault, where it is one.
        let term = match (&node.kind, lines.next(), lines.next()) {
            (NodeKind::Binary(Binary::Add | Binary::Sub), Some(only), None) => only,
            _ => node.span.clone(),
        };
        if let Some(reason) = self.reason.take()
            && self.failure.is_none()
        {
            self.failure = Some(NotPeriodic { span: term.clone(), reason });
        }
        self.terms.push(matches!(value, Part::Line(_)).then_some(term));
    }
}

impl PlantExpr {
    /// Proves that the expression has the period in t, for every x and e at which it is defined (derivation, 11.1).
    ///
    /// t may stand inside the arguments of sin, cos and tan alone, as `A t + B` with B free of t and A an exact constant with
    /// `A T/(2 pi)` a whole number. The period is exact, so nothing is rounded.
    ///
    /// # Errors
    /// The first operation, in the order of evaluation, that leaves this form. It says nothing against the period.
    pub fn prove_periodic(&self, period: Option<&Monomial>) -> Result<(), NotPeriodic> {
        let unit = Monomial::rational(Rational::from(1));
        let mut prover = Prover { period: period.unwrap_or(&unit), reason: None, failure: None, terms: Vec::new() };
        let part = evaluate(&self.nodes, &mut prover);
        let whole = 0..self.text().len();
        match part {
            Part::Free(_) => Ok(()),
            Part::Wave if period.is_some() => Ok(()),
            Part::Line(_) => {
                let term = prover.terms.pop().flatten();
                Err(NotPeriodic { span: term.unwrap_or(whole), reason: PeriodicityReason::Outside })
            }
            Part::Wave => Err(NotPeriodic { span: whole, reason: PeriodicityReason::Period }),
            Part::Refused if period.is_none() => Err(NotPeriodic { span: whole, reason: PeriodicityReason::Period }),
            Part::Refused => {
                // Every refusal is noted with its place.
                let unplaced = NotPeriodic { span: whole, reason: PeriodicityReason::Outside };
                Err(prover.failure.unwrap_or(unplaced))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Expr, PlantNames, Variables};

    fn proof(text: &str, period: &str) -> Result<(), NotPeriodic> {
        let names = PlantNames::new(vec!["x".to_owned()]).unwrap();
        let period = Expr::parse(period, Variables::None).unwrap().exact();
        PlantExpr::parse(text, &names).unwrap().prove_periodic(period.as_ref())
    }

    #[test]
    fn what_has_the_period() {
        for (text, period) in [
            ("sin(2*pi*t)", "1"),
            ("cos(4*pi*t + x)", "1"),
            ("cos(x + 4*pi*t - e^2)", "1"),
            ("sin(2*pi*t)^2", "1"),
            ("sin(2*pi*(t + 1/4))", "1"),
            ("sin(2*pi*(x - t))", "1"),
            ("sin(2*pi*t*2/3)", "3/2"),
            ("sin(2*pi*t*2/3)", "3"),
            ("sin(t) + x*cos(-3*t)", "2*pi"),
            ("tan(t)", "2*pi"),
            ("exp(-4000*(1 - cos(2*pi*t - 1)))", "1"),
            ("sin(x + sin(2*pi*t))/(2 + cos(2*pi*t))", "1"),
            ("max(sin(sqrt(2)*sqrt(2)*pi*t), x)", "1"),
            ("sin(t + t)", "pi"),
            ("sin(5*t - 3*t)", "pi"),
            ("cos(t - t)", "1"),
            ("x*e^3 + log(2 + e)", "1"),
            ("cos(0*t)", "1"),
            ("x", "exp(1)"),
        ] {
            assert_eq!(proof(text, period), Ok(()), "{text}, {period}");
        }
    }

    #[test]
    fn what_is_not_proved_to_have_it_is_refused_in_its_place() {
        use PeriodicityReason::{Coefficient, Degrees, Frequency, Outside, Period};
        for (text, period, blamed, reason) in [
            ("sin(360*t)", "1", "sin(360*t)", Degrees),
            ("cos(9000*t)", "1/25", "cos(9000*t)", Degrees),
            ("sin(359*t)", "1", "sin(359*t)", Frequency),
            ("sin(360*pi*t)", "1/7", "sin(360*pi*t)", Frequency),
            ("1 + sin(t)", "1", "sin(t)", Frequency),
            ("sin(pi*t)", "1", "sin(pi*t)", Frequency),
            ("sin(pi*t)^2", "1", "sin(pi*t)", Frequency),
            ("tan(pi*t)", "1", "tan(pi*t)", Frequency),
            ("sin(2*pi*t)", "2*pi", "sin(2*pi*t)", Frequency),
            ("sin(2*pi*t*2/3)", "1", "sin(2*pi*t*2/3)", Frequency),
            ("sin(6.2831853071795864769*t)", "1", "sin(6.2831853071795864769*t)", Frequency),
            ("t*x", "1", "t*x", Coefficient),
            ("sin(x*t)", "1", "x*t", Coefficient),
            ("sin(2*pi*t/x)", "1", "2*pi*t/x", Coefficient),
            ("sin(exp(1)*t)", "1", "exp(1)*t", Coefficient),
            ("sin(t/sin(0))", "1", "t/sin(0)", Coefficient),
            ("sin(t + pi*t)", "2*pi", "t + pi*t", Coefficient),
            ("sin(t^2)", "2*pi", "t^2", Outside),
            ("sin(t*t)", "2*pi", "t*t", Outside),
            ("sin(1/t)", "2*pi", "1/t", Outside),
            ("exp(t)", "1", "exp(t)", Outside),
            ("2 + t", "1", "t", Outside),
            ("1 + t/10 - cos(2*pi*t)", "1", "t/10", Outside),
            ("t - t", "1", "t - t", Outside),
            ("x + 0*t", "1", "0*t", Outside),
            ("atan(t) + t", "1", "atan(t)", Outside),
            ("min(t, 1)", "1", "min(t, 1)", Outside),
            ("x^t", "1", "x^t", Outside),
            ("sin(2*pi*t + cos(2*pi*t))", "1", "2*pi*t", Outside),
            ("t*sin(2*pi*t)", "1", "t*sin(2*pi*t)", Outside),
            ("sin(2*pi*t)", "exp(0)", "sin(2*pi*t)", Period),
        ] {
            let error = proof(text, period).unwrap_err();
            assert_eq!((&text[error.span.clone()], error.reason), (blamed, reason), "{text}");
        }
    }
}
