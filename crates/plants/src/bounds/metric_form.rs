//! The matrix of a metric over the derivatives (derivation, 13.7): of (E), whose metric has no p, and of the two of (Jm).

use super::PRECISION;
use super::centred::{Centred, negated};
use super::decide::Values;
use super::definite::SymmetricValues;
use super::inequality::moved_by;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::Metric;

/// The numbers of the matrix of one metric.
pub(super) struct MetricForm {
    pub(super) metric: Metric,
    /// The threshold times p of the near metric; 0 where there is none.
    pub(super) pulled: Vec<Rational>,
    /// The corner of e, without what the derivatives take from it.
    pub(super) of_e: Rational,
    /// What d is moved by; 0 without an input gain.
    pub(super) moved: Rational,
}

impl MetricForm {
    /// `[[-(P J + J'P) - c_x I, pulled - P g - J'p, -p - (k_p/2) r'], [., of_e - 2 p'g - c_e, -w - (k_p/2) d], [., ., k_p - c_y]]` in
    /// (x, e, y), in the coordinates y of the states.
    pub(super) fn matrix(&self, values: &Values<'_>) -> Option<SymmetricValues> {
        let MetricForm { metric: Metric { matrix: p, cross, weight, k_p, c_x, c_e, c_y }, pulled, of_e, moved } = self;
        let frame = values.frame;
        let region = values.engine.region();
        let half_k_p = Enclosure::from_rational(k_p, PRECISION) / 2;
        // [[f_x, f_e], [q_x, q_e]] in the coordinates x.
        let mut of_f = values.matrix();
        let mut of_q = of_f.pop()?;
        let n = of_f.len();
        let slope = moved_by(frame, of_q.pop()?, moved);
        let column: Vec<Vec<Centred>> = of_f.iter_mut().map(|row| row.split_off(n)).collect();
        let jacobian = values.product(region.matrix(), &values.product(region.inverse(), &of_f, false), true);
        let column = values.product(region.inverse(), &column, false);
        let row = values.product(region.matrix(), &[of_q], true).concat();

        let mut entries = Vec::new();
        let turned = values.product(p, &jacobian, false);
        let upper = (0..n).flat_map(|i| (i..n).map(move |j| (i, j)));
        entries.extend(upper.map(|(i, j)| {
            let sum = frame.add(&turned[i][j], &turned[j][i]);
            let sum = if i == j { frame.add(&sum, &frame.rational(c_x)) } else { sum };
            (i, j, negated(&sum))
        }));
        let driven = values.product(p, &column, false).concat();
        let minus_pulled = |i: usize| frame.rational(&Rational::from(-&pulled[i]));
        let mut of_e_and_x: Vec<Centred> =
            driven.into_iter().enumerate().map(|(i, v)| frame.add(&v, &minus_pulled(i))).collect();
        let mut corner = frame.rational(&Rational::from(of_e - c_e));
        let mut of_y_and_x: Vec<Centred> = row.iter().map(|slope| frame.scale(slope, &half_k_p)).collect();
        if cross.iter().any(|entry| *entry != 0) {
            // p'J, by columns, and p'g.
            let turned = row_times(values, cross, &jacobian);
            of_e_and_x = of_e_and_x.iter().zip(&turned).map(|(value, turned)| frame.add(value, turned)).collect();
            of_y_and_x = of_y_and_x.iter().zip(cross).map(|(value, p)| frame.add(value, &frame.rational(p))).collect();
            let pushed = row_times(values, cross, &column).pop()?;
            corner = frame.add(&corner, &negated(&frame.add(&pushed, &pushed)));
        }
        entries.extend(of_e_and_x.iter().enumerate().map(|(i, value)| (i, n, negated(value))));
        entries.extend(of_y_and_x.iter().enumerate().map(|(i, value)| (i, n + 1, negated(value))));
        entries.push((n, n, corner));
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
