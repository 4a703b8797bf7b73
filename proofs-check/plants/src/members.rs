//! Functions of t along the approximate orbits of a family, for all of its members (docs/mathematics.md, section 13.2).
//!
//! On a box with the middle c, `g(t;p) = g(t;c) + sum_i (p_i - c_i) D_i` with D_i in the enclosure of the derivative of g in p_i over the
//! box, along the orbits `xb(t;p)`, which are affine in p. So what g is at c is known by its polynomial, and where the derivatives are
//! small, as those of a defect are, the box adds little; where they are not, it is halved.

use super::formula::{Axis, Formulas, Id};
use super::machine::{Curves, Machine, Values};
use super::path::{Path, Polynomial};
use super::region::Piece;
use proofs_core::interval::Interval;

/// Nodes, and their derivatives in each parameter.
#[derive(Clone)]
pub struct Roots {
    nodes: Vec<Id>,
    slopes: Vec<Vec<Id>>,
}

impl Roots {
    /// With so many parameters.
    pub fn new(formulas: &mut Formulas, nodes: &[Id], parameters: usize) -> Roots {
        let slopes = (0..parameters)
            .map(|i| nodes.iter().map(|id| formulas.derivative(*id, Axis::Parameter(i))).collect())
            .collect();
        Roots { nodes: nodes.to_vec(), slopes }
    }
}

/// What is needed to expand them.
pub struct Members<'m, 'f> {
    at_middle: Path<'m, 'f>,
    in_parameters: Vec<Path<'m, 'f>>,
}

/// The nodes on a box of t and the parameters.
pub struct Expanded {
    /// With the parameters in the middle.
    pub at_middle: Vec<Polynomial>,
    /// For each parameter a bound of the distance from the middle, and the derivatives on the whole box.
    pub slopes: Vec<(Interval, Vec<Polynomial>)>,
}

impl<'m, 'f> Members<'m, 'f> {
    /// For these nodes.
    pub fn new(machine: &'m Machine<'f>, curves: &Curves, om: &Interval, roots: &Roots) -> Members<'m, 'f> {
        let path = |nodes: &Vec<Id>| Path::new(machine, curves, om, nodes);
        Members { at_middle: path(&roots.nodes), in_parameters: roots.slopes.iter().map(path).collect() }
    }

    /// On a box without v and with e = 0.
    pub fn expand(&self, piece: &Piece, values: &Values) -> Expanded {
        let (middle, on_box) = (piece.middles(), piece.intervals());
        let slope = |(i, path): (usize, &Path<'m, 'f>)| {
            (piece.half_width(Some(1 + i)), path.expand(&piece.cell, &on_box[1..], values))
        };
        Expanded {
            at_middle: self.at_middle.expand(&piece.cell, &middle[1..], values),
            slopes: self.in_parameters.iter().enumerate().map(slope).collect(),
        }
    }
}

/// The sum.
pub fn total<'i>(parts: impl Iterator<Item = &'i Interval>, precision: u32) -> Interval {
    parts.fold(Interval::int(0, precision), |sum, part| sum + part)
}

impl Expanded {
    /// How much each component moves with the parameters, by a bound of its derivatives.
    pub fn moves(&self, bound: impl Fn(&Polynomial) -> Interval) -> Vec<Vec<Interval>> {
        let of = |(width, slopes): &(Interval, Vec<Polynomial>)| slopes.iter().map(|s| width * bound(s)).collect();
        self.slopes.iter().map(of).collect()
    }
}
