//! Rules Ms and E for a sampled regulator: stability, and existence without a small gain, by matrix inequalities over
//! the derivatives of a plant (docs/mathematics.md, section 13.7, at samples).
//!
//! From a sample on `e(s) = (1 - s sigma) e_k + s y + G` with `G' = q - mean q`, and G vanishes at both ends, so
//! `lambda (avg G^2 - (t/pi)^2 avg q^2) <= 0` may be added to what U loses over t. The sum is the average over s of a
//! form in (x, e_k, y, G), the least over w of `F_{t,s}`. It does not increase with t, and `F_{h,s}` is affine in s
//! and in (J, g, r, d): so it is not negative where `F_{h,0}` and `F_{h,h}` are semidefinite at every t and every
//! point. What is proved of the two, of the plant's formulas, the crate `proofs-plants` says.
//!
//! Guarantee, with what it proves: in the error box `U^t <= U_k` for 0 < t <= h, and U falls over a step by `h rho
//! (rms(x)^2 + e_k^2 + y^2)` at least, for some rho > 0 (rate, c_e, c_y > 0). For convergence as in section 12.3 it
//! takes no more: q is `r x + d e` with bounded r and d, and `G(h) = 0` makes its mean a bounded function of x, e_k
//! and y, whatever h d is.
//!
//! Of every T-periodic solution in `|x| <= X`, `|e| <= E` of the loop with `l q_0` in the place of q_0, 0 <= l <= 1:
//! what [`Existence::answer`] says. The sum of the steps of U over a period is 0, and that of y is (the integrator),
//! so q_0 counts without its mean in both places. There is a solution, by Leray and Schauder as in continuous time, if
//! the conditions that then stand in the place of S1b to S2c hold strictly.

use super::law::{Law, Terms};
use crate::interval::Interval;
use crate::json::Field;
use crate::matrix::Matrix;
use crate::rules::inequality::{above_0, place, symmetric};
use crate::rules::metric::Answer;
use crate::verdict::Outcome;
use rug::Rational;

/// `F_{h,s} >= diag(2 w_x rate P, c_e, c_y, 0, 0)` in (x, e_k, y, G, w), with the P, w_x and eta of the witness.
#[derive(Clone, Debug)]
pub struct Stability {
    pub pointer: String,
    pub x: Rational,
    pub e: Rational,
    pub lambda: Rational,
    pub rate: Rational,
    pub c_e: Rational,
    pub c_y: Rational,
    pub w_x: Rational,
    pub eta: Rational,
}

/// `F_{h,s} >= c_x |x|^2 + c_e e(s)^2 + c_y y^2 - gamma q_0^2` in (x, e_k, y, G, w, q_0), with `q + q_0` for q, and a P of any sign.
#[derive(Clone, Debug)]
pub struct Existence {
    pub pointer: String,
    pub x: Rational,
    pub e: Rational,
    /// P, by rows. That it has one for each state is seen where the formulas are.
    pub p: Matrix,
    pub k_p: Rational,
    pub lambda: Rational,
    pub c_x: Rational,
    pub c_e: Rational,
    pub c_y: Rational,
    pub gamma: Rational,
}

/// What has to be proved of a plant's formulas, with the law that it is about.
#[derive(Clone, Copy)]
pub struct Inequalities<'w> {
    pub law: &'w Terms,
    pub stability: Option<&'w Stability>,
    pub existence: Option<&'w Existence>,
}

impl Stability {
    /// Reads the part `matrix_inequality`; the weights are those of the witness that it is a part of.
    pub fn read(field: &Field<'_>, [w_x, eta]: [&Rational; 2]) -> Outcome<Stability> {
        field.object(|fields| {
            let [x, e] = place(fields)?;
            let [lambda, rate, c_e, c_y] = above_0(fields, ["lambda", "rate", "c_e", "c_y"])?;
            let [w_x, eta] = [w_x, eta].map(Rational::clone);
            Ok(Stability { pointer: field.pointer.clone(), x, e, lambda, rate, c_e, c_y, w_x, eta })
        })
    }
}

impl Existence {
    /// Reads the part `existence_inequality`.
    pub fn read(field: &Field<'_>) -> Outcome<Existence> {
        field.object(|fields| {
            let [x, e] = place(fields)?;
            let p = symmetric(&fields.required("P")?)?;
            let names = ["k_p", "lambda", "c_x", "c_e", "c_y", "gamma"];
            let [k_p, lambda, c_x, c_e, c_y, gamma] = above_0(fields, names)?;
            Ok(Existence { pointer: field.pointer.clone(), x, e, p, k_p, lambda, c_x, c_e, c_y, gamma })
        })
    }

    /// With Q_m: rms(x), rms(e), and the rms of y over the samples.
    pub fn answer(&self, law: &Law<'_>, oscillation: &Interval) -> Answer {
        let by = |weight: &Rational| (law.d.number(&self.gamma) / law.d.number(weight)).sqrt() * oscillation;
        Answer { rms_x: by(&self.c_x), rms_e: by(&self.c_e), rms_y: by(&self.c_y) }
    }
}
