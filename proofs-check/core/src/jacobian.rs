//! The Jacobian F(t) of a specification, and the P(t) with which a witness proves a Lyapunov triple for it: read and checked in
//! form. What is proved with them is in the crate `proofs-plants`.

use crate::constant::Constant;
use crate::expr::Expr;
use crate::json::{Field, Json};
use crate::period::Period;
use crate::verdict::{Outcome, bad, demand};
use rug::Rational;

/// The highest harmonic of P that is read.
const MAX_HARMONIC: usize = 64;
/// The name of the rule on P.
pub const RULE: &str = "Lyapunov triple";
/// The most states that a Jacobian is read for.
const MAX_STATES: usize = 12;

/// An entry of the Jacobian F(t).
#[derive(Clone, Debug)]
pub enum Entry {
    /// A function of t.
    Function(Expr),
    /// Any number between two, lo <= hi, at each time.
    Between([Constant; 2]),
}

/// The rows of F(t).
pub type Jacobian = Vec<Vec<Entry>>;

/// The rows of a symmetric matrix.
pub type Matrix = Vec<Vec<Rational>>;

/// Reads the rows of F(t).
pub fn read(field: &Field<'_>, period: &Period) -> Outcome<Jacobian> {
    let rows = field.elements()?;
    if rows.is_empty() || rows.len() > MAX_STATES {
        return bad(&field.pointer, format!("expected 1 to {MAX_STATES} rows"));
    }
    let entry = |field: &Field<'_>| {
        if !matches!(field.json, Json::Array(_)) {
            return Ok(Entry::Function(period.expression(field, &[], &[])?));
        }
        let [lo, hi] = &field.elements()?[..] else { return bad(&field.pointer, "expected [lower end, upper end]") };
        let (lo, hi) = (Constant::read(lo)?, Constant::read(hi)?);
        demand(
            lo.number().le(&hi.number()),
            "specification",
            &field.pointer,
            "the lower end is at most the upper end",
        )?;
        Ok(Entry::Between([lo, hi]))
    };
    let row = |row: &Field<'_>| {
        let entries = row.elements()?;
        if entries.len() != rows.len() {
            return bad(&row.pointer, format!("expected {} entries", rows.len()));
        }
        entries.iter().map(entry).collect()
    };
    rows.iter().map(row).collect()
}

/// P(t) = mean + sum over k of cos(2 pi k t/T) A_k + sin(2 pi k t/T) B_k, and the triple.
#[derive(Clone, Debug)]
pub struct Witness {
    /// Where it stands in the file.
    pub pointer: String,
    pub mean: Matrix,
    pub harmonics: Vec<[Matrix; 2]>,
    /// P_low, P_up, alpha.
    pub numbers: [Rational; 3],
}

/// Reads a symmetric matrix of the order of the Jacobian.
fn matrix(field: &Field<'_>, order: usize) -> Outcome<Matrix> {
    let row = |row: &Field<'_>| row.elements()?.iter().map(Field::rational).collect::<Outcome<Vec<_>>>();
    let rows = field.elements()?.iter().map(row).collect::<Outcome<Matrix>>()?;
    if rows.len() != order || rows.iter().any(|row| row.len() != order) {
        return bad(&field.pointer, format!("expected {order} rows of {order} numbers, as the Jacobian has"));
    }
    let symmetric = (0..order).all(|i| (0..i).all(|j| rows[i][j] == rows[j][i]));
    demand(Some(symmetric), RULE, &field.pointer, "P is symmetric")?;
    Ok(rows)
}

impl Witness {
    /// Reads the part `lyapunov` of a witness; its numbers are the triple p_low, p_up, alpha.
    pub fn read(field: &Field<'_>, order: usize) -> Outcome<(Witness, [Constant; 3])> {
        let mut fields = field.fields()?;
        let mean = matrix(&fields.required("P")?, order)?;
        let mut harmonics = Vec::new();
        if let Some(list) = fields.optional("harmonics") {
            for element in list.elements()? {
                let mut pair = element.fields()?;
                let [cos, sin] = [pair.required("cos")?, pair.required("sin")?];
                pair.finish()?;
                harmonics.push([matrix(&cos, order)?, matrix(&sin, order)?]);
            }
            if harmonics.len() > MAX_HARMONIC {
                return bad(&list.pointer, format!("expected at most {MAX_HARMONIC} harmonics"));
            }
        }
        let mut triple = Vec::new();
        let mut number = |name: &str| -> Outcome<Rational> {
            let field = fields.required(name)?;
            let value = field.rational()?;
            demand(Some(value > 0), RULE, &field.pointer, format!("{name} > 0"))?;
            triple.push(Constant::read(&field)?);
            Ok(value)
        };
        let numbers = [number("p_low")?, number("p_up")?, number("alpha")?];
        fields.finish()?;
        let [p_low, p_up, alpha] = &triple[..] else { return bad(&field.pointer, "expected a triple") };
        let triple = [p_low.clone(), p_up.clone(), alpha.clone()];
        Ok((Witness { pointer: field.pointer.clone(), mean, harmonics, numbers }, triple))
    }
}
