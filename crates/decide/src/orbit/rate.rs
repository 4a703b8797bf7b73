//! The contraction in a tube around the curve (derivation, 11.2): `P' + P J + J^T P <= -2 alpha P` with
//! `J = L^-1 f_x(t, xb + L v, 0) L` for all t and all `|v| <= rho`.
//!
//! On a cell of half-width h (in periods) and for one v, the matrix `Q = -(P' + P J + J^T P) - 2 alpha P` along `xb(t) + L v` is
//! `A + d B + d^2 R` with d in [-h, h] (Taylor's formula, entry by entry). A + d B is positive definite if it is at both ends;
//! the row sums of the bounds of h^2 |R_ij| are taken from the diagonal (2 |v_i v_j| <= v_i^2 + v_j^2). The series are computed
//! for all v at once: v_i enters the constant term as an interval. Cells that are not proved are halved. The members of a family
//! are taken in the same way, all at once, or half of them at a time where that does not do.

use super::cells::Wave;
use super::curve::{Curve, PRECISION};
use super::defect::{slope, weigh};
use super::linear::norm;
use super::members::{Members, ParameterBox};
use super::recurrences::{combine, mul};
use super::taylor::Taylor;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::parallel;
use sigmastar_lang::expr::Walk;
use sigmastar_lang::spec::Constant;
use sigmastar_matrix::{ScaledMatrix, Symmetric};

/// The order of the rest in t.
const ORDER: usize = 2;

/// Powers of two that the number of cells runs through.
const CELLS: std::ops::RangeInclusive<u32> = 4..=11;

/// What a proof may cost: the cells that are examined, times the cube of the order and what a cell costs besides.
const MAX_COST: usize = 2_000_000;
const CELL_OVERHEAD: usize = 200;

/// How often the parameters of a family are halved on a cell, at most.
const HALVINGS: usize = 6;

/// What the proof of a rate needs besides the rate and the tube.
pub(super) struct Contraction<'a> {
    pub(super) period: &'a Constant,
    pub(super) members: &'a Members,
    /// f, and then its derivatives with respect to the states, row by row.
    pub(super) walk: &'a Walk,
    pub(super) l: &'a [Vec<Enclosure>],
    pub(super) inverse: &'a [Vec<Enclosure>],
    /// P(t), symmetric.
    pub(super) p: &'a Symmetric<Wave>,
}

/// How a cell went.
enum Outcome {
    Proved,
    /// Not proved, and not refuted at its middle.
    Open,
    /// Not proved at its middle alone: no halving helps.
    Fails,
    /// f may not be smooth in the tube.
    NotSmooth,
}

impl Contraction<'_> {
    /// Proves the rate in the tube.
    ///
    /// Guarantee: if `Ok`, f is smooth at every point of the tube, and the matrix inequality holds there for every t.
    ///
    /// # Errors
    /// Where in the period (s = t/T) it is not proved, in words.
    pub(super) fn prove(&self, alpha: &Enclosure, rho: &Enclosure) -> Result<(), String> {
        let reach: Vec<Enclosure> = self.l.iter().map(|row| norm(row.iter().cloned(), PRECISION) * rho).collect();
        let first = 1_usize << *CELLS.start();
        let mut pending: Vec<usize> = (0..first).collect();
        let cell_cost = self.l.len().pow(3) + CELL_OVERHEAD;
        let mut left = MAX_COST;
        for exponent in CELLS {
            let Some(rest) = left.checked_sub(pending.len() * cell_cost) else { break };
            left = rest;
            let curve = Curve::new(self.members, self.p.entries().iter(), self.period, exponent, ORDER + 1);
            // Level by level, so that what is examined does not depend on the number of threads.
            let outcomes: Vec<Outcome> =
                parallel::map(&pending, |cell| self.on_cell(&curve, *cell, alpha, &reach, None));
            let place = |at: usize| (pending[at] as f64 + 0.5) / curve.cells.count as f64;
            if let Some(at) = outcomes.iter().position(|outcome| matches!(outcome, Outcome::Fails)) {
                return Err(format!("P' + P J + J^T P <= -2 alpha P is not proved at t/T = {}", place(at)));
            }
            let last = exponent == *CELLS.end();
            if let Some(at) = outcomes.iter().position(|outcome| last && matches!(outcome, Outcome::NotSmooth)) {
                return Err(format!("f may not be smooth near t/T = {}", place(at)));
            }
            let open = pending.iter().zip(&outcomes).filter(|(_, outcome)| !matches!(outcome, Outcome::Proved));
            let next: Vec<usize> = open.flat_map(|(cell, _)| [2 * cell, 2 * cell + 1]).collect();
            if next.is_empty() {
                return Ok(());
            }
            pending = next;
        }
        Err("P' + P J + J^T P <= -2 alpha P is not proved on cells of the period as small as are tried".to_owned())
    }

    /// On a cell, and for the members with these parameters, all in the place of none.
    fn on_cell(
        &self,
        curve: &Curve,
        cell: usize,
        alpha: &Enclosure,
        reach: &[Enclosure],
        some: Option<(&ParameterBox, usize)>,
    ) -> Outcome {
        let (parameters, halvings) = some.unwrap_or((&self.members.parameters, HALVINGS));
        let together = self.at_once(curve, cell, alpha, reach, parameters);
        let Some(halves) = parameters.halves().filter(|_| halvings > 0 && matches!(together, Outcome::Fails)) else {
            return together;
        };
        let mut outcome = Outcome::Proved;
        for half in &halves {
            match self.on_cell(curve, cell, alpha, reach, Some((half, halvings - 1))) {
                Outcome::Proved => {}
                Outcome::Open => outcome = Outcome::Open,
                other => return other,
            }
        }
        outcome
    }

    fn at_once(
        &self,
        curve: &Curve,
        cell: usize,
        alpha: &Enclosure,
        reach: &[Enclosure],
        parameters: &ParameterBox,
    ) -> Outcome {
        let n = self.l.len();
        let own = curve.states(cell, ORDER);
        let mut states = curve.of_members(&own, &curve.sensitivities(cell, ORDER), parameters);
        for series in &mut states {
            for (component, reach) in series.iter_mut().zip(reach) {
                component[0] = &component[0] + reach.negate().hull(reach);
            }
        }
        let mut values = curve.along(self.walk, cell, (&states, &parameters.values), ORDER);
        if !values.iter().flatten().flatten().all(Enclosure::is_defined) {
            return Outcome::NotSmooth;
        }
        for series in &mut values {
            series.drain(..n);
        }
        let elapsed = parameters.elapsed(&curve.period);
        let p = self.p.map(|_, _, wave| curve.cells.expand(wave, cell, ORDER + 1));
        let [middle, over] = [0, 1].map(|which| {
            let p = p.map(|_, _, series| series[which].clone());
            self.decay(&values[which], &p, alpha, &elapsed)
        });
        let half = &curve.cells.half;
        let zero = Enclosure::zero(PRECISION);
        let at = |series: &Taylor, power: usize| series.get(power).cloned().unwrap_or_else(|| zero.clone());
        let definite = |end: Option<i64>| {
            let value = middle.map(|_, _, series| match end {
                None => at(series, 0),
                Some(sign) => at(series, 0) + at(series, 1) * half * sign,
            });
            let taken = |i: usize| match end {
                None => zero.clone(),
                Some(_) => (0..n).fold(zero.clone(), |sum, j| sum + at(over.at(i, j), ORDER).abs()) * half.sqr(),
            };
            // The least diagonal: wide enclosures, as those of a clock, are beyond the scale of their middle.
            let entry = |i: usize, j: usize| match i == j {
                true => (taken(i) - value.at(i, i)).ceiling().negate(),
                false => value.at(i, j).clone(),
            };
            ScaledMatrix::from_enclosures(n, entry).is_some_and(|matrix| matrix.is_positive_definite().is_true())
        };
        if definite(Some(1)) && definite(Some(-1)) {
            Outcome::Proved
        } else if definite(None) {
            Outcome::Open
        } else {
            Outcome::Fails
        }
    }

    /// `-(P' + P J + J^T P) - 2 alpha P` as series, from those of the derivatives of f.
    fn decay(
        &self,
        jacobian: &[Taylor],
        p: &Symmetric<Taylor>,
        alpha: &Enclosure,
        period: &Enclosure,
    ) -> Symmetric<Taylor> {
        let n = self.l.len();
        // In the coordinates y: L^-1 f_x L.
        let left: Vec<Vec<Taylor>> = (0..n)
            .map(|i| (0..n).map(|m| weigh((0..n).map(|k| (&self.inverse[i][k], &jacobian[k * n + m])))).collect())
            .collect();
        let rows: Vec<Vec<Taylor>> =
            (0..n).map(|i| (0..n).map(|j| weigh((0..n).map(|m| (&self.l[m][j], &left[i][m])))).collect()).collect();
        Symmetric::from_fn(n, |i, j| {
            let mut sum =
                combine(&slope(p.at(i, j), period), &p.at(i, j).iter().map(|c| c * alpha * 2).collect::<Taylor>(), 1);
            for (k, row) in rows.iter().enumerate() {
                sum = combine(&sum, &mul(p.at(i, k), &row[j], ORDER), 1);
                sum = combine(&sum, &mul(p.at(k, j), &row[i], ORDER), 1);
            }
            sum.iter().map(Enclosure::negate).collect()
        })
    }
}
