//! A derivation with its witness, as a certificate gives it: read, evaluated, and every condition demanded.
//!
//! Guarantee of [`Derivation::prove`]: all conditions of the derivation hold for the witness, the bounding functions are
//! as they must be up to every argument that is used, and so the claim at `sigma` and `set` is proved.

use super::common::{Evaluated, Free};
use super::existence::Existence;
use super::inequality::Inequality;
use super::joint::Joint;
use super::sampled::{self, claim::Regulator};
use super::set::ClaimedSet;
use super::{bounding, rates, regulation, sharp};
use crate::actuator;
use crate::data::Data;
use crate::interval::Interval;
use crate::json::Fields;
use crate::verdict::{Condition, Outcome, Verdict, finding};
use rug::Rational;

/// The free numbers of a claim about either regulator.
pub enum Witness {
    /// In continuous time: sections 5 and 10.
    Sharp(Box<sharp::Witness>),
    /// A sampled regulator: section 12.
    Sampled(Box<sampled::Witness>),
}

/// What has to be proved of a plant's formulas besides their bounds, where stability or existence rests on it.
#[derive(Clone, Copy, Default)]
pub struct Inequalities<'w> {
    pub stability: Option<&'w Inequality>,
    pub joint: Option<&'w Joint>,
    pub existence: Option<&'w Existence>,
    /// (D), of the rates that a claim by one of the first two has.
    pub slopes: Option<rates::Asked<'w>>,
    /// Those of a sampled regulator, with its law.
    pub at_samples: Option<sampled::inequality::Inequalities<'w>>,
}

/// One derivation with its witness.
pub struct Derivation {
    pub witness: Witness,
    /// Exact regulation, which a claim in continuous time may add.
    pub regulation: Option<Box<regulation::Witness>>,
}

impl Derivation {
    /// Takes the free numbers out of a witness; what is left there is the caller's to read or to refuse.
    pub fn read(fields: &mut Fields<'_>, sigma: Rational, set: ClaimedSet) -> Outcome<Derivation> {
        let witness = Witness::Sharp(Box::new(sharp::Witness::read(fields, sigma, set)?));
        let regulation = fields.part("exact_regulation", regulation::Witness::read)?.map(Box::new);
        Ok(Derivation { witness, regulation })
    }

    /// Takes the free numbers of a claim about a sampled regulator out of a witness.
    pub fn read_sampled(fields: &mut Fields<'_>, regulator: &Regulator<'_>, set: ClaimedSet) -> Outcome<Derivation> {
        let witness = Witness::Sampled(Box::new(sampled::Witness::read(fields, regulator, set)?));
        Ok(Derivation { witness, regulation: None })
    }

    /// The largest X and E of exact regulation, where that is claimed.
    pub fn regulated(&self, d: &Data<'_>) -> Option<[Interval; 2]> {
        self.regulation.as_ref().map(|w| [d.number(&w.d_x), d.number(&w.d_e)])
    }

    /// Those of the witness.
    pub fn inequalities(&self) -> Inequalities<'_> {
        match &self.witness {
            Witness::Sharp(w) => Inequalities {
                stability: w.stability.matrix(),
                joint: w.stability.joint(),
                existence: w.existence.inequality.as_ref(),
                ..Inequalities::default()
            },
            Witness::Sampled(w) => Inequalities { at_samples: Some(w.inequalities()), ..Inequalities::default() },
        }
    }

    /// Whether the error decays by C5 or, at samples without a delay, by C5h.
    pub fn rests_on_norms(&self) -> bool {
        match &self.witness {
            Witness::Sharp(w) => matches!(w.stability, sharp::Stability::Norms),
            Witness::Sampled(w) => w.stability.is_none() && w.past.is_none(),
        }
    }

    /// The law of a claim at samples.
    pub fn law(&self) -> Option<&sampled::law::Terms> {
        match &self.witness {
            Witness::Sharp(_) => None,
            Witness::Sampled(w) => Some(&w.terms),
        }
    }

    /// (X, E) at which the inequality by which the error decays has (J, r), and (g, d), in continuous time; none where it does by norms.
    pub fn regions(&self) -> Option<[[&Rational; 2]; 2]> {
        let Inequalities { stability, joint, .. } = self.inequalities();
        stability.map(Inequality::arguments).or_else(|| joint.map(|part| [[&part.x, &part.e]; 2]))
    }

    /// Whether it is an inequality with a splitting, on a path with a corner.
    pub fn has_corner(&self) -> bool {
        self.inequalities().stability.is_some_and(|part| part.splitting.is_some())
    }

    /// Y_0 as it is written, of a law with a delay.
    pub fn prediction(&self) -> Option<&str> {
        match &self.witness {
            Witness::Sharp(_) => None,
            Witness::Sampled(w) => w.past.as_ref().map(|past| past.text.as_str()),
        }
    }

    /// The numbers that both regulators have. X_p and E_p bound the periodic solution exactly.
    pub fn free(&self) -> &Free {
        match &self.witness {
            Witness::Sharp(w) => &w.free,
            Witness::Sampled(w) => &w.free,
        }
    }

    /// Evaluates the conditions; the transfer bound is proved, and the others are left to be demanded.
    pub fn evaluate(&self, d: &Data<'_>) -> Outcome<Evaluated> {
        match &self.witness {
            Witness::Sharp(w) => sharp::evaluate(d, w),
            Witness::Sampled(w) => sampled::evaluate(d, w),
        }
    }

    /// Proves the derivation: its conditions, and the bounding functions up to its arguments.
    pub fn prove(&self, d: &Data<'_>, lines: &mut Vec<String>) -> Outcome<Evaluated> {
        let evaluated = self.evaluate(d)?;
        let (name, sigma) = match &self.witness {
            Witness::Sharp(w) => ("sharp", &w.sigma),
            Witness::Sampled(w) => ("sampled", &w.terms.sigma),
        };
        let Free { pointer, set, .. } = self.free();
        lines.push(format!("{name} derivation, sigma = {sigma}"));
        all(name, pointer, evaluated.transfer.iter().chain(&evaluated.conditions), lines)?;
        without_domain(d, &evaluated.arguments, lines)?;
        if let Some(exact) = &self.regulation {
            if d.spec.actuator.is_some() {
                let message = "with an actuator nothing is proved of infinitely many oscillators";
                return Err(finding(Verdict::Undecided, actuator::RULE, &exact.pointer, message));
            }
            lines.push(format!("exact regulation, sigma_oo = {}", exact.sigma));
            let Inequalities { stability, joint, .. } = self.inequalities();
            let conditions = regulation::evaluate(d, set, exact, (stability, joint))?;
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
