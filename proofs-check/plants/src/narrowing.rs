//! Along which axis a box is halved where a node is not known well enough. A hint, of which nothing is believed.

use super::formula::Id;
use super::machine::{At, Machine, Program, Values};
use super::region::{Piece, axes};

/// A node with what has to be computed for it.
pub struct Narrowing {
    id: Id,
    program: Program,
}

impl Narrowing {
    /// For a node.
    pub fn new(machine: &Machine<'_>, id: Id) -> Narrowing {
        Narrowing { id, program: machine.program(&[id]) }
    }

    /// The axis, t (`None`) or a side, whose middle alone in the place of its width makes the node's enclosure narrowest; the
    /// widest side where none has a say. Other values than before stand in `values` after it.
    pub fn axis(
        &self,
        machine: &Machine<'_>,
        piece: &Piece,
        whole: &Piece,
        states: usize,
        values: &mut Values,
    ) -> Option<Option<usize>> {
        let depends = machine.formulas.depends(self.id);
        let mut width = |side: Option<usize>| {
            let at = if side.is_none() { At::Middle } else { At::Box };
            let mut sides = piece.sides.clone();
            if let Some(side) = side {
                sides[side] = sides[side].middle();
            }
            let (v, rest) = sides.split_at(states);
            machine.run(&self.program, at, &piece.cell, v, rest, values);
            let value = machine.get(self.id, at, &piece.cell, values);
            let width = value.hi().to_f64() - value.lo().to_f64();
            if width.is_nan() { f64::INFINITY } else { width }
        };
        let open = axes(depends, states).filter(|side| *piece.half_width(*side).hi() > 0);
        let all: Vec<(f64, Option<usize>)> = open.map(|side| (width(side), side)).collect();
        let narrowest = all.iter().min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(width, _)| width.is_finite());
        narrowest.map(|(_, side)| *side).or_else(|| piece.widest(whole, depends, states))
    }
}
