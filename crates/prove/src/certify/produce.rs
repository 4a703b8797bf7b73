//! The whole run: prove the bounding functions, search, round, decide, in each derivation.

use super::certification::{Alternatives, Certification, ExactClaim, PrintedFigure, RelativeDegreeGains};
use super::constants::Columns;
use super::least_limit::with_least_kept;
use super::matrix_checks::MatrixChecks;
use super::options::{Limits, Options};
use super::outcome::{Outcome, failing};
use super::pool::{BestSharp, Member, Wanted, model};
use super::refusal::Refusal;
use super::round::{TransferKind, exact_claim, round_repaired};
use super::sensitivity::{aligned, ranked, with_nominal_gain};
use super::verdict::Verdict;
use rug::Rational;
use sigmastar_decide::conditions::no_plant;
use sigmastar_decide::conditions::{BoundingProblem, prove_on_domain, prove_up_to};
use sigmastar_decide::conditions::{GivenWitness, Proof, RepairedProof, SharpProof, Witness};
use sigmastar_decide::conditions::{decide, decide_exact};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::expr::BoundingFailure;
use sigmastar_lang::spec::model::Specification;
use sigmastar_propose::search::{
    Failing, FloatModel, Goal, Obstacle, SharpProposal, search_printed, search_repaired, without_optional_data,
};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::condition::Condition;
use sigmastar_theory::derivation::exact_regulation::ExactWitness;
use sigmastar_theory::derivation::printed::{PrintedEvaluation, level_condition};
use sigmastar_theory::derivation::relative_degree::{RelativeDegreeError, k_2, k_infinity};
use sigmastar_theory::transfer::{TradeOff, printed_transfer};

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
        run.set_gains(&[member]);
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

    let paper_model = model(data, TransferKind::ClosedForm);
    // From a plant's formulas only the data of the claim are computed; the other derivations know of no input gain, and
    // of no interval of the period: their K_alpha falls as T grows.
    let others = spec.plant().is_none() && data.input_gain.is_none() && spec.period.interval().is_none();
    // They know of no actuator either.
    let others = others && spec.actuator.is_none();
    let repaired = (options.compare && others).then(|| match search_repaired(&paper_model) {
        Err(obstacle) => Outcome::NotFound(obstacle),
        Ok(proposal) => round_repaired(data, &paper_model, &proposal, options.ladder).into(),
    });
    let BestSharp { model: sharp_model, proposal, outcome: sharp, roomy, smallest_gain } = member.best(asked);
    let sharp = match sharp {
        Outcome::NotFound(Obstacle { failing, at }) if options.compare => {
            let none = Limits::default();
            let failing = with_least_kept(spec, asked.limits.unwrap_or(&none), failing, |spec, limits, _| {
                let found = member.about(spec).best(Wanted { limits: Some(limits), ..asked }).outcome;
                let proved = proved_up_to_arguments(spec, found, None).ok()?;
                proved.proved().map(|proof| proof.witness.sigma.to_f64())
            });
            Outcome::NotFound(Obstacle { failing, at })
        }
        sharp => sharp,
    };
    // Figures about the smallest gain say nothing about one that is given.
    let limited = spec.actuator.is_some() || asked.limits.is_some_and(|limits| !limits.is_empty());
    let proposal = proposal.filter(|_| asked.gain.is_none() && !limited);
    let sharp = proved_up_to_arguments(spec, sharp, Some(&mut unproved))?;
    let repaired = repaired.map(|outcome| proved_up_to_arguments(spec, outcome, None)).transpose()?;
    let printed = if others { printed_figure(data, &paper_model) } else { PrintedFigure::default() };
    let exact = match (&sharp, spec.internal_model.matched) {
        // It is of another gain.
        (Outcome::Proved(proof), true) if spec.actuator.is_none() => {
            exact_claim(data, &sharp_model.with_goal(Goal::default()), &proof.witness.set, options.ladder)
                // Its error box has its own size, and may reach beyond the arguments of the other derivations.
                .filter(|claim| {
                    let ExactWitness { d_x, d_e, .. } = &claim.witness;
                    spec.domain.is_some() || prove_up_to(spec, d_x, d_e).is_ok()
                })
        }
        _ => None,
    };
    let parts = Parts { sharp, repaired, printed, exact, exact_failing: Vec::new(), unproved, proposal };
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
    let sharp = proved_up_to_arguments(spec, sharp, Some(&mut unproved))?;
    if let (None, Some(claim)) = (&spec.domain, &claimed) {
        unproved.extend(undecided_or_error(prove_up_to(spec, &claim.witness.d_x, &claim.witness.d_e))?);
    }
    let exact_failing = claimed.as_ref().map_or_else(Vec::new, |claim| failing(&claim.evaluation.conditions));
    let exact = claimed.filter(|_| exact_failing.is_empty());
    let refutation = if spec.plant().is_none() { level_condition(&data).err() } else { None };
    let printed = PrintedFigure { refutation, evaluation: None, sigma: None };
    let model = FloatModel::new(&data, TradeOff::closed_form(&data));
    let parts = Parts { sharp, repaired: None, printed, exact, exact_failing, unproved, proposal: None };
    let mut run = assemble(spec, options, &data, parts, &model)?;
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
    repaired: Option<Outcome<RepairedProof>>,
    printed: PrintedFigure,
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
    let Parts { sharp, repaired, printed, exact, exact_failing, unproved, proposal } = parts;
    let relative_degree = relative_degree_gains(spec, data.precision);
    if let Some(Err(error @ RelativeDegreeError::NotHurwitz(_))) = relative_degree {
        return Err(Refusal::Filter(error));
    }
    let checks = MatrixChecks::new(spec, sharp.proved(), repaired.as_ref().and_then(Outcome::proved));
    let proved = sharp.proved().is_some() && unproved.is_empty() && exact_failing.is_empty() && !checks.disagree();
    let verdict = if proved { Verdict::Certified } else { Verdict::Undecided };
    let columns = Columns { sharp, repaired, printed: &printed, exact: exact.as_ref() };
    let (columns, constants) = columns.evaluated(spec, data.precision, options.ladder);
    let Columns { sharp, repaired, .. } = columns;
    let known = sharp.proved().zip(proposal.as_ref());
    let sensitivities = known.map_or_else(Vec::new, |(proof, proposal)| ranked(spec, model, proposal, proof));
    let aligned = known.and_then(|(_, proposal)| aligned(model, proposal));
    let nominal_gain = known.and_then(|(proof, proposal)| with_nominal_gain(spec, model, proposal, proof));
    let alternatives = Alternatives { by_norms: None, aligned, nominal_gain };
    // Without a domain, the claim is about the arguments it uses; without a claim, about all.
    let used = reach(&sharp).or_else(|| repaired.as_ref().and_then(reach));
    let no_plant = no_plant(data, used.as_ref().filter(|_| spec.domain.is_none()));
    let of_specification = known.filter(|_| spec.plant().is_none());
    let without_optional = of_specification.map_or_else(Vec::new, |_| without_optional_data(model));
    Ok(Certification {
        spec,
        options,
        verdict,
        binding: proposal.map(|proposal| proposal.binding),
        precision: constants.precision,
        sharp,
        roomy: None,
        repaired,
        printed,
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
        noise_of_rows: Vec::new(),
        unproved_bounds: unproved,
        constants: constants.rows,
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

/// Without a domain, the bounding functions are proved up to the arguments that a proof uses; with one they are already.
///
/// For the derivation of the claim, which has a list `unproved`, refuted ones are an error and undecided ones go there; for the
/// other, either takes its proof away.
fn proved_up_to_arguments<W: Witness>(
    spec: &Specification,
    outcome: Outcome<Proof<W>>,
    unproved: Option<&mut Vec<BoundingProblem>>,
) -> Result<Outcome<Proof<W>>, Refusal> {
    let (None, Some(proof)) = (&spec.domain, outcome.attempt()) else { return Ok(outcome) };
    let Some([x, e]) = proof.decided().reach() else { return Ok(Outcome::NotFound(Failing::NotFinite(None).into())) };
    let result = prove_up_to(spec, &x, &e);
    if let Some(unproved) = unproved {
        unproved.extend(undecided_or_error(result)?);
        return Ok(outcome);
    }
    Ok(if result.is_ok() { outcome } else { Outcome::NotFound(Failing::Bounds.into()) })
}

/// The largest arguments that a proof uses, rounded up.
fn reach<W: Witness>(outcome: &Outcome<Proof<W>>) -> Option<[Rational; 2]> {
    outcome.proved().and_then(|proof| proof.decided().reach())
}

fn printed_figure(data: &Data<'_>, model: &FloatModel) -> PrintedFigure {
    let refutation = level_condition(data).err();
    let evaluation = search_printed(data, model).and_then(|proposal| {
        let short = |value: f64| round_f64(value, 8, Direction::Nearest);
        let (x_a, e_a) = (short(proposal.x_a)?, round_f64(proposal.e_a, 8, Direction::Down)?);
        let h = data.rational(&round_f64(proposal.h, 8, Direction::Down)?);
        let printed = printed_transfer(data);
        let kappas = [&printed.kappa_0, &printed.kappa_1];
        Some(PrintedEvaluation::new(data, kappas, &data.rational(&x_a), &data.rational(&e_a), |_| h))
    });
    let sigma = evaluation
        .as_ref()
        .and_then(|evaluation| Some(evaluation.sigma_p.as_ref().ok()?.max(evaluation.sigma_a.as_ref().ok()?)));
    PrintedFigure { refutation, evaluation, sigma: sigma.filter(Enclosure::is_bounded) }
}
