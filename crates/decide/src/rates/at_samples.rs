//! A decay from sample to sample for given oscillators, from any quadratic function that serves in the error box: (R_h) of derivation,
//! section 13.6.
//!
//! C4 and C5h keep the solution in the error box of the certificate (derivation, 12.3). With the bounds of
//! [`SampleBounds`], `zs = N^(1/2) zeta`, `b = N^(1/2) M`, `R = exp(Phi h)` on zs, `b_1 = b'R b` and the variables
//! (X, e, zs, w1, w2, p, rho_E, rho_Y) the loop is
//!
//!   `y = (1 - b_u) sigma e + b_u K b'R zs + w1 + w2 + p`,  `e+ = (1 - h sigma) e + h y`,  `zs+ = R zs - h b y`,
//!
//! and with `rho = c_X X + rho_E + rho_Y`, kf = sqrt(P_up) k_f the form that [`SampledDynamics::proves`] decides is
//!
//!   `-w [-2 a_2 h X^2 + 2 h kf X rho + c (X + h kf rho)^2] - (1+c) (e+, zs+)'Pi (e+, zs+) + (e, zs)'Pi (e, zs)`
//!   `- l_slope (hi1 e - w1)(w1 - lo1 e) - l_hold (hi2 y - w2)(w2 - lo2 y)`
//!   `- l_x (k_x^2 (1+g)^2 X^2 - p^2) - l_e (c_E^2 e^2 - rho_E^2) - l_y (c_Y^2 y^2 - rho_Y^2)`.
//!
//! If it is positive definite at both ends b_u of the input gain, then `(1+c) W_{k+1} <= W_k` for `W = w xi^2 + (e, zs)'Pi (e, zs)`:
//! `xi_{k+1}^2 - xi_k^2 <= -2 a_2 h X^2 + 2 h kf X rms(e)` and `xi_{k+1} <= X + h kf rms(e)` grow with rms(e), whose bound rho takes its
//! place. What is subtracted is convex in b_u, since y is affine in it, Pi > 0 and lo2 <= 0 <= hi2: so both ends serve.
//!
//! With noise v of the measurement and a disturbance d of q the form has the variables D, v and rho_d besides: y is
//! `D - b_u (sigma + K b_1) v` more, zs+ is `((1 - h sigma) I - R) b v` more, rho is rho_d more, and to the form is added
//! `g_d D^2 + g_v v^2 + g_r rho_d^2`. Then `(1+c) W_{k+1} <= W_k + g_d D^2 + g_v v^2 + g_r rho_d^2`.
//!
//! Bounds of the plant's data enter as rationals in the harder direction, for which the relations stay true, as in
//! [`super::inequality`]; where k_x is 0, X, p, rho_E and rho_Y are left out.

use super::inequality::{LoopBounds, input, is_definite, is_triangle, whole};
use super::oscillators::OscillatorMatrix;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::sampled::{SampleBounds, SampleNumbers, SampledLaw};

/// The error system of some oscillators at samples.
pub struct SampledDynamics<'a> {
    /// The internal model.
    pub oscillators: &'a OscillatorMatrix,
    /// The law.
    pub law: &'a SampledLaw<Enclosure>,
    /// The gain, in 1/time.
    pub sigma: Rational,
    /// The bounds of the plant's data in the error box.
    pub bounds: &'a LoopBounds,
    /// What follows from them for a sample.
    pub sample: SampleBounds<Enclosure>,
    /// Whether there is a disturbance, which moves e within a sample, too: rounding alone does not.
    disturbed: bool,
    /// cos(l w h) and sin(l w h) for each of their harmonics l, 0 the first.
    pub turns: Vec<[Enclosure; 2]>,
}

/// The multipliers that come with x.
#[derive(Clone, Debug)]
pub struct OfX<R> {
    /// w, the weight of xi^2.
    pub w: R,
    /// l_x.
    pub l_x: R,
    /// l_e.
    pub l_e: R,
    /// l_y.
    pub l_y: R,
}

/// The numbers of a proof.
#[derive(Clone, Debug)]
pub struct SampledRateWitness {
    /// The lower triangle of Pi on (e, zs), row by row; of order 2 p + 2, with p oscillators beside the integrator.
    pub pi: Vec<Vec<Rational>>,
    /// c: W is divided by 1 + c in a sample.
    pub c: Rational,
    /// l_slope.
    pub l_slope: Rational,
    /// l_hold.
    pub l_hold: Rational,
    /// Those of x; none where k_x = 0.
    pub of_x: Option<OfX<Rational>>,
    /// Those of the inputs that are there.
    pub inputs: Inputs<Rational>,
}

/// The weights of the inputs; none of those that are not there.
#[derive(Clone, Debug, Default)]
pub struct Inputs<R> {
    /// g_d, of the mean of the disturbance over a sample.
    pub g_d: Option<R>,
    /// g_v, of the noise.
    pub g_v: Option<R>,
    /// g_r, of what the disturbance moves e by within a sample; with x and a disturbance alone.
    pub g_r: Option<R>,
}

impl<'a> SampledDynamics<'a> {
    /// The loop of a claim at samples; `None` where a bound of it is not a finite number, or the data contradict each other.
    #[must_use]
    pub fn new(
        data: &Data<'_>,
        (oscillators, law): (&'a OscillatorMatrix, &'a SampledLaw<Enclosure>),
        sigma: &Rational,
        bounds: &'a LoopBounds,
    ) -> Option<SampledDynamics<'a>> {
        let number = |value: &Rational| Enclosure::from_rational(value, data.precision);
        let sample = SampleBounds::new(&SampleNumbers {
            step: law.step.clone(),
            sigma: number(sigma),
            pi: law.pi.clone(),
            k_x: number(&bounds.k_x),
            slopes: bounds.slopes.each_ref().map(number),
        });
        let unit = &law.pi * 2 / Enclosure::from_integer(i64::from(law.samples), data.precision);
        let turns = oscillators.harmonics.iter().map(|l| (&unit * i64::from(*l)).cos_sin()).collect();
        let ordered = sample.slope[0].le(&sample.slope[1]) == Truth::True;
        (sample.within.is_positive() == Truth::True && ordered).then_some(SampledDynamics {
            oscillators,
            law,
            sigma: sigma.clone(),
            bounds,
            sample,
            disturbed: data.spec.d_bar() > 0,
            turns,
        })
    }

    /// The ends of the input gain; 1 without one.
    pub fn gains(&self) -> Vec<Enclosure> {
        match &self.law.input_gain {
            None => vec![Enclosure::one(self.law.step.precision())],
            Some(gain) => vec![gain.low.clone(), gain.high.clone()],
        }
    }

    /// Whether the numbers prove their decay, as the module says.
    ///
    /// Guarantee: if true, then for every solution that stays in the error box W, to which what the inputs weigh is added, is divided by at
    /// least 1 + c from sample to sample, with W positive definite. If false, nothing is known.
    #[must_use]
    pub fn proves(&self, witness: &SampledRateWitness) -> bool {
        let n = self.oscillators.order() + 1;
        let mut positive = vec![&witness.c, &witness.l_slope, &witness.l_hold];
        positive.extend(witness.of_x.iter().flat_map(|OfX { w, l_x, l_e, l_y }| [w, l_x, l_e, l_y]));
        let Inputs { g_d, g_v, g_r } = &witness.inputs;
        positive.extend([g_d, g_v, g_r].into_iter().flatten());
        let within = self.bounds.has_x && self.disturbed && g_d.is_some();
        let fits = witness.of_x.is_some() == self.bounds.has_x && g_r.is_some() == within;
        if !(is_triangle(&witness.pi, n) && fits) || positive.iter().any(|number| **number <= 0) {
            return false;
        }
        let weighted = Weighted::new(self, &witness.pi);
        is_definite(n, |i, j| weighted.at(i, j).clone())
            && self.gains().iter().all(|gain| {
                let form = weighted.form(witness, gain);
                is_definite(form.order, |i, j| form.at(i, j).clone())
            })
    }
}

/// A linear form: the variables that it has, and their coefficients.
type Linear = Vec<(usize, Enclosure)>;

/// A quadratic form, as the lower triangle of its matrix.
pub struct Quadratic {
    /// The number of variables.
    pub order: usize,
    lower: Vec<Enclosure>,
}

impl Quadratic {
    fn zero(order: usize, precision: u32) -> Quadratic {
        Quadratic { order, lower: vec![Enclosure::zero(precision); order * (order + 1) / 2] }
    }

    /// An entry of the matrix.
    #[must_use]
    pub fn at(&self, i: usize, j: usize) -> &Enclosure {
        let (row, column) = (i.max(j), i.min(j));
        &self.lower[row * (row + 1) / 2 + column]
    }

    /// Adds `coefficient a b`.
    fn add(&mut self, coefficient: &Enclosure, a: &Linear, b: &Linear) {
        let half = coefficient / Enclosure::from_integer(2, coefficient.precision());
        for (i, left) in a {
            let [whole, half] = [coefficient * left, &half * left];
            for (j, right) in b {
                // Of a product of two variables the matrix has one half on each side of its diagonal.
                let term = if i == j { &whole * right } else { &half * right };
                let (row, column) = (*i.max(j), *i.min(j));
                let entry = &mut self.lower[row * (row + 1) / 2 + column];
                *entry = &*entry + term;
            }
        }
    }
}

/// Pi, and what the step of the loop makes of it.
pub struct Weighted<'a> {
    dynamics: &'a SampledDynamics<'a>,
    /// Pi, row by row.
    pi: Vec<Enclosure>,
    /// `T'Pi T`, T = blkdiag(1 - h sigma, R), row by row.
    turned: Vec<Enclosure>,
    /// `T'Pi B`, B = h (1, -b).
    image: Vec<Enclosure>,
    /// `B'Pi B`.
    square: Enclosure,
    /// `T'Pi V`, `B'Pi V` and `V'Pi V`, V what noise moves (e, zs) by but for its part in y.
    noise: (Vec<Enclosure>, [Enclosure; 2]),
}

impl<'a> Weighted<'a> {
    /// Of the rows of the lower triangle of Pi.
    #[must_use]
    pub fn new(dynamics: &'a SampledDynamics<'a>, lower: &[Vec<Rational>]) -> Weighted<'a> {
        let (oscillators, law) = (dynamics.oscillators, dynamics.law);
        let precision = law.step.precision();
        let n = lower.len();
        let pi = whole(lower, precision);
        let inputs: Linear = input(oscillators).into_iter().map(|(j, entry)| (j, &law.step * entry)).collect();
        let dot = |form: &Linear, with: &dyn Fn(usize) -> Enclosure| {
            form.iter().fold(Enclosure::zero(precision), |sum, (j, entry)| sum + entry * with(*j))
        };
        let times =
            |form: &Linear| -> Vec<Enclosure> { (0..n).map(|row| dot(form, &|j| pi[row * n + j].clone())).collect() };
        let columns: Vec<Linear> = (0..n).map(|column| dynamics.column(column)).collect();
        let turn = |vector: &[Enclosure]| -> Vec<Enclosure> {
            columns.iter().map(|column| dot(column, &|row| vector[row].clone())).collect()
        };
        let direct = times(&inputs);
        let square = dot(&inputs, &|j| direct[j].clone());
        let image = turn(&direct);
        let moved = dynamics.moved_by_noise();
        let pushed = times(&moved);
        let noise = (turn(&pushed), [&inputs, &moved].map(|form| dot(form, &|j| pushed[j].clone())));
        let right: Vec<Enclosure> = (0..n * n)
            .map(|at| {
                let (i, j) = (at / n, at % n);
                columns[j].iter().fold(Enclosure::zero(precision), |sum, (row, entry)| sum + &pi[i * n + row] * entry)
            })
            .collect();
        let turned = (0..n * n)
            .map(|at| {
                let (i, j) = (at / n, at % n);
                columns[i]
                    .iter()
                    .fold(Enclosure::zero(precision), |sum, (row, entry)| sum + entry * &right[row * n + j])
            })
            .collect();
        Weighted { dynamics, pi, turned, image, square, noise }
    }

    fn at(&self, i: usize, j: usize) -> &Enclosure {
        &self.pi[i * self.image.len() + j]
    }

    /// The form at one input gain.
    #[must_use]
    pub fn form(&self, witness: &SampledRateWitness, gain: &Enclosure) -> Quadratic {
        let Weighted { dynamics, .. } = self;
        let SampledDynamics { bounds, sample, law, .. } = dynamics;
        let precision = law.step.precision();
        let number = |value: &Rational| Enclosure::from_rational(value, precision);
        let one = Enclosure::one(precision);
        let n = self.image.len();
        // (X, e, zs, w1, w2, p, rho_E, rho_Y), and the inputs.
        let first = usize::from(bounds.has_x);
        let [e, w1, w2, p, rho_e, rho_y] =
            [first, first + n, first + n + 1, first + n + 2, first + n + 3, first + n + 4];
        let mut order = if bounds.has_x { n + 6 } else { n + 2 };
        let mut input = |weight: &Option<Rational>| {
            weight.as_ref().map(|weight| {
                order += 1;
                (order - 1, number(weight))
            })
        };
        let Inputs { g_d, g_v, g_r } = &witness.inputs;
        let [d, v, rho_d] = [g_d, g_v, g_r].map(&mut input);
        let unit = |index: usize| -> Linear { vec![(index, one.clone())] };
        let plus = |mut left: Linear, right: Linear| {
            left.extend(right);
            left
        };
        let times = |factor: &Enclosure, form: &Linear| -> Linear {
            form.iter().map(|(index, value)| (*index, factor * value)).collect()
        };
        let mut y = dynamics.feedback(gain, first);
        y.extend(plus(unit(w1), unit(w2)));
        y.extend(bounds.has_x.then(|| (p, one.clone())));
        y.extend(d.iter().map(|(d, _)| (*d, one.clone())));
        y.extend(v.iter().map(|(v, _)| (*v, (gain * dynamics.noise_gain()).negate())));

        let mut form = Quadratic::zero(order, precision);
        let kept = number(&witness.c) + &one;
        for i in 0..n {
            for j in 0..=i {
                let at = i * n + j;
                let (row, column) = (first + i, first + j);
                form.lower[row * (row + 1) / 2 + column] = &self.pi[at] - &kept * &self.turned[at];
            }
        }
        let image: Linear = self.image.iter().enumerate().map(|(i, value)| (first + i, value.clone())).collect();
        form.add(&(&kept * -2), &image, &y);
        form.add(&(&kept * &self.square).negate(), &y, &y);
        if let Some((v, _)) = &v {
            let (turned, [of_y, square]) = &self.noise;
            let v = unit(*v);
            let turned: Linear = turned.iter().enumerate().map(|(i, value)| (first + i, value.clone())).collect();
            form.add(&(&kept * -2), &plus(turned, times(of_y, &y)), &v);
            form.add(&(&kept * square).negate(), &v, &v);
        }
        for (index, weight) in [&d, &v, &rho_d].into_iter().flatten() {
            form.add(weight, &unit(*index), &unit(*index));
        }

        let sector = |form: &mut Quadratic, l: &Rational, [low, high]: &[Enclosure; 2], of: &Linear, w: usize| {
            let above = plus(times(high, of), vec![(w, one.negate())]);
            let below = plus(unit(w), times(&low.negate(), of));
            form.add(&number(l).negate(), &above, &below);
        };
        sector(&mut form, &witness.l_slope, &sample.slope, &unit(e), w1);
        sector(&mut form, &witness.l_hold, &sample.hold, &y, w2);

        if let Some(OfX { w, l_x, l_e, l_y }) = &witness.of_x {
            let [w, l_x, l_e, l_y] = [w, l_x, l_e, l_y].map(number);
            let kf = &law.step * number(&bounds.root_p_up) * number(&bounds.k_f);
            let x = unit(0);
            let mut rho = plus(plus(times(&sample.held.c_x, &x), unit(rho_e)), unit(rho_y));
            rho.extend(rho_d.iter().map(|(index, _)| (*index, one.clone())));
            let next = plus(x.clone(), times(&kf, &rho));
            form.add(&(&w * number(&bounds.x_decay) * &law.step * 2), &x, &x);
            form.add(&(&w * &kf * -2), &x, &rho);
            form.add(&(&w * number(&witness.c)).negate(), &next, &next);
            let mut within = |l: &Enclosure, bound: &Enclosure, of: &Linear, rest: usize| {
                form.add(&(l * bound.sqr()).negate(), of, of);
                form.add(l, &unit(rest), &unit(rest));
            };
            within(&l_x, &sample.by_x, &x, p);
            within(&l_e, &sample.held.c_e, &unit(e), rho_e);
            within(&l_y, &sample.held.c_y, &y, rho_y);
        }
        form
    }
}

impl SampledDynamics<'_> {
    /// 1 - h sigma.
    fn decay(&self) -> Enclosure {
        let precision = self.law.step.precision();
        Enclosure::one(precision) - &self.law.step * Enclosure::from_rational(&self.sigma, precision)
    }

    /// A column of T = blkdiag(1 - h sigma, R).
    fn column(&self, column: usize) -> Linear {
        match column {
            0 => vec![(0, self.decay())],
            1 => vec![(1, Enclosure::one(self.law.step.precision()))],
            // R = [[cos, sin], [-sin, cos]] on the two states of an oscillator in (e, zs).
            first if first % 2 == 0 => {
                let [cos, sin] = &self.turns[first / 2];
                vec![(first, cos.clone()), (first + 1, sin.negate())]
            }
            second => {
                let [cos, sin] = &self.turns[second / 2];
                vec![(second - 1, sin.clone()), (second, cos.clone())]
            }
        }
    }

    /// `((1 - h sigma) I - R) b` on zs: what noise moves the state of the regulator by, but for its part in y.
    fn moved_by_noise(&self) -> Linear {
        let decay = self.decay();
        let b = &self.oscillators.b;
        let mut form = Vec::new();
        for (state, weight) in b.iter().enumerate().filter(|(state, _)| *state == 0 || state % 2 == 1) {
            form.push((state + 1, &decay * weight));
            form.extend(self.column(state + 1).into_iter().map(|(row, entry)| (row, (entry * weight).negate())));
        }
        form
    }

    /// u as a function of (e, zs) before a step, entry by entry: `-sigma e + K b'R zs`.
    #[must_use]
    pub fn control(&self) -> Vec<Enclosure> {
        let precision = self.law.step.precision();
        let mut all = vec![Enclosure::zero(precision); self.oscillators.order() + 1];
        for (i, entry) in self.feedback(&Enclosure::one(precision), 0) {
            all[i] = entry;
        }
        all[0] = Enclosure::from_rational(&self.sigma, precision).negate();
        all
    }

    /// `sigma + K b'R b`: what noise is in u, over -1, and in y, over -b_u.
    pub fn noise_gain(&self) -> Enclosure {
        let precision = self.law.step.precision();
        let seen = self.oscillators.b.iter().enumerate().filter(|(state, _)| *state == 0 || state % 2 == 1);
        let sum = seen.fold(Enclosure::zero(precision), |sum, (state, weight)| {
            sum + weight.sqr() * &self.turns[state.div_ceil(2)][0]
        });
        &self.law.gain * sum + Enclosure::from_rational(&self.sigma, precision)
    }

    /// `(1 - b_u) sigma e + b_u K b'R zs`, e being the variable `first`.
    fn feedback(&self, gain: &Enclosure, first: usize) -> Linear {
        let law = self.law;
        let precision = law.step.precision();
        let mut form = Vec::new();
        if law.input_gain.is_some() {
            form.push((first, (Enclosure::one(precision) - gain) * Enclosure::from_rational(&self.sigma, precision)));
        }
        let k = gain * &law.gain;
        for column in 1..=self.oscillators.order() {
            // b has the first state of each oscillator alone.
            let seen = self.column(column).into_iter().find(|(row, _)| *row == 1 || row % 2 == 0);
            form.extend(seen.map(|(row, entry)| (first + column, &k * entry * &self.oscillators.b[row - 1])));
        }
        form
    }
}
