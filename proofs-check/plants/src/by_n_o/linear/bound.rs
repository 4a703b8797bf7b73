//! Numbers that a function on a box does not exceed in magnitude: in its middle, on the box, and its derivatives there.
//!
//! `|f(z)| <= |f(c)| + sum_i |z_i - c_i| D_i` with D_i at least the size of the i-th derivative on the box, also where f vanishes. Of several functions, as
//! one for each instant between two samples, such numbers bound the largest.

use super::complex::Complex;
use super::jet::{Axes, Jet};
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

/// The numbers.
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

    /// Of a function.
    pub fn of(jet: &Jet<Complex>) -> Bound {
        let size = |z: &Complex| z.square().sqrt().ceiling();
        Bound { middle: size(&jet.middle), all: size(&jet.all), slopes: jet.slopes.iter().map(size).collect() }
    }

    fn with(&self, other: &Bound, of: impl Fn(&Interval, &Interval) -> Interval) -> Bound {
        let zero = Interval::int(0, self.middle.precision());
        let at = |bound: &Bound, i: usize| bound.slopes.get(i).cloned().unwrap_or_else(|| zero.clone());
        let count = self.slopes.len().max(other.slopes.len());
        Bound {
            middle: of(&self.middle, &other.middle).ceiling(),
            all: of(&self.all, &other.all).ceiling(),
            slopes: (0..count).map(|i| of(&at(self, i), &at(other, i)).ceiling()).collect(),
        }
    }

    /// Of the larger one of both.
    pub fn most(&self, other: &Bound) -> Bound {
        self.with(other, Interval::max)
    }

    /// Of the sum, the other one with a factor.
    pub fn plus(&self, other: &Bound, factor: &Interval) -> Bound {
        self.with(other, |a, b| a + b * factor)
    }

    /// Of the root of the sum of the squares, that of the other one with a factor: of the length of a vector.
    pub fn beside(&self, other: &Bound, factor: i64) -> Bound {
        self.with(other, |a, b| (a.sqr() + b.sqr() * factor).sqrt())
    }

    /// Of the root of the square of it and a number.
    pub fn raised(&self, square: &Interval) -> Bound {
        let raised = |value: &Interval| (value.sqr() + square.ceiling()).sqrt().ceiling();
        Bound { middle: raised(&self.middle), all: raised(&self.all), slopes: self.slopes.clone() }
    }

    /// In the middle of the box.
    pub fn in_middle(&self) -> &Interval {
        &self.middle
    }

    /// On the box.
    pub fn on_box(&self, axes: &Axes) -> Interval {
        let by_slopes = &self.middle + axes.reach(&self.slopes, self.middle.precision());
        self.all.least(&by_slopes).ceiling()
    }

    /// That what it bounds is at most a number.
    pub fn at_most(&self, axes: &Axes, limit: &Interval) -> Judgement {
        if self.on_box(axes).le(limit) == Some(true) {
            return Judgement::Proved;
        }
        if limit.lt(&self.middle) == Some(true) { Judgement::Stuck } else { Judgement::Open }
    }
}
