//! The gains of linear periodic systems: K_alpha, K_{alpha,2}, beta, beta_s, tau, and their inverses in sigma.

use sigmastar_exact::real::{Operand, Real};

/// `K_alpha = c (e^{alpha T} - 1 + c) e^{-alpha T}` (P:app:Kalpha1), a pure number.
///
/// Hypotheses: c >= 1, alpha, T > 0. Alone of these gains it falls as T grows. Guarantee: a T-periodic solution of chi' = F chi + g has
/// sup|chi| <= (K_alpha/alpha) sup|g| when (P_low, P_up, alpha) holds for F. Sound; never less than c, which
/// serves as well (derivation, lemma K: differentiate sqrt(chi' P chi)).
#[must_use]
pub fn k_alpha<R: Real>(c: &R, alpha: &R, period: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    // The same number in the form c (1 + (c - 1) e^{-alpha T}), which has no cancellation and no overflow.
    let (one, decay) = (R::int(1), (-(alpha * period)).exp());
    c * (one.clone() + (c - one) * decay)
}

/// `K_{alpha,2}` as printed (P:app:Kalpha2): `k sqrt(T (1 + e^{-alpha T}) / (2 (1 - e^{-alpha T})))`.
///
/// Unsound for T < 1: the factor T does not belong there (erratum E12).
#[must_use]
pub fn k_alpha_2_printed<R: Real>(k: &R, alpha: &R, period: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    k * (period * (alpha * period / R::int(2)).coth() / R::int(2)).sqrt()
}

/// `K_{alpha,2}` without the misplaced sqrt(T): `k sqrt(coth(alpha T / 2) / 2)`, a pure number.
///
/// Guarantee, with k = K_alpha or c: sup|chi| <= (K_{alpha,2}/sqrt(alpha)) |g|_2, the L2 norm being over one period.
#[must_use]
pub fn k_alpha_2<R: Real>(k: &R, alpha: &R, period: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    k * ((alpha * period / R::int(2)).coth() / R::int(2)).sqrt()
}

/// `beta(sigma) = sqrt(2 T coth(sigma T/2) / sigma)` (P:eq:beta_definition), in units of time; decreasing in sigma.
///
/// Guarantee: sup|e| <= beta(sigma) sup|q| for the periodic error. Sound; twice [`beta_s`].
#[must_use]
pub fn beta<R: Real>(sigma: &R, period: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    R::int(2) * beta_s(sigma, period)
}

/// `beta_s(sigma) = sqrt((T / (2 sigma)) coth(sigma T/2))` (derivation, section 3), in units of time.
///
/// Guarantee: sup|e| <= beta_s(sigma) rms(q) for the periodic error, every n_o and mu; decreasing in sigma.
#[must_use]
pub fn beta_s<R: Real>(sigma: &R, period: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    (period * (sigma * period / R::int(2)).coth() / (R::int(2) * sigma)).sqrt()
}

/// `tau(sigma)`: sup|e| <= tau(sigma) rms(q') for the periodic error, every n_o and mu (derivation, section 3), in
/// units of time squared; decreasing in sigma.
///
/// `tau^2 = sum_{j != 0} 1/(om_j^2 (sigma^2 + om_j^2)) = T^4 S(sigma T)`, om_j = 2 pi j/T, with S of
/// [`Real::oscillator_sum`].
#[must_use]
pub fn tau<R: Real>(sigma: &R, period: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    period.sqr() * (sigma * period).oscillator_sum().sqrt()
}

/// `bt(sigma)`: sup|e| <= bt(sigma) rms(q) for the periodic error, every n_o and mu (derivation, 10.2), in units of time;
/// decreasing in sigma, and at most T/sqrt(12).
///
/// `bt^2 = sum_{j != 0} 1/(sigma^2 + om_j^2) = beta_s^2 - 1/sigma^2 = T^2 B(sigma T)`, with B of [`Real::zero_mean_sum`]: the
/// error has zero mean, so the term of j = 0 does not count.
#[must_use]
pub fn zero_mean_gain<R: Real>(sigma: &R, period: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    period * (sigma * period).zero_mean_sum().sqrt()
}

/// `K2(a) = c sqrt(T coth(aT/2)/(2a))` (derivation, 10.2), in units of time.
///
/// Hypothesis: `chi' = J(t) chi + g` with the rate a > 0 of a P(t), c = sqrt(P_up/P_low). Guarantee: the T-periodic solution
/// has sup|chi| <= K2(a) rms(g).
#[must_use]
pub fn mean_square_gain<R: Real>(c: &R, rate: &R, period: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    c * (period * (rate * period / R::int(2)).coth() / (R::int(2) * rate)).sqrt()
}

/// The smallest sigma with `beta_s(sigma) <= level`; the inverse of [`beta_s`].
///
/// Hypotheses: level, T > 0. Unknown when the level is not certainly positive.
#[must_use]
pub fn beta_s_inverse<R: Real>(level: &R, period: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    // With u = sigma T/2: beta_s^2 = (T^2/4) coth(u)/u.
    let v = (R::int(2) * level / period).sqr();
    let u = if level.is_certainly_positive() { v.coth_ratio_inverse() } else { R::unknown() };
    R::int(2) * u / period
}

/// The smallest sigma with `beta(sigma) <= level`; the inverse of [`beta`].
#[must_use]
pub fn beta_inverse<R: Real>(level: &R, period: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    beta_s_inverse(&(level / R::int(2)), period)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rug::Rational;
    use sigmastar_exact::enclosure::Enclosure;

    fn number(value: f64) -> Enclosure {
        Enclosure::from_rational(&Rational::from_f64(value).unwrap(), 128)
    }

    fn relative_width(value: &Enclosure) -> f64 {
        let ends = Enclosure::new(value.upper(), value.upper()) - Enclosure::new(value.lower(), value.lower());
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
    fn the_gain_of_zero_mean_matches_its_series() {
        let direct = |sigma: f64, period: f64| {
            let om = |j: f64| 2.0 * std::f64::consts::PI * j / period;
            // The rest of the sum is about T^2/(2 pi^2 n), half a term more or less.
            let sum: f64 = (1..400_000_u32).map(|j| 1.0 / (sigma * sigma + om(j.into()).powi(2))).sum();
            (2.0 * (sum + period.powi(2) / (4.0 * std::f64::consts::PI.powi(2) * 399_999.5))).sqrt()
        };
        for sigma in [1e-12, 1e-6, 1e-3, 0.1, 0.9, 1.1, 10.0, 1e3] {
            let value = zero_mean_gain(&number(sigma), &number(1.5));
            assert!(close(&value, direct(sigma, 1.5), 1e-9), "sigma = {sigma}: {:?}", value.decimals());
            assert!(relative_width(&value) < 1e-15, "sigma = {sigma}");
            let beta = beta_s(&number(sigma), &number(1.5));
            let difference = beta.sqr() - number(sigma).sqr().recip();
            assert!(!difference.lt(&value.sqr()).is_true() && !value.sqr().lt(&difference).is_true());
        }
    }

    /// A scalar equation chi' = -a chi + g with a comb of impulses as g approaches K2: here its exact L2 kernel.
    #[test]
    fn the_mean_square_gain_is_the_norm_of_the_periodic_kernel() {
        let (a, period) = (0.7_f64, 3.0_f64);
        let kernel = |s: f64| (-a * s).exp() / (1.0 - (-a * period).exp());
        let n = 200_000;
        let step = period / f64::from(n);
        let square: f64 = (0..n).map(|i| kernel((f64::from(i) + 0.5) * step).powi(2) * step).sum();
        let expected = (square * period).sqrt();
        assert!(close(&mean_square_gain(&number(1.0), &number(a), &number(period)), expected, 1e-9));
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
