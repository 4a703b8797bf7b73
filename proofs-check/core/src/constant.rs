//! Real constants of a file: exact where they have an exact form, and enclosed at any precision.

use crate::exact::Exact;
use crate::expr::{Expr, NONE, Named, Written};
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::verdict::{Outcome, bad, demand};
use rug::Rational;

/// The name of the rule on what a specification or a plant is made of.
pub const RULE: &str = "specification";

/// The precisions, in bits, at which a question about constants is asked.
pub const PRECISIONS: [u32; 4] = [128, 256, 512, 1024];

/// A real constant of a file.
#[derive(Clone, Debug)]
pub struct Constant {
    /// As written, with constants in the places of their names.
    pub text: String,
    /// The constant as it may stand in a sentence.
    pub words: String,
    expr: Expr,
    /// Its exact form, if it has one.
    pub exact: Option<Exact>,
}

impl Constant {
    /// Reads a number or a constant expression that has a finite value.
    pub fn read(field: &Field<'_>) -> Outcome<Constant> {
        Constant::read_with(field, &[])
    }

    /// Reads a number or a constant expression that has a finite value, where names of other constants may stand.
    pub fn read_with(field: &Field<'_>, constants: &[Named]) -> Outcome<Constant> {
        let (expr, Written { text, words }) = expression_with(field, NONE, constants)?;
        let constant = Constant { text, words, exact: expr.exact(), expr };
        if PRECISIONS.iter().any(|p| constant.enclose(*p).is_bounded()) {
            return Ok(constant);
        }
        bad(&field.pointer, "this constant has no value that can be enclosed")
    }

    /// A rational number that stands for what is written: a bound of it.
    pub fn standing_for(Written { text, words }: Written, value: Rational) -> Constant {
        Constant { text, words, exact: Exact::rational(&value), expr: Expr::number(value) }
    }

    /// What is written, as an expression without variables.
    pub fn expr(&self) -> &Expr {
        &self.expr
    }

    /// An enclosure.
    pub fn enclose(&self, precision: u32) -> Interval {
        let none = Interval::undefined(precision);
        self.expr.enclose(&none, &none)
    }

    /// The exact value, if it is rational.
    pub fn rational(&self) -> Option<Rational> {
        self.exact.as_ref().and_then(Exact::as_rational)
    }

    /// This constant as a number that can be compared.
    pub fn number(&self) -> Number<'_> {
        Number { exact: self.exact.clone(), enclose: Box::new(|p| self.enclose(p)) }
    }
}

/// A real number: exact form if there is one, and enclosures at any precision.
pub struct Number<'a> {
    /// The exact form.
    pub exact: Option<Exact>,
    /// The enclosures.
    pub enclose: Box<dyn Fn(u32) -> Interval + 'a>,
}

impl<'a> Number<'a> {
    /// A rational number.
    pub fn rational(value: Rational) -> Number<'a> {
        Number { exact: Exact::rational(&value), enclose: Box::new(move |p| Interval::rational(&value, p)) }
    }

    /// The product.
    pub fn times(self, other: Number<'a>) -> Number<'a> {
        let exact = self.exact.as_ref().zip(other.exact.as_ref()).and_then(|(a, b)| a.mul(b));
        Number { exact, enclose: Box::new(move |p| (self.enclose)(p) * (other.enclose)(p)) }
    }

    /// `self < other`, exactly where possible, else by enclosures of rising precision.
    pub fn lt(&self, other: &Number<'_>) -> Option<bool> {
        let exact = self.exact.as_ref().zip(other.exact.as_ref()).and_then(|(a, b)| a.compare(b));
        if let Some(order) = exact {
            return Some(order.is_lt());
        }
        PRECISIONS.iter().find_map(|p| (self.enclose)(*p).lt(&(other.enclose)(*p)))
    }

    /// `self <= other`.
    pub fn le(&self, other: &Number<'_>) -> Option<bool> {
        other.lt(self).map(|less| !less)
    }
}

/// Takes a constant that has to be positive out of an object.
pub fn positive(fields: &mut Fields<'_>, name: &str) -> Outcome<Constant> {
    positive_with(&fields.required(name)?, name, &[])
}

/// Reads one, in which names of a plant's constants may stand.
pub fn positive_with(field: &Field<'_>, name: &str, constants: &[Named]) -> Outcome<Constant> {
    let constant = Constant::read_with(field, constants)?;
    let truth = Number::rational(Rational::new()).lt(&constant.number());
    demand(truth, RULE, &field.pointer, format!("{name} > 0"))?;
    Ok(constant)
}

/// Reads an expression in the given variables.
pub fn expression(field: &Field<'_>, variables: &[&str]) -> Outcome<Expr> {
    expression_with(field, variables, &[]).map(|(expr, _)| expr)
}

/// Reads an expression in the given variables, where names of constants may stand besides, and how it is written.
pub fn expression_with(field: &Field<'_>, variables: &[&str], constants: &[Named]) -> Outcome<(Expr, Written)> {
    Expr::parse_with(field.numeral()?, variables, constants)
        .or_else(|error| bad(&field.pointer, format!("not an expression: {error}")))
}
