//! Along which axis a box is halved where a node is not known well enough. A hint, of which nothing is believed.

use super::formula::{Axis, Id};
use super::machine::{At, Machine, Program, Values};
use super::region::{Piece, axis};
use super::time::point;
use proofs_core::interval::Interval;

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
        values: &mut Values,
    ) -> Option<Option<usize>> {
        let (states, depends) = (piece.sides.len() - 1, machine.formulas.depends(self.id));
        let mut width = |side: Option<usize>| {
            let at = if side.is_none() { At::Middle } else { At::Box };
            let mut sides: Vec<Interval> = (0..=states).map(|i| piece.side(i)).collect();
            if let Some(side) = side {
                sides[side] = point(&piece.middle(side));
            }
            machine.run(&self.program, at, &piece.cell, &sides[..states], &sides[states], values);
            let value = machine.get(self.id, at, &piece.cell, values);
            let width = value.hi().to_f64() - value.lo().to_f64();
            if width.is_nan() { f64::INFINITY } else { width }
        };
        let time = (depends & Axis::Time.bit() != 0).then_some(None);
        let sides = (0..=states).filter(|side| depends & axis(*side, states).bit() != 0).map(Some);
        let open = time.into_iter().chain(sides).filter(|side| *piece.half_width(*side).hi() > 0);
        let all: Vec<(f64, Option<usize>)> = open.map(|side| (width(side), side)).collect();
        let narrowest = all.iter().min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(width, _)| width.is_finite());
        narrowest.map(|(_, side)| *side).or_else(|| piece.widest(whole, depends))
    }
}
