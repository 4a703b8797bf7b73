//! Pi for the bounds of noise and disturbances, in floating point (derivation, 13.6).
//!
//! With the middle of delta and of the input gain, as in [`super::small_gain`], (N) asks of `Q = Pi^-1`, with lam and l = 1,
//!
//!   `(A_c + lam) Q + (.)' + Q (c e e' + c_v v v') Q + (beta + gam_d) B B' + gam_v B_v B_v' < 0`,  gam_d = 1/g_d, gam_v = 1/g_v,
//!
//! of which the stabilising solution of the Riccati equation is the least Q there is. `1/e_low` is its first entry, so
//! `S^2 = Q_ee (d_bar^2/gam_d + v_bar^2/gam_v)/(2 lam)`: to be made small over lam, over `gam_d + gam_v k^2`, k = sigma + mu b'b being about what
//! noise is worth as a disturbance, and, with both inputs, over their ratio. Nothing here is a claim.

use super::descent::{Point, Thoroughness, descend};
use super::riccati::Equation;
use super::small_gain::{Budget, SmallGain};
use faer::linalg::solvers::{DenseSolveCore, Solve};
use faer::{Mat, Side};
use sigmastar_decide::rates::inequality::{ErrorDynamics, Form, RateWitness, Signal};
use sigmastar_exact::number::Portable;

/// One of so many parts of the room in the small-gain condition is given away: c and beta grow with it, the room for inputs shrinks.
const PARTS: f64 = 1e3;

/// Steps of a search in lambda, in the size of the inputs, and in their ratio.
const STEPS: [usize; 3] = [14, 10, 8];

/// Orders of Pi from which on fewer steps are made.
const LARGE: usize = 50;

/// The numbers of a proof but for g_d and g_v.
pub(super) struct Proposal {
    /// lambda.
    pub(super) rate: f64,
    /// w, for l = 1.
    pub(super) w: f64,
    /// Pi.
    pub(super) pi: Mat<f64>,
    /// 1 over the first entry of its inverse.
    pub(super) e_low: f64,
}

/// A Pi with about the least S that (N) can prove for inputs of these sizes, d_bar and v_bar; `None` where none is found.
pub(super) fn propose(dynamics: &ErrorDynamics<'_>, sizes: [f64; 2]) -> Option<Proposal> {
    let search = Search::new(dynamics, sizes)?;
    let steps = if search.condition.order() > LARGE { STEPS.map(|steps| steps / 2) } else { STEPS };
    let cost = |point: Point| search.solve(point).map_or(f64::INFINITY, |solution| solution.square);
    let at = descend(Thoroughness { steps, last: 7.0 }, sizes, cost, |_| ());
    search.proposal(at)
}

struct Search {
    condition: SmallGain,
    largest: f64,
    /// d_bar, v_bar.
    sizes: [f64; 2],
    /// B_v in the middle of the input gain.
    noise: Vec<f64>,
    /// sigma + mu b'b.
    noise_gain: f64,
}

struct Solution {
    /// S^2.
    square: f64,
    /// Q.
    q: Mat<f64>,
    /// lambda.
    rate: f64,
    /// w.
    w: f64,
}

impl Search {
    fn new(dynamics: &ErrorDynamics<'_>, sizes: [f64; 2]) -> Option<Search> {
        let condition = SmallGain::new(dynamics)?;
        let (noise, noise_gain) = condition.dynamics.noise(dynamics.oscillators);
        let largest = condition.largest_rate()?;
        Some(Search { condition, largest, sizes, noise, noise_gain })
    }

    fn proposal(&self, point: Point) -> Option<Proposal> {
        let Solution { q, rate, w, .. } = self.solve(point)?;
        let inverse = q.partial_piv_lu().inverse();
        let n = inverse.nrows();
        let pi = Mat::from_fn(n, n, |i, j| f64::midpoint(inverse[(i, j)], inverse[(j, i)]));
        Some(Proposal { rate, w, pi, e_low: 1.0 / q[(0, 0)] })
    }

    fn solve(&self, point: Point) -> Option<Solution> {
        let rate = point.rate(self.largest);
        let multipliers = self.condition.multipliers(rate, PARTS)?;
        let Budget { available, from_e, from_x, .. } = self.condition.budget(rate);
        let used = from_e + from_x + 2.0 / PARTS * (available - from_e - from_x);
        let room = multipliers.input * ((available / used).portable_powi(2) - 1.0);
        let [gam_d, gam_v] = point.weights(room, self.sizes, self.noise_gain);
        let input = &self.condition.dynamics.input;
        let n = input.len();
        let a = Mat::from_fn(n, n, |i, j| self.condition.dynamics.matrix[(j, i)] + if i == j { rate } else { 0.0 });
        let driven = Mat::from_fn(n, n, |i, j| {
            (multipliers.input + gam_d) * input[i] * input[j] + gam_v * self.noise[i] * self.noise[j]
        });
        let of_e: Vec<f64> = (0..n).map(|i| f64::from(u8::from(i == 0))).collect();
        let mut inputs = vec![(multipliers.output, of_e)];
        if !self.condition.dynamics.moved.is_empty() {
            inputs.push((multipliers.moved, self.condition.dynamics.moved.clone()));
        }
        let equation = Equation { a: &a, inputs: &inputs, output: &driven };
        let q = equation.stabilising([multipliers.input + point.total(room), multipliers.output])?;
        let q = equation.refined(&q).unwrap_or(q);
        let of = |size: f64, weight: f64| if size > 0.0 { size * size / weight } else { 0.0 };
        let [d_bar, v_bar] = self.sizes;
        let square = q[(0, 0)] * (of(d_bar, gam_d) + of(v_bar, gam_v)) / (2.0 * rate);
        (square.is_finite() && square > 0.0).then_some(Solution { square, q, rate, w: multipliers.w })
    }
}

/// (g_d, g_v) with which the form of a witness without inputs is positive semidefinite with them, about least in
/// `g_d d^2 + g_v v^2` for these sizes d, v of the inputs; in doubles, and no claim. `None` where it is not even without them.
pub(super) fn input_weights(dynamics: &ErrorDynamics<'_>, witness: &RateWitness, sizes: [f64; 2]) -> Option<[f64; 2]> {
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
