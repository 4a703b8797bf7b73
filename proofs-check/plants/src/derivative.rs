//! Derivatives of formulas, as formulas (docs/mathematics.md, section 11.6).
//!
//! Where every operation is applied inside of where it is smooth, which is decided apart ([`super::smooth`]), these are the
//! derivatives. The one along t follows the frame: the derivative of xb(t) is xb'(t), that of v is 0.

use super::formula::{Axis, Formulas, Id, Kind, Leaf};
use super::term::Term;
use proofs_core::expr::Op;
use rug::Rational;

impl Formulas {
    /// The derivative of a node along an axis.
    pub fn derivative(&mut self, root: Id, axis: Axis) -> Id {
        // From the leaves up, so that nothing recurs however long a sum is.
        for id in self.below(&[root]) {
            if self.derivatives.contains_key(&(id, axis)) {
                continue;
            }
            let slope = if self.depends(id) & axis.bit() == 0 { self.int(0) } else { self.slope(id, axis) };
            self.derivatives.insert((id, axis), slope);
        }
        self.known(root, axis)
    }

    /// A derivative that has been formed.
    fn known(&mut self, id: Id, axis: Axis) -> Id {
        match self.derivatives.get(&(id, axis)) {
            Some(slope) => *slope,
            None => self.int(0),
        }
    }

    fn slope(&mut self, id: Id, axis: Axis) -> Id {
        let (op, [a, b]) = match self.node(id).kind.clone() {
            Kind::Leaf(leaf) => return self.leaf_slope(leaf),
            Kind::Sign(_) => return self.int(0),
            Kind::Apply(op, operands) => (op, operands),
        };
        let (da, db) = (self.known(a, axis), self.known(b, axis));
        let one = self.int(1);
        let slope = match op {
            Op::Neg => -da,
            Op::Add => da + db,
            Op::Sub => da - db,
            Op::Mul => da * b + a * db,
            Op::Div => (da - id * db) / b,
            Op::Sqrt => self.half() * da / id,
            Op::Exp => id * da,
            Op::Log => da / a,
            Op::Sin => Term::of(Op::Cos, a) * da,
            Op::Cos => -(Term::of(Op::Sin, a) * da),
            Op::Tan => (one + id * id) * da,
            Op::Tanh => (one - id * id) * da,
            Op::Atan => da / (one + a * a),
            Op::Exprelr(order) => Term::of(Op::Exprelr(order + 1), a) * da,
            Op::Sinc(order) => Term::of(Op::Sinc(order + 1), a) * da,
            Op::Abs => self.sign(a) * da,
            Op::Power(n) => self.int(i64::from(n)) * Term::of(Op::Power(n - 1), a) * da,
            Op::Pow => {
                let less = self.make(b - one);
                b * self.apply(&Op::Pow, [a, less]) * da + id * Term::of(Op::Log, a) * db
            }
            Op::Min => self.chosen([b, a], [da, db]),
            Op::Max => self.chosen([a, b], [da, db]),
            Op::Number(_) | Op::Pi | Op::Variable(_) => self.int(0).into(),
        };
        self.make(slope)
    }

    fn half(&mut self) -> Id {
        self.number(&Rational::from((1, 2)))
    }

    /// The first slope where `larger > smaller`, the second where it is less: by factors that are exactly 0 and 1.
    fn chosen(&mut self, [larger, smaller]: [Id; 2], [first, second]: [Id; 2]) -> Term {
        let apart = self.make(larger - smaller);
        let (sign, half) = (self.sign(apart), self.half());
        (half + half * sign) * first + (half - half * sign) * second
    }

    fn leaf_slope(&mut self, leaf: Leaf) -> Id {
        match leaf {
            Leaf::Time | Leaf::State(_) | Leaf::Output | Leaf::Parameter(_) => self.int(1),
            Leaf::Orbit { state, order } => self.leaf(Leaf::Orbit { state, order: order + 1 }),
            Leaf::Lyapunov { which, entry, order } => self.leaf(Leaf::Lyapunov { which, entry, order: order + 1 }),
            Leaf::Drift(_) => self.int(0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formula::Leaf;
    use crate::machine::{At, Curves, Machine};
    use proofs_core::expr::Expr;
    use proofs_core::interval::Interval;
    use rug::Rational;

    const PRECISION: u32 = 320;

    fn number(text: (i64, i64)) -> Interval {
        Interval::rational(&Rational::from(text), PRECISION)
    }

    /// A node at a place (t, x, e).
    fn value(formulas: &Formulas, id: Id, [t, x, e]: &[Interval; 3]) -> Interval {
        let curves = Curves { orbit: Vec::new(), lyapunov: Vec::new() };
        let machine = Machine::new(formulas, &curves, &Interval::pi(PRECISION));
        // The time is the middle of a cell.
        let (cell, mut values) = (machine.period(&(t * 2)), machine.values());
        machine.run(
            &machine.program(&[id]),
            At::Middle,
            &cell,
            std::slice::from_ref(x),
            std::slice::from_ref(e),
            &mut values,
        );
        machine.get(id, At::Middle, &cell, &values)
    }

    #[test]
    fn derivatives_are_the_limits_of_difference_quotients() {
        let place = [number((3, 8)), number((7, 10)), number((-2, 5))];
        let step = Interval::rational(&(Rational::from(1) >> 60), PRECISION);
        for text in [
            "x*e + x/(3 + e) - e^3/x",
            "sqrt(x)*sqrt(x + e)",
            "exp(x*e)",
            "log(x - e)",
            "sin(2*pi*t + x)*cos(e*x)",
            "tan(x*e + cos(t))",
            "atan(x^2 - e)/tanh(x)",
            "abs(e)*abs(x)*x",
            "min(x, e)*max(x, e^2)",
            "x^2.5 + (x - e)^x",
            "x^-3 + 2^e",
            "-x^2*-e",
            "sin(t)^3*exp(-cos(t))*x*e",
            "min(x*e, 1, x)",
            "pi*x - x/pi + 0*e",
            "exprelr(10*x - 7)*e + exprelr(e*x)",
            "sinc(10*x - 7)*e + sinc(3*e*x)",
        ] {
            let mut formulas = Formulas::default();
            let variables = [Leaf::Time, Leaf::Output, Leaf::State(0)].map(|leaf| formulas.leaf(leaf));
            let expr = Expr::parse(text, &["t", "e", "x"]).unwrap();
            let id = formulas.read(&expr, &variables, &mut Vec::new());
            for (index, axis) in [Axis::Time, Axis::State(0), Axis::Output].into_iter().enumerate() {
                let slope = formulas.derivative(id, axis);
                let (mut after, mut before) = (place.clone(), place.clone());
                after[index] = &place[index] + &step;
                before[index] = &place[index] - &step;
                let quotient = (value(&formulas, id, &after) - value(&formulas, id, &before)) / (&step * 2);
                let apart = (value(&formulas, slope, &place) - quotient).abs();
                assert!(apart.hi().to_f64() < 1e-28, "{text} along {axis:?}: {apart:?}");
                // Twice, for what the bounds of mixed derivatives need.
                let again = formulas.derivative(slope, Axis::State(0));
                let (mut after, mut before) = (place.clone(), place.clone());
                after[1] = &place[1] + &step;
                before[1] = &place[1] - &step;
                let quotient = (value(&formulas, slope, &after) - value(&formulas, slope, &before)) / (&step * 2);
                let apart = (value(&formulas, again, &place) - quotient).abs();
                assert!(apart.hi().to_f64() < 1e-26, "{text} along {axis:?} and x: {apart:?}");
            }
        }
    }

    #[test]
    fn a_corner_has_no_derivative() {
        let mut formulas = Formulas::default();
        let variables = [Leaf::Time, Leaf::Output, Leaf::State(0)].map(|leaf| formulas.leaf(leaf));
        let zero = number((0, 1));
        let mut demands = Vec::new();
        for text in ["abs(x)", "min(x, e)", "max(x, 2*x)"] {
            let id = formulas.read(&Expr::parse(text, &["t", "e", "x"]).unwrap(), &variables, &mut demands);
            let slope = formulas.derivative(id, Axis::State(0));
            assert!(!value(&formulas, slope, &[number((1, 3)), zero.clone(), zero.clone()]).is_defined(), "{text}");
        }
        assert_eq!(demands.len(), 3);
    }
}
