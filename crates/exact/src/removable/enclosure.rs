//! Values over intervals.

use super::{Family, downward, mirrored, of_reciprocal, upward};
use crate::enclosure::Enclosure;
use rug::float::Special;
use rug::{Float, Integer, Rational};
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// Terms of a Taylor polynomial at most; the rest is bounded in any case.
const MAX_TERMS: usize = 300;

/// Bits beyond the precision of the result: the ladders lose those of k! and a few more.
fn precision_inside(precision: u32, order: usize) -> u32 {
    let order = order as u32 + 1;
    precision + 40 + order * (u32::BITS - order.leading_zeros())
}

/// `[-r, r]` for a magnitude.
fn around_zero(magnitude: &Enclosure) -> Enclosure {
    magnitude.negate().hull(magnitude)
}

fn ratio(numerator: i64, denominator: usize, precision: u32) -> Enclosure {
    Enclosure::from_rational(&Rational::from((numerator, denominator)), precision)
}

/// Whether a number is near enough to 0 for Taylor's polynomial.
fn is_near(x: &Float) -> bool {
    x.get_exp().is_none_or(|exponent| exponent <= 0)
}

/// `I_last` at a point with |x| < 1, by so many terms that nothing is left of the rest.
fn top(family: Family, x: &Enclosure, last: usize, bound: i64) -> Enclosure {
    let size = x.abs();
    with_rest(family, x, last, bound, terms_for(&size))
}

/// A number J of terms, at most [`MAX_TERMS`], with `s^J/J!` far below the last digit of a size s below 1 where there is one.
fn terms_for(size: &Enclosure) -> usize {
    let bits = f64::from(size.precision() + 8);
    let of_size = -libm::log2(size.upper_f64());
    let (mut below, mut terms) = (of_size, 1);
    while below <= bits && terms < MAX_TERMS {
        terms += 1;
        below += of_size + libm::log2(terms as f64);
    }
    terms
}

/// `I_(k+j)(0)/j!` for j = 0, 1, ..., [`MAX_TERMS`] - 1, and `1/j!` for one more, at a precision.
struct Coefficients {
    of_powers: Vec<Enclosure>,
    factorials: Vec<Enclosure>,
}

type Known = HashMap<(Family, usize, u32), Arc<Coefficients>>;

/// Those of a family and an order k, made once for each precision.
fn coefficients(family: Family, k: usize, precision: u32) -> Arc<Coefficients> {
    static KNOWN: LazyLock<Mutex<Known>> = LazyLock::new(Mutex::default);
    // Whoever panics while he holds the lock has changed nothing but whole entries.
    let lock = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = lock().get(&(family, k, precision)) {
        return known.clone();
    }
    let next = |(j, factorial): &(i64, Enclosure)| Some((j + 1, factorial / (j + 1)));
    let all = std::iter::successors(Some((0, Enclosure::one(precision))), next);
    let factorials: Vec<Enclosure> = all.take(MAX_TERMS + 1).map(|(_, factorial)| factorial).collect();
    let own = |(j, factorial): (usize, &Enclosure)| factorial * family.sign(k + j) / (k + j + 1) as i64;
    let of_powers = factorials.iter().take(MAX_TERMS).enumerate().map(own).collect();
    let made = Arc::new(Coefficients { of_powers, factorials });
    lock().insert((family, k, precision), made.clone());
    made
}

/// `I_last(x)` by J terms of its series: the rest is `I_(last+J)(xi) x^J/J!`, and `|I_m| <= bound/(m + 1)`.
fn with_rest(family: Family, x: &Enclosure, last: usize, bound: i64, terms: usize) -> Enclosure {
    let known = coefficients(family, last, x.precision());
    let zero = Enclosure::zero(x.precision());
    let sum = known.of_powers[..terms].iter().rev().fold(zero, |sum, own| sum * x + own);
    let power = x.abs().pow_integer(&Integer::from(terms)) * &known.factorials[terms];
    sum + around_zero(&(power * bound / (last + terms + 1) as i64))
}

/// `S_0, ..., S_last` at a point.
fn waves(x: &Enclosure, last: usize) -> Vec<Enclosure> {
    let [cos, sin] = x.cos_sin();
    let ends = [sin.clone(), cos.clone(), sin.negate(), cos.negate()];
    if is_near(&x.upper()) {
        downward(x, top(Family::Wave, x, last, 1), &ends, last)
    } else {
        upward(x, &sin, &ends, last)
    }
}

/// `E_0, ..., E_last` at a point, times `e^-x` where they are `scaled`.
fn exponentials(x: &Enclosure, last: usize, scaled: bool) -> Vec<Enclosure> {
    let one = Enclosure::one(x.precision());
    let exp = if scaled { x.negate().exp() } else { x.exp() };
    let (end, start) = if scaled { (one.clone(), &one - &exp) } else { (exp.clone(), &exp - &one) };
    let ends = [(); 4].map(|()| end.clone());
    if is_near(&x.upper()) {
        // e < 3.
        let top = top(Family::Exponential, x, last, 3);
        downward(x, if scaled { top * exp } else { top }, &ends, last)
    } else {
        upward(x, &start, &ends, last)
    }
}

/// A point at a precision at which it is exact.
fn point(x: &Float, precision: u32) -> Enclosure {
    Enclosure::point(&Float::with_val(precision.max(x.prec()), x))
}

/// The derivative of order k of `x/(e^x - 1)` at a point.
fn exprelr_at(x: &Float, k: usize, precision: u32) -> Enclosure {
    let negative = x.is_sign_negative();
    let y = point(&x.clone().abs(), precision_inside(precision, k));
    let one = Enclosure::one(y.precision());
    let at_y = y.negate().exp() * of_reciprocal(&exponentials(&y, k, true), &one);
    mirrored(k, &y, at_y, negative)
}

/// The most that a derivative of order k of `x/(e^x - 1)` is in magnitude, `2 k! zeta(k)/(2 pi)^k`, with zeta(2) < 5/3 and
/// zeta(k) < 5/4 from 3 on.
fn largest_exprelr(k: usize, precision: u32) -> Enclosure {
    let turn = Enclosure::pi(precision) * 2;
    let start = if k == 2 { ratio(10, 3, precision) } else { ratio(5, 2, precision) };
    (1..=k).fold(start, |bound, i| bound * i as i64 / &turn).ceiling()
}

impl Enclosure {
    /// The middle, and an upper bound of how far the others are from it.
    fn middle(&self, precision: u32) -> (Float, Enclosure) {
        let sum = Float::with_val(precision, &self.lower() + &self.upper());
        let middle = sum / 2u32;
        let reach = (self.at_precision(precision) - point(&middle, precision)).abs().ceiling();
        (middle, reach)
    }

    /// From the smaller end of the first to the larger end of the second.
    fn from_to(low: &Enclosure, high: &Enclosure, precision: u32) -> Enclosure {
        Enclosure::new(low.lower(), high.upper()).at_precision(precision)
    }

    /// The derivative of an order of `b(x) = x/(e^x - 1)` with `b(0) = 1`: `exprelr` of the expressions.
    ///
    /// Formula: derivation, 11.7. b is positive and decreases, b' increases from -1 to 0, b'' is even and decreases with |x|; these
    /// three are enclosed by their values at ends. A higher one is that in the middle, give or take the half-width times the most
    /// that the next one is. Guarantee: as of every operation; defined wherever the interval is.
    #[must_use]
    pub fn exprelr(&self, order: u32) -> Enclosure {
        let (p, k) = (self.precision(), order as usize);
        if !self.is_defined() {
            return Enclosure::undefined(p);
        }
        let at = |x: &Float| exprelr_at(x, k, p);
        // A half-line has the limit at its infinite end.
        let [lower, upper] = [self.lower(), self.upper()];
        match k {
            0 => {
                let low = if upper.is_finite() { at(&upper) } else { Enclosure::zero(p) };
                let high = if lower.is_finite() { at(&lower) } else { Enclosure::entire(p) };
                Enclosure::from_to(&low, &high, p)
            }
            1 => {
                let low = if lower.is_finite() { at(&lower) } else { Enclosure::from_integer(-1, p) };
                let high = if upper.is_finite() { at(&upper) } else { Enclosure::zero(p) };
                Enclosure::from_to(&low, &high, p)
            }
            2 => {
                let size = self.abs();
                let low = if size.upper().is_finite() { at(&size.upper()) } else { Enclosure::zero(p) };
                Enclosure::from_to(&low, &at(&size.lower()), p)
            }
            _ => {
                let bound = around_zero(&largest_exprelr(k, p));
                if !self.is_bounded() {
                    return bound;
                }
                let inside = precision_inside(p, k);
                let (middle, reach) = self.middle(inside);
                let around = exprelr_at(&middle, k, p) + around_zero(&(reach * largest_exprelr(k + 1, inside)));
                around.intersect(&bound).at_precision(p)
            }
        }
    }

    /// The derivative of an order of `sin(x)/x`, 1 at 0: `sinc` of the expressions, which is the unnormalised one.
    ///
    /// Formula: derivation, 11.7. `|S_k| <= 1/(k + 1)`, and `|S_k(x)| <= 2/|x|`. sinc decreases with |x| up to pi; any S_k is monotone
    /// where S_(k+1) has a sign, and otherwise within the half-width times S_(k+1) of its value in the middle. Guarantee: as of every
    /// operation; defined wherever the interval is.
    #[must_use]
    pub fn sinc(&self, order: u32) -> Enclosure {
        let (p, k) = (self.precision(), order as usize);
        if !self.is_defined() {
            return Enclosure::undefined(p);
        }
        let most = |k: usize| around_zero(&ratio(1, k + 1, p).ceiling());
        let size = self.abs();
        let far =
            if size.is_positive().is_true() { around_zero(&(size.floor().recip() * 2).ceiling()) } else { most(k) };
        let bound = most(k).intersect(&far);
        if !self.is_bounded() {
            return bound;
        }
        let inside = precision_inside(p, k + 1);
        let at = |x: &Float| waves(&point(x, inside), k + 1);
        if k == 0 && size.upper() <= 3 {
            return Enclosure::from_to(&at(&size.upper())[0], &at(&size.lower())[0], p).intersect(&bound);
        }
        let (middle, reach) = self.middle(inside);
        let centre = at(&middle);
        if self.is_exact() {
            return centre[k].at_precision(p);
        }
        let slope = &centre[k + 1] + around_zero(&(&reach / (k as i64 + 3)));
        let slope = slope.intersect(&around_zero(&ratio(1, k + 2, inside).ceiling()));
        let rises = slope.is_nonnegative().is_true();
        if rises || slope.negate().is_nonnegative().is_true() {
            let [first, last] = [self.lower(), self.upper()].map(|end| at(&end)[k].clone());
            let (low, high) = if rises { (first, last) } else { (last, first) };
            return Enclosure::from_to(&low, &high, p).intersect(&bound);
        }
        // On both sides of the middle by at most |S_(k+1)| times the half-width.
        (&centre[k] + around_zero(&(slope.abs() * reach).ceiling())).at_precision(p).intersect(&bound)
    }

    /// `E_0, ..., E_last`, the derivatives of `(e^x - 1)/x` up to an order: integrals of what is positive and increases with x.
    ///
    /// Guarantee: as of every operation; defined wherever the interval is.
    #[must_use]
    pub fn exprel_derivatives(&self, last: usize) -> Vec<Enclosure> {
        let p = self.precision();
        if !self.is_defined() {
            return vec![Enclosure::undefined(p); last + 1];
        }
        let inside = precision_inside(p, last);
        let at = |x: &Float, otherwise: Enclosure| {
            let finite = x.is_finite();
            let all = if finite { exponentials(&point(x, inside), last, false) } else { Vec::new() };
            // Where e^x has overflown nothing but the sign is known.
            let known = |value: Enclosure| if value.is_defined() { value } else { otherwise.clone() };
            if finite { all.into_iter().map(known).collect() } else { vec![otherwise.clone(); last + 1] }
        };
        let [zero, most] = [Float::new(p), Float::with_val(p, Special::Infinity)];
        let positive = Enclosure::new(zero, most);
        let (low, high): (Vec<_>, Vec<_>) = (at(&self.lower(), positive.clone()), at(&self.upper(), positive.clone()));
        low.iter().zip(&high).map(|(low, high)| Enclosure::from_to(low, high, p).intersect(&positive)).collect()
    }

    /// `S_0, ..., S_last`, the derivatives of `sin(x)/x` up to an order.
    #[must_use]
    pub fn sinc_derivatives(&self, last: usize) -> Vec<Enclosure> {
        (0..=last as u32).map(|order| self.sinc(order)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::enclosure::Truth;
    use rug::float::Round;

    /// Points of every size, and their opposites.
    fn points() -> Vec<Float> {
        let sizes = [-1100, -300, -130, -60, -53, -20, -7, -2, -1, 0, 1, 2, 3, 4, 6, 9, 12, 40, 300, 1100];
        let scaled =
            sizes.into_iter().flat_map(|shift| [1.0, 1.37, -1.0, -1.81].map(|m| Float::with_val(53, m) << shift));
        scaled.chain([0.0, 3.0, -3.0, 3.2, 4.4934, 5.7635].map(|x| Float::with_val(53, x))).collect()
    }

    /// The formulas as they are written, in plain MPFR arithmetic at a precision at which nothing cancels; as the limit at 0.
    fn reference(wave: bool, x: &Float, order: usize) -> Float {
        let bits = 700 + 3 * x.get_exp().unwrap_or(0).unsigned_abs() * (order as u32 + 1);
        if x.is_zero() {
            let [wave_at_0, other] = [[1.0, 0.0, -1.0 / 3.0, 0.0, 0.2], [1.0, -0.5, 1.0 / 6.0, 0.0, -1.0 / 30.0]];
            return Float::with_val(bits, if wave { wave_at_0[order] } else { other[order] });
        }
        let x = Float::with_val(bits, x);
        // x f = d, so x f^(k) = d^(k) - k f^(k-1); and (e^x - 1) b = x, so (e^x - 1) b^(k) = x^(k) - sum C(k, j) e^x b^(k-j).
        let mut all: Vec<Float> = Vec::new();
        let (sin, cos) = if wave { x.clone().sin_cos(Float::new(bits)) } else { (Float::new(bits), Float::new(bits)) };
        let (exp, less) = if wave { (x.clone(), x.clone()) } else { (x.clone().exp(), x.clone().exp_m1()) };
        for k in 0..=order {
            let next = if wave {
                let end = [sin.clone(), cos.clone(), -sin.clone(), -cos.clone()][k % 4].clone();
                if k == 0 { end / &x } else { (end - all[k - 1].clone() * k as u32) / &x }
            } else {
                let own = [x.clone(), Float::with_val(bits, 1)].into_iter().nth(k).unwrap_or_else(|| Float::new(bits));
                let mut binomial = 1u32;
                let rest = (1..=k).fold(own, |rest, j| {
                    binomial = binomial * (k - j + 1) as u32 / j as u32;
                    rest - exp.clone() * &all[k - j] * binomial
                });
                rest / &less
            };
            all.push(next);
        }
        all[order].clone()
    }

    /// A relative distance far below the last digit, for what the reference itself has rounded.
    fn contains(enclosure: &Enclosure, value: &Float) -> bool {
        let slack = Float::with_val(64, value.abs_ref()) >> 400;
        let low = Float::with_val_round(value.prec(), value - &slack, Round::Down).0;
        let high = Float::with_val_round(value.prec(), value + &slack, Round::Up).0;
        enclosure.lower() <= high && low <= enclosure.upper()
    }

    #[test]
    fn points_are_enclosed_tightly() {
        for (x, wave, order) in points().iter().flat_map(|x| (0..10).map(move |i| (x, i % 2 == 0, i / 2))) {
            let size = Float::with_val(53, x.abs_ref());
            // Sines of enormous numbers are not computed, and their exponentials are 0 or infinite as far as anybody can see.
            let sized = size < if wave { 1e30 } else { 1e5 };
            let value = sized.then(|| reference(wave, x, order as usize));
            for precision in [53, 64, 128, 200] {
                let at = Enclosure::point(&Float::with_val(precision, x));
                let found = if wave { at.sinc(order) } else { at.exprelr(order) };
                let words = format!("{wave} {order} at {x}, {precision}: {found:?}");
                assert!(found.is_defined(), "{words}");
                if let Some(value) = &value {
                    // The table at 0 is of doubles.
                    let near = x.is_zero() && (found.midpoint_f64() - value.to_f64()).abs() < 1e-15;
                    assert!(near || contains(&found, value), "{words}, {value:.20}");
                }
                // Of what is 0 at 0 and no more than a rest, digits count from the point.
                let least = Float::with_val(64, 1) >> if order < 3 { precision } else { 0 };
                let width = Float::with_val(64, found.upper() - found.lower());
                let scale = Float::with_val(64, found.abs().upper()).max(&least);
                assert!(!sized || width <= (scale >> (precision - 3)), "{words}");
            }
        }
    }

    /// Intervals contain the values at their points; where 0 is in them, at an end, or beside them.
    #[test]
    fn intervals_contain_their_points() {
        let places = points();
        for (i, a) in places.iter().enumerate() {
            for b in places.iter().skip(i % 17).step_by(17) {
                let (low, high) = if a <= b { (a, b) } else { (b, a) };
                let whole = Enclosure::new(low.clone(), high.clone());
                for order in 0..5 {
                    let found = [whole.sinc(order), whole.exprelr(order)];
                    for part in 0..=6_u32 {
                        let inside = low.clone() + Float::with_val(60, high - low) * part / 6u32;
                        let inside = Enclosure::point(&inside.clamp(low, high));
                        for (found, at) in found.iter().zip([inside.sinc(order), inside.exprelr(order)]) {
                            let apart = found.lower() > at.upper() || at.lower() > found.upper();
                            assert!(!apart, "{low} to {high}, {order}: {found:?} without {at:?}");
                        }
                    }
                }
            }
        }
        // As tight as can be: 1/(e - 1) and 1 + 1/(e - 1); sin 1 and 1; where sinc turns.
        let unit = Enclosure::between(&Rational::from(-1), &Rational::from(1), 128);
        let near = |found: Enclosure, ends: [f64; 2]| {
            let found = [found.lower().to_f64(), found.upper().to_f64()];
            assert!(found.iter().zip(ends).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
        };
        near(unit.exprelr(0), [0.581_976_706_869_326_4, 1.581_976_706_869_326_4]);
        near(unit.sinc(0), [0.841_470_984_807_896_5, 1.0]);
        near(Enclosure::zero(64).exprelr(1), [-0.5, -0.5]);
        let turn = Enclosure::between(&Rational::from((449, 100)), &Rational::from((45, 10)), 64).sinc(0);
        assert!(turn.lower() < -0.2172 && turn.lower() > -0.21725 && turn.upper() < -0.2172, "{turn:?}");
    }

    /// What the enclosures rest on, on a grid: signs and directions of the first three, and the bounds of the others.
    #[test]
    fn derivatives_are_bounded_as_is_said() {
        let mut before: Option<[Enclosure; 3]> = None;
        for step in -60..=60_i64 {
            let x = ratio(step, 4, 96);
            let b = [0, 1, 2].map(|order| x.exprelr(order));
            assert_eq!(b[0].is_positive(), Truth::True);
            assert_eq!(b[2].is_positive(), Truth::True);
            if let Some(before) = before {
                assert!(b[0].lt(&before[0]).is_true() && before[1].lt(&b[1]).is_true());
                assert_eq!(b[2].lt(&before[2]).is_true(), step > 0);
            }
            for order in 2..8 {
                assert!(x.exprelr(order).abs().le(&largest_exprelr(order as usize, 96)).is_true(), "{step} {order}");
                assert!(!x.sinc(order).abs().gt(&ratio(1, order as usize + 1, 96)).is_true(), "{step} {order}");
            }
            before = Some(b);
        }
    }

    /// Few terms leave a rest that is seen: it is not too small, and not much too large.
    #[test]
    fn the_rest_is_what_is_left_out() {
        for (numerator, last, terms) in (-15..=15).flat_map(|n| (0..20).map(move |i| (n, i % 4, 1 + i / 4))) {
            let x = ratio(numerator, 16, 200);
            let power = (1..=terms).fold(Enclosure::one(200), |power, j| power * x.abs() / j as i64);
            for (family, bound) in [(Family::Exponential, 3), (Family::Wave, 1)] {
                let found = with_rest(family, &x, last, bound, terms);
                let value = top(family, &x, last, bound);
                assert!(
                    found.lower() <= value.upper() && value.lower() <= found.upper(),
                    "{family:?} {numerator} {last} {terms}"
                );
                let most = 6.0 * power.upper_f64() + 1e-30;
                assert!((found.upper() - found.lower()).to_f64() <= most, "{family:?} {numerator} {last} {terms}");
            }
        }
    }

    #[test]
    fn half_lines_and_what_is_undefined() {
        let end = |special| Float::with_val(64, special);
        let right = Enclosure::new(Float::with_val(64, 1), end(Special::Infinity));
        let left = Enclosure::new(end(Special::NegInfinity), Float::with_val(64, -1));
        let b = right.exprelr(0);
        assert!(b.lower() == 0 && b.upper() < 0.582);
        let b = left.exprelr(0);
        assert!(b.lower() > 1.58 && b.upper().is_infinite());
        for order in 0..5 {
            for half in [&left, &right] {
                assert!(half.sinc(order).is_bounded());
                assert!(order == 0 || half.exprelr(order).is_bounded());
                assert_eq!(half.exprel_derivatives(order as usize).len(), order as usize + 1);
            }
            assert!(!Enclosure::undefined(64).sinc(order).is_defined());
            assert!(!Enclosure::undefined(64).exprelr(order).is_defined());
        }
        assert!(!Enclosure::undefined(64).exprel_derivatives(2)[1].is_defined());
    }

    /// `E_k` at both ends of an interval against the series with exact coefficients, and `E_0 b = 1`.
    #[test]
    fn derivatives_of_exprel() {
        for x in points().iter().filter(|x| Float::with_val(53, x.abs_ref()) < 50) {
            let all = Enclosure::point(x).at_precision(128).exprel_derivatives(12);
            for (k, value) in all.iter().enumerate() {
                let exact = point(x, 4000);
                let (mut term, mut sum) = (Enclosure::one(4000), Enclosure::zero(4000));
                for j in 0..400 {
                    sum = sum + &term / (k as i64 + j + 1);
                    term = term * &exact / (j + 1);
                }
                assert!(value.lower() <= sum.upper() && sum.lower() <= value.upper(), "{k} at {x}: {value:?}");
                let width = (value.upper() - value.lower()) / value.upper();
                assert!(width < 1e-36, "{k} at {x}: {value:?}");
            }
            let product = &all[0] * Enclosure::point(x).at_precision(128).exprelr(0);
            assert!(product.contains(&Rational::from(1)), "{x}");
        }
    }
}
