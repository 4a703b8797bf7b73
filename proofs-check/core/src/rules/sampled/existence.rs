//! Rules S1 and S2 for a sampled regulator: the periodic solution, at every phase of the sampling grid (docs/mathematics.md,
//! section 12.2).
//!
//! Guarantee: for every n_o < N_s/2 there is a T-periodic solution with sup|x| <= X_p, sup|e| <= E_p at all times, rms(x) <= r_x,
//! rms(e) <= r_e, rms(e') <= r_d, and `|zeta_k|_N <= Z` at all samples. Nothing is said of another sigma or h. The bounds of `q_0`
//! for the response to harmonics are those of a continuous regulator, and are not used; what it says of q is. With an inequality of
//! existence S1b to S2c are strict, and what it says of the solution is in their minima.

use super::delay;
use super::gains::Gains;
use super::law::Law;
use crate::interval::Interval;
use crate::rules::control;
use crate::rules::inequality::Inequality;
use crate::rules::mean_squares::{Bounds, Means};
use crate::verdict::Condition;

/// What is proved of the periodic solution.
pub struct Solution {
    pub x: Interval,
    pub e: Interval,
    pub z: Interval,
    /// A bound of |u| along it.
    pub steady: Interval,
    /// A bound of |y_k| along it.
    pub largest_y: Interval,
    pub conditions: Vec<Condition>,
}

/// Evaluates S1 and S2; `pair` is (k0, k1), which the transfer rule has to settle.
pub fn evaluate(
    law: &Law<'_>,
    (means, inequality): (&Means, Option<&Inequality>),
    [x_p, e_p]: [&Interval; 2],
    pair: [&Interval; 2],
) -> Solution {
    let d = law.d;
    let mut bounds = Bounds::new(d, &law.sigma, [x_p, e_p]);
    if inequality.is_some() {
        bounds = bounds.for_any_share_of_forcing();
    }
    let r = means.each_ref().map(|value| d.number(value));
    let [_, r_e, r_d] = &r;
    let [[r_q, r_1], _] = bounds.inputs(&r);
    let gains = Gains::new(law);
    let pi = Interval::pi(d.precision);
    // Between samples e is a linear interpolation and G, which vanishes at both ends: sup|G| and rms(G).
    let period = &d.period.only();
    let between = &law.h / (&pi * 2) * (&law.h * period).sqrt() * &r_1;
    let between_rms = (&law.h / &pi).sqr() * &r_1;
    let at_samples = (&gains.sup * &r_q).least(&(&gains.sup_t * &r_1));
    // sum e_k = 0, so e has a zero.
    let mut sup_e = (&at_samples + between).least(&(period * r_e * r_d).sqrt());
    let mut rms_e = (&gains.rms * &r_q).least(&(&gains.rms_t * &r_1)) + between_rms;
    let mut rms_e_t = (&gains.slope * &r_q).least(&((gains.rms.sqr() + (&law.h / &pi).sqr()).sqrt() * &r_1));

    let answer = inequality.map(|inequality| inequality.answer(d, &inequality.sigma, &bounds.oscillation()));
    let mut what = ["sup|e|", "rms(e)", "rms(e')"];
    if let Some(answer) = &answer {
        // sup|G| <= (sqrt(h)/2)|G'|_2, and e' is the slope of the interpolation and G', which are orthogonal.
        sup_e = sup_e.least(&(&gains.sup_y * &answer.rms_y + (&law.h * period).sqrt() / 2 * &r_q));
        rms_e = rms_e.least(&answer.rms_e);
        rms_e_t = rms_e_t.least(&((&answer.rms_y * 2 / (2 - &law.share)).sqr() + r_q.sqr()).sqrt());
        what = [
            "12.2, sqrt(T r_e r_d), bt_h r_y + (sqrt(h T)/2) R_q",
            "12.2, sqrt(gamma/c_e) Q_m",
            "12.2, sqrt((2 r_y/(2 - h sigma))^2 + R_q^2)",
        ];
    }
    let said = answer.as_ref().map(|answer| (answer, "sqrt(gamma/c_x) Q_m"));
    let conditions = bounds.stay(&r, &[sup_e.clone(), rms_e, rms_e_t], what, said);
    let e = e_p.min(&sup_e);
    let w_squared = d.w.sqr();
    let mean = (period / (&law.mu * 2) + pair[0] / &w_squared) * r_q.sqr() + pair[1] / w_squared.sqr() * r_1.sqr();
    // The input of zeta is what y is without b K v_k, so (1-b) sigma e_k is in it.
    let [up, down] = law.shifts(&(&law.sigma * &gains.prediction));
    let shifted = 1 + up.max(&-down);
    let (z, of_u) = if law.delayed {
        // Each |y_j| is at most 1 + th1 times what drives zeta, which is at most `shifted` times |q_j|; a step raises |zeta|_N^2 by at
        // most `h q^2/(2 b K cq) + h^2 Nb2 y_{k-1}^2`, cq = 1 - b K h Nb2.
        let load = |gain: &Interval| 1 - gain * &law.h * law.sum();
        let raised = |gain: Interval| (&gain * 2 * load(&gain)).recip();
        let [low, high] = [d.by_gain(|gain| &gain.low, &law.gain), d.by_gain(|gain| &gain.high, &law.gain)];
        let raised = raised(low).max(&raised(high)) * shifted.sqr() + &law.h * law.sum() * gains.of_y.sqr();
        let share = (law.of_y() * &shifted).sqr();
        let mean = &share * (pair[0] / &w_squared * r_q.sqr() + pair[1] / w_squared.sqr() * r_1.sqr());
        let z = (period * raised * r_q.sqr() + mean).sqrt();
        // u = -sigma et + K M'N R^2 zeta_{k-1}.
        (z, at_samples / law.ahead())
    } else {
        (&law.growth * mean.sqrt() * shifted, e.clone())
    };
    let by_parts = control::by_parts(d, [&law.sigma, &law.gain], [&of_u, &z]);
    let largest_y = delay::largest(law, &gains.of_y, [&r_q, &r_1]);
    let steady = law.answer(&gains.slope_by_y).steady(&bounds.along(&r), &by_parts);
    Solution { x: bounds.sup_x(&e, r_e), z, steady, largest_y, e, conditions }
}
