//! What is wrong in print: the list E1 to E23, each item with its evidence computed on the spot.
//!
//! [`errata`] returns the list in order. The evidence is decided by exact rationals and enclosures; what rests on a
//! floating-point simulation or on the paper's own measurements is marked [`Kind::Cited`] and never called proved.
//! With a specification every item about the chain of constants also says what it means for that data ([`ForData`]).
//! The structure knows nothing of formats; the `Display` implementations are plain one-line texts.

mod claims;
mod contraction;
mod evidence;
mod example;
mod higher_degree;
mod infinite;
mod kappa;
mod numbers;
mod regulation;
mod report;
mod size;
mod slips;
mod square_wave;
mod stability;
mod transfer;

pub use evidence::{Evidence, Kind, Relation, Side};
pub use report::ErrataReport;

use sigmastar_exact::enclosure::DEFAULT_PRECISION;
use sigmastar_lang::expr::Expr;
use sigmastar_lang::spec::Specification;
use sigmastar_theory::data::{Bound, Data};
use std::fmt;

/// How much an erratum matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// Makes the printed chain of constants unsound or empty.
    A,
    /// Makes a printed proof wrong; the printed result is not contradicted.
    AProof,
    /// A sentence claims more than is proved or true.
    AClaim,
    /// The printed example does not satisfy the hypotheses.
    AExample,
    /// Sound but needlessly large.
    B,
    /// A slip without effect on the chain.
    C,
}

impl fmt::Display for Class {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Class::A => "A",
            Class::AProof => "A (proof)",
            Class::AClaim => "A (claim)",
            Class::AExample => "A (example)",
            Class::B => "B",
            Class::C => "C",
        })
    }
}

/// What an erratum means for the data of one specification.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bearing {
    /// Proved for this data: the printed formula is contradicted, has no solution, or gives less than is proved.
    Bites,
    /// Proved for this data: the printed formula gives a sound value, but a larger one than needed.
    Costs,
    /// Proved for this data: the printed value is the right one or is sound for another reason.
    Harmless,
    /// Not settled by this data alone: it depends on the plant or on numbers that are still free.
    Depends,
}

impl fmt::Display for Bearing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Bearing::Bites => "bites",
            Bearing::Costs => "costs",
            Bearing::Harmless => "harmless",
            Bearing::Depends => "depends",
        })
    }
}

/// A named number.
#[derive(Clone, Debug)]
pub struct NamedNumber {
    /// What it is.
    pub name: String,
    /// Its value.
    pub value: Side,
}

impl fmt::Display for NamedNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}", self.name, self.value)
    }
}

/// An erratum seen from one specification.
#[derive(Clone, Debug)]
pub struct ForData {
    /// Whether it matters there.
    pub bearing: Bearing,
    /// One sentence.
    pub summary: String,
    /// The numbers behind it.
    pub figures: Vec<NamedNumber>,
}

impl ForData {
    fn new(bearing: Bearing, summary: impl Into<String>) -> ForData {
        ForData { bearing, summary: summary.into(), figures: Vec::new() }
    }

    fn figure(mut self, name: impl Into<String>, value: impl Into<Side>) -> ForData {
        self.figures.push(NamedNumber { name: name.into(), value: value.into() });
        self
    }
}

impl fmt::Display for ForData {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.bearing, self.summary)?;
        for (index, figure) in self.figures.iter().enumerate() {
            write!(f, "{}{figure}", if index == 0 { " [" } else { "; " })?;
        }
        if self.figures.is_empty() { Ok(()) } else { f.write_str("]") }
    }
}

/// One item of the list.
#[derive(Clone, Debug)]
pub struct Erratum {
    /// E1 to E23.
    pub id: &'static str,
    /// Where in the paper: LaTeX labels (`P:...`) and words.
    pub place: &'static str,
    /// How much it matters.
    pub class: Class,
    /// What is printed.
    pub printed: &'static str,
    /// What holds instead.
    pub instead: &'static str,
    /// The evidence.
    pub evidence: Vec<Evidence>,
    /// What it means for a specification, where one is given and the item is about such data.
    pub for_data: Option<ForData>,
}

impl Erratum {
    /// Whether every piece of rigorous evidence was proved, and there is at least one.
    #[must_use]
    pub fn is_proved(&self) -> bool {
        let mut rigorous = self.evidence.iter().filter(|e| e.kind == Kind::Rigorous).peekable();
        rigorous.peek().is_some() && rigorous.all(Evidence::is_proved)
    }
}

/// The list E1, ..., E23, in order, with its evidence; with a specification, also what each item means for it.
#[must_use]
pub fn errata(spec: Option<&Specification>) -> Vec<Erratum> {
    // The paper knows of no input gain.
    let spec = spec.map(|spec| Specification { input_gain: None, ..spec.clone() });
    let data = spec.as_ref().map(|spec| Data::new(spec, DEFAULT_PRECISION));
    let data = data.as_ref();
    vec![
        size::e1(data),
        size::e2(data),
        stability::e3(data),
        stability::e4(data),
        contraction::e5(data),
        transfer::e6(data),
        transfer::e7(data),
        transfer::e8(data),
        transfer::e9(data),
        regulation::e10(data),
        regulation::e11(data),
        regulation::e12(data),
        infinite::e13(data),
        higher_degree::e14(data),
        claims::e15(data),
        claims::e16(data),
        slips::e17(),
        example::e18(data),
        example::e19(),
        example::e20(),
        example::e21(),
        example::e22(),
        infinite::e23(),
    ]
}

/// Whether a bounding function is the constant 0, exactly.
fn vanishes(data: &Data<'_>, bound: Bound) -> bool {
    let constant = bound.of(data.spec).and_then(Expr::exact);
    constant.as_ref().and_then(|value| value.as_rational()).is_some_and(rug::Rational::is_zero)
}

/// Whether a bounding function is a constant, exactly.
fn is_constant(data: &Data<'_>, bound: Bound) -> bool {
    bound.of(data.spec).is_some_and(|expr| expr.exact().is_some())
}
