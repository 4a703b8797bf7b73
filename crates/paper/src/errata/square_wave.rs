//! The periodic error of an integrator loop under a nearly square wave, enclosed (the evidence of E10).
//!
//! e' = q - sigma e + mu n_0 zeta, zeta' = -mu n_0 zeta - q (n_o = 0) with n_0 = 2, mu = 10, T = 4, sigma = 4000 and
//! q(t) = tanh(2000 sin(pi t/2)). Put Z = mu n_0 zeta, W = sigma e, y = q + Z, a = mu n_0 = 20:
//! Z' = -a (Z + q), W' = -sigma (W - y). The periodic solution inherits q(t+2) = -q(t), and q(2-t) = q(t).

use super::numbers::{integer, pi, ratio, rational};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;

/// a = mu n_0.
const RATE: i64 = 20;

/// sigma.
const SIGMA: i64 = 4000;

/// The steps of the partition, each of 1/200000: together 4 ms, beyond which q is 1 but for 1e-10.
const STEPS: i64 = 800;

/// Steps per unit of time.
const STEPS_PER_UNIT: i64 = 200_000;

/// An enclosure of sigma sup|e_p|.
///
/// Guarantee: contains the number. On `[0, 1]` q increases from 0, so on each step of a partition it lies between its
/// values at the two ends; Z and W then follow from their explicit solutions. With u counted back from t = 2:
/// Z(0) (1 + e^(-2a)) = a int_0^2 e^(-a u) q(u) du and W(0) (1 + e^(-2 sigma)) = -sigma int_0^2 e^(-sigma u) y(2-u) du.
pub(super) fn scaled_supremum() -> Enclosure {
    let nodes: Vec<Enclosure> = (0..=STEPS).map(|i| wave(&ratio(i, STEPS_PER_UNIT))).collect();
    let step = ratio(1, STEPS_PER_UNIT);
    let end = Rational::from(&step * STEPS);
    let decay = |rate: i64, time: &Rational| (-(integer(rate) * rational(time))).exp();
    let (z_decay, w_decay) = (decay(RATE, &step), decay(SIGMA, &step));
    let unit = Enclosure::between(&Rational::new(), &Rational::from(1), z_decay.precision());

    // rate int_0^1 e^(-rate u) q(u) du: step by step up to `end`, and with q between q(end) and 1 from there on.
    let weighted = |rate: i64, step_decay: &Enclosure| {
        let mut sum = integer(0);
        let mut weight = integer(1);
        for ends in nodes.windows(2) {
            let next = &weight * step_decay;
            sum = sum + (&weight - &next) * ends[0].hull(&ends[1]);
            weight = next;
        }
        let last = decay(rate, &Rational::from(1));
        sum + (decay(rate, &end) - last) * wave(&end).hull(&integer(1))
    };
    // On [1, 2] all that is used is 0 <= q <= 1.
    let late = (decay(RATE, &Rational::from(1)) - decay(RATE, &Rational::from(2))) * &unit;
    let z_start = (weighted(RATE, &z_decay) + late) / (1 + decay(RATE, &Rational::from(2)));

    // Z(2) = -Z(0), and going back by u <= `end`: -1 <= Z(2-u) <= e^(a u) (1 - Z(0)) - 1, because 0 <= q <= 1 and
    // |Z| <= 1. Before that |y| <= 2 (weight e^(-sigma end)).
    let z_before = integer(-1).hull(&((1 - &z_start) / decay(RATE, &end) - 1));
    let near = 1 - decay(SIGMA, &end);
    // `weighted` runs over [0, 1], where q >= 0: the part beyond `end` is at most e^(-sigma end).
    let far = decay(SIGMA, &end) * Enclosure::between(&Rational::from(-3), &Rational::from(3), z_decay.precision());
    let w_start = -(weighted(SIGMA, &w_decay) + near * z_before + far) / (1 + decay(SIGMA, &Rational::from(2)));

    let (mut z, mut w) = (z_start, w_start);
    let mut largest = w.clone();
    for ends in nodes.windows(2) {
        let q = ends[0].hull(&ends[1]);
        // Within the step Z is a mean of Z at the left end and of -q, with a weight of Z between `z_decay` and 1.
        let z_next = &z_decay * &z - (1 - &z_decay) * &q;
        let y = &q + z.hull(&z_next);
        let w_next = &w_decay * &w + (1 - &w_decay) * y;
        largest = largest.max(&w_next);
        (z, w) = (z_next, w_next);
    }
    if !z.is_positive().is_true() {
        return Enclosure::undefined(z.precision());
    }
    // Within a step W is a mean of W at the left end, with weight at least `w_decay`, and of y: so the upper ends above
    // cover the whole step, while the lower ends hold at nodes. After the last node Z <= Z(end), y <= 1 + Z(end) and
    // W <= max(W(end), 1 + Z(end)). W >= inf y >= -1 everywhere, and W(t+2) = -W(t).
    let above = largest.max(&(1 + &z));
    largest.hull(&above)
}

/// q(t) at a time in `[0, 1]`.
fn wave(time: &Rational) -> Enclosure {
    (2000 * (pi() * rational(time) / 2).sin()).tanh()
}
