//! Quadratic forms that fall along the differences of solutions of the law at samples, for small peaks (derivation, 14.6): semidefinite programs over
//! a few points at which the derivatives are known.

use super::peak_program::{PeakOf, PeakProgram, positive};
use super::pointwise::Slopes;
use crate::semidefinite::propose;
use sigmastar_matrix::symmetric::{triangle, unit_entry};
use sigmastar_matrix::{AffineMatrix, Symmetric};
use sigmastar_theory::derivation::sampled_form::{AtPoint, Corner, FormNumbers, Less, LoopNumbers, form};

/// What a program at samples needs besides.
#[derive(Clone, Debug)]
pub struct HeldProgram {
    /// The numbers of the law.
    pub of: LoopNumbers<f64>,
    /// With a delay: how far the last y is from that of the periodic solution at the start.
    pub past: Option<f64>,
}

/// `V = x'P x + w e^2 + (b K k_p/2) |zeta|_N^2`, with a delay `g_m h y_{k-1}^2` besides.
#[derive(Clone, Debug)]
pub struct HeldForm {
    /// P by rows.
    pub matrix: Vec<Vec<f64>>,
    /// w.
    pub weight: f64,
    /// k_p.
    pub k_p: f64,
    /// lambda.
    pub lambda: f64,
    /// g_m, with a delay.
    pub past: Option<f64>,
    /// gamma and c_y, of one that says how far a solution is from a trial.
    pub near: Option<[f64; 2]>,
}

/// What a program at samples looks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HeldGoal {
    /// A small peak.
    Peak(PeakOf),
    /// That the solution is near to a trial: `F_s - c_y y^2 + gamma q_0^2 >= 0` with a small `(gamma d_q^2 + 9/5 lambda (h/pi)^2 d_w^2)/c_y`, of a defect d_q and a control that
    /// is off by d_w within a sample. Without a delay.
    NearTrial([f64; 2]),
}

/// One variable of the program that is 1, the others 0.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Variable {
    Matrix(usize, usize),
    Weight,
    KP,
    Lambda,
    Past,
    /// What P is at most.
    Above,
    /// gamma, near a trial.
    Gamma,
}

/// Units in which everything is about 1.
struct Units {
    x: f64,
    e: f64,
    /// Of G and v, over that of e.
    within: f64,
}

impl PeakProgram {
    /// The form with the least bound of the peak that is found, of the law at samples; `margin` is the share of the diagonal by which the matrices are to be
    /// definite. `None` where none is found. All points have all derivatives.
    #[must_use]
    pub fn propose_at_samples(&self, goal: HeldGoal, margin: f64, held: &HeldProgram) -> Option<HeldForm> {
        let n = self.points.first()?.1.r.len();
        let delayed = held.past.is_some();
        let near = matches!(goal, HeldGoal::NearTrial(_));
        let mut variables: Vec<Variable> = triangle(n).map(|(i, k)| Variable::Matrix(i, k)).collect();
        variables.extend([Variable::Weight, Variable::KP, Variable::Lambda, Variable::Above]);
        if delayed {
            variables.push(Variable::Past);
        }
        if near {
            variables.push(Variable::Gamma);
        }
        let sigma = self.sigma;
        let e = positive(self.start[1], 1.0);
        let units = Units { x: positive(self.start[0], e), e, within: (sigma * held.of.across).sqrt() };
        let is = |variable: usize, other: Variable| f64::from(variables[variable] == other);
        let mut constraints: Vec<AffineMatrix<f64>> = Vec::new();
        for (_, point) in &self.points {
            for corner in held.of.corners(delayed) {
                let terms: Vec<Vec<Vec<f64>>> = variables
                    .iter()
                    .map(|variable| matrix((sigma, near), held, (&units, margin), *variable, (point, &corner)))
                    .collect();
                let entry = |variable: usize, i: usize, k: usize| terms[variable][i.min(k)][i.max(k)];
                let order = n + 4 + usize::from(delayed) + usize::from(near);
                // c_y is 1/sigma.
                let constant = |i: usize, k: usize| if near && i == n + 1 && k == n + 1 { -1.0 } else { 0.0 };
                constraints.push(AffineMatrix::from_fn(order, variables.len(), constant, entry));
            }
        }
        let in_matrix = |variable: usize, i: usize, k: usize| match variables[variable] {
            Variable::Matrix(p, q) => unit_entry((p, q), i, k),
            _ => 0.0,
        };
        let cost: Vec<f64> = variables
            .iter()
            .map(|variable| match variable {
                Variable::Weight => 1.0,
                Variable::Above if n > 0 => 1.0,
                Variable::KP => self.gain[1] * self.mu / (2.0 * sigma) * square(self.start[2] / units.e),
                Variable::Past => held.of.step / sigma * square(held.past.unwrap_or(0.0) / units.e),
                _ => 0.0,
            })
            .collect();
        // What x^2 has at least: enough for the level to keep x within its reach.
        let far = self.reach.map_or(0.0, |reach| square(units.x / reach));
        if n > 0 {
            let above = |variable: usize, i: usize, k: usize| {
                is(variable, Variable::Above) * f64::from(i == k) - in_matrix(variable, i, k)
            };
            let below = |variable: usize, i: usize, k: usize| {
                let least = far * cost[variable] + margin * is(variable, Variable::Above);
                in_matrix(variable, i, k) - least * f64::from(i == k)
            };
            constraints.push(AffineMatrix::from_fn(n, variables.len(), |_, _| 0.0, above));
            constraints.push(AffineMatrix::from_fn(n, variables.len(), |_, _| 0.0, below));
        } else {
            let above = |variable: usize, _, _| is(variable, Variable::Above);
            constraints.push(AffineMatrix::from_fn(1, variables.len(), |_, _| 0.0, above));
        }
        // 1/w + share/kappa + past/gamma <= 1, by its Schur complement; of the error 1/w alone.
        let with_control = goal == HeldGoal::Peak(PeakOf::Control);
        let share = 2.0 * self.mu * self.n_bar_squared / (sigma * self.gain[0]);
        let of_past = held.of.step * square(sigma + self.mu * self.n_bar_squared) / sigma;
        let parts: Vec<(Variable, f64)> = [(Variable::Weight, 1.0), (Variable::KP, share), (Variable::Past, of_past)]
            .into_iter()
            .filter(|(variable, _)| with_control || *variable == Variable::Weight)
            .filter(|(variable, _)| delayed || *variable != Variable::Past)
            .collect();
        let constant = |i: usize, k: usize| match (i.min(k), i.max(k)) {
            (0, 0) => 1.0,
            (0, k) => parts[k - 1].1.sqrt(),
            _ => 0.0,
        };
        let term = |variable: usize, i: usize, k: usize| match (i, k) {
            (i, k) if i == k && i > 0 => is(variable, parts[i - 1].0),
            _ => 0.0,
        };
        let of_trial = match goal {
            HeldGoal::Peak(_) => None,
            HeldGoal::NearTrial(disturbances) => {
                // Of gamma and lambda in their units; across has 3/2 h/pi.
                let [of_q, of_w] = disturbances.map(square);
                let of_lambda = 0.8 * square(held.of.across) * of_w * square(sigma) / square(units.within);
                let least = 1e-6 * of_q.max(of_lambda);
                let of_variable = |variable: &Variable| match variable {
                    Variable::Gamma => of_q.max(least) / of_q.max(of_lambda),
                    Variable::Lambda => of_lambda.max(least) / of_q.max(of_lambda),
                    _ => 0.0,
                };
                Some(variables.iter().map(of_variable).collect())
            }
        };
        if !near {
            constraints.push(AffineMatrix::from_fn(parts.len() + 1, variables.len(), constant, term));
        }
        let found = propose(&of_trial.unwrap_or(cost), &constraints).ok()?.x;
        let value = |variable: Variable| variables.iter().position(|own| *own == variable).map(|place| found[place]);
        let ratio = units.e / units.x;
        Some(HeldForm {
            matrix: Symmetric::from_entries(n, &found).map(|_, _, value| value * ratio * ratio).rows(),
            weight: value(Variable::Weight)?,
            k_p: value(Variable::KP)? / sigma,
            lambda: value(Variable::Lambda)? * sigma / (units.within * units.within),
            past: value(Variable::Past).map(|past| past / sigma),
            near: value(Variable::Gamma).map(|gamma| [gamma / sigma, sigma.recip()]),
        })
    }
}

fn square(value: f64) -> f64 {
    value * value
}

/// F over sigma in these units, the upper triangle, less its margin: linear in the variables.
fn matrix(
    (sigma, near): (f64, bool),
    held: &HeldProgram,
    (units, margin): (&Units, f64),
    variable: Variable,
    (point, corner): (&Slopes, &Corner<'_, f64>),
) -> Vec<Vec<f64>> {
    let Units { x, e, within } = *units;
    let n = point.r.len();
    let delayed = held.past.is_some();
    let is = |other: Variable| f64::from(variable == other);
    let ratio = e / x;
    let of_matrix = |i: usize, k: usize| match variable {
        Variable::Matrix(p, q) => unit_entry((p, q), i, k) * ratio * ratio,
        _ => 0.0,
    };
    let numbers = FormNumbers {
        of: &held.of,
        weight: is(Variable::Weight),
        k_p: is(Variable::KP) / sigma,
        lambda: is(Variable::Lambda) * sigma / (within * within),
        less: Less { e_k: 0.0, e: 0.0, y: 0.0 },
        gamma: near.then(|| is(Variable::Gamma) / sigma),
        past: delayed.then(|| is(Variable::Past) / sigma),
    };
    // In the order (x, e, y, G, v) and then q_0 or p: the length of each over that of e, and the variable that is kept.
    let place = |i: usize| match i {
        _ if i < n => (ratio.recip(), Variable::Above),
        _ if i == n => (1.0, Variable::Weight),
        _ if i == n + 1 => (sigma, Variable::KP),
        _ if i < n + 4 => (within, Variable::Lambda),
        _ if near => (sigma, Variable::Gamma),
        _ => (sigma, Variable::Past),
    };
    let order = n + 4 + usize::from(delayed) + usize::from(near);
    let mut matrix = vec![vec![0.0; order]; order];
    for (i, k, value) in form(&AtPoint::default(), numbers, corner, point.with(of_matrix, 0.0)) {
        matrix[i][k] = value * place(i).0 * place(k).0 / sigma;
    }
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] -= margin * is(place(i).1);
    }
    matrix
}
