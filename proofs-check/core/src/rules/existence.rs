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
//! Guarantee: with all that `covers` and `conditions` say, and the inequality proved of the plant's formulas (the crate `proofs-plants` does), there is for
//! every n_o and every sigma' >= sigma a T-periodic solution with sup|x| <= X_p, sup|e| <= E_p, rms(x) <= r_x, rms(e) <= r_e,
//! rms(e') <= r_d, and all that `mean_squares` says of one. For the linear loop with the coefficients of any (x, e) in that box has one
//! periodic answer (with `q_0` = 0 it is 0), which is continuous in them, and its answers to `l q_0` are bounded in H1; by Leray and
//! Schauder it is enough that no solution with 0 < l < 1 has sup|x| = X_p or sup|e| = E_p. Its root mean squares rho satisfy rho <= G(rho),
//! with the concave G of `mean_squares`, and S1c, S2b, S2c say G(r) < r, so rho < r as there. Then S1b and S2 keep it inside.
//! Strictness matters in all five. b_q_rms and b_qt_rms are of q itself and say nothing for l < 1: they are not used.

use super::inequality::{number, symmetric};
use crate::data::Data;
use crate::interval::Interval;
use crate::json::Field;
use crate::verdict::{Condition, Outcome};
use rug::Rational;

/// The numbers of the inequality.
#[derive(Clone, Debug)]
pub struct Existence {
    pub pointer: String,
    pub x: Rational,
    pub e: Rational,
    /// P, by rows. That it has one for each state is seen where the formulas are.
    pub p: Vec<Vec<Rational>>,
    pub k_p: Rational,
    pub c_x: Rational,
    pub c_y: Rational,
    pub threshold: Rational,
}

/// What the inequality says of every such solution.
pub struct Answer {
    /// `k_p Q_m/(2 sqrt(c_x c_y))`.
    pub rms_x: Interval,
    /// `k_p Q_m/(2 sqrt(2 (sigma - threshold) c_y))`; undefined where the threshold is not below sigma.
    pub rms_e: Interval,
    /// `r_y = k_p Q_m/c_y`; rms(e') too is not larger, nor sg rms(e), and sup|e| <= bt r_y.
    pub rms_y: Interval,
}

impl Existence {
    /// Reads the part `existence_inequality`.
    pub fn read(field: &Field<'_>) -> Outcome<Existence> {
        let mut fields = field.fields()?;
        let existence = Existence {
            x: number(&mut fields, "X", false)?,
            e: number(&mut fields, "E", false)?,
            p: symmetric(&fields.required("P")?)?,
            k_p: number(&mut fields, "k_p", true)?,
            c_x: number(&mut fields, "c_x", true)?,
            c_y: number(&mut fields, "c_y", true)?,
            threshold: number(&mut fields, "sigma", true)?,
            pointer: field.pointer.clone(),
        };
        fields.finish()?;
        Ok(existence)
    }

    /// At the gain sigma, with Q_m.
    pub fn answer(&self, d: &Data<'_>, sigma: &Rational, oscillation: &Interval) -> Answer {
        let [k_p, c_x, c_y] = [&self.k_p, &self.c_x, &self.c_y].map(|value| d.number(value));
        let excess = match sigma > &self.threshold {
            true => d.number(&Rational::from(sigma - &self.threshold)) * 2,
            false => Interval::undefined(d.precision),
        };
        let force = k_p * oscillation;
        let by = |weight: Interval| &force / ((weight * &c_y).sqrt() * 2);
        Answer { rms_x: by(c_x), rms_e: by(excess), rms_y: &force / &c_y }
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
        let [threshold, gain] = [&self.threshold, sigma].map(|value| d.number(value));
        let mut conditions =
            vec![Condition::less("E3", "threshold of the existence inequality < sigma", threshold, gain), contracts];
        let [damped, damped_t] = if with_kap { ["g_k Rt, ", "Rt + kap r_e, "] } else { [""; 2] };
        let of_e = "k_p Q_m/(2 sqrt(2 (sigma - threshold) c_y))";
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

/// What is known of a solution at r, and what has to be above it: of sup|x|, rms(x), sup|e|, rms(e), rms(e').
pub type Sides<'s> = [[&'s Interval; 2]; 5];

/// S1b to S2c, strictly; `what`: the bounds that the last four are the least of.
pub(super) fn strictly(sides: Sides<'_>, what: [String; 4]) -> impl Iterator<Item = Condition> {
    let [rms_x, sup_e, rms_e, rms_e_t] = what;
    let names = [
        ("S1b", "(c/a_1) b_fe E_p, K2(a_1) b_fe r_e".to_owned(), "X_p"),
        ("S1c", rms_x, "r_x"),
        ("S2", sup_e, "E_p"),
        ("S2b", rms_e, "r_e"),
        ("S2c", rms_e_t, "r_d"),
    ];
    names.into_iter().zip(sides).map(|((id, bounds, end), [lhs, rhs])| {
        Condition::less(id, format!("min{{{bounds}}} < {end}"), lhs.clone(), rhs.clone())
    })
}

/// E1 and E2: X_p and E_p lie where an inequality is proved, at X and E. Differences of rationals are exact, so equality is decided.
pub(super) fn covers(d: &Data<'_>, [x_p, e_p]: [&Rational; 2], [x, e]: [&Rational; 2]) -> [Condition; 2] {
    let within = |id, what, inner: &Rational, outer: &Rational| {
        Condition::at_most(id, what, d.number(&Rational::from(inner - outer)), d.int(0))
    };
    [
        within("E1", "X_p - X of the existence inequality <= 0", x_p, x),
        within("E2", "E_p - E of the existence inequality <= 0", e_p, e),
    ]
}
