//! What a certificate says about the regulated error (derivation, section 6).

use crate::data::Data;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;

/// Terms of the infinite sums that are added one by one before the tail is bounded.
const PARTIAL_TERMS: u128 = 64;

/// The largest number of oscillators that a target search considers.
pub const MAX_OSCILLATORS: u64 = 1 << 40;

/// What drives the periodic error: bounds of q along the periodic solution, and what x makes of e.
#[derive(Clone, Debug)]
pub struct Excitation {
    /// Of rms(q): R_q.
    pub q_rms: Enclosure,
    /// Of the rms of q's derivative along the solution: R_1.
    pub q_rate_rms: Enclosure,
    /// sup|x| over sup|e|.
    pub x_gain: Enclosure,
}

/// psi_1, psi_x and psi_2: bounds for every n_o and mu at once.
#[derive(Clone, Debug)]
pub struct Psi {
    /// psi_1 = T R_1/sqrt(12), with an input gain over b_m: sup|e| <= psi_1/sigma.
    pub psi_1: Enclosure,
    /// psi_x = (c/a_1) b_fe psi_1: sup|x| <= psi_x/sigma.
    pub psi_x: Enclosure,
    /// psi_2 = T R_q^2/Om^2, Om = 2 pi/T, with an input gain over b_m^2: the integral of e^2 over a period is at most psi_2/(n_o+1)^2 (matched only).
    pub psi_2: Enclosure,
}

impl Psi {
    /// Evaluates the three constants.
    #[must_use]
    pub fn new(data: &Data<'_>, excitation: &Excitation) -> Psi {
        let of_error = |rms: &Enclosure| over_input_gain(data, rms);
        let psi_1 =
            &data.period * of_error(&excitation.q_rate_rms) / Enclosure::from_integer(12, data.precision).sqrt();
        Psi {
            psi_x: &excitation.x_gain * &psi_1,
            psi_1,
            psi_2: &data.period * of_error(&excitation.q_rms).sqr() / data.fundamental.sqr(),
        }
    }
}

/// What bounds q, over b_m where there is an input gain: with it e answers as to that much more of q (derivation, 13.1).
fn over_input_gain(data: &Data<'_>, rms: &Enclosure) -> Enclosure {
    data.input_gain.as_ref().map_or_else(|| rms.clone(), |gain| rms / gain.of_error())
}

/// Certified bounds of the periodic error for one number of oscillators, upper bounds only.
#[derive(Clone, Debug)]
pub struct ErrorBounds {
    /// rms(e) over a period.
    pub rms: Enclosure,
    /// sup|e|.
    pub sup: Enclosure,
}

/// Bounds of rms(e) and sup|e| with n_o oscillators at a matched base frequency, for every sigma' >= sigma.
///
/// Harmonics |k| <= n_o of e vanish and |e_k| <= |q_k|/sqrt((k Om)^2 + sigma^2), so with a = (n_o+1) Om
/// rms(e) <= min{ R_q/sqrt(a^2 + sigma^2), R_1/(a sqrt(a^2 + sigma^2)) },
/// sup|e| <= min{ e_per, R_q sqrt(2 S_0), R_1 sqrt(2 S_1) } with S_0 = sum_{k>n_o} 1/((k Om)^2 + sigma^2) and
/// S_1 = sum_{k>n_o} 1/((k Om)^2 ((k Om)^2 + sigma^2)), by Cauchy-Schwarz. With an input gain R_q and R_1 are over b_m.
///
/// Hypotheses: existence at sigma; base_frequency = 2 pi/T. Guarantee: both are upper bounds, nonincreasing in n_o up to
/// rounding; e_per also bounds the rms.
#[must_use]
pub fn error_bounds(
    data: &Data<'_>,
    excitation: &Excitation,
    sigma: &Enclosure,
    e_per: &Enclosure,
    n_o: u64,
) -> ErrorBounds {
    let omega = &data.fundamental;
    let [q_rms, q_rate_rms] = [&excitation.q_rms, &excitation.q_rate_rms].map(|rms| over_input_gain(data, rms));
    let first = harmonic(data, u128::from(n_o) + 1) * omega;
    let modulus = (first.sqr() + sigma.sqr()).sqrt();
    let rms = e_per.min(&(&q_rms / &modulus)).min(&(&q_rate_rms / (first * modulus)));
    let [by_size, by_rate] = tail_sums(data, sigma, n_o);
    let sup = e_per.min(&(&q_rms * (2 * by_size).sqrt())).min(&(&q_rate_rms * (2 * by_rate).sqrt()));
    ErrorBounds { rms: rms.ceiling(), sup: sup.ceiling() }
}

/// The number of a harmonic, enclosed; wider than `u64`, because sums run past the last one.
fn harmonic(data: &Data<'_>, k: u128) -> Enclosure {
    data.rational(&Rational::from(k))
}

/// Upper bounds of S_0 and S_1: a partial sum and the tails
/// `sum_{k>n} 1/((k Om)^2 + sigma^2) <= arctan(sigma/(n Om))/(Om sigma)` and
/// `sum_{k>n} 1/((k Om)^2((k Om)^2 + sigma^2)) <= (1/(n+1)^2 + 1/(n+1))/(Om^2 (((n+1) Om)^2 + sigma^2))`.
fn tail_sums(data: &Data<'_>, sigma: &Enclosure, n_o: u64) -> [Enclosure; 2] {
    let omega = &data.fundamental;
    let integer = |k: u128| harmonic(data, k);
    let (mut by_size, mut by_rate) = (data.zero(), data.zero());
    let n_o = u128::from(n_o);
    let last = n_o + PARTIAL_TERMS;
    for k in n_o + 1..=last {
        let square = (integer(k) * omega).sqr();
        let term = (&square + sigma.sqr()).recip();
        by_rate = by_rate + &term / square;
        by_size = by_size + term;
    }
    let size_tail = (sigma / (integer(last) * omega)).atan() / (omega * sigma);
    let next = integer(last + 1);
    let rate_tail = (next.sqr().recip() + next.recip()) / (omega.sqr() * ((&next * omega).sqr() + sigma.sqr()));
    [(by_size + size_tail).ceiling(), (by_rate + rate_tail).ceiling()]
}

/// The smallest n_o (up to [`MAX_OSCILLATORS`]) whose bound, chosen by `of`, is certainly at most `target`.
///
/// Guarantee: the bound at the returned n_o is proved to be at most the target. (It is the smallest for which that is
/// provable with these formulas, which decrease in n_o up to rounding.) `None` if none was found.
#[must_use]
pub fn smallest_n_o(target: &Enclosure, of: impl Fn(u64) -> Enclosure) -> Option<u64> {
    let reaches = |n_o: u64| of(n_o).le(target).is_true();
    if reaches(0) {
        return Some(0);
    }
    let mut high: u64 = 1;
    while !reaches(high) {
        high *= 2;
        if high > MAX_OSCILLATORS {
            return None;
        }
    }
    let mut low = high / 2;
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if reaches(middle) { high = middle } else { low = middle }
    }
    Some(high)
}
