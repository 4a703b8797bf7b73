//! The regulator at the samples of a computer: the law of section 12 of the derivation.

use super::Regulator;

/// The regulator at samples h apart, the control held between them. With R = e^(Phi h), at each sample
///
/// v = M'N R (z - M e),   u = -sigma e + K v,   z_next = R (z - M e) + (1 - h sigma) M e.
///
/// K = mu/(1 + h mu Nbar^2/2) with the sum Nbar^2 of all weights, so that the energy zeta'N zeta of zeta = z - M e has
/// the balance that it has in continuous time, for every number of oscillators that the samples can tell apart. (e^(Phi h)
/// with the error held and the continuous u is unstable for many oscillators.) The same as a linear system:
/// z_next = Phi z + Gamma e, u = C z + D e with Phi = R, Gamma = (1 - h sigma) M - R M, C = K M'N R,
/// D = -sigma - K M'N R M. For an actuator with a nominal gain u, and with it C and D, are over that gain.
///
/// With a delay (section 13.4) the control that acts in a sample is computed in the one before. At a sample, with s what the control
/// that acts adds to e beside K v, and e1 what e is predicted to be at the next sample,
///
/// e1 = e + s,   z_next = R (z - M e) + M e1,   v = M'N R (z_next - M e1),   u_next = -sigma e1 + K v,   s_next = -h sigma e1,
///
/// where u_next is put out at the next sample; s is a state more. As a linear system, with (z, s) for z and u_next for u,
/// Phi = [[R, M], [0, -h sigma]], Gamma = (M - R M, -h sigma), C = (K M'N R^2, -sigma), D = -sigma - K M'N R^2 M.
///
/// Made by [`Design::discretise`](super::Design::discretise), which says how each number is rounded.
#[derive(Clone, Debug, PartialEq)]
pub struct Discrete {
    /// The sampling time h.
    pub step: f64,
    /// K.
    pub gain: f64,
    /// Nb2, not below the sum of all weights; K h Nb2 < 2 is proved.
    pub weight_sum: f64,
    /// 1 - h sigma.
    pub decay: f64,
    /// h sigma, of the law with a delay; none without.
    pub prediction: Option<f64>,
    /// (cos(l w h), sin(l w h)) for l = 1, ..., n_o.
    pub rotations: Vec<[f64; 2]>,
    /// Gamma, of dimension 2 n_o + 1, with a delay one more.
    pub input: Vec<f64>,
    /// C, of the same dimension.
    pub output: Vec<f64>,
    /// D.
    pub feedthrough: f64,
    /// The largest |u| that is applied; without it u is never clipped.
    pub saturation: Option<f64>,
}

impl Discrete {
    /// This regulator with its control clipped to |u| <= limit; [`Stepper::step`] says what keeps it from winding up.
    #[must_use]
    pub fn saturated(self, limit: Option<f64>) -> Discrete {
        Discrete { saturation: limit, ..self }
    }

    /// Whether the sampling time and the limit of the control are positive doubles and every entry is a finite one.
    #[must_use]
    pub fn is_representable(&self) -> bool {
        let singles = [self.step, self.gain, self.weight_sum, self.decay, self.feedthrough];
        let lists = self.rotations.iter().flatten().chain(&self.input).chain(&self.output).chain(&self.prediction);
        let limit = self.saturation.is_none_or(|limit| limit > 0.0 && limit.is_finite());
        self.step > 0.0 && limit && singles.iter().chain(lists).all(|entry| entry.is_finite())
    }

    /// The dimension of its state: of z, and with a delay one more.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.input.len()
    }

    /// The control that acts at the first instant of the law with a delay, from a state z, where nothing is predicted: K M'N R z, over
    /// the nominal gain, and clipped. An aligned start puts out 0 instead.
    #[must_use]
    pub fn first_control(&self, regulator: &Regulator, z: &[f64]) -> f64 {
        let turns = [[1.0, 0.0]].into_iter().chain(self.rotations.iter().copied());
        let parts =
            z.iter().take(1).map(|z| [*z, 0.0]).chain(z[z.len().min(1)..].chunks_exact(2).map(|z| [z[0], z[1]]));
        let terms = regulator.weights.iter().zip(turns).zip(parts);
        let sum: f64 = terms.map(|((weight, [cosine, sine]), [a, b])| weight * (cosine * a + sine * b)).sum();
        let u = self.gain * sum / regulator.divisor();
        self.saturation.map_or(u, |limit| u.clamp(-limit, limit))
    }

    /// Phi of the linear system: R = e^(Phi h) = blkdiag(1, [[cos a, sin a], [-sin a, cos a]]) with a = l w h; with a delay what is
    /// predicted is a state more.
    #[must_use]
    pub fn transition(&self) -> faer::Mat<f64> {
        let dimension = self.input.len();
        let mut transition = faer::Mat::identity(dimension, dimension);
        if let Some(product) = self.prediction {
            let last = dimension - 1;
            transition[(last, last)] = -product;
            transition[(0, last)] = 1.0;
            (0..self.rotations.len()).for_each(|at| transition[(2 * at + 1, last)] = 1.0);
        }
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
        let z = vec![0.0; discrete.dimension()];
        Stepper { regulator, discrete, z }
    }

    /// A regulator in the state z, with a delay (z, s); `None` where that has not its dimension.
    #[must_use]
    pub fn starting(regulator: Regulator, discrete: Discrete, z: Vec<f64>) -> Option<Stepper> {
        let own = regulator.dimension() + usize::from(discrete.prediction.is_some());
        (z.len() == own && own == discrete.dimension()).then_some(Stepper { regulator, discrete, z })
    }

    /// The state z, with a delay (z, s).
    #[must_use]
    pub fn state(&self) -> &[f64] {
        &self.z
    }

    /// Clips the control to another limit from now on, or no more.
    pub fn clip(&mut self, limit: Option<f64>) {
        self.discrete.saturation = limit;
    }

    /// Takes the measured error e of this sample, returns the control u for it, with a delay the one that is put out at the next
    /// sample, and moves z to the next sample.
    ///
    /// Where u is clipped, z_next has h M (the control applied - the control wanted) added: (1 - h sigma) e is e + h (u - K v),
    /// and it is the u applied that the plant sees. So z moves as an observer of the disturbance that is told the control
    /// applied: zeta = z - M e has the same recursion with and without clipping, and its balance of energy. With a delay s_next has the
    /// h (applied - wanted) of the control that it goes with, to the same end.
    pub fn step(&mut self, e: f64) -> f64 {
        let nominal = self.regulator.divisor();
        let Some((n_0, weights)) = self.regulator.weights.split_first() else {
            return -self.regulator.sigma * e / nominal;
        };
        let predicted = self.discrete.prediction.map(|product| (product, e + self.z[self.z.len() - 1]));
        // z becomes R (z - M e).
        self.z[0] -= e;
        let mut sum = n_0 * self.z[0];
        for (at, ([cosine, sine], n_l)) in self.discrete.rotations.iter().zip(weights).enumerate() {
            let first = 2 * at + 1;
            let (a, b) = (self.z[first] - e, self.z[first + 1]);
            self.z[first] = cosine * a + sine * b;
            self.z[first + 1] = cosine * b - sine * a;
            sum += match predicted {
                None => n_l * self.z[first],
                Some(_) => n_l * (cosine * self.z[first] + sine * self.z[first + 1]),
            };
        }
        let wanted = self.discrete.gain * sum - self.regulator.sigma * predicted.map_or(e, |(_, next)| next);
        // What e keeps without input: at once, or what is predicted and then what that keeps.
        let mut carry = match predicted {
            None => self.discrete.decay * e,
            Some((product, next)) => -(product * next),
        };
        let mut u = wanted / nominal;
        if let Some(limit) = self.discrete.saturation {
            let mut applied = wanted;
            if u > limit {
                u = limit;
                applied = nominal * limit;
            }
            if u < -limit {
                u = -limit;
                applied = -(nominal * limit);
            }
            carry += self.discrete.step * (applied - wanted);
        }
        let added = predicted.map_or(carry, |(_, next)| next);
        self.z[0] += added;
        for at in 0..self.discrete.rotations.len() {
            self.z[2 * at + 1] += added;
        }
        if predicted.is_some() {
            let last = self.z.len() - 1;
            self.z[last] = carry;
        }
        u
    }
}
