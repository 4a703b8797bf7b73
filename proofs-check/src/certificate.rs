//! The certificate file (formats.md), and the order in which the rules are applied to it.

use crate::data::Data;
use crate::interval::Interval;
use crate::json::{Field, Fields, Json};
use crate::rules::claim::{Claim, read_set};
use crate::rules::transfer::Proof;
use crate::rules::{constants, lmi, lyapunov, regulation, repaired, sharp, stored};
use crate::spec::{BOUND_NAMES, Specification, header};
use crate::verdict::{Condition, Finding, Outcome, Verdict, bad, invalid};
use crate::{monotone, sha256};
use rug::Rational;

/// The working precisions, in bits: from that of the certificate up to the last.
const PRECISIONS: std::ops::RangeInclusive<u32> = 128..=4096;
const LAST_PRECISION: u32 = 1024;

/// One derivation with its witness.
enum Derivation {
    Sharp(Box<sharp::Witness>, Option<Box<regulation::Witness>>, Option<Box<lmi::Witness>>),
    Repaired(Box<repaired::Witness>),
}

/// Applies every rule; `lines` receives the argument, line by line.
pub fn check(json: &Json, lines: &mut Vec<String>) -> Outcome<()> {
    let mut file = Field { json, pointer: String::new() }.fields()?;
    header(&mut file, "sigmastar/certificate")?;
    let mut tool = file.required("tool")?.fields()?;
    stored::text(&tool.required("name")?, "sigmastar")?;
    let version = tool.required("version")?;
    let number = |part: &str| (1..=9).contains(&part.len()) && part.bytes().all(|b| b.is_ascii_digit());
    let parts: Vec<&str> = version.text()?.split('.').collect();
    if parts.len() != 3 || !parts.into_iter().all(number) {
        return bad(&version.pointer, "expected three whole numbers, as in `1.0.2`");
    }
    tool.finish()?;
    let bits = file.required("precision_bits")?;
    let first_precision = bits.whole()?;
    if !PRECISIONS.contains(&first_precision) {
        return bad(&bits.pointer, format!("expected {PRECISIONS:?} bits"));
    }
    let embedded = file.required("specification")?;
    let mut witness = file.required("witness")?.fields()?;
    let spec = Specification::read(&embedded, &mut witness)?;
    let mut canonical = String::new();
    embedded.json.canonical(&mut canonical);
    stored::text(&file.required("specification_sha256")?, &sha256::hex_digest(canonical.as_bytes()))?;
    lines.push(
        "specification: well-formed; T, w, mu, alpha, P_low > 0, P_up >= P_low; W1-W3 and n_0 > n_1; digest right"
            .to_owned(),
    );

    let claim = Claim::read(&file.required("claim")?)?;
    let main = Derivation::read(witness, claim.sharp, claim.sigma.clone(), claim.set.clone())?;
    let other = file.optional("comparison").map(|field| comparison(&field, !claim.sharp)).transpose()?;
    let (list, table) = (file.required("conditions")?, file.required("constants")?);
    file.finish()?;

    let mut precision = first_precision;
    loop {
        let mut attempt = lines.clone();
        let rules = Rules { d: &Data::new(&spec, precision), claim: &claim, list: &list, table: &table };
        let result = rules.apply(&main, other.as_ref(), &mut attempt);
        // More bits do not help where the cutting of the box came to its end.
        let undecided = |finding: &Finding| finding.verdict == Verdict::Undecided && finding.rule != monotone::RULE;
        let again = result.as_ref().is_err_and(|finding| undecided(finding)) && precision < LAST_PRECISION;
        if !again {
            *lines = attempt;
            result?;
            break;
        }
        precision *= 2;
    }
    // Last, because it may take the longest.
    if let Some((jacobian, witness)) = &spec.jacobian {
        let words = lyapunov::prove(jacobian, &spec.period, witness)?;
        lines.push(format!("Lyapunov triple: {words}"));
    }
    Ok(())
}

/// The free numbers of the derivation that the claim is not about, for the table of constants.
fn comparison(field: &Field<'_>, sharp: bool) -> Outcome<Derivation> {
    let mut fields = field.fields()?;
    let part = fields.required(if sharp { "sharp" } else { "repaired" })?;
    fields.finish()?;
    let mut fields = part.fields()?;
    let sigma = fields.required("sigma_star")?.rational()?;
    let mut set = fields.required("initial_set")?.fields()?;
    let (numbers, _) = read_set(&mut set)?;
    set.finish()?;
    let witness = fields.required("witness")?.fields()?;
    fields.finish()?;
    Derivation::read(witness, sharp, sigma, numbers)
}

fn proof(field: &Field<'_>) -> Outcome<Proof> {
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

impl Derivation {
    fn read(mut fields: Fields<'_>, sharp: bool, sigma: Rational, set: [Rational; 3]) -> Outcome<Derivation> {
        let pointer = fields.pointer.clone();
        let mut number = |name: &str| fields.required(name)?.rational();
        if !sharp {
            let w = repaired::Witness {
                x: number("X")?,
                e: number("E")?,
                level: number("L")?,
                h: number("h")?,
                p_x: number("p_x")?,
                p_e: number("p_e")?,
                k0: number("k0")?,
                k1: number("k1")?,
                transfer: proof(&fields.required("transfer")?)?,
                pointer,
                sigma,
                set,
            };
            fields.finish()?;
            return Ok(Derivation::Repaired(Box::new(w)));
        }
        let w = sharp::Witness {
            x_p: number("X_p")?,
            e_p: number("E_p")?,
            d_x: number("D_x")?,
            d_e: number("D_e")?,
            p_x: number("p_x")?,
            p_e: number("p_e")?,
            w_x: number("w_x")?,
            h: number("h")?,
            k0: number("k0")?,
            k1: number("k1")?,
            transfer: proof(&fields.required("transfer")?)?,
            pointer,
            sigma,
            set,
        };
        let exact = fields.optional("exact_regulation").map(|field| regulation_witness(&field)).transpose()?;
        let multipliers = fields.optional("lmi").map(|field| lmi::Witness::read(&field)).transpose()?;
        fields.finish()?;
        Ok(Derivation::Sharp(Box::new(w), exact.map(Box::new), multipliers.map(Box::new)))
    }
}

fn regulation_witness(field: &Field<'_>) -> Outcome<regulation::Witness> {
    let mut fields: Fields<'_> = field.fields()?;
    let mut number = |name| -> Outcome<Rational> { fields.required(name)?.rational() };
    let w = regulation::Witness {
        sigma: number("sigma_star_oo")?,
        d_x: number("D_x")?,
        d_e: number("D_e")?,
        w_x: number("w_x")?,
        h: number("h")?,
        pointer: field.pointer.clone(),
    };
    fields.finish()?;
    Ok(w)
}

/// What was proved of one derivation.
enum Proved<'w> {
    Sharp(&'w sharp::Witness, Box<sharp::Sharp>, Option<&'w Rational>),
    Repaired(&'w repaired::Witness, Box<repaired::Repaired>),
}

/// The rules at one precision.
struct Rules<'a> {
    d: &'a Data<'a>,
    claim: &'a Claim<'a>,
    list: &'a Field<'a>,
    table: &'a Field<'a>,
}

impl Rules<'_> {
    fn apply(&self, main: &Derivation, other: Option<&Derivation>, lines: &mut Vec<String>) -> Outcome<()> {
        let d = self.d;
        lines.push(format!("working precision: {} bits", d.precision));
        if let Some([x, e]) = &d.spec.domain {
            let (x, e) = (x.enclose(d.precision), e.enclose(d.precision));
            self.bounding_functions([&x, &e], lines)?;
        }
        let main = self.prove(main, lines)?;
        let other = other.map(|other| {
            lines.push("for comparison, the other derivation:".to_owned());
            self.prove(other, lines)
        });
        let other = other.transpose()?;
        let mut input = constants::Input { sharp: None, repaired: None, regulation: None };
        for proved in [Some(&main), other.as_ref()].into_iter().flatten() {
            match proved {
                Proved::Sharp(w, s, exact) => (input.sharp, input.regulation) = (Some((*w, s.as_ref())), *exact),
                Proved::Repaired(w, r) => input.repaired = Some((*w, r.as_ref())),
            }
        }
        let conditions = match &main {
            Proved::Sharp(w, s, _) => {
                self.claim.check(d, [&s.x_per, &s.e_per, &s.z], [&w.x_p, &w.e_p])?;
                &s.conditions
            }
            Proved::Repaired(w, r) => {
                self.claim.check(d, [&r.existence.x_p, &r.existence.e_p, &r.z], [&w.x, &w.e])?;
                &r.conditions
            }
        };
        lines
            .push("claim: verdict, n_o, mu, set, periodic solution and statement are those that are proved".to_owned());
        stored::conditions(self.list, conditions)?;
        let cells = constants::check(d, self.table, &input)?;
        lines.push(format!("stored: {} conditions and {cells} constants are those computed here", conditions.len()));
        Ok(())
    }

    /// Proves one derivation: conditions, and bounding functions up to its arguments.
    fn prove<'w>(&self, derivation: &'w Derivation, lines: &mut Vec<String>) -> Outcome<Proved<'w>> {
        let d = self.d;
        match derivation {
            Derivation::Repaired(w) => {
                let proved = repaired::evaluate(d, w)?;
                lines.push(format!("repaired derivation, sigma = {}", w.sigma));
                all("repaired", &w.pointer, proved.transfer.iter().chain(&proved.conditions), lines)?;
                self.without_domain(&proved.arguments, lines)?;
                Ok(Proved::Repaired(w, Box::new(proved)))
            }
            Derivation::Sharp(w, exact, multipliers) => {
                let proved = sharp::evaluate(d, w)?;
                lines.push(format!("sharp derivation, sigma = {}", w.sigma));
                all("sharp", &w.pointer, proved.transfer.iter().chain(&proved.conditions), lines)?;
                self.without_domain(&proved.arguments, lines)?;
                if let Some(multipliers) = multipliers {
                    lmi::check(d, &proved.error_box, [&w.sigma, &w.w_x, &w.h], multipliers)?;
                    lines.push("  C5 holds by its matrix inequality too".to_owned());
                }
                if let Some(exact) = exact {
                    lines.push(format!("exact regulation, sigma_oo = {}", exact.sigma));
                    let conditions = regulation::evaluate(d, &w.set, exact)?;
                    all("exact regulation", &exact.pointer, conditions.iter(), lines)?;
                    self.without_domain(&[d.number(&exact.d_x), d.number(&exact.d_e)], lines)?;
                }
                Ok(Proved::Sharp(w, Box::new(proved), exact.as_ref().map(|exact| &exact.sigma)))
            }
        }
    }

    /// Without a domain the bounding functions are proved up to the arguments that are used.
    fn without_domain(&self, [x, e]: &[Interval; 2], lines: &mut Vec<String>) -> Outcome<()> {
        if self.d.spec.domain.is_some() { Ok(()) } else { self.bounding_functions([x, e], lines) }
    }

    fn bounding_functions(&self, [x, e]: [&Interval; 2], lines: &mut Vec<String>) -> Outcome<()> {
        let (Some(x), Some(e)) = (x.upper(), e.upper()) else {
            return invalid("bounding functions", "/witness", "an argument is not finite");
        };
        for (name, expr) in BOUND_NAMES.iter().zip(&self.d.spec.bounds) {
            if let Some(expr) = expr {
                monotone::prove(name, expr, &x, &e, self.d.precision)?;
            }
        }
        let (x, e) = (x.to_f64(), e.to_f64());
        lines.push(format!("bounding functions: finite, nonnegative, nondecreasing up to X = {x}, E = {e}"));
        Ok(())
    }
}

/// Writes down all conditions, then demands each.
fn all<'c>(
    rule: &'static str,
    pointer: &str,
    mut conditions: impl Iterator<Item = &'c Condition> + Clone,
    lines: &mut Vec<String>,
) -> Outcome<()> {
    lines.extend(conditions.clone().map(Condition::line));
    conditions.try_for_each(|condition| condition.demand(rule, pointer))
}
