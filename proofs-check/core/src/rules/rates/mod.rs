//! Rule: what a claim says of given oscillators, the first n_o or those of a set of harmonics (section 14.7), at its gain and no other (docs/mathematics.md, section 13.6): rates without noise, and
//! limits with it. Of a claim by norms, in continuous time (`continuous`) or at samples (`sampled`), and without noise of one by a matrix inequality
//! or joint metrics in continuous time ([`slopes`]).
//!
//! Guarantee of [`prove`], for each n_o and each set, of which something may be said where the claim is about every set: every solution from the claimed set has `|e - e_per| <= factor exp(-rate (t - t_0))`, at samples for the sampling
//! instants t, and with the noise of the file and the rounding of its regulator (`rounding`), where that is claimed (`noise`), `|e - e_per| <= peak` at all
//! times and at most `limit` in the end. Where the claim says something by n_o, that is so if it is true, which the crate `proofs-plants` proves afterwards.

pub mod claimed;
mod continuous;
mod form;
mod noise;
mod norm;
mod rounding;
mod sampled;
pub mod slopes;
#[cfg(test)]
mod tests;

use super::by_n_o::Known;
use super::by_n_o::oscillators::Oscillators;
use super::common::{Free, Sizes};
use super::sampled::law::{Law, Terms};
use super::stability::{ErrorBox, distances};
use crate::data::Data;
use crate::interval::Interval;
use crate::json::Field;
use crate::verdict::{Condition, Outcome, bad};
use claimed::{RULE, Rate};
pub use noise::demand_noise;
use rug::Rational;

/// The most of them, numbers and sets.
const MOST: usize = 8;

/// What proves what is said of some oscillators.
pub struct Witness {
    pointer: String,
    oscillators: Oscillators,
    /// e_up and z_up, of the Pi of the rate.
    ends: [Rational; 2],
    proof: Proof,
}

/// The forms of the rate and, where it is claimed, of the limits with noise.
enum Proof {
    Continuous(Box<continuous::Proof>, Option<Box<continuous::OfNoise>>),
    Sampled(Box<sampled::Proof>, Option<Box<sampled::OfNoise>>),
    Slopes(Box<slopes::Proof>),
}

/// What the rates of a claim are proved by, as its stability is.
#[derive(Clone, Copy)]
pub enum Kind {
    /// By norms.
    Continuous,
    /// By norms, at samples.
    Sampled,
    /// By a matrix inequality or joint metrics, of a plant with so many states; `corner`: whether the inequality has a splitting.
    Slopes { states: usize, corner: bool },
}

/// What proves the rates of a claim by slopes, and (X, E) at which the inequality that it rests on has (J, r), and (g, d).
#[derive(Clone, Copy)]
pub struct Asked<'w> {
    pub witnesses: &'w [Witness],
    pub at: [[&'w Rational; 2]; 2],
}

impl<'w> Asked<'w> {
    /// The slopes, each with its oscillators.
    pub fn slopes(self) -> impl Iterator<Item = (&'w Oscillators, &'w slopes::Slopes)> {
        self.witnesses.iter().flat_map(|witness| {
            let parts: &[_] = match &witness.proof {
                Proof::Slopes(proof) => &proof.parts,
                Proof::Continuous(..) | Proof::Sampled(..) => &[],
            };
            parts.iter().map(|part| (&witness.oscillators, part))
        })
    }

    /// X and E up to which (D) of these columns is to hold: of all of them, those of the whole error box.
    pub fn region(self, columns: slopes::Columns) -> [&'w Rational; 2] {
        let [of_states, of_error] = self.at;
        match columns {
            slopes::Columns::All => [of_states[0], of_error[1]],
            slopes::Columns::States => of_states,
            slopes::Columns::Error => of_error,
        }
    }
}

impl Witness {
    /// Reads the part `for_n_o` of a witness.
    pub fn read_list(field: Option<&Field<'_>>, kind: Kind) -> Outcome<Vec<Witness>> {
        let list = field.map_or_else(|| Ok(Vec::new()), Field::elements)?;
        if let Some(field) = field.filter(|_| list.is_empty() || list.len() > MOST) {
            return bad(&field.pointer, format!("expected 1 to {MOST} rates"));
        }
        list.iter().map(|field| Witness::read(field, kind)).collect()
    }

    /// Reads the part `for_n_o` of a witness: one for each rate of the claim, or it is refused.
    pub fn read_all(field: Option<&Field<'_>>, claimed: &[Rate<'_>], kind: Kind) -> Outcome<Vec<Witness>> {
        let witnesses = Witness::read_list(field, kind)?;
        if witnesses.len() != claimed.len() {
            return bad("/witness/for_n_o", "expected one for each rate of the claim");
        }
        for (rate, witness) in claimed.iter().zip(&witnesses) {
            if rate.oscillators != witness.oscillators {
                let place = witness.oscillators.place(&witness.pointer);
                return bad(&place, format!("the claim has {} here", rate.oscillators.about()));
            }
            if rate.noise.is_some() != witness.has_noise() {
                return bad(&witness.pointer, "`noise` stands here exactly where it stands in the claim");
            }
        }
        Ok(witnesses)
    }

    fn read(field: &Field<'_>, kind: Kind) -> Outcome<Witness> {
        let mut fields = field.fields()?;
        let oscillators = Oscillators::take(&mut fields)?;
        // With slopes nothing is proved of noise: there the field is one that is not known.
        let noise = if matches!(kind, Kind::Slopes { .. }) { None } else { fields.optional("noise") };
        let mut noise = noise.map(|field| field.fields()).transpose()?;
        let proof = match kind {
            Kind::Continuous => {
                let of_noise =
                    noise.as_mut().map(|fields| continuous::OfNoise::read(fields, &oscillators)).transpose()?;
                Proof::Continuous(Box::new(continuous::Proof::read(&mut fields, &oscillators)?), of_noise.map(Box::new))
            }
            Kind::Sampled => {
                let of_noise = noise.as_mut().map(|fields| sampled::OfNoise::read(fields, &oscillators)).transpose()?;
                Proof::Sampled(Box::new(sampled::Proof::read(&mut fields, &oscillators)?), of_noise.map(Box::new))
            }
            Kind::Slopes { states, corner } => {
                Proof::Slopes(Box::new(slopes::Proof::read(&mut fields, &oscillators, states, corner)?))
            }
        };
        let ends = fields.numbers(["e_up", "z_up"])?;
        [noise, Some(fields)].into_iter().flatten().try_for_each(|fields| fields.finish())?;
        Ok(Witness { pointer: field.pointer.clone(), oscillators, ends, proof })
    }

    fn has_noise(&self) -> bool {
        matches!(&self.proof, Proof::Continuous(_, Some(_)) | Proof::Sampled(_, Some(_)))
    }
}

/// How far starts are from the periodic solution, as in C4: of these sizes, or with these oscillators of those that are known by n_o, whichever are less.
fn reach(d: &Data<'_>, free: &Free, sizes: &Sizes, by_n_o: Option<[&Rational; 3]>) -> [Interval; 3] {
    let for_every = distances(d, &free.set, [&sizes.x, &sizes.e, &sizes.zeta]);
    let Some(by_n_o) = by_n_o else { return for_every };
    let [x, e, zeta] = by_n_o.map(|size| d.number(size));
    let own = distances(d, &free.set, [&x, &e, &zeta]);
    [0, 1, 2].map(|i| for_every[i].min(&own[i]))
}

/// Proves all that a claim says of given oscillators, around a periodic solution of these sizes, but for (D) of slopes. `law`: that of a claim at samples; `by_n_o`:
/// what it says by n_o.
pub fn prove(
    d: &Data<'_>,
    (free, sizes, sigma, law, by_n_o): (&Free, &Sizes, &Rational, Option<&Terms>, Option<Known<'_>>),
    (claimed, witnesses): (&[Rate<'_>], &[Witness]),
    lines: &mut Vec<String>,
) -> Outcome<()> {
    let radii = [&free.d_x, &free.d_e].map(|value| d.number(value));
    let error_box = ErrorBox::new(d, free.paths, [&sizes.x, &sizes.e], radii.each_ref());
    let law = law.map(|terms| Law::new(d, terms));
    for (rate, witness) in claimed.iter().zip(witnesses) {
        let at = format!("{}/noise", witness.pointer);
        let by_n_o = by_n_o.and_then(|known| known.sizes(&rate.oscillators));
        let reach = reach(d, free, sizes, by_n_o);
        let z = by_n_o.map_or_else(|| sizes.zeta.clone(), |[.., zeta]| sizes.zeta.min(&d.number(zeta)));
        let known = rate.noise.is_some();
        let known = known.then(|| noise::Known::new(d, free, (reach.clone(), &z), (&error_box.e_b, law.is_some())));
        norm::positive("rate", &rate.rate, &rate.pointer)?;
        norm::positive("factor", &rate.factor, &rate.pointer)?;
        let ([start, e_low], of_noise) = match (&witness.proof, &law) {
            (Proof::Continuous(proof, of_noise), None) => (
                continuous::rate(d, (&error_box, sigma), (rate, proof, &witness.ends), &reach)?,
                of_noise.as_ref().map(|proof| continuous::noise(d, (&error_box, sigma), proof)),
            ),
            (Proof::Sampled(proof, of_noise), Some(law)) => (
                sampled::rate(law, &error_box, (rate, proof, &witness.ends), &reach)?,
                of_noise
                    .as_ref()
                    .zip(known.as_ref())
                    .map(|(proof, known)| sampled::noise(law, (&error_box, known), proof)),
            ),
            (Proof::Slopes(proof), None) => (slopes::rate(d, sigma, (rate, proof, &witness.ends), &reach)?, None),
            _ => return bad(&witness.pointer, "this is not what proves a rate of such a regulator"),
        };
        let of_x = if matches!(witness.proof, Proof::Slopes(_)) { "x_up" } else { "w P_up" };
        let what = format!("{of_x} dX^2 + e_up dE^2 + z_up dZ^2 <= factor^2 e_low, {}", rate.oscillators.about());
        let condition = Condition::at_most("R", what, start, d.number(&rate.factor).sqr() * e_low);
        lines.push(condition.line());
        condition.demand(RULE, &format!("{}/factor", rate.pointer))?;
        if let (Some(limits), Some(of_noise), Some(known)) = (&rate.noise, of_noise, &known) {
            let [s, kappa] = of_noise?;
            noise::prove(d, (free, known), limits, [&s, &kappa], &at, lines)?;
        }
    }
    Ok(())
}
