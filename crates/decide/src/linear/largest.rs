//! The largest sizes of the members of a linear family, by subdivision of the box of parameters and gains.

use super::member::{Answer, Clock};
use super::plant::LinearPlant;
use super::steady::{Loop, Sizes};
use super::supremum::Fineness;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::Oscillators;
use std::cell::OnceCell;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// By what share a bound may be above that of some member at some gain: of e and u, and of what only the transient rests on.
const ROOMS: [f64; 6] = [0.002, 0.002, 0.002, 0.02, 0.02, 0.02];

/// The most sides of a box whose corners are looked at first.
const MOST_CORNERS: usize = 5;

/// The ends of the parameters.
type Ends = Vec<[Rational; 2]>;

/// How the members on the boxes of the parameters that were looked at answer the harmonics: the same for every gain and number of
/// oscillators.
#[derive(Debug)]
pub struct Answers<'p> {
    plant: &'p LinearPlant,
    clock: Clock,
    known: Mutex<HashMap<Ends, Option<Arc<Answer>>>>,
}

impl<'p> Answers<'p> {
    /// Of a plant at such instants.
    #[must_use]
    pub fn new(plant: &'p LinearPlant, clock: Clock) -> Answers<'p> {
        Answers { plant, clock, known: Mutex::default() }
    }

    /// The plant.
    #[must_use]
    pub fn plant(&self) -> &'p LinearPlant {
        self.plant
    }

    fn answer(&self, parameters: &[[Rational; 2]]) -> Option<Arc<Answer>> {
        // Whoever panics while he holds the lock has changed nothing but whole entries.
        let lock = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(answer) = lock().get(parameters) {
            return answer.clone();
        }
        let family = self.plant.family(parameters);
        let answer = family.and_then(|family| family.answer(self.plant.lines(), &self.clock)).map(Arc::new);
        lock().insert(parameters.to_vec(), answer.clone());
        answer
    }
}

/// Bounds along the periodic solution of every member of the family at every gain of the actuator, for these oscillators.
///
/// Hypothesis: the loop of each has exactly one T-periodic solution ([`super::Falling::decide`]). Guarantee: that one is so bounded. After so
/// many boxes as `effort` (corners and middles, to which they are compared, not counted) none is cut any more; `None` where no bound is found by then.
#[must_use]
pub fn sizes(answers: &Answers<'_>, own: &Loop, oscillators: &Oscillators, effort: usize) -> Option<Sizes<Enclosure>> {
    let [low, high] = [own.gain[0].lower_rational()?, own.gain[1].upper_rational()?];
    let mut whole = answers.plant.whole().to_vec();
    whole.push([low, high]);
    // Of a single member nothing but the instants is uncertain.
    let single = whole.iter().all(|[low, high]| low == high);
    let fineness = if single { Fineness::FINE } else { Fineness::COARSE };
    let regulation = OnceCell::new();
    let at = |ends: &[[Rational; 2]]| {
        let (gain, parameters) = ends.split_last()?;
        let answer = answers.answer(parameters)?;
        let regulation = regulation.get_or_init(|| own.regulation(oscillators, answer.lines.len()));
        own.sizes(&answer, gain, regulation, fineness)
    };
    // What is bounded at points: no box shows less. The largest is often at a corner.
    let larger = |a: Sizes<Enclosure>, b: &Sizes<Enclosure>| a.with(b, |a, b| a.max(b));
    let mut known = corners(&whole).iter().filter_map(|point| at(point)).reduce(|a, b| larger(a, &b));
    let mut open = vec![whole.clone()];
    let mut found: Option<Sizes<Enclosure>> = None;
    let mut boxes = 0;
    while !open.is_empty() {
        boxes += open.len();
        let all: Vec<Option<Sizes<Enclosure>>> = open.iter().map(|ends| at(ends)).collect();
        let in_middle = open.iter().zip(&all).filter(|(_, sizes)| sizes.is_some() && !single);
        let in_middle = in_middle.filter_map(|(ends, _)| at(&middle(ends)));
        known = in_middle.chain(known.take()).reduce(|a, b| larger(a, &b));
        let mut next = Vec::new();
        for (ends, sizes) in open.into_iter().zip(all) {
            let sharp = sizes.as_ref().zip(known.as_ref()).is_some_and(|(sizes, known)| {
                let mut pairs = sizes.each().into_iter().zip(known.each()).zip(ROOMS);
                pairs.all(|((size, known), room)| size.upper_f64() <= known.upper_f64() * (1.0 + room))
            });
            match sizes {
                Some(sizes) if sharp || boxes >= effort => {
                    found = Some(found.map_or_else(|| sizes.clone(), |found| larger(found, &sizes)));
                }
                None if boxes >= effort => return None,
                sizes => match halved(ends, &whole) {
                    Some(halves) => next.extend(halves),
                    // There is nothing to cut.
                    None => {
                        let sizes = sizes?;
                        found = Some(found.map_or_else(|| sizes.clone(), |found| larger(found, &sizes)));
                    }
                },
            }
        }
        open = next;
    }
    found
}

/// The point in the middle of a box.
fn middle(ends: &[[Rational; 2]]) -> Ends {
    let point = |[low, high]: &[Rational; 2]| {
        let middle: Rational = Rational::from(low + high) / 2;
        [middle.clone(), middle]
    };
    ends.iter().map(point).collect()
}

/// The corners of a box with a few sides; those of many are not looked at, and a point has none.
fn corners(ends: &[[Rational; 2]]) -> Vec<Ends> {
    let open: Vec<usize> = (0..ends.len()).filter(|side| ends[*side][0] != ends[*side][1]).collect();
    if open.is_empty() || open.len() > MOST_CORNERS {
        return Vec::new();
    }
    let corner = |which: usize| {
        let mut corner = middle(ends);
        for (bit, side) in open.iter().enumerate() {
            let end = &ends[*side][which >> bit & 1];
            corner[*side] = [end.clone(), end.clone()];
        }
        corner
    };
    (0..1 << open.len()).map(corner).collect()
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
