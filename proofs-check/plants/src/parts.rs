//! The orbit and the forcing of a witness, as a file has them (docs/formats.md, "A certificate of a plant"): read and checked in form.

use super::time::Wave;
use proofs_core::json::{Field, Fields};
use proofs_core::verdict::{Outcome, bad, demand};
use rug::Rational;

/// The most harmonics of the orbit and of the forcing.
const MAX_HARMONICS: usize = 200;

/// xb(t;p), with eps, rho and r (docs/mathematics.md, sections 11.2 and 13.2).
#[derive(Clone, Debug)]
pub struct Orbit {
    pub pointer: String,
    /// The components of xb_0, and those of each sensitivity.
    pub waves: Vec<Vec<Wave>>,
    pub defect: Rational,
    pub tube: Rational,
    pub radius: Rational,
}

/// qb(t;p), with r_0 and r_1 (section 11.4).
#[derive(Clone, Debug)]
pub struct Forcing {
    pub pointer: String,
    /// qb_0, and each sensitivity.
    pub waves: Vec<Wave>,
    pub rest: Rational,
    pub rest_t: Rational,
}

fn number(fields: &mut Fields<'_>, name: &str, positive: bool) -> Outcome<Rational> {
    let field = fields.required(name)?;
    let value = field.rational()?;
    let (truth, what) = if positive { (value > 0, "> 0") } else { (value >= 0, ">= 0") };
    demand(Some(truth), "signs", &field.pointer, format!("{name} {what}"))?;
    Ok(value)
}

/// What is read of an object, and after it that of each of the `sensitivities`, one for each number of the family.
fn curves<T>(fields: &mut Fields<'_>, members: usize, read: impl Fn(&mut Fields<'_>) -> Outcome<T>) -> Outcome<Vec<T>> {
    let mut all = vec![read(fields)?];
    if members == 0 {
        return Ok(all);
    }
    let list = fields.required("sensitivities")?;
    all.extend(list.list(|field| field.object(&read))?);
    if all.len() == 1 + members {
        return Ok(all);
    }
    let what = "one for each parameter of which an interval is given, and one for the period if it is an interval";
    bad(&list.pointer, format!("expected {members} objects, {what}"))
}

pub fn orbit(field: &Field<'_>, order: usize, members: usize) -> Outcome<Orbit> {
    let mut fields = field.fields()?;
    let waves = curves(&mut fields, members, |fields| Wave::read_all(fields, order, MAX_HARMONICS))?;
    let orbit = Orbit {
        pointer: field.pointer.clone(),
        waves,
        defect: number(&mut fields, "defect", false)?,
        tube: number(&mut fields, "tube", true)?,
        radius: number(&mut fields, "radius", false)?,
    };
    fields.finish().map(|()| orbit)
}

pub fn forcing(field: &Field<'_>, members: usize) -> Outcome<Forcing> {
    let mut fields = field.fields()?;
    let waves = curves(&mut fields, members, |fields| Wave::read(fields, MAX_HARMONICS))?;
    let forcing = Forcing {
        pointer: field.pointer.clone(),
        waves,
        rest: number(&mut fields, "rest", false)?,
        rest_t: number(&mut fields, "rest_t", false)?,
    };
    fields.finish().map(|()| forcing)
}
