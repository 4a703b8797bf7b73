//! The region on which something is decided, in boxes: t over a period, v in a ball, or the states themselves each in an interval,
//! e in an interval (docs/mathematics.md, sections 11.3 and 11.6).
//!
//! Boxes that are certainly outside of the ball are left out. The ends of a box are shared with its neighbours, so the boxes
//! cover the region whatever is rounded.

use super::around::Around;
use super::formula::Axis;
use super::machine::{Cell, Machine};
use super::read::{MAX_INTERVALS, Plant};
use super::time::around;
use proofs_core::interval::Interval;
use rug::Rational;
use std::rc::Rc;

/// How many cells of t there are before anything is halved for a reason.
const FIRST_CELLS_LOG: u32 = 4;

/// `v` or `x` in a set of `states` dimensions, `|e| <= output`, all t, and parameters between two ends.
#[derive(Clone)]
pub struct Region {
    pub states: usize,
    pub shape: Shape,
    pub output: Interval,
    pub parameters: Vec<[Rational; 2]>,
}

/// Where v or x lies.
#[derive(Clone)]
pub enum Shape {
    /// `|v| <= radius`.
    Ball(Interval),
    /// Each component between two ends, and all around a middle that moves.
    Sides(Vec<Interval>, Around),
}

/// A box: those axes on which nothing depends have the whole range.
#[derive(Clone)]
pub struct Piece {
    pub cell: Rc<Cell>,
    /// Of v_1, ..., v_n, of e, and of the parameters, with the clock the last of them.
    pub sides: Vec<Interval>,
}

impl Region {
    /// All members of a family, without states and with e = 0.
    pub fn of_family(plant: &Plant, precision: u32) -> Region {
        let zero = Interval::int(0, precision);
        let parameters = plant.family.iter().map(|span| span.ends.clone()).collect();
        Region { states: 0, shape: Shape::Ball(zero.clone()), output: zero, parameters }
    }

    /// The box of everything, over one cell of t.
    pub fn whole(&self, machine: &Machine<'_>, cell: Rc<Cell>) -> Piece {
        let around = |size: &Interval| around(&size.round(machine.precision));
        let mut sides = match &self.shape {
            Shape::Ball(radius) => vec![around(radius); self.states],
            Shape::Sides(sides, _) => sides.clone(),
        };
        sides.push(around(&self.output));
        sides.extend(self.parameters.iter().map(|[lo, hi]| Interval::between(lo, hi, machine.precision)));
        Piece { cell, sides }
    }

    /// Boxes that cover it, cut along t if something depends on t.
    pub fn pieces(&self, machine: &Machine<'_>, root: &Rc<Cell>, depends: u16) -> Vec<Piece> {
        let times = if depends & Axis::Time.bit() != 0 { FIRST_CELLS_LOG } else { 0 };
        root.parts(times).into_iter().map(|cell| self.whole(machine, cell)).collect()
    }

    /// Whether a box has no point of the region.
    pub fn misses(&self, piece: &Piece) -> bool {
        let radius = match &self.shape {
            Shape::Ball(radius) => radius,
            Shape::Sides(_, around) => {
                return around.excludes(&piece.sides[..self.states]);
            }
        };
        let nearest = |side: &Interval| side.abs().floor().sqr();
        let zero = Interval::int(0, radius.precision());
        let distance = piece.sides[..self.states].iter().map(nearest).fold(zero, |sum, part| sum + part);
        radius.sqr().lt(&distance) == Some(true)
    }

    /// The radius of the ball, where a box is not certainly within it.
    pub fn reaches_out(&self, piece: &Piece) -> Option<&Interval> {
        let Shape::Ball(radius) = &self.shape else { return None };
        let zero = Interval::int(0, radius.precision());
        let distance = piece.sides[..self.states].iter().map(Interval::sqr).fold(zero, |sum, part| sum + part);
        (distance.ceiling().le(&radius.sqr()) != Some(true)).then_some(radius)
    }

    /// A place of v, e and the parameters with v moved towards the origin, to lie within the ball where it is outside, and the
    /// parameters between their ends. A hint.
    pub fn inward(&self, place: &mut [Interval]) {
        let (place, rest) = place.split_at_mut(self.states);
        for (value, [lo, hi]) in rest.iter_mut().skip(1).zip(&self.parameters) {
            let [lo, hi] = [lo, hi].map(|end| Interval::rational(end, value.precision()));
            *value = value.max(&lo.ceiling()).min(&hi.floor());
        }
        let Shape::Ball(radius) = &self.shape else { return };
        let p = radius.precision();
        let distance = place.iter().fold(Interval::int(0, p), |sum, v| sum + v.sqr()).sqrt();
        if distance.lt(radius) != Some(true) && distance.is_positive() {
            let inward = Interval::rational(&Rational::from((999_999, 1_000_000)), p);
            let factor = radius * inward / distance;
            place.iter_mut().for_each(|v| *v = (&*v * &factor).middle());
        }
    }

    /// Whether the middle of a box certainly belongs to the region.
    pub fn has_middle(&self, piece: &Piece) -> bool {
        self.has(&piece.middles())
    }

    /// Whether v_1, ..., v_n, e and the parameters certainly belong to it. Between [`Shape::Sides`] it says less, that nothing shows they do
    /// not: such a refutation is not believed (`still`).
    pub fn has(&self, place: &[Interval]) -> bool {
        let lies_within = |value: &Interval, end: &Interval| value.le(end) == Some(true);
        let within = match &self.shape {
            Shape::Ball(radius) => {
                let zero = Interval::int(0, radius.precision());
                let distance = place[..self.states].iter().fold(zero, |sum, v| sum + v.sqr());
                lies_within(&distance, &radius.sqr())
            }
            Shape::Sides(sides, around) => {
                place.iter().zip(sides).all(|(v, side)| side.contains(v)) && !around.excludes(place)
            }
        };
        let between = |(value, [lo, hi]): (&Interval, &[Rational; 2])| *value.lo() >= *lo && *value.hi() <= *hi;
        let rest = &place[self.states..];
        within && lies_within(&rest[0].abs(), &self.output) && rest[1..].iter().zip(&self.parameters).all(between)
    }
}

impl Piece {
    /// The middles of all sides.
    pub fn middles(&self) -> Vec<Interval> {
        self.sides.iter().map(Interval::middle).collect()
    }

    /// A bound of the distance to the middle, along t (`None`) or a side.
    pub fn half_width(&self, side: Option<usize>) -> Interval {
        side.map_or(&self.cell.all, |side| &self.sides[side]).half_width()
    }

    /// The two halves along t (`None`) or a side.
    pub fn halves(&self, side: Option<usize>) -> [Piece; 2] {
        let Some(side) = side else {
            return self.cell.halves().map(|cell| Piece { cell, sides: self.sides.clone() });
        };
        self.sides[side].halves().map(|part| {
            let mut half = self.clone();
            half.sides[side] = part;
            half
        })
    }

    /// The width along t (`None`) or a side in comparison with that of another box, 0 where that has none. A hint.
    pub fn share(&self, side: Option<usize>, whole: &Piece) -> f64 {
        let width = |piece: &Piece| piece.half_width(side).hi().to_f64();
        let (now, first) = (width(self), width(whole));
        if first > 0.0 { now / first } else { 0.0 }
    }

    /// Along which of these axes a box is widest, in comparison with the widths at the beginning: t (`None`) or a side. A hint,
    /// of which nothing is believed.
    pub fn widest(&self, whole: &Piece, depends: u16, states: usize) -> Option<Option<usize>> {
        let share = |side: Option<usize>| self.share(side, whole);
        let all = axes(depends, states).map(|side| (share(side), side)).filter(|(share, _)| *share > 0.0);
        all.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, side)| side)
    }
}

/// The axes on which something depends that depends on these: t (`None`) and sides.
pub fn axes(depends: u16, states: usize) -> impl Iterator<Item = Option<usize>> {
    // The clock is one more.
    let sides = (0..=states + MAX_INTERVALS + 1).map(Some);
    std::iter::once(None).chain(sides).filter(move |side| depends & axis(*side, states).bit() != 0)
}

/// The axis of t (`None`) or of a side.
pub fn axis(side: Option<usize>, states: usize) -> Axis {
    match side {
        None => Axis::Time,
        Some(side) if side < states => Axis::State(side),
        Some(side) if side == states => Axis::Output,
        Some(side) => Axis::Parameter(side - states - 1),
    }
}
