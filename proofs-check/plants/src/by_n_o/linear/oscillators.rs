//! What the oscillators of a matched base frequency make of a harmonic k at which there is none (docs/mathematics.md, sections 14.3, 14.6 and 14.7).
//!
//! With `g = g_H(k) = sum over |l| in H of c_l/(l - k)`, H their harmonics, `c_0 = n_0` and else `c_l = n_|l|/2`, and `y_k = nu g`, the control has the harmonic
//! `u_k = -(sigma + i y_k (i om_k + sigma)) e_k`, for `mu s_k = -i y_k (i om_k + sigma) e_k`; and `|zeta_k|_N = sqrt(g_H'(k)) |i om_k + sigma| |e_k|/Om`.
//!
//! At samples, with `z = e^(i om_k h)`, `u_k = -kappa_k e_k`, `y_k = Delta_k e_k` and `|zeta_k|_N = h |y_k| sqrt(sum c_l/(4 sin^2((k-l) Om h/2)))`, where
//! `Delta_k = (z - 1)/h + sigma` and `kappa_k = sigma + K h g_k Delta_k`, `g_k = -(1/2) sum c_l (1 + i cot((k-l) Om h/2))`; with a delay
//! `Delta_k = z ((z - 1)/h + sigma)/(z + h sigma)` and `kappa_k = sigma/(z + h sigma) + K h (g_k - b_1/z) Delta_k`, `b_1 = sum over l in H of n_l cos(l Om h)`.

use super::complex::Complex;
use super::jet::Number;
use proofs_core::interval::Interval;
use proofs_core::rules::by_n_o::oscillators::Oscillators;
use proofs_core::spec::InternalModel;

/// The regulator of the claim at one precision.
pub struct Regulator<'s> {
    /// The weights.
    pub model: &'s InternalModel,
    /// The gain.
    pub sigma: Interval,
    /// mu; at samples K.
    pub mu: Interval,
    /// `Om = 2 pi/T`, the base frequency.
    pub om: Interval,
    /// Of a regulator at samples.
    pub at_samples: Option<Sampling>,
}

/// How a regulator samples.
pub struct Sampling {
    /// h.
    pub h: Interval,
    /// N_s.
    pub samples: u32,
    /// Whether a control is computed in the sample before it acts.
    pub delayed: bool,
}

/// Of a harmonic without an oscillator.
pub struct Beyond {
    /// `-u_k/e_k`: `sigma + i y_k (i om_k + sigma)`, or kappa_k.
    pub turn: Complex,
    /// `|zeta_k|_N/|e_k|`.
    pub size: Interval,
    /// `|y_k|/|e_k|`.
    pub moved: Interval,
}

impl Sampling {
    /// `e^(i k Om h)`: `Om h = 2 pi/N_s`.
    pub fn turn(&self, k: i64) -> Complex {
        let angle = Interval::pi(self.h.precision()) * (2 * k) / i64::from(self.samples);
        Complex { re: angle.cos(), im: angle.sin() }
    }

    /// `(e^(i k Om h) - 1)/h`.
    pub fn speed(&self, k: usize) -> Complex {
        let turn = self.turn(k as i64);
        Complex { re: (turn.re - 1) / &self.h, im: turn.im / &self.h }
    }
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

    /// The harmonic k >= 1 of a control at its instants, from that of its means over the samples that follow; in continuous time both are one.
    pub fn put_out(&self, k: usize, mean: Complex) -> Complex {
        let Some(sampling) = &self.at_samples else { return mean };
        let Complex { re, im } = sampling.speed(k).scaled(&self.frequency(k).recip());
        // Over i: re + i im becomes im - i re.
        mean.times(&Complex { re: im, im: -re })
    }

    /// Of a harmonic k >= 1 that is not among them: the terms l and -l of g are `-n_l k/(k^2 - l^2)` together, and those of g'
    /// `n_l (k^2 + l^2)/(k^2 - l^2)^2`. They are not defined where k is one of them.
    pub fn beyond(&self, own: &Oscillators, k: usize) -> Beyond {
        if let Some(sampling) = &self.at_samples {
            return self.at_samples(sampling, own, k);
        }
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
        let moved = (frequency.sqr() + self.sigma.sqr()).sqrt();
        Beyond { turn, size: slope.sqrt() * &moved / &self.om, moved }
    }

    /// The same at samples. The terms of l and -l are not defined where k is one of the oscillators.
    fn at_samples(&self, sampling: &Sampling, own: &Oscillators, k: usize) -> Beyond {
        let Sampling { h, samples, delayed } = sampling;
        let p = self.om.precision();
        let (mut g, mut square, mut last) = (Complex::zero(p), Interval::int(0, p), Interval::int(0, p));
        for l in own.harmonics() {
            let n_l = self.weight(*l as usize);
            last = last + &n_l * sampling.turn(i64::from(*l)).re;
            let (c_l, both) = if *l == 0 { (n_l, 1) } else { (n_l / 2, 2) };
            for sign in [1, -1].into_iter().take(both) {
                let half = Interval::pi(p) * (k as i64 - sign * i64::from(*l)) / i64::from(*samples);
                let (cos, sin) = (half.cos(), half.sin());
                g = Complex { re: g.re - &c_l / 2, im: g.im - &c_l * cos / (&sin * 2) };
                square = square + &c_l / (sin.sqr() * 4);
            }
        }
        let (z, sigma) = (sampling.turn(k as i64), Complex::real(self.sigma.clone()));
        let way = sampling.speed(k).plus(&sigma);
        let (delta, direct, pulled) = match delayed {
            false => (way, sigma, g),
            true => {
                let ahead = z.plus(&Complex::real(h * &self.sigma));
                let pulled = g.plus(&Complex::real(last).over(&z).opposite());
                (z.times(&way).over(&ahead), sigma.over(&ahead), pulled)
            }
        };
        let turn = direct.plus(&pulled.times(&delta).scaled(&(&self.mu * h)));
        let moved = delta.square().sqrt();
        Beyond { turn, size: h * &moved * square.sqrt(), moved }
    }
}
