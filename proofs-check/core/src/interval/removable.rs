//! `b(x) = x/(e^x - 1)` with b(0) = 1, `s(x) = sin(x)/x` with s(0) = 1, and their derivatives of any order, of intervals
//! (docs/mathematics.md, section 11.7).
//!
//! | what                                     | enclosure                                                                    |
//! |------------------------------------------|------------------------------------------------------------------------------|
//! | b                                        | it decreases: the values at the ends                                         |
//! | b'                                       | it increases                                                                 |
//! | b''                                      | it decreases with the magnitude of x                                         |
//! | b^(k), k > 2                             | the value in the middle and the most that b^(k+1) is; from x b^(k) at x >= 1 |
//! | s, magnitudes up to 3                    | it decreases with the magnitude of x                                         |
//! | s^(k), where s^(k+1) has one sign        | the values at the ends                                                       |
//! | s^(k) elsewhere                          | the value in the middle and s^(k+1)                                          |
//!
//! The value at a point is that of the power series at 0, with its rest, or of a recurrence that divides by x, which is not small.

use super::{Interval, rounded};
use crate::effort;
use rug::float::Round;
use rug::{Float, Integer, Rational};
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

/// The two functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Function {
    Exprelr,
    Sinc,
}

/// By function, order of the derivative, and precision.
type Tables = HashMap<(Function, usize, u32), Rc<[Interval]>>;

/// The most terms of a power series.
const MAX_TERMS: usize = 200;

/// e^x is neither 0 nor infinite for x up to this.
const FAR: i64 = 1 << 20;

thread_local! {
    /// B_0, B_1, ..., as far as they have been asked for.
    static BERNOULLI: RefCell<Vec<Rational>> = const { RefCell::new(Vec::new()) };
    /// The power series that have been asked for.
    static TABLES: RefCell<Tables> = RefCell::new(HashMap::new());
}

/// B_n, from `sum over j <= n of C(n + 1, j) B_j = 0`.
fn bernoulli(n: usize) -> Rational {
    BERNOULLI.with_borrow_mut(|known| {
        for m in known.len()..=n {
            let (mut binomial, mut sum) = (Integer::from(1), Rational::new());
            for (j, b) in known.iter().enumerate() {
                sum += Rational::from(b * &binomial);
                binomial = binomial * (m + 1 - j) as u64 / (j + 1) as u64;
            }
            known.push(if m == 0 { Rational::from(1) } else { -sum / Rational::from(m as u64 + 1) });
        }
        known[n].clone()
    })
}

/// `[-r, r]`, r the upper end.
fn about_zero(r: &Interval) -> Interval {
    let r = r.ceiling();
    (-&r).hull(&r)
}

/// `f_0, ..., f_(N-1), r` of `f^(k)(x) = sum over j < N of f_j x^j + [-r, r] x^N`, f one of the two functions, for |x| up to 1/2 (b) or 1
/// (s). r is below 2^-w where the numbers of terms allow it.
///
/// |s^(m)| <= 1/(m + 1); |b^(m)| <= (5/2) m!/(2 pi)^m, m > 2, and 6 < 2 pi. Nothing is paid for here: a table is made once, and what an
/// answer costs must not depend on those before it.
fn table(function: Function, k: usize, w: u32) -> Rc<[Interval]> {
    let made = TABLES.with_borrow(|tables| tables.get(&(function, k, w)).cloned());
    made.unwrap_or_else(|| {
        let (mut all, mut factorial, mut reach) = (Vec::new(), Integer::from(1), Rational::from(1));
        let small = Rational::from(1) >> w;
        for j in 0..=MAX_TERMS {
            factorial *= j.max(1) as u64;
            let (own, rest) = match function {
                Function::Exprelr => {
                    let power = Integer::from(Integer::u_pow_u((k + j) as u32, k as u32));
                    let six = Integer::from(Integer::u_pow_u(6, (k + j) as u32));
                    (bernoulli(k + j), Rational::from((power * 5u32, six * 2u32)))
                }
                Function::Sinc => {
                    let sign = [1, 0, -1, 0][(k + j) % 4];
                    let place = (k + j + 1) as u64;
                    (Rational::from((sign, place)), Rational::from((1, Integer::from(&factorial * place))))
                }
            };
            // From the fourth on, the order of the rest is above 2.
            if j > 3 && Rational::from(&rest * &reach) < small || j == MAX_TERMS {
                all.push(Interval::rational(&rest, w));
                break;
            }
            all.push(Interval::rational(&(own / &factorial), w));
            if function == Function::Exprelr {
                reach >>= 1;
            }
        }
        let all: Rc<[Interval]> = all.into();
        TABLES.with_borrow_mut(|tables| tables.insert((function, k, w), all.clone()));
        all
    })
}

/// The value of a power series near 0.
fn power_series(function: Function, k: usize, x: &Interval) -> Interval {
    let table = table(function, k, x.precision());
    let Some((rest, terms)) = table.split_last() else { return Interval::undefined(x.precision()) };
    terms.iter().rev().fold(about_zero(rest), |sum, c| sum * x + c)
}

/// More than `2 m! zeta(m)/(2 pi)^m`, which no value of b^(m) exceeds in magnitude, m > 2: zeta(m) < 5/4.
fn largest(m: usize, p: u32) -> Interval {
    let turn = Interval::pi(p) * 2;
    let start = Interval::rational(&Rational::from((5, 2)), p);
    (1..=m).fold(start, |bound, i| bound * i as i64 / &turn).ceiling()
}

/// `b, b', ..., b^(last)` from b, at what is not 0: `x b^(n+1) = (1 - n - x) b^(n) - n b^(n-1) - sum of C(n, j) b^(j) b^(n-j)`, the
/// n-th derivative of `x b' = (1 - x) b - b^2`.
pub fn derivatives<V: Clone>(
    first: V,
    last: usize,
    product: impl Fn(&V, &V) -> V,
    sum: impl Fn(V, V, i64) -> V,
    step: impl Fn(i64, &V, V) -> V,
) -> Vec<V> {
    let mut all = vec![first];
    for n in 0..last {
        let mut binomial = 1_i64;
        let mut rest = product(&all[0], &all[n]);
        for j in 1..=n {
            binomial = binomial * (n + 1 - j) as i64 / j as i64;
            rest = sum(rest, product(&all[j], &all[n - j]), binomial);
        }
        if n > 0 {
            rest = sum(rest, all[n - 1].clone(), n as i64);
        }
        let next = step(1 - n as i64, &all[n], rest);
        all.push(next);
    }
    all
}

/// b^(k) where it is computed by division by x.
fn by_division(x: &Interval, b: Interval, k: usize) -> Interval {
    let step = |whole: i64, top: &Interval, rest: Interval| ((whole - x) * top - rest) / x;
    let all = derivatives(b, k, |a, b| a * b, |sum, a, factor| sum + a * factor, step);
    all.last().cloned().unwrap_or_else(|| x.clone())
}

/// b at a point that is not 0.
fn quotient(x: &Float, p: u32) -> Interval {
    let point = |x: &Float| Interval::point(&Float::with_val(p.max(x.prec()), x));
    if x.clone().abs() > FAR {
        // b(x) <= b(FAR) on the right, b(-x) = x + b(x) on the left.
        let small = Interval::int(0, p).hull(&quotient(&Float::with_val(64, FAR), p));
        return if *x > 0 { small } else { small - point(x) };
    }
    if !effort::elementary(p) {
        return Interval::undefined(p);
    }
    let less = |round| {
        let mut value = Float::with_val(p.max(x.prec()), x);
        value.exp_m1_round(round);
        value
    };
    point(x) / Interval::new(less(Round::Down), less(Round::Up))
}

/// Bits that are needed inside for a result of p bits: b itself is a quotient of two numbers that are met to rounding, and what b' loses
/// beyond that is a few bits, in one word with a result of doubles.
fn inside(p: u32, k: usize) -> u32 {
    match k {
        0 => p,
        1 => p + 10,
        _ => p + 24 + 8 * k as u32,
    }
}

/// b^(k) at a point: `b(-x) = b(x) + x`.
fn exprelr_at(x: &Float, k: usize, p: u32) -> Interval {
    let w = inside(p, k).max(x.prec());
    let at = Interval::point(&Float::with_val(w, x));
    if x.is_zero() || k > 0 && x.clone().abs() < 0.5 {
        return power_series(Function::Exprelr, k, &at);
    }
    if k == 0 || *x > 0 {
        return by_division(&at, quotient(x, w), k);
    }
    let other = by_division(&-at, quotient(&x.clone().abs(), w), k);
    match k {
        1 => Interval::int(-1, w) - other,
        _ if k % 2 == 1 => -other,
        _ => other,
    }
}

/// s^(k) at a point: `x s^(k) = (d/dx)^k sin x - k s^(k-1)`.
fn sinc_at(x: &Float, k: usize, p: u32) -> Interval {
    let w = inside(p, k + 1).max(x.prec());
    let at = Interval::point(&Float::with_val(w, x));
    if x.clone().abs() < 1 {
        return power_series(Function::Sinc, k, &at);
    }
    let (sin, cos) = (at.sin(), at.cos());
    let waves = [sin.clone(), cos.clone(), -sin, -cos];
    let first = &waves[0] / &at;
    (1..=k).fold(first, |before, m| (&waves[m % 4] - before * m as i64) / &at)
}

impl Interval {
    /// Between the value at one end and that at the other.
    fn across(low: &Interval, high: &Interval, p: u32) -> Interval {
        Interval::new(rounded(p, &*low.lo(), Round::Down), rounded(p, &*high.hi(), Round::Up))
    }

    /// The k-th derivative of `x/(e^x - 1)`, which is 1 at 0.
    pub fn exprelr(&self, k: u32) -> Interval {
        let (p, k) = (self.precision(), k as usize);
        if !self.is_defined() {
            return Interval::undefined(p);
        }
        // What it comes to at an infinite end, of 0 on the right.
        let at = |x: &Float, on_the_left: Interval| match (x.is_finite(), x.is_sign_negative()) {
            (true, _) => exprelr_at(x, k, p),
            (false, true) => on_the_left,
            (false, false) => Interval::int(0, p),
        };
        let (lo, hi) = (self.lo(), self.hi());
        match k {
            0 => {
                let everything = Interval::entire(p).max(&Interval::int(0, p));
                Interval::across(&at(&hi, everything.clone()), &at(&lo, everything), p)
            }
            1 => Interval::across(&at(&lo, Interval::int(-1, p)), &at(&hi, Interval::int(-1, p)), p),
            2 => {
                let size = self.abs();
                Interval::across(&at(&size.hi(), Interval::int(0, p)), &at(&size.lo(), Interval::int(0, p)), p)
            }
            _ => self.of_higher_order(k),
        }
    }

    /// That of an order above 2.
    fn of_higher_order(&self, k: usize) -> Interval {
        let p = self.precision();
        let all = about_zero(&largest(k, p));
        if !self.is_bounded() {
            return all;
        }
        let reach = self.half_width() * largest(k + 1, p);
        let near = exprelr_at(&self.middle().lo(), k, p) + about_zero(&reach);
        let common = all.intersect(&near.round(p));
        if !(self.is_positive() && *self.lo() >= 1) {
            return common;
        }
        // Where it is small, so is what the recurrence gives.
        let w = inside(p, k);
        let wide = self.round(w);
        let both = common.intersect(&by_division(&wide, wide.exprelr(0), k).round(p));
        if both.is_defined() { both } else { common }
    }

    /// The k-th derivative of `sin(x)/x`, which is 1 at 0.
    pub fn sinc(&self, k: u32) -> Interval {
        let (p, k) = (self.precision(), k as usize);
        if !self.is_defined() {
            return Interval::undefined(p);
        }
        let most = |m: usize| about_zero(&Interval::rational(&Rational::from((1, m + 1)), p));
        let size = self.abs();
        // |x s^(k)| <= 1 + k |s^(k-1)| <= 2.
        let far = Interval::int(2, p) / size.floor();
        let all = if far.is_defined() { most(k).intersect(&about_zero(&far)) } else { most(k) };
        if !self.is_bounded() {
            return all;
        }
        let (lo, hi) = (self.lo(), self.hi());
        let found = if self.is_point() {
            sinc_at(&lo, k, p)
        } else if k == 0 && *size.hi() <= 3 {
            Interval::across(&sinc_at(&size.hi(), 0, p), &sinc_at(&size.lo(), 0, p), p)
        } else {
            let (middle, reach) = (self.middle(), self.half_width());
            let next = sinc_at(&middle.lo(), k + 1, p) + about_zero(&(&reach / (k as i64 + 3)));
            let slope = next.round(p).intersect(&most(k + 1));
            match (slope.is_nonnegative(), slope.is_nonpositive()) {
                (true, _) => Interval::across(&sinc_at(&lo, k, p), &sinc_at(&hi, k, p), p),
                (_, true) => Interval::across(&sinc_at(&hi, k, p), &sinc_at(&lo, k, p), p),
                _ => sinc_at(&middle.lo(), k, p) + about_zero(&(slope.abs() * reach)),
            }
        };
        found.round(p).intersect(&all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rational(value: (i64, i64), p: u32) -> Interval {
        Interval::rational(&Rational::from(value), p)
    }

    #[test]
    fn bernoulli_numbers_are_the_known_ones() {
        let known = [
            (1, 1),
            (-1, 2),
            (1, 6),
            (0, 1),
            (-1, 30),
            (0, 1),
            (1, 42),
            (0, 1),
            (-1, 30),
            (0, 1),
            (5, 66),
            (0, 1),
            (-691, 2730),
        ];
        for (n, value) in known.into_iter().enumerate() {
            assert_eq!(bernoulli(n), Rational::from(value), "B_{n}");
        }
    }

    /// On both sides of where the way of computing changes, and where both ways serve.
    #[test]
    fn the_ways_of_computing_agree() {
        for numerator in [1, 7, 8, 9, 15, 16, 17, 40] {
            for sign in [1, -1] {
                let x = Float::with_val(64, sign * numerator) / 16u32;
                let at = Interval::point(&Float::with_val(400, &x));
                for k in 0..7 {
                    let divided = by_division(&at, quotient(&x, 400), k);
                    let found = exprelr_at(&x, k, 128);
                    assert!(found.intersect(&divided).is_defined(), "{k} at {x}: {found:?} {divided:?}");
                    assert!((found.ceiling() - found.floor()).hi().to_f64() < 1e-36, "{k} at {x}: {found:?}");
                }
            }
        }
    }

    #[test]
    fn known_values() {
        let zero = Interval::int(0, 128);
        for (k, value) in [(0, (1, 1)), (1, (-1, 2)), (2, (1, 6)), (3, (0, 1)), (4, (-1, 30))] {
            assert!(zero.exprelr(k).contains(&rational(value, 200)), "{k}");
        }
        for (k, value) in [(0, (1, 1)), (1, (0, 1)), (2, (-1, 3)), (3, (0, 1)), (4, (1, 5))] {
            assert!(zero.sinc(k).contains(&rational(value, 200)), "{k}");
        }
        // 1/(e - 1) and 1 + 1/(e - 1).
        let unit = Interval::between(&Rational::from(-1), &Rational::from(1), 64).exprelr(0);
        let ends = [unit.lo().to_f64(), unit.hi().to_f64()];
        assert!((ends[0] - 0.581_976_706_869_326_4).abs() < 1e-15 && (ends[1] - 1.581_976_706_869_326_4).abs() < 1e-15);
        assert!(!Interval::undefined(64).exprelr(0).is_defined() && !Interval::undefined(64).sinc(1).is_defined());
    }

    /// At enormous numbers and on half-lines.
    #[test]
    fn far_away() {
        for shift in [20, 25, 40, 1000] {
            let x = Interval::point(&(Float::with_val(64, 1) << shift));
            let right = x.exprelr(0);
            assert!(right.is_nonnegative() && *right.hi() < 1e-300, "{right:?}");
            let left = (-&x).exprelr(0);
            assert!(left.contains(&x) && (left.ceiling() - &x).hi().to_f64() < 1e-12 * x.hi().to_f64());
            assert!((-&x).exprelr(1).contains(&Interval::int(-1, 64)));
            for k in 0..5 {
                assert!(x.sinc(k).abs().le(&(Interval::int(2, 64) / &x).ceiling()) == Some(true));
                assert!(x.exprelr(k).is_bounded());
            }
        }
        let half = Interval::int(1, 64).hull(&Interval::entire(64).max(&Interval::int(1, 64)));
        assert!(*half.exprelr(0).lo() == 0 && *half.exprelr(0).hi() < 0.582);
        assert!(!(-&half).exprelr(0).is_bounded() && *(-&half).exprelr(0).lo() > 1.58);
        for k in 1..5 {
            assert!(
                (-&half).exprelr(k).is_bounded()
                    && half.sinc(k).is_bounded()
                    && Interval::entire(64).sinc(k).is_bounded()
            );
        }
    }
}
