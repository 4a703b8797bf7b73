//! What is verified of a bounding function: that it is finite and nondecreasing in X and in E (docs/mathematics.md, section 1).
//!
//! The box [0, X] x [0, E] is cut into pieces, as somebody says ([`Step`]). On every piece the expression must be defined, and
//! its difference quotients in X and in E are proved nonnegative by the rule that is named for the piece: slopes or growth
//! (`slopes`), with the polynomials in sums taken exactly (`polynomials`), or second derivatives (`jets`). The pieces are
//! closed and cover the box, whatever the cuts are, so a segment along an axis runs through finitely many of them and the
//! expression is nondecreasing along it. A function that is defined on every piece is bounded there, hence finite.

mod jets;
pub mod polynomials;
mod slopes;

use crate::expr::Expr;
use crate::interval::Interval;
use polynomials::{Polynomials, Propose};
use rug::Rational;
use slopes::Part;
use std::cell::OnceCell;
use std::collections::VecDeque;

/// A closed piece of the box: the ends in X, the ends in E.
pub type Piece = [[Rational; 2]; 2];

/// One step of a proof: what is to be done with the piece that waits longest; the first is the box.
pub enum Step {
    /// It is cut along X (0) or E (1), and both halves wait.
    Cut {
        /// The axis.
        along: usize,
        /// A number between the ends.
        at: Rational,
    },
    /// The expression is nondecreasing on it in X and in E, for these reasons.
    Proved([Reason; 2]),
}

/// Why an expression is nondecreasing on a piece along an axis.
#[derive(Clone, Copy, Debug)]
pub enum Reason {
    /// The piece is a point along the axis.
    Flat,
    /// Its difference quotients are nonnegative.
    Slope,
    /// Its growth is nonnegative.
    Growth,
    /// Its derivative is nonnegative: enclosed at an end or the middle of the axes that are named, and changing from there by
    /// its own derivatives.
    Derivative([bool; 2]),
}

/// An expression with what every piece needs of it.
pub struct Function<'e> {
    /// The expression.
    pub expr: &'e Expr,
    polynomials: Polynomials,
    precision: u32,
}

impl<'e> Function<'e> {
    /// For a working precision in bits; `factor` proposes the factors of polynomials.
    pub fn new(expr: &'e Expr, factor: &Propose<'_>, precision: u32) -> Function<'e> {
        Function { expr, polynomials: Polynomials::new(expr, factor), precision }
    }

    /// The value at a point.
    pub fn at(&self, [x, e]: [&Rational; 2]) -> Interval {
        self.expr.enclose(&Interval::rational(x, self.precision), &Interval::rational(e, self.precision))
    }

    /// What one evaluation on a piece tells; `None` where the expression may be undefined or unbounded.
    pub fn facts(&self, piece: &Piece) -> Option<Facts<'_>> {
        let sides = piece.each_ref().map(|[a, b]| Interval::between(a, b, self.precision));
        let part = slopes::part(self.expr, &self.polynomials, [&sides[0], &sides[1]])?;
        let flat = piece.each_ref().map(|[a, b]| a == b);
        (part.value.is_bounded()).then(|| Facts { expr: self.expr, sides, flat, part, jet: OnceCell::new() })
    }

    /// A piece cut in two.
    pub fn halves(piece: &Piece, along: usize, at: &Rational) -> [Piece; 2] {
        [1, 0].map(|end| {
            let mut half = piece.clone();
            half[along][end] = at.clone();
            half
        })
    }

    /// Whether the steps prove the expression finite and nondecreasing on the box.
    pub fn verify(&self, whole: Piece, steps: &[Step]) -> bool {
        let mut queue = VecDeque::from([whole]);
        let all = steps.iter().all(|step| {
            let Some(piece) = queue.pop_front() else { return false };
            match step {
                Step::Cut { along, at } => {
                    let inside = piece.get(*along).is_some_and(|[a, b]| a < at && at < b);
                    queue.extend(inside.then(|| Function::halves(&piece, *along, at)).into_iter().flatten());
                    inside
                }
                Step::Proved(reasons) => {
                    let facts = self.facts(&piece);
                    facts.is_some_and(|facts| [0, 1].iter().all(|&along| facts.shows(along, reasons[along])))
                }
            }
        });
        all && queue.is_empty()
    }
}

/// What is known of an expression on a piece, on which it is defined and bounded.
pub struct Facts<'f> {
    expr: &'f Expr,
    sides: [Interval; 2],
    flat: [bool; 2],
    part: Part,
    /// The derivatives, once they are asked for.
    jet: OnceCell<Option<jets::Jet>>,
}

impl Facts<'_> {
    /// Whether it is nondecreasing along an axis for this reason.
    pub fn shows(&self, along: usize, reason: Reason) -> bool {
        match reason {
            Reason::Flat => self.flat[along],
            Reason::Slope => self.part.slope[along].is_nonnegative(),
            Reason::Growth => self.part.growth[along].is_nonnegative(),
            Reason::Derivative(moved) => {
                let sides = self.sides.each_ref();
                let whole = self.jet.get_or_init(|| jets::jet(self.expr, sides));
                whole.as_ref().is_some_and(|whole| jets::is_nondecreasing(self.expr, whole, sides, along, moved))
            }
        }
    }

    /// Along which axes it is constant, so that cutting them does not help.
    pub fn constant(&self) -> [bool; 2] {
        self.part.slope.each_ref().map(Interval::is_zero)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::ARGUMENTS;

    fn verified(text: &str, steps: &[Step]) -> bool {
        let whole = [0, 0].map(|from| [Rational::from(from), Rational::from(1)]);
        Function::new(&Expr::parse(text, ARGUMENTS).unwrap(), &|_| Vec::new(), 128).verify(whole, steps)
    }

    fn cut(along: usize, numerator: i32) -> Step {
        Step::Cut { along, at: Rational::from((numerator, 2)) }
    }

    #[test]
    fn the_pieces_must_cover_the_box() {
        let slope = || Step::Proved([Reason::Slope; 2]);
        assert!(verified("X + E", &[slope()]));
        assert!(verified("X + E", &[cut(0, 1), slope(), cut(1, 1), slope(), slope()]));
        // A piece that is left out, one too many, no piece at all, and cuts that are none.
        for steps in [vec![cut(0, 1), slope()], vec![slope(), slope()], vec![], vec![cut(0, 1)]] {
            assert!(!verified("X + E", &steps));
        }
        for cut in [cut(0, 0), cut(1, 2), cut(1, -1), cut(0, 3), cut(2, 1)] {
            assert!(!verified("X + E", &[cut, slope(), slope()]));
        }
    }

    #[test]
    fn each_piece_must_be_proved_for_the_reason_that_is_named() {
        let all = [Reason::Flat, Reason::Slope, Reason::Growth];
        let moved = [[false, false], [true, false], [false, true], [true, true]].map(Reason::Derivative);
        for reason in all.into_iter().chain(moved) {
            // They decrease along X, along E, and are not defined everywhere.
            for text in ["2 - X + E", "2 + X - E", "1/X", "log(X + E)", "1/(X - 1/2)"] {
                assert!(!verified(text, &[Step::Proved([reason; 2])]), "{text}, {reason:?}");
                let halves = [cut(0, 1), Step::Proved([reason; 2]), Step::Proved([reason; 2])];
                assert!(!verified(text, &halves), "{text}, {reason:?}");
            }
        }
        assert!(!verified("X + E", &[Step::Proved([Reason::Flat, Reason::Slope])]));
        assert!(verified("X^2/(1 + X)", &[Step::Proved([Reason::Growth; 2])]));
    }
}
