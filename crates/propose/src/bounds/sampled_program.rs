//! The free numbers of the inequality of existence of the regulator at samples (derivation, 13.7, (E) at samples), proposed by
//! semidefinite programs over sampled points.

use super::place::{Place, Places};
use super::pointwise::{Derivatives, MatrixAt, Slopes};
use super::sampled_point::SampledEnergy;
use super::suprema::FloatSuprema;
use crate::semidefinite::propose;
use sigmastar_lang::spec::Bound;
use sigmastar_matrix::symmetric::{triangle, unit_entry};
use sigmastar_matrix::{AffineMatrix, Symmetric};
use sigmastar_theory::derivation::sampled_form::{AtPoint, Corner, FormNumbers, Less, LoopNumbers, form};

/// Points that are added where what was found holds least, and how often.
const POINTS: usize = 4;
const ROUNDS: usize = 4;

/// By what share gamma may be larger than the least one, for how definite the rest is.
const ROOM: f64 = 0.1;

/// By what share it may be larger at a point that was not looked at.
const TOLERANCE: f64 = 1e-2;

/// The share of what the rest is definite by that is c_x, and that of what y has that is c_y.
const OF_STATES: f64 = 0.8;
const OF_Y: f64 = 0.97;

/// The numbers that F is linear in.
#[derive(Clone, Default)]
struct Variables {
    /// The place in the triangle of P that is 1.
    p: Option<(usize, usize)>,
    weight: f64,
    k_p: f64,
    lambda: f64,
    c_e: f64,
    c_y: f64,
    gamma: f64,
    /// What the rest is definite by, beside e(s) and y.
    room: f64,
}

/// Units in which everything is about 1.
struct Units {
    /// Of x, where e has 1.
    x: f64,
    /// Of G and of w.
    within: f64,
    sigma: f64,
}

struct Program<'n> {
    points: Vec<Slopes>,
    of: &'n LoopNumbers<f64>,
    /// c_e in units of sigma^2 c_y.
    share: f64,
}

impl FloatSuprema {
    /// P, k_p, lambda and the weights with a small gamma on `G(X, E)`, where c_e is `share` times sigma^2 c_y; `None` where there are
    /// none.
    #[must_use]
    pub fn propose_sampled_energy(&self, at: [f64; 2], of: &LoopNumbers<f64>, share: f64) -> Option<SampledEnergy> {
        let all = Places::Stride(1);
        let mut program = Program { points: Vec::new(), of, share };
        let first = self.where_largest(at, &all, [Bound::Rate, Bound::Qx, Bound::Fe, Bound::QeMax]);
        program.add(self, at, first);
        let mut found = program.solve()?;
        for _ in 0..ROUNDS {
            let expected = program.gamma(&found) * (1.0 + TOLERANCE);
            let gamma = |derivatives: &Derivatives<'_>, _: &MatrixAt| found.gamma(&Slopes::from(derivatives), of);
            let worst = self.largest_of_derivatives(at, &all, POINTS, gamma);
            let beyond: Vec<Place> =
                worst.into_iter().filter(|(gamma, _)| *gamma > expected).map(|(_, place)| place).collect();
            if beyond.is_empty() {
                break;
            }
            program.add(self, at, beyond);
            found = program.solve()?;
        }
        Some(found)
    }
}

impl Program<'_> {
    fn add(&mut self, samples: &FloatSuprema, at: [f64; 2], places: Vec<Place>) {
        let places = Places::listed(places);
        self.points.extend(samples.of_derivatives(at, &places, |derivatives, _| Slopes::from(derivatives)));
    }

    /// The least gamma at the points.
    fn gamma(&self, energy: &SampledEnergy) -> f64 {
        self.points.iter().map(|point| energy.gamma(point, self.of)).fold(0.0, f64::max)
    }

    fn units(&self) -> Units {
        let sigma = self.of.sigma;
        Units { x: Slopes::unit(&self.points, sigma), within: (sigma * self.of.across).sqrt(), sigma }
    }

    fn solve(&self) -> Option<SampledEnergy> {
        let units = self.units();
        let n = self.points.first()?.r.len();
        let mut of_f: Vec<Variables> =
            triangle(n).map(|place| Variables { p: Some(place), ..Variables::default() }).collect();
        let of_p = of_f.len();
        of_f.push(Variables { weight: 1.0, ..Variables::default() });
        of_f.push(Variables { k_p: 1.0, ..Variables::default() });
        of_f.push(Variables { lambda: 1.0, ..Variables::default() });
        let fixed = Variables { c_y: 1.0, c_e: self.share, ..Variables::default() };
        let gamma = Variables { gamma: 1.0, ..Variables::default() };
        let (_, least) = self.solution(&units, &fixed, &of_f, &gamma, 1.0)?;
        let least = (least > 0.0).then_some(least)?;
        let fixed = Variables { gamma: least * (1.0 + ROOM), ..fixed };
        let room = Variables { room: 1.0, ..Variables::default() };
        let (values, room) = self.solution(&units, &fixed, &of_f, &room, -1.0)?;
        let [weight, k_p, lambda] = [0, 1, 2].map(|k| values[of_p + k]);
        if [weight, k_p, lambda, room].iter().any(|value| *value <= 0.0) {
            return None;
        }
        // The weight of e^2 becomes 1.
        let Units { x, within, sigma } = units;
        Some(SampledEnergy {
            p: Symmetric::from_entries(n, &values).map(|_, _, value| value / (weight * x * x)).rows(),
            k_p: k_p / (weight * sigma),
            lambda: lambda * sigma / (weight * within * within),
            c_x: OF_STATES * room * sigma / (weight * x * x),
            c_e: self.share * sigma / weight,
            c_y: OF_Y / (weight * sigma),
        })
    }

    /// The variables of F, and the last one, of which so much is made small.
    fn solution(
        &self,
        units: &Units,
        fixed: &Variables,
        of_f: &[Variables],
        last: &Variables,
        cost_of_last: f64,
    ) -> Option<(Vec<f64>, f64)> {
        let order = self.points.first()?.r.len() + 5;
        let at_all_ends =
            self.points.iter().flat_map(|point| self.of.corners(false).map(move |corner| (point, corner)));
        let constraints: Vec<AffineMatrix<f64>> = at_all_ends
            .map(|(point, corner)| {
                let matrix = |variables: &Variables| self.matrix(units, variables, point, &corner);
                let constant = matrix(fixed);
                let terms: Vec<Vec<Vec<f64>>> = of_f.iter().chain([last]).map(matrix).collect();
                let entry = |matrix: &[Vec<f64>], i: usize, k: usize| matrix[i.min(k)][i.max(k)];
                AffineMatrix::from_fn(
                    order,
                    terms.len(),
                    |i, k| entry(&constant, i, k),
                    |variable, i, k| entry(&terms[variable], i, k),
                )
            })
            .collect();
        let mut cost = vec![0.0; of_f.len() + 1];
        cost[of_f.len()] = cost_of_last;
        let mut found = propose(&cost, &constraints).ok()?.x;
        let last = found.pop()?;
        Some((found, last))
    }

    /// F in these units, the upper triangle: linear in the variables.
    fn matrix(&self, units: &Units, variables: &Variables, point: &Slopes, corner: &Corner<'_, f64>) -> Vec<Vec<f64>> {
        let Units { x, within, sigma } = *units;
        let Variables { p, weight, k_p, lambda, c_e, c_y, gamma, room } = *variables;
        let n = point.r.len();
        let parts = point.with(|i, k| p.map_or(0.0, |place| unit_entry(place, i, k) / (x * x)), 0.0);
        let numbers = FormNumbers {
            of: self.of,
            weight,
            k_p: k_p / sigma,
            lambda: lambda * sigma / (within * within),
            less: Less { e_k: 0.0, e: c_e * sigma, y: c_y / sigma },
            gamma: Some(gamma / sigma),
            past: None,
        };
        let unit = |i: usize| match i {
            _ if i < n => x,
            _ if i == n => 1.0,
            _ if i == n + 2 || i == n + 3 => within,
            _ => sigma,
        };
        let mut matrix = vec![vec![0.0; n + 5]; n + 5];
        for (i, k, value) in form(&AtPoint::default(), numbers, corner, parts) {
            matrix[i][k] = value * unit(i) * unit(k) / sigma;
        }
        for i in (0..=n).chain([n + 2, n + 3]) {
            matrix[i][i] -= room;
        }
        matrix
    }
}
