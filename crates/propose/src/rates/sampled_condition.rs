//! The largest decay from sample to sample that (R_h) can prove, in floating point: a scalar condition, and the multipliers for it.
//!
//! In the form of [`sigmastar_decide::rates::at_samples`] the variables (X, rho_E, rho_Y) and (e, zs, w1, w2, p) do not meet. With `w1 = c_1 e + w1'`,
//! `|w1'| <= d_1 |e|`, `w2 = c_2 y + w2'`, `|w2'| <= d_2 |y|`, the second part is the bounded real inequality of a system whose one input is
//! `u = w1' + w2' + p`, with the weight `1/(1/l_slope + 1/l_hold + 1/l_x)`, and whose outputs are e and y, with the weights
//! `l_slope d_1^2 + l_e c_E^2` and `l_hold d_2^2 + l_y c_Y^2`. The first part is positive definite for some w if and only if
//! `1/(1/l_e + 1/l_y) > l_x k_x^2 (1+g)^2 kappa^2`, `kappa = B/A + sqrt(c (h kf)^2/A + (B/A)^2)`, `A = 2 a_2 h - 2 h kf c_X - c (1 + h kf c_X)^2 > 0`,
//! `B = h kf (1 + c (1 + h kf c_X))` (kf/a_2 where h and c vanish). With `k = k_x (1+g) kappa`, `D_e = d_1 + k c_E`, `D_y = d_2 + k c_Y` the
//! best multipliers (Cauchy and Schwarz) are known but for one number r > 0, and there are some if and only if on `|z| = (1+c)^(-1/2)`
//!
//!   `(D_e + r D_y)(D_e |H_e|^2 + D_y |H_y|^2/r) < 1`  and the loop without u is faster,
//!
//! H_y, H_e the transfer functions from u to y and e: `1/H_y = 1 - c_2 - ((1-b) sigma + c_1) h/(z-a) + b K h G(z)`,
//! `H_e = h H_y/(z-a)`, `G(z) = b'R (z - R)^-1 b`. In r it is convex. An input gain b, `|b - b_c| <= b_d`, is an input more at the same place,
//! of `V = -(sigma h/(z-a) + K h G) H_y`, with one number q more. Nothing here is a claim: it says where to look for Pi.

use super::least::{GOLDEN, OFFSETS, golden};
use super::proposal::{Condition, Numbers, Proposal};
use super::sampled_riccati::System;
use faer::{Mat, c64};
use rug::Rational;
use sigmastar_decide::rates::at_samples::{Inputs, OfX, SampledDynamics, SampledRateWitness};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, Portable, round_f64};

/// Steps of a bisection.
const BISECTIONS: u32 = 40;

/// q of an input gain, over D_e + r D_y.
const SHARES: [f64; 9] = [0.01, 0.03, 0.1, 0.2, 0.4, 0.7, 1.0, 2.0, 5.0];

/// By how many powers of 2 r may differ from where e and y count alike.
const RATIOS: f64 = 24.0;

/// A range of factors, by its middle and half its width.
#[derive(Clone, Copy, Debug)]
struct Range {
    middle: f64,
    half: f64,
}

impl Range {
    fn new([low, high]: [f64; 2]) -> Range {
        Range { middle: f64::midpoint(low, high), half: (high - low) / 2.0 }
    }
}

/// The bounds of x in doubles.
#[derive(Clone, Copy, Debug)]
struct States {
    /// a_2.
    decay: f64,
    /// h kf.
    kf: f64,
    /// k_x (1+g).
    by_x: f64,
    c_x: f64,
    c_e: f64,
    c_y: f64,
}

/// The scalar condition of some oscillators at one gain.
pub struct SampledCondition {
    step: f64,
    sigma: f64,
    /// K, and b_c.
    k: f64,
    gain: f64,
    /// b_d, or 0.
    half_gain: f64,
    slope: Range,
    hold: Range,
    states: Option<States>,
    /// b, and cos(l w h), sin(l w h).
    b: Vec<f64>,
    turns: Vec<[f64; 2]>,
    /// A, B, C, D of the loop from u to y, with the uncertain parts in the middle.
    a: Mat<f64>,
    input: Vec<f64>,
    row: Vec<f64>,
    through: f64,
    /// -sigma e + K b'R zs.
    moved: Vec<f64>,
    /// sigma + K b'R b, and ((1 - h sigma) I - R) b on (e, zs).
    pub(super) noise_gain: f64,
    pushed: Vec<f64>,
    eigenvalues: Vec<c64>,
}

/// What the outputs weigh at one frequency: |H_e|^2, |H_y|^2, |V|^2.
type Sizes = [f64; 3];

/// What is left to choose at a rate.
#[derive(Clone, Copy, Debug)]
struct Choice {
    d_e: f64,
    d_y: f64,
    r: f64,
    q: f64,
}

impl Choice {
    /// `(D_e + r D_y + q)(D_e |H_e|^2 + D_y |H_y|^2/r + b_d^2 |V|^2/q)`, the largest one.
    fn product(&self, half_gain: f64, sizes: &[Sizes]) -> f64 {
        let Choice { d_e, d_y, r, q } = self;
        let of_gain = if half_gain > 0.0 { half_gain * half_gain / q } else { 0.0 };
        let output = |[e, y, v]: &Sizes| d_e * e + d_y * y / r + of_gain * v;
        (d_e + r * d_y + q) * sizes.iter().map(output).fold(0.0, f64::max)
    }
}

/// The multipliers of a proposal in doubles, and the system from which Pi comes.
pub(super) struct Multipliers {
    l_slope: f64,
    l_hold: f64,
    pub(super) of_x: Option<OfX<f64>>,
    /// The least g_r; 0 without x.
    pub(super) g_r: f64,
    /// The sum of 1/l over what is uncertain, and what the condition leaves besides.
    input: f64,
    pub(super) room: f64,
    /// The roots of what e, y and what the input gain moves weigh.
    weights: [f64; 3],
    pub(super) system: System,
}

impl SampledCondition {
    /// The condition in doubles; `None` where a number is not finite.
    #[must_use]
    pub fn new(dynamics: &SampledDynamics<'_>) -> Option<SampledCondition> {
        let of = |value: &Enclosure| value.midpoint_f64();
        let SampledDynamics { law, sample, bounds, .. } = dynamics;
        let (step, sigma, k) = (of(&law.step), dynamics.sigma.to_f64(), of(&law.gain));
        let ends = law.input_gain.as_ref().map_or([1.0, 1.0], |gain| [of(&gain.low), of(&gain.high)]);
        let Range { middle: gain, half: half_gain } = Range::new(ends);
        let [slope, hold] = [&sample.slope, &sample.hold].map(|ends| Range::new(ends.each_ref().map(of)));
        let b: Vec<f64> = dynamics.oscillators.b.iter().map(of).collect();
        let turns: Vec<[f64; 2]> = dynamics.turns.iter().map(|turn| turn.each_ref().map(of)).collect();
        let n = b.len() + 1;
        // T = blkdiag(1 - h sigma, R), and b'R.
        let turned = Mat::from_fn(n, n, |i, j| match (i, j) {
            (0, 0) => 1.0 - step * sigma,
            (1, 1) => 1.0,
            _ if i < 2 || j < 2 || i / 2 != j / 2 => 0.0,
            _ => {
                let [cos, sin] = turns[i / 2];
                if i == j {
                    cos
                } else if i < j {
                    sin
                } else {
                    -sin
                }
            }
        });
        let seen: Vec<f64> = (0..n).map(|j| (1..n).map(|i| b[i - 1] * turned[(i, j)]).sum()).collect();
        let through = 1.0 / (1.0 - hold.middle);
        let at_e = (1.0 - gain) * sigma + slope.middle;
        let row: Vec<f64> = (0..n).map(|j| through * (gain * k * seen[j] + if j == 0 { at_e } else { 0.0 })).collect();
        let moved = (0..n).map(|j| k * seen[j] - if j == 0 { sigma } else { 0.0 }).collect();
        let direct: Vec<f64> = (0..n).map(|i| step * if i == 0 { 1.0 } else { -b[i - 1] }).collect();
        let a = Mat::from_fn(n, n, |i, j| turned[(i, j)] + direct[i] * row[j]);
        if !(through > 0.0 && a.as_ref().is_all_finite()) {
            return None;
        }
        let states = bounds.has_x.then(|| States {
            decay: bounds.x_decay.to_f64(),
            kf: step * bounds.root_p_up.to_f64() * bounds.k_f.to_f64(),
            by_x: of(&sample.by_x),
            c_x: of(&sample.held.c_x),
            c_e: of(&sample.held.c_e),
            c_y: of(&sample.held.c_y),
        });
        let eigenvalues = a.eigenvalues().ok()?.into_iter().filter(|value| value.im >= 0.0).collect();
        let input = direct.iter().map(|entry| entry * through).collect();
        let decay = 1.0 - step * sigma;
        let of_turned = |i: usize| -> f64 { (1..n).map(|j| turned[(i, j)] * b[j - 1]).sum() };
        let pushed = (0..n).map(|i| if i == 0 { 0.0 } else { decay * b[i - 1] - of_turned(i) }).collect();
        Some(SampledCondition {
            step,
            sigma,
            k,
            gain,
            half_gain,
            slope,
            hold,
            states,
            b,
            turns,
            a,
            input,
            row,
            through,
            moved,
            noise_gain: of(&dynamics.noise_gain()),
            pushed,
            eigenvalues,
        })
    }

    /// The order of Pi.
    pub(super) fn order(&self) -> usize {
        self.row.len()
    }

    /// c of a rate.
    pub(super) fn c(&self, rate: f64) -> f64 {
        (2.0 * self.step * rate).portable_exp() - 1.0
    }

    /// A, B and (h kf)^2 c of x at one c.
    fn of_x(&self, c: f64) -> Option<[f64; 3]> {
        let States { decay, kf, c_x, .. } = self.states?;
        let reach = 1.0 + kf * c_x;
        let decay = 2.0 * (decay * self.step - kf * c_x) - c * reach * reach;
        Some([decay, kf * (1.0 + c * reach), c * kf * kf])
    }

    /// k at one c: 0 without x, NaN or infinite where x is slower.
    fn coupling(&self, c: f64) -> f64 {
        match (self.states, self.of_x(c)) {
            (Some(states), Some([decay, cross, square])) if decay > 0.0 => {
                let ratio = cross / decay;
                states.by_x * (ratio + (square / decay + ratio * ratio).sqrt())
            }
            (Some(_), _) => f64::INFINITY,
            _ => 0.0,
        }
    }

    /// D_e and D_y at one c.
    fn sizes(&self, c: f64) -> [f64; 2] {
        let k = self.coupling(c);
        let [c_e, c_y] = self.states.map_or([0.0, 0.0], |states| [states.c_e, states.c_y]);
        let times = |c: f64| if self.states.is_some() { k * c } else { 0.0 };
        [self.slope.half + times(c_e), self.hold.half + times(c_y)]
    }

    /// What the outputs weigh at z.
    fn at(&self, z: c64) -> Sizes {
        let real = |value: f64| c64::new(value, 0.0);
        let integrator = real(self.step) / (z - real(1.0 - self.step * self.sigma));
        let mut sum = real(self.b[0] * self.b[0]) / (z - real(1.0));
        for (l, [cos, sin]) in self.turns.iter().enumerate().skip(1) {
            let weight = self.b[2 * l - 1].portable_powi(2) / 2.0;
            for pole in [c64::new(*cos, *sin), c64::new(*cos, -sin)] {
                sum += real(weight) * pole / (z - pole);
            }
        }
        let model = real(self.k * self.step) * sum;
        let at_e = real((1.0 - self.gain) * self.sigma + self.slope.middle);
        let y = real(1.0) / (real(1.0 - self.hold.middle) - at_e * integrator + real(self.gain) * model);
        let moved = (real(self.sigma) * integrator + model) * y;
        [integrator * y, y, moved].map(|value| value.re * value.re + value.im * value.im)
    }

    /// What the outputs weigh along the circle of a rate, at points where that may be largest. The tangents of the half angles give the
    /// points, so that no function is needed that differs between machines.
    fn along(&self, rate: f64) -> Vec<Sizes> {
        let radius = (-self.step * rate).portable_exp();
        let mut tangents: Vec<f64> = (0..120).map(|k| 1e-4 * 1.15f64.portable_powi(k)).chain([0.0, 1e9]).collect();
        for value in &self.eigenvalues {
            let size = value.re.portable_hypot(value.im);
            let at = value.im / (size + value.re).max(1e-12);
            let distance = (radius / size).portable_ln() / 2.0 * (1.0 + at * at);
            tangents.extend(OFFSETS.iter().map(|offset| at + offset * distance).filter(|t| *t >= 0.0));
        }
        tangents
            .iter()
            .map(|t| {
                let square = t * t;
                let unit = c64::new((1.0 - square) / (1.0 + square), 2.0 * t / (1.0 + square));
                self.at(c64::new(radius, 0.0) * unit)
            })
            .collect()
    }

    /// The best r and q at a rate, with what they leave: below 1 where the condition holds.
    fn best(&self, [d_e, d_y]: [f64; 2], sizes: &[Sizes]) -> (Choice, f64) {
        let largest = |of: usize| sizes.iter().map(|all| all[of]).fold(0.0, f64::max);
        let alike = (largest(1) / largest(0)).sqrt();
        let shares = if self.half_gain > 0.0 { &SHARES[..] } else { &[0.0][..] };
        let of = |share: f64, power: f64| {
            let r = alike * (power * std::f64::consts::LN_2).portable_exp();
            Choice { d_e, d_y, r, q: share * (d_e + r * d_y) }
        };
        let value = |choice: &Choice| choice.product(self.half_gain, sizes);
        let best = |share: f64| {
            let power = golden(|power| value(&of(share, power)), [-RATIOS, RATIOS], GOLDEN);
            of(share, power.0)
        };
        let all = shares.iter().map(|share| best(*share)).map(|choice| (choice, value(&choice)));
        all.min_by(|one, other| one.1.total_cmp(&other.1)).unwrap_or((of(0.0, 0.0), f64::NAN))
    }

    /// Multipliers at a rate, with a share of what the condition leaves over given away, so that every inequality of the module is strict.
    pub(super) fn multipliers(&self, rate: f64, share: f64) -> Option<Multipliers> {
        let c = self.c(rate);
        let along = self.along(rate);
        let sizes = self.sizes(c);
        let (choice, least) = self.best(sizes, &along);
        if least.is_nan() || least >= 1.0 {
            return None;
        }
        let largest = |of: usize| along.iter().map(|all| all[of]).fold(0.0, f64::max).sqrt();
        let units = [1.0 / largest(0), 1.0 / largest(1)];
        let more = |share: f64| Choice { d_e: sizes[0] + share * units[0], d_y: sizes[1] + share * units[1], ..choice };
        let floor = |choice: Choice| Choice {
            q: if self.half_gain > 0.0 { choice.q.max(1e-6 * units[0]) } else { 0.0 },
            ..choice
        };
        let (mut low, mut up) = (0.0, 1.0);
        for _ in 0..BISECTIONS {
            let middle = f64::midpoint(low, up);
            let left = floor(more(middle)).product(self.half_gain, &along);
            if left < least + share * (1.0 - least) { low = middle } else { up = middle }
        }
        let Choice { d_e, d_y, r, q } = floor(more(low));
        // Half of what is left for each of the two ways to an output.
        let extra = [(d_e - sizes[0]) / 2.0, (d_y - sizes[1]) / 2.0];
        let (slope, hold, of_x, g_r) = match (self.states, self.of_x(c)) {
            (Some(States { by_x, c_e, c_y, .. }), Some([decay, cross, square])) => {
                let tight = self.coupling(c);
                let k = tight + (extra[0] / c_e).min(extra[1] / c_y);
                let l_x = 1.0 / (k * (c_e + r * c_y));
                // w A - l_x k_x^2 (1+g)^2, where it is best; for h kf = 0 any does.
                let share = square * decay / (cross * cross).max(f64::MIN_POSITIVE);
                let surplus = by_x * by_x / (1.0 + share).sqrt();
                let w = l_x * (surplus + by_x * by_x) / decay;
                let of_x = OfX { w, l_x, l_e: k / c_e, l_y: k / (r * c_y) };
                // 1/(1/l_e + 1/l_y + 1/g_r) is to exceed l_x tight^2.
                let g_r = (l_x / (1.0 / (tight * tight) - 1.0 / (k * k))).max(1e-6 * l_x * k * k);
                (self.slope.half + extra[0], self.hold.half + extra[1], Some(of_x), g_r)
            }
            _ => (d_e, d_y, None, 0.0),
        };
        let left = Choice { d_e, d_y, r, q }.product(self.half_gain, &along);
        let n = self.row.len();
        let root = (d_e + r * d_y + q).sqrt();
        let rows = if self.half_gain > 0.0 { 3 } else { 2 };
        let weights =
            [d_e.sqrt(), (d_y / r).sqrt(), if self.half_gain > 0.0 { self.half_gain / q.sqrt() } else { 0.0 }];
        // Faster by the rate.
        let faster = (self.step * rate).portable_exp();
        let system = System {
            a: Mat::from_fn(n, n, |i, j| faster * self.a[(i, j)]),
            b: Mat::from_fn(n, 1, |i, _| faster * root * self.input[i]),
            c: Mat::from_fn(rows, n, |i, j| {
                weights[i]
                    * match i {
                        0 => f64::from(u8::from(j == 0)),
                        1 => self.row[j],
                        _ => self.moved[j],
                    }
            }),
            d: Mat::from_fn(rows, 1, |i, _| if i == 1 { weights[1] * root * self.through } else { 0.0 }),
        };
        let input = root * root;
        let room = input * (1.0 / left - 1.0);
        Some(Multipliers { l_slope: 1.0 / slope, l_hold: 1.0 / (r * hold), of_x, g_r, input, room, weights, system })
    }

    /// The system of the multipliers with `gam_d = 1/g_d` more for the disturbance and, where it is not 0, `gam_v = 1/g_v` for the noise.
    pub(super) fn disturbed(&self, rate: f64, multipliers: &Multipliers, [gam_d, gam_v]: [f64; 2]) -> System {
        let System { a, b, c, d } = &multipliers.system;
        let faster = (self.step * rate).portable_exp();
        let more = ((multipliers.input + gam_d) / multipliers.input).sqrt();
        let root = gam_v.sqrt();
        let columns = if gam_v > 0.0 { 2 } else { 1 };
        // Noise is -b_c (sigma + K b_1) times an input at y, -(sigma + K b_1) in what the input gain moves, and what it pushes.
        let at_y = -self.gain * self.noise_gain;
        let direct = [0.0, self.through * at_y, -self.noise_gain];
        System {
            a: a.clone(),
            b: Mat::from_fn(a.nrows(), columns, |i, j| match j {
                0 => more * b[(i, 0)],
                _ => root * faster * (at_y * self.input[i] + self.pushed[i]),
            }),
            c: c.clone(),
            d: Mat::from_fn(c.nrows(), columns, |i, j| match j {
                0 => more * d[(i, 0)],
                _ => root * multipliers.weights[i] * direct[i],
            }),
        }
    }
}

impl Condition for SampledCondition {
    type Numbers = SampledNumbers;

    const BISECTIONS: u32 = BISECTIONS;

    fn ceilings(&self) -> [f64; 2] {
        let of = |value: &c64| -value.re.portable_hypot(value.im).portable_ln() / self.step;
        let of_loop = self.eigenvalues.iter().map(of).fold(f64::INFINITY, f64::min);
        // c below (2 a_2 h - 2 h kf c_X)/(1 + h kf c_X)^2.
        let of_x = self.states.map_or(f64::INFINITY, |States { decay, kf, c_x, .. }| {
            let c = 2.0 * (decay * self.step - kf * c_x) / (1.0 + kf * c_x).portable_powi(2);
            (1.0 + c).max(0.0).portable_ln() / (2.0 * self.step)
        });
        [of_loop, of_x]
    }

    fn holds(&self, rate: f64) -> bool {
        self.best(self.sizes(self.c(rate)), &self.along(rate)).1 < 1.0
    }

    fn propose(&self, largest: f64, share: f64) -> Option<Proposal<SampledNumbers>> {
        let multipliers = self.multipliers(largest * f64::midpoint(1.0, share), 0.5)?;
        let pi = multipliers.system.least()?;
        Some(Proposal { pi, numbers: multipliers.numbers(self.c(largest * share)) })
    }
}

/// The numbers of a proof at samples beside Pi, in doubles.
#[derive(Clone, Debug)]
pub struct SampledNumbers {
    /// c.
    pub c: f64,
    /// l_slope.
    pub l_slope: f64,
    /// l_hold.
    pub l_hold: f64,
    /// Those of x.
    pub of_x: Option<OfX<f64>>,
}

impl Multipliers {
    /// Those of a proof, with this c.
    pub(super) fn numbers(&self, c: f64) -> SampledNumbers {
        SampledNumbers { c, l_slope: self.l_slope, l_hold: self.l_hold, of_x: self.of_x.clone() }
    }
}

impl Numbers for SampledNumbers {
    type Witness = SampledRateWitness;

    fn witness(&self, pi: Vec<Vec<Rational>>, digits: u32) -> Option<SampledRateWitness> {
        let round = |value: f64| round_f64(value, digits, Direction::Nearest);
        let of_x = match &self.of_x {
            None => None,
            Some(OfX { w, l_x, l_e, l_y }) => {
                Some(OfX { w: round(*w)?, l_x: round(*l_x)?, l_e: round(*l_e)?, l_y: round(*l_y)? })
            }
        };
        let c = round_f64(self.c, 9, Direction::Down)?;
        let [l_slope, l_hold] = [round(self.l_slope)?, round(self.l_hold)?];
        Some(SampledRateWitness { pi, c, l_slope, l_hold, of_x, inputs: Inputs::default() })
    }
}
