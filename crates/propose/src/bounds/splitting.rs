//! A splitting S of the matrix inequality (M) (derivation, 13.7), proposed by a semidefinite program over sampled points.

use super::place::{Place, Places};
use super::sampled_pairs::MatrixArguments;
use super::suprema::FloatSuprema;
use super::weights::{FloatWeights, Root};
use crate::semidefinite::propose;
use sigmastar_matrix::AffineMatrix;
use sigmastar_matrix::doubles::largest as largest_eigenvalue;
use sigmastar_matrix::doubles::{product, roots};

/// Points of either kind that a semidefinite program begins with, and that are added where S fails.
const POINTS: usize = 8;

/// How often points are added, and by what share S may fail at a point.
const ROUNDS: usize = 6;
const TOLERANCE: f64 = 1e-3;

/// The share of the threshold that is given for the distance of S from what it must not exceed.
const ROOM: f64 = 2e-3;

impl FloatSuprema {
    /// S that makes the threshold small; `F >= S` as far as a search sees. `None` where there is none.
    #[must_use]
    pub fn propose_splitting(&self, at: MatrixArguments, weights: FloatWeights) -> Option<Vec<Vec<f64>>> {
        let all = Places::Stride(1);
        let corners = self.corners(at, &all, weights, POINTS);
        let expected = self.threshold_of_pairs(at, &corners, weights);
        if !(expected.is_finite() && expected > 0.0) {
            return None;
        }
        let mut program = Program::new(expected);
        program.add(self, at, weights, [&corners.states, &corners.error]);
        let mut s = program.solve()?;
        for _ in 0..ROUNDS {
            let (Some(root), Ok(cholesky)) = (inverse_root(&s), Root::new(lower(&s))) else { return None };
            let of_states = self.largest_of_derivatives(at.states, &all, POINTS, |derivatives, matrix| {
                share(&root, &weights.of_states(derivatives, matrix))
            });
            let so_far = program.threshold;
            let of_error = self.largest_of_derivatives(at.error, &all, POINTS, |derivatives, _| {
                cholesky.threshold(&weights.of_error(derivatives, self.moves), &mut Vec::new()) / so_far
            });
            let beyond = |list: Vec<(f64, Place)>| -> Vec<Place> {
                list.into_iter().filter(|(value, _)| *value > 1.0 + TOLERANCE).map(|(_, place)| place).collect()
            };
            let (of_states, of_error) = (beyond(of_states), beyond(of_error));
            if of_states.is_empty() && of_error.is_empty() {
                break;
            }
            let [of_states, of_error] = [of_states, of_error].map(Places::listed);
            program.add(self, at, weights, [&of_states, &of_error]);
            s = program.solve()?;
        }
        let s = program.centred(ROOM)?;
        let root = inverse_root(&s)?;
        let need = self.refined_of_derivatives(at.states, |derivatives, matrix| {
            share(&root, &weights.of_states(derivatives, matrix))
        });
        let need = need.max(1.0);
        let fits = need.is_finite() && need > 0.0;
        fits.then(|| s.iter().map(|row| row.iter().map(|entry| entry / need).collect()).collect())
    }

    /// The least sigma for a given S, by a longer search.
    #[must_use]
    pub fn refined_threshold_with(&self, s: &[Vec<f64>], at: [f64; 2], weights: FloatWeights) -> Option<f64> {
        let root = Root::new(lower(s)).ok()?;
        let found = self.refined_of_derivatives(at, |derivatives, _| {
            root.threshold(&weights.of_error(derivatives, self.moves), &mut Vec::new())
        });
        (found.is_finite() && found > 0.0).then_some(found)
    }
}

/// The semidefinite program: S, and the least `2 sigma`.
struct Program {
    /// The matrices that S must not exceed, by rows.
    above: Vec<Vec<Vec<f64>>>,
    /// The columns beside S.
    columns: Vec<Vec<f64>>,
    /// What sigma is expected to be, and then is.
    threshold: f64,
}

impl Program {
    fn new(expected: f64) -> Program {
        Program { above: Vec::new(), columns: Vec::new(), threshold: expected }
    }

    fn add(&mut self, samples: &FloatSuprema, at: MatrixArguments, weights: FloatWeights, places: [&Places; 2]) {
        let above = samples.of_derivatives(at.states, places[0], |derivatives, matrix| {
            full(&weights.of_states(derivatives, matrix), derivatives.r.len() + 1)
        });
        self.above.extend(above);
        let columns = samples.of_derivatives(at.error, places[1], |derivatives, _| {
            weights.of_error(derivatives, samples.moves).at(self.threshold)
        });
        self.columns.extend(columns.into_iter().flatten());
    }

    /// S with the least threshold.
    fn solve(&mut self) -> Option<Vec<Vec<f64>>> {
        let (s, share) = self.solution(None)?;
        self.threshold *= share;
        (self.threshold > 0.0).then_some(s)
    }

    /// S that is far from what it must not exceed, with a threshold that is larger by this share.
    fn centred(&self, room: f64) -> Option<Vec<Vec<f64>>> {
        self.solution(Some(1.0 + room)).map(|(s, _)| s)
    }

    /// S, and the least sigma as a share of what it is expected to be; where that share is given, the distance of S from what it
    /// must not exceed instead, which is made large. All is scaled so that the diagonal of S and `2 sigma` are about 1.
    fn solution(&self, given: Option<f64>) -> Option<(Vec<Vec<f64>>, f64)> {
        let first = self.above.first()?;
        let order = first.len();
        let scale: Vec<f64> = (0..order).map(|i| first[i][i].sqrt().recip()).collect();
        let unit = (2.0 * self.threshold).sqrt().recip();
        let pairs: Vec<(usize, usize)> = (0..order).flat_map(|i| (i..order).map(move |j| (i, j))).collect();
        let is_entry = |variable: usize, i: usize, j: usize| f64::from(pairs.get(variable) == Some(&(i, j)));
        let above = self.above.iter().map(|matrix| {
            let constant = |i: usize, j: usize| matrix[i][j] * scale[i] * scale[j];
            let term = |variable: usize, i: usize, j: usize| match variable == pairs.len() {
                true if given.is_some() && i == j => -1.0,
                true => 0.0,
                false => -is_entry(variable, i, j),
            };
            AffineMatrix::from_fn(order, pairs.len() + 1, constant, term)
        });
        let beside = self.columns.iter().map(|column| {
            let constant = |i: usize, j: usize| match (i == order, j == order) {
                (true, true) => given.unwrap_or(0.0),
                (false, true) => column[i] * scale[i] * unit,
                _ => 0.0,
            };
            let term = |variable: usize, i: usize, j: usize| match (variable == pairs.len(), i == order && j == order) {
                (true, corner) => f64::from(corner && given.is_none()),
                (false, _) => is_entry(variable, i, j),
            };
            AffineMatrix::from_fn(order + 1, pairs.len() + 1, constant, term)
        });
        let constraints: Vec<AffineMatrix<f64>> = above.chain(beside).collect();
        let mut cost = vec![0.0; pairs.len() + 1];
        cost[pairs.len()] = if given.is_some() { -1.0 } else { 1.0 };
        let found = propose(&cost, &constraints).ok()?.x;
        let mut s = vec![vec![0.0; order]; order];
        for ((i, j), value) in pairs.iter().zip(&found) {
            let value = value / (scale[*i] * scale[*j]);
            (s[*i][*j], s[*j][*i]) = (value, value);
        }
        Some((s, found[pairs.len()]))
    }
}

/// The lower triangle of a symmetric matrix, by rows.
fn lower(matrix: &[Vec<f64>]) -> Vec<f64> {
    matrix.iter().enumerate().flat_map(|(i, row)| row[..=i].iter().copied()).collect()
}

/// A symmetric matrix from its lower triangle.
fn full(lower: &[f64], order: usize) -> Vec<Vec<f64>> {
    let at = |i: usize, j: usize| if j <= i { lower[i * (i + 1) / 2 + j] } else { lower[j * (j + 1) / 2 + i] };
    (0..order).map(|i| (0..order).map(|j| at(i, j)).collect()).collect()
}

/// The inverse of the symmetric root; `None` where the matrix is not positive definite.
fn inverse_root(s: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let [_, inverse] = roots(s);
    inverse.iter().flatten().all(|entry| entry.is_finite()).then_some(inverse)
}

/// The largest share of S that the matrix with this lower triangle is not below, as its reciprocal; infinite where there is none.
fn share(inverse_root: &[Vec<f64>], of: &[f64]) -> f64 {
    let matrix = full(of, inverse_root.len());
    let mut form = product(inverse_root, &product(&matrix, inverse_root));
    form.iter_mut().flatten().for_each(|entry| *entry = -*entry);
    let least = -largest_eigenvalue(form);
    if least > 0.0 { least.recip() } else { f64::INFINITY }
}
