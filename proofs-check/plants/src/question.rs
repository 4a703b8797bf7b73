//! Whether a symmetric matrix of formulas is positive semidefinite on a region: every bound of section 11.3 of
//! docs/mathematics.md is such a question.
//!
//! On a box with the middle c, `Q(z) = Q(c) + sum_k (z_k - c_k) D_k`, where D_k lies in the enclosure of the k-th derivative on the
//! box (mean value theorem, entry by entry). The box may reach out of the ball, so that its middle and the segments to it lie
//! where nothing is known of the formulas: it is used only where every operation is seen to be smooth on the whole box. With an invertible S of the middle, `S'QS` is enclosed entry by entry, and is positive
//! definite if its pivots are. S makes the entries beside the diagonal vanish at the middle, so they count with their squares,
//! and the entry that decides is bounded from below to second order. Its part in v is bounded over the ball as well, where a
//! linear function has a bound that no box around the ball gives.
//!
//! The boxes are halved where that fails, along the axis that contributes most; the choice of the axis and of S decides nothing.

use super::formula::{Axis, Demand, Formulas, Id};
use super::machine::{At, Cell, Machine, Program, Values};
use super::region::{Narrowing, Piece, Region, axes, axis};
use super::time::around;
use proofs_core::effort;
use proofs_core::interval::Interval;
use proofs_core::matrix::semidefinite;
use rug::Float;
use std::rc::Rc;

/// The most boxes that one question may take, where the steps of interval arithmetic are not bounded.
pub const MAX_PIECES: usize = 1_000_000;

/// A side that is narrower in comparison with that of the first boxes is not halved: what is not decided there is not decided by
/// boxes, as a value that only a smaller bound of the drift would show.
const LEAST_SHARE: f64 = 1e-12;

/// After so many boxes, places where the matrix may not be semidefinite are tried as well.
const PROBED_AFTER: usize = 24;

/// The rows of a symmetric matrix, its lower triangle, with its derivatives.
#[derive(Clone, Debug)]
pub struct Question {
    rows: Vec<Vec<Id>>,
    /// Along t (`None`) and the sides on which an entry depends.
    slopes: Vec<(Option<usize>, Vec<Vec<Id>>)>,
    /// What makes the entries continuously differentiable.
    corners: Vec<(Id, Demand)>,
    depends: u16,
}

/// The answer to a question.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// It is, on all boxes: their number.
    Proved(usize),
    /// It is certainly not at this t, in words.
    Refuted(String),
    /// It could not be decided near this t.
    Open(String),
}

impl Question {
    /// Prepares the derivatives of a lower triangle.
    pub fn new(formulas: &mut Formulas, rows: Vec<Vec<Id>>, states: usize) -> Question {
        let depends = rows.iter().flatten().fold(0, |all, id| all | formulas.depends(*id));
        let slope = |side: Option<usize>| {
            let axis = axis(side, states);
            let rows = rows.iter().map(|row| row.iter().map(|id| formulas.derivative(*id, axis)).collect()).collect();
            (side, rows)
        };
        let slopes = axes(depends, states).map(slope).collect();
        let entries: Vec<Id> = rows.iter().flatten().copied().collect();
        Question { slopes, corners: formulas.corners(&entries), rows, depends }
    }

    /// Whether it changes with t.
    pub fn moves(&self) -> bool {
        self.depends & Axis::Time.bit() != 0
    }

    /// Whether an entry depends on a component of the states.
    pub fn names(&self, state: usize) -> bool {
        self.depends & Axis::State(state).bit() != 0
    }

    /// Decides it on a region, by so many boxes at most.
    pub fn decide(
        &self,
        machine: &Machine<'_>,
        root: &Rc<Cell>,
        region: &Region,
        most: usize,
        values: &mut Values,
    ) -> Answer {
        let entries: Vec<Id> = self.rows.iter().flatten().copied().collect();
        let slopes = self.slopes.iter().flat_map(|(_, rows)| rows.iter().flatten());
        let corners = self.corners.iter().map(|(id, _)| id);
        let all: Vec<Id> = entries.iter().chain(slopes).chain(corners).copied().collect();
        let mut decision = Decision {
            question: self,
            machine,
            region,
            programs: [machine.program(&entries), machine.program(&all)],
            narrowings: self.corners.iter().map(|(id, _)| Narrowing::new(machine, *id)).collect(),
            values,
        };
        let mut queue = region.pieces(machine, root, self.depends);
        queue.reverse();
        let Some(whole) = queue.last().cloned() else { return Answer::Proved(0) };
        let mut count = 0;
        while let Some(piece) = queue.pop() {
            count += 1;
            if count > most || effort::exhausted() {
                return Answer::Open(place(region, &piece));
            }
            match decision.judge(&piece, &whole, count > PROBED_AFTER) {
                Judgement::Proved => {}
                Judgement::Refuted => return Answer::Refuted(place(region, &piece)),
                Judgement::Halve(side) => match side.or_else(|| piece.widest(&whole, self.depends, region.states)) {
                    Some(side) if piece.share(side, &whole) > LEAST_SHARE => queue.extend(piece.halves(side)),
                    _ => return Answer::Open(place(region, &piece)),
                },
            }
        }
        Answer::Proved(count)
    }
}

fn place(region: &Region, piece: &Piece) -> String {
    let states = region.states;
    let listed = |sides: std::ops::Range<usize>| {
        let list: Vec<String> = sides.map(|i| format!("{:.6}", piece.sides[i].to_f64())).collect();
        list.join(", ")
    };
    let (t, e) = (piece.cell.middle.to_f64(), piece.sides[states].to_f64());
    let of_family = match region.parameters.len() {
        0 => String::new(),
        count => format!(", p = ({})", listed(states + 1..states + 1 + count)),
    };
    if states == 0 && e == 0.0 {
        return format!("t = {t:.6}{of_family}");
    }
    format!("t = {t:.6}, L^-1 (x - xb) = ({}), e = {e:.6}{of_family}", listed(0..states))
}

enum Judgement {
    Proved,
    Refuted,
    /// Along t, a side, or whichever is widest.
    Halve(Option<Option<usize>>),
}

type Matrix = Vec<Vec<Interval>>;

struct Decision<'a, 'f> {
    question: &'a Question,
    machine: &'a Machine<'f>,
    region: &'a Region,
    /// For the entries alone, and with the derivatives.
    programs: [Program; 2],
    /// One for each corner.
    narrowings: Vec<Narrowing>,
    values: &'a mut Values,
}

impl Decision<'_, '_> {
    fn read(&self, rows: &[Vec<Id>], at: At, cell: &Cell) -> Matrix {
        rows.iter().map(|row| row.iter().map(|id| self.machine.get(*id, at, cell, self.values)).collect()).collect()
    }

    fn judge(&mut self, piece: &Piece, whole: &Piece, probed: bool) -> Judgement {
        let states = self.region.states;
        if self.region.misses(piece) {
            return Judgement::Proved;
        }
        let rows = &self.question.rows;
        let (v, rest) = piece.sides.split_at(states);
        self.machine.run(&self.programs[1], At::Box, &piece.cell, v, rest, self.values);
        let on_box = self.read(rows, At::Box, &piece.cell);
        if semidefinite(on_box.clone()) == Some(true) {
            return Judgement::Proved;
        }
        let value = |id: Id| self.machine.get(id, At::Box, &piece.cell, self.values);
        let corner = self.question.corners.iter().position(|(id, what)| !what.holds(&value(*id)));
        let slopes: Vec<(Option<usize>, Matrix)> =
            self.question.slopes.iter().map(|(side, rows)| (*side, self.read(rows, At::Box, &piece.cell))).collect();
        let points = piece.middles();
        let (v, rest) = points.split_at(states);
        self.machine.run(&self.programs[0], At::Middle, &piece.cell, v, rest, self.values);
        let middle = self.read(rows, At::Middle, &piece.cell);
        if semidefinite(middle.clone()) == Some(false) && self.region.has_middle(piece) {
            return Judgement::Refuted;
        }
        let defined = on_box.iter().chain(slopes.iter().flat_map(|(_, rows)| rows)).flatten().all(Interval::is_defined);
        let judgement = match corner {
            Some(corner) => {
                Judgement::Halve(self.narrowings[corner].axis(self.machine, piece, whole, states, self.values))
            }
            None if defined => self.by_mean_value(piece, &middle, &slopes),
            None => Judgement::Halve(None),
        };
        let open = matches!(judgement, Judgement::Halve(_));
        if open && probed && self.fails_at_end(piece, &middle, &slopes) { Judgement::Refuted } else { judgement }
    }

    /// Whether the matrix is certainly not semidefinite where its last pivot falls to, at the time in the middle: at ends of the
    /// box, moved into the ball.
    fn fails_at_end(&mut self, piece: &Piece, middle: &Matrix, slopes: &[(Option<usize>, Matrix)]) -> bool {
        let states = self.region.states;
        let Some(basis) = Basis::new(middle) else { return false };
        let last = middle.len() - 1;
        let mut place = piece.middles();
        for (side, matrix) in slopes {
            let Some(side) = *side else { continue };
            let rate = basis.form(matrix, last, last).middle();
            if !rate.is_zero() {
                place[side] =
                    if rate.is_nonpositive() { piece.sides[side].ceiling() } else { piece.sides[side].floor() };
            }
        }
        self.region.inward(&mut place);
        let (v, rest) = place.split_at(states);
        self.machine.run(&self.programs[0], At::Middle, &piece.cell, v, rest, self.values);
        let there = self.read(&self.question.rows, At::Middle, &piece.cell);
        self.region.has(&place) && semidefinite(there) == Some(false)
    }

    fn by_mean_value(&self, piece: &Piece, middle: &Matrix, slopes: &[(Option<usize>, Matrix)]) -> Judgement {
        let Some(basis) = Basis::new(middle) else { return Judgement::Halve(None) };
        let order = middle.len();
        let widths: Vec<Interval> = slopes.iter().map(|(side, _)| piece.half_width(*side)).collect();
        let radius = self.region.reaches_out(piece);
        let mut enclosed: Matrix = Vec::with_capacity(order);
        // How much each axis contributes; a hint.
        let mut scores = vec![0.0; slopes.len()];
        for i in 0..order {
            let mut row = Vec::with_capacity(i + 1);
            let rates =
                |j: usize| -> Vec<Interval> { slopes.iter().map(|(_, matrix)| basis.form(matrix, i, j)).collect() };
            let moves = |rates: &[Interval]| -> Vec<Interval> {
                rates.iter().zip(&widths).map(|(rate, width)| rate.abs() * width).collect()
            };
            for (j, before) in enclosed.iter().enumerate() {
                let (value, parts) = (basis.form(middle, i, j), moves(&rates(j)));
                let size = parts.iter().fold(Interval::int(0, value.precision()), |sum, part| sum + part);
                // It counts with its square over the pivot before it.
                let weight = size.hi().to_f64() / enclosed_end(&before[j]);
                scores.iter_mut().zip(&parts).for_each(|(score, part)| *score += part.hi().to_f64() * weight);
                row.push(value + around(&size));
            }
            let own = rates(i);
            row.push(basis.form(middle, i, i) - self.fall(piece, slopes, &own, &moves(&own), radius));
            for ((score, rate), width) in scores.iter_mut().zip(&own).zip(&widths) {
                *score += 2.0 * rate.half_width().hi().to_f64() * width.hi().to_f64();
            }
            enclosed.push(row);
        }
        if semidefinite(enclosed) == Some(true) {
            return Judgement::Proved;
        }
        let best = scores.iter().zip(slopes).filter(|(score, _)| score.is_finite() && **score > 0.0);
        let known = scores.iter().all(|score| score.is_finite());
        Judgement::Halve(best.max_by(|a, b| a.0.total_cmp(b.0)).map(|(_, (side, _))| *side).filter(|_| known))
    }

    /// How far an entry of the diagonal may lie on the box below its value at the middle; `radius`: of the ball that the box
    /// reaches out of.
    fn fall(
        &self,
        piece: &Piece,
        slopes: &[(Option<usize>, Matrix)],
        rates: &[Interval],
        parts: &[Interval],
        radius: Option<&Interval>,
    ) -> Interval {
        let zero = || Interval::int(0, self.machine.precision);
        let is_state = |side: &Option<usize>| side.is_some_and(|side| side < self.region.states);
        let of = |wanted: bool| {
            let all = slopes.iter().zip(parts).filter(move |((side, _), _)| is_state(side) == wanted);
            all.fold(zero(), |sum, (_, part)| sum + part)
        };
        let (others, by_box) = (of(false), of(true));
        let Some(radius) = radius else { return others + by_box };
        // g v >= -|g| radius in the ball, for a number g in the enclosure; the rest of it moves over the box.
        let (mut square, mut at_middle, mut rest) = (zero(), zero(), zero());
        for ((side, _), rate) in slopes.iter().zip(rates) {
            let Some(side) = side.filter(|side| *side < self.region.states) else { continue };
            let number = rate.middle();
            square = square + number.sqr();
            at_middle = at_middle + &number * piece.sides[side].middle();
            rest = rest + (rate - number).abs() * piece.half_width(Some(side));
        }
        let by_ball = square.sqrt() * radius + at_middle + rest;
        if by_ball.is_defined() { others + by_box.ceiling().min(&by_ball.ceiling()) } else { others + by_box }
    }
}

/// The size of a pivot, not 0; a hint.
fn enclosed_end(pivot: &Interval) -> f64 {
    pivot.lo().to_f64().abs().max(1e-100)
}

/// An entry of S.
enum Factor {
    Zero,
    One,
    Number(Interval),
}

impl Factor {
    fn times(&self, value: &Interval) -> Option<Interval> {
        match self {
            Factor::Zero => None,
            Factor::One => Some(value.clone()),
            Factor::Number(number) => Some(number * value),
        }
    }
}

/// The columns of S, in the order of the pivots.
struct Basis(Vec<Vec<Factor>>);

impl Basis {
    /// By elimination in the middles of the entries, the largest entry of the diagonal first.
    fn new(matrix: &Matrix) -> Option<Basis> {
        let order = matrix.len();
        let p = matrix.first()?.first()?.precision();
        if !matrix.iter().flatten().all(Interval::is_bounded) {
            return None;
        }
        let middle = |i: usize, j: usize| matrix[i.max(j)][i.min(j)].to_f64();
        let mut a: Vec<Vec<f64>> = (0..order).map(|i| (0..order).map(|j| middle(i, j)).collect()).collect();
        let unit = |i: usize| (0..order).map(|j| f64::from(u8::from(i == j))).collect::<Vec<_>>();
        let mut columns: Vec<Vec<f64>> = (0..order).map(unit).collect();
        let mut left: Vec<usize> = (0..order).collect();
        let mut sorted = Vec::new();
        while let Some(best) = (0..left.len()).max_by(|i, j| a[left[*i]][left[*i]].total_cmp(&a[left[*j]][left[*j]])) {
            let pivot = left.remove(best);
            for other in &left {
                if a[pivot][pivot] == 0.0 || a[*other][pivot] == 0.0 {
                    continue;
                }
                let factor = a[*other][pivot] / a[pivot][pivot];
                let less = |from: &mut Vec<f64>, row: &[f64]| {
                    from.iter_mut().zip(row).for_each(|(entry, of)| *entry -= factor * of);
                };
                let (column, row) = (columns[pivot].clone(), a[pivot].clone());
                less(&mut columns[*other], &column);
                less(&mut a[*other], &row);
            }
            sorted.push(pivot);
        }
        // S is triangular in the order of the pivots with 1 on its diagonal, whatever was rounded: so it is invertible.
        if !columns.iter().flatten().all(|entry| entry.is_finite()) {
            return None;
        }
        let entry = |x: &f64| match () {
            () if *x == 0.0 => Factor::Zero,
            () if *x == 1.0 => Factor::One,
            () => Factor::Number(Interval::point(&Float::with_val(p, x))),
        };
        Some(Basis(sorted.iter().map(|pivot| columns[*pivot].iter().map(entry).collect()).collect()))
    }

    /// The entry (i, j) of S'AS for a symmetric A, of which the lower triangle is read. Entries of A that are multiplied with 0 are
    /// left out, so all of them have to be defined.
    fn form(&self, matrix: &Matrix, i: usize, j: usize) -> Interval {
        let entry = |k: usize, l: usize| if k >= l { &matrix[k][l] } else { &matrix[l][k] };
        let total = |parts: &mut dyn Iterator<Item = Interval>| {
            let first = parts.next();
            first.map(|first| parts.fold(first, |sum, part| sum + part))
        };
        let row = |k: usize| total(&mut self.0[j].iter().enumerate().filter_map(|(l, right)| right.times(entry(k, l))));
        let mut rows = self.0[i].iter().enumerate().filter_map(|(k, left)| match left {
            Factor::Zero => None,
            _ => left.times(&row(k)?),
        });
        // A column of S is not 0, so there is a part.
        total(&mut rows).unwrap_or_else(|| Interval::undefined(entry(0, 0).precision()))
    }
}
