//! What a run found out.

use super::gain_row::{ByCount, GainRow, RowNoise};
use super::matrix_checks::{MatrixChecks, SylvesterCheck};
use super::options::{Limits, Options};
use super::outcome::{Outcome, is_better};
use super::verdict::Verdict;
use crate::rate::found::RateForCount;
use rug::Rational;
use sigmastar_decide::conditions::BoundingProblem;
use sigmastar_decide::conditions::NoPlant;
use sigmastar_decide::conditions::{Decided, Proof, RepairedProof, SharpProof};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::AskedHarmonics;
use sigmastar_lang::spec::model::Specification;
use sigmastar_propose::search::{Binding, Datum, Failing, Obstacle, OptionalDatum};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::condition::{Condition, all};
use sigmastar_theory::derivation::control::Control;
use sigmastar_theory::derivation::exact_regulation::{ExactEvaluation, ExactWitness};
use sigmastar_theory::derivation::initial_set::ClaimedSet;
use sigmastar_theory::derivation::printed::{Infeasible, PrintedEvaluation};
use sigmastar_theory::derivation::relative_degree::RelativeDegreeError;
use sigmastar_theory::derivation::sharp::SharpEvaluation;
use sigmastar_theory::derivation::table::Row;
use sigmastar_theory::transfer::serves_every_set;
use std::sync::OnceLock;

/// What the printed formulas say about the data; nothing where the data are those of a plant's formulas.
#[derive(Clone, Debug, Default)]
pub struct PrintedFigure {
    /// Why P:eq:boundx_bounde_1 has no solution.
    pub refutation: Option<Infeasible>,
    /// The constants at the free numbers that are best without that condition, when there are any.
    pub evaluation: Option<PrintedEvaluation<Enclosure>>,
    /// The figure that the other conditions would give: max(sigma_p*, sigma_a*).
    pub sigma: Option<Enclosure>,
}

/// The paper's constants beside those of a claim.
#[derive(Clone, Debug)]
pub struct Constants {
    /// The derivation of the claim, at the precision of the table.
    pub sharp: Outcome<SharpProof>,
    /// The repaired derivation; none where it does not apply, or nothing is compared.
    pub repaired: Option<Outcome<RepairedProof>>,
    /// What the printed formulas say.
    pub printed: PrintedFigure,
    /// Sylvester's criterion for R of the repaired derivation.
    pub sylvester: Option<SylvesterCheck>,
    /// Every constant; of a plant those of the claim alone, and none without a proof.
    pub rows: Vec<Row>,
}

/// The exact-regulation claim.
#[derive(Clone, Debug)]
pub struct ExactClaim {
    /// The free numbers.
    pub witness: ExactWitness,
    /// The evaluation.
    pub evaluation: ExactEvaluation,
}

/// The gains from e to xi_1 (derivation, section 6): limsup|xi_1| <= k_inf limsup|e| and, over a period,
/// the integral of xi_1^2 is at most k_2 times that of e^2.
#[derive(Clone, Debug)]
pub struct RelativeDegreeGains {
    /// k_inf, in units of time^(r-1).
    pub k_inf: Enclosure,
    /// k_2, in units of time^(2r-2).
    pub k_2: Enclosure,
}

/// sigma* in other ways; floating point, claimed by nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Alternatives {
    /// With stability by norms, where it is proved by a matrix inequality: at few samples, and in coordinates that are no further
    /// improved where the inequality does far better. None where that is not above sigma*.
    pub by_norms: Option<f64>,
    /// With an aligned start, where the start is another one and that lowers sigma* by a share that matters.
    pub aligned: Option<f64>,
    /// With the input gain known to be the nominal one, where it is uncertain; by the kind of proof that the claim has.
    pub nominal_gain: Option<f64>,
}

/// Everything a run found out.
#[derive(Clone, Debug)]
pub struct Certification<'s> {
    /// The specification.
    pub spec: &'s Specification,
    /// The options of the run.
    pub options: Options,
    /// The gain that was asked about, where the smallest one was not sought.
    pub given_gain: Option<Rational>,
    /// What was to be kept at the gain.
    pub limits: Limits,
    /// About the smallest gain, where it is another one that was sought; floating point.
    pub smallest_gain: Option<f64>,
    /// The verdict.
    pub verdict: Verdict,
    /// The derivation of the claim.
    pub sharp: Outcome<SharpProof>,
    /// At a gain that is given, of a document with noise or a disturbance: a proof whose error box has more room than that of the claim.
    pub(crate) roomy: Option<Box<SharpProof>>,
    /// k_inf and k_2, when the specification has a relative degree, or why there are none.
    pub relative_degree: Option<Result<RelativeDegreeGains, RelativeDegreeError>>,
    /// Exact regulation, when the base frequency is matched and a claim was proved.
    pub exact: Option<ExactClaim>,
    /// The conditions that are not proved of an exact-regulation claim that was given to be decided again.
    pub exact_failing: Vec<Condition>,
    /// What the matrix inequalities say; a disagreement keeps the claim from being certified.
    pub checks: MatrixChecks,
    /// That no plant with a state x satisfies the data, where it is proved; the claim then says nothing about any.
    pub no_plant: Option<NoPlant>,
    /// Which condition sets sigma*, according to the search.
    pub binding: Option<Binding>,
    /// For each optional datum that is given, sigma* without it (an estimate), and none where nothing is found then.
    pub without_optional: Vec<(OptionalDatum, Option<f64>)>,
    /// By how much sigma* falls (relatively) when a datum improves by 1 %, largest first; floating point.
    pub sensitivities: Vec<(Datum, f64)>,
    /// sigma* in other ways.
    pub alternatives: Alternatives,
    /// For each parameter with an interval sigma* with it closed to the nominal value (an estimate), and none where nothing is found
    /// then; empty unless the run was to compare.
    pub interval_costs: Vec<(String, Option<f64>)>,
    /// Bounds at the gain of the claim and at larger ones; empty without a claim, with an actuator, and where no search was made.
    pub gains: Vec<GainRow>,
    /// Bounds for each number of oscillators at the gain of the claim, of a plant that is linear in x and e; with the rows.
    pub by_count: Option<ByCount>,
    /// What is proved of noise at the gains of these rows, for the numbers of oscillators that were asked about.
    pub noise_of_rows: Vec<RowNoise>,
    /// Bounding functions that were neither proved nor refuted.
    pub unproved_bounds: Vec<BoundingProblem>,
    /// [`Certification::constants`], once it was asked for.
    pub(crate) constants: OnceLock<Constants>,
    /// For each number of oscillators that was asked about its rate at the gain of the claim.
    pub for_n_o: Vec<RateForCount>,
    /// The precision at which the numbers of the claim are known well.
    pub precision: u32,
}

impl Certification<'_> {
    /// What was decided, proved or not; `None` where there was no witness.
    #[must_use]
    pub fn attempt(&self) -> Option<Decided<'_>> {
        self.sharp.attempt().map(Proof::decided)
    }

    /// The proof of the claim, if certified.
    #[must_use]
    pub fn claim(&self) -> Option<Decided<'_>> {
        // The verdict says so already; a claim is not to rest on one field.
        self.attempt().filter(|attempt| self.verdict == Verdict::Certified && all(attempt.conditions).is_true())
    }

    /// The claimed gain, if certified.
    #[must_use]
    pub fn sigma_star(&self) -> Option<&Rational> {
        self.claim().map(|claim| claim.sigma)
    }

    /// Whether the gain of the claim is the smallest one that was found: none was given, and nothing was to be kept.
    #[must_use]
    pub fn is_smallest(&self) -> bool {
        self.given_gain.is_none() && self.limits.is_empty() && self.spec.actuator.is_none()
    }

    /// Whether this claim has a smaller gain than another one, or at the same gain a smaller bound of |e|.
    #[must_use]
    pub fn is_better_than(&self, other: &Certification<'_>) -> bool {
        let [one, other] = [self, other].map(|run| run.sharp.proved().filter(|_| run.claim().is_some()));
        one.zip(other).is_some_and(|(one, other)| is_better(one, other))
    }

    /// Whether this run, without a claim, comes closer to what was to be kept than another one.
    #[must_use]
    pub fn closer_to_limits_than(&self, other: &Certification<'_>) -> bool {
        // What a claim keeps to comes first.
        let missed = |run: &Certification<'_>| match &run.sharp {
            Outcome::NotFound(Obstacle { failing: Failing::Limit { asked, least, proved, .. }, .. }) => {
                (!proved, least / asked)
            }
            _ => (true, f64::INFINITY),
        };
        missed(self) < missed(other)
    }

    /// Bounds of |e| along the periodic solution and on the way, and of the control, at the gain of the claim, if certified.
    #[must_use]
    pub fn bounds(&self) -> Option<(&Enclosure, &Enclosure, &Control<Enclosure>)> {
        let proof = self.sharp.proved().filter(|_| self.claim().is_some())?;
        let SharpEvaluation { periodic, peak, control, .. } = &proof.evaluation;
        Some((&periodic.e_per, peak, control))
    }

    /// Whether the claim is about every finite set of harmonics that contains 0, not about the first `n_o` alone (derivation, 14.7): where its proof of
    /// the transfer bound serves them, the period is known exactly, and nothing else is asked for.
    #[must_use]
    pub fn is_for_every_set(&self) -> bool {
        let first = self.spec.internal_model.harmonics == Some(AskedHarmonics::First);
        let serves = |claim: Decided<'_>| serves_every_set(&Data::new(self.spec, claim.precision), claim.transfer);
        !first && self.spec.period.interval().is_none() && self.claim().is_some_and(serves)
    }

    /// The claimed initial set, if certified.
    #[must_use]
    pub fn claimed_set(&self) -> Option<&ClaimedSet> {
        self.claim().map(|claim| claim.set)
    }

    /// The conditions, proved or not.
    #[must_use]
    pub fn conditions(&self) -> &[Condition] {
        self.attempt().map_or(&[], |attempt| attempt.conditions)
    }

    /// Upper bounds of the periodic solution, |x|, |e|, |zeta|_N and |z|_N, if certified.
    #[must_use]
    pub fn periodic_solution(&self) -> Option<[Enclosure; 4]> {
        let claim = self.claim()?;
        let [x, e, zeta] = claim.periodic.map(Enclosure::clone);
        let n_bar = Data::new(self.spec, claim.precision).numbers.n_bar;
        let z = &zeta + n_bar * &e;
        Some([x, e, zeta, z])
    }
}
