//! Formulas over enclosures.

use super::PlantVariable;
use super::enclose::{binary, power, unary};
use super::formulas::Operations;
use super::syntax::{Binary, Unary};
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};

/// The algebra of natural interval evaluation on a box of (t, x, e).
///
/// Guarantee: a defined value contains that of the formula at every point of the box, and proves that it has one there. A
/// state or parameter for which there is no interval is undefined.
#[derive(Clone, Copy, Debug)]
pub struct Enclosing<'a> {
    /// The time.
    pub t: &'a Enclosure,
    /// The states.
    pub x: &'a [Enclosure],
    /// The error.
    pub e: &'a Enclosure,
    /// The parameters of which intervals are known.
    pub p: &'a [Enclosure],
    /// The precision of constants, in bits.
    pub precision: u32,
}

/// The value of [`Operations::step`] where the operand lies in an interval; undefined where it may be 0.
#[must_use]
pub fn enclosed_step(a: &Enclosure) -> Enclosure {
    match (a.is_positive(), a.is_nonnegative()) {
        (Truth::True, _) => Enclosure::one(a.precision()),
        (_, Truth::False) => Enclosure::zero(a.precision()),
        _ => Enclosure::undefined(a.precision()),
    }
}

impl Operations for Enclosing<'_> {
    type Value = Enclosure;

    fn number(&mut self, value: &Rational) -> Enclosure {
        Enclosure::from_rational(value, self.precision)
    }

    fn pi(&mut self) -> Enclosure {
        Enclosure::pi(self.precision)
    }

    fn variable(&mut self, variable: PlantVariable) -> Enclosure {
        match variable {
            PlantVariable::Time => self.t.clone(),
            PlantVariable::Error => self.e.clone(),
            PlantVariable::State(index) => {
                self.x.get(index).cloned().unwrap_or_else(|| Enclosure::undefined(self.precision))
            }
            PlantVariable::Parameter(index) => {
                self.p.get(index).cloned().unwrap_or_else(|| Enclosure::undefined(self.precision))
            }
        }
    }

    fn unary(&mut self, operation: Unary, a: &Enclosure) -> Enclosure {
        unary(operation, a)
    }

    fn binary(&mut self, operation: Binary, a: &Enclosure, b: &Enclosure) -> Enclosure {
        binary(operation, a, b)
    }

    fn power(&mut self, base: &Enclosure, exponent: i32) -> Enclosure {
        power(base, exponent)
    }

    fn step(&mut self, a: &Enclosure) -> Enclosure {
        enclosed_step(a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Formula, Formulas, Memory, PlantExpr, PlantNames, VariableSet};

    const EXPRESSIONS: [&str; 14] = [
        "x*y - e/x + t",
        "sin(x*t) + cos(y)^3 - 2*x^-2",
        "exp(-x^2) + log(1 + y^2)",
        "sqrt(1 + x^2 + e^2)",
        "tan(x/3) + tanh(e*y)",
        "atan(e*y) + abs(x - y)^3",
        "max(x, y, e)^2 + min(x*y, e)",
        "(1 + x^2)^(y/2)",
        "2^x + (2 + sin(t))^e",
        "-(x - y)*-e^4",
        "cos(2*pi*t)*x + cos(2*pi*t)^4",
        "sqrt(3)*x^5 + x^0",
        "exprelr(10*x - 7 + t*e)*y + exprelr(y^3)",
        "sinc(10*x - 7 + t*e)*y + sinc(y*x)^2",
    ];
    const VARIABLES: [PlantVariable; 4] =
        [PlantVariable::Time, PlantVariable::State(0), PlantVariable::State(1), PlantVariable::Error];

    fn formulas() -> (Formulas, Vec<Formula>) {
        let names = PlantNames::new(vec!["x".to_owned(), "y".to_owned()]).unwrap();
        let mut formulas = Formulas::new();
        let all = EXPRESSIONS.iter().map(|text| formulas.insert(&PlantExpr::parse(text, &names).unwrap())).collect();
        (formulas, all)
    }

    fn at(formulas: &Formulas, outputs: &[Formula], point: &[Rational; 4]) -> Vec<Enclosure> {
        let [t, x, y, e] = point.each_ref().map(|value| Enclosure::from_rational(value, 256));
        let x = [x, y];
        formulas.walk(outputs).evaluate(&mut Enclosing { t: &t, x: &x, e: &e, p: &[], precision: 256 })
    }

    /// First and second derivatives in all variables against central differences of what they are derivatives of.
    #[test]
    fn derivatives_agree_with_differences() {
        let (mut formulas, values) = formulas();
        let point = [(3, 10), (7, 10), (-6, 5), (2, 5)].map(Rational::from);
        let step = Rational::from((1, 1_u64 << 40));
        let check = |formulas: &mut Formulas, of: &[Formula], order: usize| -> Vec<Vec<Formula>> {
            let all: Vec<Vec<Formula>> = VARIABLES.iter().map(|v| formulas.derivatives(of, *v)).collect();
            for (index, derivatives) in all.iter().enumerate() {
                let moved = |sign: i32| {
                    let mut point = point.clone();
                    point[index] += Rational::from(&step * sign);
                    at(formulas, of, &point)
                };
                let (up, down) = (moved(1), moved(-1));
                let exact = at(formulas, derivatives, &point);
                for (i, derivative) in exact.iter().enumerate() {
                    let quotient = (&up[i] - &down[i]) / Enclosure::from_rational(&Rational::from(&step * 2), 256);
                    let error = (derivative - quotient).abs().upper_f64();
                    let text = EXPRESSIONS[i % EXPRESSIONS.len()];
                    assert!(error < 1e-18, "{text}: order {order} in {:?}: {derivative:?}", VARIABLES[index]);
                }
            }
            all
        };
        for derivatives in check(&mut formulas, &values, 1) {
            check(&mut formulas, &derivatives, 2);
        }
    }

    #[test]
    fn constants_are_exact_and_zeros_are_seen() {
        let names = PlantNames::new(vec!["x".to_owned()]).unwrap();
        let mut formulas = Formulas::new();
        let mut insert = |text: &str| formulas.insert(&PlantExpr::parse(text, &names).unwrap());
        let (tenth, linear, root) = (insert("1/30*3"), insert("x/3 + sqrt(3)*pi"), insert("sqrt(2)^2"));
        assert_eq!(formulas.value(tenth), Some(&Rational::from((1, 10))));
        assert_eq!(formulas.value(root), None);
        let slope = formulas.derivatives(&[linear], PlantVariable::State(0))[0];
        assert_eq!(formulas.value(slope), Some(&Rational::from((1, 3))));
        let second = formulas.derivatives(&[slope, linear], PlantVariable::State(0))[0];
        assert!(formulas.is_zero(second));
    }

    #[test]
    fn a_memory_forgets_what_has_changed() {
        let (formulas, values) = formulas();
        let walk = formulas.walk(&values);
        let mut memory = Memory::default();
        let mut e = Enclosure::from_integer(1, 64);
        let (t, x) = (Enclosure::from_integer(2, 64), [3, 4].map(|x| Enclosure::from_integer(x, 64)));
        for number in 1..4 {
            e = Enclosure::from_integer(number, 64);
            let mut algebra = Enclosing { t: &t, x: &x, e: &e, p: &[], precision: 64 };
            let changed = VariableSet::of(PlantVariable::Error);
            assert_eq!(walk.evaluate_again(&mut algebra, &mut memory, changed), walk.evaluate(&mut algebra));
        }
        assert!(e.contains(&Rational::from(3)));
        let time = |index: usize| formulas.walk(&values[index..=index]).all_variables().has(PlantVariable::Time);
        assert!(time(0) && !time(2));
    }

    #[test]
    fn what_operations_demand() {
        let names = PlantNames::new(vec!["x".to_owned()]).unwrap();
        for (text, demanded) in [
            ("1/x + 1/2", &["1/x"][..]),
            ("sqrt(x) + log(x) + sqrt(2)", &["sqrt(x)", "log(x)"]),
            ("abs(x)*min(x, 1, e)", &["abs(x)", "min(x, 1", "min(x, 1, e)"]),
            ("tan(t)^-1 + x^3", &["tan(t)", "tan(t)^-1"]),
            ("(1 + x)^(1/2)", &["(1 + x)^(1/2)"]),
            ("abs(0) + 1/sin(0) + tanh(x)", &["abs(0)", "1/sin(0)"]),
        ] {
            let mut formulas = Formulas::new();
            let (_, demands) = formulas.insert_with_demands(&PlantExpr::parse(text, &names).unwrap());
            let parts: Vec<&str> = demands.iter().map(|demand| &text[demand.span.clone()]).collect();
            assert_eq!(parts, demanded);
        }
    }
}
