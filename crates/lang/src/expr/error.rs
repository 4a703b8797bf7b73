//! Why an expression was refused.

use super::{MAX_EXPONENT, MAX_NESTING, MAX_NODES, MAX_TEXT};
use sigmastar_exact::number::DecimalError;
use std::ops::Range;
use thiserror::Error;

/// Why a text is not an expression, where, and what would help. Displayed as one sentence.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{kind}")]
pub struct ExprError {
    /// What is wrong.
    pub kind: ExprErrorKind,
    /// The bytes of the text concerned; both ends lie on character boundaries, and the range is empty only at the
    /// end of the text.
    pub span: Range<usize>,
    /// What could have stood there, in words.
    pub expected: Option<&'static str>,
    /// A suggestion, as one sentence without a final stop.
    pub help: Option<String>,
}

/// What is wrong with a text that is not an expression.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum ExprErrorKind {
    /// Nothing but white space.
    #[error("the expression is empty")]
    Empty,
    /// The text is too long.
    #[error("the expression has {length} bytes; at most {MAX_TEXT} are read")]
    TooLong {
        /// Its length in bytes.
        length: usize,
    },
    /// Parentheses, calls and exponents are nested too deeply.
    #[error("the expression is nested more than {MAX_NESTING} levels deep")]
    TooDeep,
    /// Too many operations.
    #[error("the expression has more than {MAX_NODES} numbers, variables and operations")]
    TooManyNodes,
    /// A character that has no meaning in an expression.
    #[error("the character {character:?} has no meaning in an expression")]
    UnexpectedCharacter {
        /// The character.
        character: char,
    },
    /// A symbol in the wrong place.
    #[error("unexpected `{found}`")]
    Unexpected {
        /// The symbol.
        found: String,
    },
    /// The text ends too early.
    #[error("the expression ends where more is needed")]
    UnexpectedEnd,
    /// Two operands next to each other.
    #[error("an operator is missing between `{left}` and `{right}`")]
    MissingOperator {
        /// The operand before the gap.
        left: String,
        /// The operand after the gap.
        right: String,
    },
    /// An opening parenthesis without its closing one.
    #[error("this parenthesis is never closed")]
    Unclosed,
    /// A name that is neither a function nor a constant nor a variable.
    #[error("`{name}` is not a known name")]
    UnknownName {
        /// The name.
        name: String,
    },
    /// X or E in a constant expression.
    #[error("the variable `{name}` cannot be used in a constant")]
    VariableInConstant {
        /// The variable.
        name: String,
    },
    /// A function name without arguments.
    #[error("the function `{name}` needs its argument in parentheses")]
    FunctionWithoutArgument {
        /// The function.
        name: String,
    },
    /// A function with the wrong number of arguments.
    #[error("`{name}` takes {needed}, not {found}")]
    ArgumentCount {
        /// The function.
        name: String,
        /// The number it takes, in words.
        needed: &'static str,
        /// The number that was found.
        found: usize,
    },
    /// A numeral that is not a number or exceeds the limits of numbers.
    #[error(transparent)]
    Number(#[from] DecimalError),
    /// A constant divisor that is 0.
    #[error("`{operation}`: the divisor is 0")]
    ZeroDivisor {
        /// The quotient.
        operation: String,
    },
    /// A constant integer exponent that is too large.
    #[error("a constant integer exponent exceeds {MAX_EXPONENT} in magnitude")]
    ExponentTooLarge,
}
