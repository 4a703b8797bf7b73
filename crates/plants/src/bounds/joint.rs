//! The joint inequality (Jm) of existence or of stability (derivation, 13.7): decided with enclosures by subdivision.

use super::PRECISION;
use super::centred::{Centred, negated};
use super::decide::{Decision, Values};
use super::definite::SymmetricValues;
use super::engine::Engine;
use super::quantity::Part;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_lang::spec::{JointInequality, JointStability, Level, Metric};
use sigmastar_matrix::is_positive_definite;

const FALSE: Decision = Decision { truth: Truth::False, boxes: 0 };

impl Engine {
    /// Decides a joint inequality, with so many boxes for each metric at most.
    ///
    /// Guarantee: `True` only if, for every t, every point of `|y| <= X`, `|e| <= E` around any x_0 within r of xb, and the
    /// derivatives of f and q there in the coordinates y, both matrices of [`JointInequality`] are positive definite, both P are
    /// symmetric of the order of the plant, k_p, c_x, c_e and c_y are positive, w of the far metric is not negative and its p is 0.
    /// `False` only if it is not so at a point, or a number is not. For the caller to prove: what [`Engine::decide`] leaves to him.
    #[must_use]
    pub fn decide_joint(&self, inequality: &JointInequality, effort: usize) -> Decision {
        let JointInequality { x, e, value, near, far } = inequality;
        let fits = |metric: &Metric| {
            let Metric { matrix, cross, k_p, c_x, c_e, c_y, .. } = metric;
            let is_symmetric = matrix.len() == self.states()
                && matrix.iter().all(|row| row.len() == self.states())
                && (0..self.states()).all(|i| (0..i).all(|j| matrix[i][j] == matrix[j][i]));
            is_symmetric && cross.len() == self.states() && [k_p, c_x, c_e, c_y].into_iter().all(|number| *number > 0)
        };
        let far_fits = far.weight >= 0 && far.cross.iter().all(|entry| *entry == 0);
        if !fits(near) || !fits(far) || !far_fits || *value <= 0 {
            return FALSE;
        }
        if *x < 0 || *e < 0 {
            return Decision { truth: Truth::Undecided, boxes: 0 };
        }
        let sum = Rational::from(&near.weight + &far.weight);
        let [of_near, of_far] = [(near, &near.weight), (far, &sum)].map(|(metric, of_e)| Form {
            metric,
            pulled: near.cross.iter().map(|entry| Rational::from(entry * value)).collect(),
            of_e: Rational::from(of_e * value) * 2,
        });
        let first = self.decide_part(Part::All, [x, e], effort, |values| of_near.matrix(values));
        if !first.truth.is_true() {
            return first;
        }
        let second = self.decide_part(Part::All, [x, e], effort, |values| of_far.matrix(values));
        Decision { boxes: first.boxes + second.boxes, ..second }
    }

    /// The same of one that proves stability.
    ///
    /// Guarantee: as [`Engine::decide_joint`], and for both metrics, of which `Pi` is positive definite, `P <= p_up I`,
    /// `Pi >= diag(x_low I, 0)` and `Pi >= diag(0, e_low)` with x_low and e_low positive.
    #[must_use]
    pub fn decide_joint_stability(&self, joint: &JointStability, effort: usize) -> Decision {
        let JointStability { inequality, levels } = joint;
        let decision = self.decide_joint(inequality, effort);
        let hold = || inequality.metrics().into_iter().zip(levels).all(|(metric, level)| lies_between(metric, level));
        if decision.truth.is_true() && !hold() { FALSE } else { decision }
    }
}

/// Whether a metric is strictly between what a level says.
fn lies_between(Metric { matrix, cross, weight, .. }: &Metric, Level { p_up, x_low, e_low }: &Level) -> bool {
    let n = matrix.len();
    let less = |x: &Rational, e: &Rational| {
        let entry = |i: usize, j: usize| match (i < n, j < n) {
            (true, true) if i == j => Rational::from(&matrix[i][j] - x),
            (true, true) => matrix[i][j].clone(),
            (false, false) => Rational::from(weight - e),
            _ => cross[i.min(j)].clone(),
        };
        (0..=n).map(|i| (0..=n).map(|j| entry(i, j)).collect()).collect::<Vec<Vec<Rational>>>()
    };
    let zero = Rational::new();
    let above = |i: usize, j: usize| (if i == j { p_up.clone() } else { Rational::new() }) - &matrix[i][j];
    let above: Vec<Vec<Rational>> = (0..n).map(|i| (0..n).map(|j| above(i, j)).collect()).collect();
    *x_low > 0
        && *e_low > 0
        && is_positive_definite(&above)
        && is_positive_definite(&less(x_low, &zero))
        && is_positive_definite(&less(&zero, e_low))
}

/// The numbers of the matrix of one metric.
struct Form<'a> {
    metric: &'a Metric,
    /// The threshold times p of the near metric.
    pulled: Vec<Rational>,
    /// The corner of e, without what the derivatives take from it.
    of_e: Rational,
}

impl Form<'_> {
    /// In (x, e, y): with a p of its own the metric of the threshold, without one that towards which it moves.
    fn matrix(&self, values: &Values<'_>) -> Option<SymmetricValues> {
        let Form { metric: Metric { matrix: p, cross, weight, k_p, c_x, c_e, c_y }, pulled, of_e } = self;
        let frame = values.frame;
        let region = &values.engine.region;
        let half_k_p = Enclosure::from_rational(k_p, PRECISION) / 2;
        // [[f_x, f_e], [q_x, q_e]] in the coordinates x.
        let mut of_f = values.matrix();
        let mut of_q = of_f.pop()?;
        let n = of_f.len();
        let slope = of_q.pop()?;
        let column: Vec<Vec<Centred>> = of_f.iter_mut().map(|row| row.split_off(n)).collect();
        let jacobian = values.product(region.matrix(), &values.product(region.inverse(), &of_f, false), true);
        let column = values.product(region.inverse(), &column, false);
        let row = values.product(region.matrix(), &[of_q], true).concat();

        let mut entries = Vec::new();
        let moved = values.product(p, &jacobian, false);
        let upper = (0..n).flat_map(|i| (i..n).map(move |j| (i, j)));
        entries.extend(upper.map(|(i, j)| {
            let sum = frame.add(&moved[i][j], &moved[j][i]);
            let sum = if i == j { frame.add(&sum, &frame.rational(c_x)) } else { sum };
            (i, j, negated(&sum))
        }));
        // p'J, by columns, and p'g.
        let of_joint = if n > 0 { row_times(values, cross, &jacobian) } else { Vec::new() };
        let pushed = if n > 0 { row_times(values, cross, &column).pop() } else { None };
        let driven = values.product(p, &column, false).concat();
        for i in 0..n {
            let sum = frame.add(&driven[i], &of_joint[i]);
            entries.push((i, n, negated(&frame.add(&sum, &frame.rational(&Rational::from(-&pulled[i]))))));
            let sum = frame.add(&frame.scale(&row[i], &half_k_p), &frame.rational(&cross[i]));
            entries.push((i, n + 1, negated(&sum)));
        }
        let corner = frame.rational(&Rational::from(of_e - c_e));
        let taken = pushed.map(|pushed| negated(&frame.add(&pushed, &pushed)));
        entries.push((n, n, taken.map_or_else(|| corner.clone(), |taken| frame.add(&corner, &taken))));
        entries.push((n, n + 1, negated(&frame.add(&frame.rational(weight), &frame.scale(&slope, &half_k_p)))));
        entries.push((n + 1, n + 1, frame.rational(&Rational::from(k_p - c_y))));
        Some(SymmetricValues { order: n + 2, entries })
    }
}

/// A row of exact numbers times a matrix.
fn row_times(values: &Values<'_>, row: &[Rational], matrix: &[Vec<Centred>]) -> Vec<Centred> {
    let frame = values.frame;
    let columns = matrix.first().map_or(0, Vec::len);
    let zero = || frame.constant(Enclosure::zero(PRECISION));
    let entry = |j: usize| {
        row.iter().zip(matrix).filter(|(factor, _)| **factor != 0).fold(zero(), |sum, (factor, entries)| {
            frame.add(&sum, &frame.scale(&entries[j], &Enclosure::from_rational(factor, PRECISION)))
        })
    };
    (0..columns).map(entry).collect()
}
