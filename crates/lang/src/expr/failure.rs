//! Why an expression was not proved to be a bounding function.

use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_rational, write_exact};
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

/// Digits of the numbers in a message, as far as they tell apart what must be told apart.
const DIGITS: usize = 6;

/// Six digits of each number, more where the two points or their values would look alike; numbers that are longer are
/// marked by "about". The alternate form (`{:#}`) has every digit of the points and seventeen of the values.
impl fmt::Display for Counterexample {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = if f.alternate() { None } else { Some(self.digits()) };
        let point = |x: &Rational, e: &Rational| format!("X {}, E {}", coordinate(x, digits), coordinate(e, digits));
        let value = |at: &Evaluation| {
            let [lower, upper] = interval(&at.value, digits.unwrap_or(sigmastar_exact::enclosure::DIGITS));
            format!("its value at {} lies in [{lower}, {upper}]", point(&at.x, &at.e))
        };
        match self {
            Counterexample::Undefined { x, e } => write!(f, "it is undefined at {}", point(x, e)),
            Counterexample::Negative(at) => f.write_str(&value(at)),
            Counterexample::Decrease { from, to } => write!(f, "{}, and {}", value(from), value(to)),
        }
    }
}

impl Counterexample {
    /// The digits at which the two points and their values are told apart.
    fn digits(&self) -> usize {
        let Counterexample::Decrease { from, to } = self else { return DIGITS };
        let apart = |digits: &usize| {
            let rounded = |side: &Rational| round_rational(side, *digits as u32, Direction::Nearest);
            let [points, others] = [from, to].map(|at| [&at.x, &at.e].map(rounded));
            let [values, below] = [from, to].map(|at| interval(&at.value, *digits));
            points != others && values != below
        };
        (DIGITS..sigmastar_exact::enclosure::DIGITS).find(apart).unwrap_or(sigmastar_exact::enclosure::DIGITS)
    }
}

/// `= 1/3`, or `about 0.333333` where the exact number is longer than the digits wanted.
fn coordinate(value: &Rational, digits: Option<usize>) -> String {
    let exact = write_exact(value);
    match digits {
        // A point and a sign are no digits.
        Some(digits) if exact.len() > digits + 2 => {
            let rounded = round_rational(value, digits as u32, Direction::Nearest);
            format!("about {}", write_exact(&rounded))
        }
        _ => format!("= {exact}"),
    }
}

/// The ends of an enclosure, rounded outward to so many digits.
fn interval(value: &Enclosure, digits: usize) -> [String; 2] {
    [value.lower_decimal(digits), value.upper_decimal(digits)]
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
    /// The largest X or E is negative: there is no domain.
    #[error("the domain is empty")]
    Empty,
    /// The largest X or E is not known to be finite.
    #[error("the domain has no largest X or E that can be enclosed")]
    Endless,
}

/// Why [`super::prove_bounding`] did not prove that an expression is a bounding function. Displayed as one sentence, with a
/// counterexample in few digits.
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

impl BoundingFailure {
    /// Nothing is decided, because the domain has no ends that can be enclosed.
    #[must_use]
    pub fn without_domain() -> BoundingFailure {
        let point = || [Rational::new(), Rational::new()];
        BoundingFailure::Undecided {
            property: Property::Finite,
            region: Box::new(DomainBox { x: point(), e: point() }),
            span: None,
            reason: Reason::Endless,
        }
    }

    /// The sentence with every digit of a counterexample, where there is one.
    #[must_use]
    pub fn in_full(&self) -> Option<String> {
        match self {
            BoundingFailure::Refuted { property, counterexample, .. } => {
                Some(format!("the expression is not {property}: {counterexample:#}"))
            }
            BoundingFailure::Undecided { .. } => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: Rational, value: i64) -> Evaluation {
        Evaluation { x, e: Rational::new(), value: Enclosure::from_integer(value, 128) }
    }

    #[test]
    fn few_digits_in_a_message_and_all_of_them_in_full() {
        let third = Rational::from((1, 3));
        let long = Rational::from((10, 3)) + Rational::from_f64(1e-30).unwrap();
        let failure = |counterexample| BoundingFailure::Refuted {
            property: Property::Nonnegative,
            counterexample: Box::new(counterexample),
            span: None,
        };
        let negative = failure(Counterexample::Negative(at(long.clone(), -2)));
        let said = "the expression is not nonnegative: its value at X about 3.33333, E = 0 lies in [-2, -2]";
        assert_eq!(negative.to_string(), said);
        assert!(negative.in_full().unwrap().contains(&format!("X = {}, E = 0", write_exact(&long))));
        let undefined = failure(Counterexample::Undefined { x: third.clone(), e: third });
        assert!(undefined.to_string().ends_with("it is undefined at X = 1/3, E = 1/3"), "{undefined}");
        // Two points that differ in the ninth digit.
        let near = Rational::from((1, 3)) + Rational::from((1, 1_000_000_000));
        let decrease = Counterexample::Decrease { from: at(Rational::from((1, 3)), 2), to: at(near, 1) };
        assert!(decrease.to_string().contains("X about 0.333333334,"), "{decrease}");
    }
}
