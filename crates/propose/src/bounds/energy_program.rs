//! The free numbers of the matrix inequality (E) of existence (derivation, 13.7), proposed by semidefinite programs over sampled points.

use super::place::{Place, Places};
use super::pointwise::{Derivatives, MatrixAt, Slopes};
use super::suprema::FloatSuprema;
use super::weights::{EnergyAt, EnergyWeights};
use crate::semidefinite::propose;
use sigmastar_lang::spec::Bound;
use sigmastar_matrix::symmetric::triangle;
use sigmastar_matrix::{AffineMatrix, Symmetric};

/// Points that are added where what was found holds least, and how often.
const POINTS: usize = 6;
const ROUNDS: usize = 5;

/// The share of the largest c_y that is left for how definite the rest is.
const KEPT: f64 = 0.93;

/// By what share of k_p c_y may be smaller at a point that was not looked at.
const TOLERANCE: f64 = 1e-3;

/// The share of what the rest is definite by that is c_x.
const OF_STATES: f64 = 0.8;

impl FloatSuprema {
    /// c_y at points of the grid, as functions of the threshold.
    #[must_use]
    pub fn energy_at(&self, at: [f64; 2], places: &Places, weights: &EnergyWeights) -> Vec<EnergyAt> {
        EnergyAt::front(self.of_derivatives(at, places, |derivatives, _| weights.at(derivatives, self.moves)))
    }

    /// The largest c_y that serves at all points, by a longer search.
    #[must_use]
    pub fn refined_margin(&self, at: [f64; 2], weights: &EnergyWeights) -> f64 {
        -self.refined_of_derivatives(at, |derivatives, _| -weights.margin(derivatives, self.moves))
    }

    /// P, k_p, c_x with a large share of c_y in k_p, at a threshold that is given; `None` where there are none.
    #[must_use]
    pub fn propose_energy(&self, at: [f64; 2], value: f64) -> Option<EnergyWeights> {
        let all = Places::Stride(1);
        let mut program = Program { points: Vec::new(), value, moves: self.moves };
        let first = self.where_largest(at, &all, [Bound::Rate, Bound::Qx, Bound::Fe, Bound::QeMax]);
        program.add(self, at, first);
        let mut found = program.solve()?;
        for _ in 0..ROUNDS {
            let worst = self
                .largest_of_derivatives(at, &all, POINTS, |derivatives, _| -found.0.margin(derivatives, self.moves));
            let expected = found.1 - TOLERANCE * found.0.k_p;
            let beyond: Vec<Place> =
                worst.into_iter().filter(|(value, _)| -value < expected).map(|(_, place)| place).collect();
            if beyond.is_empty() {
                break;
            }
            program.add(self, at, beyond);
            found = program.solve()?;
        }
        Some(found.0)
    }
}

/// The programs for given points.
struct Program {
    points: Vec<Slopes>,
    value: f64,
    /// The 1 - b of an input gain.
    moves: Option<[f64; 2]>,
}

impl Program {
    fn add(&mut self, samples: &FloatSuprema, at: [f64; 2], places: Vec<Place>) {
        let point = |derivatives: &Derivatives<'_>, _: &MatrixAt| {
            // (1-b) sigma, at both ends, has its place beside d.
            let d = derivatives.d;
            let slopes = self.moves.map_or_else(|| vec![d], |moves| moves.map(|share| d + share * self.value).into());
            slopes.into_iter().map(|d| Slopes { d, ..Slopes::from(derivatives) }).collect::<Vec<Slopes>>()
        };
        let points = samples.of_derivatives(at, &Places::listed(places), point);
        self.points.extend(points.into_iter().flatten());
    }

    /// The weights, and c_y at the points.
    fn solve(&self) -> Option<(EnergyWeights, f64)> {
        let unit = Slopes::unit(&self.points, self.value);
        let (_, largest) = self.solution(unit, None)?;
        let kept = KEPT * (largest > 0.0).then_some(largest)?;
        let (variables, room) = self.solution(unit, Some(kept))?;
        let n = self.points.first()?.r.len();
        // The weight of e^2 becomes 1.
        let w = *variables.last()?;
        if w.min(room) <= 0.0 {
            return None;
        }
        let p = Symmetric::from_entries(n, &variables).map(|_, _, value| value / (w * unit * unit)).rows();
        let c_x = OF_STATES * room * self.value / (w * unit * unit);
        let k_p = 1.0 / (w * self.value);
        Some((EnergyWeights { p, k_p, c_x, value: self.value }, kept * k_p))
    }

    /// P, the weight w of e^2, and the largest c with `F >= diag(0, 0, c)` for k_p = 1; where c is given, instead of it the largest m
    /// with `F >= diag(m, m, c)`. Time in units of 1/value, y in that of `unit`.
    fn solution(&self, unit: f64, given: Option<f64>) -> Option<(Vec<f64>, f64)> {
        let n = self.points.first()?.r.len();
        let triangle: Vec<(usize, usize)> = triangle(n).collect();
        let (w, last) = (triangle.len(), triangle.len() + 1);
        let (e, y) = (n, n + 1);
        let value = self.value;
        let mut constraints: Vec<AffineMatrix<f64>> = self
            .points
            .iter()
            .map(|Slopes { j: matrix, g, r, d }| {
                let constant = |i: usize, k: usize| match (i.min(k), i.max(k)) {
                    (i, k) if i < n && k == y => -0.5 * r[i] * unit / value,
                    (i, k) if i == e && k == y => -0.5 * d / value,
                    (i, k) if i == y && k == y => 1.0 - given.unwrap_or(0.0),
                    _ => 0.0,
                };
                let term = |variable: usize, i: usize, k: usize| {
                    let (i, k) = (i.min(k), i.max(k));
                    if variable == last {
                        let corner = given.is_none() && i == y && k == y;
                        let definite = given.is_some() && i == k && i <= e;
                        return if corner || definite { -1.0 } else { 0.0 };
                    }
                    if variable == w {
                        return match (i == e, k == e, k == y) {
                            (true, true, _) => 2.0,
                            (true, _, true) => -1.0,
                            _ => 0.0,
                        };
                    }
                    let (a, b) = triangle[variable];
                    // Row `row` of E times a vector, for E with ones at (a, b) and (b, a).
                    let times = |row: usize, vector: &dyn Fn(usize) -> f64| match (row == a, row == b) {
                        (true, _) => vector(b),
                        (false, true) => vector(a),
                        (false, false) => 0.0,
                    };
                    match (i < n, k < n, k == e) {
                        (true, true, _) => {
                            let column = |k: usize| move |m: usize| matrix[m * n + k];
                            -(times(i, &column(k)) + times(k, &column(i))) / value
                        }
                        (true, false, true) => -times(i, &|m| g[m]) / (unit * value),
                        _ => 0.0,
                    }
                };
                AffineMatrix::from_fn(n + 2, last + 1, constant, term)
            })
            .collect();
        // What serves every larger sigma: `[[2 w, -w - (1-b)/2], [., 1 - c]]` at both ends (E4).
        for share in self.moves.into_iter().flatten() {
            let constant = |i: usize, k: usize| match (i.min(k), i.max(k)) {
                (0, 1) => -0.5 * share,
                (1, 1) => 1.0 - given.unwrap_or(0.0),
                _ => 0.0,
            };
            let term = |variable: usize, i: usize, k: usize| match (i.min(k), i.max(k)) {
                (0, 0) if variable == w => 2.0,
                (0, 1) if variable == w => -1.0,
                (1, 1) if variable == last && given.is_none() => -1.0,
                _ => 0.0,
            };
            constraints.push(AffineMatrix::from_fn(2, last + 1, constant, term));
        }
        let mut cost = vec![0.0; last + 1];
        cost[last] = -1.0;
        let mut found = propose(&cost, &constraints).ok()?.x;
        let largest = found.pop()?;
        Some((found, largest))
    }
}
