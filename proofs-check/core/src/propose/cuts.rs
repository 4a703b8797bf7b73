//! Cuts of a box [0, X] x [0, E] into pieces on which an expression is proved nondecreasing, the widest first.

use crate::effort;
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

/// Cuts the box until every piece is proved, a point refutes it or the effort ends.
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
