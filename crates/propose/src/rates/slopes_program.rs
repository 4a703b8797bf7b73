//! What is to be known of the first derivatives together so that the loop decays fast: Q, G and H of (K) and (D) (derivation, 13.6),
//! proposed by semidefinite programs over sampled derivatives. Nothing rests on them.

use crate::bounds::{FloatSlopes, FloatSuprema};
use crate::semidefinite::propose;
use faer::linalg::solvers::{DenseSolveCore, Llt};
use faer::{Mat, Side};
use sigmastar_decide::rates::matrix_loop::{KnownSlopes, MatrixLoop, Multipliers};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_matrix::{AffineMatrix, Symmetric};
use sigmastar_theory::evidence::Part;
use std::ops::Range;

/// Points that are added where what was found does not hold, and how often.
const POINTS: usize = 6;
const ROUNDS: usize = 4;

/// The margin from which on a program has a solution.
const SOLVED: f64 = 1e-7;

/// The share of the margin that is left at points that a program did not see.
const LEFT: f64 = 0.1;

/// The shares of the rate of the slowest loop with one of the derivatives between which the largest one is sought, the share that is
/// tried first, and the steps.
const SHARES: [f64; 2] = [0.01, 0.95];
const HALVED: usize = 5;

/// The shares of the largest rate at which balls are taken: the program at that rate itself has no room.
const TAKEN: [f64; 4] = [0.95, 0.8, 0.5, 0.2];

/// The columns of D that are known together, and what is sampled of them.
struct SampledPart {
    part: Part,
    columns: Range<usize>,
    /// X + r and E of the box.
    at: [f64; 2],
    /// Extreme ones, and those that programs needed.
    points: Vec<Vec<Vec<f64>>>,
}

/// Sampled derivatives: all of them on one box, or the columns of x and of e on boxes of their own.
pub struct SampledSlopes<'s> {
    samples: &'s FloatSuprema,
    states: usize,
    parts: Vec<SampledPart>,
    /// The unit of x in that of e, and the largest norm of the derivatives with it, in 1/time.
    length: f64,
    norm: f64,
    /// The unit of time of a program.
    time: f64,
}

/// What a program finds: the multipliers of each part, and the margin.
struct Solution {
    slopes: Vec<KnownSlopes<f64>>,
    margin: f64,
}

impl<'s> SampledSlopes<'s> {
    /// Of a plant with so many states: each part of D for its X + r, E.
    #[must_use]
    pub fn new(samples: &'s FloatSuprema, states: usize, parts: &[(Part, [f64; 2])]) -> SampledSlopes<'s> {
        let sampled = |(part, at): &(Part, [f64; 2])| {
            let points = samples.derivatives_at(*part, *at, &samples.extreme_places(*at));
            SampledPart { part: *part, columns: part.columns(states), at: *at, points }
        };
        let parts = parts.iter().map(sampled).collect();
        let mut found = SampledSlopes { samples, states, parts, length: 1.0, norm: 0.0, time: 1.0 };
        let g = found.largest(|i, j| i < states && j == states);
        let r = found.largest(|i, j| i == states && j < states);
        found.length = if g > 0.0 && r > 0.0 { (g / r).sqrt() } else { 1.0 };
        found.norm = found.largest(|_, _| true);
        found
    }

    /// The largest root of the squares of these entries of D at a point, in the units.
    fn largest(&self, counts: impl Fn(usize, usize) -> bool) -> f64 {
        let of = |part: &SampledPart| {
            let square = |d: &Vec<Vec<f64>>| -> f64 {
                let scaled = self.scaled(&part.columns, d);
                let entries = scaled
                    .iter()
                    .enumerate()
                    .flat_map(|(i, row)| row.iter().enumerate().map(move |(j, entry)| (i, j, entry)));
                entries.filter(|(i, j, _)| counts(*i, part.columns.start + j)).map(|(_, _, entry)| entry * entry).sum()
            };
            part.points.iter().map(square).fold(0.0, f64::max)
        };
        self.parts.iter().map(of).sum::<f64>().sqrt()
    }

    /// Columns of D in the units.
    fn scaled(&self, columns: &Range<usize>, d: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let row = |(i, row): (usize, &Vec<f64>)| {
            row.iter().zip(columns.clone()).map(|(entry, j)| entry * self.time * self.unit(j) / self.unit(i)).collect()
        };
        d.iter().enumerate().map(row).collect()
    }

    fn unit(&self, i: usize) -> f64 {
        if i < self.states { self.length } else { 1.0 }
    }

    /// The rate of the slowest loop with one of the derivatives of each part.
    fn slowest(&self, of: &MatrixLoop<f64>) -> f64 {
        let whole = |mut all: Vec<Vec<Vec<f64>>>, part: &SampledPart| {
            all = all
                .iter()
                .flat_map(|left| {
                    part.points.iter().map(|right| left.iter().zip(right).map(|(a, b)| [&a[..], b].concat()).collect())
                })
                .collect();
            all
        };
        let all = self.parts.iter().fold(vec![vec![Vec::new(); self.states + 1]], whole);
        all.iter().filter_map(|d| decay(of, d)).fold(f64::INFINITY, f64::min)
    }

    /// Balls that let this loop decay at a large rate, and at smaller ones; one for each part.
    #[must_use]
    pub fn propose(&mut self, of: &MatrixLoop<Enclosure>) -> Vec<Vec<FloatSlopes>> {
        let slowest = self.slowest(&of.doubles(1.0));
        if !(slowest > 0.0 && slowest.is_finite()) {
            return Vec::new();
        }
        // Between the slowest mode and the derivatives: the margins of a program are the larger so.
        self.time = (slowest * self.norm.max(slowest)).sqrt().recip();
        let (of, slowest) = (of.doubles(self.time), slowest * self.time);
        let [mut low, mut high] = SHARES.map(|share| share * slowest);
        if self.solve(&of, high).is_some() {
            low = high;
        } else if self.solve(&of, low).is_some() {
            for _ in 0..HALVED {
                let middle = (low * high).sqrt();
                if self.solve(&of, middle).is_some() { low = middle } else { high = middle }
            }
        } else {
            return Vec::new();
        }
        let found: Vec<Solution> = TAKEN.iter().filter_map(|share| self.solve(&of, share * low)).collect();
        let balls = |found: &Solution| {
            self.parts.iter().zip(&found.slopes).map(|(part, slopes)| self.ball(part.part, slopes)).collect()
        };
        found.iter().filter_map(balls).collect()
    }

    /// A solution at a rate, once the points are added where it does not hold.
    fn solve(&mut self, of: &MatrixLoop<f64>, rate: f64) -> Option<Solution> {
        let mut found = self.program(of, rate)?;
        for _ in 0..ROUNDS {
            let beyond = |(part, slopes): (&SampledPart, &KnownSlopes<f64>)| {
                let lack = |d: &[Vec<f64>]| lack(&self.scaled(&part.columns, d), slopes, found.margin);
                let worst = self.samples.places_beyond(part.part, part.at, POINTS, lack);
                self.samples.derivatives_at(part.part, part.at, &worst)
            };
            let worst: Vec<_> = self.parts.iter().zip(&found.slopes).map(beyond).collect();
            if worst.iter().all(Vec::is_empty) {
                break;
            }
            self.parts.iter_mut().zip(worst).for_each(|(part, worst)| part.points.extend(worst));
            found = self.program(of, rate)?;
        }
        Some(found)
    }

    /// The ball of a part of a solution, in the units of the plant.
    fn ball(&self, part: Part, slopes: &KnownSlopes<f64>) -> Option<FloatSlopes> {
        let Ball { middle, size, .. } = Ball::new(slopes)?;
        let (order, columns) = (slopes.h.len(), &slopes.columns);
        let h = Mat::from_fn(order, order, |i, j| slopes.h[i][j]);
        let rows = |of: &Mat<f64>, scale: &dyn Fn(usize, usize) -> f64| -> Vec<Vec<f64>> {
            (0..of.nrows()).map(|i| (0..of.ncols()).map(|j| of[(i, j)] * scale(i, j)).collect()).collect()
        };
        let (time, unit) = (self.time, |i: usize| self.unit(i));
        let own = |i: usize| self.unit(columns.start + i);
        let found = FloatSlopes {
            part,
            centre: rows(&middle, &|i, j| -unit(i) / (own(j) * time)),
            size: rows(&size, &|i, j| 1.0 / (own(i) * own(j) * time)),
            h: rows(&h, &|i, j| time / (unit(i) * unit(j))),
        };
        let finite =
            [&found.centre, &found.size, &found.h].into_iter().flatten().flatten().all(|entry| entry.is_finite());
        finite.then_some(found)
    }

    /// The solution with the largest margin of all inequalities, where that is positive: Pi, K and (D) at every point are above it, and
    /// the traces of Pi and of each H are bounded.
    fn program(&self, of: &MatrixLoop<f64>, rate: f64) -> Option<Solution> {
        let (order, signals) = (of.order(), of.states + 1);
        let shapes: Vec<Range<usize>> = self.parts.iter().map(|part| part.columns.clone()).collect();
        let triangular = |n: usize| n * (n + 1) / 2;
        let of_pi = triangular(order);
        // What each variable adds to Pi and to the slopes.
        let parts = |variables: &[f64]| {
            let mut rest = &variables[of_pi..];
            let mut take = |count: usize| {
                let (taken, left) = rest.split_at(count);
                rest = left;
                taken
            };
            let known = |columns: &Range<usize>| {
                let count = columns.len();
                let q = Symmetric::from_entries(count, take(triangular(count))).rows();
                let g = take(count * signals).chunks(signals).map(<[f64]>::to_vec).collect();
                let h = Symmetric::from_entries(signals, take(triangular(signals))).rows();
                KnownSlopes { columns: columns.clone(), q, g, h }
            };
            let slopes: Vec<KnownSlopes<f64>> = shapes.iter().map(known).collect();
            (Symmetric::from_entries(order, variables).rows(), slopes)
        };
        let of_part =
            |columns: &Range<usize>| triangular(columns.len()) + columns.len() * signals + triangular(signals);
        let last = of_pi + shapes.iter().map(of_part).sum::<usize>();
        let unit = |variable: usize| {
            let mut unit = vec![0.0; last];
            unit[variable] = 1.0;
            parts(&unit)
        };
        let mut constraints = Vec::new();
        let mut above = |order: usize, forms: Vec<Vec<Vec<f64>>>| {
            constraints.push(AffineMatrix::from_fn(
                order,
                last + 1,
                |_, _| 0.0,
                |variable, i, j| match forms.get(variable) {
                    Some(form) => form[i.max(j)][i.min(j)],
                    None => -f64::from(i == j),
                },
            ));
        };
        let units: Vec<_> = (0..last).map(unit).collect();
        for gain in of.ends() {
            let form = |(pi, slopes): &(Vec<Vec<f64>>, Vec<KnownSlopes<f64>>)| {
                of.form(gain, &Multipliers { rate: &rate, pi, slopes })
            };
            above(order + signals * shapes.len(), units.iter().map(form).collect());
        }
        for (index, part) in self.parts.iter().enumerate() {
            for d in &part.points {
                let scaled = self.scaled(&part.columns, d);
                above(
                    part.columns.len(),
                    units.iter().map(|(_, slopes)| of_derivatives(&scaled, &slopes[index])).collect(),
                );
            }
        }
        above(order, units.iter().map(|(pi, _)| pi.clone()).collect());
        // 1 - tr(Pi)/order - the sum of tr(H)/signals >= 0.
        let trace = |of: &[Vec<f64>]| (0..of.len()).map(|i| of[i][i]).sum::<f64>() / of.len() as f64;
        let traces = |(pi, slopes): &(Vec<Vec<f64>>, Vec<KnownSlopes<f64>>)| {
            slopes.iter().fold(-trace(pi), |sum, part| sum - trace(&part.h))
        };
        let bounded = |variable: usize| units.get(variable).map_or(0.0, traces);
        constraints.push(AffineMatrix::from_fn(1, last + 1, |_, _| 1.0, |variable, _, _| bounded(variable)));
        let mut cost = vec![0.0; last + 1];
        cost[last] = -1.0;
        let found = propose(&cost, &constraints).ok()?.x;
        let margin = found[last];
        let (_, slopes) = parts(&found[..last]);
        (margin > SOLVED).then_some(Solution { slopes, margin })
    }
}

/// The ball `(D - C)'H (D - C) <= S` in which (D) has some columns of D.
pub(super) struct Ball {
    /// H^-1.
    pub(super) inverse: Mat<f64>,
    /// -C.
    pub(super) middle: Mat<f64>,
    /// S.
    pub(super) size: Mat<f64>,
}

impl Ball {
    /// `C = -H^-1 G'`, `S = Q + G H^-1 G'`; `None` where H is not definite.
    pub(super) fn new(KnownSlopes { columns, q, g, h }: &KnownSlopes<f64>) -> Option<Ball> {
        let (order, count) = (h.len(), columns.len());
        let matrix = |of: &[Vec<f64>], rows: usize, columns: usize| Mat::from_fn(rows, columns, |i, j| of[i][j]);
        let (q, g, h) = (matrix(q, count, count), matrix(g, count, order), matrix(h, order, order));
        let inverse = Llt::new(h.as_ref(), Side::Lower).ok()?.inverse();
        let middle = &inverse * g.transpose();
        let size = &q + &g * &middle;
        Some(Ball { inverse, middle, size })
    }
}

/// A with the middle of b_u, and B.
pub(super) fn matrices(of: &MatrixLoop<f64>) -> [Mat<f64>; 2] {
    let n = of.order();
    let ends = of.ends();
    let middle = ends.iter().sum::<f64>() / ends.len() as f64;
    let (input, feedback) = (of.input(), of.feedback(&middle));
    let entry = |list: &[Option<f64>], i: usize| list[i].unwrap_or(0.0);
    let mut a = Mat::from_fn(n, n, |i, j| entry(&input, i) * entry(&feedback, j));
    for column in 0..n {
        if let Some((row, value)) = of.drift(column) {
            a[(row, column)] += value;
        }
    }
    let b = Mat::from_fn(n, of.states + 1, |i, k| match k == of.states {
        true => entry(&input, i),
        false => f64::from(i == k),
    });
    [a, b]
}

/// What an input gain moves, `b_d (-sigma e + mu b'zs)` with half the width b_d of its interval, and B_q; none where it is known.
pub(super) fn moved(of: &MatrixLoop<f64>) -> Option<[Vec<f64>; 2]> {
    let [low, high] = of.ends() else { return None };
    // The feedback is affine in b_u.
    let [low, high] = [low, high].map(|gain| of.feedback(gain));
    let plain = |list: &[Option<f64>]| list.iter().map(|entry| entry.unwrap_or(0.0)).collect::<Vec<f64>>();
    let signal = plain(&low).iter().zip(plain(&high)).map(|(low, high)| (high - low) / 2.0).collect();
    Some([signal, plain(&of.input())])
}

/// The loop with constant derivatives.
pub(super) fn closed(of: &MatrixLoop<f64>, d: &[Vec<f64>]) -> Mat<f64> {
    let [mut a, b] = matrices(of);
    for i in 0..a.nrows() {
        for j in 0..=of.states {
            a[(i, j)] += (0..=of.states).map(|k| b[(i, k)] * d[k][j]).sum::<f64>();
        }
    }
    a
}

/// The rate of decay with constant derivatives, which may be negative; `None` where it has none in doubles.
pub(super) fn decay(of: &MatrixLoop<f64>, d: &[Vec<f64>]) -> Option<f64> {
    let a = closed(of, d);
    // A NaN would not stop an iteration for eigenvalues.
    if !a.as_ref().is_all_finite() {
        return None;
    }
    let values = a.eigenvalues().ok()?;
    Some(values.iter().map(|value| -value.re).fold(f64::INFINITY, f64::min))
}

/// By how much (D) fails at a point; 0 where it holds with some of the margin.
fn lack(d: &[Vec<f64>], slopes: &KnownSlopes<f64>, margin: f64) -> f64 {
    let rows = of_derivatives(d, slopes);
    let order = rows.len();
    let own = |i: usize, j: usize| rows[i.max(j)][i.min(j)] - if i == j { LEFT * margin } else { 0.0 };
    let matrix = Mat::from_fn(order, order, own);
    if Llt::new(matrix.as_ref(), Side::Lower).is_ok() {
        return 0.0;
    }
    let values = matrix.self_adjoint_eigenvalues(Side::Lower).unwrap_or_default();
    values.first().map_or(0.0, |least| -least)
}

/// `Q - G D - D'G' - D'H D`, its lower triangle by rows.
fn of_derivatives(d: &[Vec<f64>], KnownSlopes { columns, q, g, h }: &KnownSlopes<f64>) -> Vec<Vec<f64>> {
    let (order, count) = (d.len(), columns.len());
    let times = |of: &[Vec<f64>], i: usize, j: usize| (0..order).map(|k| of[i][k] * d[k][j]).sum::<f64>();
    let weighed: Vec<Vec<f64>> = (0..order).map(|i| (0..count).map(|j| times(h, i, j)).collect()).collect();
    let square = |i: usize, j: usize| (0..order).map(|k| d[k][i] * weighed[k][j]).sum::<f64>();
    let entry = |i: usize, j: usize| q[i][j] - times(g, i, j) - times(g, j, i) - square(i, j);
    (0..count).map(|i| (0..=i).map(|j| entry(i, j)).collect()).collect()
}
