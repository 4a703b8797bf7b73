//! The largest sizes of the members of a linear family, by subdivision of the box of parameters and gains.

use super::PRECISION;
use super::plant::LinearPlant;
use super::steady::{Loop, Oscillators, Sizes};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;

/// The most boxes that are looked at.
const MAX_BOXES: usize = 1024;

/// By what share a bound may be above what some member has: of e and u, and of what only the transient rests on.
const ROOMS: [f64; 4] = [0.005, 0.005, 0.03, 0.03];

/// Bounds along the periodic solution of every member of the family at every gain of the actuator, for this number of oscillators.
///
/// Guarantee: for every such member whose loop has one T-periodic solution at most that is so bounded. `None` where no bound is found within
/// the effort.
#[must_use]
pub fn sizes(plant: &LinearPlant, own: &Loop, oscillators: Oscillators) -> Option<Sizes<Enclosure>> {
    let [low, high] = [own.gain[0].lower_rational()?, own.gain[1].upper_rational()?];
    let mut whole = plant.whole().to_vec();
    whole.push([low, high]);
    let at = |ends: &[[Rational; 2]]| {
        let (gain, parameters) = ends.split_last()?;
        let lines = plant.member(&plant.enclosed(parameters))?.lines(plant.lines(), &own.fundamental)?;
        own.sizes(&lines, &Enclosure::between(&gain[0], &gain[1], PRECISION), oscillators)
    };
    let mut open = vec![whole.clone()];
    let mut known: Option<Sizes<f64>> = None;
    let mut found: Option<Sizes<Enclosure>> = None;
    let mut boxes = 0;
    while !open.is_empty() {
        boxes += open.len();
        // What some member has, so that the largest is not below it.
        for ends in &open {
            let middle: Vec<[Rational; 2]> =
                ends.iter().map(|[low, high]| [(); 2].map(|()| Rational::from(low + high) / 2)).collect();
            if let Some(sizes) = at(&middle) {
                let upper = sizes.doubles();
                known = Some(known.map_or_else(|| upper.clone(), |known| known.with(&upper, |a, b| a.max(*b))));
            }
        }
        let known = known.as_ref();
        let mut next = Vec::new();
        for ends in open {
            let sizes = at(&ends);
            let sharp = sizes.as_ref().zip(known).is_some_and(|(sizes, known)| {
                let pairs = sizes.each().into_iter().zip(known.each()).zip(ROOMS);
                pairs.into_iter().all(|((size, known), room)| size.upper_f64() <= known * (1.0 + room))
            });
            match sizes {
                Some(sizes) if sharp || boxes >= MAX_BOXES => {
                    found = Some(found.map_or_else(|| sizes.clone(), |found| found.with(&sizes, |a, b| a.max(b))));
                }
                None if boxes >= MAX_BOXES => return None,
                _ => next.extend(halved(ends, &whole)?),
            }
        }
        open = next;
    }
    found
}

impl Sizes<Enclosure> {
    fn doubles(&self) -> Sizes<f64> {
        let Sizes { error, control, states, zeta } = self;
        let [error, control, states, zeta] = [error, control, states, zeta].map(Enclosure::upper_f64);
        Sizes { error, control, states, zeta }
    }
}

/// Both halves of a box, across the side that is the largest share of that of the whole; `None` where none has a length.
fn halved(ends: Vec<[Rational; 2]>, whole: &[[Rational; 2]]) -> Option<[Vec<[Rational; 2]>; 2]> {
    let length = |[low, high]: &[Rational; 2]| Rational::from(high - low);
    let share = |side: usize| {
        let of = length(&whole[side]);
        if of == 0 { Rational::new() } else { length(&ends[side]) / of }
    };
    // The first of the largest.
    let side = (0..ends.len()).rev().max_by_key(|&side| share(side)).filter(|&side| share(side) > 0)?;
    let [low, high] = &ends[side];
    let middle: Rational = Rational::from(low + high) / 2;
    let with = |end: [Rational; 2]| {
        let mut ends = ends.clone();
        ends[side] = end;
        ends
    };
    Some([with([low.clone(), middle.clone()]), with([middle, high.clone()])])
}
