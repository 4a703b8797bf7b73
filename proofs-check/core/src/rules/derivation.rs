//! A derivation with its witness, as a certificate gives it: read, evaluated, and every condition demanded.
//!
//! Guarantee of [`Derivation::prove`]: all conditions of the derivation hold for the witness, the bounding functions are
//! as they must be up to every argument that is used, and so the claim at `sigma` and `set` is proved.

use super::claim::Sizes;
use super::sampled::{self, claim::Regulator};
use super::transfer::Proof;
use super::{bounding, mean_squares, regulation, sharp};
use crate::data::Data;
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::verdict::{Condition, Outcome, bad};
use rug::Rational;

/// The free numbers of a claim about either regulator.
pub enum Witnesses {
    /// In continuous time: sections 5 and 10.
    Sharp(Box<sharp::Witness>),
    /// A sampled regulator: section 12.
    Sampled(Box<sampled::Witness>),
}

/// One derivation with its witness.
pub struct Derivation {
    pub witnesses: Witnesses,
    /// Exact regulation, which a claim in continuous time may add.
    pub regulation: Option<Box<regulation::Witness>>,
}

/// What was evaluated of one derivation.
pub enum Proved {
    /// In continuous time: sections 5 and 10.
    Sharp(Box<sharp::Sharp>),
    /// A sampled regulator: section 12.
    Sampled(Box<sampled::Sampled>),
}

/// Reads how the transfer bound is proved.
pub fn proof(field: &Field<'_>) -> Outcome<Proof> {
    let mut fields = field.fields()?;
    let kind = fields.required("proof")?;
    let proof = match kind.text()? {
        "closed-form" => Proof::ClosedForm,
        "matched" => Proof::Matched(fields.required("K")?.whole()?),
        "boxes" => {
            let list = |field: Field<'_>| field.elements()?.iter().map(Field::rational).collect::<Outcome<Vec<_>>>();
            let (m0, n0) = (fields.required("m0")?.whole()?, fields.required("N0")?.whole()?);
            let breaks = fields.required("boxes")?.elements()?.into_iter().map(list).collect::<Outcome<_>>()?;
            Proof::Boxes { m0, n0, breaks }
        }
        _ => return bad(&kind.pointer, "expected `closed-form`, `matched` or `boxes`"),
    };
    fields.finish()?;
    Ok(proof)
}

/// r'_x, r'_e, r'_d.
fn means(field: &Field<'_>) -> Outcome<mean_squares::Means> {
    let mut fields = field.fields()?;
    let mut number = |name: &str| fields.required(name)?.rational();
    let means = [number("r_x")?, number("r_e")?, number("r_d")?];
    fields.finish().map(|()| means)
}

impl Derivation {
    /// Takes the free numbers out of a witness; what is left there is the caller's to read or to refuse.
    pub fn read(fields: &mut Fields<'_>, sigma: Rational, set: [Rational; 3]) -> Outcome<Derivation> {
        let pointer = fields.pointer.clone();
        if fields.has("p_x") && !fields.has("r_x") {
            return bad(&pointer, "this witness, by p_x and p_e, is of an older form: certify again");
        }
        let mut number = |name: &str| fields.required(name)?.rational();
        let existence = mean_squares::Witness {
            r: [number("r_x")?, number("r_e")?, number("r_d")?],
            kap: number("kap")?,
            refined: fields.optional("refined").map(|field| means(&field)).transpose()?,
        };
        let mut number = |name: &str| fields.required(name)?.rational();
        let w = sharp::Witness {
            x_p: number("X_p")?,
            e_p: number("E_p")?,
            d_x: number("D_x")?,
            d_e: number("D_e")?,
            existence,
            w_x: number("w_x")?,
            h: number("h")?,
            k0: number("k0")?,
            k1: number("k1")?,
            transfer: proof(&fields.required("transfer")?)?,
            pointer,
            sigma,
            set,
        };
        let regulation = fields.optional("exact_regulation").map(|field| regulation::Witness::read(&field));
        let regulation = regulation.transpose()?.map(Box::new);
        Ok(Derivation { witnesses: Witnesses::Sharp(Box::new(w)), regulation })
    }

    /// The same for a sampled regulator.
    pub fn read_sampled(fields: &mut Fields<'_>, regulator: &Regulator<'_>, set: [Rational; 3]) -> Outcome<Derivation> {
        let w = sampled::Witness::read(fields, regulator, set)?;
        Ok(Derivation { witnesses: Witnesses::Sampled(Box::new(w)), regulation: None })
    }

    /// Whether it is about a sampled regulator.
    pub fn is_sampled(&self) -> bool {
        matches!(self.witnesses, Witnesses::Sampled(_))
    }

    /// The largest X and E of exact regulation, where that is claimed.
    pub fn regulated(&self, d: &Data<'_>) -> Option<[Interval; 2]> {
        self.regulation.as_ref().map(|w| [d.number(&w.d_x), d.number(&w.d_e)])
    }

    /// X_p and E_p of the witness, which bound the periodic solution exactly.
    pub fn exact(&self) -> [&Rational; 2] {
        match &self.witnesses {
            Witnesses::Sharp(w) => [&w.x_p, &w.e_p],
            Witnesses::Sampled(w) => [&w.x_p, &w.e_p],
        }
    }

    /// Evaluates the conditions; the transfer bound is proved, and the others are left to be demanded.
    pub fn evaluate(&self, d: &Data<'_>) -> Outcome<Proved> {
        Ok(match &self.witnesses {
            Witnesses::Sharp(w) => Proved::Sharp(Box::new(sharp::evaluate(d, w)?)),
            Witnesses::Sampled(w) => Proved::Sampled(Box::new(sampled::evaluate(d, w)?)),
        })
    }

    /// Proves the derivation: its conditions, and the bounding functions up to its arguments.
    pub fn prove(&self, d: &Data<'_>, lines: &mut Vec<String>) -> Outcome<Proved> {
        let proved = self.evaluate(d)?;
        let (name, pointer, sigma, set) = match &self.witnesses {
            Witnesses::Sharp(w) => ("sharp", &w.pointer, &w.sigma, &w.set),
            Witnesses::Sampled(w) => ("sampled", &w.pointer, &w.terms.sigma, &w.set),
        };
        lines.push(format!("{name} derivation, sigma = {sigma}"));
        let (transfer, conditions, arguments) = proved.parts();
        all(name, pointer, transfer.iter().chain(conditions), lines)?;
        without_domain(d, arguments, lines)?;
        if let Some(exact) = &self.regulation {
            lines.push(format!("exact regulation, sigma_oo = {}", exact.sigma));
            let conditions = regulation::evaluate(d, set, exact)?;
            all("exact regulation", &exact.pointer, conditions.iter(), lines)?;
            without_domain(d, &[d.number(&exact.d_x), d.number(&exact.d_e)], lines)?;
        }
        Ok(proved)
    }
}

impl Proved {
    fn parts(&self) -> (&[Condition], &[Condition], &[Interval; 2]) {
        match self {
            Proved::Sharp(s) => (&s.transfer, &s.conditions, &s.arguments),
            Proved::Sampled(sampled) => (&sampled.transfer, &sampled.conditions, &sampled.arguments),
        }
    }

    /// The conditions, in the order of the file.
    pub fn conditions(&self) -> &[Condition] {
        self.parts().1
    }

    /// The largest X and E at which bounding functions are used.
    pub fn arguments(&self) -> &[Interval; 2] {
        self.parts().2
    }

    /// The sizes |x|, |e|, |zeta|_N of the periodic solution.
    pub fn sizes(&self) -> Sizes {
        let [x, e, zeta] = match self {
            Proved::Sharp(s) => [&s.solution.x, &s.solution.e, &s.z],
            Proved::Sampled(sampled) => [&sampled.solution.x, &sampled.solution.e, &sampled.solution.z],
        };
        Sizes { x: x.clone(), e: e.clone(), zeta: zeta.clone() }
    }
}

/// Without a domain the bounding functions are proved up to the arguments that are used.
pub fn without_domain(d: &Data<'_>, [x, e]: &[Interval; 2], lines: &mut Vec<String>) -> Outcome<()> {
    // Those of a plant are numbers, which are proved apart.
    if d.spec.domain.is_some() || d.spec.plant.is_some() { Ok(()) } else { bounding::prove_all(d, [x, e], lines) }
}

/// Writes down all conditions, then demands each.
pub fn all<'c>(
    rule: &'static str,
    pointer: &str,
    mut conditions: impl Iterator<Item = &'c Condition> + Clone,
    lines: &mut Vec<String>,
) -> Outcome<()> {
    lines.extend(conditions.clone().map(Condition::line));
    conditions.try_for_each(|condition| condition.demand(rule, pointer))
}
