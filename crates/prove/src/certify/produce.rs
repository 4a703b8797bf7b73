//! The whole run: prove the bounding functions, search, round, decide.

use super::certification::{Alternatives, Certification, ExactClaim, RelativeDegreeGains};
use super::least_limit::with_least_kept;
use super::matrix_checks::MatrixChecks;
use super::options::{Limits, Options};
use super::outcome::{Outcome, failing};
use super::pool::{BestSharp, Member, Wanted};
use super::precision::refined;
use super::refusal::Refusal;
use super::round::exact_claim;
use super::sensitivity::{aligned, ranked, with_nominal_gain};
use super::verdict::Verdict;
use rug::Rational;
use sigmastar_decide::conditions::no_plant;
use sigmastar_decide::conditions::{BoundingProblem, prove_on_domain, prove_up_to};
use sigmastar_decide::conditions::{GivenWitness, Proof, SharpProof, Witness};
use sigmastar_decide::conditions::{decide, decide_exact};
use sigmastar_lang::expr::BoundingFailure;
use sigmastar_lang::spec::model::Specification;
use sigmastar_propose::search::{Failing, FloatModel, Goal, Obstacle, SharpProposal, without_optional_data};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::condition::Condition;
use sigmastar_theory::derivation::exact_regulation::ExactWitness;
use sigmastar_theory::derivation::relative_degree::{RelativeDegreeError, k_2, k_infinity};
use sigmastar_theory::transfer::TradeOff;
use std::sync::OnceLock;

/// Certifies a specification: search, then rigorous decision.
///
/// Guarantee: the verdict is `Certified` only if the bounding functions are proved on every argument used and every
/// condition is proved for the witness. With an actuator the gain is the smallest one that is found for which C6 holds.
///
/// # Errors
/// Bounding functions that are *refuted*, with their counterexamples, and an unstable filter: bad input.
pub fn certify(spec: &Specification, options: Options) -> Result<Certification<'_>, Refusal> {
    certify_for(spec, options, Wanted::default())
}

/// The same as it is wanted: from a start that is known; for the smallest gain that is found with which limits are kept, or for one that is given,
/// which is that of the claim then. A claim that is proved keeps to the limits at its gain.
///
/// # Errors
/// Those of [`certify`].
pub fn certify_for<'s>(
    spec: &'s Specification,
    options: Options,
    asked: Wanted<'_>,
) -> Result<Certification<'s>, Refusal> {
    if spec.internal_model.sampling.is_some() {
        return Err(Refusal::Sampled);
    }
    let member = Member::new(spec, asked.start, options);
    let mut run = certify_member(&member, options, asked)?;
    if options.compare {
        run.set_gains(&[member], &[]);
    }
    Ok(run)
}

/// The same of a member of a pool, without the rows of larger gains ([`Certification::set_gains`]).
///
/// # Errors
/// Those of [`certify`].
pub fn certify_member<'s>(
    member: &Member<'s>,
    options: Options,
    asked: Wanted<'_>,
) -> Result<Certification<'s>, Refusal> {
    let Member { spec, data, .. } = member;
    let spec = *spec;
    if spec.internal_model.sampling.is_some() {
        return Err(Refusal::Sampled);
    }
    let mut unproved = undecided_or_error(prove_on_domain(spec))?;
    let BestSharp { model: sharp_model, proposal, outcome: sharp, roomy, smallest_gain } = member.best(asked);
    let sharp = match sharp {
        Outcome::NotFound(Obstacle { failing, at }) if options.compare => {
            let none = Limits::default();
            let failing = with_least_kept(spec, asked.limits.unwrap_or(&none), failing, |spec, limits, _| {
                let found = member.about(spec).best(Wanted { limits: Some(limits), ..asked }).outcome;
                proved_up_to_arguments(spec, found).proved().map(|proof| proof.witness.sigma.to_f64())
            });
            Outcome::NotFound(Obstacle { failing, at })
        }
        sharp => sharp,
    };
    // Figures about the smallest gain say nothing about one that is given.
    let limited = spec.actuator.is_some() || asked.limits.is_some_and(|limits| !limits.is_empty());
    let proposal = proposal.filter(|_| asked.gain.is_none() && !limited);
    let (sharp, result) = up_to_arguments(spec, sharp);
    unproved.extend(undecided_or_error(result)?);
    let exact = match (&sharp, spec.internal_model.matched) {
        // It is of another gain.
        (Outcome::Proved(proof), true) if spec.actuator.is_none() => {
            exact_claim(data, &sharp_model.with_goal(Goal::default()), &proof.witness.set, options.ladder)
                // Its error box has its own size, and may reach beyond the arguments of the claim.
                .filter(|claim| {
                    let ExactWitness { d_x, d_e, .. } = &claim.witness;
                    spec.domain.is_some() || prove_up_to(spec, d_x, d_e).is_ok()
                })
        }
        _ => None,
    };
    let parts = Parts { sharp, exact, exact_failing: Vec::new(), unproved, proposal };
    let run = assemble(spec, options, data, parts, &sharp_model)?;
    let limits = asked.limits.cloned().unwrap_or_default();
    Ok(Certification { given_gain: asked.gain.cloned(), limits, roomy, smallest_gain, ..run })
}

/// Decides the witness of a certificate again, without any search.
///
/// Guarantee: as for [`certify`]; and a file that claims exact regulation is `Certified` only if that claim is proved too.
/// The verdict is `Refuted` when a condition is proved not to hold for the witness (another witness may still do).
///
/// # Errors
/// Bounding functions that are *refuted*, with their counterexamples, and an unstable filter: bad input.
pub fn recheck<'s>(
    spec: &'s Specification,
    file: &GivenWitness,
    options: Options,
) -> Result<Certification<'s>, Refusal> {
    if spec.internal_model.sampling.is_some() {
        return Err(Refusal::Sampled);
    }
    let data = Data::new(spec, options.ladder.start.max(53));
    let GivenWitness { witness, exact } = file;
    let sharp = Some(decide(spec, witness.as_ref().clone(), options.ladder)).into();
    // With an actuator it is not claimed: it is about other gains.
    let claimed = exact.as_ref().filter(|_| spec.actuator.is_none()).map(|exact| ExactClaim {
        witness: exact.clone(),
        evaluation: decide_exact(spec, &witness.set, exact, options.ladder),
    });
    let mut unproved = undecided_or_error(prove_on_domain(spec))?;
    let (sharp, result) = up_to_arguments(spec, sharp);
    unproved.extend(undecided_or_error(result)?);
    if let (None, Some(claim)) = (&spec.domain, &claimed) {
        unproved.extend(undecided_or_error(prove_up_to(spec, &claim.witness.d_x, &claim.witness.d_e))?);
    }
    let exact_failing = claimed.as_ref().map_or_else(Vec::new, |claim| failing(&claim.evaluation.conditions));
    let exact = claimed.filter(|_| exact_failing.is_empty());
    let model = FloatModel::new(&data, TradeOff::closed_form(&data));
    let parts = Parts { sharp, exact, exact_failing, unproved, proposal: None };
    // Nothing is searched for, what would be compared included.
    let mut run = assemble(spec, Options { compare: false, ..options }, &data, parts, &model)?;
    // A given witness that breaks a condition is refuted; a search that ends with one has merely found nothing.
    let mut conditions = run.conditions().iter().chain(&run.exact_failing);
    if run.verdict == Verdict::Undecided && conditions.any(|condition| condition.truth().is_false()) {
        run.verdict = Verdict::Refuted;
    }
    Ok(run)
}

/// What the stages of a run produced.
struct Parts {
    sharp: Outcome<SharpProof>,
    exact: Option<ExactClaim>,
    exact_failing: Vec<Condition>,
    unproved: Vec<BoundingProblem>,
    proposal: Option<SharpProposal>,
}

fn assemble<'s>(
    spec: &'s Specification,
    options: Options,
    data: &Data<'_>,
    parts: Parts,
    model: &FloatModel,
) -> Result<Certification<'s>, Refusal> {
    let Parts { sharp, exact, exact_failing, unproved, proposal } = parts;
    let relative_degree = relative_degree_gains(spec, data.precision);
    if let Some(Err(error @ RelativeDegreeError::NotHurwitz(_))) = relative_degree {
        return Err(Refusal::Filter(error));
    }
    let checks = MatrixChecks::new(spec, sharp.proved());
    let proved = sharp.proved().is_some() && unproved.is_empty() && exact_failing.is_empty() && !checks.disagree();
    let verdict = if proved { Verdict::Certified } else { Verdict::Undecided };
    let (sharp, precision) = refined(sharp, spec, options.ladder);
    let known = sharp.proved().zip(proposal.as_ref());
    let sensitivities = known.map_or_else(Vec::new, |(proof, proposal)| ranked(spec, model, proposal, proof));
    let aligned = known.and_then(|(_, proposal)| aligned(model, proposal));
    let nominal_gain = known.and_then(|(proof, proposal)| with_nominal_gain(spec, model, proposal, proof));
    let alternatives = Alternatives { by_norms: None, aligned, nominal_gain };
    // Without a domain, the claim is about the arguments it uses; without a claim, about all.
    let used = sharp.proved().and_then(|proof| proof.decided().reach());
    let no_plant = no_plant(data, used.as_ref().filter(|_| spec.domain.is_none()));
    let of_specification = known.filter(|_| spec.plant().is_none());
    let without_optional = of_specification.map_or_else(Vec::new, |_| without_optional_data(model));
    Ok(Certification {
        spec,
        options,
        verdict,
        binding: proposal.map(|proposal| proposal.binding),
        precision,
        sharp,
        roomy: None,
        relative_degree,
        exact,
        exact_failing,
        checks,
        no_plant,
        sensitivities,
        alternatives,
        interval_costs: Vec::new(),
        without_optional,
        gains: Vec::new(),
        by_count: None,
        noise_of_rows: Vec::new(),
        unproved_bounds: unproved,
        constants: OnceLock::new(),
        for_n_o: Vec::new(),
        given_gain: None,
        limits: Limits::default(),
        smallest_gain: None,
    })
}

/// k_inf and k_2 of the specification's filter, if it has one.
fn relative_degree_gains(
    spec: &Specification,
    precision: u32,
) -> Option<Result<RelativeDegreeGains, RelativeDegreeError>> {
    let filter = spec.relative_degree.as_ref()?;
    // The reader has refused irrational coefficients.
    let a: Option<Vec<Rational>> = filter.a.iter().map(|a| a.as_rational().cloned()).collect();
    let a = a?;
    Some(k_infinity(&a, precision).and_then(|k_inf| Ok(RelativeDegreeGains { k_inf, k_2: k_2(&a, precision)? })))
}

/// Splits failures of the bounding functions: refuted ones are errors, undecided ones keep a claim from being made.
pub(super) fn undecided_or_error(result: Result<(), Vec<BoundingProblem>>) -> Result<Vec<BoundingProblem>, Refusal> {
    let problems = result.err().unwrap_or_default();
    let (refuted, undecided): (Vec<_>, Vec<_>) =
        problems.into_iter().partition(|problem| matches!(problem.failure, BoundingFailure::Refuted { .. }));
    if refuted.is_empty() { Ok(undecided) } else { Err(Refusal::Bounds(refuted)) }
}

/// An outcome with what comes of proving the bounding functions up to the arguments that its proof uses; with a domain they are proved already.
fn up_to_arguments<W: Witness>(
    spec: &Specification,
    outcome: Outcome<Proof<W>>,
) -> (Outcome<Proof<W>>, Result<(), Vec<BoundingProblem>>) {
    let (None, Some(proof)) = (&spec.domain, outcome.attempt()) else { return (outcome, Ok(())) };
    match proof.decided().reach() {
        Some([x, e]) => (outcome, prove_up_to(spec, &x, &e)),
        None => (Outcome::NotFound(Failing::NotFinite(None).into()), Ok(())),
    }
}

/// An outcome on which no claim rests; bounding functions that are not proved take its proof away.
pub(super) fn proved_up_to_arguments<W: Witness>(
    spec: &Specification,
    outcome: Outcome<Proof<W>>,
) -> Outcome<Proof<W>> {
    match up_to_arguments(spec, outcome) {
        (outcome, Ok(())) => outcome,
        (_, Err(_)) => Outcome::NotFound(Failing::Bounds.into()),
    }
}
