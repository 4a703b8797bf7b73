//! The regulator at samples: search, rounding and decision of a claim about one gain and one sampling period (derivation, 12).

use super::gain_row::{ByCount, GainRow, RowNoise};
use super::least_limit::with_least_kept;
use super::limits::{FloatLimits, NEAR, ROOMS};
use super::options::Limits;
use super::outcome::{Outcome, smaller};
use super::produce::undecided_or_error;
use super::refusal::Refusal;
use super::round::{
    LONG_DIGITS, RoundedBox, SHORT_DIGITS, box_with, claimed_set, first_proved, nearest, room, rounded_box,
    rounded_sigma,
};
use super::verdict::Verdict;
use crate::rate::found::SampledRateForCount;
use rug::Rational;
use sigmastar_decide::conditions::Ladder;
use sigmastar_decide::conditions::SampledProof;
use sigmastar_decide::conditions::decide;
use sigmastar_decide::conditions::{BoundingProblem, prove_on_domain, prove_up_to};
use sigmastar_decide::conditions::{NoPlant, no_plant};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64, round_rational};
use sigmastar_lang::spec::model::Specification;
use sigmastar_lang::spec::{SampledGain, Sampling};
use sigmastar_propose::search::{
    Extreme, Failing, FloatModel, Goal, Obstacle, PastShare, SampledLimit, SampledProposal, SampledSearch, weight_h,
};
use sigmastar_theory::data::{Bound, Data, Problem};
use sigmastar_theory::derivation::condition::{Condition, all};
use sigmastar_theory::derivation::control::Control;
use sigmastar_theory::derivation::harmonics::AtOrigin;
use sigmastar_theory::derivation::initial_set::claimed_distances;
use sigmastar_theory::derivation::mean_squares::{Gains, MeanSquares, PeriodicSize, SetBounds};
use sigmastar_theory::derivation::sampled::{
    DelayWitness, SampledEvaluation, SampledGains, SampledLaw, SampledWitness, energy, sampled_trade_off,
};

/// Everything that a run about the regulator at samples found out.
#[derive(Clone, Debug)]
pub struct SampledCertification<'s> {
    /// The specification.
    pub spec: &'s Specification,
    /// The sampling period, with the number of samples.
    pub sampling: Sampling,
    /// The gain that was asked about, where the smallest one was not sought.
    pub given_gain: Option<Rational>,
    /// What was to be kept at the gain.
    pub limits: Limits,
    /// The verdict.
    pub verdict: Verdict,
    /// The proof, or what came of it.
    pub outcome: Outcome<SampledProof>,
    /// At a gain that is given, of a document with noise or a disturbance: a proof whose error box has more room than that of the claim.
    pub(super) roomy: Option<Box<SampledProof>>,
    /// What was found in floating point, and what limits it.
    pub found: Option<(SampledProposal, SampledLimit)>,
    /// Bounding functions that were neither proved nor refuted.
    pub unproved_bounds: Vec<BoundingProblem>,
    /// That no plant with a state x satisfies the data, where it is proved.
    pub no_plant: Option<NoPlant>,
    /// What the gain would be with each interval closed to its nominal value, where it is compared: estimates.
    pub interval_costs: Vec<(String, Option<f64>)>,
    /// Bounds at the gain of the claim and at larger ones; empty without a claim, with an actuator, and where nothing is compared.
    pub gains: Vec<GainRow>,
    /// What is proved of noise at the gains of these rows, for the numbers of oscillators that were asked about.
    pub noise_of_rows: Vec<RowNoise>,
    /// About the gain at which norms prove a claim, where this one rests on (Ms), has another gain and that was looked for.
    pub norms_from: Option<f64>,
    /// Rates for the numbers of oscillators that were asked about.
    pub for_n_o: Vec<SampledRateForCount>,
    /// Bounds by the number of oscillators at the gain of the claim, where the plant has some.
    pub by_count: Option<ByCount>,
}

impl SampledCertification<'_> {
    /// The proof of the claim, if certified.
    #[must_use]
    pub fn claim(&self) -> Option<&SampledProof> {
        let proof = self.outcome.proved()?;
        (self.verdict == Verdict::Certified && all(&proof.evaluation.conditions).is_true()).then_some(proof)
    }

    /// Whether for some number of oscillators that was asked about it is proved what noise, a disturbance and rounding do.
    #[must_use]
    pub fn counts_noise(&self) -> bool {
        self.for_n_o.iter().any(|found| found.proved_noise().is_some())
    }

    /// The conditions, proved or not.
    #[must_use]
    pub fn conditions(&self) -> &[Condition] {
        self.outcome.attempt().map_or(&[], |proof| &proof.evaluation.conditions)
    }

    /// Upper bounds of sup|x|, sup|e|, sup_k |zeta_k|_N and sup_k |z_k|_N along the periodic solution, if certified.
    #[must_use]
    pub fn periodic_solution(&self) -> Option<[Enclosure; 4]> {
        let proof = self.claim()?;
        let (size, zeta) = (&proof.evaluation.size, proof.evaluation.z.clone());
        let n_bar = Data::new(self.spec, proof.precision).numbers.n_bar;
        // At samples z_k = zeta_k + M e_k.
        let z = &zeta + n_bar * &size.e_per;
        Some([size.x_per.clone(), size.e_per.clone(), zeta, z])
    }

    /// Whether this claim has a smaller gain than another one, or at the same gain a smaller bound of |e|; any is better than none.
    #[must_use]
    pub fn is_better_than(&self, other: &SampledCertification<'_>) -> bool {
        match (self.claim(), other.claim()) {
            (Some(one), Some(other)) => is_better(one, other),
            (one, other) => one.is_some() && other.is_none(),
        }
    }

    /// Bounds of the control, if certified.
    #[must_use]
    pub fn control(&self) -> Option<&Control<Enclosure>> {
        self.claim().map(|proof| &proof.evaluation.control)
    }

    /// The largest X and E at which a bounding function is used.
    #[must_use]
    pub fn largest_arguments(&self) -> Option<[Enclosure; 2]> {
        self.outcome.attempt().map(arguments)
    }

    /// Whether f(0,0) > 0 is proved of the bounding function, although |f(t,0,0)| = 0 for every plant of the family.
    #[must_use]
    pub fn has_force_at_origin(&self) -> bool {
        let data = Data::new(self.spec, 128);
        data.bound(Bound::F, &data.zero(), &data.zero()).is_positive().is_true()
    }
}

/// Whether a proof has every condition where the other has not, or a smaller gain, or at the same gain a smaller bound of |e|.
fn is_better(one: &SampledProof, other: &SampledProof) -> bool {
    let key = |proof: &SampledProof| (!proof.truth().is_true(), proof.witness.sigma.clone());
    let [first, second] = [one, other].map(key);
    first < second || (first == second && smaller([one, other].map(|proof| &proof.evaluation.peak)))
}

fn arguments(proof: &SampledProof) -> [Enclosure; 2] {
    let evaluation = &proof.evaluation;
    let (bounds, error_box) = (&evaluation.bounds, &evaluation.error_box);
    [bounds.x_p.max(&error_box.x_b), bounds.e_p.max(&error_box.e_b)]
}

/// Certifies the regulator at samples: at the gain that is given, or at the smallest one that is found; near a proposal, where
/// one is known.
///
/// Guarantee: the verdict is `Certified` only if the bounding functions are proved on every argument used and every condition
/// is proved for the witness.
///
/// # Errors
/// Bounding functions that are *refuted*, with their counterexamples: bad input.
pub fn certify_sampled<'s>(
    spec: &'s Specification,
    sampling: &Sampling,
    gain: Option<&Rational>,
    start: Option<&SampledProposal>,
    ladder: Ladder,
) -> Result<SampledCertification<'s>, Refusal> {
    certify_sampled_within(spec, sampling, (gain, &Limits::default()), start, ladder)
}

/// The same with limits that a claim keeps to: at the gain that is given, or at the smallest one that is found with which it does.
///
/// # Errors
/// Those of [`certify_sampled`].
pub fn certify_sampled_within<'s>(
    spec: &'s Specification,
    sampling: &Sampling,
    (gain, limits): (Option<&Rational>, &Limits),
    start: Option<&SampledProposal>,
    ladder: Ladder,
) -> Result<SampledCertification<'s>, Refusal> {
    let unproved = undecided_or_error(prove_on_domain(spec))?;
    let data = Data::new(spec, ladder.start.max(53));
    let Some(law) = spec.internal_model.sampled_gain(&sampling.step) else {
        let extreme = Extreme::Number("the sampling period", sampling.step.to_f64());
        return assemble(spec, sampling, gain, (Outcome::NotFound(Failing::Magnitude(extreme).into()), None), unproved);
    };
    if let Some(gain) = gain.filter(|gain| !sampling.fits(gain).is_true()) {
        let (sigma, largest) = (gain.to_f64(), sampling.step.to_f64().recip());
        let obstacle = Failing::Hold { sigma, largest, given: true }.into();
        return assemble(spec, sampling, Some(gain), (Outcome::NotFound(obstacle), None), unproved);
    }
    let model = sampled_model(&data, sampling, &law);
    let law = (SampledLaw::new(&data, sampling, &law).to_f64(), law);
    let search = SampledSearch::new(&model, law.0.clone());
    let proposal = proposed(&search, start, gain);
    let mut roomy = None;
    let (outcome, found) = match (proposal, FloatLimits::new(spec, limits)) {
        (Err(obstacle), _) => (Outcome::NotFound(obstacle), None),
        (Ok(proposal), None) => {
            let proof = round(&data, (sampling, &law.1), (&model, &search), (&proposal, gain), ladder);
            let is_asked = gain.is_some() && spec.disturbances.any_at_samples();
            roomy = proof.clone().filter(|proof| is_asked && proof.truth().is_true()).map(Box::new);
            // At a gain that is given the one with which e goes the least far.
            let model = model.with_goal(Goal::Peak);
            let search_peak = SampledSearch::new(&model, law.0.clone());
            let nearest = gain.and_then(|gain| search_peak.near(&proposal, Some(gain.to_f64())).ok());
            let nearest = nearest
                .and_then(|found| round(&data, (sampling, &law.1), (&model, &search_peak), (&found, gain), ladder));
            let limit = search.limit(&proposal);
            let both = [proof, nearest].into_iter().flatten();
            let best = both.reduce(|known, other| if is_better(&other, &known) { other } else { known });
            (best.into(), Some((proposal, limit)))
        }
        (Ok(least), Some(within)) => {
            let keep = Keep { limits, within, least, start };
            let outcome = match kept(&data, (sampling, &law), &model, keep, gain, ladder) {
                Outcome::NotFound(Obstacle { failing, at }) => {
                    let failing = with_least_kept(spec, limits, failing, |spec, limits, within| {
                        let data = Data::new(spec, data.precision);
                        let found =
                            kept(&data, (sampling, &law), &model, Keep { limits, within, least, start }, gain, ladder);
                        found.proved().map(|proof| proof.witness.sigma.to_f64())
                    });
                    Outcome::NotFound(Obstacle { failing, at })
                }
                outcome => outcome,
            };
            (outcome, None)
        }
    };
    let run = assemble(spec, sampling, gain, (outcome, found), unproved)?;
    Ok(SampledCertification { limits: limits.clone(), roomy, ..run })
}

/// The best proposal at the gain that is given, or at the smallest one; near a known one where there is one.
fn proposed(
    search: &SampledSearch<'_>,
    start: Option<&SampledProposal>,
    gain: Option<&Rational>,
) -> Result<SampledProposal, Obstacle> {
    match (start, gain) {
        (Some(known), gain) => search.near(known, gain.map(Rational::to_f64)),
        (None, Some(gain)) => search.at_gain(gain.to_f64()),
        (None, None) => search.smallest(),
    }
}

/// What is to be kept, and where its search begins.
struct Keep<'k> {
    limits: &'k Limits,
    within: FloatLimits,
    least: SampledProposal,
    start: Option<&'k SampledProposal>,
}

/// The proof at the smallest gain from that of `least` on that is found with which the limits are kept, or at the one that is given.
fn kept(
    data: &Data<'_>,
    (sampling, (law, numbers)): (&Sampling, &(SampledLaw<f64>, SampledGain)),
    model: &FloatModel,
    Keep { limits, within: float, least, start }: Keep<'_>,
    gain: Option<&Rational>,
    ladder: Ladder,
) -> Outcome<SampledProof> {
    let given = gain.is_some() || model.at_samples.gain().is_some();
    let at = |goal: Goal, sigma: f64| {
        let model = model.with_goal(goal);
        let search = SampledSearch::new(&model, law.clone());
        let proposal = match start {
            Some(known) => search.near(known, Some(sigma)),
            None => search.at_gain(sigma),
        }?;
        search.largest_at(&proposal).map(|largest| (proposal, largest))
    };
    let kept = |proof: &SampledProof| {
        let SampledEvaluation { size, peak, control, .. } = &proof.evaluation;
        limits.kept([&size.e_per, peak], control)
    };
    // The smallest gain itself may do, but for rounding.
    let is_it = |proof: &SampledProof| given || proof.witness.sigma <= least.sigma * NEAR;
    let search = SampledSearch::new(model, law.clone());
    let proof = round(data, (sampling, numbers), (model, &search), (&least, gain), ladder);
    if let Some(proof) = proof.filter(|proof| proof.truth().is_true() && is_it(proof) && kept(proof)) {
        return Some(proof).into();
    }
    let mut outcome = None;
    for room in ROOMS {
        let found = match float.smallest([least.sigma, law.step.recip()], (given, room), at) {
            Ok(found) => found,
            Err(obstacle) => return outcome.unwrap_or(Outcome::NotFound(obstacle)),
        };
        let Some(sigma) = gain.cloned().or_else(|| within(sampling, found.sigma()?)) else { continue };
        let model = model.with_goal(found.goal);
        let search = SampledSearch::new(&model, law.clone());
        let proof = round(data, (sampling, numbers), (&model, &search), (&found.proposal, Some(&sigma)), ladder);
        let attempt: Outcome<SampledProof> = match proof {
            // Nothing is claimed that does not keep to what was asked for.
            Some(proof) if !kept(&proof) => Outcome::NotFound(found.failing().into()),
            proof => proof.into(),
        };
        if attempt.proved().is_some() {
            return attempt;
        }
        outcome = Some(attempt);
    }
    outcome.unwrap_or_else(|| Outcome::NotFound(Failing::NotFinite(None).into()))
}

/// Decides the witness of a certificate again, without any search.
///
/// Guarantee: as for [`certify_sampled`]. Hypothesis: the samples of the witness are those of the period of `spec`. The verdict
/// is `Refuted` when a condition is proved not to hold for the witness.
///
/// # Errors
/// Bounding functions that are *refuted*, with their counterexamples: bad input.
pub fn recheck_sampled<'s>(
    spec: &'s Specification,
    witness: &SampledWitness,
    ladder: Ladder,
) -> Result<SampledCertification<'s>, Refusal> {
    let unproved = undecided_or_error(prove_on_domain(spec))?;
    let proof = decide(spec, witness.clone(), ladder);
    let mut run = assemble(spec, &witness.sampling, None, (Some(proof).into(), None), unproved)?;
    let refuted = run.conditions().iter().any(|condition| condition.truth().is_false());
    if run.verdict == Verdict::Undecided && refuted {
        run.verdict = Verdict::Refuted;
    }
    Ok(run)
}

/// The specification in floating point, with the pairs (k0, k1) of the law.
#[must_use]
pub fn sampled_model(data: &Data<'_>, sampling: &Sampling, gain: &SampledGain) -> FloatModel {
    FloatModel::new(data, sampled_trade_off(data, &SampledLaw::new(data, sampling, gain)))
}

fn assemble<'s>(
    spec: &'s Specification,
    sampling: &Sampling,
    gain: Option<&Rational>,
    (outcome, found): (Outcome<SampledProof>, Option<(SampledProposal, SampledLimit)>),
    mut unproved: Vec<BoundingProblem>,
) -> Result<SampledCertification<'s>, Refusal> {
    // Without a domain, the bounding functions are proved up to the arguments that are used.
    let reach = outcome.attempt().map(|proof| arguments(proof).map(|argument| argument.upper_rational()));
    let reach = match reach {
        Some([Some(x), Some(e)]) => Some([x, e]),
        _ => None,
    };
    if let (None, Some([x, e])) = (&spec.domain, &reach) {
        unproved.extend(undecided_or_error(prove_up_to(spec, x, e))?);
    }
    let known = spec.domain.is_some() || reach.is_some();
    let proved = outcome.proved().is_some() && known && unproved.is_empty();
    let data = Data::new(spec, 128);
    Ok(SampledCertification {
        spec,
        sampling: sampling.clone(),
        given_gain: gain.cloned(),
        limits: Limits::default(),
        verdict: if proved { Verdict::Certified } else { Verdict::Undecided },
        no_plant: no_plant(&data, reach.as_ref().filter(|_| spec.domain.is_none())),
        outcome,
        roomy: None,
        found,
        unproved_bounds: unproved,
        interval_costs: Vec::new(),
        gains: Vec::new(),
        noise_of_rows: Vec::new(),
        norms_from: None,
        for_n_o: Vec::new(),
        by_count: None,
    })
}

/// Rounds a proposal and decides it: the first witness that is proved, or the last one.
fn round(
    data: &Data<'_>,
    (sampling, law): (&Sampling, &SampledGain),
    (model, search): (&FloatModel, &SampledSearch<'_>),
    (proposal, gain): (&SampledProposal, Option<&Rational>),
    ladder: Ladder,
) -> Option<SampledProof> {
    let enclosed = SampledLaw::new(data, sampling, law);
    let origin = AtOrigin::new(data);
    first_proved(data, ladder, |(digits, slack)| {
        let sigma = match gain.or_else(|| model.at_samples.gain()) {
            Some(gain) => gain.clone(),
            None => within(sampling, rounded_sigma(proposal.sigma, slack)?)?,
        };
        let near = Some((proposal.rho, proposal.eta));
        let (found, at) = search.at(sigma.to_f64(), proposal.floors, near, room(digits)).ok()?;
        let up = |value: f64| round_f64(value, digits, Direction::Up);
        let MeanSquares { x, e, e_rate } = found.squares;
        let (x_p, e_p, r_x, r_e, r_d) = (up(found.x_p)?, up(found.e_p)?, up(x)?, up(e)?, up(e_rate)?);
        let above = |value: f64| round_f64(value * (1.0 + 1e-12), SHORT_DIGITS, Direction::Up);
        let (k0, k1) = (above(found.pair.0)?, above(found.pair.1)?);
        let bounds = SetBounds::new(data, data.rational(&x_p), data.rational(&e_p));
        let squares = MeanSquares { x: &r_x, e: &r_e, e_rate: &r_d }.map(|value| data.rational(value));
        let known = data.spec.bounds.proved_values().at_samples.existence.as_ref();
        let energy = known.map(|known| energy::bounds_of(data, &origin, known));
        let gains = SampledGains::new(&enclosed, &data.rational(&sigma), &data.period).with_energy(energy);
        let size = PeriodicSize::new(data, &bounds, &origin, &gains, &squares);
        let z = gains.z_squared(data, &size.forcing, [&data.rational(&k0), &data.rational(&k1)]).sqrt();
        let set = claimed_set(data, &x_p, &e_p, &z)?;
        // From the claimed set itself, which is rounded up; the candidate's own distances keep its floors.
        let [dist_x, dist_e, dist_z] =
            claimed_distances(data, &set, [&size.x_per, &size.e_per, &z]).map(|distance| distance.upper_f64());
        let d_x = at.d_x.max(at.rho * model.c * dist_x);
        let far = [at.dist_e.max(dist_e), at.dist_z.max(dist_z)];
        let box_of = |weights| box_with(model, weights, [d_x / (at.rho * model.c), far[0], far[1]], slack);
        let RoundedBox { d_x, d_e, w_x, h: eta } = match model.at_samples.weights() {
            Some(weights) => box_of(weights),
            None => rounded_box(model, d_x, at.rho, far, at.eta, slack),
        }?;
        let (eta, delay) = match at.past {
            None => (eta, None),
            Some(past) => {
                let y_0 = y_0(sampling, &set.e0)?;
                let y_per = gains.largest_mean(&size.forcing).upper_f64();
                // As far as the claimed set has it.
                let distance = sampling.step.to_f64().sqrt() * (y_0.to_f64() + y_per) * (1.0 + 1e-15);
                let past = PastShare { distance: past.distance.max(distance), ..past };
                let gm = nearest(past.weight(at.eta, far[0]), LONG_DIGITS)?;
                let eta = nearest(weight_h((1.0 - past.share) * at.eta, far[0], far[1]), LONG_DIGITS)?;
                (eta, Some(DelayWitness { gm, y_0 }))
            }
        };
        let (sampling, law) = (sampling.clone(), law.clone());
        Some(SampledWitness {
            sigma,
            sampling,
            law,
            x_p,
            e_p,
            r_x,
            r_e,
            r_d,
            d_x,
            d_e,
            w_x,
            eta,
            k0,
            k1,
            set,
            paths: at.paths,
            delay,
        })
    })
}

/// Y_0 with E_0 <= h Y_0, exactly where that is a short number.
fn y_0(sampling: &Sampling, e_0: &Rational) -> Option<Rational> {
    let exact = match sampling.step.as_rational() {
        Some(step) => Rational::from(e_0 / step),
        None => (Enclosure::from_rational(e_0, 512) / sampling.step.enclose(512)).upper_rational()?,
    };
    Some(round_rational(&exact, LONG_DIGITS, Direction::Up))
}

/// The gain, or the largest one with h sigma <= 1 where it is beyond that.
fn within(sampling: &Sampling, sigma: Rational) -> Option<Rational> {
    if sampling.fits(&sigma).is_true() {
        return Some(sigma);
    }
    let largest = match sampling.step.as_rational() {
        Some(step) => step.clone().recip(),
        None => {
            let inverse = sampling.step.enclose(128).recip().lower_rational()?;
            round_rational(&inverse, LONG_DIGITS, Direction::Down)
        }
    };
    sampling.fits(&largest).is_true().then_some(largest)
}
