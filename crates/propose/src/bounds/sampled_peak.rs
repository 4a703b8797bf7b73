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
    pub fn propose_at_samples(&self, of: PeakOf, margin: f64, held: &HeldProgram) -> Option<HeldForm> {
        let n = self.points.first()?.1.r.len();
        let delayed = held.past.is_some();
        let mut variables: Vec<Variable> = triangle(n).map(|(i, k)| Variable::Matrix(i, k)).collect();
        variables.extend([Variable::Weight, Variable::KP, Variable::Lambda, Variable::Above]);
        if delayed {
            variables.push(Variable::Past);
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
                    .map(|variable| matrix(sigma, held, (&units, margin), *variable, (point, &corner)))
                    .collect();
                let entry = |variable: usize, i: usize, k: usize| terms[variable][i.min(k)][i.max(k)];
                let order = n + 4 + usize::from(delayed);
                constraints.push(AffineMatrix::from_fn(order, variables.len(), |_, _| 0.0, entry));
            }
        }
        let in_matrix = |variable: usize, i: usize, k: usize| match variables[variable] {
            Variable::Matrix(p, q) => unit_entry((p, q), i, k),
            _ => 0.0,
        };
        if n > 0 {
            let above = |variable: usize, i: usize, k: usize| {
                is(variable, Variable::Above) * f64::from(i == k) - in_matrix(variable, i, k)
            };
            let below = |variable: usize, i: usize, k: usize| {
                in_matrix(variable, i, k) - margin * is(variable, Variable::Above) * f64::from(i == k)
            };
            constraints.push(AffineMatrix::from_fn(n, variables.len(), |_, _| 0.0, above));
            constraints.push(AffineMatrix::from_fn(n, variables.len(), |_, _| 0.0, below));
        } else {
            let above = |variable: usize, _, _| is(variable, Variable::Above);
            constraints.push(AffineMatrix::from_fn(1, variables.len(), |_, _| 0.0, above));
        }
        // 1/w + share/kappa + past/gamma <= 1, by its Schur complement; of the error 1/w alone.
        let with_control = of == PeakOf::Control;
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
        constraints.push(AffineMatrix::from_fn(parts.len() + 1, variables.len(), constant, term));
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
        let found = propose(&cost, &constraints).ok()?.x;
        let value = |variable: Variable| variables.iter().position(|own| *own == variable).map(|place| found[place]);
        let ratio = units.e / units.x;
        Some(HeldForm {
            matrix: Symmetric::from_entries(n, &found).map(|_, _, value| value * ratio * ratio).rows(),
            weight: value(Variable::Weight)?,
            k_p: value(Variable::KP)? / sigma,
            lambda: value(Variable::Lambda)? * sigma / (units.within * units.within),
            past: value(Variable::Past).map(|past| past / sigma),
        })
    }
}

fn square(value: f64) -> f64 {
    value * value
}

/// F over sigma in these units, the upper triangle, less its margin: linear in the variables.
fn matrix(
    sigma: f64,
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
        gamma: None,
        past: delayed.then(|| is(Variable::Past) / sigma),
    };
    // In the order (x, e, y, G, v, p): the length of each over that of e, and the variable that is kept.
    let place = |i: usize| match i {
        _ if i < n => (ratio.recip(), Variable::Above),
        _ if i == n => (1.0, Variable::Weight),
        _ if i == n + 1 => (sigma, Variable::KP),
        _ if i < n + 4 => (within, Variable::Lambda),
        _ => (sigma, Variable::Past),
    };
    let order = n + 4 + usize::from(delayed);
    let mut matrix = vec![vec![0.0; order]; order];
    for (i, k, value) in form(&AtPoint::default(), numbers, corner, point.with(of_matrix, 0.0)) {
        matrix[i][k] = value * place(i).0 * place(k).0 / sigma;
    }
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] -= margin * is(place(i).1);
    }
    matrix
}
