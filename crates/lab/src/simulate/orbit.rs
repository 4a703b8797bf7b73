//! A periodic signal from its samples: largest value, root mean square, Fourier coefficients.

use super::adaptive::trajectory;
use super::integration::{IntegrationFailure, Tolerance};
use super::period::Period;
use super::{ClosedLoop, SteadyState};
use num_complex::Complex;
use rustfft::FftPlanner;
use sigmastar_exact::number::Portable;

/// Samples of a period: a power of two, enough for the hundredth harmonic and far beyond.
const SAMPLES: usize = 4096;

/// A T-periodic solution, sampled.
#[derive(Clone, Debug)]
pub struct Orbit {
    /// y at 0, T/N, ..., T - T/N.
    pub samples: Vec<Vec<f64>>,
    /// Where e is in y.
    pub error_index: usize,
}

impl Orbit {
    /// Samples a steady state over a period.
    ///
    /// # Errors
    /// [`IntegrationFailure`].
    pub fn new(closed_loop: &ClosedLoop, steady: &SteadyState) -> Result<Orbit, IntegrationFailure> {
        if let Some(steps) = steady.implicit_steps {
            let samples = Period::new(closed_loop, steps).samples(&steady.start, SAMPLES)?;
            return Ok(Orbit { samples, error_index: closed_loop.states() });
        }
        let tolerance = Tolerance::TIGHT;
        let mut samples = trajectory(closed_loop, 0.0, closed_loop.period, SAMPLES, &steady.start, tolerance)?;
        samples.truncate(SAMPLES);
        Ok(Orbit { samples, error_index: closed_loop.states() })
    }

    /// The samples of e.
    #[must_use]
    pub fn error(&self) -> Vec<f64> {
        self.samples.iter().map(|y| y[self.error_index]).collect()
    }
}

/// The largest |e| over a period: the largest sample, with the parabola through it and its neighbours.
#[must_use]
pub fn sup(samples: &[f64]) -> f64 {
    let n = samples.len();
    let largest = (0..n).max_by(|&a, &b| samples[a].abs().total_cmp(&samples[b].abs()));
    let Some(at) = largest else { return 0.0 };
    let (before, here, after) = (samples[(at + n - 1) % n].abs(), samples[at].abs(), samples[(at + 1) % n].abs());
    let bend = before - 2.0 * here + after;
    if bend >= 0.0 {
        return here;
    }
    here - (after - before).portable_powi(2) / (8.0 * bend)
}

/// The root mean square of equally spaced samples of a period.
#[must_use]
pub fn rms(samples: &[f64]) -> f64 {
    (samples.iter().map(|value| value * value).sum::<f64>() / samples.len().max(1) as f64).sqrt()
}

/// |c_k| for k = 0, ..., `count` - 1, where the signal is the sum of c_k e^(2 pi i k t/T) over all integers k.
#[must_use]
pub fn amplitudes(samples: &[f64], count: usize) -> Vec<f64> {
    let n = samples.len();
    let mut buffer: Vec<Complex<f64>> = samples.iter().map(|&value| Complex::new(value, 0.0)).collect();
    FftPlanner::new().plan_fft_forward(n).process(&mut buffer);
    buffer.iter().take(count.min(n / 2)).map(|value| value.norm() / n as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn signal(t: f64) -> f64 {
        0.25 + (TAU * t + 0.3).cos() - 0.5 * (3.0 * TAU * t).sin()
    }

    #[test]
    fn figures_of_a_known_signal() {
        let samples: Vec<f64> = (0..256).map(|k| signal(f64::from(k) / 256.0)).collect();
        let amplitudes = amplitudes(&samples, 6);
        for (amplitude, expected) in amplitudes.iter().zip([0.25, 0.5, 0.0, 0.25, 0.0, 0.0]) {
            assert!((amplitude - expected).abs() < 1e-13);
        }
        assert!((rms(&samples) - (0.0625 + 0.5 + 0.125_f64).sqrt()).abs() < 1e-14);
        let exact = (0..2_000_000).map(|k| signal(f64::from(k) / 2e6).abs()).fold(0.0, f64::max);
        let sampled = samples.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        // The parabola recovers all but a hundredth of what the largest sample misses.
        let missed = exact - sampled;
        assert!(missed > 1e-4 && (sup(&samples) - exact).abs() < 0.01 * missed, "{exact} {sampled}");
        assert_eq!(sup(&[2.0, 2.0, 2.0]), 2.0);
    }
}
