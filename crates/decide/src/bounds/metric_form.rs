//! The matrix of a metric over the derivatives (derivation, 13.7): of (E), whose metric has no p, and of the two of (Jm).

use super::PRECISION;
use super::centred::{Centred, negated};
use super::decide::{InY, Values};
use super::definite::SymmetricValues;
use super::inequality::{in_x_and_y, moved_by, subtract};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::Metric;
use sigmastar_theory::evidence::Part;

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
        let half_k_p = Enclosure::from_rational(k_p, PRECISION) / 2;
        let InY { jacobian, column, row, slope } = values.in_y(Part::All)?;
        let n = row.len();
        let slope = moved_by(frame, slope?, moved);

        let mut entries = values.steady_decay(p, &jacobian, c_x);
        let driven = values.product(p, &column, false).concat();
        let minus_pulled = |i: usize| frame.rational(&Rational::from(-&pulled[i]));
        let mut of_e_and_x: Vec<Centred> =
            driven.into_iter().enumerate().map(|(i, v)| frame.add(&v, &minus_pulled(i))).collect();
        let mut corner = frame.rational(&Rational::from(of_e - c_e));
        let mut of_y_and_x: Vec<Centred> = row.iter().map(|slope| frame.scale(slope, &half_k_p)).collect();
        if cross.iter().any(|entry| *entry != 0) {
            // p'J and p'g.
            let times = |matrix: &[Vec<Centred>]| values.product(std::slice::from_ref(cross), matrix, false).concat();
            let turned = times(&jacobian);
            of_e_and_x = of_e_and_x.iter().zip(&turned).map(|(value, turned)| frame.add(value, turned)).collect();
            of_y_and_x = of_y_and_x.iter().zip(cross).map(|(value, p)| frame.add(value, &frame.rational(p))).collect();
            let pushed = times(&column).pop()?;
            corner = frame.add(&corner, &negated(&frame.add(&pushed, &pushed)));
        }
        entries.extend(of_e_and_x.iter().enumerate().map(|(i, value)| (i, n, negated(value))));
        entries.extend(of_y_and_x.iter().enumerate().map(|(i, value)| (i, n + 1, negated(value))));
        entries.push((n, n, corner));
        entries.push((n, n + 1, negated(&frame.add(&frame.rational(weight), &frame.scale(&slope, &half_k_p)))));
        entries.push((n + 1, n + 1, frame.rational(&Rational::from(k_p - c_y))));
        Some(SymmetricValues { order: n + 2, entries })
    }

    /// The first of (14.5a) less S, `[[-(P J + J'P) - c_x I, -(k_p/2) r'], [., k_p - c_y]] - S` in (x, y), from (J, r).
    pub(super) fn beyond(&self, s: &[Vec<Rational>], values: &Values<'_>) -> Option<SymmetricValues> {
        let Metric { matrix: p, k_p, c_x, c_y, .. } = &self.metric;
        let frame = values.frame;
        let half_k_p = Enclosure::from_rational(k_p, PRECISION) / 2;
        let InY { jacobian, row, .. } = values.in_y(Part::States)?;
        let n = row.len();
        let mut entries = values.steady_decay(p, &jacobian, c_x);
        entries.extend(row.iter().enumerate().map(|(i, slope)| (i, n, negated(&frame.scale(slope, &half_k_p)))));
        entries.push((n, n, frame.rational(&Rational::from(k_p - c_y))));
        subtract(frame, &mut entries, s);
        Some(SymmetricValues { order: n + 1, entries })
    }

    /// The second of (14.5a), `[[S, v], [v', of_e - c_e]]` in the order (x, e, y), from (g, d).
    pub(super) fn beside(&self, s: &[Vec<Rational>], values: &Values<'_>) -> Option<SymmetricValues> {
        let MetricForm { metric: Metric { matrix: p, weight, k_p, c_e, .. }, of_e, moved, .. } = self;
        let frame = values.frame;
        let half_k_p = Enclosure::from_rational(k_p, PRECISION) / 2;
        let InY { column, slope, .. } = values.in_y(Part::Error)?;
        let n = column.len();
        let slope = moved_by(frame, slope?, moved);
        let mut entries = in_x_and_y(frame, s);
        let driven = values.product(p, &column, false).concat();
        entries.extend(driven.iter().enumerate().map(|(i, value)| (i, n, negated(value))));
        entries.push((n, n, frame.rational(&Rational::from(of_e - c_e))));
        entries.push((n, n + 1, negated(&frame.add(&frame.rational(weight), &frame.scale(&slope, &half_k_p)))));
        Some(SymmetricValues { order: n + 2, entries })
    }
}
