//! What the regulator with the oscillators of an entry puts out with the e of a trial, harmonic by harmonic (docs/mathematics.md, section 14.4).

use crate::by_n_o::linear::complex::Complex;
use crate::by_n_o::linear::jet::Number;
use crate::by_n_o::linear::oscillators::Regulator;
use proofs_core::interval::Interval;
use proofs_core::rules::by_n_o::curves::Curves;
use proofs_core::rules::by_n_o::oscillators::Oscillators;
use proofs_core::wave::Wave;

/// Of curves.
pub struct Answer {
    /// `2 sum |uhat_k - uhat*_k|`, `uhat*_k = -(sigma + i y_k (i om_k + sigma)) ehat_k`, over the k >= 1 without an oscillator. At samples uhat is what the control is
    /// in the mean over a sample, and stands here with what it is at the start of one: `(e^(i om_k h) - 1)/(i om_k h) uhat_k`, and `-kappa_k ehat_k`.
    pub kappa: Interval,
    /// zhat, a bound of the part of `|zeta|_N` with the output `uhat*`.
    pub zeta: Interval,
}

/// `a_k - i b_k`, twice the harmonic k.
fn twice(wave: &Wave, k: usize, precision: u32) -> Complex {
    let [re, im] = wave.harmonic(k).map(|value| Interval::rational(&value, precision));
    Complex { re, im: -im }
}

impl Answer {
    /// `zhat^2` is at first `uhat_0^2/(mu^2 n_0) + sum 4 |uhat_k|^2/(mu^2 n_k)` over the k >= 1 with one.
    pub fn new(regulator: &Regulator<'_>, own: &Oscillators, Curves { e, u, .. }: &Curves) -> Answer {
        let p = regulator.om.precision();
        let zero = || Interval::int(0, p);
        let over = |square: Interval, k: usize| square / (regulator.mu.sqr() * regulator.weight(k));
        let first = over(Interval::rational(&u.mean, p).sqr(), 0);
        let later = own.harmonics().iter().skip(1).map(|k| *k as usize);
        let within = later.fold(first, |sum, k| sum + over(twice(u, k, p).square(), k));
        let (mut kappa, mut beyond) = (zero(), zero());
        for k in (1..=e.harmonics.len().max(u.harmonics.len())).filter(|k| !own.contains(*k)) {
            let [error, output] = [e, u].map(|wave| twice(wave, k, p));
            let of_k = regulator.beyond(own, k);
            let output = regulator.put_out(k, output);
            kappa = kappa + output.plus(&of_k.turn.times(&error)).square().sqrt();
            beyond = beyond + of_k.size * error.square().sqrt();
        }
        Answer { kappa, zeta: within.sqrt() + beyond }
    }
}
