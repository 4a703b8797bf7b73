//! The periodic solution of a linear loop for a given number of oscillators (derivation, 14.3).

use super::PRECISION;
use super::member::Line;
use super::supremum::{Fineness, supremum};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::{InternalModel, Oscillators};
use sigmastar_theory::transfer::Complex;

/// The regulator, whose base frequency is that of the period, and the gain of the actuator over its nominal value.
#[derive(Clone, Debug)]
pub struct Loop {
    /// sigma.
    pub sigma: Enclosure,
    /// mu.
    pub mu: Enclosure,
    /// Om = w = 2 pi/T.
    pub fundamental: Enclosure,
    /// n_0, n_1, ..., as far as there are lines and oscillators.
    pub weights: Vec<Enclosure>,
    /// The square of Nbar, the sum of all weights; or of those of given oscillators ([`Loop::with_oscillators`]).
    pub n_bar_squared: Enclosure,
    /// The interval `[b_lo, b_hi]`; `[1, 1]` without an input gain.
    pub gain: [Enclosure; 2],
    /// The inverse of the coordinates L: sizes of x are those of `L^-1 x`.
    pub inverse: Vec<Vec<Rational>>,
}

impl Loop {
    /// The loop of an internal model with a matched base frequency at a gain, for lines and oscillators up to this harmonic.
    #[must_use]
    pub fn new(
        sigma: &Rational,
        model: &InternalModel,
        last: usize,
        gain: Option<[Enclosure; 2]>,
        inverse: Vec<Vec<Rational>>,
    ) -> Loop {
        let one = Enclosure::one(PRECISION);
        Loop {
            sigma: Enclosure::from_rational(sigma, PRECISION),
            mu: model.mu.enclose(PRECISION),
            fundamental: model.base_frequency.enclose(PRECISION),
            weights: (0..=last as u64).map(|l| model.weights.weight(l, PRECISION)).collect(),
            n_bar_squared: model.weights.total(PRECISION),
            gain: gain.unwrap_or([one.clone(), one]),
            inverse,
        }
    }

    /// The loop of these oscillators alone, of whose weights Nbar is the sum; `None` where it does not have all of them.
    #[must_use]
    pub fn with_oscillators(self, oscillators: &Oscillators) -> Option<Loop> {
        let nothing = Enclosure::zero(PRECISION);
        let n_bar_squared = oscillators.all().try_fold(nothing, |sum, l| Some(sum + self.weights.get(l as usize)?))?;
        Some(Loop { n_bar_squared, ..self })
    }

    /// `sum over l in +-H of c_l/(l - k)^power`, c_0 = n_0 and else n_|l|/2, for k not in H: g_H(k) and its derivative.
    pub(crate) fn poles(&self, oscillators: &Oscillators, k: usize, power: u32) -> Enclosure {
        let term = |l: u32| {
            let at = |l: i64| Enclosure::from_rational(&Rational::from((1, (l - k as i64).pow(power))), PRECISION);
            let both = if l == 0 { at(0) } else { (at(i64::from(l)) + at(-i64::from(l))) / 2 };
            &self.weights[l as usize] * both
        };
        oscillators.all().fold(Enclosure::zero(PRECISION), |sum, l| sum + term(l))
    }
}

/// Bounds along the periodic solution.
#[derive(Clone, Debug)]
pub struct Sizes<T> {
    /// Of |e|.
    pub error: T,
    /// Of the root mean square of e.
    pub mean_square: T,
    /// Of |u| of the law.
    pub control: T,
    /// Of `|L^-1 (x - x_0)|`.
    pub states: T,
    /// Of |zeta|_N.
    pub zeta: T,
}

impl<T> Sizes<T> {
    /// With a value of each in its place.
    pub(super) fn with(&self, other: &Sizes<T>, of: impl Fn(&T, &T) -> T) -> Sizes<T> {
        Sizes {
            error: of(&self.error, &other.error),
            mean_square: of(&self.mean_square, &other.mean_square),
            control: of(&self.control, &other.control),
            states: of(&self.states, &other.states),
            zeta: of(&self.zeta, &other.zeta),
        }
    }

    /// In a fixed order.
    pub(super) fn each(&self) -> [&T; 5] {
        [&self.error, &self.mean_square, &self.control, &self.states, &self.zeta]
    }
}

impl Loop {
    /// Bounds of the periodic solution of every member whose lines are these, with a gain of the actuator in `gain`. `None` where the answer
    /// to a line may have no bound. What is below them some instant has, of |e| and |u|, as closely as `fineness` says.
    ///
    /// Line k meets an oscillator where k is in H: then `e_k = 0`, `u_k = -c_k/b`, and `|zeta_k|_N = sqrt(2/n_k) |c_k|/(b mu)`. Else
    /// `e_k = c_k/D`, `D = i om_k - W_k + b (sigma + i y_k (i om_k + sigma))`, `y_k = nu g_H(k)`, `u_k = ((i om_k - W_k) e_k - c_k)/b`, and
    /// `|zeta_k|_N = sqrt(g_H'(k)) |i om_k + sigma| |e_k|/w`.
    pub(super) fn sizes(
        &self,
        lines: &[Line],
        gain: &Enclosure,
        oscillators: &Oscillators,
        fineness: Fineness,
    ) -> Option<Sizes<Enclosure>> {
        let zero = || Enclosure::zero(PRECISION);
        let of_mu = gain * &self.mu;
        let mut within = zero();
        let mut sizes = Sizes { error: zero(), mean_square: zero(), control: zero(), states: zero(), zeta: zero() };
        let (mut errors, mut controls) = (Vec::new(), Vec::new());
        for (k, line) in lines.iter().enumerate() {
            let Line { frequency, states, transfer, forcing } = line;
            if oscillators.meets(k) {
                // |zeta_0|^2 = |c_0|^2/((b mu)^2 n_0); both of k and -k: 2 * 2 |c_k|^2/((b mu)^2 n_k).
                let both = if k == 0 { 1 } else { 4 };
                within = within + forcing.norm_squared() / of_mu.sqr() / &self.weights[k] * both;
                errors.push(Complex::real(zero()));
                controls.push(forcing.scaled(&gain.recip().negate()));
                continue;
            }
            let y = &self.mu / &self.fundamental * self.poles(oscillators, k, 1);
            let answer = Complex { re: &self.sigma - &y * frequency, im: &y * &self.sigma }.scaled(gain);
            let own = Complex { re: transfer.re.negate(), im: frequency - &transfer.im };
            let error = forcing.div(&own.add(&answer));
            if !(error.re.is_bounded() && error.im.is_bounded()) {
                return None;
            }
            controls.push(own.mul(&error).sub(forcing).scaled(&gain.recip()));
            let moved: Vec<Complex> = states.iter().map(|part| part.mul(&error)).collect();
            sizes.states = sizes.states + self.length(&moved) * 2;
            let of_y = (frequency.sqr() + self.sigma.sqr()).sqrt() * error.norm();
            sizes.zeta = sizes.zeta + self.poles(oscillators, k, 2).sqrt() * of_y / &self.fundamental * 2;
            errors.push(error);
        }
        sizes.zeta = sizes.zeta + within.sqrt();
        // Both of k and -k; the mean is 0.
        sizes.mean_square = (errors.iter().fold(zero(), |sum, error| sum + error.norm_squared()) * 2).sqrt();
        let largest = |waves: Vec<Complex>| supremum(&[waves.into_iter().map(|wave| vec![wave]).collect()], fineness);
        sizes.error = largest(errors);
        sizes.control = largest(controls);
        let bounded = sizes.each().into_iter().all(Enclosure::is_bounded);
        bounded.then_some(sizes)
    }

    /// |L^-1 x|.
    fn length(&self, x: &[Complex]) -> Enclosure {
        let row = |row: &Vec<Rational>| {
            let zero = Complex::real(Enclosure::zero(PRECISION));
            let entries = row.iter().zip(x).filter(|(entry, _)| **entry != 0);
            entries.fold(zero, |sum, (entry, x)| sum.add(&x.scaled(&Enclosure::from_rational(entry, PRECISION))))
        };
        let squares = self.inverse.iter().map(|entries| row(entries).norm_squared());
        squares.fold(Enclosure::zero(PRECISION), |sum, square| sum + square).sqrt()
    }
}
