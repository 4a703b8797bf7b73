//! Rule: stability and its level by two joint metrics, in the place of C5 and of the C4 of U (docs/mathematics.md, section 13.7, (Jm)).
//!
//! Guarantee: with `demand_extents` and the conditions, and the two inequalities of `inequality` proved of the plant's formulas, every solution from
//! the claimed set converges to the periodic solution, at every gain from sigma on. For at
//! `sigma' = sigma_0/l` the V of the metric between the two falls in the error box, by `min c (|x|^2 + |e|^2 + y^2)` or more. At the start it
//! is at most the sum of the left sides of C4 and C4f with the shares l and 1 - l, because P, |p|, w and k_p are; on `|x| = D_x` and
//! `|e| = D_e` it is at least that of the right sides, because `Pi >= diag(x_low I, 0)` and `Pi >= diag(0, e_low)` are. So no solution
//! leaves the box. X_b, E_b and the sizes in C4 are those at sigma, which are no smaller at a larger gain. The two metrics may be scaled
//! in different ways.

use super::control;
use super::inequality::{Extent, Inequality, Metric, P};
use crate::data::Data;
use crate::interval::Interval;
use crate::matrix::{is_semidefinite, shifted};
use crate::verdict::{Condition, Outcome, demand};
use rug::Rational;

/// The near and the far metric of an inequality of stability, each with its extent.
pub type Pair<'i> = [(&'i Metric, &'i Extent); 2];

impl Extent {
    /// Whether it is that of a metric, in exact arithmetic: the name of each of its numbers, and what that says.
    pub fn is_of(&self, metric: &Metric) -> [(&'static str, &'static str, bool); 3] {
        let P::Own(p) = &metric.p else { return [("P_up", "P is of its own", false); 3] };
        let (zero, one) = (Rational::new(), Rational::from(1));
        let below = shifted(p, &Rational::from(-1), &Rational::from(-&self.p_up));
        let cross = |i: usize| metric.cross.get(i).unwrap_or(&zero).clone();
        let above = |x_low: &Rational, e_low: &Rational| {
            let mut rows = shifted(p, &one, x_low);
            rows.iter_mut().enumerate().for_each(|(i, row)| row.push(cross(i)));
            rows.push((0..p.len()).map(cross).chain([Rational::from(&metric.w - e_low)]).collect());
            is_semidefinite(rows)
        };
        [
            ("P_up", "P <= P_up I", is_semidefinite(below)),
            ("x_low", "Pi >= diag(x_low I, 0)", above(&self.x_low, &zero)),
            ("e_low", "Pi >= diag(0, e_low)", above(&zero, &self.e_low)),
        ]
    }
}

impl Inequality {
    /// The two metrics of stability, where there are two.
    pub fn pair(&self) -> Option<Pair<'_>> {
        let far = self.far.as_ref()?;
        Some([(&self.metric, self.metric.extent.as_ref()?), (far, far.extent.as_ref()?)])
    }

    /// The extents are those of the metrics.
    pub fn demand_extents(&self) -> Outcome<()> {
        for (name, (metric, extent)) in ["near", "far"].into_iter().zip(self.pair().into_iter().flatten()) {
            for (field, what, holds) in extent.is_of(metric) {
                demand(Some(holds), self.kind.rule(), &format!("{}/{name}/{field}", self.pointer), what)?;
            }
        }
        Ok(())
    }
}

/// `P_up dX^2 + 2 |p| dX dE + w dE^2 + (k_p b mu/2) dZ^2`: what V is at most that far from the periodic solution, at the gain b of the actuator.
pub fn start(d: &Data<'_>, (metric, extent): (&Metric, &Extent), [x, e, z]: &[Interval; 3], b: &Interval) -> Interval {
    let [p_up, w, half] = [&extent.p_up, &metric.w, &metric.half].map(|value| d.number(value));
    p_up * x.sqr() + size_of_cross(d, metric) * 2 * x * e + w * e.sqr() + half * b * &d.mu * z.sqr()
}

/// |p|.
pub fn size_of_cross(d: &Data<'_>, metric: &Metric) -> Interval {
    let square = metric.cross.iter().fold(Rational::new(), |sum, entry| sum + Rational::from(entry.square_ref()));
    d.number(&square).sqrt()
}

/// C4 and C4f, of the near and the far metric, with dX, dE, dZ and the radii of the error box.
pub fn levels(d: &Data<'_>, pair: Pair<'_>, reach: &[Interval; 3], radii: [&Rational; 2]) -> [Condition; 2] {
    let [d_x, d_e] = radii.map(|value| d.number(value));
    let level = |id, name, (metric, extent): (&Metric, &Extent)| {
        let [x_low, e_low] = [&extent.x_low, &extent.e_low].map(|value| d.number(value));
        let exit = (x_low * d_x.sqr()).min(&(e_low * d_e.sqr()));
        let what = "P_up dX^2 + 2 |p| dX dE + w dE^2 + (k_p mu/2) dZ^2 < min{x_low D_x^2, e_low D_e^2}";
        Condition::less(id, format!("{what}, {name}"), start(d, (metric, extent), reach, &d.int(1)), exit)
    };
    let [near, far] = pair;
    [level("C4", "near", near), level("C4f", "far", far)]
}

/// Of the metric between the two at sigma, with the threshold sigma_0 and the share `l = sigma_0/sigma` of the near one: what V at the start is at most,
/// that share of the left sides of C4 and C4f, and the e_low and `k_p mu/2` of which V is not below `e_low e^2 + (k_p mu/2)|zeta|_N^2`.
pub fn between(
    d: &Data<'_>,
    pair: Pair<'_>,
    [near, far]: [&Interval; 2],
    [threshold, sigma]: [&Rational; 2],
) -> [Interval; 3] {
    let share = Rational::from(threshold / sigma);
    let (of_near, of_far) = (d.number(&share), d.number(&(1 - share)));
    let between = |near: &Interval, far: &Interval| &of_near * near + &of_far * far;
    let of = |number: fn(&Metric, &Extent) -> Rational| {
        let [near, far] = pair.map(|(metric, extent)| d.number(&number(metric, extent)));
        between(&near, &far)
    };
    let [e_low, half] = [of(|_, extent| extent.e_low.clone()), of(|metric, _| metric.half.clone())];
    [between(near, far), e_low, half * &d.mu]
}

/// How far the control goes at sigma, with the threshold sigma_0 and the left sides of C4 and C4f.
pub fn transient(d: &Data<'_>, pair: Pair<'_>, [near, far]: &[Condition; 2], gains: [&Rational; 2]) -> Interval {
    let [start, e_low, h] = between(d, pair, [&near.lhs, &far.lhs], gains);
    control::transient(d, [&d.number(gains[1]), &d.mu], [&e_low, &h], (&start, &d.int(0)))
}
