//! Functions of t along the approximate orbit, as polynomials with a remainder on cells that cover a period.
//!
//! Of a family, for all of its members (docs/mathematics.md, section 13.2): On a box with the middle c, `g(t;p) = g(t;c) + sum_i (p_i - c_i) D_i` with D_i in the enclosure of the derivative of g in p_i over the
//! box, along the orbits `xb(t;p)`, which are affine in p. So what g is at c is known by its polynomial, and where the derivatives are
//! small, as those of a defect are, the box adds little; where they are not, it is halved.

use super::formula::{Axis, Formulas, Id, Leaf};
use super::machine::{Cell, Curves, Machine, Values};
use super::region::Piece;
use super::taylor::{Series, expand};
use super::time::{Table, waves};
use proofs_core::effort;
use proofs_core::interval::Interval;
use std::collections::VecDeque;

/// The order of the polynomials.
pub const ORDER: usize = 12;
/// Terms of Taylor's formula for what xb and qb are on a cell.
const TERMS: usize = 3;
/// How many cells there are at first, and the most.
const FIRST_CELLS_LOG: u32 = 5;
const MAX_CELLS: usize = 8_192;

/// A function on a cell: coefficients at the middle, and the coefficient of the remainder `d^(ORDER+1)`.
pub struct Polynomial {
    pub coefficients: Series,
    pub remainder: Interval,
}

/// What is needed to expand formulas at v = 0, e = 0.
pub struct Path<'m, 'f> {
    pub machine: &'m Machine<'f>,
    orbit: Vec<Table>,
    om: Interval,
    count: usize,
    /// Nodes, after all that they are made from.
    groups: Vec<(Vec<Id>, Vec<Id>)>,
}

impl<'m, 'f> Path<'m, 'f> {
    /// For groups of nodes.
    pub fn new(machine: &'m Machine<'f>, curves: &Curves, om: &Interval, groups: &[Vec<Id>]) -> Path<'m, 'f> {
        // One order more for the velocity, one for the remainder.
        let last = ORDER + 3 + TERMS;
        Path {
            orbit: curves.orbit.iter().map(|wave| Table::new(wave, om, last)).collect(),
            count: curves.orbit.iter().map(|wave| wave.harmonics.len()).max().unwrap_or(0),
            groups: groups.iter().map(|roots| (machine.formulas.below(roots), roots.clone())).collect(),
            om: om.clone(),
            machine,
        }
    }

    /// What of t is known on a cell.
    pub fn on_cell<'c>(&'c self, cell: &'c Cell) -> OnCell<'c> {
        let waves = waves(&self.om, &cell.middle, self.count);
        let of = |table: &Table| {
            (0..=ORDER + 2 + TERMS).map(|order| table.at(order, &waves, self.machine.precision)).collect()
        };
        OnCell {
            orbit: &self.orbit,
            cell,
            half: cell.all.half_width(),
            derivatives: self.orbit.iter().map(of).collect(),
        }
    }

    /// The nodes of each group on a cell, each with its own parameters.
    pub fn expand(&self, cell: &Cell, parameters: &[&[Interval]], values: &Values) -> Vec<Vec<Polynomial>> {
        let (p, on_cell, formulas) = (self.machine.precision, self.on_cell(cell), self.machine.formulas);
        let number = |id: Id| self.machine.number(id, values);
        let group = |((order, roots), parameters): (&(Vec<Id>, Vec<Id>), &&[Interval])| {
            let series = |on_all: bool, length: usize| {
                expand(formulas, order, number, |leaf| on_cell.series(leaf, parameters, on_all, length), length)
            };
            let (thin, thick) = (series(false, ORDER + 1), series(true, ORDER + 2));
            let polynomial = |root: &Id| Polynomial {
                coefficients: thin[root.0].clone(),
                remainder: coefficient(&thick[root.0], ORDER + 1, p),
            };
            roots.iter().map(polynomial).collect()
        };
        self.groups.iter().zip(parameters).map(group).collect()
    }
}

/// The functions of t alone on a cell.
pub struct OnCell<'c> {
    orbit: &'c [Table],
    cell: &'c Cell,
    half: Interval,
    /// Of each wave at the middle.
    derivatives: Vec<Vec<Interval>>,
}

impl OnCell<'_> {
    /// The series of a leaf in t, with these parameters, at the middle of the cell, or at every point of it. Of v and e it is 0.
    pub fn series(&self, leaf: Leaf, parameters: &[Interval], on_all: bool, length: usize) -> Series {
        let p = self.half.precision();
        let none = || vec![Interval::undefined(p)];
        match leaf {
            Leaf::Time if on_all => vec![self.cell.all.clone(), Interval::int(1, p)],
            Leaf::Time => vec![self.cell.middle.clone(), Interval::int(1, p)],
            Leaf::State(_) | Leaf::Output => vec![Interval::int(0, p)],
            Leaf::Parameter(i) => parameters.get(i).map_or_else(none, |value| vec![value.clone()]),
            Leaf::Orbit { state, order } => {
                let (Some(table), Some(all)) = (self.orbit.get(state), self.derivatives.get(state)) else {
                    return none();
                };
                let mut factorial = Interval::int(1, p);
                let coefficient = |k: usize| {
                    factorial = if k > 1 { &factorial * k as i64 } else { factorial.clone() };
                    let value = match all.get(order + k..order + k + TERMS) {
                        Some(values) if on_all => table.around(order + k, values, &self.half),
                        Some(values) => values[0].clone(),
                        None => Interval::undefined(p),
                    };
                    value / &factorial
                };
                (0..length).map(coefficient).collect()
            }
            Leaf::Lyapunov { .. } | Leaf::Drift(_) => none(),
        }
    }
}

/// A coefficient of a series, 0 where a short one does not list it.
pub fn coefficient(series: &Series, k: usize, precision: u32) -> Interval {
    series.get(k).cloned().unwrap_or_else(|| undefined_or_zero(series, precision))
}

/// The coefficient that a short series does not list.
fn undefined_or_zero(series: &Series, precision: u32) -> Interval {
    let known = series.iter().all(Interval::is_defined) && !series.is_empty();
    if known { Interval::int(0, precision) } else { Interval::undefined(precision) }
}

/// What is known of a box of t and the parameters.
pub enum Judged {
    Proved,
    Refuted,
    /// How much t (the first) and each parameter add to what is bounded: a hint.
    Halve(Vec<f64>),
    /// What is known at one point is not known well enough: smaller boxes do not help.
    Open,
}

/// Decides something on boxes that cover `whole`, a period and all parameters; else where that fails, and whether it is refuted there.
///
/// # Errors
/// The time, and whether it is refuted.
pub fn everywhere(whole: Piece, mut judge: impl FnMut(&Piece) -> Judged) -> Result<usize, (f64, bool)> {
    let mut queue = VecDeque::from([whole]);
    for _ in 0..FIRST_CELLS_LOG {
        queue = queue.iter().flat_map(|piece| piece.halves(None)).collect();
    }
    // The largest first: along the edge of where it fails, halves of halves may all have their middles on one side of it.
    let mut count = 0;
    while let Some(piece) = queue.pop_front() {
        count += 1;
        let at = piece.cell.middle.to_f64();
        match judge(&piece) {
            Judged::Proved => {}
            Judged::Refuted => return Err((at, true)),
            Judged::Halve(shares) if count < MAX_CELLS && !effort::exhausted() => {
                // Side 0 is that of e, which t has here. What is not known counts most, t before the parameters.
                let known = |share: f64| if share.is_nan() { f64::INFINITY } else { share };
                let largest = shares.into_iter().map(known).enumerate().rev().max_by(|a, b| a.1.total_cmp(&b.1));
                queue.extend(piece.halves(largest.map(|(side, _)| side).filter(|side| *side > 0)));
            }
            Judged::Halve(_) | Judged::Open => return Err((at, false)),
        }
    }
    Ok(count)
}

/// `|a_0| + |a_1| h + ... + |remainder| h^(ORDER+1)`: a bound on a cell of half width h.
pub fn bound(polynomial: &Polynomial, half: &Interval) -> Interval {
    size(&polynomial.coefficients, half) + polynomial.remainder.abs() * half.powi(ORDER as i32 + 1)
}

fn size(coefficients: &[Interval], half: &Interval) -> Interval {
    let zero = Interval::int(0, half.precision());
    coefficients.iter().rev().fold(zero, |sum, a| a.abs() + half * sum)
}

/// A bound of the size of the derivative of a polynomial with its remainder, on a cell of this half width.
pub fn bound_of_derivative(polynomial: &Polynomial, half: &Interval) -> Interval {
    let slopes: Series = polynomial.coefficients.iter().enumerate().skip(1).map(|(k, a)| a * k as i64).collect();
    size(&slopes, half) + polynomial.remainder.abs() * half.powi(ORDER as i32) * (ORDER as i64 + 1)
}

/// A bound of the Euclidean norm of several: by the polynomial of its square, without the remainders.
pub fn bound_of_norm<'p>(polynomials: impl IntoIterator<Item = &'p Polynomial>, half: &Interval) -> Interval {
    let p = half.precision();
    let zero = || Interval::int(0, p);
    let mut square = vec![zero(); 2 * ORDER + 1];
    let mut remainder = zero();
    for polynomial in polynomials {
        for (i, a) in polynomial.coefficients.iter().enumerate() {
            for (j, b) in polynomial.coefficients.iter().enumerate() {
                square[i + j] = &square[i + j] + a * b;
            }
        }
        remainder = remainder + (polynomial.remainder.abs() * half.powi(ORDER as i32 + 1)).sqr();
    }
    // The first coefficient with its sign.
    let later = half * size(&square[1..], half);
    (&square[0] + later).max(&zero()).sqrt() + remainder.sqrt()
}

/// Nodes, and then their derivatives in each of so many parameters.
pub fn roots(formulas: &mut Formulas, nodes: &[Id], parameters: usize) -> Vec<Vec<Id>> {
    let mut along = |i: usize| nodes.iter().map(|id| formulas.derivative(*id, Axis::Parameter(i))).collect();
    let slopes: Vec<Vec<Id>> = (0..parameters).map(&mut along).collect();
    [nodes.to_vec()].into_iter().chain(slopes).collect()
}

/// Such nodes on a box of t and the parameters, without v and with e = 0.
pub struct Expanded {
    /// With the parameters in the middle.
    pub at_middle: Vec<Polynomial>,
    /// For each parameter a bound of the distance from the middle, and the derivatives on the whole box.
    slopes: Vec<(Interval, Vec<Polynomial>)>,
}

impl Expanded {
    /// From a path for these nodes.
    pub fn new(path: &Path<'_, '_>, piece: &Piece, values: &Values) -> Expanded {
        // The first side is that of e.
        let (middle, on_box) = (piece.middles(), &piece.sides);
        let mut parameters = vec![&on_box[1..]; on_box.len()];
        parameters[0] = &middle[1..];
        let mut groups = path.expand(&piece.cell, &parameters, values).into_iter();
        let at_middle = groups.next().unwrap_or_default();
        Expanded {
            at_middle,
            slopes: groups.zip(1..).map(|(slopes, side)| (piece.half_width(Some(side)), slopes)).collect(),
        }
    }

    /// For each parameter how much each component moves with it, by a bound of its derivatives.
    pub fn moves(&self, bound: impl Fn(&Polynomial) -> Interval) -> Vec<Vec<Interval>> {
        let of = |(width, slopes): &(Interval, Vec<Polynomial>)| slopes.iter().map(|s| width * bound(s)).collect();
        self.slopes.iter().map(of).collect()
    }
}

/// The sum.
pub fn total<'i>(parts: impl Iterator<Item = &'i Interval>, precision: u32) -> Interval {
    parts.fold(Interval::int(0, precision), |sum, part| sum + part)
}
