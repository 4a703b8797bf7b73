//! Rule: existence of the periodic solution without a small gain, by a matrix inequality over the derivatives of a plant
//! (docs/mathematics.md, section 13.7, (E), on the straight path).
//!
//! The inequality, in (x, e, y), at every t and every point of `|y| <= X`, `|e| <= E`, with J, g, r, d at that one point:
//! `[-(P J + J'P) - c_x I, -P g, -(k_p/2) r'; ., 2 threshold, -1 - (k_p/2) d; ., ., k_p - c_y] >= 0`. P is symmetric, of any sign.
//!
//! What it says of a solution. Let 0 <= l <= 1, and let (x, e, zeta) be a T-periodic solution in `|x| <= X`, `|e| <= E` of the loop
//! with `l q_0` in the place of `q_0 = q(t,0,0)`. The inequality is affine in (J, g, r, d), so it holds of their averages on the
//! segment from (0,0) to (x,e). With y = q + mu s the derivative of `x'P x + e^2 + (k_p mu/2)|zeta|_N^2` has the mean 0, so
//! `c_x rms(x)^2 + 2 (sigma - threshold) rms(e)^2 + c_y rms(y)^2 <= k_p mean(y l q_0) <= k_p Q_m rms(y)`: y has the mean 0 (the
//! integrator), so `q_0` counts without its mean, and `Q_m = sqrt(2 sum_{k>=1} C_k^2) + r_0`. Hence [`Answer`].
//!
//! With an input gain (section 13.1) `d + (1-b) threshold` stands in the place of d, at both ends of b, and `b k_p mu/2` is the weight of
//! `|zeta|_N^2`, with y = q + (1-b) sigma e + b mu s: the mean is the same, and e' = y - sigma e is. At `threshold/l`,
//! 0 < l <= 1, with l k_p, the form is in `(x/sqrt(l), e/sqrt(l), y sqrt(l))` l times the one at the threshold, and (1 - l) times that of
//! e and y with d = 0 besides. So with E4 it is not below `diag(c_x, 0, l c_y)`: rms(y) and rms(x) are bounded as at the threshold, and e by y.
//!
//! In the joint form there are two metrics (`metric`), of any sign, in the place of P. At a gain `sigma' >= threshold` the one between them
//! has `c_x rms(x)^2 + c_e rms(e)^2 + c_y rms(y)^2 <= k_p Q_m rms(y)` in the same way. The threshold may be sigma itself: c_e > 0 has the part of
//! what a gain above it leaves. The rest is the same, for of P and w no more is used than that.
//!
//! Guarantee: with all that `covers` and `conditions` say, and the inequality proved of the plant's formulas (the crate `proofs-plants` does), there is for
//! every n_o and every sigma' >= sigma a T-periodic solution with sup|x| <= X_p, sup|e| <= E_p, rms(x) <= r_x, rms(e) <= r_e,
//! rms(e') <= r_d, and all that `mean_squares` says of one. For the linear loop with the coefficients of any (x, e) in that box has one
//! periodic answer (with `q_0` = 0 it is 0), which is continuous in them, and its answers to `l q_0` are bounded in H1; by Leray and
//! Schauder it is enough that no solution with 0 < l < 1 has sup|x| = X_p or sup|e| = E_p. Its root mean squares rho satisfy rho <= G(rho),
//! with the concave G of `mean_squares`, and S1c, S2b, S2c say G(r) < r, so rho < r as there. Then S1b and S2 keep it inside.
//! Strictness matters in all five. b_q_rms and b_qt_rms are of q itself and say nothing for l < 1: they are not used.

use super::inequality::{above_0, not_above, place, symmetric};
use super::metric::{Answer, Metric, Metrics};
use crate::data::Data;
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::verdict::{Condition, Outcome, Relation};
use rug::Rational;

/// The name of the rule.
pub const RULE: &str = "existence inequality";

/// The numbers of the inequality.
#[derive(Clone, Debug)]
pub struct Existence {
    pub pointer: String,
    pub x: Rational,
    pub e: Rational,
    pub threshold: Rational,
    pub form: Form,
}

/// Which matrices there are.
#[derive(Clone, Debug)]
pub enum Form {
    /// One, with w = 1 and c_e = 0 at the threshold: the gain above it is what c_e is made of.
    Block(Metric),
    /// Two, for the threshold and for every larger gain.
    Joint(Box<Metrics>),
}

impl Existence {
    /// Reads the part `existence_inequality`; it is joint where it has a near metric.
    pub fn read(field: &Field<'_>) -> Outcome<Existence> {
        field.object(|fields| {
            let form = match fields.has("near") {
                true => Form::Joint(Box::new(Metrics::read(fields, |_| Ok(()))?.0)),
                false => Form::Block(block(fields)?),
            };
            let [x, e] = place(fields)?;
            let [threshold] = above_0(fields, ["sigma"])?;
            Ok(Existence { pointer: field.pointer.clone(), x, e, threshold, form })
        })
    }

    /// The place of two metrics, where there are two.
    pub fn joint(&self) -> Option<&String> {
        matches!(self.form, Form::Joint(_)).then_some(&self.pointer)
    }

    /// E4, for a gain: with 0 for d the part of e and y is not below `diag(0, c_y)`.
    fn undamped(&self, d: &Data<'_>) -> Option<Condition> {
        let (Some(gain), Form::Block(metric)) = (&d.gain, &self.form) else { return None };
        let [k_p, c_y, threshold] = [&metric.k_p, &metric.least[2], &self.threshold].map(|value| d.number(value));
        let [undamped, room] = gain.undamped(&(k_p / 2), &threshold);
        let what = "(1 + (k_p/2) (1-b) threshold)^2 <= 2 threshold (k_p - c_y) at both ends of b";
        Some(Condition::at_most("E4", what, undamped, room - threshold * c_y * 2))
    }

    /// At the gain sigma and every larger one, with Q_m. In the block form c_e is `2 (sigma - threshold)`, and nothing is known of rms(e)
    /// where the threshold is not below sigma, or with an input gain.
    pub fn answer(&self, d: &Data<'_>, sigma: &Rational, oscillation: &Interval) -> Answer {
        match &self.form {
            Form::Joint(metrics) => metrics.answer(d, oscillation),
            Form::Block(metric) if sigma > &self.threshold && d.gain.is_none() => {
                metric.answer(d, oscillation, &(d.number(&Rational::from(sigma - &self.threshold)) * 2))
            }
            Form::Block(metric) => metric.answer(d, oscillation, &Interval::undefined(d.precision)),
        }
    }

    /// E3, strict where nothing but the gain above the threshold makes c_e; and what c_e is.
    fn exceeded(&self, d: &Data<'_>, sigma: &Rational) -> (Condition, &'static str) {
        match self.form {
            Form::Block(_) => {
                let [threshold, gain] = [&self.threshold, sigma].map(|value| d.number(value));
                let what = "threshold of the existence inequality < sigma";
                (Condition::less("E3", what, threshold, gain), "2 (sigma - threshold)")
            }
            Form::Joint(_) => {
                let what = "threshold of the existence inequality - sigma".to_owned();
                (not_above(d, "E3", what, [&self.threshold, sigma]), "c_e")
            }
        }
    }

    /// E3, S1, and what stands in the place of S1b to S2c.
    pub fn conditions(
        &self,
        d: &Data<'_>,
        sigma: &Rational,
        contracts: Condition,
        sides: Sides<'_>,
        with_kap: bool,
    ) -> Vec<Condition> {
        let (enough, c_e) = self.exceeded(d, sigma);
        let mut conditions: Vec<Condition> = [enough].into_iter().chain(self.undamped(d)).chain([contracts]).collect();
        let [damped, damped_t] = if with_kap { ["g_k Rt, ", "Rt + kap r_e, "] } else { [""; 2] };
        let of_e = format!("k_p Q_m/(2 sqrt({c_e} c_y))");
        let what = [
            "(c/a_1) b_fe r_e, k_p Q_m/(2 sqrt(c_x c_y))".to_owned(),
            "bt R_q, tau R_1, sqrt(T r_e r_d), q_0 form, bt r_y".to_owned(),
            format!("R_q/sg, R_1/(Om sg), q_0 form, {damped}r_y/sg, {of_e}"),
            format!("R_q, R_1/sg, {damped_t}r_y"),
        ];
        conditions.extend(strictly(sides, what));
        conditions
    }
}

/// The one matrix, with w = 1.
fn block(fields: &mut Fields<'_>) -> Outcome<Metric> {
    let p = symmetric(&fields.required("P")?)?;
    let [k_p, c_x, c_y] = above_0(fields, ["k_p", "c_x", "c_y"])?;
    Ok(Metric { p, w: Rational::from(1), k_p, least: [c_x, Rational::new(), c_y] })
}

/// What is known of a solution at r, and what has to be above it: of sup|x|, rms(x), sup|e|, rms(e), rms(e').
pub type Sides<'s> = [[&'s Interval; 2]; 5];

/// S1b to S2c; `what`: the left sides of the last four.
pub(super) fn of_periodic(relation: Relation, sides: Sides<'_>, what: [String; 4]) -> impl Iterator<Item = Condition> {
    let [rms_x, sup_e, rms_e, rms_e_t] = what;
    let names = [
        ("S1b", "min{(c/a_1) b_fe E_p, K2(a_1) b_fe r_e}".to_owned(), "X_p"),
        ("S1c", rms_x, "r_x"),
        ("S2", sup_e, "E_p"),
        ("S2b", rms_e, "r_e"),
        ("S2c", rms_e_t, "r_d"),
    ];
    names.into_iter().zip(sides).map(move |((id, what, end), [lhs, rhs])| {
        let what = format!("{what} {} {end}", relation.symbol());
        Condition { id, what, lhs: lhs.clone(), relation, rhs: rhs.clone() }
    })
}

/// S1b to S2c as strict conditions, with the bounds that the last four are the least of.
pub(super) fn strictly(sides: Sides<'_>, bounds: [String; 4]) -> impl Iterator<Item = Condition> {
    of_periodic(Relation::Less, sides, bounds.map(|bounds| format!("min{{{bounds}}}")))
}

/// E1 and E2: X_p and E_p lie where an inequality is proved, at X and E.
pub(super) fn covers(d: &Data<'_>, [x_p, e_p]: [&Rational; 2], [x, e]: [&Rational; 2]) -> [Condition; 2] {
    let within = |id, what: &str, ends| not_above(d, id, format!("{what} of the existence inequality"), ends);
    [within("E1", "X_p - X", [x_p, x]), within("E2", "E_p - E", [e_p, e])]
}
