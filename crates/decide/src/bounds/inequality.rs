//! The matrix inequality (M) of stability (derivation, 13.7): decided with enclosures by subdivision.

use super::PRECISION;
use super::centred::{Centred, Frame, negated};
use super::chart::Ball;
use super::decide::{Decision, InY, OnBoxes, Values, subdivide};
use super::definite::{SymmetricValues, Verdict, definite};
use super::engine::Engine;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::{Bound, Constant, MatrixInequality, Splitting};
use sigmastar_matrix::is_symmetric;
use sigmastar_theory::evidence::Part;

impl Engine {
    /// Decides the inequality, with so many boxes for each of its parts at most; mu is that of the internal model.
    ///
    /// Guarantee: `True` only if, for every t, every point of `|y| <= X`, `|e| <= E` around any x_0 within r of xb, and the
    /// derivatives (J, g, r, d) of f and q there in the coordinates y, with `kp = 2 h/mu` and `J_+ = J + rate I`,
    /// `F = [[-w_x (P' + P J_+ + J_+'P), -w_x P g, -(kp/2) r'], [., 2 value, -1 - (kp/2) d], [., ., kp]]` is positive definite; with a
    /// splitting for (J, r) at every point of one region and (g, d) at every point of another one, at the same t; with an input gain so
    /// at both ends of b with d + (1-b) value in the place of d; and `w_x`, `h` and `rate` are positive. `False` only if it, or what the splitting asks for, is not so at a point. For the caller to prove:
    /// what [`Engine::decide`] leaves to him.
    #[must_use]
    pub fn decide_inequality(&self, inequality: &MatrixInequality, mu: &Constant, effort: usize) -> Decision {
        let MatrixInequality { w_x, h, rate, splitting, .. } = inequality;
        if [w_x, h, rate].into_iter().any(|weight| *weight <= 0) {
            return Decision::FALSE;
        }
        let [of_states, of_error] = inequality.arguments();
        let negative = of_states.iter().chain(&of_error).any(|end| **end < 0);
        if negative || (self.states() > 0 && !self.has_matrix(Bound::Rate)) {
            return Decision::UNDECIDED;
        }
        let form = Form::new(inequality, mu);
        let ends = self.moved_slopes(&inequality.value);
        let Some(Splitting { matrix, .. }) = splitting else {
            return self.decide_ends(&ends, (Part::All, of_states), effort, |values, moved| form.whole(values, moved));
        };
        if !is_symmetric(matrix, self.states() + 1) {
            return Decision::UNDECIDED;
        }
        // With the first, F is at least what the second is about.
        let first = self.decide_part(Part::States, of_states, effort, |values| form.beyond(matrix, values));
        let beside = |values: &Values<'_>, moved: &Rational| form.beside(matrix, values, moved);
        first.and(|| self.decide_ends(&ends, (Part::Error, of_error), effort, beside))
    }

    /// Decides that `matrix(values, moved)` is positive definite on `G(X, E)` for each move `moved` of d in `ends`. There are two moves
    /// where there is an input gain, else one.
    pub(super) fn decide_ends(
        &self,
        ends: &[Rational],
        (part, at): (Part, [&Rational; 2]),
        effort: usize,
        matrix: impl Fn(&Values<'_>, &Rational) -> Option<SymmetricValues>,
    ) -> Decision {
        self.decide_all(ends, (part, at), effort, matrix)
    }

    /// Decides that `matrix(values, which)` is positive definite on `G(X, E)` for each of `all`, on the same boxes: what is evaluated there serves all.
    pub(super) fn decide_all<W>(
        &self,
        all: &[W],
        (part, at): (Part, [&Rational; 2]),
        effort: usize,
        matrix: impl Fn(&Values<'_>, &W) -> Option<SymmetricValues>,
    ) -> Decision {
        let quantity = self.first_derivatives(part);
        let examine = |values: &Values<'_>, frame: &Frame, ball: &Ball, which: &W| match matrix(values, which) {
            Some(mut matrix) => {
                matrix.entries.retain(|(i, j, value)| i == j || !value.is_zero());
                definite(frame, &matrix, ball)
            }
            None => Verdict::Stuck,
        };
        self.in_all(effort, |tube, effort| {
            let chart = self.chart(tube, &quantity.active, at);
            let mut boxes = OnBoxes::new(self, quantity, (tube, &chart));
            subdivide(&chart, effort, |cell, ball| {
                boxes.with(cell, ball, |values, frame| {
                    let mut verdicts = all.iter().map(|which| examine(values, frame, ball, which));
                    verdicts.find(|verdict| *verdict != Verdict::Holds).unwrap_or(Verdict::Holds)
                })
            })
        })
    }

    /// Decides that a matrix of these derivatives is positive definite on `G(X, E)`.
    pub(super) fn decide_part(
        &self,
        part: Part,
        at: [&Rational; 2],
        effort: usize,
        matrix: impl Fn(&Values<'_>) -> Option<SymmetricValues>,
    ) -> Decision {
        self.decide_all(&[()], (part, at), effort, |values, ()| matrix(values))
    }
}

/// d, moved by an input gain where there is one.
pub(super) fn moved_by(frame: &Frame, slope: Centred, moved: &Rational) -> Centred {
    if *moved == 0 { slope } else { frame.add(&slope, &frame.rational(moved)) }
}

/// Subtracts S from a matrix in (x, y).
pub(super) fn subtract(frame: &Frame, entries: &mut Entries, s: &[Vec<Rational>]) {
    for (i, j, value) in entries {
        *value = frame.sub(value, &frame.rational(&s[*i][*j]));
    }
}

/// S in (x, y) as a part of a matrix in (x, e, y).
pub(super) fn in_x_and_y(frame: &Frame, s: &[Vec<Rational>]) -> Entries {
    let n = s.len() - 1;
    let place = |index: usize| if index == n { n + 1 } else { index };
    let upper = (0..=n).flat_map(|i| (i..=n).map(move |j| (i, j)));
    upper.map(|(i, j)| (place(i), place(j), frame.rational(&s[i][j]))).collect()
}

/// The numbers of F.
struct Form {
    w_x: Enclosure,
    half_k_p: Enclosure,
    rate: Enclosure,
    value: Enclosure,
}

/// Entries (row, column, value) on and above the diagonal.
pub(super) type Entries = Vec<(usize, usize, Centred)>;

impl Form {
    fn new(MatrixInequality { w_x, h, rate, value, .. }: &MatrixInequality, mu: &Constant) -> Form {
        let exact = |number: &Rational| Enclosure::from_rational(number, PRECISION);
        let half_k_p = exact(h) / mu.enclose(PRECISION);
        Form { w_x: exact(w_x), half_k_p, rate: exact(rate), value: exact(value) }
    }

    /// F in (x, e, y), from all derivatives, and what d is moved by.
    fn whole(&self, values: &Values<'_>, moved: &Rational) -> Option<SymmetricValues> {
        let all = values.in_y(Part::All)?;
        let n = all.row.len();
        let mut entries = self.of_states(values, &all, n + 1)?;
        entries.extend(self.of_error(values, &all, moved)?);
        Some(SymmetricValues { order: n + 2, entries })
    }

    /// F without the row of e, less S, from (J, r).
    fn beyond(&self, s: &[Vec<Rational>], values: &Values<'_>) -> Option<SymmetricValues> {
        let frame = values.frame;
        let of_states = values.in_y(Part::States)?;
        let n = of_states.row.len();
        let mut entries = self.of_states(values, &of_states, n)?;
        subtract(frame, &mut entries, s);
        Some(SymmetricValues { order: n + 1, entries })
    }

    /// `[[S, v], [v', 2 value]]` in the order (x, e, y), from (g, d).
    fn beside(&self, s: &[Vec<Rational>], values: &Values<'_>, moved: &Rational) -> Option<SymmetricValues> {
        let frame = values.frame;
        let of_error = values.in_y(Part::Error)?;
        let n = of_error.column.len();
        let mut entries = self.of_error(values, &of_error, moved)?;
        entries.extend(in_x_and_y(frame, s));
        Some(SymmetricValues { order: n + 2, entries })
    }

    /// The block of x and y, which stands in the row `y`: all of it, zeros too.
    fn of_states(&self, values: &Values<'_>, InY { jacobian, row, .. }: &InY, y: usize) -> Option<Entries> {
        let frame = values.frame;
        let mut entries = Entries::new();
        if !row.is_empty() {
            let decay = values.decay(Bound::Rate, jacobian, &frame.constant(self.rate.clone()))?;
            entries.extend(decay.entries.into_iter().map(|(i, j, value)| (i, j, frame.scale(&value, &self.w_x))));
            entries
                .extend(row.iter().enumerate().map(|(i, value)| (i, y, negated(&frame.scale(value, &self.half_k_p)))));
        }
        entries.push((y, y, frame.constant(&self.half_k_p * 2)));
        Some(entries)
    }

    /// The row of e, which is the last but one.
    fn of_error(&self, values: &Values<'_>, InY { column, slope, .. }: &InY, moved: &Rational) -> Option<Entries> {
        let frame = values.frame;
        let slope = moved_by(frame, slope.clone()?, moved);
        let n = column.len();
        let mut entries = Entries::new();
        if n > 0 {
            let moved = values.times_p(column)?;
            entries.extend(
                moved.into_iter().enumerate().map(|(i, value)| (i, n, negated(&frame.scale(&value, &self.w_x)))),
            );
        }
        entries.push((n, n, frame.constant(&self.value * 2)));
        let one = frame.constant(Enclosure::one(PRECISION));
        entries.push((n, n + 1, negated(&frame.add(&one, &frame.scale(&slope, &self.half_k_p)))));
        Some(entries)
    }
}
