//! The region on which something is decided, in boxes: t over a period, v in a ball, or the states themselves each in an interval,
//! e in an interval (docs/mathematics.md, sections 11.3 and 11.6).
//!
//! Boxes that are certainly outside of the ball are left out. The ends of a box are shared with its neighbours, so the boxes
//! cover the region whatever is rounded.

use super::formula::{Axis, Id};
use super::machine::{At, Cell, Machine, Program, Values};
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

/// A node with what has to be computed for it: along which axis a box is halved where it is not known well enough. A hint, of which nothing is believed.
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

/// Some of the states around an orbit: a box of them that is in no ball of all coordinates, at no time.
///
/// Some components of `x = xb(t) + L y`, `|y| <= radius`.
///
/// With the rows R of L that they have, `w = x - xb = R y`. The parts `u_i = sum_j g_ij r_j` of the rows that are orthogonal to each
/// other give `g_i w = u_i y`, and so `sum_i (g_i w)^2 / |u_i|^2 <= |y|^2` (Bessel).
#[derive(Clone)]
pub struct Around {
    radius: Interval,
    /// The components, and what xb has of each over a period.
    middle: Vec<(usize, Interval)>,
    /// g_i and `|u_i|^2 > 0`.
    forms: Vec<(Vec<Interval>, Interval)>,
}

impl Around {
    /// From the components, each with its row of L and with what xb has of it over a period. `None` where the rows are not seen
    /// to be independent.
    pub fn new(components: Vec<(usize, &[Rational], Interval)>, radius: Interval) -> Option<Around> {
        let p = radius.precision();
        let product =
            |a: &[Interval], b: &[Interval]| a.iter().zip(b).fold(Interval::int(0, p), |sum, (a, b)| sum + a * b);
        let mut forms: Vec<(Vec<Interval>, Interval)> = Vec::new();
        let mut orthogonal: Vec<Vec<Interval>> = Vec::new();
        for (i, (_, row, _)) in components.iter().enumerate() {
            let row: Vec<Interval> = row.iter().map(|value| Interval::rational(value, p)).collect();
            let mut form: Vec<Interval> = (0..components.len()).map(|j| Interval::int(i64::from(i == j), p)).collect();
            let mut part = row.clone();
            for ((before, square), other) in forms.iter().zip(&orthogonal) {
                let share = product(&row, other) / square;
                let less = |from: &mut Vec<Interval>, of: &[Interval]| {
                    from.iter_mut().zip(of).for_each(|(value, of)| *value = &*value - &share * of);
                };
                less(&mut part, other);
                less(&mut form, before);
            }
            let square = part.iter().fold(Interval::int(0, p), |sum, value| sum + value.sqr());
            if !square.is_positive() {
                return None;
            }
            forms.push((form, square));
            orthogonal.push(part);
        }
        let middle = components.into_iter().map(|(state, _, range)| (state, range)).collect();
        Some(Around { radius, middle, forms })
    }

    /// Whether no x of a box lies in it, at any time; a `false` says nothing.
    pub fn excludes(&self, x: &[Interval]) -> bool {
        let zero = || Interval::int(0, self.radius.precision());
        let from: Vec<Interval> = self.middle.iter().map(|(state, middle)| &x[*state] - middle).collect();
        let part = |(form, square): &(Vec<Interval>, Interval)| {
            let value = form.iter().zip(&from).fold(zero(), |sum, (factor, from)| sum + factor * from);
            value.sqr() / square
        };
        let distance = self.forms.iter().map(part).fold(zero(), |sum, part| sum + part);
        self.radius.sqr().lt(&distance) == Some(true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Place = [(i32, i32); 3];

    /// The second and the third of three coordinates, and what they are at y where xb = (0, 1, 0).
    fn around(radius: i64) -> (Around, impl Fn(Place) -> Vec<Interval>) {
        let l = [[2, 0, 0], [3, -1, 0], [1, 5, 4]].map(|row| row.map(Rational::from));
        let number = |value: &Rational| Interval::rational(value, 128);
        let rows = (1..3).map(|i| (i, l[i].as_slice(), number(&Rational::from(i == 1)))).collect();
        let around = Around::new(rows, Interval::int(radius, 128)).unwrap();
        let place = move |y: Place| {
            let y = y.map(Rational::from);
            let x = |(i, row): (usize, &[Rational; 3])| {
                row.iter().zip(&y).fold(Rational::from(i == 1), |sum, (l, y)| sum + Rational::from(l * y))
            };
            l.iter().enumerate().map(|row| number(&x(row))).collect()
        };
        (around, place)
    }

    /// Every place of the ball stays, those on its edge too; of those beyond, the ones that no other first coordinate brings back.
    #[test]
    fn no_place_of_the_ball_is_left_out() {
        let (around, place) = around(1);
        // Pythagorean: on the sphere.
        for (y, other) in [((3, 5), (4, 5)), ((-3, 5), (4, 5)), ((4, 5), (-3, 5)), ((0, 1), (1, 1)), ((-1, 1), (0, 1))]
        {
            for y in [[y, other, (0, 1)], [(0, 1), y, other], [other, (0, 1), y]] {
                assert!(!around.excludes(&place(y)), "{y:?}");
            }
        }
        // Beyond along the plane of the two rows.
        for y in [[(3, 2), (-1, 2), (0, 1)], [(1, 10), (5, 4), (1, 1)]] {
            assert!(around.excludes(&place(y)), "{y:?}");
        }
        // The direction that is orthogonal to both rows moves neither component.
        assert!(!around.excludes(&place([(-400, 1), (-1200, 1), (1600, 1)])));
    }

    /// Rows that depend on each other say nothing.
    #[test]
    fn dependent_rows_are_told() {
        let row = [Rational::from(1), Rational::from(2)];
        let zero = || Interval::int(0, 128);
        let rows = vec![(0, row.as_slice(), zero()), (1, row.as_slice(), zero())];
        assert!(Around::new(rows, Interval::int(1, 128)).is_none());
    }
}
