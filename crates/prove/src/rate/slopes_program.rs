//! What is to be known of the first derivatives together so that the loop decays fast: Q, G and H of (K) and (D) (derivation, 13.6),
//! proposed by semidefinite programs over sampled derivatives. Nothing rests on them.

use super::matrix_loop::{MatrixLoop, Multipliers};
use faer::linalg::solvers::{DenseSolveCore, Llt};
use faer::{Mat, Side};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_matrix::AffineMatrix;
use sigmastar_matrix::semidefinite::propose;
use sigmastar_plants::bounds::{FloatSlopes, FloatSuprema};

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

/// Sampled derivatives on one box: extreme ones, and those that programs needed.
pub struct SampledSlopes<'s> {
    samples: &'s FloatSuprema,
    at: [f64; 2],
    points: Vec<Vec<Vec<f64>>>,
    /// The unit of x in that of e, and the largest norm of the derivatives with it, in 1/time.
    length: f64,
    norm: f64,
    /// The unit of time of a program.
    time: f64,
}

/// What a program finds: Q, G, H by rows and the margin.
struct Solution {
    slopes: [Vec<Vec<f64>>; 3],
    margin: f64,
}

impl<'s> SampledSlopes<'s> {
    /// Derivatives for X + r, E.
    #[must_use]
    pub fn new(samples: &'s FloatSuprema, at: [f64; 2]) -> SampledSlopes<'s> {
        let plain = samples.derivatives_at(at, &samples.extreme_places(at));
        let n = plain.first().map_or(0, Vec::len).saturating_sub(1);
        let norm = |values: &mut dyn Iterator<Item = f64>| values.map(|value| value * value).sum::<f64>().sqrt();
        let g = plain.iter().map(|d| norm(&mut d[..n].iter().map(|row| row[n]))).fold(0.0, f64::max);
        let r = plain.iter().map(|d| norm(&mut d[n][..n].iter().copied())).fold(0.0, f64::max);
        let length = if g > 0.0 && r > 0.0 { (g / r).sqrt() } else { 1.0 };
        let mut found = SampledSlopes { samples, at, points: plain, length, norm: 0.0, time: 1.0 };
        found.norm = found.scaled_points().iter().map(|d| norm(&mut d.iter().flatten().copied())).fold(0.0, f64::max);
        found
    }

    fn scaled_points(&self) -> Vec<Vec<Vec<f64>>> {
        self.points.iter().map(|d| self.scaled(d)).collect()
    }

    /// D in the units.
    fn scaled(&self, d: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let n = d.len() - 1;
        let unit = |i: usize| if i < n { self.length } else { 1.0 };
        (0..=n).map(|i| (0..=n).map(|j| d[i][j] * self.time * unit(j) / unit(i)).collect()).collect()
    }

    /// Balls of Q, G and H that let this loop decay at a large rate, and at smaller ones.
    #[must_use]
    pub fn propose(&mut self, of: &MatrixLoop<Enclosure>) -> Vec<FloatSlopes> {
        let plain = of.doubles(1.0);
        let slowest = self.points.iter().filter_map(|d| plain.decay(d)).fold(f64::INFINITY, f64::min);
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
        found.iter().filter_map(|found| self.ball(found)).collect()
    }

    /// A solution at a rate, once the points are added where it does not hold.
    fn solve(&mut self, of: &MatrixLoop<f64>, rate: f64) -> Option<Solution> {
        let mut found = program(of, &self.scaled_points(), rate)?;
        for _ in 0..ROUNDS {
            let lack = |d: &[Vec<f64>]| lack(&self.scaled(d), &found);
            let worst = self.samples.places_beyond(self.at, POINTS, lack);
            if worst.is_empty() {
                break;
            }
            self.points.extend(self.samples.derivatives_at(self.at, &worst));
            found = program(of, &self.scaled_points(), rate)?;
        }
        Some(found)
    }

    /// The ball of a solution, in the units of the plant.
    fn ball(&self, Solution { slopes: [q, g, h], .. }: &Solution) -> Option<FloatSlopes> {
        let order = h.len();
        let unit = |i: usize| if i + 1 < order { self.length } else { 1.0 };
        let matrix = |of: &[Vec<f64>]| Mat::from_fn(order, order, |i, j| of[i][j]);
        let (q, g, h) = (matrix(q), matrix(g), matrix(h));
        let inverse = Llt::new(h.as_ref(), Side::Lower).ok()?.inverse();
        let centre = &inverse * g.transpose();
        let size = &q + &g * &centre;
        let rows = |of: &Mat<f64>, scale: &dyn Fn(usize, usize) -> f64| -> Vec<Vec<f64>> {
            (0..order).map(|i| (0..order).map(|j| of[(i, j)] * scale(i, j)).collect()).collect()
        };
        let time = self.time;
        let found = FloatSlopes {
            centre: rows(&centre, &|i, j| -unit(i) / (unit(j) * time)),
            size: rows(&size, &|i, j| 1.0 / (unit(i) * unit(j) * time)),
            h: rows(&h, &|i, j| time / (unit(i) * unit(j))),
        };
        let finite =
            [&found.centre, &found.size, &found.h].into_iter().flatten().flatten().all(|entry| entry.is_finite());
        finite.then_some(found)
    }
}

impl MatrixLoop<f64> {
    /// A with the middle of b_u, and B.
    pub(super) fn matrices(&self) -> [Mat<f64>; 2] {
        let n = self.order();
        let ends = self.ends();
        let middle = ends.iter().sum::<f64>() / ends.len() as f64;
        let (input, feedback) = (self.input(), self.feedback(&middle));
        let entry = |of: &[Option<f64>], i: usize| of[i].unwrap_or(0.0);
        let mut a = Mat::from_fn(n, n, |i, j| entry(&input, i) * entry(&feedback, j));
        for column in 0..n {
            if let Some((row, value)) = self.drift(column) {
                a[(row, column)] += value;
            }
        }
        let b = Mat::from_fn(n, self.states + 1, |i, k| match k == self.states {
            true => entry(&input, i),
            false => f64::from(i == k),
        });
        [a, b]
    }

    /// What an input gain moves, `b_d (-sigma e + mu b'zs)` with half the width b_d of its interval, and B_q; none where it is known.
    pub(super) fn moved(&self) -> Option<[Vec<f64>; 2]> {
        let [low, high] = self.ends() else { return None };
        // The feedback is affine in b_u.
        let [low, high] = [low, high].map(|gain| self.feedback(gain));
        let plain = |of: &[Option<f64>]| of.iter().map(|entry| entry.unwrap_or(0.0)).collect::<Vec<f64>>();
        let signal = plain(&low).iter().zip(plain(&high)).map(|(low, high)| (high - low) / 2.0).collect();
        Some([signal, plain(&self.input())])
    }

    /// The loop with constant derivatives.
    pub(super) fn closed(&self, d: &[Vec<f64>]) -> Mat<f64> {
        let [mut a, b] = self.matrices();
        for i in 0..a.nrows() {
            for j in 0..=self.states {
                a[(i, j)] += (0..=self.states).map(|k| b[(i, k)] * d[k][j]).sum::<f64>();
            }
        }
        a
    }

    /// The rate of decay with constant derivatives, which may be negative; `None` where it has none in doubles.
    pub(super) fn decay(&self, d: &[Vec<f64>]) -> Option<f64> {
        let a = self.closed(d);
        // A NaN would not stop an iteration for eigenvalues.
        if !(0..a.ncols()).all(|j| (0..a.nrows()).all(|i| a[(i, j)].is_finite())) {
            return None;
        }
        let values = a.eigenvalues().ok()?;
        Some(values.iter().map(|value| -value.re).fold(f64::INFINITY, f64::min))
    }
}

/// By how much (D) fails at a point; 0 where it holds with some of the margin.
fn lack(d: &[Vec<f64>], Solution { slopes: [q, g, h], margin, .. }: &Solution) -> f64 {
    let order = d.len();
    let rows = of_derivatives(d, [q, g, h]);
    let own = |i: usize, j: usize| rows[i.max(j)][i.min(j)] - if i == j { LEFT * margin } else { 0.0 };
    let matrix = Mat::from_fn(order, order, own);
    if Llt::new(matrix.as_ref(), Side::Lower).is_ok() {
        return 0.0;
    }
    let values = matrix.self_adjoint_eigenvalues(Side::Lower).unwrap_or_default();
    values.first().map_or(0.0, |least| -least)
}

/// `Q - G D - D'G' - D'H D`, its lower triangle by rows.
fn of_derivatives(d: &[Vec<f64>], [q, g, h]: [&[Vec<f64>]; 3]) -> Vec<Vec<f64>> {
    let order = d.len();
    let times = |of: &[Vec<f64>], i: usize, j: usize| (0..order).map(|k| of[i][k] * d[k][j]).sum::<f64>();
    let weighed: Vec<Vec<f64>> = (0..order).map(|i| (0..order).map(|j| times(h, i, j)).collect()).collect();
    let square = |i: usize, j: usize| (0..order).map(|k| d[k][i] * weighed[k][j]).sum::<f64>();
    let entry = |i: usize, j: usize| q[i][j] - times(g, i, j) - times(g, j, i) - square(i, j);
    (0..order).map(|i| (0..=i).map(|j| entry(i, j)).collect()).collect()
}

/// The solution with the largest margin of all inequalities, where that is positive: Pi, K and (D) at every point are above it, and
/// the traces of Pi and H are bounded.
fn program(of: &MatrixLoop<f64>, points: &[Vec<Vec<f64>>], rate: f64) -> Option<Solution> {
    let (order, signals) = (of.order(), of.states + 1);
    let triangle = |n: usize| (0..n).flat_map(|i| (0..=i).map(move |j| (i, j))).collect::<Vec<_>>();
    let (of_pi, small) = (triangle(order), triangle(signals));
    let full: Vec<(usize, usize)> = (0..signals).flat_map(|i| (0..signals).map(move |j| (i, j))).collect();
    let ends = [of_pi.len(), of_pi.len() + small.len(), of_pi.len() + small.len() + full.len()];
    let last = ends[2] + small.len();
    let parts = |variables: &[f64]| {
        let square = |n: usize| vec![vec![0.0; n]; n];
        let symmetric = |n: usize, places: &[(usize, usize)], values: &[f64]| {
            let mut matrix = square(n);
            for ((i, j), value) in places.iter().zip(values) {
                (matrix[*i][*j], matrix[*j][*i]) = (*value, *value);
            }
            matrix
        };
        let mut g = square(signals);
        for ((i, j), value) in full.iter().zip(&variables[ends[1]..]) {
            g[*i][*j] = *value;
        }
        let q = symmetric(signals, &small, &variables[ends[0]..]);
        let h = symmetric(signals, &small, &variables[ends[2]..]);
        (symmetric(order, &of_pi, variables), [q, g, h])
    };
    // What each variable adds to each of the forms.
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
        let form = |(pi, slopes): &(Vec<Vec<f64>>, [Vec<Vec<f64>>; 3])| {
            of.form(gain, &Multipliers { rate: &rate, pi, slopes: slopes.each_ref().map(Vec::as_slice) })
        };
        above(order + signals, units.iter().map(form).collect());
    }
    for d in points {
        let form = |(_, slopes): &(_, [Vec<Vec<f64>>; 3])| of_derivatives(d, slopes.each_ref().map(Vec::as_slice));
        above(signals, units.iter().map(form).collect());
    }
    above(order, units.iter().map(|(pi, _)| pi.clone()).collect());
    // 1 - tr(Pi)/order - tr(H)/signals >= 0.
    let trace = |of: &[Vec<f64>]| (0..of.len()).map(|i| of[i][i]).sum::<f64>() / of.len() as f64;
    let bounded = |variable: usize| units.get(variable).map_or(0.0, |(pi, [_, _, h])| -trace(pi) - trace(h));
    constraints.push(AffineMatrix::from_fn(1, last + 1, |_, _| 1.0, |variable, _, _| bounded(variable)));
    let mut cost = vec![0.0; last + 1];
    cost[last] = -1.0;
    let found = propose(&cost, &constraints).ok()?.x;
    let margin = found[last];
    let (_, slopes) = parts(&found[..last]);
    (margin > SOLVED).then_some(Solution { slopes, margin })
}
