//! The matrix inequalities at one point in doubles (derivation, 13.7): F of (M) without e, the column of e, and the least sigma of both; the
//! margin of (E).

use super::pointwise::{Derivatives, MatrixAt, dot};
use rug::Rational;
use sigmastar_lang::spec::ExistenceInequality;

/// The free numbers of (M) in doubles (derivation, 13.7).
#[derive(Clone, Copy, Debug)]
pub struct FloatWeights {
    /// w_x.
    pub w_x: f64,
    /// kp = 2 h/mu.
    pub k_p: f64,
    /// The rate that x keeps.
    pub rate: f64,
}

impl FloatWeights {
    /// G: the lower triangle by rows, of x and y. Not a number where P is not the identity.
    pub fn of_states(self, at: &Derivatives<'_>, matrix: &MatrixAt) -> Vec<f64> {
        let FloatWeights { w_x, k_p, rate } = self;
        let n = at.r.len();
        let mut rows = Vec::with_capacity((n + 1) * (n + 2) / 2);
        let known = if n == 0 || matches!(matrix, MatrixAt::Identity) { -w_x } else { f64::NAN };
        for i in 0..n {
            for k in 0..=i {
                let own = if i == k { 2.0 * rate } else { 0.0 };
                rows.push(known * (at.j[i * n + k] + at.j[k * n + i] + own));
            }
        }
        rows.extend(at.r.iter().map(|slope| -0.5 * k_p * slope));
        rows.push(k_p);
        rows
    }

    /// v: the column of e, in x and y, with P = 1; `moves` are the 1 - b of an input gain.
    pub fn of_error(self, at: &Derivatives<'_>, moves: Option<[f64; 2]>) -> Column {
        let of_states = at.g.iter().map(|slope| -self.w_x * slope);
        let half = 0.5 * self.k_p;
        Column {
            fixed: of_states.chain([-1.0 - half * at.d]).collect(),
            moved: moves.map(|moves| moves.map(|share| -half * share)),
            larger: moves.map_or(Thresholds::ALL, |moves| {
                moves.into_iter().map(|share| for_any_larger(half, 1.0 - share)).fold(Thresholds::ALL, Thresholds::and)
            }),
        }
    }
}

/// The column of e beside its diagonal. With an input gain its entry with y changes with sigma, at either end of b (derivation, 13.1).
pub struct Column {
    fixed: Vec<f64>,
    /// What sigma adds to the last entry, at both ends.
    moved: Option<[f64; 2]>,
    /// The sigma from which on the inequality holds of any larger one too, at both ends.
    larger: Thresholds,
}

/// Where `(1 + ht (1-b) sigma)^2 <= 4 ht sigma` at one end of an input gain, (B) of derivation, 13.1: between `1/(ht (1 + sqrt(b))^2)` and
/// `1/(ht (1 - sqrt(b))^2)`.
fn for_any_larger(h_over_mu: f64, b: f64) -> Thresholds {
    let at = |root: f64| (h_over_mu * root * root).recip();
    Thresholds { least: at(1.0 + b.sqrt()), largest: at(1.0 - b.sqrt()) }
}

impl Column {
    /// The column at a sigma: at both ends where they differ.
    pub fn at(&self, sigma: f64) -> Vec<Vec<f64>> {
        let Some(moved) = self.moved else { return vec![self.fixed.clone()] };
        let end = |by: f64| {
            let mut column = self.fixed.clone();
            column.iter_mut().last().into_iter().for_each(|entry| *entry += by * sigma);
            column
        };
        moved.map(end).into()
    }
}

/// The sigma at which F is positive semidefinite, with an input gain an interval: of one point, or of many together.
#[derive(Clone, Copy, Debug)]
pub struct Thresholds {
    /// The least; infinite where there is none, not a number where a value is undefined.
    pub least: f64,
    largest: f64,
}

impl Thresholds {
    /// Where nothing is asked for.
    pub const ALL: Thresholds = Thresholds { least: f64::NEG_INFINITY, largest: f64::INFINITY };

    /// Those from the least one on.
    #[must_use]
    pub fn from(least: f64) -> Thresholds {
        Thresholds { least, largest: f64::INFINITY }
    }

    /// Those that are in both.
    pub fn and(self, other: Thresholds) -> Thresholds {
        let undefined = self.least.is_nan() || other.least.is_nan();
        let least = if undefined { f64::NAN } else { self.least.max(other.least) };
        Thresholds { least, largest: self.largest.min(other.largest) }
    }

    /// The least of them; infinite where there are none.
    pub fn value(self) -> f64 {
        if self.least > self.largest { f64::INFINITY } else { self.least }
    }
}

/// The free numbers of (E) in doubles (derivation, 13.7).
#[derive(Clone, Debug)]
pub struct EnergyWeights {
    /// P by rows, in the coordinates y.
    pub p: Vec<Vec<f64>>,
    /// k_p.
    pub k_p: f64,
    /// c_x.
    pub c_x: f64,
    /// The threshold of sigma.
    pub value: f64,
}

impl From<&ExistenceInequality> for EnergyWeights {
    fn from(ExistenceInequality { matrix, k_p, c_x, value, .. }: &ExistenceInequality) -> EnergyWeights {
        let p = matrix.iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect();
        EnergyWeights { p, k_p: k_p.to_f64(), c_x: c_x.to_f64(), value: value.to_f64() }
    }
}

impl EnergyWeights {
    /// The largest c_y at one point; `moves` are the 1 - b of an input gain.
    pub fn margin(&self, at: &Derivatives<'_>, moves: Option<[f64; 2]>) -> f64 {
        self.at(at, moves).margin(self.k_p, self.value)
    }

    /// c_y at one point as a function of the threshold.
    pub fn at(&self, at: &Derivatives<'_>, moves: Option<[f64; 2]>) -> EnergyAt {
        let EnergyWeights { p, k_p, c_x, .. } = self;
        let n = at.r.len();
        let moved = |i: usize, k: usize| -> f64 { (0..n).map(|m| p[i][m] * at.j[m * n + k]).sum() };
        let mut rows = Vec::with_capacity(n * (n + 1) / 2);
        for i in 0..n {
            rows.extend((0..=i).map(|k| -(moved(i, k) + moved(k, i)) - if i == k { *c_x } else { 0.0 }));
        }
        let root = match Root::new(rows) {
            Ok(root) => root,
            Err(without) => return EnergyAt { of_y: without, between: 0.0, of_e: 0.0, moves },
        };
        let of_e = root.solved((0..n).map(|i| -(0..n).map(|m| p[i][m] * at.g[m]).sum::<f64>()));
        let of_y = root.solved(at.r.iter().map(|slope| -0.5 * k_p * slope));
        EnergyAt {
            between: -1.0 - 0.5 * k_p * at.d - dot(&of_e, &of_y),
            of_e: dot(&of_e, &of_e),
            of_y: dot(&of_y, &of_y),
            moves,
        }
    }
}

/// What is left of the rows of e and y of (E) where those of x are eliminated: `[[2 sigma - of_e, between], [., k_p - of_y]]`; with an
/// input gain `-(k_p/2) (1-b) sigma` more in `between`, at both ends.
#[derive(Clone, Copy, Debug)]
pub struct EnergyAt {
    of_y: f64,
    between: f64,
    of_e: f64,
    moves: Option<[f64; 2]>,
}

impl EnergyAt {
    /// The largest c_y at a threshold of sigma; negative and infinite where there is none. With an input gain it serves every larger
    /// sigma (E4).
    #[must_use]
    pub fn margin(self, k_p: f64, value: f64) -> f64 {
        let EnergyAt { of_y, between, of_e, moves } = self;
        let left = 2.0 * value - of_e;
        let with = |moved: f64| k_p - of_y - (between - moved) * (between - moved) / left;
        let margin = match moves {
            None => with(0.0),
            Some(moves) => {
                let at = |share: f64| {
                    let moved = 0.5 * k_p * share * value;
                    with(moved).min(k_p - (1.0 + moved) * (1.0 + moved) / (2.0 * value))
                };
                at(moves[0]).min(at(moves[1]))
            }
        };
        if left > 0.0 || left.is_nan() { margin } else { f64::NEG_INFINITY }
    }

    /// Those of which one has the least margin, whatever k_p and the threshold are: the others are no larger in any entry than one of
    /// these, and no operation of [`EnergyAt::margin`] turns that around by rounding. All, where an entry is not finite.
    ///
    /// With an input gain a larger `between` makes the margin smaller at the end that moves it least, and a smaller one at the other end,
    /// where the square is the larger one: those are left that have the least margin of one kind or the other.
    #[must_use]
    pub fn front(all: Vec<EnergyAt>) -> Vec<EnergyAt> {
        let finite = |at: &EnergyAt| [at.of_y, at.between, at.of_e].iter().all(|entry| entry.is_finite());
        if !all.iter().all(finite) {
            return all;
        }
        let kinds = match all.iter().any(|at| at.moves.is_some()) {
            false => vec![behind(&all, |at| [at.of_y, at.between.abs(), at.of_e])],
            true => [1.0, -1.0].map(|sign| behind(&all, |at| [at.of_y, sign * at.between, at.of_e])).into(),
        };
        let left = |index: usize| kinds.iter().any(|behind| !behind[index]);
        all.into_iter().enumerate().filter(|(index, _)| left(*index)).map(|(_, at)| at).collect()
    }
}

/// So many of the foremost are compared with: a few leave out nearly all that all would.
const FOREMOST: usize = 24;

/// Which of them one of the foremost reaches in all sizes, none of these themselves.
fn behind(all: &[EnergyAt], sizes: impl Fn(&EnergyAt) -> [f64; 3]) -> Vec<bool> {
    let sized: Vec<[f64; 3]> = all.iter().map(sizes).collect();
    let sum = |index: usize| sized[index].iter().sum::<f64>();
    // The largest ones first: what is beyond many is among them.
    let mut order: Vec<usize> = (0..all.len()).collect();
    order.sort_by(|a, b| sum(*b).total_cmp(&sum(*a)));
    let (mut foremost, mut behind): (Vec<[f64; 3]>, _) = (Vec::new(), vec![false; all.len()]);
    for index in order {
        let own = sized[index];
        behind[index] = foremost.iter().any(|other| other.iter().zip(&own).all(|(other, own)| other >= own));
        if !behind[index] && foremost.len() < FOREMOST {
            foremost.push(own);
        }
    }
    behind
}

/// A positive definite matrix by its Cholesky factor, the lower triangle by rows.
pub struct Root(Vec<f64>);

impl Root {
    /// Of the lower triangle of a matrix.
    ///
    /// # Errors
    /// What stands for the threshold of a matrix that is not positive definite: infinity, or what is not a number.
    pub fn new(lower: Vec<f64>) -> Result<Root, f64> {
        let mut rows = lower;
        let at = |i: usize, k: usize| i * (i + 1) / 2 + k;
        let mut i = 0;
        while at(i, 0) < rows.len() {
            for k in 0..=i {
                let sum: f64 = (0..k).map(|m| rows[at(i, m)] * rows[at(k, m)]).sum();
                let rest = rows[at(i, k)] - sum;
                rows[at(i, k)] = match k < i {
                    true => rest / rows[at(k, k)],
                    false if rest > 0.0 => rest.sqrt(),
                    false => return Err(if rest.is_nan() { f64::NAN } else { f64::INFINITY }),
                };
            }
            i += 1;
        }
        Ok(Root(rows))
    }

    /// The solution of `R s = v` for the factor R, of which `|s|^2 = v' G^-1 v`, in the place of what is in `solved`.
    fn solve(&self, v: impl Iterator<Item = f64>, solved: &mut Vec<f64>) {
        solved.clear();
        let mut rows = self.0.as_slice();
        for (i, value) in v.enumerate() {
            let (row, rest) = rows.split_at(i + 1);
            solved.push((value - dot(row, solved)) / row[i]);
            rows = rest;
        }
    }

    fn solved(&self, v: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut solved = Vec::with_capacity(v.size_hint().0);
        self.solve(v, &mut solved);
        solved
    }

    /// Half of `v' G^-1 v` of a column that does not change with sigma.
    pub fn half_square(&self, column: &[f64]) -> f64 {
        let solved = self.solved(column.iter().copied());
        0.5 * dot(&solved, &solved)
    }

    /// Half of `v' G^-1 v`; with an input gain the sigma with `v(sigma)' G^-1 v(sigma) <= 2 sigma` at both ends. A search looks
    /// some million times: `solved` is room for what is solved, and holds nothing.
    pub fn thresholds(&self, column: &Column, solved: &mut Vec<f64>) -> Thresholds {
        self.solve(column.fixed.iter().copied(), solved);
        let square = dot(solved, solved);
        let Some(moved) = column.moved else { return Thresholds::from(0.5 * square) };
        // Of the last unit vector the last entry alone is left: one over the last one of the factor.
        let last = self.0.last().map_or(f64::NAN, |last| last.recip());
        let beside = solved.last().map_or(f64::NAN, |entry| entry * last);
        let at_end = |by: f64| {
            // square + 2 half sigma + curved sigma^2 <= 2 sigma.
            let (half, curved) = (1.0 - beside * by, by * by * last * last);
            let discriminant = half * half - square * curved;
            if !(half > 0.0 && discriminant >= 0.0) {
                let undefined = half.is_nan() || discriminant.is_nan();
                return Thresholds::from(if undefined { f64::NAN } else { f64::INFINITY });
            }
            let root = half + discriminant.sqrt();
            Thresholds { least: square / root, largest: root / curved }
        };
        at_end(moved[0]).and(at_end(moved[1])).and(column.larger)
    }

    /// The least of them.
    pub fn threshold(&self, column: &Column, solved: &mut Vec<f64>) -> f64 {
        self.thresholds(column, solved).value()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of many points a few are left, and the least margin is the same to the last bit, at any k_p and threshold.
    #[test]
    fn points_that_others_are_beyond_change_no_margin() {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut point = || EnergyAt { of_y: random(), between: random() - 0.5, of_e: random() - 0.5, moves: None };
        let all: Vec<EnergyAt> = (0..500).map(|_| point()).collect();
        let front = EnergyAt::front(all.clone());
        assert!(front.len() > 1 && front.len() < 100, "{}", front.len());
        let least = |points: &[EnergyAt], k_p: f64, value: f64| {
            points.iter().map(|point| point.margin(k_p, value)).fold(f64::INFINITY, f64::min)
        };
        for (k_p, value) in [(0.5, 0.1), (2.0, 0.3), (2.0, 1.0), (1.0, 20.0)] {
            assert_eq!(least(&front, k_p, value), least(&all, k_p, value), "{k_p} {value}");
        }
        // With an input gain, whichever side of 1 its ends are on.
        for moves in [[-0.1, 0.2], [0.2, -0.1], [0.1, 0.2], [-0.2, -0.1]] {
            let moved: Vec<EnergyAt> = all.iter().map(|at| EnergyAt { moves: Some(moves), ..*at }).collect();
            let front = EnergyAt::front(moved.clone());
            assert!(front.len() > 1 && front.len() < 250, "{}", front.len());
            for (k_p, value) in [(0.5, 0.1), (2.0, 0.3), (2.0, 1.0), (1.0, 20.0), (3.0, 5.0)] {
                assert_eq!(least(&front, k_p, value), least(&moved, k_p, value), "{moves:?} {k_p} {value}");
            }
        }
        let [undefined, infinite] = [f64::NAN, f64::INFINITY].map(|of_y| {
            let one = EnergyAt { of_y, ..all[0] };
            EnergyAt::front(all.iter().copied().chain([one]).collect()).len()
        });
        assert_eq!([undefined, infinite], [all.len() + 1; 2]);
    }
}
