//! The gains of linear periodic systems: K_alpha, K_{alpha,2}, beta, beta_s, tau, and their inverses in sigma.

use crate::enclosure::{Enclosure, Truth};
use rug::Rational;

/// `K_alpha = c (e^{alpha T} - 1 + c) e^{-alpha T}` (P:app:Kalpha1), a pure number.
///
/// Hypotheses: c >= 1, alpha, T > 0. Guarantee: a T-periodic solution of chi' = F chi + g has
/// sup|chi| <= (K_alpha/alpha) sup|g| when (P_low, P_up, alpha) holds for F. Sound; never less than c, which
/// serves as well (derivation, lemma K: differentiate sqrt(chi' P chi)).
#[must_use]
pub fn k_alpha(c: &Enclosure, alpha: &Enclosure, period: &Enclosure) -> Enclosure {
    // The same number in the form c (1 + (c - 1) e^{-alpha T}), which has no cancellation and no overflow.
    let decay = (-(alpha * period)).exp();
    c * (1 + (c - 1) * decay)
}

/// `K_{alpha,2}` as printed (P:app:Kalpha2): `k sqrt(T (1 + e^{-alpha T}) / (2 (1 - e^{-alpha T})))`.
///
/// Unsound for T < 1: the factor T does not belong there (erratum E12).
#[must_use]
pub fn k_alpha_2_printed(k: &Enclosure, alpha: &Enclosure, period: &Enclosure) -> Enclosure {
    k * (period * (alpha * period / 2).coth() / 2).sqrt()
}

/// `K_{alpha,2}` without the misplaced sqrt(T): `k sqrt(coth(alpha T / 2) / 2)`, a pure number.
///
/// Guarantee, with k = K_alpha or c: sup|chi| <= (K_{alpha,2}/sqrt(alpha)) |g|_2, the L2 norm being over one period.
#[must_use]
pub fn k_alpha_2(k: &Enclosure, alpha: &Enclosure, period: &Enclosure) -> Enclosure {
    k * ((alpha * period / 2).coth() / 2).sqrt()
}

/// `beta(sigma) = sqrt(2 T coth(sigma T/2) / sigma)` (P:eq:beta_definition), in units of time; decreasing in sigma.
///
/// Guarantee: sup|e| <= beta(sigma) sup|q| for the periodic error. Sound; twice [`beta_s`].
#[must_use]
pub fn beta(sigma: &Enclosure, period: &Enclosure) -> Enclosure {
    2 * beta_s(sigma, period)
}

/// `beta_s(sigma) = sqrt((T / (2 sigma)) coth(sigma T/2))` (derivation, section 3), in units of time.
///
/// Guarantee: sup|e| <= beta_s(sigma) rms(q) for the periodic error, every n_o and mu; decreasing in sigma.
#[must_use]
pub fn beta_s(sigma: &Enclosure, period: &Enclosure) -> Enclosure {
    (period * (sigma * period / 2).coth() / (2 * sigma)).sqrt()
}

/// `tau(sigma)`: sup|e| <= tau(sigma) rms(q') for the periodic error, every n_o and mu (derivation, section 3), in
/// units of time squared; decreasing in sigma.
///
/// `tau^2 = sum_{j != 0} 1/(om_j^2 (sigma^2 + om_j^2)) = (T/sigma)^2 g(sigma T)`,
/// `g(y) = 1/12 - coth(y/2)/(2y) + 1/y^2`, om_j = 2 pi j/T. The closed form cancels for small y, where the
/// alternating series `g(y)/y^2 = 1/720 - y^2/30240 + y^4/1209600 - ...` takes over; both are enclosures, so their
/// intersection is one.
#[must_use]
pub fn tau(sigma: &Enclosure, period: &Enclosure) -> Enclosure {
    let p = sigma.precision().max(period.precision());
    let y = sigma * period;
    let half = (&y / 2).coth() / (2 * &y);
    let twelfth = Enclosure::from_rational(&Rational::from((1, 12)), p);
    // sum >= 0 and sum <= 2 zeta(4) (T/2pi)^4 = T^4/720, because dropping sigma enlarges every term.
    let trivial = Enclosure::zero(p).hull(&Enclosure::from_rational(&Rational::from((1, 720)), p));
    // g is nonnegative, so a negative lower end is only rounding.
    let closed = (twelfth - half + y.sqr().recip()).max(&Enclosure::zero(p)) / y.sqr();
    let mut ratio = trivial.intersect(&closed);
    if y.lt(&Enclosure::one(p)).is_true() {
        ratio = ratio.intersect(&tau_series(&y));
    }
    period.sqr() * ratio.sqrt()
}

/// `sum_k (-1)^k 2 zeta(2k+4) (y/(2 pi))^{2k} / (2 pi)^4` for 0 < y < 1: alternating with decreasing terms, so the sum
/// lies between consecutive partial sums. The coefficients are |B_{2k+4}|/(2k+4)!.
fn tau_series(y: &Enclosure) -> Enclosure {
    const COEFFICIENTS: [(i64, i64); 5] =
        [(1, 720), (-1, 30_240), (1, 1_209_600), (-1, 47_900_160), (691, 1_307_674_368_000)];
    let p = y.precision();
    let square = y.sqr();
    let mut power = Enclosure::one(p);
    let mut partial = Enclosure::zero(p);
    let mut previous = partial.clone();
    for coefficient in COEFFICIENTS {
        previous = partial.clone();
        partial = partial + Enclosure::from_rational(&Rational::from(coefficient), p) * &power;
        power = power * &square;
    }
    previous.hull(&partial)
}

/// The smallest sigma with `beta_s(sigma) <= level`, enclosed; the inverse of [`beta_s`].
///
/// Hypotheses: level, T > 0. Undefined when the level is not certainly positive.
#[must_use]
pub fn beta_s_inverse(level: &Enclosure, period: &Enclosure) -> Enclosure {
    // With u = sigma T/2: beta_s^2 = (T^2/4) coth(u)/u, and 1/u <= coth(u)/u <= (1 + 1/u)/u.
    if !level.is_positive().is_true() {
        return Enclosure::undefined(level.precision());
    }
    let v = (2 * level / period).sqr();
    let first = v.recip();
    let last = (1 + (1 + 4 * &v).sqrt()) / (2 * &v);
    let u = decreasing_root(&first, &last, |u| u.coth() / u, &v);
    2 * u / period
}

/// The smallest sigma with `beta(sigma) <= level`, enclosed; the inverse of [`beta`].
#[must_use]
pub fn beta_inverse(level: &Enclosure, period: &Enclosure) -> Enclosure {
    beta_s_inverse(&(level / 2), period)
}

/// The smallest sigma with `tau(sigma) <= level`, enclosed; the inverse of [`tau`], and 0 where the level is at least
/// its supremum T^2/sqrt(720).
///
/// Hypotheses: level, T > 0. Undefined when the level is not certainly positive, or cannot be told from the supremum.
#[must_use]
pub fn tau_inverse(level: &Enclosure, period: &Enclosure) -> Enclosure {
    let p = level.precision().max(period.precision());
    if !level.is_positive().is_true() {
        return Enclosure::undefined(p);
    }
    // In units of the period: tau = T^2 t(y), y = sigma T, and t(y) <= 1/(sqrt(12) y).
    let target = level / period.sqr();
    let supremum = Enclosure::from_integer(720, p).sqrt().recip();
    match target.lt(&supremum) {
        Truth::False => Enclosure::zero(p),
        Truth::Undecided => Enclosure::undefined(p),
        Truth::True => {
            let last = (Enclosure::from_integer(12, p).sqrt() * &target).recip();
            // For y < 2 pi the series alternates: (t(y)/t(0))^2 >= 1 - y^2/42 (42 = 30240/720), and sqrt(1-z) >= 1-z,
            // so the root has y^2 >= 42 (1 - target/t(0)), at most 6.5^2; half of that y is below every root, those
            // beyond 2 pi included, and leaves room for rounding.
            let first = ((1 - &target / supremum) * 42).max(&Enclosure::zero(p)).sqrt() / 2;
            decreasing_root(&first, &last, |y| tau(y, &Enclosure::one(p)), &target) / period
        }
    }
}

/// Encloses the root of `f(u) = target` for a decreasing f on `[first, last]`, where f(first) >= target >= f(last),
/// by bisection: a half is dropped only on a certain comparison.
fn decreasing_root(
    first: &Enclosure,
    last: &Enclosure,
    f: impl Fn(&Enclosure) -> Enclosure,
    target: &Enclosure,
) -> Enclosure {
    let p = target.precision();
    let (Some(mut low), Some(mut high)) = (first.lower_rational(), last.upper_rational()) else {
        return Enclosure::undefined(p);
    };
    if low <= 0 || low > high {
        return Enclosure::undefined(p);
    }
    for _ in 0..2 * p {
        // The middle, rounded to the working precision so that the rationals stay short.
        let middle = Rational::from(&low + &high) / 2u32;
        let middle = Enclosure::from_rational(&middle, p);
        let Some(exact) = middle.lower_rational() else { break };
        if exact <= low || exact >= high {
            break;
        }
        let value = f(&Enclosure::from_rational(&exact, p));
        if value.ge(target).is_true() {
            low = exact;
        } else if value.le(target).is_true() {
            high = exact;
        } else {
            break;
        }
    }
    Enclosure::between(&low, &high, p)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn number(value: f64) -> Enclosure {
        Enclosure::from_rational(&Rational::from_f64(value).unwrap(), 128)
    }

    fn relative_width(value: &Enclosure) -> f64 {
        let ends = Enclosure::new(value.upper().clone(), value.upper().clone())
            - Enclosure::new(value.lower().clone(), value.lower().clone());
        (ends / value).upper_f64()
    }

    fn close(value: &Enclosure, expected: f64, relative: f64) -> bool {
        (value.midpoint_f64() - expected).abs() <= relative * expected.abs()
    }

    #[test]
    fn printed_and_repaired_forms_agree_with_their_definitions() {
        let (c, alpha, t) = (number(1.25), number(0.5), number(2.0));
        let e = (-1.0_f64).exp();
        assert!(close(&k_alpha(&c, &alpha, &t), 1.25 * (1.0 / e - 1.0 + 1.25) * e, 1e-14));
        assert!(close(&k_alpha_2(&c, &alpha, &t), 1.25 * ((1.0 + e) / (2.0 * (1.0 - e))).sqrt(), 1e-14));
        assert!(close(&k_alpha_2_printed(&c, &alpha, &t), 1.25 * (2.0 * (1.0 + e) / (2.0 * (1.0 - e))).sqrt(), 1e-14));
        let sigma = number(3.0);
        let q = (-6.0_f64).exp();
        assert!(close(&beta(&sigma, &t), (4.0 * (1.0 + q) / (3.0 * (1.0 - q))).sqrt(), 1e-14));
    }

    #[test]
    fn k_alpha_equals_one_for_a_scalar() {
        assert!(close(&k_alpha(&number(1.0), &number(0.1), &number(3.0)), 1.0, 1e-30));
    }

    /// tau by its defining series; the terms left out are below 1e-12 of the sum.
    fn tau_direct(sigma: f64, period: f64) -> f64 {
        let om = |j: f64| 2.0 * std::f64::consts::PI * j / period;
        let sum: f64 =
            (1..400_000_u32).map(|j| 1.0 / (om(j.into()).powi(2) * (sigma * sigma + om(j.into()).powi(2)))).sum();
        (2.0 * sum).sqrt()
    }

    #[test]
    fn tau_matches_its_series_for_all_sizes_of_sigma_t() {
        for sigma in [1e-12, 1e-6, 1e-3, 0.1, 0.9, 1.1, 10.0, 1e3] {
            let value = tau(&number(sigma), &number(1.5));
            assert!(close(&value, tau_direct(sigma, 1.5), 1e-11), "sigma = {sigma}: {:?}", value.decimals());
            let width = relative_width(&value);
            assert!(width < 1e-15, "sigma = {sigma}: relative width {width:e}");
        }
    }

    #[test]
    fn the_inverse_of_a_nonpositive_level_is_undefined() {
        assert!(!beta_s_inverse(&number(0.0), &number(1.0)).is_defined());
        assert!(!beta_s_inverse(&number(-1.0), &number(1.0)).is_defined());
        assert!(beta_s_inverse(&number(1.0), &number(1.0)).is_bounded());
    }

    proptest! {
        #[test]
        fn inverses_invert(exponent in -9.0_f64..9.0, period in -6.0_f64..6.0) {
            let (sigma, period) = (number(10f64.powf(exponent)), number(10f64.powf(period)));
            let back = beta_s_inverse(&beta_s(&sigma, &period), &period);
            prop_assert!(back.lower() <= sigma.lower() && back.upper() >= sigma.upper());
            prop_assert!(relative_width(&back) < 1e-25);
            let doubled = beta_inverse(&beta(&sigma, &period), &period);
            prop_assert!(doubled.lower() <= sigma.lower() && doubled.upper() >= sigma.upper());
        }

        #[test]
        fn tau_inverts(exponent in -2.0_f64..9.0, period in -6.0_f64..6.0) {
            let period = number(10f64.powf(period));
            let sigma = number(10f64.powf(exponent)) / &period;
            let back = tau_inverse(&tau(&sigma, &period), &period);
            prop_assert!(back.lower() <= sigma.lower() && back.upper() >= sigma.upper());
            prop_assert!(relative_width(&back) < 1e-8);
            let supremum = period.sqr() / Enclosure::from_integer(720, 128).sqrt();
            prop_assert_eq!(tau_inverse(&(supremum * 2), &period), Enclosure::zero(128));
        }

        #[test]
        fn all_gains_decrease_in_sigma(exponent in -9.0_f64..9.0, factor in 1.01_f64..100.0) {
            let (low, high) = (number(10f64.powf(exponent)), number(factor * 10f64.powf(exponent)));
            let period = number(1.0);
            prop_assert!(beta_s(&high, &period).lt(&beta_s(&low, &period)).is_true());
            prop_assert!(tau(&high, &period).le(&tau(&low, &period)).is_true() || exponent < -7.0);
            // The two elementary bounds of the derivation.
            let elementary = &period / (Enclosure::from_integer(12, 128).sqrt() * &low);
            prop_assert!(tau(&low, &period).lower() <= elementary.upper());
        }
    }
}
