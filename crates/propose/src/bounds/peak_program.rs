//! Quadratic forms that fall along the differences of solutions, for small peaks (derivation, 14.4, 14.5): semidefinite programs over a few
//! points at which the derivatives are known.

use super::pointwise::Slopes;
use crate::semidefinite::propose_among;
use sigmastar_matrix::AffineMatrix;
use sigmastar_matrix::doubles::{largest, largest_of};
use sigmastar_matrix::symmetric::{Symmetric, triangle};
use sigmastar_theory::evidence::Part;

/// What is to be small.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PeakOf {
    /// |e - e_per|.
    Error,
    /// |u - u_per|.
    Control,
}

/// A loop, and how far from its periodic solution it starts.
#[derive(Clone, Debug)]
pub struct PeakProgram {
    /// J, g, r, d at some points, in the coordinates of the norms of x: all of them at once, or J and r at some and g and d at others, which
    /// gives a form along x first.
    pub points: Vec<(Part, Slopes)>,
    /// b at both ends of the input gain.
    pub gain: [f64; 2],
    /// sigma.
    pub sigma: f64,
    /// mu.
    pub mu: f64,
    /// The sum of all weights.
    pub n_bar_squared: f64,
    /// The distances of the start from the periodic solution: of x, e, and zeta.
    pub start: [f64; 3],
    /// Whether x and e are joined; they are not along x first.
    pub joint: bool,
    /// How far x may come from the periodic solution, where that is limited.
    pub reach: Option<f64>,
}

/// `V = x'P x + 2 e p'x + w e^2 + (b mu k_p/2) |zeta|_N^2`.
#[derive(Clone, Debug)]
pub struct FallingForm {
    /// P by rows.
    pub matrix: Vec<Vec<f64>>,
    /// p: zeros where x and e are not joined.
    pub cross: Vec<f64>,
    /// w.
    pub weight: f64,
    /// k_p.
    pub k_p: f64,
    /// `P <= p_up I`.
    pub p_up: f64,
    /// `Pi >= diag(x_low I, 0)`; 1 without states.
    pub x_low: f64,
    /// `Pi >= diag(0, e_low)`.
    pub e_low: f64,
    /// S of (14.5a), along x first.
    pub splitting: Option<Vec<Vec<f64>>>,
    /// c_x, c_e and c_y of (14.4a) at the points.
    pub margins: [f64; 3],
    /// A bound of V at the start.
    pub level: f64,
}

/// The places of the variables.
#[derive(Clone, Copy)]
struct Variables {
    n: usize,
    /// The entries of P come first, then those of p.
    m: usize,
    cross: usize,
    /// Whether those of S come last.
    split: bool,
}

impl Variables {
    /// w; k_p sigma; what P, and |p|, are at most; what e^2 has at least.
    fn w(self) -> usize {
        self.m + self.cross
    }
    fn kappa(self) -> usize {
        self.w() + 1
    }
    fn above(self) -> usize {
        self.w() + 2
    }
    fn length(self) -> usize {
        self.w() + 3
    }
    fn of_error(self) -> usize {
        self.w() + 4
    }
    fn splitting(self) -> usize {
        self.w() + 5
    }
    fn count(self) -> usize {
        self.splitting() + if self.split { triangle(self.n + 1).count() } else { 0 }
    }

    /// The coefficient of a variable in an entry of S.
    fn in_splitting(self, variable: usize, i: usize, k: usize) -> f64 {
        let place = triangle(self.n + 1).position(|(p, q)| (p.min(q), p.max(q)) == (i.min(k), i.max(k)));
        f64::from(place.is_some_and(|place| self.splitting() + place == variable))
    }

    /// The coefficient of a variable in an entry of `[P p; p' w]`.
    fn in_metric(self, variable: usize, i: usize, k: usize) -> f64 {
        let (i, k) = (i.min(k), i.max(k));
        let here = match (k < self.n, i < self.n) {
            (true, _) => triangle(self.n).position(|(p, q)| (p.min(q), p.max(q)) == (i, k)),
            (false, true) => (self.cross > 0).then(|| self.m + i),
            (false, false) => Some(self.w()),
        };
        f64::from(here == Some(variable))
    }
}

impl PeakProgram {
    /// The form with the least bound of the peak that is found; `margin` is the share of the diagonal by which the matrices are to be definite. `None`
    /// where none is found.
    #[must_use]
    pub fn propose(&self, of: PeakOf, margin: f64) -> Option<FallingForm> {
        let n = self.points.first()?.1.r.len();
        let m = triangle(n).count();
        let split = self.points.iter().any(|(part, _)| *part != Part::All);
        let joint = self.joint && !split;
        let v = Variables { n, m, cross: if joint { n } else { 0 }, split };
        // Lengths of x, e and y, so that the distances of the start are 1: x = d_x xi, e = d_e eps, y = sigma d_e up.
        let d_e = positive(self.start[1], 1.0);
        let d_x = positive(self.start[0], d_e);
        let ratio = d_e / d_x;
        let gains = if self.gain[0] == self.gain[1] { &self.gain[..1] } else { &self.gain[..] };
        let mut at_points: Vec<AffineMatrix<f64>> = Vec::new();
        let mut constraints: Vec<AffineMatrix<f64>> = Vec::new();
        for (part, point) in &self.points {
            for b in gains.iter().copied() {
                // In the order (x, e, y).
                let term = |variable: usize, i: usize, k: usize| {
                    let kept = f64::from(i == k)
                        * match (i < n, i == n) {
                            (true, _) => f64::from(variable == v.above()),
                            (_, true) => f64::from(variable == v.w()),
                            _ => f64::from(variable == v.kappa()),
                        };
                    let of_error = i == n || k == n;
                    let own = || self.entry(v, (point, b), ratio, variable, i, k);
                    let in_splitting = || v.in_splitting(variable, i.min(n), k.min(n));
                    let value = match part {
                        Part::All => own(),
                        Part::States => own() - in_splitting(),
                        Part::Error if of_error => own(),
                        Part::Error => in_splitting(),
                    };
                    value - margin * kept
                };
                at_points.push(match part {
                    Part::States => {
                        let skip = |i: usize| if i == n { n + 1 } else { i };
                        let term = |variable: usize, i: usize, k: usize| term(variable, skip(i), skip(k));
                        AffineMatrix::from_fn(n + 1, v.count(), |_, _| 0.0, term)
                    }
                    _ => AffineMatrix::from_fn(n + 2, v.count(), |_, _| 0.0, term),
                });
            }
        }
        let is = |variable: usize, other: usize| f64::from(variable == other);
        let of_zeta = self.start[2] / d_e;
        let mut cost = vec![0.0; v.count()];
        cost[v.w()] = 1.0;
        cost[v.kappa()] = self.gain[1] * self.mu / (2.0 * self.sigma) * of_zeta * of_zeta;
        if n > 0 {
            (cost[v.above()], cost[v.length()]) = (1.0, 2.0);
            let above = |variable: usize, i: usize, k: usize| {
                is(variable, v.above()) * f64::from(i == k) - v.in_metric(variable, i, k)
            };
            constraints.push(AffineMatrix::from_fn(n, v.count(), |_, _| 0.0, above));
            // What x^2 has at least: enough for the level to keep x within its reach.
            let far = self.reach.map_or(0.0, |reach| (d_x / reach) * (d_x / reach));
            let below = |variable: usize, i: usize, k: usize| {
                let least = far * cost[variable] + margin * is(variable, v.above());
                v.in_metric(variable, i, k) - if i == k && i < n { least } else { 0.0 }
            };
            constraints.push(AffineMatrix::from_fn(n + 1, v.count(), |_, _| 0.0, below));
        } else {
            constraints.push(AffineMatrix::from_fn(1, v.count(), |_, _| 0.0, |variable, _, _| is(variable, v.above())));
        }
        let long = |variable: usize, i: usize, k: usize| {
            let of_length = is(variable, v.length()) * f64::from(i == k);
            let beside = if i.max(k) == n && i.min(k) < n { v.in_metric(variable, i, k) } else { 0.0 };
            of_length + beside
        };
        constraints.push(AffineMatrix::from_fn(n + 1, v.count(), |_, _| 0.0, long));
        let of_error = |variable: usize, i: usize, k: usize| {
            let least = if i == n && k == n { is(variable, v.of_error()) } else { 0.0 };
            v.in_metric(variable, i, k) - least
        };
        constraints.push(AffineMatrix::from_fn(n + 1, v.count(), |_, _| 0.0, of_error));
        constraints.push(match of {
            PeakOf::Error => {
                AffineMatrix::from_fn(1, v.count(), |_, _| -1.0, |variable, _, _| is(variable, v.of_error()))
            }
            PeakOf::Control => {
                // 1/e_low + share/kappa <= 1, by its Schur complement.
                let share = 2.0 * self.mu * self.n_bar_squared / (self.sigma * self.gain[0]);
                let constant = |i: usize, k: usize| match (i.min(k), i.max(k)) {
                    (0, 0) | (0, 1) => 1.0,
                    (0, 2) => share.sqrt(),
                    _ => 0.0,
                };
                let term = |variable: usize, i: usize, k: usize| match (i, k) {
                    (1, 1) => is(variable, v.of_error()),
                    (2, 2) => is(variable, v.kappa()),
                    _ => 0.0,
                };
                AffineMatrix::from_fn(3, v.count(), constant, term)
            }
        });
        let found = propose_among(&cost, &at_points, &constraints).ok()?;
        let level = cost.iter().zip(&found).map(|(cost, value)| cost * value).sum::<f64>() * d_e * d_e;
        // In units of e^2.
        let matrix = Symmetric::from_entries(n, &found).map(|_, _, value| value * ratio * ratio).rows();
        let cross: Vec<f64> =
            if joint { found[m..m + n].iter().map(|value| value * ratio).collect() } else { vec![0.0; n] };
        let [w, kappa, above] = [v.w(), v.kappa(), v.above()].map(|variable| found[variable]);
        let p_up = above * ratio * ratio;
        let margins = [margin * self.sigma * p_up, margin * self.sigma * w, margin * kappa / self.sigma];
        // P less what p takes of it.
        let less = |i: usize| (0..n).map(|k| cross[i] * cross[k] / w - matrix[i][k]).collect::<Vec<f64>>();
        let x_low = if n > 0 { -largest((0..n).map(less).collect()) } else { 1.0 };
        let e_low = found[v.of_error()];
        // Over sigma, and in the lengths of x and y.
        let length = |i: usize| if i < n { ratio } else { self.sigma.recip() };
        let of_splitting = |i: usize, k: usize, value: &f64| value * self.sigma * length(i) * length(k);
        let splitting = split.then(|| Symmetric::from_entries(n + 1, &found[v.splitting()..]).map(of_splitting).rows());
        let k_p = kappa / self.sigma;
        Some(FallingForm { matrix, cross, weight: w, k_p, p_up, x_low, e_low, splitting, margins, level })
    }

    /// The coefficient of a variable in an entry of the matrix (14.4a) over sigma, in (xi, eps, up).
    fn entry(&self, v: Variables, (point, b): (&Slopes, f64), ratio: f64, variable: usize, i: usize, k: usize) -> f64 {
        let (i, k) = (i.min(k), i.max(k));
        let (n, sigma) = (v.n, self.sigma);
        let Slopes { j, g, r, d } = point;
        // A row of P or p, by which a column is multiplied.
        let times = |row: usize, column: &dyn Fn(usize) -> f64| -> f64 {
            (0..n).map(|l| v.in_metric(variable, row, l) * column(l)).sum()
        };
        let of_state = |column: usize| move |l: usize| j[l * n + column] / sigma;
        let of_error = |l: usize| g[l] * ratio / sigma;
        let own = |row: usize, column: usize| v.in_metric(variable, row, column);
        let of_kappa = if variable == v.kappa() { 1.0 } else { 0.0 };
        match (i < n, k < n, i == n, k == n) {
            (true, true, ..) => -times(i, &of_state(k)) - times(k, &of_state(i)),
            (true, _, _, true) => own(i, n) - times(i, &of_error) - times(n, &of_state(i)),
            (true, ..) => -own(i, n) - 0.5 * of_kappa * r[i] / (ratio * sigma),
            (_, _, true, true) => 2.0 * own(n, n) - 2.0 * times(n, &of_error),
            (_, _, true, _) => -own(n, n) - 0.5 * of_kappa * (d + (1.0 - b) * sigma) / sigma,
            _ => of_kappa,
        }
    }

    /// The least of the margins of a form, in the lengths of the start.
    #[must_use]
    pub fn least_margin(&self, form: &FallingForm) -> f64 {
        let d_e = positive(self.start[1], 1.0);
        let d_x = positive(self.start[0], d_e);
        let [c_x, c_e, c_y] = form.margins;
        let [of_e, of_y] = [c_e * d_e * d_e, c_y * (self.sigma * d_e) * (self.sigma * d_e)];
        if form.matrix.is_empty() { of_e.min(of_y) } else { of_e.min(of_y).min(c_x * d_x * d_x) }
    }

    /// By how much the matrix (14.4a) of a form, less its margins, is not positive semidefinite at a point, in the lengths of the start; along x first
    /// the one of (14.5a) that is about this part of the derivatives.
    #[must_use]
    pub fn lack(&self, form: &FallingForm, at: (Part, &Slopes)) -> f64 {
        let (mut matrix, order) = self.lacking(form, at);
        largest_of(&mut matrix, order)
    }

    /// The same where it is more than `least`; else negative infinity, which is far sooner seen.
    #[must_use]
    pub fn lack_above(&self, form: &FallingForm, at: (Part, &Slopes), least: f64) -> f64 {
        let (mut matrix, order) = self.lacking(form, at);
        if is_below(&matrix, order, least) { f64::NEG_INFINITY } else { largest_of(&mut matrix, order) }
    }

    /// The matrix whose largest eigenvalue is the lack, by rows, and its order.
    fn lacking(&self, form: &FallingForm, (part, point): (Part, &Slopes)) -> (Vec<f64>, usize) {
        let n = point.r.len();
        let d_e = positive(self.start[1], 1.0);
        let d_x = positive(self.start[0], d_e);
        let FallingForm { matrix: p, cross, weight, k_p, splitting, margins, .. } = form;
        let Slopes { j, g, r, d } = point;
        let sigma = self.sigma;
        let in_splitting = |i: usize, k: usize| splitting.as_ref().map_or(0.0, |s| s[i.min(k).min(n)][i.max(k).min(n)]);
        let of_state = |row: &[f64], column: usize| (0..n).map(|l| row[l] * j[l * n + column]).sum::<f64>();
        let of_error = |row: &[f64]| row.iter().zip(g).map(|(p, g)| p * g).sum::<f64>();
        let unit = |i: usize| {
            if i < n {
                d_x
            } else if i == n {
                d_e
            } else {
                sigma * d_e
            }
        };
        let entry = |i: usize, k: usize| {
            let (i, k) = (i.min(k), i.max(k));
            let margin = |own: f64| if i == k { own } else { 0.0 };
            let value = match (i < n, k < n, i == n, k == n) {
                (true, true, ..) => -of_state(&p[i], k) - of_state(&p[k], i) - margin(margins[0]),
                (true, _, _, true) => sigma * cross[i] - of_error(&p[i]) - of_state(cross, i),
                (true, ..) => -cross[i] - 0.5 * k_p * r[i],
                (_, _, true, true) => 2.0 * sigma * weight - 2.0 * of_error(cross) - margins[1],
                (_, _, true, _) => -weight - 0.5 * k_p * d,
                _ => k_p - margins[2],
            };
            let value = match part {
                Part::States => value - in_splitting(i, k),
                Part::Error if i != n && k != n => in_splitting(i, k),
                _ => value,
            };
            -value * unit(i) * unit(k)
        };
        let places: Vec<usize> = (0..n + 2).filter(|place| part != Part::States || *place != n).collect();
        let order = places.len();
        let mut matrix = vec![0.0; order * order];
        for (row, i) in places.iter().enumerate() {
            for (column, k) in places.iter().enumerate().skip(row) {
                let value = entry(*i, *k);
                (matrix[row * order + column], matrix[column * order + row]) = (value, value);
            }
        }
        (matrix, order)
    }
}

/// Whether all eigenvalues of a symmetric matrix are below a number, by the pivots of what is between.
fn is_below(matrix: &[f64], order: usize, number: f64) -> bool {
    let mut rest: Vec<f64> = matrix.iter().map(|entry| -entry).collect();
    (0..order).for_each(|i| rest[i * order + i] += number);
    for k in 0..order {
        let pivot = rest[k * order + k];
        if pivot.is_nan() || pivot <= 0.0 {
            return false;
        }
        for i in k + 1..order {
            let factor = rest[i * order + k] / pivot;
            (k + 1..=i).for_each(|j| rest[i * order + j] -= factor * rest[j * order + k]);
        }
    }
    true
}

/// The value, or another one where it is not positive.
pub(super) fn positive(value: f64, other: f64) -> f64 {
    if value > 0.0 && value.is_finite() { value } else { other }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_is_below_a_number_if_its_largest_eigenvalue_is() {
        // Their largest eigenvalues are 3, 5 and 2 + sqrt(2); the second one fails at the last pivot alone.
        let matrices: [(&[f64], usize, f64); 3] = [
            (&[1.0, 2.0, 2.0, 1.0], 2, 3.0),
            (&[-1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 5.0], 3, 5.0),
            (&[2.0, 1.0, 0.0, 1.0, 2.0, 1.0, 0.0, 1.0, 2.0], 3, 2.0 + std::f64::consts::SQRT_2),
        ];
        for (matrix, order, largest) in matrices {
            assert!(is_below(matrix, order, largest + 1e-9), "{matrix:?}");
            assert!(!is_below(matrix, order, largest - 1e-9), "{matrix:?}");
        }
        assert!(!is_below(&[1.0, 2.0, 2.0, 1.0], 2, 3.0), "one that is equal is not below");
        assert!(is_below(&[-2.0, 1.0, 1.0, -0.51], 2, 0.0) && !is_below(&[-2.0, 1.0, 1.0, -0.49], 2, 0.0));
        assert!(!is_below(&[f64::NAN], 1, 3.0) && !is_below(&[0.0, f64::NAN, f64::NAN, 0.0], 2, 3.0));
        assert!(is_below(&[], 0, -1.0));
    }
}
