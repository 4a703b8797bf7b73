//! Pi with a small factor of the exponential bound (derivation, 13.6), at a rate at which some Pi is known: a semidefinite program.
//!
//! The factor is the root of `(x_up dX^2 + e_up dE^2 + z_up dZ^2)/e_low`. (K) is linear in Pi and the Q, G, H of the derivatives together, so that Pi
//! is sought with a multiple l of those that are known, for a fixed e_low; Pi/l goes with the known ones.

use crate::semidefinite::propose;
use faer::Mat;
use sigmastar_decide::rates::matrix_loop::{KnownSlopes, MatrixLoop, Multipliers};
use sigmastar_matrix::AffineMatrix;
use sigmastar_matrix::symmetric::{triangle, unit_entry};

/// The largest order of Pi: beyond, the program takes longer than the rest of a claim.
const LARGEST_ORDER: usize = 16;

/// The parts of (x, e, zs), each with an upper bound.
const PARTS: usize = 3;

/// Pi with about the least factor for starts within these distances of x, e and zs; `known` is a Pi for a rate not below this one with its e_low, in
/// whose units the program is. `None` where the order is too large, and where nothing is found.
pub(super) fn least_factor(
    (of, slopes): (&MatrixLoop<f64>, &[KnownSlopes<f64>]),
    rate: f64,
    (known, e_low): (&Mat<f64>, f64),
    distances: [f64; PARTS],
) -> Option<Mat<f64>> {
    let program = Program::new(of, known)?;
    let mut constraints = of.ends().iter().map(|gain| program.falls(gain, rate, slopes)).collect::<Option<Vec<_>>>()?;
    constraints.extend([program.above(e_low), program.below(), program.positive()]);
    let found = propose(&program.cost(distances), &constraints).ok()?.x;
    program.pi(&found)
}

/// The variables are the entries of Pi in the units of the diagonal of the known one, then the upper bounds, each in the largest unit of its part,
/// and l.
struct Program<'p> {
    of: &'p MatrixLoop<f64>,
    known: Vec<Vec<f64>>,
    /// The roots of its diagonal.
    root: Vec<f64>,
    places: Vec<(usize, usize)>,
    /// The largest root of each part.
    largest: [f64; PARTS],
}

impl<'p> Program<'p> {
    fn new(of: &'p MatrixLoop<f64>, known: &Mat<f64>) -> Option<Program<'p>> {
        let order = of.order();
        let root: Vec<f64> = (0..order).map(|i| known[(i, i)].sqrt()).collect();
        if order > LARGEST_ORDER || !root.iter().all(|root| *root > 0.0) {
            return None;
        }
        let known = (0..order).map(|i| (0..order).map(|j| known[(i, j)]).collect()).collect();
        let places = triangle(order).collect();
        let mut program = Program { of, known, root, places, largest: [0.0; PARTS] };
        for i in 0..order {
            let largest = &mut program.largest[part(of.states, i)];
            *largest = largest.max(program.root[i]);
        }
        Some(program)
    }

    fn order(&self) -> usize {
        self.root.len()
    }

    /// The places of the upper bounds, and of l.
    fn upper(&self, part: usize) -> usize {
        self.places.len() + part
    }

    fn multiple(&self) -> usize {
        self.places.len() + PARTS
    }

    fn count(&self) -> usize {
        self.multiple() + 1
    }

    /// What a variable adds to an entry of Pi, in its units.
    fn entry(&self, variable: usize, i: usize, j: usize) -> f64 {
        self.places.get(variable).map_or(0.0, |place| unit_entry(*place, i, j))
    }

    /// K at one end of the input gain, in the units of its diagonal at the known Pi.
    fn falls(&self, gain: &f64, rate: f64, slopes: &[KnownSlopes<f64>]) -> Option<AffineMatrix<f64>> {
        let form =
            |pi: &[Vec<f64>], slopes: &[KnownSlopes<f64>]| self.of.form(gain, &Multipliers { rate: &rate, pi, slopes });
        let of_known = form(&self.known, slopes);
        let unit: Vec<f64> = of_known.iter().enumerate().map(|(i, row)| row[i].sqrt()).collect();
        if !unit.iter().all(|unit| *unit > 0.0) {
            return None;
        }
        let unknown: Vec<KnownSlopes<f64>> = slopes.iter().map(without).collect();
        let order = self.order();
        let of_variable = |variable: usize| {
            let entry = |i: usize, j: usize| self.entry(variable, i, j) * self.root[i] * self.root[j];
            let pi: Vec<Vec<f64>> = (0..order).map(|i| (0..order).map(|j| entry(i, j)).collect()).collect();
            form(&pi, if variable == self.multiple() { slopes } else { &unknown })
        };
        let forms: Vec<Vec<Vec<f64>>> = (0..self.count()).map(of_variable).collect();
        let term = |variable: usize, i: usize, j: usize| forms[variable][i.max(j)][i.min(j)] / (unit[i] * unit[j]);
        Some(AffineMatrix::from_fn(unit.len(), self.count(), |_, _| 0.0, term))
    }

    /// `Pi >= diag(0, e_low, 0)`.
    fn above(&self, e_low: f64) -> AffineMatrix<f64> {
        let e = self.of.states;
        let low = e_low / (self.root[e] * self.root[e]);
        let least = |i: usize, j: usize| if (i, j) == (e, e) { -low } else { 0.0 };
        AffineMatrix::from_fn(self.order(), self.count(), least, |variable, i, j| self.entry(variable, i, j))
    }

    /// `Pi <= diag(x_up I, e_up, z_up I)`.
    fn below(&self) -> AffineMatrix<f64> {
        let term = |variable: usize, i: usize, j: usize| {
            let part = part(self.of.states, i);
            let bound = if i == j && variable == self.upper(part) { self.largest[part] / self.root[i] } else { 0.0 };
            bound * bound - self.entry(variable, i, j)
        };
        AffineMatrix::from_fn(self.order(), self.count(), |_, _| 0.0, term)
    }

    /// x_up is not negative: without states nothing else holds it.
    fn positive(&self) -> AffineMatrix<f64> {
        AffineMatrix::from_fn(1, self.count(), |_, _| 0.0, |variable, _, _| f64::from(variable == self.upper(0)))
    }

    /// The square of the factor times e_low, over the largest of its coefficients.
    fn cost(&self, distances: [f64; PARTS]) -> Vec<f64> {
        let mut cost = vec![0.0; self.count()];
        for (part, distance) in distances.into_iter().enumerate() {
            let root = self.largest[part] * distance;
            cost[self.upper(part)] = root * root;
        }
        // What costs nothing is not bounded.
        let size = cost.iter().copied().fold(0.0, f64::max);
        let least = f64::EPSILON * size;
        (0..PARTS).for_each(|part| cost[self.upper(part)] = cost[self.upper(part)].max(least));
        cost.iter().map(|cost| cost / size).collect()
    }

    /// Pi/l of a solution.
    fn pi(&self, found: &[f64]) -> Option<Mat<f64>> {
        let multiple = found[self.multiple()];
        let mut pi = Mat::<f64>::zeros(self.order(), self.order());
        for ((i, j), value) in self.places.iter().zip(found) {
            let value = value * self.root[*i] * self.root[*j] / multiple;
            (pi[(*i, *j)], pi[(*j, *i)]) = (value, value);
        }
        (multiple > 0.0 && pi.as_ref().is_all_finite()).then_some(pi)
    }
}

/// The part of (x, e, zs) that an entry is in.
fn part(states: usize, i: usize) -> usize {
    usize::from(i >= states) + usize::from(i > states)
}

/// What is known where nothing is.
fn without(part: &KnownSlopes<f64>) -> KnownSlopes<f64> {
    let zero = |rows: &[Vec<f64>]| rows.iter().map(|row| vec![0.0; row.len()]).collect();
    KnownSlopes { columns: part.columns.clone(), q: zero(&part.q), g: zero(&part.g), h: zero(&part.h) }
}
