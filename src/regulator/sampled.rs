//! What sampling does to the loop: which sampling times are refused, and the spectral radius of the loop that is left.

use super::{Design, Discrete, Regulator};
use crate::enclosure::Enclosure;
use crate::spec::Constant;
use faer::Mat;
use std::fmt;
use thiserror::Error;

/// Why a regulator cannot work at a sampling time.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum SamplingError {
    /// h sigma is not proved to be below 2.
    #[error(
        "h sigma = {product:.6} with the sampling time h: from 2 on a measured error that is held over each sample makes \
         the error grow from sample to sample"
    )]
    TooSlowForSigma {
        /// h sigma.
        product: f64,
        /// 2/sigma, rounded down.
        below: f64,
    },
    /// The fastest oscillator is not proved to turn by less than half a turn in a sample.
    #[error(
        "oscillator {n_o} turns by {turns:.6} of a turn in a sample: from 1/2 on (2 n_o h >= T) the samples cannot tell it \
         from a slower one"
    )]
    Aliasing {
        /// n_o.
        n_o: u32,
        /// n_o w h/(2 pi).
        turns: f64,
        /// pi/(n_o w), rounded down.
        below: f64,
        /// The number of oscillators that this sampling time serves.
        oscillators: u32,
    },
}

impl SamplingError {
    /// What to try.
    #[must_use]
    pub fn way_out(&self) -> String {
        match self {
            SamplingError::TooSlowForSigma { below, .. } => {
                format!("take a sampling time well below 2/sigma = {below:.6e}, or a smaller sigma")
            }
            SamplingError::Aliasing { below, oscillators, .. } => {
                format!("take a sampling time well below {below:.6e}, or at most {oscillators} oscillators")
            }
        }
    }
}

impl Design<'_> {
    /// Whether a sampling time h can work at all: h sigma < 2 and n_o w h < pi, both decided with outward rounding.
    ///
    /// # Errors
    /// [`SamplingError`].
    pub fn check_sampling(&self, step: &Constant) -> Result<(), SamplingError> {
        let (sigma, base, n_o) = self.rates();
        let step = step.enclose(sigma.precision());
        let integer = |value: i64| Enclosure::from_integer(value, sigma.precision());
        let product = sigma * &step;
        if !product.lt(&integer(2)).is_true() {
            let below = (integer(2) / sigma).lower_f64();
            return Err(SamplingError::TooSlowForSigma { product: product.midpoint_f64(), below });
        }
        let pi = Enclosure::pi(sigma.precision());
        let angle = &(i64::from(n_o) * &base) * &step;
        if angle.lt(&pi).is_true() {
            return Ok(());
        }
        // n_o >= 1 here: the angle 0 is below pi.
        let most = (&pi / &(&base * &step)).lower_f64();
        let oscillators = (most.ceil() - 1.0).clamp(0.0, f64::from(n_o - 1)) as u32;
        let turns = (&angle / &(&pi * 2)).midpoint_f64();
        let below = (pi / (i64::from(n_o) * &base)).lower_f64();
        Err(SamplingError::Aliasing { n_o, turns, below, oscillators })
    }
}

/// The loop of the plant e' = u with the sampled regulator: e measured at the samples, u held between them. In floating
/// point, and no claim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledLoop {
    radius: f64,
}

impl SampledLoop {
    /// The loop with the law as it is exported: e(k+1) = e(k) + h u(k), u = -sigma e + mu M'N(z - M e), z(k+1) = Phi_d z(k) +
    /// Gamma_d e(k). `None` where a number is beyond double precision.
    #[must_use]
    pub fn new(regulator: &Regulator, discrete: &Discrete) -> Option<SampledLoop> {
        let n = regulator.dimension();
        let transition = discrete.transition();
        let (m, weights) = (regulator.m(), regulator.n_diagonal());
        let output: Vec<f64> = m.iter().zip(&weights).map(|(m, n)| discrete.step * regulator.mu * m * n).collect();
        let direct = 1.0 - discrete.step * regulator.sigma - output.iter().sum::<f64>();
        let matrix = Mat::from_fn(n + 1, n + 1, |row, column| match (row, column) {
            (0, 0) => direct,
            (0, column) => output[column - 1],
            (row, 0) => discrete.input[row - 1],
            (row, column) => transition[(row - 1, column - 1)],
        });
        spectral_radius(&matrix).map(|radius| SampledLoop { radius })
    }

    /// The spectral radius in ten digits: below 1 the loop converges, by this factor from sample to sample in the end.
    #[must_use]
    pub fn spectral_radius(self) -> f64 {
        // The last digits are those of the machine's eigenvalue routine, and the same file is to have the same bytes.
        format!("{:.9e}", self.radius).parse().unwrap_or(self.radius)
    }

    /// Whether the loop does not converge.
    #[must_use]
    pub fn is_unstable(self) -> bool {
        self.radius >= 1.0
    }

    /// The word for it.
    #[must_use]
    pub fn verdict(self) -> &'static str {
        if self.is_unstable() { "unstable" } else { "stable" }
    }
}

impl fmt::Display for SampledLoop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the sampled loop on the plant e' = u is {}: spectral radius {}",
            self.verdict(),
            self.spectral_radius()
        )
    }
}

/// The largest modulus of the eigenvalues of a square matrix; `None` where an entry is not finite.
#[must_use]
pub fn spectral_radius(matrix: &Mat<f64>) -> Option<f64> {
    // A NaN would not stop the iteration.
    if !matrix.col_iter().all(|column| column.iter().all(|entry| entry.is_finite())) {
        return None;
    }
    let eigenvalues = matrix.eigenvalues().ok()?;
    Some(eigenvalues.iter().fold(0.0, |largest: f64, value| largest.max(value.re.hypot(value.im))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::regulator::Stepper;
    use crate::spec::Specification;
    use rug::Rational;

    fn constant(numerator: i64, denominator: i64) -> Constant {
        Constant::rational(&Rational::from((numerator, denominator)))
    }

    #[test]
    fn the_radius_is_that_of_the_loop_with_the_stepper() {
        let spec = Specification::from_json("example", include_str!("../../specs/paper-example.json")).unwrap();
        for (n_o, samples, unstable) in [(0, 100, false), (1, 100, false), (3, 10, true), (4, 12, true)] {
            let design = Design::new(&spec.internal_model, &constant(2, 1), n_o);
            let (regulator, discrete) = (design.regulator(), design.discretise(&constant(1, samples)));
            let sampled = SampledLoop::new(&regulator, &discrete).unwrap();
            assert_eq!(sampled.is_unstable(), unstable, "{n_o} {samples} {sampled}");
            // The growth of a long run, over as many samples as it takes for the largest mode to stand alone.
            let (mut stepper, mut e) = (Stepper::new(regulator.clone(), discrete.clone()), 1.0);
            let mut size = |steps: usize| {
                for _ in 0..steps {
                    e += discrete.step * stepper.step(e);
                }
                stepper.state().iter().chain([&e]).fold(0.0, |size: f64, value| size.max(value.abs()))
            };
            let (first, second) = (size(2000), size(2000));
            let growth = (second / first).powf(1.0 / 2000.0);
            assert!((growth - sampled.spectral_radius()).abs() < 2e-3, "{n_o} {samples}: {growth} {sampled}");
            assert_eq!(growth >= 1.0, unstable);
        }
    }

    #[test]
    fn sampling_times_that_cannot_work() {
        let spec = Specification::from_json("example", include_str!("../../specs/paper-example.json")).unwrap();
        let check = |sigma: i64, n_o: u32, step: (i64, i64)| {
            Design::new(&spec.internal_model, &constant(sigma, 1), n_o).check_sampling(&constant(step.0, step.1))
        };
        assert_eq!(check(2, 4, (1, 10)), Ok(()));
        assert_eq!(check(19, 4, (1, 10)), Ok(()));
        // Equality is refused in both.
        assert!(matches!(check(20, 4, (1, 10)), Err(SamplingError::TooSlowForSigma { .. })));
        assert!(matches!(check(58, 0, (1, 10)), Err(SamplingError::TooSlowForSigma { .. })));
        assert!(matches!(check(2, 5, (1, 10)), Err(SamplingError::Aliasing { oscillators: 4, .. })));
        assert!(matches!(check(2, 9, (1, 10)), Err(SamplingError::Aliasing { oscillators: 4, .. })));
        assert_eq!(check(2, 5, (99, 1000)), Ok(()));
    }

    #[test]
    fn radii() {
        let matrix = Mat::from_fn(2, 2, |i, j| [[0.0, -2.0], [2.0, 0.0]][i][j]);
        assert!((spectral_radius(&matrix).unwrap() - 2.0).abs() < 1e-14);
        assert_eq!(spectral_radius(&Mat::from_fn(1, 1, |_, _| f64::NAN)), None);
        assert!(SampledLoop { radius: 1.0 }.is_unstable() && !SampledLoop { radius: 1.0 - 1e-15 }.is_unstable());
    }
}
