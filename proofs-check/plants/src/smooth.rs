//! Smoothness of the formulas where they are used (docs/mathematics.md, section 11.1, P0): what each operation asks of its
//! operands, decided by enclosures on boxes that cover the region.

use super::formula::{Demand, Formulas, Id};
use super::machine::{At, Cell, Machine, Values};
use super::region::{Narrowing, Region};
use proofs_core::effort;
use proofs_core::verdict::{Outcome, demand};
use std::rc::Rc;

/// The name of this rule.
pub const RULE: &str = "smoothness";
/// The most boxes.
const MAX_PIECES: usize = 40_000;

/// Proves every demand on a region; how many boxes that took.
pub fn prove(
    formulas: &Formulas,
    demands: &[(Id, Demand)],
    pointer: &str,
    machine: &Machine<'_>,
    root: &Rc<Cell>,
    region: &Region,
    values: &mut Values,
) -> Outcome<usize> {
    let states = region.states;
    let depends = |id: Id| formulas.depends(id);
    let (varying, constant): (Vec<_>, Vec<_>) = demands.iter().copied().partition(|(id, _)| depends(*id) != 0);
    let undecided = |what: String| demand(None, RULE, pointer, what).map(|()| 0);
    for (id, what) in constant {
        // An operand that is the same everywhere: 1/(2 - 2), or a function of numbers.
        if !what.holds(&machine.number(id, values)) {
            return undecided(format!("a constant is {}", words(what)));
        }
    }
    if varying.is_empty() {
        return Ok(0);
    }
    let ids: Vec<Id> = varying.iter().map(|(id, _)| *id).collect();
    let program = machine.program(&ids);
    let narrowings: Vec<Narrowing> = ids.iter().map(|id| Narrowing::new(machine, *id)).collect();
    let all = ids.iter().fold(0, |all, id| all | depends(*id));
    let mut queue = region.pieces(machine, root, all);
    let Some(whole) = queue.last().cloned() else { return Ok(0) };
    let mut count = 0;
    while let Some(piece) = queue.pop() {
        if region.misses(&piece) {
            continue;
        }
        count += 1;
        let (v, rest) = piece.sides.split_at(states);
        machine.run(&program, At::Box, &piece.cell, v, rest, values);
        let open = varying.iter().position(|(id, what)| !what.holds(&machine.get(*id, At::Box, &piece.cell, values)));
        let Some(open) = open else { continue };
        let (_, what) = varying[open];
        let side = narrowings[open].axis(machine, &piece, &whole, states, values);
        match side.filter(|_| count < MAX_PIECES && !effort::exhausted()) {
            Some(side) => queue.extend(piece.halves(side)),
            None => {
                let t = piece.cell.middle.to_f64();
                return undecided(format!("the operand of an operation is {} near t = {t:.6}", words(what)));
            }
        }
    }
    Ok(count)
}

fn words(what: Demand) -> &'static str {
    match what {
        Demand::Finite => "a finite number",
        Demand::Nonzero => "not 0",
        Demand::Positive => "positive",
    }
}
