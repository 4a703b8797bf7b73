//! What an uncertain input gain changes in the formulas (derivation, 13.1): e' = q(t,x,e) + b u, b one unknown constant in
//! `[b_lo, b_hi]`, 0 < b_lo <= 1 <= b_hi.
//!
//! With y := q + (1-b) sigma e + b mu s it is e' = y - sigma e, zeta' = Phi zeta - M y: the plant with gain b is the plant with
//! gain 1, b mu in the place of mu and q + (1-b) sigma e in that of q.

use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::real::{Operand, Real};
use sigmastar_lang::plant::Plant;

/// The interval `[b_lo, b_hi]` of an input gain that is not known exactly.
///
/// Hypothesis: 0 < b_lo <= 1 <= b_hi, and not both are 1: where both are, there is none of these, and every formula is the one without
/// it.
#[derive(Clone, Debug)]
pub struct InputGain<R> {
    /// b_lo.
    pub low: R,
    /// b_hi.
    pub high: R,
}

impl InputGain<Enclosure> {
    /// The middles.
    #[must_use]
    pub fn midpoints(&self) -> InputGain<f64> {
        InputGain { low: self.low.midpoint_f64(), high: self.high.midpoint_f64() }
    }
}

impl<R: Real> InputGain<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// `b_m = min{1, b_lo} = b_lo`: a harmonic of the answer e to q is at most `|q_j|/(b_m sqrt(sigma^2 + om_j^2))`.
    ///
    /// For `|i om + b sigma + i y (i om + sigma)|^2`, least over real y, is `(b sigma^2 + om^2)^2/(sigma^2 + om^2)`.
    #[must_use]
    pub fn of_error(&self) -> &R {
        &self.low
    }

    /// d_b at b_lo: `|om_j e_j| <= d_b |q_j|`; 1 where b_lo is certainly not below 1/2, else the larger one of 1 and
    /// `1/(2 sqrt(b_lo (1 - b_lo)))`, which is never below 1.
    #[must_use]
    pub fn of_error_rate(&self) -> R {
        let one = R::int(1);
        let half = &self.low + &self.low - &one;
        if half.is_certainly_positive() || half.is_zero() {
            return one;
        }
        // It is 1 at b_lo = 1/2, and falls in b below.
        let rest = &one - &self.low;
        (&one / (R::int(2) * (&self.low * rest).sqrt())).max(&one)
    }

    /// `c_m`, the least `c_b` at both ends, with c_b = b up to 1 and `2/sqrt(3 + b)` beyond: `|y_j| sqrt(1 + (b nu g)^2) <= |q_j|/c_b`.
    #[must_use]
    pub fn of_steady_state(&self) -> R {
        self.low.min(&(R::int(2) / (R::int(3) + &self.high).sqrt()))
    }

    /// `b_lo^3`, not above `b c_b^2`: sup - inf of |zeta|_N^2 is at most `T R_q^2/(2 b_lo^3 mu)`.
    #[must_use]
    pub fn of_swing(&self) -> R {
        self.low.sqr() * &self.low
    }

    /// The largest |1 - b|: q_b = q + (1-b) sigma e is so far from q, in units of sigma |e|.
    #[must_use]
    pub fn largest_shift(&self) -> R {
        let one = R::int(1);
        (&one - &self.low).max(&(&self.high - one))
    }

    /// The sector of dq/de + (1-b) sigma over both ends, from that of dq/de, with which C5 is what it is without a gain: from
    /// `-(k_l + (b_hi - 1) sigma)` up to `m + (1 - b_lo) sigma`.
    ///
    /// m is max(m, 0), unless (B): `4 ht sigma >= (1 + ht (1-b) sigma)^2` at both ends, with which m itself serves every larger gain.
    #[must_use]
    pub fn sector(&self, [below, above]: [&R; 2], h_over_mu: &R, sigma: &R) -> [R; 2] {
        let one = R::int(1);
        let above = if self.allows_damping(h_over_mu, sigma) { above.clone() } else { above.max(&R::int(0)) };
        [below + (&self.high - &one) * sigma, above + (one - &self.low) * sigma]
    }

    /// Both members of (B), `(1 + ht (1-b) sigma)^2` at the worse end and `4 ht sigma`.
    #[must_use]
    pub fn damping(&self, h_over_mu: &R, sigma: &R) -> [R; 2] {
        let moved = h_over_mu * sigma;
        let at = |b: &R| (R::int(1) + &moved * (R::int(1) - b)).sqr();
        [at(&self.low).max(&at(&self.high)), R::int(4) * moved]
    }

    /// Whether (B) is certain.
    fn allows_damping(&self, h_over_mu: &R, sigma: &R) -> bool {
        let [worst, room] = self.damping(h_over_mu, sigma);
        (room - worst).is_certainly_positive()
    }
}

/// The 1 - b at both ends of the input gain of a plant, outwards; none where it is 1.
#[must_use]
pub fn moves(plant: &Plant, precision: u32) -> Option<[Rational; 2]> {
    let gain = plant.input_gain.as_ref()?;
    let one = Rational::from(1);
    if let (Some([low, high]), false) = (gain.exact_factors(), gain.is_nominal()) {
        return Some([&one - low, one - high]);
    }
    let [low, high] = gain.factors(precision)?;
    // What is enclosed has bounds.
    Some([&one - low.lower_rational()?, one - high.upper_rational()?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::derivation::stability::{DecayTerms, Sector};
    use proptest::prelude::*;
    use rug::Rational;

    fn gain(low: f64, high: f64) -> InputGain<f64> {
        InputGain { low, high }
    }

    /// `|i om + b sigma + i y (i om + sigma)|`.
    fn denominator(b: f64, sigma: f64, om: f64, y: f64) -> f64 {
        (b * sigma - y * om).hypot(om + y * sigma)
    }

    proptest! {
        /// Of every harmonic, whatever the internal model answers there.
        #[test]
        fn harmonics_are_within_their_bounds(
            low in 0.02_f64..1.0, high in 1.0_f64..9.0, share in 0.0_f64..1.0,
            sigma in -4.0_f64..4.0, om in -4.0_f64..4.0, y in -50.0_f64..50.0,
        ) {
            let (gain, b) = (gain(low, high), low + share * (high - low));
            let (sigma, om) = (10f64.powf(sigma), 10f64.powf(om));
            let e = 1.0 / denominator(b, sigma, om, y);
            let plain = sigma.hypot(om);
            prop_assert!(e <= (1.0 + 1e-12) / (gain.of_error() * plain));
            prop_assert!(om * e <= gain.of_error_rate() * (1.0 + 1e-12));
            // y = (i om + sigma) e, and q_b = y (1 + i y).
            let answer = plain * e * 1.0_f64.hypot(y);
            prop_assert!(answer <= (1.0 + 1e-12) / gain.of_steady_state());
            // sup - inf of |zeta|_N^2 over a period: |q_b|^2 T/(2 b mu).
            prop_assert!(answer * answer / b <= (1.0 + 1e-12) / gain.of_swing());
        }

        /// With the sector of a gain C5 is the positivity of the form in (xi, e, y) at every b, also at a larger sigma with a smaller
        /// weight in proportion.
        #[test]
        fn the_form_is_positive_at_every_gain(
            low in 0.1_f64..1.0, high in 1.0_f64..4.0, share in 0.0_f64..1.0, slope in 0.0_f64..1.0,
            m in -3.0_f64..3.0, more in 0.0_f64..3.0, ht in -3.0_f64..1.0, [w, rate, k_x, k_f] in prop::array::uniform4(0.05_f64..2.0),
            above in 1.0001_f64..2.0, larger in 1.0_f64..30.0, point in prop::array::uniform3(-1.0_f64..1.0), ends in prop::array::uniform4(any::<bool>()),
        ) {
            let (gain, ht) = (gain(low, high), 10f64.powf(ht));
            let k_l = more - m;
            prop_assume!(k_l >= 0.0 && m <= k_l && 4.0 * w * rate > ht * k_x * k_x);
            let terms = |sigma: f64| {
                let [below, above] = gain.sector([&k_l, &m], &ht, &sigma);
                DecayTerms::new([&w, &ht], [&rate, &1.0, &1.0], [&k_x, &k_f], &Sector { below, above })
            };
            let threshold = |sigma: f64| terms(sigma).threshold(4.0 * w * rate - ht * k_x * k_x);
            // The first sigma on a ladder that is above its threshold by so much, if any.
            let sigma = (0..120).map(|k| 1e-2 * 1.15f64.powi(k)).find(|sigma| threshold(*sigma) * above < *sigma);
            prop_assume!(sigma.is_some());
            let (sigma, b) = (sigma.unwrap(), low + share * (high - low));
            for (sigma, ht) in [(sigma, ht), (larger * sigma, ht / larger)] {
                let [xi, e, y] = point;
                let xi = xi.abs();
                let end = |first: bool, a: f64, b: f64| if first { a } else { b };
                let delta = end(ends[0], -k_l, m);
                let delta = end(ends[1], delta, m - slope * (m + k_l));
                let u_x = end(ends[2], 1.0, -1.0) * k_x * xi;
                // y where the square that it completes vanishes, or anywhere.
                let worst = (e + ht * ((delta + (1.0 - b) * sigma) * e + u_x)) / (2.0 * ht);
                let y = end(ends[3], worst, y);
                let form = 2.0 * w * rate * xi * xi - 2.0 * w * xi * k_f * e.abs() + 2.0 * sigma * e * e - 2.0 * e * y
                    + 2.0 * ht * y * y - 2.0 * ht * y * ((delta + (1.0 - b) * sigma) * e + u_x);
                let size = xi * xi + e * e + y * y;
                prop_assert!(form > -1e-9 * size * (1.0 + sigma), "{form} {size} {sigma} {ht} {b} {delta}");
            }
        }
    }

    #[test]
    fn the_bounds_are_reached() {
        // At om = 0 and y = 0, for om^2 = b/(1 - 2b) sigma^2, and far out.
        let low = 0.2_f64;
        let gain = gain(low, 1.0);
        assert_eq!(gain.of_error(), &low);
        let om = (low / (1.0 - 2.0 * low)).sqrt();
        let y = -(1.0 - low) * om / (1.0 + om * om);
        let reached = om / denominator(low, 1.0, om, y);
        assert!((reached / gain.of_error_rate() - 1.0).abs() < 1e-12, "{reached}");
        assert!((1.0 / denominator(low, 1.0, 0.0, 0.0) - 1.0 / low).abs() < 1e-12);
        // There sup - inf of |zeta|_N^2 has its bound, too.
        let still = 1.0 / denominator(low, 1.0, 1e-9, 0.0);
        assert!((still * still / low * gain.of_swing() - 1.0).abs() < 1e-6);
        // c_b beyond 1: the largest over C and y of the quotient, on a grid.
        let high = 2.5_f64;
        let quotient = |om: f64, y: f64| om.hypot(1.0) * 1.0_f64.hypot(y) / denominator(high, 1.0, om, y);
        let largest = (0..400).flat_map(|i| (0..400).map(move |k| (0.01 * f64::from(i), 0.02 * f64::from(k - 200))));
        let largest = largest.map(|(om, y)| quotient(om, y)).fold(0.0, f64::max);
        let stated = 1.0 / InputGain { low: 1.0, high }.of_steady_state();
        assert!(largest <= stated && largest > 0.999 * stated, "{largest} {stated}");
    }

    #[test]
    fn the_rate_of_the_error_is_that_of_q_from_one_half_on() {
        let exact = |n: i64, d: i64| Enclosure::from_rational(&Rational::from((n, d)), 128);
        let rate = |low: Enclosure| InputGain { low, high: exact(1, 1) }.of_error_rate();
        assert!(rate(exact(1, 2)).le(&exact(1, 1)).is_true() && rate(exact(3, 4)).le(&exact(1, 1)).is_true());
        // 1/(2 sqrt(1/5 4/5)) = 5/4.
        let fifth = rate(exact(1, 5));
        assert!(fifth.gt(&exact(1249, 1000)).is_true() && fifth.lt(&exact(1251, 1000)).is_true());
        let nearly = rate(exact(499_999, 1_000_000));
        assert!(nearly.ge(&exact(1, 1)).is_true() && nearly.lt(&exact(1_000_001, 1_000_000)).is_true());
    }

    /// dq/de < 0 counts only where (B) holds at both ends.
    #[test]
    fn damping_counts_under_its_condition() {
        let (gain, sigma) = (gain(0.8, 1.25), 2.0);
        let close = |a: [f64; 2], b: [f64; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        // 4 ht sigma = 4 and (1 + 0.5 0.2 2)^2 = 1.44.
        assert!(close(gain.damping(&0.5, &sigma), [1.44, 4.0]));
        assert!(close(gain.sector([&3.0, &-1.0], &0.5, &sigma), [3.5, -0.6]));
        // 4 ht sigma = 0.8 and (1 + 0.1 0.2 2)^2 = 1.0816.
        assert!(close(gain.sector([&3.0, &-1.0], &0.1, &sigma), [3.5, 0.4]));
        assert!(close(gain.sector([&3.0, &1.0], &0.1, &sigma), [3.5, 1.4]));
    }
}
