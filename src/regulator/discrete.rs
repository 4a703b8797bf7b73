//! The regulator at the samples of a computer.

use super::Regulator;

/// The exact discretisation of z' = Phi z + Gamma e for an e that is constant over each sample.
///
/// Made by [`Design::discretise`](super::Design::discretise), which states the formulas.
#[derive(Clone, Debug, PartialEq)]
pub struct Discrete {
    /// The sampling time dt.
    pub step: f64,
    /// (cos(l w dt), sin(l w dt)) for l = 1, ..., n_o.
    pub rotations: Vec<[f64; 2]>,
    /// The input vector, of dimension 2 n_o + 1.
    pub input: Vec<f64>,
}

impl Discrete {
    /// Whether the sampling time is a positive double and every entry a finite one.
    #[must_use]
    pub fn is_representable(&self) -> bool {
        let mut all = [self.step].into_iter().chain(self.rotations.iter().flatten().chain(&self.input).copied());
        self.step > 0.0 && all.all(f64::is_finite)
    }

    /// e^(Phi dt) = blkdiag(1, [[cos a, sin a], [-sin a, cos a]]) with a = l w dt.
    #[must_use]
    pub fn transition(&self) -> ndarray::Array2<f64> {
        let dimension = self.input.len();
        let mut transition = ndarray::Array2::eye(dimension);
        for (at, [cosine, sine]) in self.rotations.iter().enumerate() {
            let first = 2 * at + 1;
            transition[(first, first)] = *cosine;
            transition[(first + 1, first + 1)] = *cosine;
            transition[(first, first + 1)] = *sine;
            transition[(first + 1, first)] = -*sine;
        }
        transition
    }
}

/// The discrete regulator at work: one call per sample.
///
/// The order of the operations is part of the contract: the exported C code performs the same ones, so the two agree
/// bit for bit where the compiler neither contracts nor reorders them.
#[derive(Clone, Debug)]
pub struct Stepper {
    regulator: Regulator,
    discrete: Discrete,
    z: Vec<f64>,
}

impl Stepper {
    /// A regulator at rest (z = 0).
    #[must_use]
    pub fn new(regulator: Regulator, discrete: Discrete) -> Stepper {
        let z = vec![0.0; regulator.dimension()];
        Stepper { regulator, discrete, z }
    }

    /// The state z.
    #[must_use]
    pub fn state(&self) -> &[f64] {
        &self.z
    }

    /// Takes the measured error e of this sample, returns the control u for it, and moves z to the next sample.
    pub fn step(&mut self, e: f64) -> f64 {
        let sum = self.regulator.internal_model_output(&self.z, e);
        let u = self.regulator.mu * sum - self.regulator.sigma * e;
        let input = &self.discrete.input;
        if let Some(integrator) = self.z.first_mut() {
            *integrator += input[0] * e;
        }
        for (at, [cosine, sine]) in self.discrete.rotations.iter().enumerate() {
            let first = 2 * at + 1;
            let (a, b) = (self.z[first], self.z[first + 1]);
            self.z[first] = (cosine * a + sine * b) + input[first] * e;
            self.z[first + 1] = (cosine * b - sine * a) + input[first + 1] * e;
        }
        u
    }
}
