//! The largest rate that the inequality of [`super::inequality`] can prove, in floating point: a scalar condition.
//!
//! For a given rate and given multipliers the matrix falls apart. Its (xi, phi) block asks for
//! `2 w_x (alpha - gam - rate) > l_x k_x^2 + w_x^2 P_up/l_f`, and the rest is the bounded real inequality
//! `Q (A_y + rate I) + (.)' + (l_e k_e^2 + l_f k_f^2) e e' + (1/l_x + 1/l_e) Q B B'Q < 0` with e = (1, 0, ..., 0), which some Q > 0
//! satisfies if and only if A_y + rate I is Hurwitz and
//! `gamma(rate)^2 (l_e k_e^2 + l_f k_f^2)(1/l_x + 1/l_e) < 1`, where gamma(rate) is the largest magnitude on the line
//! Re s = -rate of the transfer function from u to et, `1/((s + sigma)(1 + mu G(s)))`, `G(s) = M'N (s I - Phi)^-1 M`.
//! The best w_x leaves `l_f > kappa^2 l_x`, kappa = k_x sqrt(P_up)/(alpha - gam - rate), and the best l_e/l_x = kappa k_f/k_e, so that
//! there are multipliers if and only if
//!
//!   `gamma(rate) (k_e + kappa k_f) < 1`:  a small-gain condition with exponential weights.
//!
//! At rate 0 gamma is at most 1/sigma (derivation, section 3). Nothing here is a claim: it says where to look for Q.

use super::inequality::ErrorDynamics;
use faer::c64;
use sigmastar_exact::number::Portable;

/// Steps of the bisection in the rate.
const BISECTIONS: u32 = 45;

/// Frequencies about each eigenvalue, in units of its distance from the line.
const OFFSETS: [f64; 15] = [0.0, 0.1, 0.25, 0.5, 0.8, 1.2, 2.0, 4.0, 10.0, -0.1, -0.25, -0.5, -1.0, -2.0, -5.0];

/// The scalar condition of one n_o at one gain.
pub struct SmallGain {
    sigma: f64,
    mu: f64,
    frequency: f64,
    /// n_0, n_1, ..., n_(n_o).
    weights: Vec<f64>,
    /// Those eigenvalues of `Phi - mu b b'` with Im >= 0.
    eigenvalues: Vec<c64>,
    has_x: bool,
    x_decay: f64,
    root_p_up: f64,
    gains: [f64; 3],
}

/// What the condition at one rate leaves to choose from.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// 1/gamma(rate), or infinity.
    pub available: f64,
    /// k_e.
    pub from_e: f64,
    /// kappa k_f.
    pub from_x: f64,
}

impl Budget {
    /// Whether the condition holds.
    #[must_use]
    pub fn suffices(&self) -> bool {
        self.from_e + self.from_x < self.available
    }
}

impl SmallGain {
    /// The condition in doubles.
    #[must_use]
    pub fn new(dynamics: &ErrorDynamics<'_>, eigenvalues: &[c64]) -> SmallGain {
        let oscillators = dynamics.oscillators;
        let states = oscillators.b.iter().enumerate();
        // |b|^2 on the first state of each oscillator; the second has 0.
        let weights =
            states.filter(|(i, _)| *i == 0 || i % 2 == 1).map(|(_, b)| b.midpoint_f64().portable_powi(2)).collect();
        let bounds = dynamics.bounds;
        SmallGain {
            sigma: dynamics.sigma.to_f64(),
            mu: oscillators.mu.midpoint_f64(),
            frequency: oscillators.base_frequency_f64(),
            weights,
            eigenvalues: eigenvalues.iter().copied().filter(|value| value.im >= 0.0).collect(),
            has_x: bounds.has_x,
            x_decay: bounds.x_decay.to_f64(),
            root_p_up: bounds.root_p_up.to_f64(),
            gains: bounds.gains.each_ref().map(rug::Rational::to_f64),
        }
    }

    /// Rates from here on are out of reach: an eigenvalue, -sigma or the zero dynamics itself is slower.
    #[must_use]
    pub fn ceiling(&self) -> f64 {
        let x = if self.has_x { self.x_decay } else { f64::INFINITY };
        self.eigenvalues.iter().map(|value| -value.re).fold(self.sigma.min(x), f64::min)
    }

    /// The magnitude of `(s + sigma)(1 + mu G(s))` at `s = -rate + i omega`.
    fn inverse_magnitude(&self, rate: f64, omega: f64) -> f64 {
        let s = c64::new(-rate, omega);
        let mut sum = c64::new(0.0, 0.0);
        for (l, weight) in self.weights.iter().enumerate() {
            let pole = c64::new(0.0, l as f64 * self.frequency);
            // n_0/s, and for l > 0 the partial fractions of n_l s/(s^2 + l^2 w^2).
            let pair = c64::new(0.5 * weight, 0.0) / (s - pole) + c64::new(0.5 * weight, 0.0) / (s + pole);
            sum += pair;
        }
        let value = (s + c64::new(self.sigma, 0.0)) * (c64::new(1.0, 0.0) + sum * c64::new(self.mu, 0.0));
        value.norm()
    }

    /// 1/gamma(rate), for `0 < rate < ceiling`.
    fn available(&self, rate: f64) -> f64 {
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
        let values: Vec<f64> = omegas.iter().map(|omega| self.inverse_magnitude(rate, *omega)).collect();
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let refined = (0..omegas.len()).filter(|i| {
            let neighbours = [i.saturating_sub(1), (i + 1).min(values.len() - 1)];
            values[*i] <= 1.05 * least && neighbours.iter().all(|j| values[*i] <= values[*j])
        });
        refined
            .map(|i| {
                let (low, up) = (omegas[i.saturating_sub(1)], omegas[(i + 1).min(omegas.len() - 1)]);
                golden(|omega| self.inverse_magnitude(rate, omega), low, up)
            })
            .fold(least, f64::min)
    }

    /// The two sides of the condition at a rate.
    #[must_use]
    pub fn budget(&self, rate: f64) -> Budget {
        let [k_x, k_e, k_f] = self.gains;
        let from_x = if self.has_x { k_x * k_f * self.root_p_up / (self.x_decay - rate) } else { 0.0 };
        Budget { available: self.available(rate), from_e: k_e, from_x }
    }

    /// The largest rate of the condition; `None` where not even a tiny one fulfils it.
    #[must_use]
    pub fn largest_rate(&self) -> Option<f64> {
        let ceiling = self.ceiling();
        let holds = |rate: f64| self.budget(rate).suffices();
        // NaN and negative ceilings end here too.
        if !(ceiling > 0.0 && ceiling.is_finite() && holds(1e-9 * ceiling)) {
            return None;
        }
        let (mut low, mut up) = (1e-9 * ceiling, ceiling);
        for _ in 0..BISECTIONS {
            let middle = f64::midpoint(low, up);
            if holds(middle) { low = middle } else { up = middle }
        }
        Some(low)
    }

    /// w_x and the multipliers (l_x, l_e, l_f) at a rate, with c and beta of `Q A + A'Q + c e e' + beta Q B B'Q = 0`; what the
    /// condition leaves over is shared out, so that every inequality of the module is strict.
    #[must_use]
    pub fn multipliers(&self, rate: f64) -> Option<Multipliers> {
        let budget = self.budget(rate);
        if !budget.suffices() {
            return None;
        }
        let [k_x, k_e, k_f] = self.gains;
        // Without coupling the budget may be as large as it likes.
        let slack = (budget.available - budget.from_e - budget.from_x) / 3.0;
        let (from_e, from_x) = (budget.from_e + slack, budget.from_x + slack);
        let (l_x, l_e) = (1.0, from_x / from_e);
        let l_f = if k_f > 0.0 { (from_x / k_f).portable_powi(2) } else { 0.0 };
        let distance = self.x_decay - rate;
        let w_x = match (self.has_x, k_f > 0.0, k_x > 0.0) {
            (true, true, _) => distance * l_f / self.root_p_up.portable_powi(2),
            (true, false, true) => k_x * k_x / distance,
            // Nothing couples x to the rest.
            (true, false, false) => 1.0,
            (false, ..) => 0.0,
        };
        // 0 for a signal that vanishes; where both do, any positive number serves.
        let inverse = |l: f64, k: f64| if k > 0.0 { 1.0 / l } else { 0.0 };
        Some(Multipliers {
            w_x,
            l: [l_x, l_e, l_f],
            output: from_e * from_e * l_e + from_x * from_x,
            input_gain: (inverse(l_x, k_x) + inverse(l_e, k_e)).max(1e-3),
        })
    }
}

/// What is left to find Q with.
#[derive(Clone, Copy, Debug)]
pub struct Multipliers {
    /// w_x, positive where there may be an x.
    pub w_x: f64,
    /// l_x, l_e, l_f.
    pub l: [f64; 3],
    /// At least `l_e k_e^2 + l_f k_f^2`, positive.
    pub output: f64,
    /// At least the sum of 1/l_x and 1/l_e over the signals that do not vanish, positive.
    pub input_gain: f64,
}

/// The least value that golden-section search meets between two arguments.
fn golden(function: impl Fn(f64) -> f64, mut low: f64, mut up: f64) -> f64 {
    let ratio = (5f64.sqrt() - 1.0) / 2.0;
    let mut inner = [up - ratio * (up - low), low + ratio * (up - low)];
    let mut values = inner.map(&function);
    for _ in 0..40 {
        if values[0] < values[1] {
            up = inner[1];
            inner = [up - ratio * (up - low), inner[0]];
            values = [function(inner[0]), values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + ratio * (up - low)];
            values = [values[1], function(inner[1])];
        }
    }
    values[0].min(values[1])
}
