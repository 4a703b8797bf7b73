//! Smoothness of the right sides on the region (derivation, 11.1).

use super::centred::OnBox;
use super::chart::Placed;
use super::decide::subdivide;
use super::definite::{Verdict, nonnegative};
use super::engine::Engine;
use super::requirement::Requirement;
use super::side::Side;
use rug::Rational;
use sigmastar_exact::enclosure::Truth;
use sigmastar_lang::expr::{Memory, VariableSet};
use sigmastar_theory::{instead, otherwise};
use std::ops::Range;
use thiserror::Error;

/// The boxes that each operation may take.
pub(super) const BOXES: usize = 1 << 14;

/// An operation of a right side that is not proved to be applied where it is smooth.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{part}`: {}", told(.what, .truth.is_false()))]
pub struct SmoothnessFailure {
    /// The index of the right side: a state, or the number of states for q.
    pub index: usize,
    /// The bytes of the operation in the text of the right side.
    pub span: Range<usize>,
    /// The operation.
    pub part: String,
    /// What is demanded of it, in words.
    pub what: &'static str,
    /// False where the demand fails somewhere; undecided where it was not proved.
    pub truth: Truth,
}

/// What becomes of a demand, straight: what happens where it fails, or what is not decided.
fn told(what: &str, fails: bool) -> String {
    let where_ = "within X and E of the orbit, where the operation is not smooth";
    match otherwise(what) {
        Some(otherwise) if fails => format!("{otherwise} at some state and error {where_}"),
        Some(otherwise) => format!("it is not decided whether {otherwise} somewhere {where_}"),
        None => format!(
            "it is not {} that {what} everywhere within X and E of the orbit",
            if fails { "true" } else { "proved" }
        ),
    }
}

impl SmoothnessFailure {
    /// What helps: a smooth function in the place of the operation, or arguments that keep away from there.
    #[must_use]
    pub fn advice(&self) -> String {
        let instead = instead(self.what, &self.part);
        format!("{instead}; or take a smaller initial set, where it is that set which reaches so far")
    }
}

impl Engine {
    /// Decides that f and q are infinitely often differentiable near `G(X,E)`: every operation is applied strictly inside of
    /// where it is smooth.
    ///
    /// # Errors
    /// The first operation of which this is not proved, with what it demands in words; also for a negative X or E.
    pub fn smooth(&self, x: &Rational, e: &Rational) -> Result<(), SmoothnessFailure> {
        for requirement in &self.requirements {
            let truth = if *x < 0 || *e < 0 { Truth::Undecided } else { self.meets(requirement, [x, e]) };
            if !truth.is_true() {
                let Requirement { index, part, demand, .. } = requirement;
                let (span, part) = (demand.span.clone(), part.clone());
                return Err(SmoothnessFailure { index: *index, span, part, what: demand.what, truth });
            }
        }
        Ok(())
    }

    fn meets(&self, requirement: &Requirement, arguments: [&Rational; 2]) -> Truth {
        let Requirement { walk, active, demand, .. } = requirement;
        self.in_all(BOXES * self.parts(), |tube, effort| {
            let chart = self.chart(tube, active, arguments);
            let mut memory = Memory::default();
            subdivide(&chart, effort, |cell, ball| {
                let time = self.time_cell(tube, if chart.time { cell[0] } else { Side::WHOLE });
                let placed = chart.place(cell, ball, Some(&time));
                let Placed { frame, t, x, e, p } = &placed;
                let outputs = walk.evaluate_again(&mut OnBox { frame, t, x, e, p }, &mut memory, VariableSet::ALL);
                let Some(value) = outputs.first() else { return Verdict::Stuck };
                let above = nonnegative(frame, value, ball, true);
                if demand.positive || above == Verdict::Holds {
                    return above;
                }
                let negative = super::centred::negated(value);
                match (nonnegative(frame, &negative, ball, true), above) {
                    (Verdict::Holds, _) => Verdict::Holds,
                    // Not positive in the middle and not negative: it vanishes there.
                    (Verdict::Fails, Verdict::Fails) => Verdict::Fails,
                    (Verdict::Fails, other) | (other, _) => other,
                }
            })
        })
        .truth
    }
}
