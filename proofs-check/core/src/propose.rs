//! Everything that is searched for: where to cut, by which rule each part is to be proved, which factors a
//! polynomial has.
//!
//! What comes from here is plain data ([`crate::monotone::Step`], break points, factors) and proves nothing: the rules verify that the
//! parts cover the whole, each part by one evaluation, and multiply the factors out. So a mistake here can make an answer `undecided`, never `valid`. It
//! is paid for apart from the claim ([`crate::effort::aside`]).

use crate::effort;
use crate::monotone::polynomials::{Factor, Polynomial, derivative, plus, scaled, trimmed};
use crate::monotone::{Facts, Function, Piece, Reason, Step};
use rug::Rational;
use std::collections::VecDeque;

/// The most pieces, and the most pieces times operations, that are looked at.
const MAX_PIECES: usize = 5_000;
const MAX_WORK: usize = 1_000_000;

/// What is found about a function on a box.
pub enum Proposal {
    /// How it is proved.
    Steps(Vec<Step>),
    /// Two points, one above the other in X or in E, from the first to the second of which it decreases.
    Decrease([[Rational; 2]; 2]),
    /// A piece on which the bounded effort does not settle it.
    Open(Piece),
}

/// The first rule that shows the function nondecreasing along an axis.
fn reason(facts: &Facts<'_>, along: usize) -> Option<Reason> {
    let from = [[false, false], [true, false], [false, true], [true, true]].map(Reason::Derivative);
    let mut reasons = [Reason::Flat, Reason::Slope, Reason::Growth].into_iter().chain(from);
    reasons.find(|reason| facts.shows(along, *reason))
}

/// Cuts a box [0, X] x [0, E] into pieces on which an expression is proved nondecreasing, the widest first, until every piece is proved, a point refutes
/// it or the effort ends.
pub fn cuts(function: &Function<'_>, whole: &Piece) -> Proposal {
    let limit = MAX_PIECES.min(MAX_WORK / function.expr.len().max(1));
    let (mut steps, mut looked_at) = (Vec::new(), 0);
    let mut queue = VecDeque::from([whole.clone()]);
    while let Some(piece) = queue.pop_front() {
        let facts = function.facts(&piece);
        let reasons = facts.as_ref().map(|facts| [0, 1].map(|along| reason(facts, along)));
        if let Some([Some(x), Some(e)]) = reasons {
            steps.push(Step::Proved([x, e]));
            continue;
        }
        looked_at += 1;
        let [[x0, x1], [e0, e1]] = &piece;
        let low = function.at([x0, e0]);
        for end in [[x1, e0], [x0, e1]] {
            if function.at(end).lt(&low) == Some(true) {
                return Proposal::Decrease([[x0, e0].map(Rational::clone), end.map(Rational::clone)]);
            }
        }
        if looked_at >= limit || effort::exhausted() {
            return Proposal::Open(piece);
        }
        // The longer side relative to the box, of those that matter.
        let width = |along: usize| {
            let [length, all] = [&piece, whole].map(|piece| Rational::from(&piece[along][1] - &piece[along][0]));
            if all == 0 { length } else { length / all }
        };
        let cut_e = match facts.map_or([false; 2], |facts| facts.constant()) {
            [true, false] => true,
            [false, true] => false,
            _ => width(1) > width(0),
        };
        let along = usize::from(cut_e && e0 != e1 || x0 == x1);
        let middle = Rational::from(&piece[along][0] + &piece[along][1]) / 2u32;
        queue.extend(Function::halves(&piece, along, &middle));
        steps.push(Step::Cut { along, at: middle });
    }
    Proposal::Steps(steps)
}

/// The square-free factors of a polynomial (Yun) with their exponents, in the order of these.
pub fn square_free(p: &Polynomial) -> Vec<Factor> {
    let Some(constant) = p.last() else { return Vec::new() };
    let d = derivative(p);
    let shared = common(p, &d);
    if shared.len() <= 1 {
        return vec![(monic(p), 1)];
    }
    let (mut bare, mut slope) =
        (divided(&monic(p), &shared).0, divided(&scaled(&d, &Rational::from(constant.recip_ref())), &shared).0);
    let mut factors = Vec::new();
    let mut exponent = 1;
    while bare.len() > 1 {
        let left = plus(&slope, &scaled(&derivative(&bare), &Rational::from(-1)));
        let factor = common(&bare, &left);
        (bare, slope) = (divided(&bare, &factor).0, divided(&left, &factor).0);
        if factor.len() > 1 {
            factors.push((factor, exponent));
        }
        exponent += 1;
    }
    factors
}

/// Quotient and remainder by a polynomial other than 0.
fn divided(p: &Polynomial, q: &Polynomial) -> (Polynomial, Polynomial) {
    let Some(lead) = q.last() else { return (Vec::new(), p.clone()) };
    let (mut quotient, mut rest) = (Vec::new(), p.clone());
    while rest.len() >= q.len() {
        let factor = rest.pop().unwrap_or_default() / lead;
        let shift = rest.len() + 1 - q.len();
        for (k, b) in q[..q.len() - 1].iter().enumerate() {
            rest[shift + k] -= Rational::from(&factor * b);
        }
        quotient.push(factor);
    }
    quotient.reverse();
    (trimmed(quotient), trimmed(rest))
}

/// The greatest common divisor, with leading coefficient 1.
fn common(p: &Polynomial, q: &Polynomial) -> Polynomial {
    let (mut p, mut q) = (monic(p), monic(q));
    while !q.is_empty() {
        let (_, rest) = divided(&p, &q);
        (p, q) = (q, monic(&rest));
    }
    p
}

fn monic(p: &Polynomial) -> Polynomial {
    p.last().map_or_else(Vec::new, |lead| scaled(p, &Rational::from(lead.recip_ref())))
}
