//! Rule: stability by a matrix inequality over the derivatives of a plant, in the place of C5 (docs/mathematics.md, section 13.7).
//!
//! Guarantee: with the conditions, and the inequality proved of the plant's formulas (whoever reads them does: the crate
//! `proofs-plants`), what C5 is there for holds at every gain from sigma on: U decreases in the error box.
//!
//! With an input gain (section 13.1) F has `d + (1-b) threshold` in the place of d, at both ends of b, in which it is affine, and C5B says
//! that L, its part in e and y with d = 0, is positive definite. At `sigma' = threshold/l`, 0 < l < 1, the weight l h serves, with b l h for
//! zeta: in `(x/sqrt(l), e/sqrt(l), y sqrt(l))` the form is l times F, and (1 - l) L besides. So it is not below
//! `2 w_x rate P` for x, and definite in e and y: U decreases, and C4 with b_hi h is more than what its level needs.

use super::paths::{Path, Paths};
use super::stability::ErrorBox;
use crate::data::Data;
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::matrix::{Matrix, is_symmetric};
use crate::verdict::{Condition, Outcome, bad};
use rug::Rational;

/// The name of the rule.
pub const RULE: &str = "matrix inequality";

/// That F with `sigma` and with J + `rate` I is positive semidefinite for the weights of the witness: for all derivatives at one point
/// of `|y| <= X`, `|e| <= E`; with a splitting for (J, r) at a point with X and the E of the splitting, and (g, d) at a point with E
/// and the X of the splitting.
#[derive(Clone, Debug)]
pub struct Inequality {
    pub pointer: String,
    pub x: Rational,
    pub e: Rational,
    pub rate: Rational,
    pub sigma: Rational,
    pub w_x: Rational,
    pub h: Rational,
    pub splitting: Option<Splitting>,
}

/// S in (x, y), which `F` without e is not below, and which leaves `[[S, v], [v', 2 sigma]] >= 0` for the column v of e.
#[derive(Clone, Debug)]
pub struct Splitting {
    pub x: Rational,
    pub e: Rational,
    pub matrix: Matrix,
}

impl Splitting {
    fn read(field: &Field<'_>) -> Outcome<Splitting> {
        field.object(|fields| {
            let matrix = symmetric(&fields.required("S")?)?;
            let [x, e] = place(fields)?;
            Ok(Splitting { x, e, matrix })
        })
    }
}

/// The rows of a symmetric matrix of any order.
pub(super) fn symmetric(rows: &Field<'_>) -> Outcome<Matrix> {
    let matrix = rows.list(|row| row.list(Field::rational))?;
    let is_square = matrix.iter().all(|row| row.len() == matrix.len());
    if is_square && is_symmetric(&matrix) { Ok(matrix) } else { bad(&rows.pointer, "expected a symmetric matrix") }
}

/// X and E, which are not negative.
pub(super) fn place(fields: &mut Fields<'_>) -> Outcome<[Rational; 2]> {
    fields.each(["X", "E"], |fields, name| number(fields, name, false))
}

/// Numbers above 0.
pub(super) fn above_0<const N: usize>(fields: &mut Fields<'_>, names: [&str; N]) -> Outcome<[Rational; N]> {
    fields.each(names, |fields, name| number(fields, name, true))
}

/// A number above 0, or one that is not negative.
pub(super) fn number(fields: &mut Fields<'_>, name: &str, positive: bool) -> Outcome<Rational> {
    let field = fields.required(name)?;
    let value = field.rational()?;
    match value > 0 || (!positive && value == 0) {
        true => Ok(value),
        false => bad(&field.pointer, if positive { "expected a number above 0" } else { "it is negative" }),
    }
}

/// That a rational is at most another: their difference is exact, so equality is decided.
pub(super) fn not_above(d: &Data<'_>, id: &'static str, what: String, [inner, outer]: [&Rational; 2]) -> Condition {
    Condition::at_most(id, format!("{what} <= 0"), d.number(&Rational::from(inner - outer)), d.int(0))
}

/// That a certificate with an inequality contains the formulas that it is about.
pub(super) fn demand_plant(d: &Data<'_>, pointer: &str) -> Outcome<()> {
    match d.spec.plant {
        Some(_) => Ok(()),
        None => bad(pointer, "a matrix inequality is about the formulas of a plant"),
    }
}

/// C5x and C5e: the error box lies where an inequality is proved, at X and E.
pub(super) fn reaches(
    d: &Data<'_>,
    error_box: &ErrorBox,
    ends: [&Rational; 2],
    inequality: &'static str,
) -> [Condition; 2] {
    let [x, e] = ends.map(|end| d.number(end));
    [
        Condition::at_most("C5x", format!("X_b <= X of the {inequality}"), error_box.x_b.clone(), x),
        Condition::at_most("C5e", format!("E_b <= E of the {inequality}"), error_box.e_b.clone(), e),
    ]
}

impl Inequality {
    /// Reads the part `matrix_inequality`; the weights are those of the witness that it is a part of.
    pub fn read(field: &Field<'_>, [w_x, h]: [&Rational; 2]) -> Outcome<Inequality> {
        field.object(|fields| {
            let [x, e] = place(fields)?;
            let [rate, sigma] = above_0(fields, ["rate", "sigma"])?;
            let splitting = fields.part("splitting", Splitting::read)?;
            let [w_x, h] = [w_x, h].map(Rational::clone);
            Ok(Inequality { pointer: field.pointer.clone(), x, e, rate, sigma, w_x, h, splitting })
        })
    }

    /// Whether it is about these weights.
    pub fn is_for(&self, [w_x, h]: [&Rational; 2]) -> bool {
        self.w_x == *w_x && self.h == *h
    }

    /// (X, E) of (J, r), and of (g, d).
    pub fn arguments(&self) -> [[&Rational; 2]; 2] {
        let other = self.splitting.as_ref();
        [[&self.x, other.map_or(&self.e, |other| &other.e)], [other.map_or(&self.x, |other| &other.x), &self.e]]
    }

    /// That the error box around a periodic solution of the sizes `periodic` lies where it is proved, on the path of f and q, and
    /// that the gain that is named is larger. Where their paths differ, the straight one is open to both.
    pub fn conditions(
        &self,
        d: &Data<'_>,
        (paths, [x_per, e_per], error_box): (Paths, [&Interval; 2], &ErrorBox),
        (sigma, name): (Interval, &str),
    ) -> Vec<Condition> {
        let path = if paths.f == paths.q { paths.f } else { Path::Straight };
        let ErrorBox { x_b, e_b, .. } = error_box;
        let within = |name, what, at: &Interval, end| Condition::at_most(name, what, at.clone(), d.number(end));
        let mut conditions = reaches(d, error_box, [&self.x, &self.e], RULE).to_vec();
        conditions.extend(self.splitting.iter().flat_map(|other| {
            [
                within("C5j", "E of df/dx <= E of the splitting", path.e_at_dx(e_per, e_b), &other.e),
                within("C5g", "X of df/de <= X of the splitting", path.x_at_de(x_per, x_b), &other.x),
            ]
        }));
        let what = format!("threshold of the matrix inequality < {name}");
        conditions.push(Condition::less("C5m", what, d.number(&self.sigma), sigma));
        conditions.extend(d.gain.as_ref().map(|gain| {
            let [undamped, room] = gain.undamped(&(d.number(&self.h) / &d.mu), &d.number(&self.sigma));
            let what = "(1 + ht (1-b) threshold)^2 < 4 ht threshold at both ends of b, ht = h/mu";
            Condition::less("C5B", what, undamped, room)
        }));
        conditions
    }
}
