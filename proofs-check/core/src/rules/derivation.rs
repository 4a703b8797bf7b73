//! A derivation with its witness, as a certificate gives it: read, evaluated, and every condition demanded.
//!
//! Guarantee of [`Derivation::prove`]: all conditions of the derivation hold for the witness, the bounding functions are
//! as they must be up to every argument that is used, and so the claim at `sigma` and `set` is proved.

use super::by_n_o::AtSamples;
use super::common::{Evaluated, Free};
use super::inequality::{Inequality, List};
use super::sampled::{self, claim::Regulator};
use super::set::ClaimedSet;
use super::{bounding, rates, regulation, sharp};
use crate::actuator;
use crate::data::Data;
use crate::interval::Interval;
use crate::json::Fields;
use crate::scope::Scope;
use crate::verdict::{Condition, Outcome, Verdict, bad, finding};
use rug::Rational;

/// What a claim about either regulator has of its own.
pub enum Witness {
    /// In continuous time: sections 5 and 10.
    Sharp(Box<sharp::Witness>),
    /// A sampled regulator: section 12.
    Sampled(Box<sampled::Witness>),
}

/// What has to be proved of a plant's formulas besides their bounds, where stability or existence rests on it.
#[derive(Clone, Copy, Default)]
pub struct Inequalities<'w> {
    /// Those of stability and of existence.
    pub list: Option<&'w List>,
    /// The law that they are about, of a regulator at samples.
    pub law: Option<&'w sampled::law::Terms>,
    /// (D), of the rates that a claim by an inequality has.
    pub slopes: Option<rates::Asked<'w>>,
}

/// One derivation with its witness.
pub struct Derivation {
    /// The numbers that both regulators have. X_p and E_p bound the periodic solution exactly.
    pub free: Free,
    /// What proves that the error decays in the place of C5, or C5h, and what adds to S1 and S2, where they are given.
    pub inequalities: List,
    pub witness: Witness,
    /// Exact regulation, which a claim in continuous time may add.
    pub regulation: Option<Box<regulation::Witness>>,
}

impl Derivation {
    /// Takes the free numbers out of a witness; what is left there is the caller's to read or to refuse. `scope`: which
    /// oscillators the claim is about.
    pub fn read(fields: &mut Fields<'_>, sigma: Rational, (set, scope): (ClaimedSet, Scope)) -> Outcome<Derivation> {
        if fields.has("p_x") && !fields.has("r_x") {
            return bad(&fields.pointer, "this witness, by p_x and p_e, is of an older form: certify again");
        }
        let free = Free::read(fields, set)?;
        let inequalities = List::read(fields, [&free.w_x, &free.h], None)?;
        let witness = Witness::Sharp(Box::new(sharp::Witness::read(fields, (sigma, scope), &free)?));
        let regulation = fields.part("exact_regulation", regulation::Witness::read)?.map(Box::new);
        Ok(Derivation { free, inequalities, witness, regulation })
    }

    /// Takes the free numbers of a claim about a sampled regulator out of a witness.
    pub fn read_sampled(
        fields: &mut Fields<'_>,
        regulator: &Regulator<'_>,
        (set, scope): (ClaimedSet, Scope),
    ) -> Outcome<Derivation> {
        let free = Free::read(fields, set)?;
        let inequalities = List::read(fields, [&free.w_x, &free.h], Some(&regulator.sigma))?;
        if let Some(part) = inequalities.all().next().filter(|_| regulator.delayed) {
            return bad(&part.pointer, "a matrix inequality says nothing of a law with a delay");
        }
        let witness = Witness::Sampled(Box::new(sampled::Witness::read(fields, regulator, scope)?));
        Ok(Derivation { free, inequalities, witness, regulation: None })
    }

    /// The largest X and E of exact regulation, where that is claimed.
    pub fn regulated(&self, d: &Data<'_>) -> Option<[Interval; 2]> {
        self.regulation.as_ref().map(|w| [d.number(&w.d_x), d.number(&w.d_e)])
    }

    /// Whether the error decays by C5 or, at samples without a delay, by C5h.
    pub fn rests_on_norms(&self) -> bool {
        self.inequalities.stability.is_none() && self.prediction().is_none()
    }

    /// The law of a claim at samples.
    pub fn law(&self) -> Option<&sampled::law::Terms> {
        match &self.witness {
            Witness::Sharp(_) => None,
            Witness::Sampled(w) => Some(&w.terms),
        }
    }

    /// The same with what a start of it is known by.
    pub fn at_samples(&self) -> Option<AtSamples<'_>> {
        match &self.witness {
            Witness::Sharp(_) => None,
            Witness::Sampled(w) => Some(AtSamples { terms: &w.terms, y_0: w.past.as_ref().map(|past| &past.y_0) }),
        }
    }

    /// (X, E) at which the inequality by which the error decays has (J, r), and (g, d), in continuous time; none where it does by norms.
    pub fn regions(&self) -> Option<[[&Rational; 2]; 2]> {
        self.inequalities.stability.as_ref().filter(|part| !part.at_samples).map(Inequality::arguments)
    }

    /// Whether it is an inequality with a splitting, on a path with a corner.
    pub fn has_corner(&self) -> bool {
        self.inequalities.stability.as_ref().is_some_and(|part| part.splitting.is_some())
    }

    /// Y_0 as it is written, of a law with a delay.
    pub fn prediction(&self) -> Option<&str> {
        match &self.witness {
            Witness::Sharp(_) => None,
            Witness::Sampled(w) => w.past.as_ref().map(|past| past.text.as_str()),
        }
    }

    /// Evaluates the conditions; the transfer bound is proved, and the others are left to be demanded.
    pub fn evaluate(&self, d: &Data<'_>) -> Outcome<Evaluated> {
        let common = (&self.free, &self.inequalities);
        match &self.witness {
            Witness::Sharp(w) => sharp::evaluate(d, common, w),
            Witness::Sampled(w) => sampled::evaluate(d, common, w),
        }
    }

    /// Proves the derivation: its conditions, and the bounding functions up to its arguments.
    pub fn prove(&self, d: &Data<'_>, lines: &mut Vec<String>) -> Outcome<Evaluated> {
        let evaluated = self.evaluate(d)?;
        let (name, sigma) = match &self.witness {
            Witness::Sharp(w) => ("sharp", &w.sigma),
            Witness::Sampled(w) => ("sampled", &w.terms.sigma),
        };
        let Free { pointer, set, .. } = &self.free;
        lines.push(format!("{name} derivation, sigma = {sigma}"));
        all(name, pointer, evaluated.transfer.iter().chain(&evaluated.conditions), lines)?;
        without_domain(d, &evaluated.arguments, lines)?;
        if let Some(exact) = &self.regulation {
            if d.spec.actuator.is_some() {
                let message = "with an actuator nothing is proved of infinitely many oscillators";
                return Err(finding(Verdict::Undecided, actuator::RULE, &exact.pointer, message));
            }
            lines.push(format!("exact regulation, sigma_oo = {}", exact.sigma));
            let conditions = regulation::evaluate(d, set, exact, self.inequalities.stability.as_ref())?;
            all("exact regulation", &exact.pointer, conditions.iter(), lines)?;
            without_domain(d, &[d.number(&exact.d_x), d.number(&exact.d_e)], lines)?;
        }
        Ok(evaluated)
    }
}

/// Without a domain the bounding functions are proved up to the arguments that are used.
fn without_domain(d: &Data<'_>, [x, e]: &[Interval; 2], lines: &mut Vec<String>) -> Outcome<()> {
    // Those of a plant are numbers, which are proved apart.
    if d.spec.domain.is_some() || d.spec.plant.is_some() { Ok(()) } else { bounding::prove_all(d, [x, e], lines) }
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
