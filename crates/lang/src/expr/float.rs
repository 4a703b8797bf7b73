//! Fast evaluation in double precision, for searches only.

use super::Expr;
use super::syntax::{Algebra, Argument, Binary, Unary, evaluate};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::Portable;
use sigmastar_exact::removable;

/// Precision at which constants are enclosed before they are rounded to doubles.
const CONSTANT_PRECISION: u32 = 64;

/// Values that an ordinary expression keeps waiting; deeper ones use [`DEEPEST`].
const SHALLOW: usize = 16;

/// Values that any expression keeps waiting. A level of nesting keeps at most one left operand of a sum, one of a
/// product and one base or first argument, so with at most 100 levels there are fewer than 512.
const DEEPEST: usize = 512;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Instruction {
    Number(f64),
    X,
    E,
    Unary(Unary),
    Binary(Binary),
    Power(i32),
}

/// An expression compiled for evaluation in double precision, with constant parts folded.
///
/// Nothing is guaranteed about rounding: it serves searches, never claims. An undefined value is NaN or, where
/// floating point has a limit for it (1/0), an infinity.
#[derive(Clone, Debug)]
pub struct FloatExpr {
    program: Box<[Instruction]>,
    shallow: bool,
}

pub(super) fn unary(operation: Unary, a: f64) -> f64 {
    match operation {
        Unary::Neg => -a,
        Unary::Sqrt => a.sqrt(),
        Unary::Exp => libm::exp(a),
        Unary::Log => libm::log(a),
        Unary::Sin => libm::sin(a),
        Unary::Cos => libm::cos(a),
        Unary::Tan => libm::tan(a),
        Unary::Atan => libm::atan(a),
        Unary::Tanh => libm::tanh(a),
        Unary::Abs => a.abs(),
        Unary::Exprelr(order) => removable::exprelr(a, order),
        Unary::Sinc(order) => removable::sinc(a, order),
    }
}

pub(super) fn binary(operation: Binary, a: f64, b: f64) -> f64 {
    match operation {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div => a / b,
        // The real power is undefined for negative bases even where `powf` knows a value.
        Binary::Pow if a > 0.0 || (a == 0.0 && b > 0.0) => libm::pow(a, b),
        Binary::Pow => f64::NAN,
        // Unlike `f64::min`, an undefined operand makes the result undefined.
        Binary::Min if a <= b => a,
        Binary::Min if b < a => b,
        Binary::Max if a >= b => a,
        Binary::Max if b > a => b,
        Binary::Min | Binary::Max => f64::NAN,
    }
}

impl FloatExpr {
    /// The number of operations, numbers and variables among them.
    #[must_use]
    pub fn operations(&self) -> usize {
        self.program.len()
    }

    /// The value at a point, approximately; takes no memory from the heap.
    #[must_use]
    pub fn eval(&self, x: f64, e: f64) -> f64 {
        if self.shallow { self.run::<SHALLOW>(x, e) } else { self.run::<DEEPEST>(x, e) }
    }

    /// Runs the program with the topmost value held apart and the `N` values below it on a stack.
    #[inline]
    fn run<const N: usize>(&self, x: f64, e: f64) -> f64 {
        let mut stack = [0.0; N];
        let mut height = 0;
        let mut top = f64::NAN;
        for instruction in &self.program {
            match *instruction {
                Instruction::Unary(operation) => top = unary(operation, top),
                Instruction::Power(exponent) => top = top.portable_powi(exponent),
                Instruction::Binary(operation) => {
                    height -= 1;
                    top = binary(operation, stack[height], top);
                }
                Instruction::Number(_) | Instruction::X | Instruction::E => {
                    stack[height] = top;
                    height += 1;
                    top = match *instruction {
                        Instruction::Number(value) => value,
                        Instruction::X => x,
                        _ => e,
                    };
                }
            }
        }
        top
    }
}

/// Emits the program; the value of a node is whether it is a constant, which then is the last instruction.
struct Compiler {
    program: Vec<Instruction>,
    height: usize,
    highest: usize,
}

impl Compiler {
    fn operand(&mut self, instruction: Instruction) {
        self.program.push(instruction);
        self.height += 1;
        self.highest = self.highest.max(self.height);
    }

    fn constant(&mut self, value: &Enclosure) -> bool {
        self.operand(Instruction::Number(value.midpoint_f64()));
        true
    }
}

impl Algebra for Compiler {
    type Value = bool;

    fn number(&mut self, value: &Rational) -> bool {
        self.constant(&Enclosure::from_rational(value, CONSTANT_PRECISION))
    }

    fn pi(&mut self) -> bool {
        self.constant(&Enclosure::pi(CONSTANT_PRECISION))
    }

    fn variable(&mut self, variable: Argument) -> bool {
        self.operand(match variable {
            Argument::X => Instruction::X,
            Argument::E => Instruction::E,
        });
        false
    }

    fn unary(&mut self, operation: Unary, constant: bool) -> bool {
        match self.program.last_mut() {
            Some(Instruction::Number(value)) if constant => *value = unary(operation, *value),
            _ => self.program.push(Instruction::Unary(operation)),
        }
        constant
    }

    fn binary(&mut self, operation: Binary, a: bool, b: bool) -> bool {
        self.height -= 1;
        if a && b
            && let [.., Instruction::Number(left), Instruction::Number(right)] = self.program[..]
        {
            self.program.truncate(self.program.len() - 2);
            self.program.push(Instruction::Number(binary(operation, left, right)));
            return true;
        }
        self.program.push(Instruction::Binary(operation));
        false
    }

    fn power(&mut self, constant: bool, exponent: i32) -> bool {
        match self.program.last_mut() {
            Some(Instruction::Number(value)) if constant => *value = value.portable_powi(exponent),
            _ => self.program.push(Instruction::Power(exponent)),
        }
        constant
    }
}

impl Expr {
    /// Compiles the expression for fast, unverified evaluation.
    #[must_use]
    pub fn to_float(&self) -> FloatExpr {
        let mut compiler = Compiler { program: Vec::new(), height: 0, highest: 0 };
        evaluate(&self.nodes, &mut compiler);
        FloatExpr { program: compiler.program.into(), shallow: compiler.highest <= SHALLOW }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Variables;

    fn compile(text: &str) -> FloatExpr {
        Expr::parse(text, Variables::XAndE).unwrap().to_float()
    }

    #[test]
    fn values() {
        for (text, value) in [
            ("X - E", -1.0),
            ("E/X", 1.5),
            ("X^E", 8.0),
            ("E^X", 9.0),
            ("-X^-2", -0.25),
            ("min(X, E, 5)", 2.0),
            ("max(X, E, 2.5)", 3.0),
            ("abs(X - E)*sqrt(16)", 4.0),
            ("1/3*X", 2.0 / 3.0),
            ("2*pi + 0*X", std::f64::consts::TAU),
        ] {
            assert!((compile(text).eval(2.0, 3.0) - value).abs() < 1e-14, "{text}");
        }
    }

    #[test]
    fn undefined_is_not_a_number() {
        for text in
            ["sqrt(-X)", "log(-X)", "(-X)^E", "0^(X - 2)", "max(1, sqrt(-X))", "max(sqrt(-X), 1)", "min(sqrt(-X), 1)"]
        {
            assert!(compile(text).eval(2.0, 2.0).is_nan(), "{text}");
        }
    }

    #[test]
    fn constants_are_folded() {
        assert_eq!(*compile("sqrt(2*8)^2 - pi/pi").program, [Instruction::Number(15.0)]);
        assert_eq!(compile("X*(1 + 2)").program.len(), 3);
        assert_eq!(compile("max(1, 2) + min(X, 3)").program.len(), 5);
    }

    #[test]
    fn deep_expressions_have_room() {
        let n = crate::expr::MAX_NESTING;
        let value = compile(&("X + 2*3^(".repeat(n / 2) + "X" + &")".repeat(n / 2))).eval(0.0, 0.0);
        assert!(value.is_infinite());
        let value = compile(&("X + E*max(X, ".repeat(n) + "X" + &")".repeat(n))).eval(0.5, 0.5);
        assert!((value - 1.0).abs() < 1e-9);
    }
}
