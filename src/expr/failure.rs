//! Why an expression was not proved to be a bounding function.

use crate::enclosure::Enclosure;
use crate::number::write_exact;
use rug::Rational;
use std::fmt;
use std::ops::Range;
use thiserror::Error;

/// What a bounding function must satisfy on its domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Property {
    /// Defined, and so, being continuous on a compact set, bounded.
    Finite,
    /// Nowhere negative.
    Nonnegative,
    /// Nondecreasing in X for every E.
    NondecreasingInX,
    /// Nondecreasing in E for every X.
    NondecreasingInE,
}

impl fmt::Display for Property {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Property::Finite => "finite",
            Property::Nonnegative => "nonnegative",
            Property::NondecreasingInX => "nondecreasing in X",
            Property::NondecreasingInE => "nondecreasing in E",
        })
    }
}

/// The value of the expression at an exact point.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluation {
    /// X.
    pub x: Rational,
    /// E.
    pub e: Rational,
    /// Contains the value there.
    pub value: Enclosure,
}

impl fmt::Display for Evaluation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [lower, upper] = self.value.decimals();
        let (x, e) = (write_exact(&self.x), write_exact(&self.e));
        write!(f, "its value at X = {x}, E = {e} lies in [{lower}, {upper}]")
    }
}

/// Exact points that prove a property false.
#[derive(Clone, Debug, PartialEq)]
pub enum Counterexample {
    /// The expression is certainly undefined at this point.
    Undefined {
        /// X.
        x: Rational,
        /// E.
        e: Rational,
    },
    /// The value is certainly negative.
    Negative(Evaluation),
    /// The value at `from` is certainly greater than at `to`, which differs from it by a larger X or E only.
    Decrease {
        /// The point with the smaller argument and the greater value.
        from: Evaluation,
        /// The point with the greater argument and the smaller value.
        to: Evaluation,
    },
}

impl fmt::Display for Counterexample {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Counterexample::Undefined { x, e } => {
                write!(f, "it is undefined at X = {}, E = {}", write_exact(x), write_exact(e))
            }
            Counterexample::Negative(at) => write!(f, "{at}"),
            Counterexample::Decrease { from, to } => write!(f, "{from}, and {to}"),
        }
    }
}

/// A closed box of arguments with exact ends.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DomainBox {
    /// Smallest and largest X.
    pub x: [Rational; 2],
    /// Smallest and largest E.
    pub e: [Rational; 2],
}

impl fmt::Display for DomainBox {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x1, x2, e1, e2] = [&self.x[0], &self.x[1], &self.e[0], &self.e[1]].map(|r| format!("{:.6e}", r.to_f64()));
        write!(f, "X about [{x1}, {x2}], E about [{e1}, {e2}]")
    }
}

/// Why a property stayed undecided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Reason {
    /// The allowed number of boxes was used up.
    #[error("the limit of {0} boxes was reached")]
    Boxes(usize),
    /// The allowed number of operations of the expression was used up.
    #[error("the limit of {0} operations of the expression was reached; a simpler upper bound of it may do")]
    Operations(u64),
    /// A box was bisected as often as is allowed and stayed undecided.
    #[error("bisection does not help there")]
    Depth,
    /// The sign of a value is not decided at the highest precision.
    #[error("its sign is not decided at {0} bits")]
    Precision(u32),
    /// The largest X or E is negative: there is no domain.
    #[error("the domain is empty")]
    Empty,
}

/// Why [`super::prove_bounding`] did not prove that an expression is a bounding function. Displayed as one sentence.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum BoundingFailure {
    /// Proved not to be one.
    #[error("the expression is not {property}: {counterexample}")]
    Refuted {
        /// The property that fails.
        property: Property,
        /// The proof that it fails.
        counterexample: Box<Counterexample>,
        /// The bytes of the operation responsible, where there is one.
        span: Option<Range<usize>>,
    },
    /// Neither proved nor refuted.
    #[error("it is not decided whether the expression is {property} near {region}: {reason}")]
    Undecided {
        /// The property that was not decided.
        property: Property,
        /// Where the proof got stuck.
        region: Box<DomainBox>,
        /// The bytes of the operation responsible, where there is one.
        span: Option<Range<usize>>,
        /// Why it got stuck.
        reason: Reason,
    },
}
