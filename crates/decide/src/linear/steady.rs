//! The periodic solution of a linear loop for a given number of oscillators (derivation, 14.3), and of the law at samples (14.6).

use super::PRECISION;
use super::jet::Jet;
use super::member::{Answer, Clock, HeldLine, Line, half_turn};
use super::supremum::{Fineness, supremum};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::{InternalModel, Oscillators, SampledGain};
use sigmastar_theory::transfer::Complex;

/// The regulator, whose base frequency is that of the period, and the gain of the actuator over its nominal value.
#[derive(Clone, Debug)]
pub struct Loop {
    /// sigma.
    pub sigma: Enclosure,
    /// mu; at samples K.
    pub mu: Enclosure,
    /// Om = w = 2 pi/T.
    pub fundamental: Enclosure,
    /// n_0, n_1, ..., as far as there are lines and oscillators.
    pub weights: Vec<Enclosure>,
    /// The square of Nbar, the sum of all weights; or of those of given oscillators ([`Loop::with_oscillators`]); at samples Nb2.
    pub n_bar_squared: Enclosure,
    /// The interval `[b_lo, b_hi]`; `[1, 1]` without an input gain.
    pub gain: [Enclosure; 2],
    /// The inverse of the coordinates L: sizes of x are those of `L^-1 x`.
    pub inverse: Vec<Vec<Rational>>,
    /// What belongs to the law at samples; none in continuous time.
    pub held: Option<AtSamples>,
}

/// What belongs to the law at samples.
#[derive(Clone, Debug)]
pub struct AtSamples {
    /// N_s.
    pub samples: u32,
    /// h.
    pub step: Enclosure,
    /// Whether a control takes the sample to be computed (derivation, 13.4).
    pub delayed: bool,
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
            held: None,
        }
    }

    /// The loop of the law at samples with these K and Nb2, of a period with this many of them.
    #[must_use]
    pub fn at_samples(self, law: &SampledGain, samples: u32, delayed: bool) -> Loop {
        let exact = |value: &Rational| Enclosure::from_rational(value, PRECISION);
        let step = Enclosure::pi(PRECISION) * 2 / (&self.fundamental * i64::from(samples));
        let held = Some(AtSamples { samples, step, delayed });
        Loop { mu: exact(&law.gain), n_bar_squared: exact(&law.weight_sum), held, ..self }
    }

    /// When the harmonics are looked at.
    #[must_use]
    pub fn clock(&self) -> Clock {
        Clock { fundamental: self.fundamental.clone(), samples: self.held.as_ref().map(|held| held.samples) }
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
    /// Of |zeta|_N; at samples at their instants.
    pub zeta: T,
    /// Of |y_k|, of the law with a delay; else 0.
    pub mean: T,
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
            mean: of(&self.mean, &other.mean),
        }
    }

    /// In a fixed order.
    pub(super) fn each(&self) -> [&T; 6] {
        [&self.error, &self.mean_square, &self.control, &self.states, &self.zeta, &self.mean]
    }
}

/// What the regulator makes of the harmonics 0, 1, ...: none of those at which it has an oscillator. The same for all members.
pub(super) struct Regulation(Vec<Option<Beyond>>);

/// What the regulator makes of a harmonic at which it has no oscillator: u = -turn e.
pub(crate) struct Beyond {
    /// `sigma + i y_k (i om_k + sigma)`; at samples kappa_k.
    pub(crate) turn: Complex,
    /// |y| over |e|.
    pub(crate) mean: Enclosure,
    /// |zeta|_N over |y|.
    pub(crate) zeta: Enclosure,
}

impl Loop {
    /// `i k Om`; at samples `(e^{i k Om h} - 1)/h`.
    pub(crate) fn delta(&self, k: usize) -> Complex {
        self.clock().delta(k)
    }

    /// The harmonic k >= 1 of a control at its sampling instants that has this one in the mean over each sample that follows; in continuous time the same.
    pub(crate) fn put_out(&self, k: usize, mean: Complex) -> Complex {
        match self.held {
            None => mean,
            // 1/(i om_k) = -i/om_k.
            Some(_) => {
                let share = self.delta(k).scaled(&(&self.fundamental * k as i64).recip());
                mean.mul(&Complex { re: share.im, im: share.re.negate() })
            }
        }
    }

    /// Of the harmonic k, at which none of these oscillators is.
    pub(crate) fn beyond(&self, oscillators: &Oscillators, k: usize) -> Beyond {
        let (frequency, delta) = (&self.fundamental * k as i64, self.delta(k));
        let sigma = || Complex::real(self.sigma.clone());
        let Some(AtSamples { samples, step, delayed }) = &self.held else {
            let y = &self.mu / &self.fundamental * self.poles(oscillators, k, 1);
            let turn = Complex { re: &self.sigma - &y * &frequency, im: &y * &self.sigma };
            let mean = (frequency.sqr() + self.sigma.sqr()).sqrt();
            return Beyond { turn, mean, zeta: self.poles(oscillators, k, 2).sqrt() / &self.fundamental };
        };
        let zero = || Enclosure::zero(PRECISION);
        // The sums of c_l, of c_l cot((k-l) Om h/2) and of c_l/sin^2((k-l) Om h/2) over l and -l, and b_1.
        let (mut total, mut cotangents, mut squares, mut b_1) = (zero(), zero(), zero(), zero());
        for l in oscillators.all().map(i64::from) {
            let weight = &self.weights[l as usize];
            let places: &[i64] = if l == 0 { &[0] } else { &[l, -l] };
            for place in places {
                let [sin, cos] = half_turn(k as i64 - place, *samples);
                let share = weight / places.len() as i64;
                cotangents = cotangents + &share * cos / &sin;
                squares = squares + share / sin.sqr();
            }
            total = total + weight;
            let [_, cos] = half_turn(2 * l, *samples);
            b_1 = b_1 + weight * cos;
        }
        let of_poles = Complex { re: total.negate(), im: cotangents.negate() }.scaled(&(Enclosure::one(PRECISION) / 2));
        let one = Complex::real(Enclosure::one(PRECISION));
        let z = delta.scaled(step).add(&one);
        let product = Complex::real(step * &self.sigma);
        let (mut mean, mut turn, mut sum) = (delta.add(&sigma()), sigma(), of_poles);
        if *delayed {
            let predicted = z.add(&product);
            mean = z.mul(&mean).div(&predicted);
            turn = turn.div(&predicted);
            sum = sum.sub(&Complex::real(b_1).div(&z));
        }
        let turn = turn.add(&sum.mul(&mean).scaled(&(&self.mu * step)));
        Beyond { turn, mean: mean.norm(), zeta: squares.sqrt() * step / 2 }
    }

    /// Of so many harmonics, from 0 on.
    pub(super) fn regulation(&self, oscillators: &Oscillators, lines: usize) -> Regulation {
        Regulation((0..lines).map(|k| (!oscillators.meets(k)).then(|| self.beyond(oscillators, k))).collect())
    }

    /// Bounds of the periodic solution of every member whose answer is this, with a gain of the actuator in `gain`. `None` where the answer
    /// to a line may have no bound. What is below them some instant has, of |e| and |u|, as closely as `fineness` says; at samples |e| has besides what it
    /// moves within one.
    ///
    /// Line k meets an oscillator where k is in H: then `e_k = 0`, `b u_k = -c_k`, and `|zeta_k|_N = sqrt(2/n_k) |u_k|/mu`. Else
    /// `e_k = c_k/D`, `D = i om_k - W_k + b (sigma + i y_k (i om_k + sigma))`, `y_k = nu g_H(k)`, `b u_k = (i om_k - W_k) e_k - c_k`, and
    /// `|zeta_k|_N = sqrt(g_H'(k)) |i om_k + sigma| |e_k|/w`. At samples (derivation, 14.6) likewise: [`Line`], [`Beyond`].
    pub(super) fn sizes(
        &self,
        Answer { lines, held, offsets }: &Answer,
        gain: &[Rational; 2],
        Regulation(regulation): &Regulation,
        fineness: Fineness,
    ) -> Option<Sizes<Enclosure>> {
        let zero = || Enclosure::zero(PRECISION);
        // The gain is one more side.
        let mut offsets = offsets.clone();
        let gain = offsets.with_side(gain);
        let inverse = gain.recip(&offsets);
        let of_mu = &gain.all().re * &self.mu;
        let mut within = zero();
        let mut sizes =
            Sizes { error: zero(), mean_square: zero(), control: zero(), states: zero(), zeta: zero(), mean: zero() };
        let (mut errors, mut controls) = (Vec::new(), Vec::new());
        // Bounds of |q'|: their sum, and that of their squares.
        let (mut rate, mut rate_squares) = (zero(), zero());
        for (k, (line, beyond)) in lines.iter().zip(regulation).enumerate() {
            let Line { frequency, delta, states, transfer, forcing, held: of_line } = line;
            let both = if k == 0 { 1 } else { 2 };
            let over_gain = |control: Jet| match of_line {
                None => control,
                Some(of_line) => control.div(&of_line.gain, &offsets),
            };
            // e, and the control b u.
            let (error, control) = if let Some(Beyond { turn, mean, zeta }) = beyond {
                let own = Jet::constant(delta.clone()).sub(transfer);
                let answer = gain.times(turn);
                let answer = match of_line {
                    None => answer,
                    Some(of_line) => of_line.gain.mul(&answer, &offsets),
                };
                let error = forcing.div(&offsets.narrowed(own.add(&answer)), &offsets);
                let of_mean = mean * error.norm();
                sizes.zeta = sizes.zeta + zeta * &of_mean * 2;
                if self.held.as_ref().is_some_and(|held| held.delayed) {
                    sizes.mean = sizes.mean + of_mean * 2;
                }
                let control = over_gain(offsets.narrowed(own.mul(&error, &offsets).sub(forcing)));
                (error, control)
            } else {
                let control = over_gain(forcing.negate());
                // |zeta_0|^2 = |c_0|^2/((b mu)^2 n_0); both of k and -k: 2 * 2 |c_k|^2/((b mu)^2 n_k).
                within = within + control.all().norm_squared() / of_mu.sqr() / &self.weights[k] * (both * both);
                (Jet::real(zero()), control)
            };
            if !(error.is_bounded() && control.is_bounded()) {
                return None;
            }
            let mut moved: Vec<Jet> = states.iter().map(|part| part.mul(&error, &offsets)).collect();
            if let Some(HeldLine { by_control, by_forcing, .. }) = of_line {
                for (moved, (of_control, of_forcing)) in moved.iter_mut().zip(by_control.iter().zip(by_forcing)) {
                    *moved = offsets.narrowed(moved.add(&of_control.mul(&control, &offsets)).add(of_forcing));
                }
            }
            sizes.states = sizes.states + self.length(&moved) * both;
            if let Some((held, of_line)) = held.as_ref().zip(of_line.as_ref()) {
                moved.push(error.clone());
                let own = held.rate_of_q((frequency, &of_line.driving), (&moved, &control), &offsets);
                rate_squares = rate_squares + own.sqr() * both;
                rate = rate + own * both;
            }
            errors.push(error.all().clone());
            controls.push(control.mul(&inverse, &offsets).all().clone());
        }
        sizes.zeta = sizes.zeta + within.sqrt();
        // Both of k and -k; the mean is 0.
        sizes.mean_square = (errors.iter().fold(zero(), |sum, error| sum + error.norm_squared()) * 2).sqrt();
        let largest = |waves: Vec<Complex>| supremum(&[waves.into_iter().map(|wave| vec![wave]).collect()], fineness);
        sizes.error = largest(errors);
        sizes.control = largest(controls);
        if let Some(AtSamples { step, .. }) = &self.held {
            // How far e is from its linear interpolation, at most; at the instants it may not be at all.
            let bow = step.sqr() / 8;
            sizes.error = &sizes.error + zero().hull(&(&bow * rate));
            sizes.mean_square = &sizes.mean_square + zero().hull(&(bow * rate_squares.sqrt()));
        }
        let bounded = sizes.each().into_iter().all(Enclosure::is_bounded);
        bounded.then_some(sizes)
    }

    /// |L^-1 x|.
    fn length(&self, x: &[Jet]) -> Enclosure {
        let row = |row: &Vec<Rational>| {
            let zero = Complex::real(Enclosure::zero(PRECISION));
            let entries = row.iter().zip(x).filter(|(entry, _)| **entry != 0);
            entries.fold(zero, |sum, (entry, x)| sum.add(&x.all().scaled(&Enclosure::from_rational(entry, PRECISION))))
        };
        let squares = self.inverse.iter().map(|entries| row(entries).norm_squared());
        squares.fold(Enclosure::zero(PRECISION), |sum, square| sum + square).sqrt()
    }
}
