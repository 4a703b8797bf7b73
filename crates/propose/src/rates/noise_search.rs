//! Pi for the bounds of noise and disturbances, in floating point (derivation, 13.6).
//!
//! With the middle of delta and of the input gain, as in [`super::SmallGain`], (N) asks of `Q = Pi^-1`, with lam and l = 1,
//!
//!   `(A_c + lam) Q + (.)' + Q (c e e' + c_v v v') Q + (beta + gam_d) B B' + gam_v B_v B_v' < 0`,  gam_d = 1/g_d, gam_v = 1/g_v,
//!
//! of which the stabilising solution of the Riccati equation is the least Q there is. `1/e_low` is its first entry, so
//! `S^2 = Q_ee (d_bar^2/gam_d + v_bar^2/gam_v)/(2 lam)`: to be made small over lam, over `gam_d + gam_v k^2`, k = sigma + mu b'b being about what
//! noise is worth as a disturbance, and, with both inputs, over their ratio. Nothing here is a claim.

use super::least::{Point, Thoroughness, least};
use super::proposal::{Condition, FIGURES, NoiseProposal, Proposal, above, below};
use super::riccati::Equation;
use super::small_gain::{Budget, RateNumbers, SmallGain};
use faer::linalg::solvers::{DenseSolveCore, Solve};
use faer::{Mat, Side};
use rug::Rational;
use sigmastar_decide::rates::inequality::{ErrorDynamics, Form, RateWitness, Signal};
use sigmastar_exact::number::{Direction, Portable, round_f64};

/// One of so many parts of the room in the small-gain condition is given away: c and beta grow with it, the room for inputs shrinks.
const PARTS: f64 = 1e3;

/// Steps of a search in lambda, in the size of the inputs, and in their ratio.
const STEPS: [usize; 3] = [14, 10, 8];

/// The numbers of a proof of (N) but for g_d and g_v.
pub struct ForInputs<'a> {
    dynamics: &'a ErrorDynamics<'a>,
    /// d_bar, v_bar.
    sizes: [f64; 2],
    /// lambda.
    rate: f64,
    /// w, for l = 1.
    w: f64,
    /// Pi^-1.
    q: Mat<f64>,
    /// S^2.
    square: f64,
}

/// A Pi with about the least S that (N) can prove for inputs of these sizes, d_bar and v_bar; `None` where none is found.
#[must_use]
pub fn propose<'a>(dynamics: &'a ErrorDynamics<'a>, sizes: [f64; 2]) -> Option<ForInputs<'a>> {
    let condition = SmallGain::new(dynamics)?;
    let SmallGain { matrix, input, moved, .. } = &condition;
    // B_v in the middle of the input gain, and sigma + mu b'b.
    let (noise, noise_gain) = condition.noise(dynamics.oscillators);
    let largest = condition.largest_rate()?;
    let n = input.len();
    let solve = |point: Point, parts: f64| {
        let rate = point.rate(largest);
        let multipliers = condition.multipliers(rate, parts)?;
        let Budget { available, from_e, from_x, .. } = multipliers.budget;
        let used = from_e + from_x + 2.0 / parts * (available - from_e - from_x);
        let room = multipliers.input * ((available / used).portable_powi(2) - 1.0);
        let [gam_d, gam_v] = point.weights(room, sizes, noise_gain);
        let a = Mat::from_fn(n, n, |i, j| matrix[(j, i)] + if i == j { rate } else { 0.0 });
        let driven =
            Mat::from_fn(n, n, |i, j| (multipliers.input + gam_d) * input[i] * input[j] + gam_v * noise[i] * noise[j]);
        let of_e: Vec<f64> = (0..n).map(|i| f64::from(u8::from(i == 0))).collect();
        let mut inputs = vec![(multipliers.output, of_e)];
        if !moved.is_empty() {
            inputs.push((multipliers.moved, moved.clone()));
        }
        let equation = Equation { a: &a, inputs: &inputs, output: &driven };
        let q = equation.solution([multipliers.input + point.total(room), multipliers.output])?;
        let of = |size: f64, weight: f64| if size > 0.0 { size * size / weight } else { 0.0 };
        let [d_bar, v_bar] = sizes;
        let square = q[(0, 0)] * (of(d_bar, gam_d) + of(v_bar, gam_v)) / (2.0 * rate);
        let found = ForInputs { dynamics, sizes, rate, w: multipliers.w, q, square };
        (square.is_finite() && square > 0.0).then_some(found)
    };
    let thoroughness = Thoroughness { order: n, steps: STEPS, fewer: 2, last: 7.0, slacks: &[PARTS] };
    least(&thoroughness, sizes, solve, |found| found.square)
}

impl NoiseProposal for ForInputs<'_> {
    type Witness = RateWitness;

    fn in_digits(&self, share: f64, digits: u32) -> Option<(RateWitness, Rational)> {
        let rate = round_f64(self.rate * share, FIGURES, Direction::Down)?;
        let (inverse, n) = (self.q.partial_piv_lu().inverse(), self.q.nrows());
        let pi = Mat::from_fn(n, n, |i, j| f64::midpoint(inverse[(i, j)], inverse[(j, i)]));
        let witness = Proposal { pi, numbers: RateNumbers { rate, w: self.w } }.in_digits(digits)?;
        let weights = input_weights(self.dynamics, &witness, self.sizes)?;
        let mut inputs = [None, None];
        for ((input, weight), size) in inputs.iter_mut().zip(weights).zip(self.sizes) {
            if size > 0.0 {
                *input = Some(above(weight)?);
            }
        }
        // 1/Q_ee is the largest one that serves.
        Some((RateWitness { inputs, ..witness }, below(1.0 / self.q[(0, 0)])?))
    }
}

/// (g_d, g_v) with which the form of a witness without inputs is positive semidefinite with them, about least in
/// `g_d d^2 + g_v v^2` for these sizes d, v of the inputs; in doubles, and no claim. `None` where it is not even without them.
fn input_weights(dynamics: &ErrorDynamics<'_>, witness: &RateWitness, sizes: [f64; 2]) -> Option<[f64; 2]> {
    let form = Form::new(dynamics, witness);
    let order = form.order();
    let mut found = [0.0_f64; 2];
    for corner in form.corners() {
        let entries = Mat::from_fn(order, order, |i, j| form.entry(&corner, i, j).midpoint_f64());
        let coupling = |signal: Signal| -> Vec<f64> {
            let of = |first: &Signal| form.coefficient(&corner, *first, signal).midpoint_f64();
            form.signals.iter().map(of).collect()
        };
        let columns = [coupling(Signal::D), coupling(Signal::V)];
        let columns = Mat::from_fn(order, 2, |i, j| columns[j][i]);
        // A NaN would go through.
        if !entries.as_ref().is_all_finite() {
            return None;
        }
        // Of very different sizes: in units in which the diagonal is 1.
        let unit = |i: usize| 1.0 / entries[(i, i)].sqrt();
        let scaled = Mat::from_fn(order, order, |i, j| unit(i) * entries[(i, j)] * unit(j));
        let scaled_columns = Mat::from_fn(order, 2, |i, j| unit(i) * columns[(i, j)]);
        let solved = scaled.llt(Side::Lower).ok()?.solve(&scaled_columns);
        let squares = scaled_columns.transpose() * &solved;
        // diag(g_d, g_v) is to be at least these squares; of the two directions the larger input pays less for the product.
        let product = squares[(0, 1)].abs();
        let shared = match sizes {
            [d, v] if d > 0.0 && v > 0.0 => [product * v / d, product * d / v],
            _ => [0.0; 2],
        };
        for i in 0..2 {
            found[i] = found[i].max(squares[(i, i)] + shared[i]);
        }
    }
    found.iter().all(|weight| weight.is_finite()).then_some(found)
}
