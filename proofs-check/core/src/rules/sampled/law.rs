//! Rule S0: the sampled law that is claimed, and the numbers that follow from it (docs/mathematics.md, section 12).
//!
//! `u_k = -sigma e_k + K v_k`, `v_k = M'N R (z_k - M e_k)`, `z_{k+1} = R (z_k - M e_k) + (1 - h sigma) M e_k`, `R = e^{Phi h}`, with
//! `h = T/N_s` and 2 n_o < N_s. Guarantee, where the conditions hold: for every such n_o, and every set of harmonics below N_s/2 that contains 0 (section
//! 14.7), the response y of `q_k + K v_k` to a periodic input has `|y_j| <= (1 + theta)|q_j|` in every harmonic, and none at j = 0; the loop
//! without input is stable.
//!
//! With an input gain (section 13.1) `y_k = qb_k + (1-b) sigma e_k + b K v_k`: the loop of gain 1 with b K for K, and the means of
//! `q + (1-b) sigma e_k` for those of q. theta is that of `b_hi K`, the largest, and mu that of `b_lo K`, so `mu <= b K (1 + theta)` for
//! every b, and a step raises `|zeta|_N^2` by `h (1 + theta_b) q^2/(2 b K)`, which is at most `h (1 + theta)^2 q^2/(2 mu)`.

use crate::data::Data;
use crate::interval::Interval;
use crate::rules::control::Answer;
use crate::scope::Scope;
use crate::verdict::{Condition, Outcome, Verdict, demand, finding};
use rug::Rational;

/// The name of this rule.
pub const RULE: &str = "sampled regulator";
/// The most samples in a period: the sums of section 12.1 have as many terms.
const MAX_SAMPLES: u32 = 65_536;
/// How far mu may lie from that of the specification, relatively: one part in this many.
const MU_PARTS: i64 = 1_000_000;

/// What is claimed of the law.
#[derive(Clone, Debug)]
pub struct Terms {
    pub sigma: Rational,
    /// N_s >= 2.
    pub samples: u32,
    /// K.
    pub gain: Rational,
    /// Nb2, at least the sum of all weights.
    pub weight_sum: Rational,
    /// Whether a control is computed in the sample before it acts.
    pub delayed: bool,
    /// Which oscillators the claim is about.
    pub scope: Scope,
}

/// The numbers of section 12 under their names there.
pub struct Law<'a> {
    pub d: &'a Data<'a>,
    pub samples: u32,
    pub sigma: Interval,
    /// h = T/N_s.
    pub h: Interval,
    /// h sigma.
    pub share: Interval,
    /// a = 1 - h sigma >= 0.
    pub a: Interval,
    /// K.
    pub gain: Interval,
    /// K (1 + theta) with theta of K, which need not be exactly the mu of the specification.
    nominal: Interval,
    /// b_hi K h Nb2/2 = theta/(1 + theta).
    pub loss: Interval,
    /// 1 + theta = 1/(1 - b_hi K h Nb2/2).
    pub growth: Interval,
    /// mu = b_lo K (1 + theta) with theta of b_lo K.
    pub mu: Interval,
    /// Whether a control is computed in the sample before it acts (section 13.4).
    pub delayed: bool,
    /// Which oscillators the claim is about.
    pub scope: Scope,
    weight_sum: Interval,
}

impl<'a> Law<'a> {
    /// Encloses the numbers; N_s is the one that is claimed, so h is T/N_s exactly.
    pub fn new(d: &'a Data<'a>, terms: &Terms) -> Law<'a> {
        let [sigma, gain, weight_sum] = [&terms.sigma, &terms.gain, &terms.weight_sum].map(|value| d.number(value));
        let h = d.period.only() / i64::from(terms.samples);
        // Where T is rational h sigma may be exactly 1.
        let share = match d.spec.period.exact().and_then(|period| period.rational()) {
            Some(period) => d.number(&(period * &terms.sigma / terms.samples)),
            None => &h * &sigma,
        };
        let loss = |gain: &Interval| gain * &h * &weight_sum / 2;
        let growth = |loss: &Interval| {
            let rest = 1 - loss;
            if rest.is_positive() { rest.recip() } else { Interval::undefined(d.precision) }
        };
        let mu = |gain: &Interval| gain * growth(&loss(gain));
        let (nominal, loss) = (mu(&gain), loss(&d.by_gain(|ends| &ends.high, &gain)));
        Law {
            a: (1 - &share).max(&d.int(0)),
            mu: mu(&d.by_gain(|ends| &ends.low, &gain)),
            growth: growth(&loss),
            samples: terms.samples,
            delayed: terms.delayed,
            scope: terms.scope,
            d,
            sigma,
            h,
            share,
            gain,
            nominal,
            loss,
            weight_sum,
        }
    }

    /// Nb2.
    pub fn sum(&self) -> &Interval {
        &self.weight_sum
    }

    /// The bound of `|y_j|` over `|q_j|`, without a gain: 1 + theta; with a delay `1 + th1 = 1/(1 - 3 b_hi K h Nb2/2)`, for the real part of
    /// `1 + K h G - K h b1 E^-1` is at least `1 - K h Nb2/2 - K h Nb2`.
    pub fn of_y(&self) -> Interval {
        let rest = 1 - &self.loss * 3;
        if !self.delayed {
            self.growth.clone()
        } else if rest.is_positive() {
            rest.recip()
        } else {
            Interval::undefined(self.d.precision)
        }
    }

    /// What e has besides with a delay, 1 + h sigma: `e_j = (1 + h sigma E^-1) y_j/D_j`.
    pub fn ahead(&self) -> Interval {
        if self.delayed { 1 + &self.share } else { self.d.int(1) }
    }

    /// How the control answers the means of q: with g = 2 (1 + theta)/(2 - h sigma) the factor is `2/sqrt(4 - g)` for g <= 3 and `g - 1` for
    /// g >= 3, which is 2 at 3 and rises with g; `sum 1/om_j^2 = (T^2 - h^2)/12` over the samples. With a gain b u_k is
    /// `(e_{k+1} - e_k)/h - qb_k` and u_0 `-q_0/b`: the factor is `(1 + g)/b`, with the g that bounds the differences of e by q.
    pub fn answer(&self, g: &Interval) -> Answer {
        let (mean, factor) = match &self.d.gain {
            Some(gain) => (gain.low.recip(), (g + 1) / &gain.low),
            // u_k is (e_{k+1} - e_k)/h - qb_k here too.
            None if self.delayed => (self.d.int(1), g + 1),
            None if (3 - g).is_nonnegative() => (self.d.int(1), 2 / (4 - g).sqrt()),
            None => (self.d.int(1), (g - 1).max(&self.d.int(2))),
        };
        let by_rate = &factor * ((self.d.period.only().sqr() - self.h.sqr()) / 12).sqrt();
        Answer { mean, factor, by_rate }
    }

    /// The square of `|e_j|` over that of `|q_j|` with a gain, from `om_j^2` and `|D_j|^2`, where `D_j = (e^{i om h} - a)/h` has the real part
    /// `sigma - (h/2) om_j^2`: `|D_j|^2` over the square of the least over b of `|D_j|^2/(1 + theta) - (1-b) sigma Re D_j`. That is linear in b,
    /// and not above `|D_j|` times the distance of `(1-b) sigma` from the line `D_j (1 - beta + i Y)`, `1 - beta >= 1/(1 + theta)`, for
    /// `q_j = (D_j (1 - beta + i Y) - (1-b) sigma) e_j`. Nothing is known where it is not above 0. With a delay this is of the prediction
    /// et in the place of e: `y_j = D_j E et_j`, and `q_j = (1 + b K h G - b K h b1 E^-1) y_j - (1-b) sigma et_j`.
    pub fn of_error(&self, frequency_squared: &Interval, size_squared: &Interval) -> Interval {
        let real = &self.sigma - &self.h / 2 * frequency_squared;
        let [up, down] = self.shifts(&(&self.sigma * real));
        let least = match self.delayed {
            false => size_squared / &self.growth - up.max(&down),
            true => {
                let [up, down] = self.shifts(&self.sigma);
                size_squared / self.of_y() - size_squared.sqrt() * up.max(&-down)
            }
        };
        if least.is_positive() { size_squared / least.sqr() } else { Interval::undefined(self.d.precision) }
    }

    /// `(1-b) moved` at b_lo, and at b_hi: 0 without a gain.
    pub fn shifts(&self, moved: &Interval) -> [Interval; 2] {
        self.d.gain.as_ref().map_or_else(|| [0; 2].map(|zero| self.d.int(zero)), |gain| gain.shifts(moved))
    }

    /// S0, all of it decided here: what follows is not even defined without it.
    pub fn conditions(&self, pointer: &str) -> Outcome<Vec<Condition>> {
        let d = self.d;
        let matched = Some(d.spec.regulator.matched);
        demand(matched, RULE, pointer, "a sampled regulator needs `matched` in the specification")?;
        if self.samples > MAX_SAMPLES {
            let message = format!("more than {MAX_SAMPLES} samples in a period are not looked at");
            return Err(finding(Verdict::Undecided, RULE, pointer, message));
        }
        let apart = (&self.nominal - &d.mu).abs();
        let largest = if d.gain.is_some() { "b_hi K" } else { "K" };
        let (times, load) = if self.delayed { ("3 ", &self.loss * 6) } else { ("", &self.loss * 2) };
        let conditions = vec![
            Condition::at_most("S0", "h sigma <= 1", self.share.clone(), d.int(1)),
            Condition::at_most("S0b", "Nbar^2 <= weight_sum", d.n_bar.sqr(), self.weight_sum.clone()),
            Condition::less("S0c", format!("{times}{largest} h weight_sum < 2"), load, d.int(2)),
            Condition::at_most("S0d", "|K (1 + theta) - mu| <= mu/10^6", apart, &d.mu / MU_PARTS),
        ];
        conditions.iter().try_for_each(|condition| condition.demand(RULE, pointer))?;
        // A larger sum would let a smaller K pass for the mu that is asked for.
        let largest = d.n_bar.sqr() * (d.int(1) + d.int(1) / MU_PARTS);
        let what = "weight_sum <= Nbar^2 (1 + 1/10^6)";
        Condition::at_most("S0b", what, self.weight_sum.clone(), largest).demand(RULE, pointer)?;
        Ok(conditions)
    }

    /// sin(pi j/N_s).
    pub fn sine(&self, j: u32) -> Interval {
        (Interval::pi(self.d.precision) * i64::from(j) / i64::from(self.samples)).sin()
    }

    /// om_j^2 = (2/h)^2 sin^2(pi j/N_s), from the sine.
    pub fn frequency_squared(&self, sine: &Interval) -> Interval {
        (sine * 2 / &self.h).sqr()
    }
}
