//! The metrics of the joint inequality (Jm) (derivation, 13.7), proposed by semidefinite programs over sampled points.

use super::place::{Place, Places};
use super::pointwise::{Derivatives, Slopes};
use super::suprema::{FloatSuprema, Starts};
use super::weights::Root;
use crate::semidefinite::propose;
use sigmastar_lang::spec::Bound;
use sigmastar_matrix::doubles::largest;
use sigmastar_matrix::{AffineMatrix, Symmetric};

/// Points that are added where what was found does not hold, and how often.
const POINTS: usize = 6;
const ROUNDS: usize = 6;

/// The most points that one program leaves for the next.
const LEFT_OVER: usize = 8;

/// The share of the largest c_y that is left for how definite the rest is, and the share of that which is used.
const KEPT: f64 = 0.93;
const USED: f64 = 0.8;

/// What is left of the margins of a program at points that it did not see.
const LEFT: f64 = 0.5;

/// A metric in doubles.
#[derive(Clone, Debug)]
pub struct FloatMetric {
    /// P by rows.
    pub p: Vec<Vec<f64>>,
    /// p.
    pub cross: Vec<f64>,
    /// w.
    pub weight: f64,
    /// k_p.
    pub k_p: f64,
    /// c_x, c_e, c_y.
    pub margins: [f64; 3],
}

/// What a metric is between, and how much of the level the initial set takes.
#[derive(Clone, Copy, Debug)]
pub struct FloatLevel {
    /// P is at most so many times the identity.
    pub p_up: f64,
    /// `1/D_x^2`.
    pub x_low: f64,
    /// `1/D_e^2`.
    pub e_low: f64,
}

/// The error box and the initial set of stability.
#[derive(Clone, Copy, Debug)]
pub struct LevelAsked {
    /// D_x and D_e.
    pub radii: [f64; 2],
    /// dX, dE, dZ.
    pub distances: [f64; 3],
    /// mu.
    pub mu: f64,
    /// A rate of x, in 1/time.
    pub rate: f64,
    /// The share of the rates of x, of e and of y that both matrices keep.
    pub margin: f64,
}

/// Which points a proposal is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LookedAt {
    /// Those of a grid.
    Grid,
    /// Those between them too, as far as a local search finds some: for a proof.
    Between,
}

impl FloatSuprema {
    /// Metrics of existence on `|y| <= X`, `|e| <= E` at a threshold, near and far: with a large share of the largest c_y/k_p. `places` are
    /// points of a program like it, and become those that this one needed besides its own.
    #[must_use]
    pub fn propose_joint_existence(
        &self,
        at: [f64; 2],
        value: f64,
        (looked, places): (LookedAt, &mut Vec<Place>),
    ) -> Option<[FloatMetric; 2]> {
        let mut program = self.program(at, value, None, places)?;
        self.settled(at, &mut program, (looked, places), |program| {
            let (_, largest) = program.of_existence(None)?;
            let kept = KEPT * (largest > 0.0).then_some(largest)?;
            let (variables, room) = program.of_existence(Some(kept))?;
            let definite = USED * (room > 0.0).then_some(room)?;
            Some((variables, [[definite, definite, kept]; 2]))
        })
        .map(|(metrics, _)| metrics)
    }

    /// Metrics of stability, near and far, and the largest share of its level that the initial set takes, to be below 1; with the points
    /// of [`FloatSuprema::propose_joint_existence`].
    #[must_use]
    pub fn propose_joint_stability(
        &self,
        at: [f64; 2],
        value: f64,
        asked: &LevelAsked,
        (looked, places): (LookedAt, &mut Vec<Place>),
    ) -> Option<([FloatMetric; 2], [FloatLevel; 2], f64)> {
        let [d_x, d_e] = asked.radii;
        let mut program = self.program(at, value, Some([d_x, d_e]), places)?;
        let (metrics, variables) =
            self.settled(at, &mut program, (looked, places), |program| program.of_stability(asked))?;
        let (share, p_up) = program.shares(&variables);
        let level =
            |p_up: f64| FloatLevel { p_up: p_up / (d_x * d_x), x_low: (d_x * d_x).recip(), e_low: (d_e * d_e).recip() };
        Some((metrics, p_up.map(level), share))
    }

    /// A program over the points where derivatives are extreme, and those that are known.
    fn program(&self, at: [f64; 2], value: f64, units: Option<[f64; 2]>, known: &[Place]) -> Option<Program> {
        let all = Places::Stride(1);
        let mut first = self.where_largest(at, &all, [Bound::Rate, Bound::Qx, Bound::Fe, Bound::QeMax, Bound::Qe]);
        first.extend(known);
        let mut program = Program { points: Vec::new(), value, units: [1.0; 2], n: 0 };
        program.add(self, at, first);
        program.n = program.points.first()?.r.len();
        program.units = units.unwrap_or_else(|| program.balanced());
        (program.n > 0).then_some(program)
    }

    /// What a program finds once the points are added where it does not hold.
    fn settled(
        &self,
        at: [f64; 2],
        program: &mut Program,
        (looked, places): (LookedAt, &mut Vec<Place>),
        solve: impl Fn(&Program) -> Option<(Vec<f64>, [[f64; 3]; 2])>,
    ) -> Option<([FloatMetric; 2], Vec<f64>)> {
        let mut found = solve(program)?;
        for _ in 0..ROUNDS {
            let (variables, margins) = &found;
            let mut worst = self.largest_of_derivatives(at, &Places::Stride(1), POINTS, |derivatives, _| {
                let point = program.point(derivatives);
                // Where it holds nobody asks by how much.
                if program.holds(&point, variables, margins) {
                    return f64::NAN;
                }
                program.lack(&point, variables, margins)
            });
            worst.retain(|(below, _)| *below > 0.0);
            if worst.is_empty() {
                break;
            }
            let worst: Vec<Place> = worst.into_iter().map(|(_, place)| place).collect();
            places.extend(&worst);
            program.add(self, at, worst);
            found = solve(program)?;
        }
        for _ in 0..if looked == LookedAt::Between { ROUNDS } else { 0 } {
            let (variables, margins) = &found;
            let lack = |derivatives: &Derivatives<'_>| program.lack(&program.point(derivatives), variables, margins);
            let mut worst = self.refined_points((at, Starts::Best), lack, |derivatives| program.point(derivatives));
            worst.retain(|(below, _)| *below > 0.0);
            if worst.is_empty() {
                break;
            }
            program.points.extend(worst.into_iter().map(|(_, point)| point));
            found = solve(program)?;
        }
        places.drain(..places.len().saturating_sub(LEFT_OVER));
        let (variables, margins) = found;
        Some((program.metrics(&variables, &margins), variables))
    }
}

/// The programs for given points. Time in units of 1/value, x and e in those that are given, y in that of e times the value: then sigma
/// is 1. The variables are P, p, w, k_p of the near metric, P, w, k_p of the far one, and what a program has beside.
struct Program {
    points: Vec<Slopes>,
    value: f64,
    units: [f64; 2],
    n: usize,
}

type Matrix = Vec<Vec<f64>>;

impl Program {
    fn add(&mut self, samples: &FloatSuprema, at: [f64; 2], places: Vec<Place>) {
        let points = samples.of_derivatives(at, &Places::listed(places), |derivatives, _| self.point(derivatives));
        self.points.extend(points);
    }

    fn point(&self, Derivatives { j, g, r, d }: &Derivatives<'_>) -> Slopes {
        let value = |values: &[f64]| values.iter().map(|entry| entry / self.value).collect();
        Slopes { j: value(j), g: value(g), r: value(r), d: d / self.value }
    }

    /// Units of x and e in which g and r are of one size.
    fn balanced(&self) -> [f64; 2] {
        let [g, r] = Slopes::largest(&self.points);
        [if g > 0.0 && r > 0.0 { (g / r).sqrt() } else { 1.0 }, 1.0]
    }

    /// The number of entries of P.
    fn triangle(&self) -> usize {
        self.n * (self.n + 1) / 2
    }

    /// The number of variables of the two metrics.
    fn size(&self) -> usize {
        2 * (self.triangle() + 2) + self.n
    }

    /// P, p, w, k_p of both metrics, in the units.
    fn parts(&self, variables: &[f64]) -> [(Matrix, Vec<f64>, f64, f64); 2] {
        let triangle = self.triangle();
        let matrix = |entries: &[f64]| Symmetric::from_entries(self.n, entries).rows();
        let (near, far) = variables.split_at(triangle + self.n + 2);
        let (p, near) = near.split_at(triangle);
        let (cross, near) = near.split_at(self.n);
        let (other, far) = far.split_at(triangle);
        [(matrix(p), cross.to_vec(), near[0], near[1]), (matrix(other), vec![0.0; self.n], far[0], far[1])]
    }

    /// The matrices of both metrics at a point, without margins.
    fn forms(&self, point: &Slopes, variables: &[f64]) -> [Matrix; 2] {
        let [s_x, s_e] = self.units;
        let n = self.n;
        let Slopes { j, g, r, d } = point;
        let g: Vec<f64> = g.iter().map(|entry| entry * s_e / s_x).collect();
        let r: Vec<f64> = r.iter().map(|entry| entry * s_x / s_e).collect();
        let parts = self.parts(variables);
        let pulled = parts[0].1.clone();
        let corners = [parts[0].2, parts[0].2 + parts[1].2];
        let mut corners = corners.into_iter();
        parts.map(|(p, cross, weight, k_p)| {
            let corner = corners.next().unwrap_or(f64::NAN);
            let moved = |i: usize, k: usize| -> f64 { (0..n).map(|m| p[i][m] * j[m * n + k]).sum() };
            let driven = |i: usize| -> f64 { (0..n).map(|m| p[i][m] * g[m] + cross[m] * j[m * n + i]).sum() };
            let pushed: f64 = cross.iter().zip(&g).map(|(p, g)| p * g).sum();
            let entry = |i: usize, k: usize| match (i.min(k), i.max(k)) {
                (i, k) if k < n => -(moved(i, k) + moved(k, i)),
                (i, k) if i < n && k == n => pulled[i] - driven(i),
                (i, _) if i < n => -cross[i] - 0.5 * k_p * r[i],
                (i, k) if i == n && k == n => 2.0 * corner - 2.0 * pushed,
                (i, _) if i == n => -weight - 0.5 * k_p * d,
                _ => k_p,
            };
            (0..n + 2).map(|i| (0..n + 2).map(|k| entry(i, k)).collect()).collect()
        })
    }

    /// The matrices at a point less what is left of the margins.
    fn less_margins(&self, point: &Slopes, variables: &[f64], margins: &[[f64; 3]; 2]) -> [Matrix; 2] {
        let mut forms = self.forms(point, variables);
        for (form, margins) in forms.iter_mut().zip(margins) {
            for (i, row) in form.iter_mut().enumerate() {
                row[i] -= LEFT * margins[(i + 1).saturating_sub(self.n).min(2)];
            }
        }
        forms
    }

    /// Whether they are positive definite.
    fn holds(&self, point: &Slopes, variables: &[f64], margins: &[[f64; 3]; 2]) -> bool {
        let lower = |form: Matrix| form.iter().enumerate().flat_map(|(i, row)| row[..=i].to_vec()).collect();
        self.less_margins(point, variables, margins).into_iter().all(|form| Root::new(lower(form)).is_ok())
    }

    /// By how much they are not: negative where they are.
    fn lack(&self, point: &Slopes, variables: &[f64], margins: &[[f64; 3]; 2]) -> f64 {
        let negative = |form: Matrix| form.iter().map(|row| row.iter().map(|entry| -entry).collect()).collect();
        let lacks = self.less_margins(point, variables, margins).map(|form| largest(negative(form)));
        lacks.into_iter().fold(f64::NEG_INFINITY, f64::max)
    }

    /// The metrics of variables, in the units of the plant.
    fn metrics(&self, variables: &[f64], margins: &[[f64; 3]; 2]) -> [FloatMetric; 2] {
        let [s_x, s_e] = self.units;
        let value = self.value;
        let parts = self.parts(variables);
        let mut margins = margins.iter();
        parts.map(|(p, cross, weight, k_p)| {
            let [c_x, c_e, c_y] = margins.next().copied().unwrap_or_default();
            FloatMetric {
                p: p.iter().map(|row| row.iter().map(|entry| entry / (s_x * s_x)).collect()).collect(),
                cross: cross.iter().map(|entry| entry / (s_x * s_e)).collect(),
                weight: weight / (s_e * s_e),
                k_p: k_p / (value * s_e * s_e),
                margins: [value * c_x / (s_x * s_x), value * c_e / (s_e * s_e), c_y / (value * s_e * s_e)],
            }
        })
    }

    /// A constraint whose matrix is linear in the variables, and one in them beyond those of the metrics.
    fn affine(
        &self,
        more: usize,
        constant: &[[f64; 3]; 2],
        term: impl Fn(usize, usize) -> Option<[f64; 3]>,
        point: &Slopes,
    ) -> Vec<AffineMatrix<f64>> {
        let (size, order) = (self.size(), self.n + 2);
        let of_variable = |variable: usize| {
            let mut unit = vec![0.0; size];
            if variable < size {
                unit[variable] = 1.0;
            }
            self.forms(point, &unit)
        };
        let all: Vec<[Matrix; 2]> = (0..size + more).map(of_variable).collect();
        let place = |i: usize| (i + 1).saturating_sub(self.n).min(2);
        (0..2)
            .map(|which| {
                AffineMatrix::from_fn(
                    order,
                    size + more,
                    |i, j| if i == j { -constant[which][place(i)] } else { 0.0 },
                    |variable, i, j| {
                        let taken = if i == j { term(which, variable).map_or(0.0, |term| term[place(i)]) } else { 0.0 };
                        all[variable][which][i][j] - taken
                    },
                )
            })
            .collect()
    }

    /// Where the numbers of the metrics stand among the variables: k_p, w of the near and of the far one.
    fn places(&self) -> [[usize; 2]; 2] {
        let triangle = self.triangle();
        let near = triangle + self.n;
        let far = near + 2 + triangle;
        [[near + 1, near], [far + 1, far]]
    }

    /// A number that is linear in the variables as a matrix of order 1.
    fn scalar(&self, more: usize, constant: f64, terms: &[(usize, f64)]) -> AffineMatrix<f64> {
        let of = |variable: usize| terms.iter().filter(|(at, _)| *at == variable).map(|(_, factor)| factor).sum();
        AffineMatrix::from_fn(1, self.size() + more, |_, _| constant, |variable, _, _| of(variable))
    }

    /// The variables, and the largest c with both matrices above diag(0, 0, c) for k_p <= 1; where c is given, instead of it the largest m
    /// with both above diag(m, m, c).
    fn of_existence(&self, given: Option<f64>) -> Option<(Vec<f64>, f64)> {
        let last = self.size();
        let constant = [[0.0, 0.0, given.unwrap_or(0.0)]; 2];
        let taken = if given.is_some() { [1.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
        let term = |_: usize, variable: usize| (variable == last).then_some(taken);
        let mut constraints: Vec<AffineMatrix<f64>> =
            self.points.iter().flat_map(|point| self.affine(1, &constant, term, point)).collect();
        let [[near, _], [far, weight]] = self.places();
        constraints.push(self.scalar(1, 1.0, &[(near, -1.0)]));
        constraints.push(self.scalar(1, 1.0, &[(far, -1.0)]));
        constraints.push(self.scalar(1, 0.0, &[(weight, 1.0)]));
        let mut cost = vec![0.0; last + 1];
        cost[last] = -1.0;
        let mut found = propose(&cost, &constraints).ok()?.x;
        let largest = found.pop()?;
        Some((found, largest))
    }

    /// The variables, of which the last four are the two P_up, the bound of |p|, and the share of the level, which is least.
    fn of_stability(&self, asked: &LevelAsked) -> Option<(Vec<f64>, [[f64; 3]; 2])> {
        let LevelAsked { radii: [d_x, d_e], distances: [dist_x, dist_e, dist_z], mu, rate, margin } = *asked;
        let (n, size) = (self.n, self.size());
        let (up, joined, share) = ([size, size + 1], size + 2, size + 3);
        let more = 4;
        let places = self.places();
        let kept = [margin * (rate / self.value).min(1.0), margin, 0.0];
        let constant = [kept; 2];
        let of_y = [0.0, 0.0, margin];
        let term = |which: usize, variable: usize| (variable == places[which][0]).then_some(of_y);
        let mut constraints: Vec<AffineMatrix<f64>> =
            self.points.iter().flat_map(|point| self.affine(more, &constant, term, point)).collect();
        let of_metric = |variable: usize, which: usize, i: usize, j: usize| {
            let mut unit = vec![0.0; size];
            match unit.get_mut(variable) {
                Some(entry) => *entry = 1.0,
                None => return 0.0,
            }
            let (p, cross, weight, _) = &self.parts(&unit)[which];
            match (i < n, j < n) {
                (true, true) => p[i][j],
                (false, false) => *weight,
                _ => cross[i.min(j)],
            }
        };
        for (which, up) in up.into_iter().enumerate() {
            // Pi above diag(1, 0) and diag(0, 1), and P at most its P_up.
            for of_states in [true, false] {
                constraints.push(AffineMatrix::from_fn(
                    n + 1,
                    size + more,
                    |i, j| if i == j && (i < n) == of_states { -1.0 } else { 0.0 },
                    |variable, i, j| of_metric(variable, which, i, j),
                ));
            }
            let above = |variable: usize, i: usize, j: usize| {
                let own = if variable == up && i == j { 1.0 } else { 0.0 };
                own - of_metric(variable, which, i, j)
            };
            constraints.push(AffineMatrix::from_fn(n, size + more, |_, _| 0.0, above));
        }
        // |p| at most its bound.
        let bounded = |variable: usize, i: usize, j: usize| match (i == j, i < n, j < n) {
            (true, _, _) if variable == joined => 1.0,
            (false, true, false) | (false, false, true) => of_metric(variable, 0, i, j),
            _ => 0.0,
        };
        constraints.push(AffineMatrix::from_fn(n + 1, size + more, |_, _| 0.0, bounded));
        let (a, b) = (dist_x / d_x, dist_e / d_e);
        let of_zeta = 0.5 * mu * dist_z * dist_z / (self.value * d_e * d_e);
        for (which, [k_p, weight]) in places.into_iter().enumerate() {
            let mut terms = vec![(share, 1.0), (up[which], -a * a), (weight, -b * b), (k_p, -of_zeta)];
            if which == 0 {
                terms.push((joined, -2.0 * a * b));
            }
            constraints.push(self.scalar(more, 0.0, &terms));
        }
        let mut cost = vec![0.0; size + more];
        cost[share] = 1.0;
        let found = propose(&cost, &constraints).ok()?.x;
        let margins = places.map(|[k_p, _]| [kept[0], kept[1], margin * found[k_p]]);
        Some((found, margins))
    }

    /// The share of the level, and P_up of both metrics, in the units.
    fn shares(&self, variables: &[f64]) -> (f64, [f64; 2]) {
        let size = self.size();
        (variables[size + 3], [variables[size], variables[size + 1]])
    }
}
