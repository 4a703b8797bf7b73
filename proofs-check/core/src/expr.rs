//! Expressions in X and E, or in t: grammar, interval evaluation, exact evaluation of constants.
//!
//! ```text
//! sum     = product (("+" | "-") product)*
//! product = signed (("*" | "/") signed)*
//! signed  = ("-" | "+")* power
//! power   = primary ("^" signed)?
//! primary = numeral | "pi" | variable | name "(" sum ("," sum)* ")" | "(" sum ")"
//! ```
//! (`^` binds tighter than a sign before it and associates to the right, as docs/guide.md says.)

use crate::exact::Exact;
use crate::interval::Interval;
use crate::json::decimal;
use rug::Rational;
use std::cmp::Ordering;

const MAX_TEXT: usize = 10_000;
const MAX_NESTING: usize = 100;
const MAX_NODES: usize = 5_000;
const MAX_EXPONENT: i32 = 1_000;

/// One operation of an expression in postfix order.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[rustfmt::skip]
pub enum Op {
    Number(Rational), Pi,
    /// A variable, by its place among those of the expression.
    Variable(usize),
    Neg, Sqrt, Exp, Log, Sin, Cos, Tan, Atan, Tanh, Abs,
    /// The derivative of some order of x/(e^x - 1), and of sin(x)/x, each 1 at 0. In a text the order is 0.
    Exprelr(u32), Sinc(u32),
    /// An integer power; the exponent is at most `MAX_EXPONENT` in magnitude.
    Power(i32),
    Add, Sub, Mul, Div, Pow, Min, Max,
}

impl Op {
    /// How many operands it has.
    pub fn operands(&self) -> usize {
        match self {
            Op::Number(_) | Op::Pi | Op::Variable(_) => 0,
            Op::Add | Op::Sub | Op::Mul | Op::Div | Op::Pow | Op::Min | Op::Max => 2,
            _ => 1,
        }
    }
}

#[rustfmt::skip]
const FUNCTIONS: [(&str, Op); 13] = [
    ("sqrt", Op::Sqrt), ("exp", Op::Exp), ("log", Op::Log), ("sin", Op::Sin), ("cos", Op::Cos), ("tan", Op::Tan),
    ("atan", Op::Atan), ("tanh", Op::Tanh), ("abs", Op::Abs), ("min", Op::Min), ("max", Op::Max),
    ("exprelr", Op::Exprelr(0)), ("sinc", Op::Sinc(0)),
];

/// The variables of a constant, of a bounding function, and of a function of time.
pub const NONE: &[&str] = &[];
pub const ARGUMENTS: &[&str] = &["X", "E"];
pub const TIME: &[&str] = &["t"];

/// A parsed expression: well-formed postfix.
#[derive(Clone, Debug)]
pub struct Expr {
    ops: Vec<Op>,
}

struct Parser<'a> {
    text: &'a [u8],
    at: usize,
    depth: usize,
    ops: Vec<Op>,
    /// The exact values of the operands so far, to recognise integer exponents.
    exact: Vec<Option<Exact>>,
    variables: &'a [&'a str],
    constants: &'a [Named],
    /// Where the name of a constant stands, and the constant; where that of a variable stands, and none.
    named: Vec<(usize, usize, Option<&'a Named>)>,
}

/// A constant under its name: an expression without variables, and its text.
#[derive(Clone, Debug)]
pub struct Named {
    pub name: String,
    pub text: String,
    pub value: Expr,
}

/// How an expression is written, with the texts of constants in the places of their names.
#[derive(Clone, Debug)]
pub struct Written {
    /// But for that as in the file.
    pub text: String,
    /// As it may stand in a sentence, whose letters are others: without white space, and each name of a variable in quotes.
    pub words: String,
}

type Parsed = Result<(), String>;

impl Parser<'_> {
    /// The next character after white space, 0 at the end.
    fn peek(&mut self) -> u8 {
        while self.text.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
        self.text.get(self.at).copied().unwrap_or(0)
    }

    fn accept(&mut self, symbol: u8) -> bool {
        let found = self.peek() == symbol;
        self.at += usize::from(found);
        found
    }

    fn push(&mut self, op: Op) -> Parsed {
        if self.ops.len() >= MAX_NODES {
            return Err(format!("more than {MAX_NODES} operations"));
        }
        step(&op, &mut self.exact, &mut exact_op);
        self.ops.push(op);
        Ok(())
    }

    fn deeper(&mut self, part: fn(&mut Self) -> Parsed) -> Parsed {
        self.depth += 1;
        if self.depth > MAX_NESTING {
            return Err(format!("nested more than {MAX_NESTING} deep"));
        }
        part(self)?;
        self.depth -= 1;
        Ok(())
    }

    fn sum(&mut self) -> Parsed {
        self.left([(b'+', Op::Add), (b'-', Op::Sub)], Self::product)
    }

    fn product(&mut self) -> Parsed {
        self.left([(b'*', Op::Mul), (b'/', Op::Div)], Self::signed)
    }

    /// Operands with left-associative operators between them.
    fn left(&mut self, operators: [(u8, Op); 2], operand: fn(&mut Self) -> Parsed) -> Parsed {
        operand(self)?;
        loop {
            let next = self.peek();
            let Some((_, op)) = operators.iter().find(|(symbol, _)| *symbol == next) else { return Ok(()) };
            self.at += 1;
            operand(self)?;
            self.push(op.clone())?;
        }
    }

    fn signed(&mut self) -> Parsed {
        let mut negative = false;
        while matches!(self.peek(), b'+' | b'-') {
            negative ^= self.accept(b'-') || !self.accept(b'+');
        }
        self.power()?;
        if negative { self.push(Op::Neg) } else { Ok(()) }
    }

    fn power(&mut self) -> Parsed {
        self.primary()?;
        if !self.accept(b'^') {
            return Ok(());
        }
        let start = self.ops.len();
        self.deeper(Self::signed)?;
        let exponent = self.exact.last().cloned().flatten().and_then(|value| value.as_rational());
        match exponent.filter(|value| *value.denom() == 1) {
            None => self.push(Op::Pow),
            Some(integer) => match integer.numer().to_i32().filter(|n| n.unsigned_abs() <= MAX_EXPONENT as u32) {
                None => Err(format!("an exponent beyond {MAX_EXPONENT}")),
                Some(n) => {
                    // The power takes the place of the exponent's operations and of its value.
                    self.ops.truncate(start);
                    self.exact.pop();
                    self.push(Op::Power(n))
                }
            },
        }
    }

    fn primary(&mut self) -> Parsed {
        let first = self.peek();
        let start = self.at;
        if first == b'(' {
            self.at += 1;
            self.deeper(Self::sum)?;
            return self.close();
        }
        if first.is_ascii_digit() || first == b'.' {
            let digits = |text: &[u8], from: usize| text[from..].iter().take_while(|b| b.is_ascii_digit()).count();
            while self.text.get(self.at).is_some_and(|b| b.is_ascii_digit() || *b == b'.') {
                self.at += 1;
            }
            if matches!(self.text.get(self.at), Some(b'e' | b'E')) {
                let sign = usize::from(matches!(self.text.get(self.at + 1), Some(b'+' | b'-')));
                let count = digits(self.text, (self.at + 1 + sign).min(self.text.len()));
                // Without digits the letter is no exponent.
                self.at += if count > 0 { 1 + sign + count } else { 0 };
            }
            let numeral = std::str::from_utf8(&self.text[start..self.at]).unwrap_or("");
            let value = decimal(numeral).ok_or_else(|| format!("no numeral of moderate size at byte {start}"))?;
            return self.push(Op::Number(value));
        }
        while self.text.get(self.at).is_some_and(|b| b.is_ascii_alphanumeric() || *b == b'_') {
            self.at += 1;
        }
        let name = std::str::from_utf8(&self.text[start..self.at]).unwrap_or("");
        if name == "pi" {
            return self.push(Op::Pi);
        }
        if let Some(index) = self.variables.iter().position(|variable| *variable == name) {
            self.named.push((start, self.at, None));
            return self.push(Op::Variable(index));
        }
        let constants = self.constants;
        if let Some(constant) = constants.iter().find(|constant| constant.name == name) {
            self.named.push((start, self.at, Some(constant)));
            // As if it stood there in parentheses.
            return constant.value.ops.iter().try_for_each(|op| self.push(op.clone()));
        }
        let Some(function) = FUNCTIONS.iter().find(|function| function.0 == name).map(|function| function.1.clone())
        else {
            return Err(format!("no number, variable or function at byte {start}"));
        };
        if !self.accept(b'(') {
            return Err(format!("a function without its argument at byte {start}"));
        }
        self.deeper(Self::sum)?;
        let folds = matches!(function, Op::Min | Op::Max);
        let mut arguments = 1;
        while folds && self.accept(b',') {
            self.deeper(Self::sum)?;
            self.push(function.clone())?;
            arguments += 1;
        }
        match (folds, arguments) {
            (true, 1) => return Err(format!("min and max take at least two arguments, at byte {start}")),
            (true, _) => {}
            (false, _) => self.push(function)?,
        }
        self.close()
    }

    fn close(&mut self) -> Parsed {
        if self.accept(b')') { Ok(()) } else { Err(format!("a closing parenthesis is missing at byte {}", self.at)) }
    }
}

/// One operation on a stack of values. A well-formed expression never meets an empty stack.
fn step<V: Clone>(op: &Op, stack: &mut Vec<V>, apply: &mut impl FnMut(&Op, Option<V>, Option<V>) -> V) {
    let second = (op.operands() == 2).then(|| stack.pop()).flatten();
    let first = (op.operands() >= 1).then(|| stack.pop()).flatten();
    stack.push(apply(op, first, second));
}

/// An operation on exact numbers, where the result is one.
pub fn exact_op(op: &Op, a: Option<Option<Exact>>, b: Option<Option<Exact>>) -> Option<Exact> {
    let (a, b) = (a.flatten(), b.flatten());
    match op {
        Op::Number(value) => Exact::rational(value),
        Op::Pi => Some(Exact::pi()),
        Op::Neg => Some(a?.neg()),
        Op::Sqrt => a?.sqrt(),
        Op::Abs => a.map(|a| if a.sign() < 0 { a.neg() } else { a }),
        Op::Power(n) => a?.pow(*n),
        Op::Add => a?.add(&b?),
        Op::Sub => a?.add(&b?.neg()),
        Op::Mul => a?.mul(&b?),
        Op::Div => a?.mul(&b?.recip()?),
        Op::Min | Op::Max => {
            let (a, b) = (a?, b?);
            let first = (a.compare(&b)? == Ordering::Less) == (*op == Op::Min);
            Some(if first { a } else { b })
        }
        Op::Variable(_) | Op::Exp | Op::Log | Op::Pow => None,
        Op::Sin | Op::Cos | Op::Tan | Op::Atan | Op::Tanh | Op::Exprelr(_) | Op::Sinc(_) => None,
    }
}

/// An operation on intervals; operands that do not belong to it are ignored.
pub fn interval_op(op: &Op, a: &Interval, b: &Interval) -> Interval {
    match op {
        Op::Neg => -a,
        Op::Sqrt => a.sqrt(),
        Op::Exp => a.exp(),
        Op::Log => a.log(),
        Op::Sin => a.sin(),
        Op::Cos => a.cos(),
        Op::Tan => a.tan(),
        Op::Atan => a.atan(),
        Op::Tanh => a.tanh(),
        Op::Abs => a.abs(),
        Op::Exprelr(order) => a.exprelr(*order),
        Op::Sinc(order) => a.sinc(*order),
        Op::Power(n) => a.powi(*n),
        Op::Add => a + b,
        Op::Sub => a - b,
        Op::Mul => a * b,
        Op::Div => a / b,
        Op::Pow => a.pow(b),
        Op::Min => a.min(b),
        Op::Max => a.max(b),
        Op::Number(value) => Interval::rational(value, a.precision()),
        Op::Pi => Interval::pi(a.precision()),
        // Variables have no value of their own.
        Op::Variable(_) => Interval::undefined(a.precision()),
    }
}

/// The derivative on the range u of an operation with one operand that is smooth wherever it is defined; `value` is its value there.
pub fn slope_op(op: &Op, u: &Interval, value: &Interval) -> Option<Interval> {
    Some(match op {
        Op::Neg => Interval::int(-1, u.precision()),
        Op::Exp => value.clone(),
        Op::Log => u.recip(),
        Op::Sin => u.cos(),
        Op::Cos => -u.sin(),
        Op::Tan => 1 + value.sqr(),
        Op::Atan => (1 + u.sqr()).recip(),
        Op::Tanh => 1 - value.sqr(),
        Op::Exprelr(order) => u.exprelr(order + 1),
        Op::Sinc(order) => u.sinc(order + 1),
        Op::Power(0) => Interval::int(0, u.precision()),
        Op::Power(n) => u.powi(n - 1) * i64::from(*n),
        _ => return None,
    })
}

/// A name of a file within a sentence: apart from the letters that the sentence has of its own.
pub fn quoted(name: &str) -> String {
    format!("'{name}'")
}

/// A text with those of constants in the given places of it, in parentheses but for digits and a point, and the names of variables by `variable`.
fn spelled_out(text: &str, named: &[(usize, usize, Option<&Named>)], variable: fn(&str) -> String) -> String {
    let (mut whole, mut from) = (String::new(), 0);
    for (start, end, constant) in named {
        whole.push_str(text.get(from..*start).unwrap_or(""));
        whole.push_str(&match constant.map(|constant| constant.text.as_str()) {
            None => variable(text.get(*start..*end).unwrap_or("")),
            Some(value) if value.bytes().all(|b| b.is_ascii_digit() || b == b'.') => value.to_owned(),
            Some(value) => format!("({value})"),
        });
        from = *end;
    }
    whole.push_str(text.get(from..).unwrap_or(""));
    whole
}

/// No two words of an expression stand side by side, so that white space only spreads it.
fn without_space(text: &str) -> String {
    text.split_ascii_whitespace().collect()
}

impl Expr {
    /// Reads an expression in [`NONE`], [`ARGUMENTS`], [`TIME`] or other variables.
    ///
    /// # Errors
    /// What is wrong, in words; sizes are bounded before anything is computed.
    pub fn parse(text: &str, variables: &[&str]) -> Result<Expr, String> {
        Expr::parse_with(text, variables, &[]).map(|(expr, _)| expr)
    }

    /// Reads an expression, where names of constants may stand besides, and how it is written.
    ///
    /// # Errors
    /// Those of [`Expr::parse`].
    pub fn parse_with(text: &str, variables: &[&str], constants: &[Named]) -> Result<(Expr, Written), String> {
        if text.len() > MAX_TEXT {
            return Err(format!("an expression of more than {MAX_TEXT} bytes"));
        }
        let bytes = text.as_bytes();
        let (ops, exact) = (Vec::new(), Vec::new());
        let mut parser = Parser { text: bytes, at: 0, depth: 0, ops, exact, variables, constants, named: Vec::new() };
        parser.sum()?;
        match parser.peek() {
            0 if parser.at == bytes.len() => {
                let whole = text.trim();
                let alone = constants.iter().find(|constant| constant.name == whole);
                let spelled =
                    |of| alone.map_or_else(|| spelled_out(text, &parser.named, of), |constant| constant.text.clone());
                let written = Written { text: spelled(str::to_owned), words: without_space(&spelled(quoted)) };
                Ok((Expr { ops: parser.ops }, written))
            }
            _ => Err(format!("an operator or the end was expected at byte {}", parser.at)),
        }
    }

    /// A number.
    pub fn number(value: Rational) -> Expr {
        Expr { ops: vec![Op::Number(value)] }
    }

    /// `2 pi t/T`, t the first variable, with T in an expression without variables.
    pub fn phase(period: &Expr) -> Expr {
        let two_pi = [Op::Number(Rational::from(2)), Op::Pi, Op::Mul];
        let ops = two_pi.into_iter().chain(period.ops.iter().cloned()).chain([Op::Div, Op::Variable(0), Op::Mul]);
        Expr { ops: ops.collect() }
    }

    /// The sum of an expression and a number times another one, of the same variables.
    pub fn plus(&self, factor: &Rational, other: &Expr) -> Expr {
        let after = [Op::Number(factor.clone()), Op::Mul, Op::Add];
        Expr { ops: self.ops.iter().chain(&other.ops).cloned().chain(after).collect() }
    }

    /// The opposite of an expression.
    pub fn negated(&self) -> Expr {
        Expr { ops: self.ops.iter().cloned().chain([Op::Neg]).collect() }
    }

    /// Evaluates in any arithmetic.
    pub fn fold<V: Clone>(&self, mut apply: impl FnMut(&Op, Option<V>, Option<V>) -> V) -> Option<V> {
        let mut stack = Vec::new();
        for op in &self.ops {
            step(op, &mut stack, &mut apply);
        }
        stack.pop()
    }

    /// The exact value of a constant expression, where it has the form of [`Exact`].
    pub fn exact(&self) -> Option<Exact> {
        self.fold(exact_op).flatten()
    }

    /// The number of operations.
    #[allow(clippy::len_without_is_empty, reason = "no expression is empty")]
    pub fn len(&self) -> usize {
        self.ops.len()
    }

    /// Contains the value at every point of the box; undefined if the expression may be undefined somewhere in it.
    pub fn enclose(&self, x: &Interval, e: &Interval) -> Interval {
        self.at(|index| [x, e].get(index).copied(), x.precision().max(e.precision()))
    }

    /// Contains the value at every point of a box of any number of variables; undefined if one has no value, or the expression may be undefined.
    pub fn at<'v>(&self, variable: impl Fn(usize) -> Option<&'v Interval>, precision: u32) -> Interval {
        let none = Interval::undefined(precision);
        let value = self.fold(|op, a: Option<Interval>, b: Option<Interval>| match op {
            Op::Variable(index) => variable(*index).unwrap_or(&none).clone(),
            _ => interval_op(op, a.as_ref().unwrap_or(&none), b.as_ref().unwrap_or(&none)),
        });
        value.unwrap_or(none)
    }
}
