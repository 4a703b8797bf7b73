//! The squared H-infinity norm k_2 = sup_w 1/|p(i w)|^2 of 1/p.

use super::{RelativeDegreeError, Routh, Undecided};
use rug::{Integer, Rational};
use sigmastar_exact::enclosure::{Enclosure, MAX_PRECISION};

/// Boxes split at most.
const MAX_SPLITS: usize = 4000;

/// The relative width of the minimum that ends the search, as a power of 2.
const TARGET: u32 = 60;

/// An enclosure of k_2, with int_0^T xi_1^2 <= k_2 int_0^T e^2 for T-periodic signals (derivation, section 6).
///
/// `f(W) = |p(i sqrt W)|^2` is a polynomial in W = w^2 with exact rational coefficients, monic of degree r - 1, with
/// f(0) = a_1^2; k_2 = 1/min f over W >= 0. A Hurwitz p makes f positive there. The minimum is
/// * at W = 0, and k_2 = 1/a_1^2 exactly, if no coefficient of f is negative;
/// * else on [0, R] with R the root-size bound of (f - f(0))/W: beyond it f > f(0). On [0, R] by bisection in
///   Bernstein form and exact integer arithmetic: f lies on a box between its least and greatest Bernstein
///   coefficient, the first and the last of which are its values at the ends. A box is discarded when no coefficient
///   is below the least value found so far, or when the coefficients are monotone (then so is f).
///
/// # Guarantee
/// The enclosure contains k_2. Its relative width is about 2^-60 (or 2^-`precision`, if that is larger) except for
/// polynomials with roots so close to the imaginary axis that the effort ends before.
///
/// # Errors
/// [`RelativeDegreeError::Count`] and [`RelativeDegreeError::NotHurwitz`] for unusable coefficients,
/// [`RelativeDegreeError::Undecided`] when no positive lower bound of f was found.
pub fn k_2(a: &[Rational], precision: u32) -> Result<Enclosure, RelativeDegreeError> {
    Routh::new(a)?;
    let output = precision.clamp(64, MAX_PRECISION);
    let f = squared_modulus(a);
    if f.iter().all(|coefficient| *coefficient >= 0) {
        let at_zero = Rational::from(a[0].square_ref());
        return Ok(Enclosure::from_rational(&at_zero.recip(), output));
    }
    let end = search_exponent(&f).ok_or(RelativeDegreeError::Undecided(Undecided::TimeScales))?;
    let (lower, upper) = minimum(&f, end);
    if lower > 0 {
        Ok(Enclosure::between(&upper.recip(), &lower.recip(), output))
    } else {
        Err(RelativeDegreeError::Undecided(Undecided::Resonance))
    }
}

/// The coefficients of |p(i w)|^2 in powers of W = w^2, from the constant term up.
///
/// With p(i w) = E(W) + i w O(W), E(W) = sum (-W)^k p_{2k}, O(W) = sum (-W)^k p_{2k+1}: f = E^2 + W O^2.
pub(super) fn squared_modulus(a: &[Rational]) -> Vec<Rational> {
    let one = Rational::from(1);
    let signed = |(k, c): (usize, &Rational)| if k % 2 == 0 { c.clone() } else { Rational::from(-c) };
    let coefficients: Vec<&Rational> = a.iter().chain([&one]).collect();
    let even: Vec<Rational> = coefficients.iter().step_by(2).copied().enumerate().map(signed).collect();
    let odd: Vec<Rational> = coefficients.iter().skip(1).step_by(2).copied().enumerate().map(signed).collect();
    let mut f = vec![Rational::new(); a.len() + 1];
    for (part, shift) in [(&even, 0), (&odd, 1)] {
        for (i, x) in part.iter().enumerate() {
            for (j, y) in part.iter().enumerate() {
                f[i + j + shift] += Rational::from(x * y);
            }
        }
    }
    f
}

/// An exponent k with f(W) > f(0) for all W >= 2^k; `None` when it is out of range or f has no negative coefficient.
///
/// `(f - f(0))/W = W^{n-1} + ... + f_1`; with |f_j| <= (R/2)^{n-j} for 1 <= j < n the lower terms are at W >= R
/// together at most (1/2 + 1/4 + ... ) W^{n-1} < W^{n-1}. Only negative f_j matter.
fn search_exponent(f: &[Rational]) -> Option<i32> {
    let n = f.len() - 1;
    let mut exponent = i64::MIN;
    for (j, coefficient) in f.iter().enumerate().take(n).skip(1).filter(|(_, c)| **c < 0) {
        // |coefficient| < 2^bits
        let bits =
            i64::from(coefficient.numer().significant_bits()) - i64::from(coefficient.denom().significant_bits()) + 1;
        let order = (n - j) as i64;
        exponent = exponent.max(bits.div_euclid(order) + 2);
    }
    i32::try_from(exponent).ok().filter(|exponent| exponent.abs() < 1 << 24)
}

/// f(2^end t) on 0 <= t <= 1 in Bernstein form: integers c_0, ..., c_n and a factor > 0 with
/// `factor f(2^end t) = sum c_i binomial(n, i) t^i (1-t)^{n-i}`.
///
/// From the power form `sum d_j t^j`: `c_i = sum_{j <= i} d_j binomial(i, j)/binomial(n, j)`.
fn bernstein(f: &[Rational], end: i32) -> (Vec<Integer>, Rational) {
    let n = f.len() - 1;
    let binomial = |n: usize, j: usize| Integer::from(Integer::binomial_u(n as u32, j as u32));
    let shifted = |(j, c): (usize, &Rational)| {
        // j <= MAX_COEFFICIENTS and |end| < 2^24, so the product fits.
        let shift = end * j as i32;
        (if shift >= 0 { Rational::from(c << shift) } else { Rational::from(c >> -shift) }) / binomial(n, j)
    };
    let ratios: Vec<Rational> = f.iter().enumerate().map(shifted).collect();
    let factor = ratios.iter().fold(Integer::from(1), |l, x| l.lcm(x.denom()));
    let whole: Vec<Integer> = ratios.iter().map(|x| x.numer() * Integer::from(&factor / x.denom())).collect();
    let coefficient = |i: usize| (0..=i).map(|j| &whole[j] * binomial(i, j)).sum::<Integer>();
    ((0..=n).map(coefficient).collect(), Rational::from(factor))
}

/// The Bernstein coefficients on the two halves, multiplied by 2^n (de Casteljau without divisions).
fn halves(coefficients: &[Integer]) -> (Vec<Integer>, Vec<Integer>) {
    let n = coefficients.len() - 1;
    let mut row = coefficients.to_vec();
    let (mut left, mut right) = (Vec::with_capacity(n + 1), Vec::with_capacity(n + 1));
    for step in 0..=n {
        // The row holds 2^step times the de Casteljau row of this step; both of its ends are wanted.
        let shift = (n - step) as u32;
        left.push(Integer::from(&row[0] << shift));
        right.push(Integer::from(&row[n - step] << shift));
        for i in 0..n - step {
            let (head, tail) = row.split_at_mut(i + 1);
            head[i] += &tail[0];
        }
    }
    right.reverse();
    (left, right)
}

/// Bounds of min f over W >= 0, exactly: the second is a value of f. `2^end` bounds the search as above.
fn minimum(f: &[Rational], end: i32) -> (Rational, Rational) {
    let n = (f.len() - 1) as u32;
    let (whole, mut factor) = bernstein(f, end);
    let ends = |c: &[Integer]| Integer::from((&c[0]).min(&c[c.len() - 1]));
    let mut least = ends(&whole);
    let mut open = vec![whole];
    let mut splits = 0;
    loop {
        // All open boxes have the same depth, and so the same factor. What has been discarded lies above `least`.
        for c in &open {
            least = least.min(ends(c));
        }
        open.retain(|c| {
            let increasing = c.windows(2).all(|pair| pair[0] <= pair[1]);
            let decreasing = c.windows(2).all(|pair| pair[0] >= pair[1]);
            !increasing && !decreasing && c.iter().any(|x| *x < least)
        });
        let lower = open.iter().flatten().min().unwrap_or(&least);
        let width = Integer::from(&least - lower);
        if width <= Integer::from(lower >> TARGET) || splits > MAX_SPLITS {
            return (Rational::from(lower) / &factor, Rational::from(&least) / &factor);
        }
        splits += open.len();
        open = open.iter().flat_map(|c| <[Vec<Integer>; 2]>::from(halves(c))).collect();
        least <<= n;
        factor <<= n;
    }
}
