//! What a certificate says about the regulated error (derivation, section 6, and 13.3 away from a matched base frequency).

use super::mistuned::Mistuning;
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
    /// Where harmonics of q(t,0,0) are known, [r_0, r_1] of its rest and [d_0, d_1] of what x and e change in q.
    pub split: Option<[[Enclosure; 2]; 2]>,
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

/// Bounds of rms(e) and sup|e| with n_o oscillators, for every sigma' >= sigma.
///
/// Harmonic by harmonic `|e_k| <= s_k |q_k|/sg_k`, `sg_k^2 = sigma^2 + (k Om)^2`, e_0 = 0, with s_k = 0 for k <= n_o at a matched base
/// frequency, where these harmonics vanish, the factor of [`Mistuning`] elsewhere, and s_k = 1 for the rest. So
/// rms(e) <= min{ R_q max s_k/sg_k, R_1 max s_k/(k Om sg_k) },
/// sup|e| <= min{ e_per, R_q sqrt(2 S_0), R_1 sqrt(2 S_1) } with S_0 = sum s_k^2/sg_k^2 and S_1 = sum s_k^2/(k Om sg_k)^2, by
/// Cauchy-Schwarz. With known harmonics the sum of the same for them, for the rest and for the change of q, where that is smaller. With an
/// input gain all of q is over b_m.
///
/// Hypotheses: existence at sigma; `mistuning` is that of the data. Guarantee: both are upper bounds, nonincreasing in n_o up to
/// rounding; e_per also bounds the rms.
#[must_use]
pub fn error_bounds(
    data: &Data<'_>,
    excitation: &Excitation,
    mistuning: Option<&Mistuning>,
    sigma: &Enclosure,
    e_per: &Enclosure,
    n_o: u64,
) -> ErrorBounds {
    let q = |rms: &Enclosure| over_input_gain(data, rms);
    let gains = HarmonicGains::new(data, mistuning, sigma, n_o);
    let [rms, sup] = gains.of(&q(&excitation.q_rms), &q(&excitation.q_rate_rms));
    let (mut rms, mut sup) = (e_per.min(&rms), e_per.min(&sup));
    if let (Some([rest, change]), Some(known)) = (&excitation.split, &data.q_0) {
        let [of_rest, of_change] = [rest, change].map(|[size, rate]| gains.of(&q(size), &q(rate)));
        let sizes: Vec<Enclosure> =
            (1..).zip(known.harmonics.iter().skip(1)).map(|(k, c)| q(c) * gains.at(data, sigma, k)).collect();
        let squares = sizes.iter().fold(data.zero(), |sum, size| sum + size.sqr());
        let sum = sizes.iter().fold(data.zero(), |sum, size| sum + size);
        rms = rms.min(&((2 * squares).sqrt() + &of_rest[0] + &of_change[0]));
        sup = sup.min(&(2 * sum + &of_rest[1] + &of_change[1]));
    }
    ErrorBounds { rms: rms.ceiling(), sup: sup.ceiling() }
}

/// What so many oscillators make of the harmonics of q.
struct HarmonicGains<'m> {
    /// s_1, s_2, ...
    kept: &'m [Enclosure],
    /// Beyond this one every s_k is 1, and up to it 0 where it is not in the list.
    last: u64,
    /// max s_k/sg_k and max s_k/(k Om sg_k).
    rms: [Enclosure; 2],
    /// sqrt(2 S_0) and sqrt(2 S_1).
    sup: [Enclosure; 2],
}

impl HarmonicGains<'_> {
    fn new<'m>(data: &Data<'_>, mistuning: Option<&'m Mistuning>, sigma: &Enclosure, n_o: u64) -> HarmonicGains<'m> {
        let kept = mistuning.map_or(&[][..], |mistuning| {
            &mistuning.factors[..mistuning.factors.len().min(usize::try_from(n_o).unwrap_or(usize::MAX))]
        });
        let last = mistuning.map_or(n_o, |_| kept.len() as u64);
        let first = harmonic(data, u128::from(last) + 1) * &data.fundamental;
        let modulus = (first.sqr() + sigma.sqr()).sqrt();
        let mut rms = [modulus.recip(), (first * modulus).recip()];
        let [mut by_size, mut by_rate] = tail_sums(data, sigma, last);
        for (k, factor) in (1..).zip(kept) {
            let omega = harmonic(data, k) * &data.fundamental;
            let gain = factor / (omega.sqr() + sigma.sqr()).sqrt();
            let of_rate = &gain / omega;
            by_size = by_size + gain.sqr();
            by_rate = by_rate + of_rate.sqr();
            rms = [rms[0].max(&gain), rms[1].max(&of_rate)];
        }
        HarmonicGains { kept, last, rms, sup: [by_size, by_rate].map(|sum| (2 * sum).sqrt()) }
    }

    /// [rms(e), sup|e|] for rms(q) <= size and rms(q') <= rate.
    fn of(&self, size: &Enclosure, rate: &Enclosure) -> [Enclosure; 2] {
        [&self.rms, &self.sup].map(|[by_size, by_rate]| (size * by_size).min(&(rate * by_rate)))
    }

    /// s_k/sg_k for one harmonic k >= 1.
    fn at(&self, data: &Data<'_>, sigma: &Enclosure, k: u64) -> Enclosure {
        let gain = ((harmonic(data, u128::from(k)) * &data.fundamental).sqr() + sigma.sqr()).sqrt().recip();
        match usize::try_from(k - 1).ok().and_then(|at| self.kept.get(at)) {
            Some(factor) => factor * gain,
            None if k <= self.last => data.zero(),
            None => gain,
        }
    }
}

/// The number of a harmonic, enclosed; wider than `u64`, because sums run past the last one.
fn harmonic(data: &Data<'_>, k: u128) -> Enclosure {
    data.rational(&Rational::from(k))
}

/// Upper bounds of the part of S_0 and S_1 beyond `last`, where s_k = 1: a partial sum and the tails
/// `sum_{k>n} 1/((k Om)^2 + sigma^2) <= arctan(sigma/(n Om))/(Om sigma)` and
/// `sum_{k>n} 1/((k Om)^2((k Om)^2 + sigma^2)) <= (1/(n+1)^2 + 1/(n+1))/(Om^2 (((n+1) Om)^2 + sigma^2))`.
fn tail_sums(data: &Data<'_>, sigma: &Enclosure, last: u64) -> [Enclosure; 2] {
    let omega = &data.fundamental;
    let integer = |k: u128| harmonic(data, k);
    let (mut by_size, mut by_rate) = (data.zero(), data.zero());
    let from = u128::from(last);
    let last = from + PARTIAL_TERMS;
    for k in from + 1..=last {
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
