//! Band-limited measurement noise, as in the paper's simulations.

use rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

/// White noise of a given power through s^2/(s^2 + 3 s + 2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseSettings {
    /// The height of the power spectral density; a sample has the variance power/step.
    pub power: f64,
    /// The seed of the random numbers.
    pub seed: u64,
}

/// The noise, one value for each step, held over the step.
///
/// White noise w: independent normal samples of variance power/h, held over steps of length h (Simulink's
/// "Band-Limited White Noise"). s^2/(s^2 + 3 s + 2) = 1 + 1/(s + 1) - 4/(s + 2), so v = w + p - 4 r with p' = -p + w,
/// r' = -2 r + w, both solved exactly over a step.
#[derive(Clone, Debug)]
pub struct BandLimitedNoise {
    random: Xoshiro256PlusPlus,
    deviation: f64,
    /// e^(-h) and 1 - e^(-h), e^(-2h) and (1 - e^(-2h))/2.
    slow: [f64; 2],
    fast: [f64; 2],
    p: f64,
    r: f64,
}

impl BandLimitedNoise {
    /// Noise for steps of length `step`.
    #[must_use]
    pub fn new(settings: NoiseSettings, step: f64) -> BandLimitedNoise {
        BandLimitedNoise {
            random: Xoshiro256PlusPlus::seed_from_u64(settings.seed),
            deviation: (settings.power / step).sqrt(),
            slow: [libm::exp(-step), -libm::expm1(-step)],
            fast: [libm::exp(-2.0 * step), -0.5 * libm::expm1(-2.0 * step)],
            p: 0.0,
            r: 0.0,
        }
    }

    /// The value for the next step.
    pub fn sample(&mut self) -> f64 {
        let normal: f64 = StandardNormal.sample(&mut self.random);
        self.respond(self.deviation * normal)
    }

    /// The filter: v for the white noise w of a step, with its states moved to the next.
    fn respond(&mut self, w: f64) -> f64 {
        let v = w + self.p - 4.0 * self.r;
        self.p = self.slow[0] * self.p + self.slow[1] * w;
        self.r = self.fast[0] * self.r + self.fast[1] * w;
        v
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_filter_has_the_transfer_function_of_the_paper() {
        // The gain at omega is measured by feeding a cosine in place of white noise.
        let step = 1e-3_f64;
        for omega in [0.3, 1.0, 2.0, 10.0_f64] {
            let mut noise = BandLimitedNoise::new(NoiseSettings { power: 1.0, seed: 0 }, step);
            let (mut real, mut imaginary, mut count) = (0.0, 0.0, 0.0);
            let periods = (60.0 * omega / std::f64::consts::TAU).ceil().max(20.0);
            let end = (periods * std::f64::consts::TAU / omega / step) as usize;
            for k in 0..2 * end {
                let w = (omega * step * k as f64).cos();
                let v = noise.respond(w);
                if k >= end {
                    real += 2.0 * v * (omega * step * k as f64).cos();
                    imaginary += 2.0 * v * (omega * step * k as f64).sin();
                    count += 1.0;
                }
            }
            let measured = (real * real + imaginary * imaginary).sqrt() / count;
            let exact = omega * omega / ((2.0 - omega * omega).powi(2) + 9.0 * omega * omega).sqrt();
            assert!((measured - exact).abs() < 5e-3, "{omega}: {measured} {exact}");
        }
    }

    #[test]
    fn the_variance_is_power_over_step_and_seeds_differ() {
        let settings = NoiseSettings { power: 1e-3, seed: 7 };
        let mut noise = BandLimitedNoise::new(settings, 1e-5);
        let samples: Vec<f64> = (0..200_000).map(|_| noise.sample()).collect();
        let variance = samples.iter().map(|v| v * v).sum::<f64>() / samples.len() as f64;
        assert!((variance / 100.0 - 1.0).abs() < 0.02, "{variance}");
        let mut again = BandLimitedNoise::new(settings, 1e-5);
        assert!(samples.iter().take(100).all(|v| *v == again.sample()));
        let mut other = BandLimitedNoise::new(NoiseSettings { seed: 8, ..settings }, 1e-5);
        assert_ne!(samples[0], other.sample());
    }
}
