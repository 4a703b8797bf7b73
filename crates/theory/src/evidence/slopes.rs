//! Of the first derivatives of a plant's formulas together (derivation, 13.6).

use rug::Rational;
use std::ops::Range;

/// Which of the first derivatives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// `[[f_x, f_e], [q_x, q_e]]`.
    All,
    /// `[[f_x], [q_x]]`.
    States,
    /// `[[f_e], [q_e]]`.
    Error,
}

impl Part {
    /// Each of them, in order.
    pub const EACH: [Part; 3] = [Part::All, Part::States, Part::Error];

    /// The columns of `[[f_x, f_e], [q_x, q_e]]` that it has, of a plant with n states.
    #[must_use]
    pub fn columns(self, n: usize) -> Range<usize> {
        match self {
            Part::All => 0..n + 1,
            Part::States => 0..n,
            Part::Error => n..n + 1,
        }
    }
}

/// Q, G and H by rows, of a part of D with k columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slopes {
    /// The part.
    pub part: Part,
    /// Q: symmetric, of order k.
    pub q: Vec<Vec<Rational>>,
    /// G: k rows of n + 1.
    pub g: Vec<Vec<Rational>>,
    /// H: symmetric, positive definite, of order n + 1.
    pub h: Vec<Vec<Rational>>,
}
