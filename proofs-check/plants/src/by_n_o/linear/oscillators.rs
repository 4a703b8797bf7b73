//! What the oscillators of a matched base frequency make of a harmonic k at which there is none (docs/mathematics.md, sections 14.3 and 14.7).
//!
//! With `g = g_H(k) = sum over |l| in H of c_l/(l - k)`, H their harmonics, `c_0 = n_0` and else `c_l = n_|l|/2`, and `y_k = nu g`, the control has the harmonic
//! `u_k = -(sigma + i y_k (i om_k + sigma)) e_k`, for `mu s_k = -i y_k (i om_k + sigma) e_k`; and `|zeta_k|_N = sqrt(g_H'(k)) |i om_k + sigma| |e_k|/Om`.

use super::complex::Complex;
use proofs_core::interval::Interval;
use proofs_core::rules::by_n_o::oscillators::Oscillators;
use proofs_core::spec::InternalModel;

/// The regulator of the claim at one precision.
pub struct Regulator<'s> {
    /// The weights.
    pub model: &'s InternalModel,
    /// The gain.
    pub sigma: Interval,
    /// mu.
    pub mu: Interval,
    /// `Om = 2 pi/T`, the base frequency.
    pub om: Interval,
}

/// Of a harmonic without an oscillator.
pub struct Beyond {
    /// `sigma + i y_k (i om_k + sigma)`.
    pub turn: Complex,
    /// `sqrt(g_H'(k)) |i om_k + sigma|/Om`.
    pub size: Interval,
}

impl Regulator<'_> {
    /// `om_k = k Om`.
    pub fn frequency(&self, k: usize) -> Interval {
        &self.om * k as i64
    }

    /// n_l.
    pub fn weight(&self, l: usize) -> Interval {
        self.model.weights.weight(l as u64, self.om.precision())
    }

    /// Of a harmonic k >= 1 that is not among them: the terms l and -l of g are `-n_l k/(k^2 - l^2)` together, and those of g'
    /// `n_l (k^2 + l^2)/(k^2 - l^2)^2`. They are not defined where k is one of them.
    pub fn beyond(&self, own: &Oscillators, k: usize) -> Beyond {
        let square = (k * k) as i64;
        let n_0 = self.weight(0);
        let (mut g, mut slope) = (-(&n_0 / k as i64), &n_0 / square);
        for l in own.harmonics().iter().skip(1) {
            let (n_l, of_l) = (self.weight(*l as usize), i64::from(*l) * i64::from(*l));
            g = g - &n_l * k as i64 / (square - of_l);
            slope = slope + n_l * (square + of_l) / ((square - of_l) * (square - of_l));
        }
        let (y, frequency) = (&self.mu / &self.om * g, self.frequency(k));
        let turn = Complex { re: &self.sigma - &y * &frequency, im: y * &self.sigma };
        let size = slope.sqrt() * (frequency.sqr() + self.sigma.sqr()).sqrt() / &self.om;
        Beyond { turn, size }
    }
}
