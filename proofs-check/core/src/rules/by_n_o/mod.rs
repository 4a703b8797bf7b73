//! Rule: what a claim says by the number of oscillators, at its gain and no other, without noise (docs/mathematics.md, section 14), in continuous time or,
//! at samples: how large the error and the control are along the T-periodic solution, and at all times from the claimed set. Of a plant that is given by
//! its formulas, with a matched base frequency. Where the claim is about every set of harmonics, the oscillators may be those of one set (section 14.7).
//!
//! Guarantee of [`prove`]: of a plant that is linear in x and e, `largest` of each entry follows from what `steady` and the witness say of the periodic
//! solution. That these are true of the formulas is proved by the crate `proofs-plants`, whose part has the same name; with trials all that an entry
//! says is, by what follows from a trial in [`tube`] and [`peaks`].

pub mod claimed;
pub mod curves;
mod form;
mod held;
pub mod kept;
pub mod linear;
pub mod oscillators;
pub mod peaks;
pub mod trials;
pub mod tube;
pub mod x_first;

use crate::data::Data;
use crate::json::Field;
use crate::rules::inequality::Inequality;
use crate::rules::sampled::law::Terms;
use crate::rules::set::ClaimedSet;
use crate::spec::Specification;
use crate::verdict::{Outcome, Verdict, bad, finding};
use claimed::{Entry, RULE};
use linear::Linear;
use oscillators::Oscillators;
use rug::Rational;
use trials::Trial;

/// Where the witness stands in a file.
const PLACE: &str = "/witness/by_n_o";

/// What proves what is said by n_o: one of the kinds.
pub enum Witness {
    /// Of a plant that is linear in x and e (section 14.3).
    Linear(Linear),
    /// At one gain of the law (section 14.4): one for each entry of the claim.
    Trials(Vec<Trial>),
}

/// The law of a claim at samples.
#[derive(Clone, Copy)]
pub struct AtSamples<'l> {
    /// Its numbers.
    pub terms: &'l Terms,
    /// Y_0, with a delay.
    pub y_0: Option<&'l Rational>,
}

/// What the claim says besides, and by what it is proved.
pub struct About<'c> {
    /// Its gain.
    pub sigma: &'c Rational,
    /// Its set.
    pub set: &'c ClaimedSet,
    /// D_x and D_e: in this box around its periodic solution errors decay.
    pub error_box: [&'c Rational; 2],
    /// Bounds of |x| and |e| along its periodic solution.
    pub periodic: [Rational; 2],
    /// k0 and k1, proved for every number of oscillators (section 2).
    pub transfer: [&'c Rational; 2],
    /// w_x and h, by which its error decays where no joint metrics say that it does.
    pub weights: [&'c Rational; 2],
    /// The inequality by which it does, where there is one.
    pub stability: Option<&'c Inequality>,
    /// Its law at samples; none in continuous time.
    pub at_samples: Option<AtSamples<'c>>,
}

impl Witness {
    /// Reads the part `by_n_o` of a witness: there exactly if the claim has its part.
    pub fn read(
        field: Option<&Field<'_>>,
        claimed: &[Entry<'_>],
        spec: &Specification,
        at_samples: Option<AtSamples<'_>>,
    ) -> Outcome<Option<Witness>> {
        let field = match (field, claimed.is_empty()) {
            (None, true) => return Ok(None),
            (Some(field), false) => field,
            (None, false) => return bad(PLACE, "it is missing: the claim says something by n_o"),
            (Some(field), true) => return bad(&field.pointer, "the claim says nothing by n_o"),
        };
        let states = spec.plant.as_ref().map_or(0, |plant| plant.states);
        let shape = trials::Shape {
            states,
            intervals: curves::intervals(spec),
            samples: at_samples.map(|law| law.terms.samples),
        };
        let delayed = at_samples.map(|law| law.y_0.is_some());
        let known = field.object(|fields| {
            let linear = fields
                .part("linear", |field| field.object(|fields| Linear::take(fields, claimed, (states, delayed))))?;
            match linear {
                Some(linear) => Ok(Some(Witness::Linear(linear))),
                None => {
                    let trials = fields.part("trials", |field| match delayed {
                        Some(true) => bad(&field.pointer, "of a regulator with a delay nothing is proved by trials"),
                        _ => trials::read_all(field, claimed, shape),
                    })?;
                    Ok(trials.map(Witness::Trials))
                }
            }
        })?;
        known.map_or_else(|| bad(&field.pointer, "expected `linear` or `trials`"), |known| Ok(Some(known)))
    }
}

/// What is known of the periodic solution by the number of oscillators.
#[derive(Clone, Copy)]
pub struct Known<'k> {
    /// What the claim says.
    pub claimed: &'k [Entry<'k>],
    /// By what.
    pub witness: &'k Witness,
}

impl<'k> Known<'k> {
    /// Bounds of `|L^-1 (x - x_0)|`, `|e|` and `|zeta|_N` along it with these oscillators, if there are some. One entry at most is about them: numbers rise,
    /// and `or_more` stands in the last one alone, and is about the first n_o; a set stands once ([`Entry::read_all`]). Nothing of it is proved here: whoever
    /// rests on it has the crate `proofs-plants` prove all that is said by n_o before it says that a claim is valid, as `proofs_check` does.
    pub fn sizes(self, oscillators: &Oscillators) -> Option<[&'k Rational; 3]> {
        let is_about = |entry: &Entry<'_>| match (entry.oscillators.n_o(), oscillators.n_o()) {
            (Some(own), Some(n_o)) => own == n_o || entry.or_more && own <= n_o,
            _ => entry.oscillators == *oscillators,
        };
        let index = self.claimed.iter().position(is_about)?;
        let [x, zeta] = match self.witness {
            Witness::Linear(linear) => linear.sizes.get(index).map(|sizes| [&sizes.x, &sizes.zeta]),
            Witness::Trials(trials) => trials.get(index)?.sizes.as_ref().map(|sizes| [&sizes.x, &sizes.zeta]),
        }?;
        let [e, ..] = &self.claimed[index].steady;
        Some([x, e, zeta])
    }
}

/// What every kind demands of the file: the sections are about one period, its own oscillators, and one orbit.
pub fn demand_form(spec: &Specification, claimed: &[Entry<'_>]) -> Outcome<()> {
    let Some(first) = claimed.first() else { return Ok(()) };
    let undecided = |message: &str| Err(finding(Verdict::Undecided, RULE, &first.pointer, message));
    match &spec.plant {
        None => undecided("it is proved of a plant that is given by its formulas, not of bounding functions"),
        Some(_) if spec.period.exact().is_none() => undecided("it is proved of a period that is one number"),
        Some(_) if !spec.regulator.matched => undecided("it is proved of a `matched` base frequency"),
        Some(plant) if plant.in_cells => undecided("it is proved of parameters that are not cut into `cells`"),
        Some(_) => Ok(()),
    }
}

/// Proves of each entry that `largest` follows from the rest; `about`: the set, the gain and the law at samples of the claim.
pub fn prove(
    d: &Data<'_>,
    about: (&ClaimedSet, &Rational, Option<AtSamples<'_>>),
    (claimed, witness): (&[Entry<'_>], &Witness),
    lines: &mut Vec<String>,
) -> Outcome<()> {
    match witness {
        Witness::Linear(linear) => linear.peaks(d, about, claimed, lines),
        // That rests on what is known of the curves of the trials: the crate `proofs-plants`.
        Witness::Trials(_) => Ok(()),
    }
}
