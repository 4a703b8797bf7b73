//! Rule: the claim says what the witness proves, no less and no more.

use super::stored::{text, upper_end};
use crate::data::Data;
use crate::interval::Interval;
use crate::json::Field;
use crate::spec::{AskedSet, Constant};
use crate::verdict::{Outcome, bad, invalid};
use rug::Rational;

/// The numbers of a claim.
pub struct Claim<'a> {
    /// `sharp` (true) or `repaired`.
    pub sharp: bool,
    /// sigma*.
    pub sigma: Rational,
    /// X_0, E_0, Z_0.
    pub set: [Rational; 3],
    sigma_text: &'a str,
    set_text: [&'a str; 3],
    verdict: Field<'a>,
    n_o: Field<'a>,
    mu: Field<'a>,
    kind: Field<'a>,
    periodic: Field<'a>,
    statement: Field<'a>,
}

/// Reads X0, E0, Z0, and what is left besides.
pub fn read_set<'a>(fields: &mut crate::json::Fields<'a>) -> Outcome<([Rational; 3], [&'a str; 3])> {
    let [x0, e0, z0] = [fields.required("X0")?, fields.required("E0")?, fields.required("Z0")?];
    let set = [x0.rational()?, e0.rational()?, z0.rational()?];
    if let Some(index) = set.iter().position(|value| *value < 0) {
        return invalid("initial set", &[&x0, &e0, &z0][index].pointer, "it must not be negative");
    }
    Ok((set, [x0.numeral()?, e0.numeral()?, z0.numeral()?]))
}

impl<'a> Claim<'a> {
    /// Reads the claim.
    pub fn read(field: &Field<'a>) -> Outcome<Claim<'a>> {
        let mut fields = field.fields()?;
        let derivation = fields.required("derivation")?;
        let sharp = match derivation.text()? {
            "sharp" => true,
            "repaired" => false,
            _ => return bad(&derivation.pointer, "only `sharp` and `repaired` can be claimed"),
        };
        let sigma = fields.required("sigma_star")?;
        let mut set = fields.required("initial_set")?.fields()?;
        let kind = set.required("kind")?;
        let (numbers, set_text) = read_set(&mut set)?;
        set.finish()?;
        let claim = Claim {
            sharp,
            sigma: sigma.rational()?,
            set: numbers,
            sigma_text: sigma.numeral()?,
            set_text,
            verdict: fields.required("verdict")?,
            n_o: fields.required("n_o")?,
            mu: fields.required("mu")?,
            kind,
            periodic: fields.required("periodic_solution")?,
            statement: fields.required("statement")?,
        };
        fields.finish()?;
        Ok(claim)
    }

    /// Compares every field with the specification and with the sizes |x|, |e|, |zeta|_N that are proved; `exact` are
    /// rational bounds of the first two.
    pub fn check(&self, d: &Data<'_>, sizes: [&Interval; 3], exact: [&Rational; 2]) -> Outcome<()> {
        text(&self.verdict, "certified")?;
        text(&self.n_o, "every n_o >= 0")?;
        let spec = d.spec;
        let mu = Constant::read(&self.mu)?;
        let same =
            mu.text == spec.mu.text || mu.exact.as_ref().zip(spec.mu.exact.as_ref()).is_some_and(|(a, b)| a.equals(b));
        if !same {
            return text(&self.mu, &spec.mu.text);
        }
        let kind = match spec.initial_set {
            AskedSet::Paper => "paper",
            AskedSet::AtRest(_) => "at-rest",
            AskedSet::Box(_) => "box",
        };
        text(&self.kind, kind)?;
        let [x, e, z] = sizes;
        let mut fields = self.periodic.fields()?;
        upper_end(&fields.required("x")?, x, Some(exact[0]))?;
        upper_end(&fields.required("e")?, e, Some(exact[1]))?;
        upper_end(&fields.required("zeta")?, z, None)?;
        upper_end(&fields.required("z")?, &(z + &d.n_bar * e), None)?;
        fields.finish()?;
        let reach = if spec.matched { "" } else { " (the base frequency need not match the period)" };
        let [x0, e0, z0] = self.set_text;
        let statement = format!(
            "For every number of oscillators n_o >= 0 and every gain sigma >= {}, with mu = {} and base frequency {}{reach}, \
             every plant within the bounding functions has a periodic solution of the closed loop to which every solution \
             from |x| <= {x0}, |e| <= {e0}, sqrt(z'Nz) <= {z0}, at any initial time, converges exponentially.",
            self.sigma_text, spec.mu.text, spec.base_frequency.text,
        );
        text(&self.statement, &statement)
    }
}
