//! Functions of t along the approximate orbits of a family, for all of its members (docs/mathematics.md, section 13.2).
//!
//! On a box with the middle c, `g(t;p) = g(t;c) + sum_i (p_i - c_i) D_i` with D_i in the enclosure of the derivative of g in p_i over the
//! box, along the orbits `xb(t;p)`, which are affine in p. So what g is at c is known by its polynomial, and where the derivatives are
//! small, as those of a defect are, the box adds little; where they are not, it is halved.

use super::formula::{Axis, Formulas, Id};
use super::machine::Values;
use super::path::{Path, Polynomial};
use super::region::Piece;
use proofs_core::interval::Interval;

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
