//! Rule: what a claim says of given numbers of oscillators, at its gain and no other (docs/mathematics.md, section 13.6): rates without noise, and
//! limits with it. Of a claim by norms alone, in continuous time (`continuous`) or at samples (`sampled`).
//!
//! Guarantee of [`prove`], for each n_o: every solution from the claimed set has `|e - e_per| <= factor exp(-rate (t - t_0))`, at samples for the sampling
//! instants t, and with the noise of the file, where that is claimed (`noise`), `|e - e_per| <= peak` at all times and at most `limit` in the end.

pub mod claimed;
mod continuous;
mod form;
mod noise;
mod norm;
mod sampled;
#[cfg(test)]
mod tests;

use super::common::{Free, Sizes};
use super::sampled::law::{Law, Terms};
use super::stability::{ErrorBox, distances};
use crate::data::Data;
use crate::json::Field;
use crate::verdict::{Condition, Outcome, bad};
use claimed::{RULE, Rate, read_count};
pub use noise::demand_noise;
use rug::Rational;

/// The most of them.
const MOST: usize = 8;

/// What proves what is said of one n_o.
pub struct Witness {
    pointer: String,
    n_o: u32,
    /// e_up and z_up, of the Pi of the rate.
    ends: [Rational; 2],
    proof: Proof,
}

/// The forms of the rate and, where it is claimed, of the limits with noise.
enum Proof {
    Continuous(Box<continuous::Proof>, Option<Box<continuous::OfNoise>>),
    Sampled(Box<sampled::Proof>, Option<Box<sampled::OfNoise>>),
}

impl Witness {
    /// Reads the part `for_n_o` of a witness, beside the claim.
    pub fn read_all(field: Option<&Field<'_>>, claimed: &[Rate<'_>], at_samples: bool) -> Outcome<Vec<Witness>> {
        let list = field.map_or_else(|| Ok(Vec::new()), Field::elements)?;
        if let Some(field) = field.filter(|_| list.is_empty() || list.len() > MOST) {
            return bad(&field.pointer, format!("expected 1 to {MOST} rates"));
        }
        let witnesses: Vec<Witness> =
            list.iter().map(|field| Witness::read(field, at_samples)).collect::<Outcome<_>>()?;
        if witnesses.len() != claimed.len() {
            return bad("/witness/for_n_o", "expected one for each rate of the claim");
        }
        for (rate, witness) in claimed.iter().zip(&witnesses) {
            if rate.n_o != witness.n_o {
                return bad(&format!("{}/n_o", witness.pointer), format!("the claim has n_o = {} here", rate.n_o));
            }
            if rate.noise.is_some() != witness.has_noise() {
                return bad(&witness.pointer, "`noise` stands here exactly where it stands in the claim");
            }
        }
        Ok(witnesses)
    }

    fn read(field: &Field<'_>, at_samples: bool) -> Outcome<Witness> {
        let mut fields = field.fields()?;
        let n_o = read_count(&mut fields)?;
        let mut noise = fields.optional("noise").map(|field| field.fields()).transpose()?;
        let proof = if at_samples {
            let of_noise = noise.as_mut().map(|fields| sampled::OfNoise::read(fields, n_o)).transpose()?;
            Proof::Sampled(Box::new(sampled::Proof::read(&mut fields, n_o)?), of_noise.map(Box::new))
        } else {
            let of_noise = noise.as_mut().map(|fields| continuous::OfNoise::read(fields, n_o)).transpose()?;
            Proof::Continuous(Box::new(continuous::Proof::read(&mut fields, n_o)?), of_noise.map(Box::new))
        };
        let ends = [fields.required("e_up")?.rational()?, fields.required("z_up")?.rational()?];
        [noise, Some(fields)].into_iter().flatten().try_for_each(|fields| fields.finish())?;
        Ok(Witness { pointer: field.pointer.clone(), n_o, ends, proof })
    }

    fn has_noise(&self) -> bool {
        matches!(&self.proof, Proof::Continuous(_, Some(_)) | Proof::Sampled(_, Some(_)))
    }
}

/// Proves all that a claim says of given n_o, around a periodic solution of these sizes: of a claim that rests on norms. `law`: that of a claim at
/// samples.
pub fn prove(
    d: &Data<'_>,
    (free, sizes, sigma, law): (&Free, &Sizes, &Rational, Option<&Terms>),
    (claimed, witnesses): (&[Rate<'_>], &[Witness]),
    lines: &mut Vec<String>,
) -> Outcome<()> {
    let radii = [&free.d_x, &free.d_e].map(|value| d.number(value));
    let error_box = ErrorBox::new(d, free.paths, [&sizes.x, &sizes.e], radii.each_ref());
    let reach = distances(d, &free.set, [&sizes.x, &sizes.e, &sizes.zeta]);
    let law = law.map(|terms| Law::new(d, terms));
    for (rate, witness) in claimed.iter().zip(witnesses) {
        let at = format!("{}/noise", witness.pointer);
        norm::positive("rate", &rate.rate, &rate.pointer)?;
        norm::positive("factor", &rate.factor, &rate.pointer)?;
        let ([start, e_low], of_noise) = match (&witness.proof, &law) {
            (Proof::Continuous(proof, of_noise), None) => (
                continuous::rate(d, (&error_box, sigma), (rate, proof, &witness.ends), &reach)?,
                of_noise.as_ref().map(|proof| continuous::noise(d, (&error_box, sigma), proof, rate.n_o)),
            ),
            (Proof::Sampled(proof, of_noise), Some(law)) => (
                sampled::rate(law, &error_box, (rate, proof, &witness.ends), &reach)?,
                of_noise.as_ref().map(|proof| sampled::noise(law, &error_box, proof, rate.n_o)),
            ),
            _ => return bad(&witness.pointer, "this is not what proves a rate of such a regulator"),
        };
        let what = format!("w P_up dX^2 + e_up dE^2 + z_up dZ^2 <= factor^2 e_low, n_o = {}", rate.n_o);
        let condition = Condition::at_most("R", what, start, d.number(&rate.factor).sqr() * e_low);
        lines.push(condition.line());
        condition.demand(RULE, &format!("{}/factor", rate.pointer))?;
        if let (Some(limits), Some(of_noise)) = (&rate.noise, of_noise) {
            let [s, kappa] = of_noise?;
            noise::prove(d, (free, sizes), limits, [&s, &kappa], &at, lines)?;
        }
    }
    Ok(())
}
