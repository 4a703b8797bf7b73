//! Rule: stability by a matrix inequality over the derivatives of a plant, in the place of C5 (docs/mathematics.md, section 13.7).
//!
//! Guarantee: with the conditions, and the inequality proved of the plant's formulas (whoever reads them does: the crate
//! `proofs-plants`), what C5 is there for holds at every gain from sigma on: U decreases in the error box.

use super::stability::ErrorBox;
use crate::data::Data;
use crate::interval::Interval;
use crate::json::Field;
use crate::verdict::{Condition, Outcome, bad};
use rug::Rational;

/// That F with `sigma` and with J + `rate` I is positive semidefinite on `|y| <= X`, `|e| <= E`, for the weights of the witness.
#[derive(Clone, Debug)]
pub struct Inequality {
    pub pointer: String,
    pub x: Rational,
    pub e: Rational,
    pub rate: Rational,
    pub sigma: Rational,
    pub w_x: Rational,
    pub h: Rational,
}

impl Inequality {
    /// Reads the part `matrix_inequality`; the weights are those of the witness that it is a part of.
    pub fn read(field: &Field<'_>, [w_x, h]: [&Rational; 2]) -> Outcome<Inequality> {
        let mut fields = field.fields()?;
        let mut number = |name: &str, positive: bool| {
            let field = fields.required(name)?;
            let value = field.rational()?;
            match value > 0 || (!positive && value == 0) {
                true => Ok(value),
                false => bad(&field.pointer, if positive { "expected a number above 0" } else { "it is negative" }),
            }
        };
        let inequality = Inequality {
            x: number("X", false)?,
            e: number("E", false)?,
            rate: number("rate", true)?,
            sigma: number("sigma", true)?,
            w_x: w_x.clone(),
            h: h.clone(),
            pointer: field.pointer.clone(),
        };
        fields.finish()?;
        Ok(inequality)
    }

    /// Whether it is about these weights.
    pub fn is_for(&self, [w_x, h]: [&Rational; 2]) -> bool {
        self.w_x == *w_x && self.h == *h
    }

    /// That the error box lies where it is proved, and that the gain that is named is larger.
    pub fn conditions(&self, d: &Data<'_>, error_box: &ErrorBox, sigma: Interval, name: &str) -> [Condition; 3] {
        let [x, e, threshold] = [&self.x, &self.e, &self.sigma].map(|value| d.number(value));
        let what = format!("threshold of the matrix inequality < {name}");
        [
            Condition::at_most("C5x", "X_b <= X of the matrix inequality", error_box.x_b.clone(), x),
            Condition::at_most("C5e", "E_b <= E of the matrix inequality", error_box.e_b.clone(), e),
            Condition::less("C5m", what, threshold, sigma),
        ]
    }
}
