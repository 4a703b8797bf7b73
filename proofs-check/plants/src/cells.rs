//! Rule: cells of a family, boxes of its parameters that have an orbit and a forcing of their own (docs/mathematics.md, section 13.2).
//!
//! Guarantee: every point of the box of the parameters lies in a cell. L, P and all bounds are common to the cells, so what is proved of
//! the formulas is proved in each; `C_k`, `r_0` and `r_1` are the largest of all. The clock is not cut.

use super::parts::{Forcing, Orbit, forcing, orbit};
use super::time::Wave;
use proofs_core::json::{Field, Fields};
use proofs_core::range::Span;
use proofs_core::spec::{self, Size};
use proofs_core::verdict::{Outcome, bad, demand};
use rug::Rational;

/// The name of the rule.
pub const RULE: &str = "cells";
/// The most cells, and the most boxes that are looked at to see that they cover.
const MAX_CELLS: usize = 64;
const MAX_BOXES: usize = 100_000;

/// The parameters and the clock of a cell, its orbit, and its forcing.
pub struct Cell {
    pub family: Vec<Span>,
    pub orbit: Orbit,
    pub forcing: Forcing,
}

type Box = Vec<[Rational; 2]>;

/// Takes `orbit` and `forcing` out of a witness, of the whole family, or `cells` in their place, which cover it; the first numbers of the
/// family are the parameters.
pub fn read(witness: &mut Fields<'_>, order: usize, family: Vec<Span>, parameters: usize) -> Outcome<Vec<Cell>> {
    let Some(list) = witness.optional("cells") else {
        return Ok(vec![cell(witness, order, family)?]);
    };
    let elements = list.elements()?;
    if elements.is_empty() || elements.len() > MAX_CELLS {
        return bad(&list.pointer, format!("expected 1 to {MAX_CELLS} cells"));
    }
    let mut boxes: Vec<Box> = Vec::new();
    let mut all = Vec::new();
    for element in &elements {
        let mut fields = element.fields()?;
        let sides = sides(&fields.required("parameters")?, parameters)?;
        let own = sides
            .iter()
            .map(|[low, high]| Span { nominal: Rational::from(low + high) / 2u32, ends: [low.clone(), high.clone()] });
        let own = own.chain(family[parameters..].iter().cloned()).collect();
        all.push(cell(&mut fields, order, own)?);
        fields.finish()?;
        boxes.push(sides);
    }
    let whole = family[..parameters].iter().map(|span| span.ends.clone()).collect();
    demand(covered(whole, &boxes), RULE, &list.pointer, "every point of the parameters lies in a cell")?;
    Ok(all)
}

fn cell(fields: &mut Fields<'_>, order: usize, family: Vec<Span>) -> Outcome<Cell> {
    let orbit = orbit(&fields.required("orbit")?, order, family.len())?;
    let forcing = forcing(&fields.required("forcing")?, family.len())?;
    Ok(Cell { family, orbit, forcing })
}

/// `low` and `high` for each parameter.
fn sides(list: &Field<'_>, parameters: usize) -> Outcome<Box> {
    let side = |field: &Field<'_>| {
        let [low, high] = field.object(|fields| fields.numbers(["low", "high"]))?;
        demand(Some(low <= high), RULE, &field.pointer, "low <= high").map(|()| [low, high])
    };
    let sides = list.list(side)?;
    if sides.len() == parameters {
        return Ok(sides);
    }
    bad(&list.pointer, format!("expected {parameters} objects, one for each parameter of which an interval is given"))
}

/// Whether boxes cover one: a part of it that meets a cell inside is cut at a face of that cell, until it lies in it. `None` where that
/// takes too many parts.
fn covered(whole: Box, cells: &[Box]) -> Option<bool> {
    let mut queue = vec![whole];
    for _ in 0..MAX_BOXES {
        let Some(part) = queue.pop() else { return Some(true) };
        let meets = |cell: &&Box| cell.iter().zip(&part).all(|([low, high], [from, to])| low < to && from < high);
        let Some(cell) = cells.iter().find(meets) else { return Some(false) };
        let faces = cell.iter().zip(&part).enumerate();
        let mut inside = faces.flat_map(|(i, (ends, [from, to]))| {
            ends.iter().filter(move |end| from < *end && *end < to).map(move |end| (i, end))
        });
        let Some((side, face)) = inside.next() else { continue };
        let [mut below, mut above] = [part.clone(), part.clone()];
        below[side][1].clone_from(face);
        above[side][0].clone_from(face);
        queue.extend([below, above]);
    }
    None
}

/// What `q_0` is of all cells: the largest `C_0 = |m_0|`, `C_k = sqrt(a_k^2 + b_k^2)/2`, `r_0` and `r_1`.
pub fn largest(cells: &[Cell]) -> spec::Forcing {
    let mut sizes: Vec<Rational> = Vec::new();
    for (k, size) in cells.iter().flat_map(|cell| amplitudes(&cell.forcing.waves, &cell.family).into_iter().enumerate())
    {
        match sizes.get_mut(k) {
            Some(largest) if size > *largest => *largest = size,
            Some(_) => {}
            None => sizes.push(size),
        }
    }
    let most =
        |of: fn(&Forcing) -> &Rational| cells.iter().map(|cell| of(&cell.forcing)).max().cloned().unwrap_or_default();
    let harmonics = sizes.into_iter().enumerate();
    spec::Forcing {
        harmonics: harmonics.map(|(k, size)| if k == 0 { Size::Number(size) } else { Size::Root(size) }).collect(),
        rest_rms: Size::Number(most(|forcing| &forcing.rest)),
        rest_t_rms: Some(Size::Number(most(|forcing| &forcing.rest_t))),
    }
}

/// C_0 and the squares of the other C_k, the largest over the family of a cell: the coefficients are affine in its numbers, so the
/// magnitudes are convex, and largest at a corner.
fn amplitudes(waves: &[Wave], family: &[Span]) -> Vec<Rational> {
    // A coefficient of the wave of a corner.
    let at = |corner: usize, coefficient: &dyn Fn(&Wave) -> Option<Rational>| {
        let mut parts = waves.iter().map(|wave| coefficient(wave).unwrap_or_default());
        let nominal = parts.next().unwrap_or_default();
        let moved = parts.zip(family).enumerate().map(|(i, (part, of))| {
            let end = &of.ends[corner >> i & 1];
            part * Rational::from(end - &of.nominal)
        });
        moved.fold(nominal, |sum, part| sum + part)
    };
    let largest = |size: &dyn Fn(usize) -> Rational| (0..1 << family.len()).map(size).max().unwrap_or_default();
    let square = |value: Rational| Rational::from(value.square_ref());
    let mean = largest(&|corner| at(corner, &|wave| Some(wave.mean.clone())).abs());
    let harmonic = |k: usize| {
        let of = |corner: usize, i: usize| at(corner, &|wave| wave.harmonics.get(k).map(|pair| pair[i].clone()));
        largest(&|corner| square(of(corner, 0)) + square(of(corner, 1))) / 4u32
    };
    let count = waves.iter().map(|wave| wave.harmonics.len()).max().unwrap_or(0);
    std::iter::once(mean).chain((0..count).map(harmonic)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sides(ends: &[[i64; 2]]) -> Box {
        ends.iter().map(|pair| pair.map(Rational::from)).collect()
    }

    /// Boxes of whole numbers that make up one, by cuts at drawn places.
    fn parts(next: &mut impl FnMut(i64) -> i64, dimension: usize) -> Vec<Vec<[i64; 2]>> {
        let mut all = vec![vec![[0, 64]; dimension]];
        for _ in 0..40 {
            let part = all.swap_remove(next(all.len() as i64) as usize);
            let side = next(dimension as i64) as usize;
            let [low, high] = part[side];
            if high - low < 2 {
                all.push(part);
                continue;
            }
            let face = low + 1 + next(high - low - 1);
            let [mut below, mut above] = [part.clone(), part];
            (below[side][1], above[side][0]) = (face, face);
            all.extend([below, above]);
        }
        all
    }

    #[test]
    fn boxes_that_cover_and_those_with_a_gap() {
        let mut state = 7_u64;
        let mut next = |below: i64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % below as u64) as i64
        };
        for case in 0..60_usize {
            let dimension = 1 + case % 4;
            let whole = || sides(&vec![[0, 64]; dimension]);
            let all = parts(&mut next, dimension);
            let boxes: Vec<Box> = all.iter().map(|part| sides(part)).collect();
            assert_eq!(covered(whole(), &boxes), Some(true), "{all:?}");
            let which = next(boxes.len() as i64) as usize;
            let mut without = boxes.clone();
            without.remove(which);
            assert_eq!(covered(whole(), &without), Some(false), "{all:?} without {which}");
            // One side of one of them that does not reach as far.
            let mut narrower = boxes;
            let end = &mut narrower[which][next(dimension as i64) as usize];
            end[0] += Rational::from((1, 1_000_000));
            assert_eq!(covered(whole(), &narrower), Some(false), "{all:?} narrower {which}");
        }
    }

    #[test]
    fn without_parameters_and_with_too_many_parts() {
        assert_eq!(covered(Vec::new(), &[Vec::new()]), Some(true));
        assert_eq!(covered(Vec::new(), &[]), Some(false));
        // Slabs that cut each other in four directions, before the one that covers.
        let whole = [[0, 64]; 4];
        let slab = |i: usize| {
            let mut slab = whole;
            slab[i % 4] = [4 * (i / 4) as i64 + 1, 4 * (i / 4) as i64 + 2];
            sides(&slab)
        };
        let slabs: Vec<Box> = (0..63).map(slab).chain([sides(&whole)]).collect();
        assert_eq!(covered(sides(&whole), &slabs), None);
        assert_eq!(covered(sides(&whole), &slabs[63..]), Some(true));
    }
}
