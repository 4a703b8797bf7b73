//! What sampling does to the loop: the spectral radius on the plant e' = u.

use super::{Design, Discrete, Regulator};
use faer::Mat;
use sigmastar_exact::number::Portable;
use sigmastar_lang::spec::Constant;
use std::fmt;

/// From here on a radius in doubles says nothing: a loop that is not proved to converge counts as unstable.
const NEARLY_ONE: f64 = 1.0 - 1e-9;

/// The loop of the plant e' = u with the sampled regulator: e measured at the samples, u held between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Convergence {
    radius: f64,
    proved: bool,
}

impl Convergence {
    /// The loop with the law as it is exported: e(k+1) = e(k) + h u(k); with a delay with the control that was put out for this sample.
    /// `None` where a number is beyond double precision.
    #[must_use]
    pub fn new(
        design: &Design<'_>,
        step: &Constant,
        regulator: &Regulator,
        discrete: &Discrete,
    ) -> Option<Convergence> {
        let matrix = match discrete.prediction {
            None => energy_matrix(regulator, discrete),
            Some(_) => delayed_matrix(regulator, discrete),
        };
        let radius = spectral_radius(&matrix)?;
        // e takes nothing from zeta but what zeta does by itself: the loop is triangular, with 1 - h sigma for e.
        Some(Convergence { radius: radius.max(discrete.decay.abs()), proved: design.converges(step) })
    }

    /// The loop with the law without a delay where its computation takes the whole sample, e(k+1) = e(k) + h u(k-1); of such a law alone.
    /// `None` of one with a delay, and where a number is beyond double precision.
    #[must_use]
    pub fn late(regulator: &Regulator, discrete: &Discrete) -> Option<Convergence> {
        if discrete.prediction.is_some() {
            return None;
        }
        let radius = spectral_radius(&late_matrix(regulator, discrete))?;
        Some(Convergence { radius, proved: false })
    }

    /// The spectral radius in ten digits, in floating point: by this factor the loop converges from sample to sample in the end.
    #[must_use]
    pub fn spectral_radius(self) -> f64 {
        // The last digits are those of the machine's eigenvalue routine, and the same file is to have the same bytes.
        format!("{:.9e}", self.radius).parse().unwrap_or(self.radius)
    }

    /// Whether the loop does not converge: it is not proved to, and the radius does not say so clearly either. A proof counts
    /// for more than the eigenvalues of a matrix of doubles, which slow oscillators bring within rounding of 1.
    #[must_use]
    pub fn is_unstable(self) -> bool {
        !self.proved && self.radius >= NEARLY_ONE
    }

    /// The word for it.
    #[must_use]
    pub fn verdict(self) -> &'static str {
        if self.is_unstable() { "unstable" } else { "stable" }
    }
}

impl fmt::Display for Convergence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the sampled loop on the plant e' = u is {}: spectral radius {}",
            self.verdict(),
            self.spectral_radius()
        )
    }
}

/// The law in the coordinates in which the energy of zeta is the square of the Euclidean norm.
struct Scaled {
    /// Of zeta.
    n: usize,
    /// R.
    transition: Mat<f64>,
    /// root N M.
    input: Vec<f64>,
    /// (root N M)' R.
    output: Vec<f64>,
}

impl Scaled {
    fn new(regulator: &Regulator, discrete: &Discrete) -> Scaled {
        let n = regulator.dimension();
        let roots: Vec<f64> = regulator.n_diagonal().iter().map(|weight| weight.sqrt()).collect();
        let input: Vec<f64> = regulator.m().iter().zip(&roots).map(|(m, root)| m * root).collect();
        let transition = discrete.transition();
        // R turns pairs of equal weights.
        let row = |column: usize| match column {
            0 => input[0],
            column => {
                let first = (column - 1) / 2 * 2 + 1;
                input[first] * transition[(first, column)]
            }
        };
        let output = (0..n).map(row).collect();
        Scaled { n, transition, input, output }
    }

    /// M'N R M.
    fn through(&self) -> f64 {
        self.input.iter().zip(&self.output).map(|(m, row)| m * row).sum()
    }
}

/// R - h K M M'N R, which moves zeta.
fn energy_matrix(regulator: &Regulator, discrete: &Discrete) -> Mat<f64> {
    let Scaled { n, transition, input, output } = Scaled::new(regulator, discrete);
    let factor = discrete.step * discrete.gain;
    Mat::from_fn(n, n, |i, j| transition[(i, j)] - factor * input[i] * output[j])
}

/// With a delay zeta_next = R zeta - h M y, y = K (M'N R zeta + h M'N R M y_last), in (zeta, y).
fn delayed_matrix(regulator: &Regulator, discrete: &Discrete) -> Mat<f64> {
    let law = Scaled::new(regulator, discrete);
    let (n, through) = (law.n, discrete.step * law.through());
    let y = |j: usize| discrete.gain * if j < n { law.output[j] } else { through };
    let turned = |i: usize, j: usize| if j < n { law.transition[(i, j)] } else { 0.0 };
    Mat::from_fn(n + 1, n + 1, |i, j| match i < n {
        true => turned(i, j) - discrete.step * law.input[i] * y(j),
        false => y(j),
    })
}

/// Of the law without a delay, put out a sample late: e_next = e + h u_last, u = -sigma e + K v, z_next = R (z - M e) + (1 - h sigma) M e, in
/// (z, e, h u).
fn late_matrix(regulator: &Regulator, discrete: &Discrete) -> Mat<f64> {
    let law = Scaled::new(regulator, discrete);
    let (n, product) = (law.n, 1.0 - discrete.decay);
    // R (z - M e) and v, in z and e.
    let moved = |i: usize, j: usize| match j {
        j if j < n => law.transition[(i, j)],
        j if j == n => -(0..n).map(|k| law.transition[(i, k)] * law.input[k]).sum::<f64>(),
        _ => 0.0,
    };
    let v = |j: usize| match j {
        j if j < n => law.output[j],
        j if j == n => -law.through(),
        _ => 0.0,
    };
    let of_e = |j: usize| if j == n { 1.0 } else { 0.0 };
    let through_gain = discrete.step * discrete.gain;
    Mat::from_fn(n + 2, n + 2, |i, j| match i {
        i if i < n => moved(i, j) + discrete.decay * law.input[i] * of_e(j),
        i if i == n => f64::from(u8::from(j >= n)),
        _ => through_gain * v(j) - product * of_e(j),
    })
}

/// The largest modulus of the eigenvalues of a square matrix; `None` where an entry is not finite.
#[must_use]
pub fn spectral_radius(matrix: &Mat<f64>) -> Option<f64> {
    // A NaN would not stop the iteration.
    if !matrix.col_iter().all(|column| column.iter().all(|entry| entry.is_finite())) {
        return None;
    }
    let eigenvalues = matrix.eigenvalues().ok()?;
    Some(eigenvalues.iter().fold(0.0, |largest: f64, value| largest.max(value.re.portable_hypot(value.im))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Stepper;
    use rug::Rational;
    use sigmastar_lang::spec::Specification;

    fn constant(numerator: i64, denominator: i64) -> Constant {
        Constant::rational(&Rational::from((numerator, denominator)))
    }

    #[test]
    fn the_radius_is_that_of_the_loop_with_the_stepper() {
        let spec = Specification::from_json("example", include_str!("../../../specs/paper-example.json")).unwrap();
        for (sigma, n_o, samples, unstable) in
            [(2, 0, 100, false), (2, 1, 100, false), (2, 3, 10, false), (2, 5, 12, false), (21, 1, 10, true)]
        {
            let (sigma, step) = (constant(sigma, 1), constant(1, samples));
            let design = Design::new(&spec.internal_model, &sigma, n_o);
            let (regulator, discrete) = (design.regulator(), design.discretise(&step).unwrap());
            let sampled = Convergence::new(&design, &step, &regulator, &discrete).unwrap();
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
    fn radii() {
        let matrix = Mat::from_fn(2, 2, |i, j| [[0.0, -2.0], [2.0, 0.0]][i][j]);
        assert!((spectral_radius(&matrix).unwrap() - 2.0).abs() < 1e-14);
        assert_eq!(spectral_radius(&Mat::from_fn(1, 1, |_, _| f64::NAN)), None);
        let unstable = |radius: f64, proved: bool| Convergence { radius, proved }.is_unstable();
        assert!(unstable(1.0, false) && unstable(1.0 - 1e-12, false));
        assert!(!unstable(0.99, false) && !unstable(1.0, true));
    }
}
