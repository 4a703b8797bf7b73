//! Rule: existence of the periodic solution without a small gain, by a matrix inequality over the derivatives of a plant
//! (docs/mathematics.md, section 13.7, (E), on the straight path), in the form of `inequality`.
//!
//! The inequality, in (x, e, y), at every t and every point of `|y| <= X`, `|e| <= E`, with J, g, r, d at that one point:
//! `[-(P J + J'P) - c_x I, -P g, -(k_p/2) r'; ., 2 threshold, -1 - (k_p/2) d; ., ., k_p - c_y] >= 0`. P is symmetric, of any sign.
//!
//! What it says of a solution. Let 0 <= l <= 1, and let (x, e, zeta) be a T-periodic solution in `|x| <= X`, `|e| <= E` of the loop
//! with `l q_0` in the place of `q_0 = q(t,0,0)`. The inequality is affine in (J, g, r, d), so it holds of their averages on the
//! segment from (0,0) to (x,e). With y = q + mu s the derivative of `x'P x + e^2 + (k_p mu/2)|zeta|_N^2` has the mean 0, so
//! `c_x rms(x)^2 + 2 (sigma - threshold) rms(e)^2 + c_y rms(y)^2 <= k_p mean(y l q_0) <= k_p Q_m rms(y)`: y has the mean 0 (the
//! integrator), so `q_0` counts without its mean, and `Q_m = sqrt(2 sum_{k>=1} C_k^2) + r_0`. Hence [`Answer`].
//!
//! With an input gain (section 13.1) `d + (1-b) threshold` stands in the place of d, at both ends of b, and `b k_p mu/2` is the weight of
//! `|zeta|_N^2`, with y = q + (1-b) sigma e + b mu s: the mean is the same, and e' = y - sigma e is. At `threshold/l`,
//! 0 < l <= 1, with l k_p, the form is in `(x/sqrt(l), e/sqrt(l), y sqrt(l))` l times the one at the threshold, and (1 - l) times that of
//! e and y with d = 0 besides. So with E4 it is not below `diag(c_x, 0, l c_y)`: rms(y) and rms(x) are bounded as at the threshold, and e by y.
//!
//! In the joint form there are two metrics, of any sign, in the place of P. At a gain `sigma' >= threshold` the one between them
//! has `c_x rms(x)^2 + c_e rms(e)^2 + c_y rms(y)^2 <= k_p Q_m rms(y)` in the same way. The threshold may be sigma itself: c_e > 0 has the part of
//! what a gain above it leaves. The rest is the same, for of P and w no more is used than that.
//!
//! At samples `c_x rms(x)^2 + c_e rms(e)^2 + c_y rms(y)^2 <= gamma Q_m^2`: the sum of the steps of U over a period is 0, and that of y is (the
//! integrator), so `q_0` counts without its mean in both places.
//!
//! Guarantee: with all that `covers`, `enough` and S1b to S2c say, and the inequality proved of the plant's formulas (the crate `proofs-plants` does), there is for
//! every n_o and every sigma' >= sigma a T-periodic solution with sup|x| <= X_p, sup|e| <= E_p, rms(x) <= r_x, rms(e) <= r_e,
//! rms(e') <= r_d, and all that `mean_squares` says of one. For the linear loop with the coefficients of any (x, e) in that box has one
//! periodic answer (with `q_0` = 0 it is 0), which is continuous in them, and its answers to `l q_0` are bounded in H1; by Leray and
//! Schauder it is enough that no solution with 0 < l < 1 has sup|x| = X_p or sup|e| = E_p. Its root mean squares rho satisfy rho <= G(rho),
//! with the concave G of `mean_squares`, and S1c, S2b, S2c say G(r) < r, so rho < r as there. Then S1b and S2 keep it inside.
//! Strictness matters in all five. b_q_rms and b_qt_rms are of q itself and say nothing for l < 1: they are not used.

use super::inequality::{Inequality, Metric, not_above};
use crate::data::Data;
use crate::interval::Interval;
use crate::verdict::Condition;
use rug::Rational;

/// What an inequality says of a periodic solution.
#[derive(Clone)]
pub struct Answer {
    /// `k_p Q_m/(2 sqrt(c_x c_y))`; at samples `sqrt(gamma/c_x) Q_m`, and so on with c_e and c_y.
    pub rms_x: Interval,
    /// `k_p Q_m/(2 sqrt(c_e c_y))`.
    pub rms_e: Interval,
    /// `r_y = k_p Q_m/c_y`; rms(e') too is not larger, nor sg rms(e), and sup|e| <= bt r_y. At samples of y over these.
    pub rms_y: Interval,
}

impl Answer {
    fn max(&self, other: &Answer) -> Answer {
        let [rms_x, rms_e, rms_y] =
            [(&self.rms_x, &other.rms_x), (&self.rms_e, &other.rms_e), (&self.rms_y, &other.rms_y)]
                .map(|(own, other)| own.max(other));
        Answer { rms_x, rms_e, rms_y }
    }
}

impl Inequality {
    /// At the gain sigma and every larger one, with Q_m. With one metric in continuous time c_e is `2 (sigma - threshold)`, and nothing is known of
    /// rms(e) where the threshold is not below sigma, or with an input gain. With two: a quotient of k_p, which is linear in l, by what is
    /// linear in l or concave, as `sqrt(c_x c_y)` is, and above 0, is nowhere larger than at one of the ends.
    pub fn answer(&self, d: &Data<'_>, sigma: &Rational, oscillation: &Interval) -> Answer {
        let of = |metric: &Metric| {
            let [c_x, c_e, c_y] = metric.least.each_ref().map(|value| d.number(value));
            if let Some(gamma) = &metric.gamma {
                let by = |weight: &Interval| (d.number(gamma) / weight).sqrt() * oscillation;
                return Answer { rms_x: by(&c_x), rms_e: by(&c_e), rms_y: by(&c_y) };
            }
            let c_e = match self.far {
                Some(_) => c_e,
                None if *sigma > self.sigma && d.gain.is_none() => d.number(&Rational::from(sigma - &self.sigma)) * 2,
                None => Interval::undefined(d.precision),
            };
            let force = d.number(&Rational::from(&metric.half * 2u32)) * oscillation;
            let by = |weight: &Interval| &force / ((weight * &c_y).sqrt() * 2);
            Answer { rms_x: by(&c_x), rms_e: by(&c_e), rms_y: &force / &c_y }
        };
        let own = of(&self.metric);
        self.far.as_ref().map_or_else(|| own.clone(), |far| own.max(&of(far)))
    }

    /// E1 and E2: X_p and E_p lie where it is proved.
    pub(super) fn covers(&self, d: &Data<'_>, [x_p, e_p]: [&Rational; 2]) -> [Condition; 2] {
        let within = |id, what: &str, ends| not_above(d, id, format!("{what} of the existence inequality"), ends);
        let [x, e] = &self.at;
        [within("E1", "X_p - X", [x_p, x]), within("E2", "E_p - E", [e_p, e])]
    }
}
