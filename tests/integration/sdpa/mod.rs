//! Semidefinite programs in SDPA's sparse format, and rigorous bounds of their optima.
//!
//! The problem is: minimise `c'x` subject to `X = x_1 F_1 + ... + x_m F_m - F_0 >= 0`; its dual: maximise `tr(F_0 Y)` subject to
//! `tr(F_k Y) = c_k`, `Y >= 0`. Matrices have blocks.

use faer::Mat;
use rug::Rational;
use sigmastar::enclosure::Truth;
use sigmastar::matrix::ScaledMatrix;
use sigmastar::matrix::{AffineMatrix, Symmetric};
use sigmastar::semidefinite::{SolverFailure, SolverPoint, margin, propose};

/// A semidefinite program.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// c.
    pub cost: Vec<f64>,
    /// The orders of the blocks; a negative one is that of a diagonal block.
    pub blocks: Vec<i64>,
    /// F_0, F_1, ...: per matrix, the nonzero entries (block, row, column, value) of the upper triangles, from 0.
    pub matrices: Vec<Vec<(usize, usize, usize, f64)>>,
}

/// Reads a problem in SDPA's sparse format: comments, m, the number of blocks, their sizes, c, and lines "matrix block row
/// column value", counted from 1. Commas, braces and parentheses count as white space.
pub fn read(text: &str) -> Result<Problem, String> {
    let clean = |line: &str| line.replace([',', '{', '}', '(', ')'], " ");
    let lines: Vec<String> = text.lines().filter(|line| !line.starts_with(['"', '*'])).map(clean).collect();
    let mut lines = lines.iter().filter(|line| !line.trim().is_empty());
    let mut next = |what: &str| lines.next().ok_or_else(|| format!("the line with {what} is missing"));
    let first = |line: &String, what: &str| {
        let word = line.split_whitespace().next().unwrap_or_default();
        word.parse::<usize>().map_err(|_| format!("{what}: `{word}` is not a count"))
    };
    let m = first(next("m")?, "m")?;
    let count = first(next("the number of blocks")?, "the number of blocks")?;
    let sizes = next("the block sizes")?.split_whitespace().take(count).map(str::parse::<i64>);
    let blocks = sizes.collect::<Result<Vec<_>, _>>().map_err(|error| format!("block sizes: {error}"))?;
    let cost = next("c")?.split_whitespace().take(m).map(str::parse::<f64>).collect::<Result<Vec<_>, _>>();
    let cost = cost.map_err(|error| format!("c: {error}"))?;
    if blocks.len() != count || cost.len() != m || blocks.contains(&0) {
        return Err("block sizes or c do not fit their counts".to_owned());
    }
    let mut matrices = vec![Vec::new(); m + 1];
    for line in lines {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [indices @ .., value] = &words[..] else { continue };
        let indices: Option<Vec<usize>> = indices.iter().map(|word| word.parse().ok()).collect();
        let (Some([matrix, block, row, column]), Ok(value)) = (indices.as_deref(), value.parse::<f64>()) else {
            return Err(format!("not an entry: `{line}`"));
        };
        let order = blocks.get(block.wrapping_sub(1)).map_or(0, |size| size.unsigned_abs() as usize);
        let diagonal = blocks.get(block.wrapping_sub(1)).is_some_and(|size| *size < 0);
        let inside = |index: usize| (1..=order).contains(&index);
        if *matrix > m || !inside(*row) || !inside(*column) || (diagonal && row != column) || !value.is_finite() {
            return Err(format!("an entry outside its matrix: `{line}`"));
        }
        let (row, column) = (*row.min(column), *row.max(column));
        matrices[*matrix].push((block - 1, row - 1, column - 1, value));
    }
    Ok(Problem { cost, blocks, matrices })
}

/// Writes a problem in the format; the shortest digits that read back to the same doubles.
pub fn write(problem: &Problem) -> String {
    let words = |values: &[String]| values.join(" ");
    let cost: Vec<String> = problem.cost.iter().map(|c| format!("{c:e}")).collect();
    let blocks: Vec<String> = problem.blocks.iter().map(i64::to_string).collect();
    let mut text = format!("{}\n{}\n{}\n{}\n", cost.len(), blocks.len(), words(&blocks), words(&cost));
    for (k, entries) in problem.matrices.iter().enumerate() {
        for (block, row, column, value) in entries {
            text += &format!("{k} {} {} {} {value:e}\n", block + 1, row + 1, column + 1);
        }
    }
    text
}

/// A sum of products of doubles to twice the digits (Ogita, Rump and Oishi's Dot2), with a bound of its error.
#[derive(Clone, Copy, Debug, Default)]
struct Dot {
    sum: f64,
    rest: f64,
    size: f64,
    terms: f64,
}

impl Dot {
    fn add(&mut self, a: f64, b: f64) {
        let product = a * b;
        let product_rest = a.mul_add(b, -product);
        let sum = self.sum + product;
        let back = sum - self.sum;
        self.rest += ((self.sum - (sum - back)) + (product - back)) + product_rest;
        (self.sum, self.size, self.terms) = (sum, self.size + product.abs(), self.terms + 1.0);
    }

    fn value(&self) -> f64 {
        self.sum + self.rest
    }

    /// `u |value| + (n u)^2 sum |a b|` with room for its own rounding; numbers here are far from under- and overflow.
    fn error(&self) -> f64 {
        let unit = f64::EPSILON;
        up(unit * self.value().abs() + (self.terms * unit).powi(2) * 4.0 * self.size + f64::MIN_POSITIVE)
    }
}

/// A sum or product of nonnegative doubles with room for its rounding (fewer than 10^5 operations).
fn up(value: f64) -> f64 {
    value * (1.0 + 1e-10)
}

/// Rigorous bounds of the optimum.
#[derive(Clone, Debug)]
pub struct Bounds {
    /// No feasible x has a smaller cost.
    pub lower: Rational,
    /// The cost of a feasible x.
    pub upper: Rational,
}

impl Problem {
    /// The blocks as constraints for the solver; a diagonal block is one constraint of order 1 for each entry.
    fn constraints(&self, margin: f64) -> Vec<AffineMatrix<f64>> {
        self.pieces()
            .into_iter()
            .map(|(block, order, offset)| {
                let dense: Vec<Symmetric<f64>> = (0..self.matrices.len())
                    .map(|k| {
                        let piece = self.piece(k, block, order, offset);
                        Symmetric::from_fn(order, |i, j| if k == 0 { -piece[(i, j)] } else { piece[(i, j)] })
                    })
                    .collect();
                let terms = self.matrices.len() - 1;
                AffineMatrix::from_fn(order, terms, |i, j| *dense[0].at(i, j), |k, i, j| *dense[k + 1].at(i, j))
                    .with_margin(margin)
            })
            .collect()
    }

    /// (block, order, first row) of each constraint.
    fn pieces(&self) -> Vec<(usize, usize, usize)> {
        let one = |(block, size): (usize, &i64)| match *size {
            size if size > 0 => vec![(block, size as usize, 0)],
            size => (0..-size as usize).map(|row| (block, 1, row)).collect(),
        };
        self.blocks.iter().enumerate().flat_map(one).collect()
    }

    fn piece(&self, k: usize, block: usize, order: usize, offset: usize) -> Mat<f64> {
        let mut dense = Mat::zeros(order, order);
        for (own, row, column, value) in &self.matrices[k] {
            if *own == block && (offset..offset + order).contains(row) {
                let (i, j) = (row - offset, column.wrapping_sub(offset));
                if j < order {
                    dense[(i, j)] += value;
                    if i != j {
                        dense[(j, i)] += value;
                    }
                }
            }
        }
        dense
    }

    /// The solver's answer to the problem with margins: `X >= eps I`, and the costs `c_k - eps tr(F_k)`, whose dual Y gives
    /// `Y + eps I` with `tr(F_k (Y + eps I)) = c_k`. Both then survive rounding.
    pub fn solve(&self) -> Result<SolverPoint, SolverFailure> {
        let eps = self.margin();
        propose(&self.shifted_cost(eps), &self.constraints(eps))
    }

    fn margin(&self) -> f64 {
        let largest = self.blocks.iter().map(|size| size.unsigned_abs() as usize).max().unwrap_or(1);
        // The sizes of the data of both problems, which the solver's tolerance is relative to.
        let constant = self.matrices[0].iter().map(|entry| entry.3 * entry.3).sum::<f64>().sqrt();
        let cost = self.cost.iter().fold(0.0, |size: f64, c| size.max(c.abs()));
        margin(constant.max(cost), largest)
    }

    fn shifted_cost(&self, eps: f64) -> Vec<f64> {
        let trace = |k: usize| self.matrices[k].iter().filter(|e| e.1 == e.2).map(|e| e.3).sum::<f64>();
        self.cost.iter().enumerate().map(|(k, c)| c - eps * trace(k + 1)).collect()
    }

    /// Bounds of the optimum that follow from a candidate, or `None` if its points cannot be proved feasible.
    ///
    /// Upper: x is taken exactly, and X proved positive definite. Lower: the linear equations of the dual have a solution
    /// within computed errors of the candidate's Y (a least-squares correction in floating point, and for what remains
    /// `|G^-1 d| <= |d|/lambda` with a proved lower bound lambda of the Gram matrix G); every Y within them is proved
    /// positive definite, and the least `tr(F_0 Y)` among them is a lower bound of every feasible cost.
    pub fn verify(&self, candidate: &SolverPoint) -> Option<Bounds> {
        let pieces = self.pieces();
        for (block, order, offset) in &pieces {
            let mut sums = vec![Dot::default(); order * order];
            for k in 0..self.matrices.len() {
                let factor = if k == 0 { -1.0 } else { candidate.x[k - 1] };
                for (own, row, column, value) in &self.matrices[k] {
                    if own == block && (*offset..offset + order).contains(row) && *column < offset + order {
                        sums[(column - offset) * order + (row - offset)].add(factor, *value);
                    }
                }
            }
            // Rows do not exceed columns in the data, so these are the lower triangle's entries.
            let at = |i: usize, j: usize| &sums[i.max(j) * order + i.min(j)];
            let allowance: Vec<f64> = (0..*order).map(|i| up((0..*order).map(|j| at(i, j).error()).sum())).collect();
            let matrix = ScaledMatrix::from_doubles(*order, |i, j| at(i, j).value(), &allowance)?;
            if matrix.is_positive_definite() != Truth::True {
                return None;
            }
        }
        let mut upper = Rational::new();
        for (c, x) in self.cost.iter().zip(&candidate.x) {
            upper += Rational::from_f64(*c)? * Rational::from_f64(*x)?;
        }
        Some(Bounds { lower: self.lower_bound(candidate, &pieces)?, upper })
    }

    fn lower_bound(&self, candidate: &SolverPoint, pieces: &[(usize, usize, usize)]) -> Option<Rational> {
        let eps = self.margin();
        let m = self.cost.len();
        let mut duals: Vec<Mat<f64>> = candidate
            .duals
            .iter()
            .map(|dual| Mat::from_fn(dual.order(), dual.order(), |i, j| dual.at(i, j) + if i == j { eps } else { 0.0 }))
            .collect();
        let dense: Vec<Vec<Mat<f64>>> =
            (0..=m).map(|k| pieces.iter().map(|(b, n, o)| self.piece(k, *b, *n, *o)).collect()).collect();
        let inner = |a: &[Mat<f64>], b: &[Mat<f64>]| -> f64 {
            let one = |(a, b): (&Mat<f64>, &Mat<f64>)| -> f64 {
                (0..a.ncols()).map(|j| (0..a.nrows()).map(|i| a[(i, j)] * b[(i, j)]).sum::<f64>()).sum()
            };
            a.iter().zip(b).map(one).sum()
        };
        // The Gram matrix in floating point, its factor, and a proved lower bound of the exact one.
        let gram = Mat::from_fn(m, m, |i, j| inner(&dense[i.max(j) + 1], &dense[i.min(j) + 1]));
        let factor = faer::linalg::solvers::Llt::new(gram.as_ref(), faer::Side::Lower).ok()?;
        let residuals = |duals: &[Mat<f64>]| -> Option<Vec<Dot>> {
            (0..m)
                .map(|k| {
                    let mut rest = Dot::default();
                    rest.add(self.cost[k], 1.0);
                    for (block, row, column, value) in &self.matrices[k + 1] {
                        let (piece, offset) = locate(pieces, *block, *row)?;
                        let entry = duals[piece][(row - offset, column - offset)];
                        rest.add(if row == column { -value } else { -2.0 * value }, entry);
                    }
                    Some(rest)
                })
                .collect()
        };
        for _ in 0..2 {
            let rest = residuals(&duals)?;
            let mut step = Mat::from_fn(m, 1, |k, _| rest[k].value());
            use faer::linalg::solvers::Solve;
            factor.solve_in_place(step.as_mut());
            for (piece, dual) in duals.iter_mut().enumerate() {
                let n = dual.nrows();
                for i in 0..n {
                    for j in 0..=i {
                        let entry =
                            dual[(i, j)] + (0..m).map(|k| step[(k, 0)] * dense[k + 1][piece][(i, j)]).sum::<f64>();
                        dual[(i, j)] = entry;
                        dual[(j, i)] = entry;
                    }
                }
            }
        }
        let rest = residuals(&duals)?;
        let size = up(rest.iter().map(|r| (r.value().abs() + r.error()).powi(2)).sum::<f64>()).sqrt();
        // Sums of m order^2 products of doubles: relative errors of 2^-53 each, of magnitudes below the Cauchy-Schwarz bound.
        let terms: usize = pieces.iter().map(|piece| piece.1 * piece.1).sum();
        let largest = (0..m).map(|k| gram[(k, k)]).fold(0.0, f64::max);
        let error = 4.0 * terms as f64 * f64::EPSILON * largest * m as f64;
        let least = (0..40).map(|halvings| largest * 0.5f64.powi(halvings)).find(|least| {
            // The subtraction from the diagonal rounds once.
            let allowance = vec![error + f64::EPSILON * largest; m];
            let shifted = |i: usize, j: usize| if i == j { gram[(i, j)] - least } else { gram[(i, j)] };
            let matrix = ScaledMatrix::from_doubles(m, shifted, &allowance);
            matrix.is_some_and(|matrix| matrix.is_positive_definite() == Truth::True)
        })?;
        let correction = up(size / least);
        let absolute: Vec<Mat<f64>> = (0..pieces.len())
            .map(|piece| {
                let n = duals[piece].nrows();
                Mat::from_fn(n, n, |i, j| up(correction * (1..=m).map(|k| dense[k][piece][(i, j)].abs()).sum::<f64>()))
            })
            .collect();
        let mut lower = Rational::new();
        for (piece, dual) in duals.iter().enumerate() {
            let n = dual.nrows();
            // |sum_k d_k F_k| <= |d| sum_k |F_k|, entry by entry.
            let allowance: Vec<f64> = (0..n).map(|i| up((0..n).map(|j| absolute[piece][(i, j)]).sum())).collect();
            let matrix = ScaledMatrix::from_doubles(n, |i, j| dual[(i, j)], &allowance)?;
            if matrix.is_positive_definite() != Truth::True {
                return None;
            }
        }
        for (block, row, column, value) in &self.matrices[0] {
            let (piece, offset) = locate(pieces, *block, *row)?;
            let (i, j) = (row - offset, column - offset);
            let value = Rational::from_f64(*value)?;
            let times = if i == j { 1u32 } else { 2 };
            lower += &value * Rational::from_f64(duals[piece][(i, j)])? * times;
            lower -= value.abs() * Rational::from_f64(absolute[piece][(i, j)])? * times;
        }
        Some(lower)
    }
}

/// The piece that holds a row of a block, and its first row.
fn locate(pieces: &[(usize, usize, usize)], block: usize, row: usize) -> Option<(usize, usize)> {
    pieces
        .iter()
        .position(|(own, order, offset)| *own == block && (*offset..offset + order).contains(&row))
        .map(|piece| (piece, pieces[piece].2))
}

/// Doubles in [-1, 1) from a linear congruence: the same on every machine.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / 2f64.powi(52) - 1.0
    }
}

/// A random strictly feasible problem of the given order and number of variables, and its optimum up to rounding.
///
/// `X = Q diag(lambda, 0) Q'` and `Y = Q diag(0, eta) Q'` are complementary, so with `F_0 = sum x_k F_k - X` and
/// `c_k = tr(F_k Y)` they are optimal and the optimum is `c'x`. F_1 = I makes the primal strictly feasible; the other F_k are
/// orthogonal to W = V - Y for a V > 0 of the same trace, so `tr(F_k V) = c_k` makes the dual strictly feasible.
pub fn random(order: usize, variables: usize, seed: u64) -> (Problem, f64) {
    let mut next = numbers(seed);
    let mut symmetric = |n: usize| {
        let random = Mat::from_fn(n, n, |_, _| next());
        Mat::from_fn(n, n, |i, j| (random[(i, j)] + random[(j, i)]) / 2.0)
    };
    let q = symmetric(order).qr().compute_Q();
    let rank = order.div_ceil(2);
    let conjugate = |values: &dyn Fn(usize) -> f64| {
        let product = &Mat::from_fn(order, order, |i, j| q[(i, j)] * values(j)) * q.transpose();
        Mat::from_fn(order, order, |i, j| (product[(i, j)] + product[(j, i)]) / 2.0)
    };
    let spread = |j: usize| 1.0 + (j % 5) as f64 / 4.0;
    let slack = conjugate(&|j| if j < rank { spread(j) } else { 0.0 });
    let dual = conjugate(&|j| if j < rank { 0.0 } else { spread(j) });
    let trace: f64 = (0..order).map(|i| dual[(i, i)]).sum();
    let interior = conjugate(&|_| trace / order as f64);
    let w = &interior - &dual;
    let inner = |a: &Mat<f64>, b: &Mat<f64>| -> f64 {
        (0..order).map(|i| (0..order).map(|j| a[(i, j)] * b[(i, j)]).sum::<f64>()).sum()
    };
    let mut matrices = vec![Mat::from_fn(order, order, |i, j| f64::from(u8::from(i == j)))];
    for _ in 1..variables {
        let f = symmetric(order);
        let share = inner(&f, &w) / inner(&w, &w);
        matrices.push(Mat::from_fn(order, order, |i, j| f[(i, j)] - share * w[(i, j)]));
    }
    let x: Vec<f64> = (0..variables).map(|_| next()).collect();
    let constant = Mat::from_fn(order, order, |i, j| {
        matrices.iter().zip(&x).map(|(f, x)| x * f[(i, j)]).sum::<f64>() - slack[(i, j)]
    });
    let cost: Vec<f64> = matrices.iter().map(|f| inner(f, &dual)).collect();
    let optimum = cost.iter().zip(&x).map(|(c, x)| c * x).sum();
    let entries = |f: &Mat<f64>| {
        (0..order)
            .flat_map(|i| (i..order).map(move |j| (i, j)))
            .map(|(i, j)| (0, i, j, f[(i, j)]))
            .filter(|e| e.3 != 0.0)
            .collect()
    };
    let matrices = std::iter::once(&constant).chain(&matrices).map(entries).collect();
    (Problem { cost, blocks: vec![order as i64], matrices }, optimum)
}
