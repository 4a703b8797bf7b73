//! Sizes of functions on a box, and what is made of them: in its middle, on the box, and bounds of their slopes there.
//!
//! Where f is not 0 the derivative of |f| is `Re(conj(f) f')/|f|`, and |f| never changes by more than |f'|; the larger one of several sizes has slopes among
//! theirs. So a size exceeds that in the middle of the box by at most the sum of the slopes times the distances, also where it has no derivative.

use super::complex::Complex;
use super::jet::{Axes, Jet};
use crate::time::around;
use proofs_core::interval::Interval;

/// What is known of a bound on a box.
pub enum Judgement {
    Proved,
    /// In the middle of the box the number is certainly exceeded.
    Refuted,
    /// In the middle of the box the bound that is computed certainly exceeds the number: no box shows less.
    Stuck,
    /// In the middle of the box too little is left of the number for what this way of computing gives away: some box may refute, none proves.
    Close,
    /// A smaller box may show it.
    Open,
}

/// A size.
#[derive(Clone, Debug)]
pub struct Bound {
    middle: Interval,
    all: Interval,
    slopes: Vec<Interval>,
}

impl Bound {
    /// 0.
    pub fn zero(precision: u32) -> Bound {
        let zero = Interval::int(0, precision);
        Bound { middle: zero.clone(), all: zero, slopes: Vec::new() }
    }

    /// That of a function.
    pub fn of(jet: &Jet<Complex>) -> Bound {
        let size = |z: &Complex| z.square().sqrt();
        let (f, all) = (&jet.all, size(&jet.all));
        let slope = |slope: &Complex| {
            let most = around(&size(slope));
            if all.is_positive() { within((&f.re * &slope.re + &f.im * &slope.im) / &all, &most) } else { most }
        };
        Bound { middle: size(&jet.middle), slopes: jet.slopes.iter().map(slope).collect(), all }
    }

    /// Along each axis the slopes of both.
    fn pairs<'p>(&'p self, other: &'p Bound) -> impl Iterator<Item = [Interval; 2]> + 'p {
        let at = |bound: &Bound, i: usize| bound.slopes.get(i).cloned();
        let zero = Interval::int(0, self.middle.precision());
        let count = self.slopes.len().max(other.slopes.len());
        (0..count).map(move |i| [self, other].map(|bound| at(bound, i).unwrap_or_else(|| zero.clone())))
    }

    /// The larger one of both.
    pub fn most(&self, other: &Bound) -> Bound {
        if other.all.lt(&self.all) == Some(true) {
            return self.clone();
        }
        if self.all.lt(&other.all) == Some(true) {
            return other.clone();
        }
        Bound {
            middle: self.middle.max(&other.middle),
            all: self.all.max(&other.all),
            slopes: self.pairs(other).map(|[a, b]| a.hull(&b)).collect(),
        }
    }

    /// The sum, the other one with a factor.
    pub fn plus(&self, other: &Bound, factor: &Interval) -> Bound {
        Bound {
            middle: &self.middle + &other.middle * factor,
            all: &self.all + &other.all * factor,
            slopes: self.pairs(other).map(|[a, b]| a + b * factor).collect(),
        }
    }

    /// The root of the sum of the squares, that of the other one with a factor: the length of a vector.
    pub fn beside(&self, other: &Bound, factor: i64) -> Bound {
        let length = |a: &Interval, b: &Interval| (a.sqr() + b.sqr() * factor).sqrt();
        let all = length(&self.all, &other.all);
        let slope = |[a, b]: [Interval; 2]| {
            let most = around(&length(&a, &b));
            let turned = || (&self.all * &a + &other.all * &b * factor) / &all;
            if all.is_positive() { within(turned(), &most) } else { most }
        };
        let slopes = self.pairs(other).map(slope).collect();
        Bound { middle: length(&self.middle, &other.middle), slopes, all }
    }

    /// The root of the sum of the square and a number.
    pub fn raised(&self, square: &Interval) -> Bound {
        let square = square.ceiling();
        let raised = |value: &Interval| (value.sqr() + &square).sqrt();
        let all = raised(&self.all);
        let unit = Interval::int(0, all.precision()).hull(&Interval::int(1, all.precision()));
        let share = if all.is_positive() { within(&self.all / &all, &unit) } else { unit };
        Bound { middle: raised(&self.middle), slopes: self.slopes.iter().map(|slope| slope * &share).collect(), all }
    }

    /// At most this in the middle of the box.
    pub fn in_middle(&self) -> Interval {
        self.middle.ceiling()
    }

    /// At most this on the box.
    pub fn on_box(&self, axes: &Axes) -> Interval {
        let by_slopes = &self.middle + axes.reach(&self.slopes, self.middle.precision());
        self.all.ceiling().least(&by_slopes.ceiling())
    }

    /// That it is at most a number.
    pub fn at_most(&self, axes: &Axes, limit: &Interval) -> Judgement {
        if self.on_box(axes).le(limit) == Some(true) {
            return Judgement::Proved;
        }
        if limit.lt(&self.middle) == Some(true) { Judgement::Stuck } else { Judgement::Open }
    }
}

/// What two enclosures of one number have in common; the second one, where the first is undefined.
fn within(value: Interval, most: &Interval) -> Interval {
    if value.is_defined() { value.intersect(most) } else { most.clone() }
}
