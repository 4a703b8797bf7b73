//! Rule: bounding functions are finite and nondecreasing in X and in E, and nowhere certainly negative (docs/mathematics.md,
//! section 1).
//!
//! The box [0, X] x [0, E] is cut until, on every piece, the expression is defined and its difference quotients in X
//! and in E are proved nonnegative: by slopes and growth (`slopes`), with the polynomials in sums taken exactly
//! (`polynomials`), or by second derivatives (`jets`). The pieces are closed and cover the box, so a segment along an
//! axis runs through finitely many of them and the expression is nondecreasing along it. A function that is defined on
//! every piece is bounded there, hence finite. What is used is its positive part: a bound of a norm is one without its
//! negative values too, so a sign that rounding leaves open, as at an origin where the value is exactly 0, does no harm.

mod jets;
mod polynomials;
mod slopes;

use crate::effort;
use crate::expr::Expr;
use crate::interval::Interval;
use crate::verdict::{Outcome, Verdict, finding};
use polynomials::Polynomials;
use rug::Rational;
use std::collections::VecDeque;

/// The most pieces, and the most pieces times operations, that are looked at.
const MAX_PIECES: usize = 5_000;
const MAX_WORK: usize = 1_000_000;

/// The name of this rule.
pub const RULE: &str = "bounding functions";

/// What is left open on a piece.
struct Open {
    /// Along which axes the expression is proved constant on the piece, so that cutting them does not help.
    constant: [bool; 2],
}

/// Proves the expression defined and nondecreasing along both axes on the piece, or says that it did not.
fn examine(expr: &Expr, polynomials: &Polynomials, piece: &[[Rational; 2]; 2], precision: u32) -> Option<Open> {
    let [x, e] = [0, 1].map(|side| Interval::between(&piece[side][0], &piece[side][1], precision));
    let Some(part) = slopes::part(expr, polynomials, [&x, &e]) else { return Some(Open { constant: [false; 2] }) };
    if !part.value.is_defined() || !part.value.is_bounded() {
        return Some(Open { constant: [false; 2] });
    }
    let monotone = |side: usize| {
        piece[side][0] == piece[side][1]
            || part.slope[side].is_nonnegative()
            || part.growth[side].is_nonnegative()
            || jets::is_nondecreasing(expr, [&x, &e], side)
    };
    let proved = monotone(0) && monotone(1);
    (!proved).then(|| Open { constant: part.slope.each_ref().map(Interval::is_zero) })
}

/// Proves the expression finite and nondecreasing on [0, x] x [0, e].
///
/// # Errors
/// `invalid` with two points where it certainly decreases, or one where it is certainly negative; `undecided` with a
/// place, when the bounded effort does not settle it.
pub fn prove(name: &str, expr: &Expr, x: &Rational, e: &Rational, precision: u32) -> Outcome<()> {
    let pointer = format!("/specification/bounds/{name}");
    let at =
        |x: &Rational, e: &Rational| expr.enclose(&Interval::rational(x, precision), &Interval::rational(e, precision));
    let zero = Rational::new();
    let origin = at(&zero, &zero);
    if origin.lt(&Interval::int(0, precision)) == Some(true) {
        return Err(finding(Verdict::Invalid, RULE, &pointer, "it is negative at X = 0, E = 0"));
    }
    let polynomials = Polynomials::new(expr);
    let mut queue = VecDeque::from([[[zero.clone(), x.clone()], [zero.clone(), e.clone()]]]);
    let limit = MAX_PIECES.min(MAX_WORK / expr.len().max(1));
    let mut looked_at = 0;
    while let Some(piece) = queue.pop_front() {
        let Some(open) = examine(expr, &polynomials, &piece, precision) else { continue };
        looked_at += 1;
        let [[x0, x1], [e0, e1]] = &piece;
        let shown = |q: &Rational| q.to_f64();
        let low = at(x0, e0);
        for (px, pe) in [(x1, e0), (x0, e1)] {
            if at(px, pe).lt(&low) == Some(true) {
                let (x0, e0, px, pe) = (shown(x0), shown(e0), shown(px), shown(pe));
                let message = format!("it decreases from X = {x0}, E = {e0} to X = {px}, E = {pe}");
                return Err(finding(Verdict::Invalid, RULE, &pointer, message));
            }
        }
        if looked_at >= limit || effort::exhausted() {
            let [x0, x1, e0, e1] = [x0, x1, e0, e1].map(shown);
            let message = format!("that it is finite and nondecreasing is not proved on [{x0}, {x1}] x [{e0}, {e1}]");
            return Err(finding(Verdict::Undecided, RULE, &pointer, message));
        }
        // The longer side relative to the box, of those that matter.
        let width = |side: &[Rational; 2], whole: &Rational| {
            let ends: Rational = (&side[1] - &side[0]).into();
            if *whole == 0 { ends } else { ends / whole }
        };
        let longer = width(&piece[1], e) > width(&piece[0], x);
        let cut_e = match open.constant {
            [true, false] => true,
            [false, true] => false,
            _ => longer,
        };
        let along = usize::from(cut_e && e0 != e1 || x0 == x1);
        let middle = Rational::from(&piece[along][0] + &piece[along][1]) / 2u32;
        for (index, end) in [(1, &middle), (0, &middle)] {
            let mut half = piece.clone();
            half[along][index] = end.clone();
            queue.push_back(half);
        }
    }
    Ok(())
}
