//! Numbers and expressions as Coq terms. They are printed from what has been read, never copied from the file, so that no text of a
//! certificate can become a part of the proof script.

use proofs_core::constant::Constant;
use proofs_core::expr::{Expr, Op};
use proofs_core::verdict::{Outcome, Verdict, finding};
use rug::{Integer, Rational};

/// The rule that a refusal names.
pub const RULE: &str = "coq";

/// The most decimal places that are written out.
const MAX_PLACES: u32 = 60;

/// Something that no theorem is written of yet.
pub fn unsupported<T>(pointer: &str, message: impl Into<String>) -> Outcome<T> {
    Err(finding(Verdict::Undecided, RULE, pointer, message))
}

/// Fields of a record: their names and terms.
pub type Fields = Vec<(&'static str, String)>;

/// What need not be there.
pub fn option(value: Option<String>) -> String {
    value.map_or_else(|| "None".to_owned(), |value| format!("Some ({value})"))
}

/// A rational number: in decimals where it has few of them, else as a fraction.
pub fn number(value: &Rational) -> String {
    let magnitude = Rational::from(value.abs_ref());
    let text = decimals(&magnitude).unwrap_or_else(|| {
        if *magnitude.denom() == 1 {
            magnitude.numer().to_string()
        } else {
            format!("({} / {})", magnitude.numer(), magnitude.denom())
        }
    });
    if *value < 0 { format!("(- {text})") } else { text }
}

/// The decimals of a number that is not negative, if they end soon.
fn decimals(value: &Rational) -> Option<String> {
    let mut denominator = value.denom().clone();
    let twos = denominator.remove_factor_mut(&Integer::from(2));
    let fives = denominator.remove_factor_mut(&Integer::from(5));
    let places = twos.max(fives);
    if denominator != 1 || places > MAX_PLACES {
        return None;
    }
    let scaled = Rational::from(value * Integer::from(Integer::u_pow_u(10, places)));
    let digits = scaled.numer().to_string();
    if places == 0 {
        return Some(digits);
    }
    let width = places as usize + 1;
    let padded = format!("{digits:0>width$}");
    let (whole, part) = padded.split_at(padded.len() - places as usize);
    Some(format!("{whole}.{part}"))
}

/// A constant, as the expression that is written.
pub fn constant(value: &Constant, pointer: &str) -> Outcome<String> {
    expression(value.expr(), pointer)
}

/// A bounding function of X and E.
pub fn function(expr: &Expr, pointer: &str) -> Outcome<String> {
    Ok(format!("fun X E => {}", expression(expr, pointer)?))
}

/// An expression; every operation is in parentheses.
fn expression(expr: &Expr, pointer: &str) -> Outcome<String> {
    let printed = expr.fold(|op, a: Option<Result<String, &'static str>>, b: Option<Result<String, &'static str>>| {
        let (a, b) = (a.transpose()?.unwrap_or_default(), b.transpose()?.unwrap_or_default());
        operation(op, &a, &b)
    });
    match printed {
        Some(Ok(text)) => Ok(text),
        Some(Err(what)) => unsupported(pointer, what),
        None => unsupported(pointer, "an expression without a value"),
    }
}

fn operation(op: &Op, a: &str, b: &str) -> Result<String, &'static str> {
    Ok(match op {
        Op::Number(value) => number(value),
        Op::Pi => "PI".to_owned(),
        Op::Variable(0) => "X".to_owned(),
        Op::Variable(1) => "E".to_owned(),
        Op::Neg => format!("(- {a})"),
        Op::Sqrt => format!("(sqrt {a})"),
        Op::Exp => format!("(exp {a})"),
        Op::Log => format!("(ln {a})"),
        Op::Sin => format!("(sin {a})"),
        Op::Cos => format!("(cos {a})"),
        Op::Tan => format!("(tan {a})"),
        Op::Atan => format!("(atan {a})"),
        Op::Tanh => format!("(tanh_exp {a})"),
        Op::Abs => format!("(Rabs {a})"),
        Op::Power(n) if *n >= 0 => format!("({a} ^ {n})"),
        Op::Power(n) => format!("(/ {a} ^ {})", n.unsigned_abs()),
        Op::Add => format!("({a} + {b})"),
        Op::Sub => format!("({a} - {b})"),
        Op::Mul => format!("({a} * {b})"),
        Op::Div => format!("({a} / {b})"),
        Op::Min => format!("(min2 {a} {b})"),
        Op::Max => format!("(max2 {a} {b})"),
        Op::Exprelr(_) => return Err("the function exprelr, which the Coq development does not have"),
        Op::Sinc(_) => return Err("the function sinc, which the Coq development does not have"),
        // Coq's Rpower is exp(b ln a) with ln 0 = 0: at 0 it is another function.
        Op::Pow => return Err("a power with an exponent that is no integer: write it with sqrt, or with exp and log"),
        Op::Variable(_) => return Err("a variable other than X and E"),
    })
}
