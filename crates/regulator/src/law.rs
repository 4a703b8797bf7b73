//! The regulator in double precision.

use faer::Mat;
use sigmastar_lang::plant::InitialRegulator;

/// The parameters of the regulator in double precision.
///
/// Invariants: `frequencies` holds l w for each harmonic l of the oscillators, rising, for l = 1, ..., n_o of the first n_o, and `weights` n_0 and
/// their n_l. Gains and
/// frequencies are in 1/time, weights are pure numbers. A regulator that is only simulated may have any positive
/// weights: W1-W3 and the strict decrease are hypotheses of a certificate, not of this type.
#[derive(Clone, Debug, PartialEq)]
pub struct Regulator {
    /// The gain sigma.
    pub sigma: f64,
    /// The gain mu.
    pub mu: f64,
    /// l w for each harmonic l of the oscillators: w, 2 w, ..., n_o w of the first n_o.
    pub frequencies: Vec<f64>,
    /// n_0 and the n_l of these.
    pub weights: Vec<f64>,
    /// The nominal gain of the actuator, by which the control is divided before it is put out; where there is none it is put out as it
    /// is (derivation, 13.1).
    pub nominal: Option<f64>,
}

/// An initial z for another number of oscillators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the initial z of the plant file has {given} components, this regulator has {needed}")]
pub struct WrongDimension {
    /// The components that the file gives.
    pub given: usize,
    /// Those of the regulator.
    pub needed: usize,
}

impl Regulator {
    /// The regulator with the weights given, n_o one less than their number, and base frequency w; an empty list of
    /// weights is the high-gain feedback u = -sigma e.
    #[must_use]
    pub fn new(sigma: f64, mu: f64, base_frequency: f64, weights: Vec<f64>) -> Regulator {
        let frequencies = (1..weights.len()).map(|l| l as f64 * base_frequency).collect();
        Regulator { sigma, mu, frequencies, weights, nominal: None }
    }

    /// The high-gain feedback u = -sigma e, which has no state.
    #[must_use]
    pub fn high_gain(sigma: f64) -> Regulator {
        Regulator { sigma, mu: 0.0, frequencies: Vec::new(), weights: Vec::new(), nominal: None }
    }

    /// This regulator for an actuator of this nominal gain.
    #[must_use]
    pub fn for_actuator(self, nominal: Option<f64>) -> Regulator {
        Regulator { nominal, ..self }
    }

    /// What the control is divided by.
    #[must_use]
    pub fn divisor(&self) -> f64 {
        self.nominal.unwrap_or(1.0)
    }

    /// The number of oscillators beside the integrator; `None` for the high-gain feedback, which has no integrator either.
    #[must_use]
    pub fn oscillators(&self) -> Option<usize> {
        self.weights.len().checked_sub(1)
    }

    /// Whether every parameter is a positive finite double (mu of the high-gain feedback aside, which has none); an exact
    /// number may be too large or too small for one.
    #[must_use]
    pub fn is_representable(&self) -> bool {
        let ordinary = |value: &f64| *value > 0.0 && value.is_finite();
        let mu = self.weights.is_empty() || ordinary(&self.mu);
        let nominal = self.nominal.as_ref().is_none_or(ordinary);
        mu && nominal && ordinary(&self.sigma) && self.frequencies.iter().chain(&self.weights).all(ordinary)
    }

    /// The dimension of z: 2 n_o + 1, or 0 for the high-gain feedback.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.oscillators().map_or(0, |n_o| 2 * n_o + 1)
    }

    /// Phi = blkdiag(0, l w [[0, 1], [-1, 0]]).
    #[must_use]
    pub fn phi(&self) -> Mat<f64> {
        let mut phi = Mat::zeros(self.dimension(), self.dimension());
        for (at, &frequency) in self.frequencies.iter().enumerate() {
            let first = 2 * at + 1;
            phi[(first, first + 1)] = frequency;
            phi[(first + 1, first)] = -frequency;
        }
        phi
    }

    /// Gamma = -(Phi + sigma I) M = (-sigma, -sigma, w, -sigma, 2 w, ...).
    #[must_use]
    pub fn gamma(&self) -> Vec<f64> {
        let mut gamma = vec![-self.sigma; self.dimension()];
        for (at, &frequency) in self.frequencies.iter().enumerate() {
            gamma[2 * at + 2] = frequency;
        }
        gamma
    }

    /// M = (1, 1, 0, 1, 0, ...).
    #[must_use]
    pub fn m(&self) -> Vec<f64> {
        (0..self.dimension()).map(|i| if i == 0 || i % 2 == 1 { 1.0 } else { 0.0 }).collect()
    }

    /// z at the first instant, with e there.
    ///
    /// # Errors
    /// As many components as the regulator does not have.
    pub fn start(&self, start: &InitialRegulator, e: f64) -> Result<Vec<f64>, WrongDimension> {
        match start {
            InitialRegulator::AtRest => Ok(vec![0.0; self.dimension()]),
            InitialRegulator::Aligned => Ok(self.m().iter().map(|m| m * e).collect()),
            InitialRegulator::Given(z) if z.len() == self.dimension() => Ok(z.clone()),
            InitialRegulator::Given(z) => Err(WrongDimension { given: z.len(), needed: self.dimension() }),
        }
    }

    /// The diagonal of N = blkdiag(n_0, n_l I_2).
    #[must_use]
    pub fn n_diagonal(&self) -> Vec<f64> {
        (0..self.dimension()).map(|i| self.weights[i.div_ceil(2)]).collect()
    }

    /// s = M'N(z - M e) = n_0 (z_0 - e) + sum n_l (z_l1 - e), in this order of operations.
    #[must_use]
    pub fn internal_model_output(&self, z: &[f64], e: f64) -> f64 {
        let Some((n_0, rest)) = self.weights.split_first() else { return 0.0 };
        let first = n_0 * (z[0] - e);
        rest.iter().enumerate().fold(first, |sum, (at, n_l)| sum + n_l * (z[2 * at + 1] - e))
    }

    /// |z|_N = sqrt(z'N z).
    #[must_use]
    pub fn weighted_norm(&self, z: &[f64]) -> f64 {
        z.iter().zip(self.n_diagonal()).map(|(z, n)| n * z * z).sum::<f64>().sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn regulator() -> Regulator {
        Regulator::new(3.0, 1.0, 2.0, vec![2.0, 1.0, 0.25])
    }

    #[test]
    fn the_matrices_are_those_of_the_paper() {
        let regulator = regulator();
        let phi = regulator.phi();
        assert_eq!((phi[(1, 2)], phi[(2, 1)], phi[(3, 4)], phi[(4, 3)]), (2.0, -2.0, 4.0, -4.0));
        assert_eq!(phi.col_iter().flat_map(|column| column.iter()).filter(|entry| **entry != 0.0).count(), 4);
        assert_eq!(regulator.m(), [1.0, 1.0, 0.0, 1.0, 0.0]);
        assert_eq!(regulator.n_diagonal(), [2.0, 1.0, 1.0, 0.25, 0.25]);
        // Gamma = -(Phi + sigma I) M, multiplied out.
        let m = faer::Col::from_fn(5, |i| regulator.m()[i]);
        let product = -(&phi * &m + faer::Scale(3.0) * &m);
        assert_eq!(regulator.gamma(), product.iter().copied().collect::<Vec<f64>>());
    }

    #[test]
    fn the_output_is_weighted() {
        let regulator = regulator();
        let z = [1.0, 2.0, 30.0, 4.0, 50.0];
        assert_eq!(regulator.internal_model_output(&z, 0.5), 2.0 * 0.5 + 1.5 + 0.25 * 3.5);
        assert_eq!(regulator.weighted_norm(&[1.0, 2.0, 0.0, 4.0, 2.0]), (2.0 + 4.0 + 4.0 + 1.0_f64).sqrt());
        let high_gain = Regulator::high_gain(3.0);
        assert_eq!((high_gain.oscillators(), high_gain.dimension()), (None, 0));
        assert_eq!(high_gain.internal_model_output(&[], 1.0), 0.0);
        assert!(high_gain.is_representable() && regulator.is_representable());
        for broken in [0.0, f64::INFINITY, f64::NAN] {
            assert!(!Regulator::high_gain(broken).is_representable());
            assert!(!Regulator { mu: broken, ..regulator.clone() }.is_representable());
            assert!(!Regulator { frequencies: vec![2.0, broken], ..regulator.clone() }.is_representable());
        }
    }
}
