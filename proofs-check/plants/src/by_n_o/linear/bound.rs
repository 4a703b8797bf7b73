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

    /// The root of the sum of the square and `factor` times the largest size of a function over the times that its enclosures are of.
    ///
    /// That largest size lies between the sizes in the enclosures, in the middle of the box and on it, and its slopes lie between the opposite of the
    /// largest slope and that. Where the root may be 0 its slopes are undefined.
    pub fn raised(&self, by: &Jet<Interval>, factor: &Interval) -> Bound {
        let raised = |value: &Interval, by: &Interval| (value.sqr() + by.abs() * factor).sqrt();
        let all = raised(&self.all, &by.all);
        let by = Bound {
            middle: by.middle.abs().ceiling(),
            all: by.all.abs(),
            slopes: by.slopes.iter().map(around).collect(),
        };
        let slope = |[own, by]: [Interval; 2]| (&self.all * own + by * factor / 2) / &all;
        Bound { middle: raised(&self.middle, &by.middle), slopes: self.pairs(&by).map(slope).collect(), all }
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

#[cfg(test)]
#[allow(clippy::disallowed_methods, reason = "what is compared need not be the same on every machine")]
mod tests {
    use super::*;
    use crate::by_n_o::linear::tests::number;

    /// `middle + slope s` for s between -w and w, with numbers between -spread and spread added.
    fn line(middle: f64, slope: f64, w: f64, spread: f64) -> Jet<Interval> {
        let around = |middle: f64, size: f64| number(middle - size).hull(&number(middle + size));
        Jet {
            middle: around(middle, spread),
            all: around(middle, (slope * w).abs() + spread),
            slopes: vec![number(slope)],
        }
    }

    /// The root of `(a + b s)^2 + r sup |c + d s + v|` over the v between -spread and spread: the number in the middle is that in the middle, on the box
    /// none is larger than the bound, and the bound is near the largest one, whichever grows.
    #[test]
    fn a_root_of_a_square_and_a_largest_size() {
        let (w, r) = (0.25, 0.5);
        let axes = Axes::new(&[number(w)]);
        for [a, b, c, d] in
            [[1.0, 0.5, 2.0, -1.0], [1.0, -0.5, -2.0, -3.0], [-0.5, 0.25, 1.0, 3.0], [0.1, 1.0, 0.0, 1.0]]
        {
            for spread in [0.0, 0.25] {
                let at = |s: f64| ((a + b * s).powi(2) + r * ((c + d * s).abs() + spread)).sqrt();
                let own = line(a, b, w, 0.0).mapped(|value| Complex::real(value.clone()));
                let bound = Bound::of(&own).raised(&line(c, d, w, spread), &number(r));
                let [in_middle, on_box] = [bound.in_middle(), bound.on_box(&axes)].map(|bound| bound.hi().to_f64());
                assert!(at(0.0) <= in_middle && in_middle < at(0.0) * (1.0 + 1e-12), "{in_middle} {}", at(0.0));
                let largest = (-64..=64).map(|i| at(w * f64::from(i) / 64.0)).fold(0.0, f64::max);
                assert!(largest <= on_box && on_box < largest * 1.25, "{largest} {on_box}");
                let [more, less] = [1.0 + 1e-9, 1.0 - 1e-9];
                assert!(matches!(bound.at_most(&axes, &number(on_box * more)), Judgement::Proved));
                if in_middle < largest {
                    assert!(matches!(bound.at_most(&axes, &number(largest * less)), Judgement::Open));
                }
                assert!(matches!(bound.at_most(&axes, &number(at(0.0) * less)), Judgement::Stuck));
            }
        }
    }
}
