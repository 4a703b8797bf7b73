//! Rule: stability and its level by two joint metrics, in the place of C5 and of the C4 of U (docs/mathematics.md, section 13.7, (Jm)).
//!
//! Guarantee: with `demand` and the conditions, and the two inequalities of `metric` proved of the plant's formulas (the crate
//! `proofs-plants` does), every solution from the claimed set converges to the periodic solution, at every gain from sigma on. For at
//! `sigma' = sigma_0/l` the V of the metric between the two falls in the error box, by `min c (|x|^2 + |e|^2 + y^2)` or more. At the start it
//! is at most the sum of the left sides of C4 and C4f with the shares l and 1 - l, because P, |p|, w and k_p are; on `|x| = D_x` and
//! `|e| = D_e` it is at least that of the right sides, because `Pi >= diag(x_low I, 0)` and `Pi >= diag(0, e_low)` are. So no solution
//! leaves the box. X_b, E_b and the sizes in C4 are those at sigma, which are no smaller at a larger gain. The two metrics may be scaled
//! in different ways.

use super::control;
use super::inequality::{above_0, demand_plant, not_above, place, reaches};
use super::metric::{Metric, Metrics};
use super::stability::ErrorBox;
use crate::data::Data;
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::matrix::{is_semidefinite, shifted};
use crate::verdict::{Condition, Outcome, demand};
use rug::Rational;

/// The name of the rule.
pub const RULE: &str = "joint inequality";

/// The part `joint_inequality`: where the inequalities are proved, the threshold sigma_0, and the metrics with their extents.
#[derive(Clone, Debug)]
pub struct Joint {
    pub pointer: String,
    pub x: Rational,
    pub e: Rational,
    pub threshold: Rational,
    pub metrics: Metrics,
    pub extents: [Extent; 2],
}

/// `P <= p_up I`, `Pi >= diag(x_low I, 0)` and `Pi >= diag(0, e_low)`. Without states the first two say nothing, so that p_up has to be
/// above 0 by itself.
#[derive(Clone, Debug)]
pub struct Extent {
    pub p_up: Rational,
    pub x_low: Rational,
    pub e_low: Rational,
}

impl Extent {
    fn read(fields: &mut Fields<'_>) -> Outcome<Extent> {
        let [p_up, x_low, e_low] = above_0(fields, ["P_up", "x_low", "e_low"])?;
        Ok(Extent { p_up, x_low, e_low })
    }

    /// Whether it is that of a metric, in exact arithmetic: the name of each of its numbers, and what that says.
    fn is_of(&self, metric: &Metric, cross: &[Rational]) -> [(&'static str, &'static str, bool); 3] {
        let (zero, one) = (Rational::new(), Rational::from(1));
        let below = shifted(&metric.p, &Rational::from(-1), &Rational::from(-&self.p_up));
        let above = |x_low: &Rational, e_low: &Rational| {
            let mut rows = shifted(&metric.p, &one, x_low);
            rows.iter_mut().zip(cross).for_each(|(row, entry)| row.push(entry.clone()));
            let last = cross.iter().cloned().chain([Rational::from(&metric.w - e_low)]);
            rows.push(last.collect());
            is_semidefinite(rows)
        };
        [
            ("P_up", "P <= P_up I", is_semidefinite(below)),
            ("x_low", "Pi >= diag(x_low I, 0)", above(&self.x_low, &zero)),
            ("e_low", "Pi >= diag(0, e_low)", above(&zero, &self.e_low)),
        ]
    }
}

impl Joint {
    /// Reads the part.
    pub fn read(field: &Field<'_>) -> Outcome<Joint> {
        field.object(|fields| {
            let (metrics, extents) = Metrics::read(fields, Extent::read)?;
            let [x, e] = place(fields)?;
            let [threshold] = above_0(fields, ["sigma"])?;
            Ok(Joint { pointer: field.pointer.clone(), x, e, threshold, metrics, extents })
        })
    }

    /// The names in the file of the metrics, each with its own p and extent.
    fn each(&self) -> [(&'static str, &Metric, Vec<Rational>, &Extent); 2] {
        let Metrics { near, far, cross } = &self.metrics;
        let [of_near, of_far] = &self.extents;
        let none = vec![Rational::new(); cross.len()];
        [("near", near, cross.clone(), of_near), ("far", far, none, of_far)]
    }

    /// It is about formulas, with a row for each state, and the extents are those of the metrics.
    pub fn demand(&self, d: &Data<'_>) -> Outcome<()> {
        let Some(plant) = &d.spec.plant else { return demand_plant(d, &self.pointer) };
        self.metrics.demand_order(plant.states, &self.pointer)?;
        let all = self.each().into_iter().flat_map(|(name, metric, cross, extent)| {
            extent
                .is_of(metric, &cross)
                .map(|(field, what, holds)| (format!("{}/{name}/{field}", self.pointer), what, holds))
        });
        all.into_iter().try_for_each(|(pointer, what, holds)| demand(Some(holds), RULE, &pointer, what))
    }

    /// C4 and C4f, of the near and the far metric, with dX, dE, dZ and the radii of the error box.
    pub fn levels(&self, d: &Data<'_>, [x, e, z]: &[Interval; 3], radii: [&Rational; 2]) -> [Condition; 2] {
        let [d_x, d_e] = radii.map(|value| d.number(value));
        let what = "P_up dX^2 + 2 |p| dX dE + w dE^2 + (k_p mu/2) dZ^2 < min{x_low D_x^2, e_low D_e^2}";
        let level = |(name, metric, cross, extent): (&str, &Metric, Vec<Rational>, &Extent)| {
            let [p_up, x_low, e_low, w, k_p] =
                [&extent.p_up, &extent.x_low, &extent.e_low, &metric.w, &metric.k_p].map(|value| d.number(value));
            let square = cross.iter().fold(Rational::new(), |sum, entry| sum + Rational::from(entry.square_ref()));
            let skew = d.number(&square).sqrt() * 2;
            let start = p_up * x.sqr() + skew * x * e + w * e.sqr() + k_p * &d.mu / 2 * z.sqr();
            let exit = (x_low * d_x.sqr()).min(&(e_low * d_e.sqr()));
            Condition::less(if name == "near" { "C4" } else { "C4f" }, format!("{what}, {name}"), start, exit)
        };
        self.each().map(level)
    }

    /// How far the control goes at sigma: of the metric between the two, at the share `l = sigma_0/sigma` of the near one, V at the start is
    /// at most that share of the left sides of C4 and C4f, and not below that of `e_low e^2 + (k_p mu/2)|zeta|_N^2`.
    pub fn transient(&self, d: &Data<'_>, [near, far]: &[Condition; 2], sigma: &Rational) -> Interval {
        let share = Rational::from(&self.threshold / sigma);
        let (of_near, of_far) = (d.number(&share), d.number(&(1 - share)));
        let between = |near: &Interval, far: &Interval| &of_near * near + &of_far * far;
        let of = |number: fn(&Metric, &Extent) -> Rational| {
            let [near, far] = self.each().map(|(_, metric, _, extent)| d.number(&number(metric, extent)));
            between(&near, &far)
        };
        let [e_low, k_p] = [of(|_, extent| extent.e_low.clone()), of(|metric, _| metric.k_p.clone())];
        let start = between(&near.lhs, &far.lhs);
        control::transient(d, [&d.number(sigma), &d.mu], [&e_low, &(k_p * &d.mu / 2)], &start)
    }

    /// C5x, C5e and C5s: the error box lies where the inequalities are proved, and the gain is not below their threshold. The last may
    /// be an equality: c_x, c_e and c_y are above 0.
    pub fn conditions(&self, d: &Data<'_>, error_box: &ErrorBox, sigma: &Rational) -> [Condition; 3] {
        let [of_x, of_e] = reaches(d, error_box, [&self.x, &self.e], RULE);
        let what = format!("threshold of the {RULE} - sigma");
        [of_x, of_e, not_above(d, "C5s", what, [&self.threshold, sigma])]
    }
}
