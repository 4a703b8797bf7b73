//! The Jacobian F(t) of a specification, and the P(t) with which a witness proves a Lyapunov triple for it: read and checked in
//! form. What is proved with them is in the crate `proofs-plants`.

use crate::constant::Constant;
use crate::expr::Expr;
use crate::json::{Field, Fields, Json};
use crate::matrix::{Matrix, is_symmetric};
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
        let truth = lo.number().le(&hi.number());
        demand(truth, "specification", &field.pointer, "the lower end is at most the upper end")?;
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

/// The list `harmonics` of an object, if it is there, of at most so many: what `cos` and `sin` are read as.
pub fn harmonics<T>(
    fields: &mut Fields<'_>,
    most: usize,
    read: impl Fn(&Field<'_>) -> Outcome<T>,
) -> Outcome<Vec<[T; 2]>> {
    let Some(list) = fields.optional("harmonics") else { return Ok(Vec::new()) };
    if list.elements()?.len() > most {
        return bad(&list.pointer, format!("expected at most {most} harmonics"));
    }
    list.list(|pair| pair.object(|pair| Ok([read(&pair.required("cos")?)?, read(&pair.required("sin")?)?])))
}

/// Reads a symmetric matrix of the order of the Jacobian.
fn matrix(field: &Field<'_>, order: usize) -> Outcome<Matrix> {
    let rows = field.matrix([order; 2], "as the Jacobian has")?;
    demand(Some(is_symmetric(&rows)), RULE, &field.pointer, "P is symmetric").map(|()| rows)
}

impl Witness {
    /// Reads the part `lyapunov` of a witness; its numbers are the triple p_low, p_up, alpha.
    pub fn read(field: &Field<'_>, order: usize) -> Outcome<(Witness, [Constant; 3])> {
        let mut fields = field.fields()?;
        let mean = matrix(&fields.required("P")?, order)?;
        let harmonics = harmonics(&mut fields, MAX_HARMONIC, |field| matrix(field, order))?;
        let mut number = |name: &str| -> Outcome<(Rational, Constant)> {
            let field = fields.required(name)?;
            let value = field.rational()?;
            demand(Some(value > 0), RULE, &field.pointer, format!("{name} > 0"))?;
            Ok((value, Constant::read(&field)?))
        };
        let [p_low, p_up, alpha] = ["p_low", "p_up", "alpha"].map(&mut number);
        let [(p_low, low), (p_up, up), (alpha, rate)] = [p_low?, p_up?, alpha?];
        fields.finish()?;
        let numbers = [p_low, p_up, alpha];
        Ok((Witness { pointer: field.pointer.clone(), mean, harmonics, numbers }, [low, up, rate]))
    }
}
