//! The largest value over t of a trigonometric polynomial whose coefficients are functions on a box (docs/mathematics.md, section 14.3).
//!
//! With harmonics up to K and M times of equal distance in a period, `m = sup|y|` is at most `max_j |y(t_j)|/(1 - (pi K/M)^2/2)`: where y is largest its
//! derivative vanishes, the next of these times is at most T/(2M) away, and `|y''| <= (K Om)^2 m` (Bernstein's inequality, twice). For a vector the
//! same holds of its part in every direction, hence of its length. The times do not depend on the box, so at each of them the mean value theorem bounds y.

use super::bound::{Bound, Judgement};
use super::complex::Complex;
use super::jet::{Axes, Jet};
use proofs_core::interval::Interval;

/// How many times there are for each harmonic: what they give away is 0.0075 %.
const TIMES: usize = 256;
/// Every so many-th is looked at first, which gives away 0.12 %.
const STRIDES: [usize; 2] = [4, 1];

/// That a function is at most a number, where what is computed is the function itself (`exact`) or a bound of it.
pub fn at_most(axes: &Axes, bound: &Jet<Interval>, limit: &Interval, exact: bool) -> Judgement {
    if axes.most(bound).le(limit) == Some(true) {
        return Judgement::Proved;
    }
    match limit.lt(&bound.middle.floor()) {
        Some(true) if exact => Judgement::Refuted,
        Some(true) => Judgement::Stuck,
        _ => Judgement::Open,
    }
}

/// `sum over all k of y_k e^(i k Om t)` by its coefficients with `k >= 0`, each with its k: vectors.
pub struct Signal(pub Vec<(usize, Vec<Jet<Complex>>)>);

/// `e^(2 pi i j/M)` for all j.
pub struct Times {
    turns: Vec<Complex>,
}

impl Times {
    /// For harmonics up to `most`.
    pub fn new(most: usize, precision: u32) -> Times {
        let count = most * TIMES;
        let turn = |j: usize| {
            let angle = Interval::pi(precision) * (2 * j) as i64 / count as i64;
            Complex { re: angle.cos(), im: angle.sin() }
        };
        Times { turns: (0..count).map(turn).collect() }
    }

    /// `1 - (pi K/M)^2/2`, for every so many-th of the times.
    fn share(&self, most: usize, stride: usize, precision: u32) -> Interval {
        let count = (self.turns.len() / stride) as i64;
        1 - (Interval::pi(precision) * most as i64 / count).sqr() / 2
    }
}

/// The factor of the harmonic k and -k together.
pub fn both(k: usize) -> i64 {
    if k == 0 { 1 } else { 2 }
}

impl Signal {
    /// `|y_0| + 2 sum |y_k|`: a bound of |y|.
    pub fn sum(&self, axes: &Axes, precision: u32) -> Jet<Interval> {
        let zero = || Jet::constant(&Interval::int(0, precision));
        let size = |(k, parts): &(usize, Vec<Jet<Complex>>)| {
            let square = parts.iter().fold(zero(), |sum, part| sum.plus(&axes.square(part)));
            axes.root(&square).mapped(|size| size * both(*k))
        };
        self.0.iter().fold(zero(), |sum, part| sum.plus(&size(part)))
    }

    /// That |y| is at most a number at all times.
    pub fn at_most(&self, axes: &Axes, limit: &Interval, times: &Times) -> Judgement {
        let p = limit.precision();
        let sum = self.sum(axes, p);
        let dimension = self.0.first().map_or(0, |(_, parts)| parts.len());
        // Of one number with one harmonic the sum is the largest value.
        let alone = dimension == 1 && self.0.len() == 1;
        let by_sum = at_most(axes, &sum, limit, alone);
        let most = self.0.iter().map(|(k, _)| *k).max().unwrap_or(0);
        if alone || matches!(by_sum, Judgement::Proved) || most == 0 || times.turns.len() < most * TIMES {
            return by_sum;
        }
        // More times show no more than this.
        let finest = limit * times.share(most, 1, p);
        for stride in STRIDES {
            let [in_middle, on_box] = self.at_times(axes, times, stride, p);
            if limit.lt(&in_middle) == Some(true) {
                return Judgement::Refuted;
            }
            if on_box.le(&(limit * times.share(most, stride, p))) == Some(true) {
                return Judgement::Proved;
            }
            if finest.lt(&in_middle) == Some(true) {
                return Judgement::Close;
            }
            if on_box.le(&finest) != Some(true) {
                break;
            }
        }
        Judgement::Open
    }

    /// The same of |y| and of what it is off by at most, which no value of y need show.
    pub fn at_most_with(&self, axes: &Axes, limit: &Interval, off: Option<&Bound>, times: &Times) -> Judgement {
        let Some(off) = off else { return self.at_most(axes, limit, times) };
        let within = |off: &Interval| self.at_most(axes, &(limit - off).floor(), times);
        if matches!(within(&off.on_box(axes)), Judgement::Proved) {
            return Judgement::Proved;
        }
        match (self.at_most(axes, limit, times), within(&off.in_middle())) {
            (Judgement::Refuted, _) => Judgement::Refuted,
            (_, Judgement::Refuted | Judgement::Stuck) => Judgement::Stuck,
            (_, Judgement::Close) => Judgement::Close,
            _ => Judgement::Open,
        }
    }

    /// At every so many-th of the times: a number that |y| reaches at one of them in the middle of the box, and one that it does not exceed at any of
    /// them on the box.
    fn at_times(&self, axes: &Axes, times: &Times, stride: usize, p: u32) -> [Interval; 2] {
        let dimension = self.0.first().map_or(0, |(_, parts)| parts.len());
        let fastest: Vec<Interval> = (0..axes.count()).map(|axis| self.most_along(axis, p)).collect();
        let reach = axes.reach(&fastest, p);
        let zero = || Interval::int(0, p);
        let (mut in_middle, mut on_box) = (zero(), zero());
        for j in (0..times.turns.len()).step_by(stride) {
            let middle: Vec<Interval> =
                (0..dimension).map(|i| self.at(times, j, i, |jet| Some(&jet.middle), p)).collect();
            let size = match middle.as_slice() {
                [one] => one.abs(),
                all => all.iter().fold(zero(), |sum, part| sum + part.sqr()).sqrt(),
            };
            in_middle = in_middle.max(&size.floor());
            if (&size + &reach).le(&on_box) == Some(true) {
                continue;
            }
            let jet = |(i, middle): (usize, &Interval)| {
                let slopes =
                    (0..axes.count()).map(|axis| self.at(times, j, i, |jet| jet.slopes.get(axis), p)).collect();
                axes.narrowed(Jet { middle: middle.clone(), all: Interval::entire(p), slopes })
            };
            let there: Vec<Jet<Interval>> = middle.iter().enumerate().map(jet).collect();
            let most = match there.as_slice() {
                [one] => one.all.abs(),
                all => {
                    let square = all.iter().fold(Jet::constant(&zero()), |sum, jet| sum.plus(&axes.times(jet, jet)));
                    axes.most(&square).sqrt()
                }
            };
            on_box = on_box.max(&most.ceiling());
        }
        [in_middle, on_box]
    }

    /// A component at the j-th time, or of its derivatives: of what each coefficient has in its place.
    fn at<'s>(
        &'s self,
        times: &Times,
        j: usize,
        i: usize,
        of: impl Fn(&'s Jet<Complex>) -> Option<&'s Complex>,
        p: u32,
    ) -> Interval {
        let count = times.turns.len();
        let term = |(k, parts): &'s (usize, Vec<Jet<Complex>>)| {
            let (value, turn) = (of(parts.get(i)?)?, &times.turns[j * k % count]);
            Some((&value.re * &turn.re - &value.im * &turn.im) * both(*k))
        };
        self.0.iter().filter_map(term).fold(Interval::int(0, p), |sum, term| sum + term)
    }

    /// A bound of the length of the derivative along an axis at all times.
    fn most_along(&self, axis: usize, p: u32) -> Interval {
        let size = |(k, parts): &(usize, Vec<Jet<Complex>>)| {
            let slopes = parts.iter().filter_map(|part| part.slopes.get(axis));
            slopes.fold(Interval::int(0, p), |sum, slope| sum + slope.square()).sqrt() * both(*k)
        };
        self.0.iter().map(size).fold(Interval::int(0, p), |sum, size| sum + size)
    }

    /// How much of each coefficient is not known along an axis; a hint.
    pub fn spread(&self, axes: &Axes, axis: usize) -> f64 {
        self.0.iter().flat_map(|(_, parts)| parts).map(|part| spread(part, axes, axis)).sum()
    }
}

/// How much of a function is not known because its derivative along an axis is not; a hint.
pub fn spread(jet: &Jet<Complex>, axes: &Axes, axis: usize) -> f64 {
    let width = |slope: &Complex| slope.re.half_width().hi().to_f64() + slope.im.half_width().hi().to_f64();
    jet.slopes.get(axis).map_or(0.0, width) * axes.width(axis)
}

#[cfg(test)]
#[allow(clippy::disallowed_methods, reason = "what is compared need not be the same on every machine")]
mod tests {
    use super::*;
    use crate::PRECISION;
    use crate::by_n_o::linear::tests::number;

    /// `size cos(k Om t - phase)` for numbers between -w and w on one axis: they move the size by the derivative `slope`, and the phase by 1.
    fn wave(k: usize, size: f64, phase: f64, [w, slope]: [f64; 2]) -> Jet<Complex> {
        let at = |s: f64| Complex {
            re: number(size / 2.0 * (phase + s).cos()),
            im: number(-size / 2.0 * (phase + s).sin()),
        };
        let moved = if k == 0 { 0.0 } else { w };
        let hull = |a: &Complex, b: &Complex| Complex { re: a.re.hull(&b.re), im: a.im.hull(&b.im) };
        let turned = hull(&at(-moved), &at(moved));
        let sized = turned.scaled(&number(1.0 - w * slope / size).hull(&number(1.0 + w * slope / size)));
        // d/ds of both: -i times it, and slope/size times it.
        let turning = if k == 0 { Complex::zero(PRECISION) } else { Complex { re: sized.im.clone(), im: -&sized.re } };
        let growing = turned.scaled(&number(slope / size));
        let slope = Complex { re: turning.re + growing.re, im: turning.im + growing.im };
        let all = hull(&sized, &at(0.0));
        Jet { middle: at(0.0), all, slopes: vec![slope] }
    }

    /// The largest value lies in the middle between two of the times, whichever are looked at.
    #[test]
    fn what_lies_between_the_times_counts() {
        let times = Times::new(3, PRECISION);
        let axes = Axes::new(&[number(0.0)]);
        for stride in STRIDES {
            let half = std::f64::consts::PI * stride as f64 / (3 * TIMES) as f64;
            for near in [0.0, 1.0, 31.0] {
                let (at, small) = (half * (1.0 + 2.0 * near), 1e-6);
                let parts = [(3, 1.0), (1, small)].map(|(k, size)| (k, wave(k, size, k as f64 * at, [0.0, 0.0])));
                for dimension in [1, 2] {
                    // In two dimensions along the diagonal.
                    let along = |(k, jet): &(usize, Jet<Complex>)| (*k, vec![jet.clone(); dimension]);
                    let signal = Signal(parts.iter().map(along).collect());
                    let largest = (1.0 + small) * (dimension as f64).sqrt();
                    let judged = |limit: f64| signal.at_most(&axes, &number(limit), &times);
                    assert!(matches!(judged(largest * (1.0 + 1e-4)), Judgement::Proved));
                    assert!(!matches!(judged(largest * (1.0 - 1e-9)), Judgement::Proved));
                    assert!(matches!(judged(largest * (1.0 - 3e-4)), Judgement::Refuted | Judgement::Close));
                    assert!(matches!(judged(largest * (1.0 - 3e-2)), Judgement::Refuted));
                }
            }
        }
    }

    /// On a box the largest value over it is bounded, and by little more.
    #[test]
    fn what_lies_in_the_box_counts() {
        let times = Times::new(2, PRECISION);
        let w = 1e-3;
        let axes = Axes::new(&[number(w)]);
        // cos(2 s' - 2 phase') (1 + 3 s) + (0.5 + s) with the phase moved by s: largest (1 + 3 w) + 0.5 + w.
        let mean = wave(0, 0.5, 0.0, [w, 1.0]).mapped(|value| value.scaled(&number(2.0)));
        let signal = Signal(vec![(0, vec![mean]), (2, vec![wave(2, 1.0, 0.3, [w, 3.0])])]);
        let largest = (1.0 + 3.0 * w) + (0.5 + w);
        let judged = |limit: f64| signal.at_most(&axes, &number(limit), &times);
        assert!(matches!(judged(largest * (1.0 + 1e-4)), Judgement::Proved));
        assert!(matches!(judged(largest * (1.0 - 1e-6)), Judgement::Open));
        assert!(matches!(judged(1.5 * (1.0 - 1e-3)), Judgement::Refuted));
    }
}
