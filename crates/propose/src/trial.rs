//! Trials (derivation, 14.4): the periodic solution of a loop with a given number of oscillators, by Fourier collocation and Newton's method, in
//! doubles and then in short rationals. Nothing is claimed of them.

use crate::orbit::{Field, FloatSeries};
use nalgebra::{DMatrix, DVector};
use rug::{Integer, Rational};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{TrigonometricVector, Wave};
use std::f64::consts::{PI, TAU};

/// The numbers of harmonics, in turn.
const HARMONICS: [usize; 4] = [8, 16, 32, 60];

/// Unknowns of Newton's method; its effort grows with their cube.
const MAX_UNKNOWNS: usize = 500;

/// Newton's steps for one number of harmonics, and halvings of a step that does not help.
const MAX_STEPS: usize = 20;
const MAX_HALVINGS: usize = 8;

/// A step after which nothing gets better, relative to the unknowns.
const SETTLED: f64 = 1e-13;

/// The share of the size of a solution that the last harmonics have at most, where there are enough of them; and with the most.
const RESOLVED: f64 = 1e-15;
const ACCEPTED: f64 = 1e-9;

/// Coefficients that are smaller than this share of the size of a solution are left out, and others rounded to it.
const GRAIN: f64 = 1e-16;

/// What a loop is.
#[derive(Clone, Debug)]
pub struct TrialLoop<'a> {
    /// The plant, of which nothing is an interval.
    pub plant: &'a Plant,
    /// sigma.
    pub sigma: f64,
    /// mu.
    pub mu: f64,
    /// n_0, n_1, ..., n_N: of N oscillators.
    pub weights: Vec<f64>,
    /// Whether the trial is for every larger number, too: without an error, and qhat without harmonics above N.
    pub or_more: bool,
}

/// xhat, ehat and qhat; ehat has neither a mean nor harmonics up to N.
#[derive(Clone, Debug)]
pub struct ProposedTrial {
    /// xhat, in the plant's own coordinates.
    pub states: TrigonometricVector,
    /// ehat.
    pub error: Wave,
    /// qhat.
    pub forcing: Wave,
}

impl TrialLoop<'_> {
    fn oscillators(&self) -> usize {
        self.weights.len() - 1
    }

    /// `(i om_k + sigma)(1 + i y_k)`, by which the regulator multiplies e_k; k > N.
    fn inverse_answer(&self, k: usize, period: f64) -> [f64; 2] {
        let omega = TAU / period;
        let at = |l: f64| (l - k as f64).recip();
        let poles: f64 = self
            .weights
            .iter()
            .enumerate()
            .map(|(l, weight)| weight * if l == 0 { at(0.0) } else { (at(l as f64) + at(-(l as f64))) / 2.0 })
            .sum();
        let y = self.mu / omega * poles;
        let frequency = omega * k as f64;
        [self.sigma - y * frequency, frequency + y * self.sigma]
    }

    /// The trial from the orbit of the zero dynamics, with as many harmonics as it needs; `None` where Newton's method does not converge, or they
    /// are too many.
    #[must_use]
    pub fn propose(&self, orbit: &FloatSeries) -> Option<ProposedTrial> {
        let mut field = Field::new(self.plant);
        let n = self.plant.states();
        let own = field.own(orbit);
        let mut start: Option<FloatSeries> = None;
        let fits = |harmonics: usize| (n + 1) * (2 * harmonics + 1) <= MAX_UNKNOWNS;
        let is_beyond = |harmonics: usize| harmonics > self.oscillators();
        // Where none of these harmonics is beyond the oscillators e vanishes.
        let vanishes = self.or_more || !HARMONICS.into_iter().any(|harmonics| is_beyond(harmonics) && fits(harmonics));
        for harmonics in HARMONICS.into_iter().filter(|harmonics| vanishes || is_beyond(*harmonics)) {
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
            let share = if harmonics == HARMONICS[HARMONICS.len() - 1] { ACCEPTED } else { RESOLVED };
            if is_resolved(&series, share * size) {
                return self.rounded(&mut field, &series, size);
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
                let answered = if self.or_more { harmonics } else { self.oscillators() };
                (answered + 1..=harmonics).map(of).sum::<f64>() / points as f64
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

    /// In short rationals: of a solution in the units of the field.
    fn rounded(&self, field: &mut Field, series: &FloatSeries, size: f64) -> Option<ProposedTrial> {
        let n = field.states();
        let harmonics = series.harmonics.len().max(if self.or_more { self.oscillators() } else { 0 });
        let points = 4 * harmonics + 1;
        let forcing: Vec<Vec<f64>> = (0..points)
            .map(|j| {
                let s = j as f64 / points as f64;
                let (at, _) = series.at(s);
                field.set(s, &at[..n], at[n]);
                vec![field.q()]
            })
            .collect();
        let mut forcing = FloatSeries::from_samples(&forcing, harmonics);
        let units: Vec<f64> = field.units().to_vec();
        let mut error = component(series, n, 1.0, size);
        error.mean = Rational::new();
        for pair in error.harmonics.iter_mut().take(self.oscillators()) {
            *pair = Default::default();
        }
        // Beyond the oscillators qhat is what ehat answers: (re + i im)(a - i b) = (a re + b im) - i (b re - a im).
        let period = field.period;
        for (k, [cos, sin]) in (1..).zip(&error.harmonics).skip(self.oscillators()) {
            let [re, im] = self.inverse_answer(k, period);
            let [a, b] = [cos, sin].map(Rational::to_f64);
            let part = forcing.harmonics.get_mut(k - 1)?;
            (part[0][0], part[1][0]) = (a * re + b * im, b * re - a * im);
        }
        for part in forcing.harmonics.iter_mut().skip(error.harmonics.len().max(self.oscillators())) {
            (part[0][0], part[1][0]) = (0.0, 0.0);
        }
        let waves: Vec<Wave> = (0..n).map(|i| component(series, i, units[i], size)).collect();
        let degree = waves.iter().map(|wave| wave.harmonics.len()).max().unwrap_or(0);
        let part = |k: usize, which: usize| {
            waves
                .iter()
                .map(|wave| wave.harmonics.get(k).map_or_else(Rational::new, |pair| pair[which].clone()))
                .collect()
        };
        let states = TrigonometricVector {
            mean: waves.iter().map(|wave| wave.mean.clone()).collect(),
            harmonics: (0..degree).map(|k| [part(k, 0), part(k, 1)]).collect(),
        };
        Some(ProposedTrial { states, error, forcing: component(&forcing, 0, 1.0, size * self.sigma) })
    }
}

/// Whether the last fourth of the harmonics is not above a size.
fn is_resolved(series: &FloatSeries, size: f64) -> bool {
    let mut last = series.harmonics.iter().skip(series.harmonics.len() * 3 / 4).flatten().flatten();
    last.all(|part| part.abs() <= size)
}

/// A component times a unit, rounded to the largest power of ten that is at most [`GRAIN`] of a size; without the last harmonics that are 0 then.
fn component(series: &FloatSeries, i: usize, unit: f64, size: f64) -> Wave {
    let places = if size > 0.0 { -libm::log10(size * unit * GRAIN).floor() } else { 0.0 };
    let power = Rational::from(Integer::from(Integer::u_pow_u(10, places.abs().min(330.0) as u32)));
    let power = if places >= 0.0 { power } else { power.recip() };
    let short = |value: f64| {
        let exact = Rational::from_f64(value * unit);
        exact.map_or_else(Rational::new, |value| Rational::from(&value * &power).round() / &power)
    };
    let pair = |[a, b]: &[Vec<f64>; 2]| [short(a[i]), short(b[i])];
    let mut harmonics: Vec<[Rational; 2]> = series.harmonics.iter().map(pair).collect();
    while harmonics.last().is_some_and(|[cos, sin]| *cos == 0 && *sin == 0) {
        harmonics.pop();
    }
    Wave { mean: short(series.mean[i]), harmonics }
}
