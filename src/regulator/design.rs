//! From exact numbers to doubles, each rounded once.

use super::{Discrete, Regulator};
use crate::enclosure::Enclosure;
use crate::spec::{Constant, InternalModel};

/// The most oscillators that are exported: the matrices are written out in full.
pub const MAX_EXPORTED_OSCILLATORS: u32 = 1000;

/// Bits at which the entries are enclosed before they are rounded. An entry such as 1 - cos(l w dt) loses twice as
/// many bits as l w dt has leading zeros, and none of that may show in 53.
const PRECISION: u32 = 512;

/// A regulator with its numbers exact: an internal model, a gain, a number of oscillators.
#[derive(Clone, Debug)]
pub struct Design<'m> {
    model: &'m InternalModel,
    sigma: Enclosure,
    n_o: u32,
}

impl<'m> Design<'m> {
    /// The regulator of an internal model with the gain sigma and n_o oscillators.
    #[must_use]
    pub fn new(model: &'m InternalModel, sigma: &Constant, n_o: u32) -> Design<'m> {
        Design { model, sigma: sigma.enclose(PRECISION), n_o }
    }

    /// The regulator in double precision.
    ///
    /// Guarantee: each parameter is the exact one rounded once (up to a double rounding of 2^-450).
    #[must_use]
    pub fn regulator(&self) -> Regulator {
        Regulator {
            sigma: self.sigma.midpoint_f64(),
            mu: self.model.mu.enclose(PRECISION).midpoint_f64(),
            frequencies: self.frequencies().iter().map(Enclosure::midpoint_f64).collect(),
            weights: (0..=u64::from(self.n_o))
                .map(|l| self.model.weights.weight(l, PRECISION).midpoint_f64())
                .collect(),
        }
    }

    /// The exact discretisation for a sampling time dt > 0 with e held constant over each sample:
    /// z(t + dt) = e^(Phi dt) z(t) + int_0^dt e^(Phi s) ds Gamma e(t).
    ///
    /// Each block is a rotation. With a = l w dt: e^(Phi_l dt) = [[cos a, sin a], [-sin a, cos a]], and the input
    /// vector of the block is (1 - cos a - r sin a, sin a + r (1 - cos a)) with r = sigma/(l w); that of the
    /// integrator is -sigma dt. Guarantee: each entry is the exact one rounded once.
    #[must_use]
    pub fn discretise(&self, step: &Constant) -> Discrete {
        let step = step.enclose(PRECISION);
        let mut rotations = Vec::new();
        let mut input = vec![(-(&self.sigma * &step)).midpoint_f64()];
        for frequency in self.frequencies() {
            let angle = &frequency * &step;
            let (sine, cosine) = (angle.sin(), angle.cos());
            // 1 - cos a = 2 sin^2(a/2), which cancels nothing.
            let versine = 2 * (angle / 2).sin().sqr();
            let ratio = &self.sigma / frequency;
            input.push((&versine - &ratio * &sine).midpoint_f64());
            input.push((&sine + ratio * versine).midpoint_f64());
            rotations.push([cosine.midpoint_f64(), sine.midpoint_f64()]);
        }
        Discrete { step: step.midpoint_f64(), rotations, input }
    }

    /// sigma, the base frequency and n_o.
    pub(super) fn rates(&self) -> (&Enclosure, Enclosure, u32) {
        (&self.sigma, self.model.base_frequency.enclose(PRECISION), self.n_o)
    }

    fn frequencies(&self) -> Vec<Enclosure> {
        let base = self.model.base_frequency.enclose(PRECISION);
        (1..=i64::from(self.n_o)).map(|l| l * &base).collect()
    }
}
