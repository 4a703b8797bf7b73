//! Metrics of (x, e), and the two that serve a gain and every larger one together (docs/mathematics.md, section 13.7, (Jm)).
//!
//! A metric has the matrix `Pi = [P p; p' w]` and `k_p`: its function is `V = (x,e)'Pi(x,e) + (k_p mu/2)|zeta|_N^2`. Along the loop, with
//! y = q + mu s, -V' is the form at (x, e, y) of
//! `F_sigma(Pi, k_p) = [-(P J + J'P), -(P g - sigma p) - J'p, -p - (k_p/2) r'; ., 2 sigma w - 2 p'g, -w - (k_p/2) d; ., ., k_p]`.
//!
//! The near metric `Pi_1 = [P_1 p; p' w_1]`, `k_1` has `F_sigma_0 >= diag(c_x I, c_e, c_y)` at the threshold sigma_0. The far one, `P_2`, `w_2`, `k_2`
//! without p, has the same, with numbers of its own, of
//! `G = [-(P_2 J + J'P_2), -(P_2 g - sigma_0 p), -(k_2/2) r'; ., 2 sigma_0 (w_1 + w_2), -w_2 - (k_2/2) d; ., ., k_2]`.
//! At `sigma' = sigma_0/l`, `0 < l <= 1`, take `Pi = l Pi_1 + (1 - l) diag(P_2, w_2)` and `k_p = l k_1 + (1 - l) k_2`: entry by entry
//! `F_sigma' = l F_sigma_0 + (1 - l) G + diag(0, 2 sigma_0 w_2 (1 - l)^2/l, 0)`, so with `w_2 >= 0` F_sigma' is not below
//! `l diag(c_1) + (1 - l) diag(c_2)`. The two matrices prove the inequality for sigma_0 and for every larger gain.

use super::inequality::{above_0, number, symmetric};
use crate::data::Data;
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::matrix::Matrix;
use crate::verdict::{Outcome, bad};
use rug::Rational;

/// The numbers of a metric, but for p.
#[derive(Clone, Debug)]
pub struct Metric {
    /// P, by rows.
    pub p: Matrix,
    /// The weight of e^2.
    pub w: Rational,
    pub k_p: Rational,
    /// c_x, c_e, c_y: its matrix is not below the diagonal one of these.
    pub least: [Rational; 3],
}

/// The near and the far metric.
#[derive(Clone, Debug)]
pub struct Metrics {
    pub near: Metric,
    pub far: Metric,
    /// The p of the near one, as long as its P.
    pub cross: Vec<Rational>,
}

/// What a metric says of a periodic solution (docs/mathematics.md, section 13.7, (E)).
pub struct Answer {
    /// `k_p Q_m/(2 sqrt(c_x c_y))`.
    pub rms_x: Interval,
    /// `k_p Q_m/(2 sqrt(c_e c_y))`.
    pub rms_e: Interval,
    /// `r_y = k_p Q_m/c_y`; rms(e') too is not larger, nor sg rms(e), and sup|e| <= bt r_y.
    pub rms_y: Interval,
}

impl Metric {
    fn read(fields: &mut Fields<'_>, w: Rational) -> Outcome<Metric> {
        let p = symmetric(&fields.required("P")?)?;
        let [k_p, least @ ..] = above_0(fields, ["k_p", "c_x", "c_e", "c_y"])?;
        Ok(Metric { p, w, k_p, least })
    }

    /// That P has a row for each state.
    pub fn demand_order(&self, states: usize, pointer: &str) -> Outcome<()> {
        if self.p.len() == states { Ok(()) } else { bad(&format!("{pointer}/P"), "expected a row for each state") }
    }

    /// `c_x rms(x)^2 + c_e rms(e)^2 + c_y rms(y)^2 <= k_p Q_m rms(y)` bounds each of them, with Q_m and this c_e.
    pub fn answer(&self, d: &Data<'_>, oscillation: &Interval, c_e: &Interval) -> Answer {
        let [k_p, c_x, c_y] = [&self.k_p, &self.least[0], &self.least[2]].map(|value| d.number(value));
        let force = k_p * oscillation;
        let by = |weight: &Interval| &force / ((weight * &c_y).sqrt() * 2);
        Answer { rms_x: by(&c_x), rms_e: by(c_e), rms_y: &force / &c_y }
    }
}

impl Metrics {
    /// Takes `near` and `far` out of a part; what else each has is read by `rest`.
    pub fn read<T>(part: &mut Fields<'_>, rest: impl Fn(&mut Fields<'_>) -> Outcome<T>) -> Outcome<(Metrics, [T; 2])> {
        let (near, cross, of_near) = part.required("near")?.object(|fields| {
            let w = fields.number("w")?;
            let near = Metric::read(fields, w)?;
            let cross = fields.required("p")?;
            let numbers = cross.list(Field::rational)?;
            if numbers.len() != near.p.len() {
                return bad(&cross.pointer, "expected a number for each row of P");
            }
            Ok((near, numbers, rest(fields)?))
        })?;
        let (far, of_far) = part.required("far")?.object(|fields| {
            let w = number(fields, "w", false)?;
            Ok((Metric::read(fields, w)?, rest(fields)?))
        })?;
        Ok((Metrics { near, far, cross }, [of_near, of_far]))
    }

    /// That either P has a row for each state.
    pub fn demand_order(&self, states: usize, pointer: &str) -> Outcome<()> {
        let all = [("near", &self.near), ("far", &self.far)];
        all.into_iter().try_for_each(|(name, metric)| metric.demand_order(states, &format!("{pointer}/{name}")))
    }

    /// At every gain from the threshold on. A quotient of k_p, which is linear in l, by what is linear in l or concave, as `sqrt(c_x c_y)`
    /// is, and above 0, is nowhere larger than at one of the ends.
    pub fn answer(&self, d: &Data<'_>, oscillation: &Interval) -> Answer {
        let [near, far] =
            [&self.near, &self.far].map(|metric| metric.answer(d, oscillation, &d.number(&metric.least[1])));
        Answer {
            rms_x: near.rms_x.max(&far.rms_x),
            rms_e: near.rms_e.max(&far.rms_e),
            rms_y: near.rms_y.max(&far.rms_y),
        }
    }
}
