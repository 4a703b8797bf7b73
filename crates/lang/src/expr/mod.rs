//! Expressions in X and E: parsing, exact and rigorous evaluation, slopes, and the proof that an expression is a
//! bounding function.
//!
//! An expression is a real function of X and E on the set where every operation in it is applied inside its domain:
//! no division by 0, no square root of a negative number, no logarithm of a number that is not positive, no tangent
//! at a pole. `u^n` with an exponent that is an integer constant (recognised exactly) is the integer power, defined
//! for every base if n >= 0 (`0^0 = 1`) and for nonzero bases if n < 0; every other `u^v` is the real power, defined
//! for u > 0, and for u = 0 with v > 0 where it is 0. On that set every expression is continuous.
//!
//! The same grammar serves the right sides of a plant ([`PlantExpr`], in t, the states and e); the two kinds of
//! expressions are different types. [`Formulas`] hold right sides and their derivatives exactly; a [`Walk`] evaluates them in
//! any algebra, a [`Program`] in doubles.
//!
//! Expressions come from strangers' files. Every limit that keeps them harmless is a public constant here; parsing
//! and evaluation take time and memory linear in the number of nodes, apart from the arithmetic itself.

mod coefficients;
mod definitions;
mod enclose;
mod enclosing;
mod error;
mod exact;
mod failure;
mod float;
mod formulas;
mod fourier;
mod graph;
mod growth;
mod in_time;
mod jet;
mod lex;
mod monomial;
mod moved;
mod names;
mod parse;
mod percent;
mod periodic;
mod phase;
mod plant;
mod point;
mod polynomial;
mod program;
mod prove;
mod refute;
mod settings;
mod slope;
mod syntax;
mod trigonometric;
mod units;
mod walk;
mod words;

pub use definitions::{DefinitionError, Definitions, MAX_INTERVALS, MAX_VARIED, occurs};
pub use enclosing::{Enclosing, enclosed_step};
pub use error::{ExprError, ExprErrorKind};
pub use failure::{BoundingFailure, Counterexample, DomainBox, Evaluation, Property, Reason};
pub use float::FloatExpr;
pub use formulas::{Demand, Formula, Formulas, Operations};
pub use fourier::Fourier;
pub use monomial::Monomial;
pub use moved::{MovedBy, Sum};
pub(crate) use percent::percent;
pub use periodic::{NotPeriodic, PeriodicityReason};
pub use phase::Phase;
pub use plant::{MAX_STATES, NameError, PlantExpr, PlantNames, PlantVariable};
pub use program::{Evaluator, Program};
pub use prove::prove_bounding;
pub use settings::ProofSettings;
pub use slope::Slopes;
pub use syntax::{Binary, Unary};
pub use trigonometric::{MAX_HARMONIC, NotTrigonometric, TrigonometricPolynomial};
pub use walk::{Memory, VariableSet, Walk};
pub use words::{in_words, quoted};

use std::fmt;
use std::sync::{Arc, OnceLock};
use syntax::Node;

/// The longest expression read, in bytes.
pub const MAX_TEXT: usize = 10_000;

/// How deep parentheses, function calls and exponents may be nested.
pub const MAX_NESTING: usize = 100;

/// The largest number of numbers, variables and operations in an expression.
pub const MAX_NODES: usize = 5_000;

/// The largest magnitude of a constant integer exponent.
pub const MAX_EXPONENT: i32 = 1_000;

/// Which variables an expression may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variables {
    /// None: a constant expression.
    None,
    /// X and E.
    XAndE,
    /// The time t, which takes the place of X: [`Expr::enclose`] is given its value as `x`.
    Time,
}

/// A parsed expression with its source text.
///
/// Cheap to clone and safe to share between threads. Two expressions are displayed as they were written.
#[derive(Clone, Debug)]
pub struct Expr {
    text: Arc<str>,
    /// The operations in postfix order, as [`syntax::evaluate`] requires.
    nodes: Arc<[Node]>,
    /// What [`polynomial::roles`] says of the nodes, once somebody asks.
    roles: Arc<OnceLock<Box<[polynomial::Role]>>>,
}

impl Expr {
    /// Reads an expression.
    ///
    /// `+ - * /` associate to the left, `^` to the right; `^` binds tighter than a sign on its left, and its exponent
    /// may carry signs (`-2^2 = -4`, `2^3^2 = 512`, `2^-1 = 1/2`). Numbers are exact decimals. There is no implicit
    /// multiplication.
    ///
    /// # Errors
    /// [`ExprError`] with the place, what was expected there and, where there is one, a suggestion; also when one of
    /// the limits [`MAX_TEXT`], [`MAX_NESTING`], [`MAX_NODES`], [`MAX_EXPONENT`] or those of
    /// [`sigmastar_exact::number::parse_decimal`] is exceeded. Never panics.
    pub fn parse(text: &str, variables: Variables) -> Result<Expr, ExprError> {
        let nodes = parse::parse(text, &variables)?;
        Ok(Expr { text: text.into(), nodes: nodes.into(), roles: Arc::default() })
    }

    /// The constant 0.
    #[must_use]
    pub fn zero() -> Expr {
        let node = Node { kind: syntax::NodeKind::Number(rug::Rational::new()), span: 0..1 };
        Expr { text: "0".into(), nodes: Arc::new([node]), roles: Arc::default() }
    }

    /// Its negative, with the same text and places.
    #[must_use]
    pub fn negated(&self) -> Expr {
        let negation = Node { kind: syntax::NodeKind::Unary(syntax::Unary::Neg), span: 0..self.text.len() };
        let nodes: Vec<Node> = self.nodes.iter().cloned().chain([negation]).collect();
        Expr { text: self.text.clone(), nodes: nodes.into(), roles: Arc::default() }
    }

    fn roles(&self) -> &[polynomial::Role] {
        self.roles.get_or_init(|| polynomial::roles(&self.nodes))
    }

    /// The source text, exactly as it was parsed.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }
}

impl fmt::Display for Expr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
