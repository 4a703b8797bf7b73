//! Trials (derivation, 14.4), in doubles: nothing is claimed of them.
//!
//! - here: the periodic solution of one loop with a given number of oscillators, by Fourier collocation and Newton's method;
//! - `fitted`: polynomials in the parameters through those of several members of a family;
//! - `rounded`: in short rationals;
//! - `sampled`: how good they are.

mod fitted;
mod rounded;
mod sampled;

pub use fitted::Members;
pub use sampled::sampled_defects;

use crate::orbit::{Field, FloatSeries};
use nalgebra::{DMatrix, DVector};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::Oscillators;
use std::f64::consts::{PI, TAU};

/// The numbers of harmonics, in turn.
const HARMONICS: [usize; 5] = [8, 16, 24, 32, 60];

/// Unknowns of Newton's method; its effort grows with their cube.
const MAX_UNKNOWNS: usize = 500;

/// Newton's steps for one number of harmonics, and halvings of a step that does not help.
const MAX_STEPS: usize = 20;
const MAX_HALVINGS: usize = 8;

/// A step after which nothing gets better, relative to the unknowns.
const SETTLED: f64 = 1e-13;

/// The share of the size of a solution that the last harmonics have at most where there are the most of them; and where samples tell no more apart.
const ACCEPTED: f64 = 1e-9;
const ACCEPTED_AT_SAMPLES: f64 = 1e-5;

/// What a loop is.
#[derive(Clone, Debug)]
pub struct TrialLoop<'a> {
    /// The plant, one member of a family.
    pub plant: &'a Plant,
    /// b, the gain of the actuator over its nominal value.
    pub gain: f64,
    /// sigma.
    pub sigma: f64,
    /// mu; at samples K.
    pub mu: f64,
    /// N_s, at samples: uhat is what the control is in the mean over the sample that follows.
    pub samples: Option<u32>,
    /// At which harmonics the oscillators are.
    pub oscillators: Oscillators,
    /// n_0, and those of these harmonics.
    pub weights: Vec<f64>,
    /// The share of the size of a solution that the last harmonics have at most, where there are enough of them.
    pub resolved: f64,
    /// Whether the trial is for every larger number, too: without an error, and uhat without harmonics above N.
    pub or_more: bool,
}

/// xhat, in the plant's own coordinates, ehat and uhat, one after the other.
#[derive(Clone, Debug)]
pub struct FloatTrial {
    /// The curves.
    pub series: FloatSeries,
    /// What each component is small beside.
    pub sizes: Vec<f64>,
}

impl TrialLoop<'_> {
    /// Whether e has no harmonic k: an oscillator meets it, or e vanishes.
    fn meets(&self, k: usize) -> bool {
        self.or_more || self.oscillators.meets(k)
    }

    /// `sigma + i y_k (i om_k + sigma)`, by which the regulator multiplies -e_k; of a k that no oscillator meets. At samples `kappa_k i om_k/delta_k`.
    fn answer(&self, k: usize, period: f64) -> [f64; 2] {
        let omega = TAU / period;
        if let Some(samples) = self.samples {
            return self.held_answer(k, [omega, period], f64::from(samples));
        }
        let at = |l: f64| (l - k as f64).recip();
        let both = |l: u32| if l == 0 { at(0.0) } else { (at(f64::from(l)) + at(-f64::from(l))) / 2.0 };
        let poles: f64 = self.oscillators.all().zip(&self.weights).map(|(l, weight)| weight * both(l)).sum();
        let y = self.mu / omega * poles;
        [self.sigma - y * omega * k as f64, y * self.sigma]
    }

    fn held_answer(&self, k: usize, [omega, period]: [f64; 2], samples: f64) -> [f64; 2] {
        let product = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a * c - b * d, a * d + b * c];
        let step = period / samples;
        let angle = |l: f64| PI * (k as f64 - l) / samples;
        let cotangent = |l: f64| libm::tan(angle(l)).recip();
        let both = |l: u32| {
            let l = f64::from(l);
            if l == 0.0 { cotangent(0.0) } else { (cotangent(l) + cotangent(-l)) / 2.0 }
        };
        let all = || self.oscillators.all().zip(&self.weights);
        // g_k, and delta_k = 2 i sin(om_k h/2) e^{i om_k h/2}/h.
        let poles = [
            -0.5 * all().map(|(_, weight)| weight).sum::<f64>(),
            -0.5 * all().map(|(l, weight)| weight * both(l)).sum::<f64>(),
        ];
        let (sin, cos) = libm::sincos(angle(0.0));
        let delta = [-2.0 * sin * sin / step, 2.0 * sin * cos / step];
        let of_mean = product(poles, [delta[0] + self.sigma, delta[1]]).map(|part| part * self.mu * step);
        // i om_k/delta_k.
        let size = delta[0] * delta[0] + delta[1] * delta[1];
        let held = [delta[1], delta[0]].map(|part| part * omega * k as f64 / size);
        product([self.sigma + of_mean[0], of_mean[1]], held)
    }

    /// `i om_k + b (sigma + i y_k (i om_k + sigma))`, by which e_k is multiplied where q is answered; of such a k.
    fn inverse_answer(&self, k: usize, period: f64) -> [f64; 2] {
        let [re, im] = self.answer(k, period);
        [self.gain * re, TAU / period * k as f64 + self.gain * im]
    }

    /// The trial from the orbit of the zero dynamics, with as many harmonics as it needs; `None` where Newton's method does not converge, or they
    /// are too many.
    #[must_use]
    pub fn propose(&self, orbit: &FloatSeries) -> Option<FloatTrial> {
        let mut field = Field::new(self.plant);
        let n = self.plant.states();
        let own = field.own(orbit);
        let mut start: Option<FloatSeries> = None;
        let most = HARMONICS[HARMONICS.len() - 1];
        // Samples tell so many harmonics apart.
        let (last, accepted) = match self.samples.map(|samples| (samples as usize - 1) / 2) {
            Some(apart) if apart < most => (apart, ACCEPTED_AT_SAMPLES),
            _ => (most, ACCEPTED),
        };
        let fits = |harmonics: usize| (n + 1) * (2 * harmonics + 1) <= MAX_UNKNOWNS;
        let all = || HARMONICS.into_iter().filter(|harmonics| *harmonics < last).chain([last]);
        let is_beyond = |harmonics: usize| harmonics >= self.oscillators.first_missing() as usize;
        // Where none of these harmonics is beyond the oscillators e vanishes.
        let vanishes = self.or_more || !all().any(|harmonics| is_beyond(harmonics) && fits(harmonics));
        for harmonics in all().filter(|harmonics| vanishes || is_beyond(*harmonics)) {
            let points = 2 * harmonics + 1;
            if !fits(harmonics) {
                return None;
            }
            let samples = match &start {
                Some(series) => series.samples(points),
                None => own.samples(points).into_iter().map(|x| x.into_iter().chain([0.0]).collect()).collect(),
            };
            let found = self.collocate(&mut field, samples.into_iter().flatten().collect(), harmonics)?;
            let rows: Vec<Vec<f64>> = found.as_slice().chunks(n + 1).map(<[f64]>::to_vec).collect();
            let series = FloatSeries::from_samples(&rows, harmonics);
            let size = self.size(&mut field, &series);
            let share = if harmonics == last { accepted } else { self.resolved };
            if is_resolved(&series, share * size) {
                return Some(self.with_control(&mut field, &series, size));
            }
            start = Some(series);
        }
        None
    }

    /// The size of a solution: of the states, and of the error that q would make without oscillators.
    fn size(&self, field: &mut Field, series: &FloatSeries) -> f64 {
        let n = field.states();
        let points = 2 * series.harmonics.len() + 1;
        let at = |(j, at): (usize, Vec<f64>)| {
            field.set(j as f64 / points as f64, &at[..n], at[n]);
            at.iter().fold((field.q() / self.sigma).abs(), |largest, value| largest.max(value.abs()))
        };
        series.samples(points).into_iter().enumerate().map(at).fold(0.0, f64::max)
    }

    /// The values of (x, e) at the points at which the equations hold.
    fn collocate(&self, field: &mut Field, start: Vec<f64>, harmonics: usize) -> Option<DVector<f64>> {
        let n = field.states();
        let (points, size) = (2 * harmonics + 1, n + 1);
        let period = field.period;
        // d/dt, and how the regulator answers q with e, between points that are so many apart.
        let differences: Vec<f64> = (0..points)
            .map(|d| {
                if d == 0 {
                    return 0.0;
                }
                let sign = if d % 2 == 0 { 1.0 } else { -1.0 };
                sign * PI / libm::sin(PI * d as f64 / points as f64) / period
            })
            .collect();
        let slope = |j: usize, l: usize| if j >= l { differences[j - l] } else { -differences[l - j] };
        let answers: Vec<f64> = (0..points)
            .map(|d| {
                let of = |k: usize| {
                    let [re, im] = self.inverse_answer(k, period);
                    let (sin, cos) = libm::sincos(TAU * (k * d % points) as f64 / points as f64);
                    // 2 Re(e^{i a}/(re + i im)).
                    2.0 * (cos * re + sin * im) / (re * re + im * im)
                };
                (1..=harmonics).filter(|k| !self.meets(*k)).map(of).sum::<f64>() / points as f64
            })
            .collect();
        let answer = |j: usize, l: usize| answers[(j + points - l) % points];
        let evaluate = |field: &mut Field, v: &DVector<f64>| {
            let mut forcing = vec![0.0; points];
            let mut residual = DVector::zeros(size * points);
            for j in 0..points {
                let at = &v.as_slice()[size * j..size * (j + 1)];
                field.set(j as f64 / points as f64, &at[..n], at[n]);
                forcing[j] = field.q();
                let f = field.f();
                for i in 0..n {
                    let own: f64 = (0..points).map(|l| slope(j, l) * v[size * l + i]).sum();
                    residual[size * j + i] = own - f[i];
                }
            }
            for j in 0..points {
                let own: f64 = (0..points).map(|l| answer(j, l) * forcing[l]).sum();
                residual[size * j + n] = v[size * j + n] - own;
            }
            residual
        };
        let mut v = DVector::from_vec(start);
        let mut residual = evaluate(field, &v);
        for _ in 0..MAX_STEPS {
            let mut matrix: DMatrix<f64> = DMatrix::zeros(size * points, size * points);
            for l in 0..points {
                let at = &v.as_slice()[size * l..size * (l + 1)];
                field.set(l as f64 / points as f64, &at[..n], at[n]);
                let (jacobian, f_e, q_x, q_e) = (field.jacobian(), field.f_e(), field.q_x(), field.q_e());
                for i in 0..n {
                    for k in 0..n {
                        matrix[(size * l + i, size * l + k)] -= jacobian[(i, k)];
                    }
                    matrix[(size * l + i, size * l + n)] -= f_e[i];
                }
                for j in 0..points {
                    for i in 0..n {
                        matrix[(size * j + i, size * l + i)] += slope(j, l);
                        matrix[(size * j + n, size * l + i)] -= answer(j, l) * q_x[i];
                    }
                    matrix[(size * j + n, size * l + n)] -= answer(j, l) * q_e;
                }
                matrix[(size * l + n, size * l + n)] += 1.0;
            }
            if !matrix.iter().all(|entry| entry.is_finite()) {
                return None;
            }
            let step = matrix.lu().solve(&residual)?;
            let mut share = 1.0;
            let mut next = None;
            for _ in 0..=MAX_HALVINGS {
                let tried = &v - &step * share;
                let found = evaluate(field, &tried);
                if found.norm() < residual.norm() {
                    next = Some((tried, found));
                    break;
                }
                share /= 2.0;
            }
            let settled = step.amax() <= SETTLED * v.amax();
            match next {
                Some((better, found)) => (v, residual) = (better, found),
                // Rounding allows nothing better, or Newton's method is stuck.
                None => return (step.amax() <= 1e3 * SETTLED * v.amax()).then_some(v),
            }
            if settled {
                return Some(v);
            }
        }
        None
    }

    /// The trial of a solution in the units of the field.
    fn with_control(&self, field: &mut Field, series: &FloatSeries, size: f64) -> FloatTrial {
        let n = field.states();
        let harmonics = series.harmonics.len().max(if self.or_more { self.oscillators.largest() as usize } else { 0 });
        let points = 4 * harmonics + 1;
        // Where an oscillator meets them the harmonics of u are those of -q/b; the others follow from those of e.
        let sample = |j: usize| {
            let s = j as f64 / points as f64;
            let (mut at, _) = series.at(s);
            field.set(s, &at[..n], at[n]);
            at.iter_mut().zip(field.units()).for_each(|(x, unit)| *x *= unit);
            at.push(-field.q() / self.gain);
            at
        };
        let samples: Vec<Vec<f64>> = (0..points).map(sample).collect();
        let sizes = field.units().iter().map(|unit| unit * size).chain([size, size * self.sigma]).collect();
        FloatTrial { series: FloatSeries::from_samples(&samples, harmonics), sizes }
    }
}

/// Whether the last fourth of the harmonics is not above a size.
fn is_resolved(series: &FloatSeries, size: f64) -> bool {
    let mut last = series.harmonics.iter().skip(series.harmonics.len() * 3 / 4).flatten().flatten();
    last.all(|part| part.abs() <= size)
}
