//! Rigorous sums of powers, `sum_{l >= first} l^-p`, by the Euler-Maclaurin formula.

use rug::Float;
use rug::float::Round;
use rug::ops::Pow;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::bernoulli_over_factorial;

/// Bits carried beyond the precision that is asked for: they absorb the rounding of some hundred operations and, for
/// exponents down to 1 + 2^-40, the cancellation in `p - 1`.
const GUARD_BITS: u32 = 64;

/// An enclosure of `sum_{l >= first} l^-p`, rounded outward to `precision` bits.
///
/// Hypotheses: `first >= 1` and p > 1, proved by the enclosure of p; the result is undefined otherwise. It holds for
/// every p in the enclosure. For a p known to more than `precision` + 64 bits the relative width is about
/// 2^-precision. The cost is bounded by a few times `precision` powers, whatever `first` and p.
///
/// # Method
/// With f(x) = x^-p and any N >= `first` the terms below N are added one by one, and
///
/// `sum_{l >= N} f(l) = N^(1-p)/(p-1) + f(N)/2 - sum_{k=1}^{K} B_2k/(2k)! f^(2k-1)(N) + R_K`.
///
/// f is completely monotone ((-1)^j f^(j) > 0 on x > 0 for every j) and all its derivatives vanish at infinity, so
/// the formula is enveloping: R_K has the sign of the first omitted term (that of index K + 1) and is at most that
/// term in magnitude. Hence R_K lies between 0 and that term, for *every* K and N: their choice is a matter of
/// width, never of soundness. The result is intersected with the integral test,
/// `first^-p <= sum <= first^-p (1 + first/(p-1))`, which is the better one for very large p.
#[must_use]
pub fn power_tail(first: u64, exponent: &Enclosure, precision: u32) -> Enclosure {
    let work = precision.max(exponent.precision()).saturating_add(GUARD_BITS);
    if first == 0 || !exponent.is_bounded() || !Enclosure::one(2).lt(exponent).is_true() {
        return Enclosure::undefined(precision);
    }
    // The sum decreases in p, so its extremes are at the ends of the enclosure.
    let at = |p: &Float| {
        // Exact: `work` exceeds the precision of the exponent and the bits of `first`. From N = work/8 on, the
        // corrections shrink to 2^-work within about work/5 terms, for moderate p.
        let (p, first) = (Float::with_val(work, p), Float::with_val(work, first));
        euler_maclaurin(&first, &p, work / 8 + 16, work as usize / 5 + 8).intersect(&integral_test(&first, &p))
    };
    let smallest = at(&exponent.upper());
    let largest = if exponent.is_exact() { smallest.clone() } else { at(&exponent.lower()) };
    Enclosure::new(
        Float::with_val_round(precision, smallest.lower(), Round::Down).0,
        Float::with_val_round(precision, largest.upper(), Round::Up).0,
    )
}

/// `n^-p`: two correctly rounded powers, which is cheaper than the general power of two intervals.
fn inverse_power(n: &Float, p: &Float) -> Enclosure {
    let minus_p = Float::with_val(p.prec(), -p);
    let rounded = |round| Float::with_val_round(p.prec(), Pow::pow(n, &minus_p), round).0;
    Enclosure::new(rounded(Round::Down), rounded(Round::Up))
}

/// `first^-p <= sum <= first^-p + int_first^oo x^-p dx`.
fn integral_test(first: &Float, p: &Float) -> Enclosure {
    let leading = inverse_power(first, p);
    let upper = &leading * &(1 + Enclosure::point(first) / (Enclosure::point(p) - 1));
    leading.hull(&upper)
}

/// The sum by the formula with N = max(`first`, `start`) and K < `corrections`, which is at least 1; at the precision
/// of p.
fn euler_maclaurin(first: &Float, p: &Float, start: u32, corrections: usize) -> Enclosure {
    let work = p.prec();
    let mut sum = Enclosure::zero(work);
    let mut last = first.clone();
    while last < start {
        sum = sum + inverse_power(&last, p);
        // Exact: small integers.
        last += 1;
    }
    let value = inverse_power(&last, p);
    let (n, p) = (&Enclosure::point(&last), &Enclosure::point(p));
    sum = sum + &value * n / (p - 1) + &value / 2;

    // The correction of index k is B_2k/(2k)! p (p+1) ... (p+2k-2) n^(-p-2k+1). At every turn of the loop `omitted` is
    // the first one that is not in the sum.
    let n_squared = n.sqr();
    let mut rising = &value * p / n;
    let mut omitted = &rising / 12;
    for (index, bernoulli) in bernoulli_over_factorial(corrections).iter().enumerate().skip(1) {
        if negligible(&omitted.abs(), &sum, work) {
            break;
        }
        let k2 = 2 * index as i64;
        rising = rising * (p + (k2 - 1)) * (p + k2) / &n_squared;
        let next = Enclosure::from_rational(bernoulli, work) * &rising;
        if !next.abs().lt(&omitted.abs()).is_true() {
            break;
        }
        sum = sum + &omitted;
        omitted = next;
    }
    sum + omitted.hull(&Enclosure::zero(work))
}

/// Whether a term is below the last bits of the sum: adding more of them would not make the result narrower.
fn negligible(term: &Enclosure, sum: &Enclosure, work: u32) -> bool {
    let scaled = Float::with_val_round(work, sum.lower() >> work, Round::Down).0;
    term.upper() <= scaled
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rug::Rational;

    fn exponent(numerator: i64, denominator: i64) -> Enclosure {
        Enclosure::from_rational(&Rational::from((numerator, denominator)), 320)
    }

    /// MPFR's zeta at an exactly represented argument, correctly rounded both ways: a second opinion.
    fn zeta(p: &Float, precision: u32) -> Enclosure {
        let rounded = |round| Float::with_val_round(precision, p.zeta_ref(), round).0;
        Enclosure::new(rounded(Round::Down), rounded(Round::Up))
    }

    fn relative_width(x: &Enclosure) -> f64 {
        let width = Float::with_val_round(64, x.upper() - x.lower(), Round::Up).0;
        Float::with_val_round(64, &width / x.lower(), Round::Up).0.to_f64()
    }

    #[test]
    fn agrees_with_zeta_and_is_narrow() {
        for (numerator, denominator) in
            [(3, 2), (1_000_001, 1_000_000), (2, 1), (3, 1), (5, 4), (21, 20), (5, 2), (10, 1), (60, 1)]
        {
            for precision in [64, 128, 192] {
                let p = exponent(numerator, denominator);
                let sum = power_tail(1, &p, precision);
                assert!(relative_width(&sum) <= 2f64.powi(2 - precision as i32), "{}", relative_width(&sum));
                // zeta decreases, so the value at the ends of the enclosure of p brackets the truth.
                assert!(sum.lower() <= zeta(&p.lower(), 256).upper(), "{numerator}/{denominator}");
                assert!(sum.upper() >= zeta(&p.upper(), 256).lower(), "{numerator}/{denominator}");
                assert!(sum.intersect(&zeta(&p.lower(), precision)).is_defined());
            }
        }
    }

    #[test]
    fn zeta_of_two_is_exact_to_the_last_bits() {
        let expected = Enclosure::pi(400).sqr() / 6;
        for precision in [53, 128, 300] {
            let sum = power_tail(1, &Enclosure::from_integer(2, precision), precision);
            assert!(sum.lower() <= expected.lower() && expected.upper() <= sum.upper());
            assert!(relative_width(&sum) < 2f64.powi(2 - precision as i32));
        }
    }

    /// The remainder is where soundness lies: the result must hold however early the formula is cut off.
    #[test]
    fn every_cut_is_sound_and_more_terms_are_narrower() {
        for p in [1.5, 1.0009765625, 2.0, 3.75] {
            let p = Float::with_val(256, p);
            let truth = zeta(&p, 256);
            for start in [1, 2, 5] {
                let mut previous = f64::INFINITY;
                for corrections in 1..=3 {
                    let sum = euler_maclaurin(&Float::with_val(256, 1), &p, start, corrections);
                    assert!(sum.lower() < truth.lower() && truth.upper() < sum.upper(), "{p} {start} {corrections}");
                    let width = relative_width(&sum);
                    assert!(width < previous || start < 5);
                    previous = width;
                }
            }
        }
    }

    #[test]
    fn extreme_arguments_are_sound() {
        for p in [exponent(1_000_000_000, 1), exponent(5000, 1), exponent(1_000_000_000_001, 1_000_000_000_000)] {
            for first in [1, 2, 37, 1000, u64::MAX] {
                let sum = power_tail(first, &p, 128);
                let leading = Enclosure::from_rational(&Rational::from(first), 256).pow(&-&p);
                assert!(sum.is_defined() && sum.upper() >= leading.lower(), "{first}");
                let above = integral_test(&Float::with_val(256, first), &p.lower());
                assert!(sum.lower() <= above.upper(), "{first} {sum:?}");
                // Where the sum is not below the smallest number that can be represented.
                assert!(sum.lower().is_zero() || relative_width(&sum) < 1e-9, "{first} {sum:?}");
            }
        }
    }

    #[test]
    fn hypotheses_are_enforced() {
        for p in [exponent(1, 1), exponent(1, 2), exponent(-3, 1), Enclosure::undefined(64), Enclosure::entire(64)] {
            assert!(!power_tail(1, &p, 128).is_defined());
        }
        let straddling = Enclosure::between(&Rational::from((9, 10)), &Rational::from(2), 64);
        assert!(!power_tail(1, &straddling, 128).is_defined());
        assert!(!power_tail(0, &exponent(2, 1), 128).is_defined());
    }

    #[test]
    fn a_wide_exponent_gives_the_whole_range() {
        let wide = Enclosure::between(&Rational::from((3, 2)), &Rational::from(2), 128);
        let sum = power_tail(3, &wide, 128);
        for p in [exponent(3, 2), exponent(7, 4), exponent(2, 1)] {
            let one = power_tail(3, &p, 160);
            assert!(sum.lower() <= one.lower() && one.upper() <= sum.upper());
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        /// Against direct summation with the integral bounds of the rest, which uses none of the formula above.
        #[test]
        fn agrees_with_direct_sums(first in 1u64..60, numerator in 1001i64..6000) {
            let p = exponent(numerator, 1000);
            let sum = power_tail(first, &p, 128);
            let mut direct = Enclosure::zero(192);
            let end = first + 200;
            for l in first..end {
                direct = direct + Enclosure::from_rational(&Rational::from(l), 192).pow(&-&p);
            }
            // sum_{l >= end} lies between the integrals from end and from end - 1.
            let rest = |from: u64| {
                Enclosure::from_rational(&Rational::from(from), 192).pow(&(1 - &p)) / (&p - 1)
            };
            let lower = &direct + rest(end);
            let upper = &direct + rest(end - 1);
            prop_assert!(lower.lower() <= sum.lower());
            prop_assert!(sum.upper() <= upper.upper());
            prop_assert!(relative_width(&sum) < 1e-35);
        }
    }
}
