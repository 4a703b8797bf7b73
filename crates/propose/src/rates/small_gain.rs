//! The largest rate that the inequality of [`sigmastar_decide::rates::inequality`] can prove, in floating point: a scalar condition.
//!
//! With the slope of q in the middle of its sector, `delta = delta_c + delta'`, `|delta'| <= k_d = (m + k_l)/2`, and with an input
//! gain in the middle of its interval, `b = b_c + b'`, `|b'| <= b_d`, what is left of them is added at B: `delta' et` and `b' v y` with
//! `v = (-sigma, mu b')`. Both ends of delta are fulfilled by one Pi if and only if this is with a multiplier l_e (with a gain: where
//! it is, with l_e and l_b), and then for given multipliers the matrix falls apart. It asks for
//! `2 w (a_2 - rate) > l k_x^2 + w^2 P_up k_f^2/c_x` and the bounded real inequality
//! `Pi (A_c + rate I) + (.)' + (l_e k_d^2 + c_x) e e' + l_b b_d^2 v v' + (1/l + 1/l_e + 1/l_b) Pi B B'Pi < 0`, which some Pi > 0
//! satisfies if and only if A_c + rate I is Hurwitz and `(l_e k_d^2 + c_x) |H|^2 + l_b b_d^2 |V|^2` times the sum of the 1/l is below 1
//! on the line Re s = -rate, H and V being the transfer functions from u to et and to v y:
//! `1/H = (s + sigma)(1 + b_c mu G(s)) - delta_c - (1 - b_c) sigma`, `G(s) = M'N (s I - Phi)^-1 M`, `V = -(sigma + (s + sigma) mu G) H`.
//! The best w leaves `c_x > kappa^2 k_f^2 l`, kappa = k_x sqrt(P_up)/(a_2 - rate), and the best l_e/l is kappa k_f/k_d, so that without a
//! gain there are multipliers if and only if
//!
//!   `gamma(rate) (k_d + kappa k_f) < 1`:  a small-gain condition with exponential weights, gamma the largest |H|;
//!
//! with one, if and only if `((k_d + kappa k_f)^2 |H|^2 + p b_d^2 |V|^2)(1 + 1/p) < 1` for some p > 0. Nothing here is a claim: it says
//! where to look for Pi.

use super::least::{GOLDEN, OFFSETS, golden};
use super::proposal::{Condition, Numbers, Proposal};
use super::riccati::Equation;
use faer::{Mat, c64};
use rug::Rational;
use sigmastar_decide::rates::OscillatorMatrix;
use sigmastar_decide::rates::inequality::{ErrorDynamics, RateWitness};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, Portable, round_f64};

/// One of so many parts of what the condition leaves over goes to each of its two sides, for a rate.
const PARTS: f64 = 3.0;

/// p of an input gain.
const SHARES: [f64; 11] = [0.01, 0.03, 0.1, 0.2, 0.4, 0.7, 1.0, 2.0, 5.0, 15.0, 50.0];

/// The scalar condition of some oscillators at one gain: the loop in doubles, with dq/de and the input gain in the middle.
pub struct SmallGain {
    /// A_c.
    pub(super) matrix: Mat<f64>,
    /// B.
    pub(super) input: Vec<f64>,
    /// v; empty without an input gain.
    pub(super) moved: Vec<f64>,
    /// k_d.
    half_slope: f64,
    /// b_d, or 0.
    half_gain: f64,
    sigma: f64,
    mu: f64,
    gain: f64,
    /// What comes from e to the input.
    slope: f64,
    /// l w and n_l for each of the harmonics l, 0 the first.
    oscillators: Vec<[f64; 2]>,
    /// Those eigenvalues of A_c with Im >= 0.
    eigenvalues: Vec<c64>,
    has_x: bool,
    x_decay: f64,
    root_p_up: f64,
    k_x: f64,
    k_f: f64,
}

impl SmallGain {
    /// The condition in doubles; `None` where a number is not finite.
    #[must_use]
    pub fn new(dynamics: &ErrorDynamics<'_>) -> Option<SmallGain> {
        let (oscillators, bounds) = (dynamics.oscillators, dynamics.bounds);
        let (mu, sigma) = (oscillators.mu.midpoint_f64(), dynamics.sigma.to_f64());
        let b: Vec<f64> = oscillators.b.iter().map(Enclosure::midpoint_f64).collect();
        let [low, high] =
            dynamics.input_gain.as_ref().map_or([1.0; 2], |ends| ends.each_ref().map(Enclosure::midpoint_f64));
        let (gain, half_gain) = (f64::midpoint(low, high), (high - low) / 2.0);
        let [least, most] = bounds.slopes.each_ref().map(Rational::to_f64);
        let (half_slope, slope) = ((most - least) / 2.0, f64::midpoint(least, most) + (1.0 - gain) * sigma);
        let n = b.len() + 1;
        let input: Vec<f64> = std::iter::once(1.0).chain(b.iter().map(|b| -b)).collect();
        let row: Vec<f64> = std::iter::once(slope).chain(b.iter().map(|b| gain * mu * b)).collect();
        let mut matrix = Mat::from_fn(n, n, |i, j| input[i] * row[j]);
        matrix[(0, 0)] -= sigma;
        for column in 0..n - 1 {
            if let Some((row, entry)) = oscillators.phi(column) {
                matrix[(row + 1, column + 1)] += entry.midpoint_f64();
            }
        }
        // A NaN would not stop an iteration for eigenvalues.
        if !(half_slope.is_finite() && matrix.as_ref().is_all_finite()) {
            return None;
        }
        let values = matrix.eigenvalues().ok()?;
        // |b|^2 on the first state of each oscillator; the second has 0.
        let first = b.iter().enumerate().filter(|(i, _)| *i == 0 || i % 2 == 1);
        let frequency = oscillators.frequency.midpoint_f64();
        let turns = oscillators.harmonics.iter().map(|l| f64::from(*l) * frequency);
        let moved = std::iter::once(-sigma).chain(b.iter().map(|b| mu * b));
        Some(SmallGain {
            moved: if half_gain > 0.0 { moved.collect() } else { Vec::new() },
            matrix,
            input,
            half_slope,
            half_gain,
            sigma,
            mu,
            gain,
            slope,
            oscillators: turns.zip(first).map(|(turn, (_, b))| [turn, b.portable_powi(2)]).collect(),
            eigenvalues: values.into_iter().filter(|value| value.im >= 0.0).collect(),
            has_x: bounds.has_x,
            x_decay: bounds.x_decay.to_f64(),
            root_p_up: bounds.root_p_up.to_f64(),
            k_x: bounds.k_x.to_f64(),
            k_f: bounds.k_f.to_f64(),
        })
    }

    /// B_v of [`sigmastar_decide::rates::inequality`] in the middle, and sigma + mu b'b.
    pub(super) fn noise(&self, oscillators: &OscillatorMatrix) -> (Vec<f64>, f64) {
        // Those of the model are -b.
        let total = self.sigma + self.mu * self.oscillators.iter().map(|[_, weight]| weight).sum::<f64>();
        let mut noise: Vec<f64> = self.input.iter().map(|input| -self.gain * total * input).collect();
        for (column, input) in self.input.iter().skip(1).enumerate() {
            noise[column + 1] += self.sigma * input;
            if let Some((row, entry)) = oscillators.phi(column) {
                noise[row + 1] += entry.midpoint_f64() * input;
            }
        }
        (noise, total)
    }

    /// 1/H and V/H at `s = -rate + i omega`.
    fn responses(&self, rate: f64, omega: f64) -> [c64; 2] {
        let s = c64::new(-rate, omega);
        let mut sum = c64::new(0.0, 0.0);
        for [turn, weight] in &self.oscillators {
            let pole = c64::new(0.0, *turn);
            // n_0/s, and for l > 0 the partial fractions of n_l s/(s^2 + l^2 w^2).
            let pair = c64::new(0.5 * weight, 0.0) / (s - pole) + c64::new(0.5 * weight, 0.0) / (s + pole);
            sum += pair;
        }
        let real = |value: f64| c64::new(value, 0.0);
        let (direct, model) = (s + real(self.sigma), sum * real(self.mu));
        [direct * (real(1.0) + model * real(self.gain)) - real(self.slope), real(self.sigma) + direct * model]
    }

    /// The frequencies at which the line at a rate is looked at, `0 < rate < ceiling`.
    fn frequencies(&self, rate: f64) -> Vec<f64> {
        // G has poles on the imaginary axis only.
        let mut omegas: Vec<f64> = self
            .eigenvalues
            .iter()
            .flat_map(|value| OFFSETS.iter().map(move |offset| value.im + offset * (-value.re - rate)))
            .filter(|omega| *omega >= 0.0)
            .chain((0..60).map(|k| self.sigma * 1e-3 * 1.25f64.portable_powi(k)))
            .chain([0.0])
            .collect();
        omegas.sort_by(f64::total_cmp);
        omegas
    }

    /// The largest k_d + kappa k_f that a rate leaves, with the best p.
    fn available(&self, rate: f64) -> [f64; 2] {
        let omegas = self.frequencies(rate);
        // (1/(1 + 1/p) - p b_d^2 |V|^2)/|H|^2 is the square of what is left at a frequency.
        let left = |share: f64, omega: f64| {
            let [inverse, moved] = self.responses(rate, omega);
            match self.moved.is_empty() {
                true => inverse.norm(),
                false => {
                    let taken = share * (self.half_gain * moved.norm()).portable_powi(2);
                    let square = inverse.norm().portable_powi(2) * share / (1.0 + share) - taken;
                    square.max(0.0).sqrt()
                }
            }
        };
        let of = |share: f64| {
            let values: Vec<f64> = omegas.iter().map(|omega| left(share, *omega)).collect();
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            let refined = (0..omegas.len()).filter(|i| {
                let neighbours = [i.saturating_sub(1), (i + 1).min(values.len() - 1)];
                values[*i] <= 1.05 * least && neighbours.iter().all(|j| values[*i] <= values[*j])
            });
            let around = refined.map(|i| (omegas[i.saturating_sub(1)], omegas[(i + 1).min(omegas.len() - 1)]));
            around.map(|(low, up)| golden(|omega| left(share, omega), [low, up], GOLDEN).1).fold(least, f64::min)
        };
        if self.moved.is_empty() {
            return [of(1.0), 1.0];
        }
        SHARES
            .iter()
            .map(|share| [of(*share), *share])
            .fold([0.0, 1.0], |best, one| if one[0] > best[0] { one } else { best })
    }

    /// The two sides of the condition at a rate.
    fn budget(&self, rate: f64) -> Budget {
        let from_x = if self.has_x { self.k_x * self.k_f * self.root_p_up / (self.x_decay - rate) } else { 0.0 };
        let [available, share] = self.available(rate);
        Budget { available, from_e: self.half_slope, from_x, share }
    }

    /// w and l at a rate, with c, c_v and beta of `Pi A + A'Pi + c e e' + c_v v v' + beta Pi B B'Pi = 0`; one of so many
    /// parts of what the condition leaves over is given to each side, so that every inequality of the module is strict.
    pub(super) fn multipliers(&self, rate: f64, parts: f64) -> Option<Multipliers> {
        let budget = self.budget(rate);
        if !budget.suffices() {
            return None;
        }
        // Without coupling the budget may be as large as it likes.
        let slack = (budget.available - budget.from_e - budget.from_x) / parts;
        let (from_e, from_x) = (budget.from_e + slack, budget.from_x + slack);
        let distance = self.x_decay - rate;
        // c_x over the square of k_f is (kappa')^2 with l = 1.
        let w = match (self.has_x, self.k_f > 0.0, self.k_x > 0.0) {
            (true, true, _) => distance * (from_x / self.k_f / self.root_p_up).portable_powi(2),
            (true, false, true) => self.k_x * self.k_x / distance,
            // Nothing couples x to the rest.
            (true, false, false) => 1.0,
            (false, ..) => 0.0,
        };
        // With l = 1: l_e = from_x/from_e. In units in which (1/l + 1/l_e) is 1 + from_e/from_x.
        let from_inputs = 1.0 + from_e / from_x;
        let output = from_e * from_x + from_x * from_x;
        let moved = budget.share * self.half_gain.portable_powi(2) / from_inputs;
        let with_gain = if self.moved.is_empty() { 0.0 } else { from_inputs / budget.share };
        Some(Multipliers { budget, w, output, moved, input: from_inputs + with_gain })
    }
}

/// What the condition at one rate leaves to choose from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Budget {
    /// The largest k_d + kappa k_f that the rest of the loop allows, or infinity.
    pub(super) available: f64,
    /// k_d.
    pub(super) from_e: f64,
    /// kappa k_f.
    pub(super) from_x: f64,
    /// p of an input gain.
    share: f64,
}

impl Budget {
    /// Whether the condition holds.
    fn suffices(&self) -> bool {
        self.from_e + self.from_x < self.available
    }
}

impl Condition for SmallGain {
    type Numbers = RateNumbers;

    const BISECTIONS: u32 = 45;

    fn ceilings(&self) -> [f64; 2] {
        let of_loop = self.eigenvalues.iter().map(|value| -value.re).fold(f64::INFINITY, f64::min);
        [of_loop, if self.has_x { self.x_decay } else { f64::INFINITY }]
    }

    fn holds(&self, rate: f64) -> bool {
        self.budget(rate).suffices()
    }

    /// Pi is from the Riccati equation `Pi (A_c + rate' I) + (.)' + c e e' + c_v v v' + beta Pi B B'Pi = 0` at a rate' halfway between the
    /// claimed and the largest one: the difference leaves the term 2 (rate' - rate) Pi in the matrix, which makes it definite.
    fn propose(&self, largest: f64, share: f64) -> Option<Proposal<RateNumbers>> {
        let shifted = largest * (1.0 + share) / 2.0;
        let multipliers = self.multipliers(shifted, PARTS)?;
        let SmallGain { matrix, input, moved, .. } = self;
        let n = input.len();
        let a = Mat::from_fn(n, n, |i, j| matrix[(i, j)] + if i == j { shifted } else { 0.0 });
        let output = Mat::from_fn(n, n, |i, j| {
            let of_e = if i == 0 && j == 0 { multipliers.output } else { 0.0 };
            of_e + if moved.is_empty() { 0.0 } else { multipliers.moved * moved[i] * moved[j] }
        });
        let inputs = [(multipliers.input, input.clone())];
        let equation = Equation { a: &a, inputs: &inputs, output: &output };
        let pi = equation.solution([multipliers.output, multipliers.input])?;
        let rate = round_f64(largest * share, 6, Direction::Down)?;
        Some(Proposal { pi, numbers: RateNumbers { rate, w: multipliers.w } })
    }
}

/// The rate, and the numbers of a proof in doubles, with l = 1.
#[derive(Clone, Debug)]
pub struct RateNumbers {
    /// The rate, rounded down.
    pub rate: Rational,
    /// w.
    pub w: f64,
}

impl Numbers for RateNumbers {
    type Witness = RateWitness;

    fn witness(&self, pi: Vec<Vec<Rational>>, digits: u32) -> Option<RateWitness> {
        let w = round_f64(self.w, digits, Direction::Nearest)?;
        Some(RateWitness { rate: self.rate.clone(), w, pi, l: Rational::from(1), inputs: [None, None] })
    }
}

/// What is left to find Pi with, for l = 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Multipliers {
    /// What the condition leaves at the rate.
    pub(super) budget: Budget,
    /// w, positive where xi counts.
    pub(super) w: f64,
    /// At least `l_e k_d^2 + c_x`, positive.
    pub(super) output: f64,
    /// `l_b b_d^2`.
    pub(super) moved: f64,
    /// At least the sum of 1/l, 1/l_e and 1/l_b over the signals that do not vanish, positive.
    pub(super) input: f64,
}
