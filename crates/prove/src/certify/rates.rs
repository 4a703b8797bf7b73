//! Rates for given oscillators, as a part of a claim (derivation, 13.6): the first n_o, or those of a set of harmonics, where the claim is about every set.

use super::certification::Certification;
use super::gain_row::ByCount;
use super::options::Limits;
use super::outcome::Outcome;
use super::sampled::SampledCertification;
use super::verdict::Verdict;
use crate::rate::bound::{MAX_COUNTS, MAX_ENTRIES, MAX_OSCILLATORS, Place, RateBound, bound};
use crate::rate::by_matrices::{Start, Tube, bounds};
use crate::rate::found::{ForCount, RateForCount, SampledRateForCount};
use crate::rate::noise::{Confinement, NoNoiseBound, NoiseBound, noise_bound};
use crate::rate::sampled::bound as at_samples;
use crate::rate::sampled::noise::noise_bound as at_samples_with_noise;
use crate::rate::sampled::rounding::measured;
use rug::Rational;
use sigmastar_decide::bounds::Engine;
use sigmastar_decide::conditions::{Proof, SampledProof, SharpProof};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64, write_exact};
use sigmastar_exact::parallel;
use sigmastar_lang::spec::{MatrixInequality, Oscillators, Specification};
use sigmastar_propose::bounds::FloatSuprema;
use sigmastar_propose::search::Failing;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::initial_set::{ClaimedSet, claimed_distances};
use sigmastar_theory::derivation::sampled::{self, SampledEvaluation};
use sigmastar_theory::derivation::sharp::SharpEvaluation;
use sigmastar_theory::derivation::stability::level_condition;

/// Why a claim can have no rates for given oscillators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoRatesOfClaim {
    /// It is about the regulator at samples with a delay.
    WithDelay,
    /// This number, or largest harmonic of a set, is not below half of these samples.
    NotBelowHalf(u32, u32),
    /// It rests on the derivatives of a plant, which could not be had again from its formulas.
    OfFormulas,
    /// So many numbers and sets were asked for.
    TooMany(usize),
    /// This number is beyond the largest one.
    Beyond(u32),
    /// Together their matrices have so many entries.
    TooLarge(usize),
}

impl NoRatesOfClaim {
    /// What is wrong; `option` is the list of numbers as the user writes it.
    #[must_use]
    pub fn message(self, option: &str) -> String {
        match self {
            NoRatesOfClaim::WithDelay => {
                format!("{option}: not available with `delay_samples`: rates at samples are of the law without a delay")
            }
            NoRatesOfClaim::NotBelowHalf(n_o, samples) => {
                format!(
                    "{option}: the claim is about n_o < {samples}/2, half of the samples in a period, and n_o is {n_o}"
                )
            }
            NoRatesOfClaim::OfFormulas => {
                format!(
                    "{option}: the claim rests on the derivatives of a plant, and they could not be had again from its formulas"
                )
            }
            NoRatesOfClaim::TooMany(count) => {
                format!("{option}: {count} numbers of oscillators; at most {MAX_COUNTS} go into one certificate")
            }
            NoRatesOfClaim::Beyond(n_o) => {
                format!(
                    "{option}: n_o = {n_o} is beyond {MAX_OSCILLATORS}: the matrix that proves its rate, of order {}, does not fit into a certificate",
                    2 * u64::from(n_o) + 2
                )
            }
            NoRatesOfClaim::TooLarge(entries) => {
                format!(
                    "{option}: the matrices that prove the rates of these numbers, and what noise and disturbances do there, have {entries} \
                     entries; at most {MAX_ENTRIES} fit into one certificate"
                )
            }
        }
    }

    /// What to try.
    #[must_use]
    pub fn help(self) -> &'static str {
        match self {
            NoRatesOfClaim::WithDelay => "leave it or the delay out",
            NoRatesOfClaim::NotBelowHalf(..) => "ask for smaller numbers, or take a shorter sampling period",
            NoRatesOfClaim::OfFormulas => {
                "leave it out; a bounding specification of the plant (`sigmastar bound`) has a claim by norms"
            }
            NoRatesOfClaim::TooMany(_) => {
                "ask for fewer, as `0,1,2,5,10,20`, or for a range in steps, as `0..60/10`; or write several certificates"
            }
            NoRatesOfClaim::TooLarge(_) => "ask for fewer, or write several certificates",
            NoRatesOfClaim::Beyond(_) => "ask for smaller numbers",
        }
    }
}

/// The numbers in order, each once.
///
/// # Errors
/// More than [`MAX_COUNTS`] different ones, one beyond [`MAX_OSCILLATORS`], and more than [`MAX_ENTRIES`] of all together.
pub fn rate_counts(asked: &[u32]) -> Result<Vec<u32>, NoRatesOfClaim> {
    let mut counts = asked.to_vec();
    counts.sort_unstable();
    counts.dedup();
    // Of a number beyond the limit there is no list of harmonics.
    match counts.last() {
        Some(last) if *last > MAX_OSCILLATORS => Err(NoRatesOfClaim::Beyond(*last)),
        _ => rate_oscillators(&counts.iter().copied().map(Oscillators::first).collect::<Vec<_>>()).map(|_| counts),
    }
}

/// Those at the first harmonics by their number, then the sets with gaps, each once.
///
/// # Errors
/// More than [`MAX_COUNTS`] different ones, a harmonic beyond [`MAX_OSCILLATORS`], and more than [`MAX_ENTRIES`] of all together.
fn rate_oscillators(asked: &[Oscillators]) -> Result<Vec<Oscillators>, NoRatesOfClaim> {
    let mut all = asked.to_vec();
    all.sort_unstable_by_key(|one| (one.n_o().is_none(), one.clone()));
    all.dedup();
    match all.iter().map(Oscillators::largest).max() {
        Some(largest) if largest > MAX_OSCILLATORS => Err(NoRatesOfClaim::Beyond(largest)),
        _ if all.len() > MAX_COUNTS => Err(NoRatesOfClaim::TooMany(all.len())),
        _ => fitting(&all, false).map(|()| all),
    }
}

/// Whether the matrices of these oscillators fit into a certificate: Pi of order 2 p + 2 with p of them beside the integrator, and one more where inputs count.
///
/// # Errors
/// They have more than [`MAX_ENTRIES`] entries together.
fn fitting(asked: &[Oscillators], with_inputs: bool) -> Result<(), NoRatesOfClaim> {
    let triangle = |one: &Oscillators| (one.count() + 1) * (2 * one.count() + 3);
    let entries = asked.iter().map(triangle).sum::<usize>() * if with_inputs { 2 } else { 1 };
    if entries > MAX_ENTRIES { Err(NoRatesOfClaim::TooLarge(entries)) } else { Ok(()) }
}

/// The numbers among them: of these alone rows at larger gains have rates.
fn numbers(asked: &[Oscillators]) -> Vec<u32> {
    asked.iter().filter_map(Oscillators::n_o).collect()
}

impl Certification<'_> {
    /// X and E of the inequality by which stability is proved, (M) or (Jm): the error box lies inside, and the first derivatives are known
    /// there together. None where the claim rests on norms, and without one.
    #[must_use]
    pub fn matrix_arguments(&self) -> Option<[&Rational; 2]> {
        self.sharp.proved().filter(|_| self.claim().is_some()).and_then(|proof| matrix_arguments(self.spec, proof))
    }

    /// Proves rates for these oscillators at the gain of the claim, and makes them a part of it; without a claim there are none, and none for sets with gaps
    /// of a claim about the first harmonics alone.
    ///
    /// Guarantee: for each bound that is proved, with these oscillators, at the claimed gain and no other, every solution from the
    /// claimed set has `|e(t) - e_per(t)| <= factor exp(-rate (t - t_0))`; where the document has noise or a disturbance and there are bounds
    /// of them, what [`noise_bound`] says of it.
    ///
    /// # Errors
    /// Those of [`rate_counts`], of sets too, and a claim that does not rest on norms, of which [`Certification::prove_rates_around`] has rates.
    pub fn prove_rates(&mut self, asked: &[Oscillators]) -> Result<(), NoRatesOfClaim> {
        let asked = self.covered(asked)?;
        if !asked.is_empty() && self.matrix_arguments().is_some() {
            return Err(NoRatesOfClaim::OfFormulas);
        }
        let Some(proof) = self.sharp.proved().filter(|_| self.claim().is_some()) else {
            self.for_n_o = Vec::new();
            return Ok(());
        };
        fitting(&asked, self.spec.disturbances.any())?;
        self.for_n_o = for_n_o(self.spec, (proof, self.by_count.as_ref()), &asked);
        self.make_room(&asked);
        self.set_rates_of_rows(&numbers(&asked), None);
        self.set_noise_of_rows(&asked);
        Ok(())
    }

    /// Those of which the claim is.
    fn covered(&self, asked: &[Oscillators]) -> Result<Vec<Oscillators>, NoRatesOfClaim> {
        covered(asked, self.is_for_every_set())
    }

    /// Why a rate that was asked about is not proved.
    #[must_use]
    pub fn why_no_rate(&self) -> String {
        NO_DECAY.to_owned()
    }

    /// The same of a claim that rests on the derivatives of a plant, by what decides and samples them around its orbit; of noise nothing is
    /// proved there.
    ///
    /// Guarantee: that of [`Certification::prove_rates`], where the engine is one of the plant and the orbit of the claim.
    ///
    /// # Errors
    /// Those of [`rate_counts`].
    pub fn prove_rates_around(
        &mut self,
        asked: &[Oscillators],
        (engine, samples): (&Engine, &FloatSuprema),
    ) -> Result<(), NoRatesOfClaim> {
        let covered = self.covered(asked)?;
        let (Some(at), Some(proof)) = (self.matrix_arguments(), self.sharp.proved()) else {
            return self.prove_rates(asked);
        };
        let data = Data::new(self.spec, proof.precision);
        let from = Starts { general: distances(&data, proof), of: (&proof.witness.set, self.by_count.as_ref()) };
        let distances = |oscillators: &Oscillators| from.with(&data, oscillators);
        let inequality = self.spec.bounds.proved_values().inequality.as_ref();
        let corner = inequality.filter(|known| known.splitting.is_some()).map(MatrixInequality::arguments);
        let start = Start { sigma: &proof.witness.sigma, distances: &distances };
        let tube = Tube { engine, samples, at, corner, start };
        let noise = || self.spec.disturbances.any().then_some(Err(NoNoiseBound::ByMatrices));
        let of = |(oscillators, bound): (&Oscillators, _)| RateForCount {
            oscillators: oscillators.clone(),
            bound,
            noise: noise(),
        };
        self.for_n_o = covered.iter().zip(bounds(&data, &tube, &covered)).map(of).collect();
        self.set_rates_of_rows(&numbers(&covered), Some(engine.states()));
        Ok(())
    }
}

/// Those of which a claim is, the first ones by their number, then sets.
///
/// # Errors
/// Those of [`rate_oscillators`].
fn covered(asked: &[Oscillators], every_set: bool) -> Result<Vec<Oscillators>, NoRatesOfClaim> {
    let mut all = rate_oscillators(asked)?;
    all.retain(|one| every_set || one.n_o().is_some());
    Ok(all)
}

/// Why a rate is not proved from the error box.
const NO_DECAY: &str = "no decay is proved for all derivatives in the error box at this gain";

/// A gain for words, to six digits.
fn shown(sigma: f64) -> String {
    round_f64(sigma, 6, Direction::Up).as_ref().map_or_else(|| sigma.to_string(), write_exact)
}

/// Whether stability at samples is proved by (Ms).
pub(super) fn by_sampled_matrix(spec: &Specification, proof: &SampledProof) -> bool {
    sampled::matrix_inequality::proved_for(&Data::new(spec, proof.precision), &proof.witness).is_some()
}

/// X and E of the inequality by which stability is proved in a proof.
pub(super) fn matrix_arguments<'s>(spec: &'s Specification, proof: &SharpProof) -> Option<[&'s Rational; 2]> {
    let values = spec.bounds.proved_values();
    if let Some(joint) = &values.joint_stability {
        return Some([&joint.inequality.x, &joint.inequality.e]);
    }
    let inequality =
        values.inequality.as_ref().filter(|known| known.w_x == proof.witness.w_x && known.h == proof.witness.h)?;
    Some([&inequality.x, &inequality.e])
}

/// From how far solutions start.
struct Starts<'a> {
    /// dX, dE, dZ for every number of oscillators.
    general: [Enclosure; 3],
    /// The set, and what is known of the periodic solution by the number of oscillators.
    of: (&'a ClaimedSet, Option<&'a ByCount>),
}

impl Starts<'_> {
    /// dX, dE, dZ with these oscillators: the least that is known of each.
    fn with(&self, data: &Data<'_>, oscillators: &Oscillators) -> [Enclosure; 3] {
        let (set, found) = self.of;
        let own = found.and_then(|found| found.distances(data, set, oscillators));
        own.map_or_else(|| self.general.clone(), |own| [0, 1, 2].map(|i| own[i].min(&self.general[i])))
    }

    /// Of |zeta|_N along the periodic solution with these oscillators: the least that is known; for all that the claim is about it is `z`.
    fn largest_zeta(&self, oscillators: &Oscillators, z: &Enclosure) -> Enclosure {
        let own = self.of.1.and_then(|found| found.largest_zeta(oscillators));
        own.map_or_else(|| z.clone(), |own| own.min(z))
    }
}

/// dX, dE, dZ of the set of a proof.
pub(super) fn distances(data: &Data<'_>, proof: &SharpProof) -> [Enclosure; 3] {
    let SharpEvaluation { periodic, z, .. } = &proof.evaluation;
    claimed_distances(data, &proof.witness.set, [&periodic.x_per, &periodic.e_per, z])
}

/// The same at samples.
pub(super) fn distances_at_samples(data: &Data<'_>, proof: &SampledProof) -> [Enclosure; 3] {
    let SampledEvaluation { size, z, .. } = &proof.evaluation;
    claimed_distances(data, &proof.witness.set, [&size.x_per, &size.e_per, z])
}

/// Rates, and bounds under noise and disturbances where the document has them, of a claim by norms.
pub(super) fn for_n_o(
    spec: &Specification,
    (proof, found): (&SharpProof, Option<&ByCount>),
    asked: &[Oscillators],
) -> Vec<RateForCount> {
    let Proof { witness, evaluation, precision } = proof;
    let data = Data::new(spec, *precision);
    let from = Starts { general: distances(&data, proof), of: (&witness.set, found) };
    let numbers = [&witness.d_x, &witness.d_e, &witness.w_x, &witness.h];
    let v_bar = data.rational(&spec.v_bar());
    let disturbed = spec.disturbances.any();
    let of = |oscillators: &Oscillators| {
        let distances = from.with(&data, oscillators);
        let place = Place { sigma: &witness.sigma, error_box: &evaluation.error_box, distances: distances.each_ref() };
        let bound = bound(&data, &place, oscillators);
        let noise = disturbed.then(|| match &bound {
            Some(bound) => {
                let zeta = from.largest_zeta(oscillators, &evaluation.z);
                noise_bound(&data, &place, &confinement(&data, (&distances, &zeta), &v_bar, numbers), &bound.into())
            }
            None => Err(NoNoiseBound::NoRate),
        });
        RateForCount { oscillators: oscillators.clone(), bound, noise }
    };
    parallel::map(asked, of)
}

impl Certification<'_> {
    /// The sentences of the claim about them, each with a space before it.
    #[must_use]
    pub fn rates_in_words(&self) -> String {
        let Some(sigma) = self.sigma_star() else { return String::new() };
        rates_in_words(self.spec, sigma, false, self.for_n_o.iter().filter_map(said_of))
    }
}

/// What a claim says of some oscillators.
pub struct SaidOfCount<'a> {
    /// The oscillators.
    pub oscillators: &'a Oscillators,
    /// The rate, in 1/time.
    pub rate: &'a Rational,
    /// The factor, in the unit of e.
    pub factor: &'a Rational,
    /// The peak and the limit under noise, where they are proved.
    pub noise: Option<[&'a Rational; 2]>,
}

pub(crate) fn said_of<P, Q>(found: &ForCount<P, Q>) -> Option<SaidOfCount<'_>> {
    let RateBound { oscillators, rate, factor, .. } = found.bound.as_ref()?;
    let noise = found.proved_noise().map(|NoiseBound { limit, peak, .. }| [peak, limit]);
    Some(SaidOfCount { oscillators, rate, factor, noise })
}

/// The sentences of a claim about some oscillators at its gain, each with a space before it.
pub fn rates_in_words<'a>(
    spec: &Specification,
    sigma: &Rational,
    at_samples: bool,
    said: impl Iterator<Item = SaidOfCount<'a>>,
) -> String {
    let sigma = write_exact(sigma);
    let (instants, inputs) = match at_samples {
        true => (" at the sampling instants t", spec.disturbances.in_words_at_samples()),
        false => ("", spec.disturbances.in_words()),
    };
    let start = if spec.initial_set.is_aligned() { " (z = M e of the measured e)" } else { "" };
    let sentences = |SaidOfCount { oscillators, rate, factor, noise }: SaidOfCount<'_>| {
        let of_rate = format!(
            " With {oscillators} and sigma = {sigma} exactly, |e(t) - e_per(t)| <= {} exp(-{} (t - t_0)){instants} for these solutions, where e_per is \
             the e of the periodic solution and t_0 the initial time.",
            apart(factor),
            apart(rate),
        );
        // Noise, a disturbance and rounding, of which there are these inputs.
        let of_noise = noise.map(|[peak, limit]| {
            format!(
                " With {oscillators} and sigma = {sigma} exactly, {inputs}: |e(t) - e_per(t)| <= {} for these starts{start} and all t >= \
                 t_0, and its limit superior is at most {}.",
                apart(peak),
                apart(limit),
            )
        });
        of_rate + &of_noise.unwrap_or_default()
    };
    said.map(sentences).collect()
}

/// A number within a sentence or in front of a product: a fraction stands in parentheses.
pub fn apart(value: &Rational) -> String {
    let text = write_exact(value);
    if text.contains('/') { format!("({text})") } else { text }
}

/// Rates, and bounds under noise and disturbances where the document has them, of a claim by norms at samples.
pub(super) fn for_n_o_at_samples(
    spec: &Specification,
    (proof, found): (&SampledProof, Option<&ByCount>),
    asked: &[Oscillators],
) -> Vec<SampledRateForCount> {
    let Proof { witness, evaluation, precision } = proof;
    let (data, law) = (Data::new(spec, *precision), &evaluation.law);
    let from = Starts { general: distances_at_samples(&data, proof), of: (&witness.set, found) };
    let numbers = [&witness.d_x, &witness.d_e, &witness.w_x, &witness.eta];
    let v_bar = measured(&data, &evaluation.error_box.e_b);
    let disturbed = spec.disturbances.any_at_samples();
    let of = |oscillators: &Oscillators| {
        let distances = from.with(&data, oscillators);
        let place = Place { sigma: &witness.sigma, error_box: &evaluation.error_box, distances: distances.each_ref() };
        let bound = at_samples::bound(&data, law, &place, oscillators);
        let noise = disturbed.then(|| match &bound {
            Some(bound) => {
                let zeta = from.largest_zeta(oscillators, &evaluation.z);
                let confinement = confinement(&data, (&distances, &zeta), &v_bar, numbers);
                at_samples_with_noise(&data, law, &place, &confinement, &bound.into())
            }
            None => Err(NoNoiseBound::NoRate),
        });
        SampledRateForCount { oscillators: oscillators.clone(), bound, noise }
    };
    parallel::map(asked, of)
}

/// What keeps the solutions without inputs in the box, L_0 being the left side of C4 at these distances; an aligned regulator sets
/// z = M (e + v).
fn confinement<'a>(
    data: &Data<'_>,
    ([of_x, of_e, of_zeta], z): (&[Enclosure; 3], &Enclosure),
    v_bar: &Enclosure,
    [d_x, d_e, w_x, h]: [&'a Rational; 4],
) -> Confinement<'a> {
    let misaligned = if data.spec.initial_set.is_aligned() { &data.n_bar * v_bar } else { data.zero() };
    let numbers = [d_x, d_e, w_x, h].map(|value| data.rational(value));
    let (level, _) = level_condition(data, [of_x, of_e, &(of_zeta + misaligned)], numbers.each_ref());
    let [.., h] = &numbers;
    let least = data.input_gain.as_ref().map_or_else(|| h.clone(), |gain| h * &gain.low);
    Confinement { zeta: z + (&level / least).sqrt(), level, w_x, radii: [d_x, d_e] }
}

impl SampledCertification<'_> {
    /// Proves rates for these oscillators, as [`Certification::prove_rates`]: at the gain and the sampling period of the claim.
    ///
    /// Guarantee: for each bound that is proved, with these oscillators, every solution that is in the claimed set at a sampling instant
    /// t_0 has `|e(t) - e_per(t)| <= factor exp(-rate (t - t_0))` at every sampling instant t >= t_0; where the document has noise or a
    /// disturbance and there are bounds of them, what [`at_samples_with_noise`] says of it.
    ///
    /// # Errors
    /// Those of [`Certification::prove_rates`], a number or a largest harmonic that is not below half of the samples, a delay, and a claim that does not rest on norms.
    pub fn prove_rates(&mut self, asked: &[Oscillators]) -> Result<(), NoRatesOfClaim> {
        let asked = covered(asked, self.spec.internal_model.asks_every_set())?;
        let Some(last) = asked.iter().map(Oscillators::largest).max() else {
            self.for_n_o = Vec::new();
            return Ok(());
        };
        if self.sampling.delayed {
            return Err(NoRatesOfClaim::WithDelay);
        }
        if 2 * last >= self.sampling.samples {
            return Err(NoRatesOfClaim::NotBelowHalf(last, self.sampling.samples));
        }
        let Some(proof) = self.claim() else {
            self.for_n_o = Vec::new();
            return Ok(());
        };
        if by_sampled_matrix(self.spec, proof) {
            // It has no norms of the error system, from which rates are proved at samples.
            let noise = || self.spec.disturbances.any_at_samples().then_some(Err(NoNoiseBound::ByMatrices));
            let of = |one: &Oscillators| SampledRateForCount { oscillators: one.clone(), bound: None, noise: noise() };
            self.for_n_o = asked.iter().map(of).collect();
        } else {
            fitting(&asked, self.spec.disturbances.any_at_samples())?;
            self.for_n_o = for_n_o_at_samples(self.spec, (proof, self.by_count.as_ref()), &asked);
            self.make_room(&asked);
        }
        self.set_rates_of_rows(&numbers(&asked));
        self.set_noise_of_rows(&asked);
        Ok(())
    }

    /// Why a rate that was asked about is not proved.
    #[must_use]
    pub fn why_no_rate(&self) -> String {
        if !self.claim().is_some_and(|proof| by_sampled_matrix(self.spec, proof)) {
            return NO_DECAY.to_owned();
        }
        let from = match self.norms_from {
            Some(sigma) => format!(": they prove a claim at the gain {}", shown(sigma)),
            // None was found, or none was looked for.
            None => String::new(),
        };
        format!("the claim rests on (Ms), and rates at samples are proved from norms{from}")
    }

    /// The sentences of the claim about them, each with a space before it.
    #[must_use]
    pub fn rates_in_words(&self) -> String {
        let Some(proof) = self.claim() else { return String::new() };
        rates_in_words(self.spec, &proof.witness.sigma, true, self.for_n_o.iter().filter_map(said_of))
    }
}

impl Certification<'_> {
    /// The rates of the claim, of each number of oscillators that was asked about: of sets of harmonics no least rate is asked.
    pub fn rates(&self) -> impl Iterator<Item = (u32, Option<&Rational>)> {
        of_numbers(&self.for_n_o)
    }

    /// Takes the claim back where a least rate was asked for and is not proved.
    pub(crate) fn keep_to_rate(&mut self) {
        let missed = self.sigma_star().and_then(|sigma| missed(&self.limits, sigma, self.rates()));
        if let Some(missed) = missed {
            self.take_back(missed);
        }
    }

    /// Takes the claim back, with all that was said beside it.
    pub(crate) fn take_back(&mut self, reason: Failing) {
        (self.sharp, self.verdict) = (Outcome::NotFound(reason.into()), Verdict::Undecided);
        (self.exact, self.gains, self.for_n_o, self.by_count) = (None, Vec::new(), Vec::new(), None);
    }
}

impl SampledCertification<'_> {
    /// The same at samples.
    pub fn rates(&self) -> impl Iterator<Item = (u32, Option<&Rational>)> {
        of_numbers(&self.for_n_o)
    }

    /// The same at samples.
    pub(crate) fn keep_to_rate(&mut self) {
        let missed = self.claim().and_then(|proof| missed(&self.limits, &proof.witness.sigma, self.rates()));
        if let Some(missed) = missed {
            self.take_back(missed);
        }
    }

    /// The same at samples.
    pub(crate) fn take_back(&mut self, reason: Failing) {
        (self.outcome, self.verdict) = (Outcome::NotFound(reason.into()), Verdict::Undecided);
        (self.gains, self.for_n_o, self.by_count) = (Vec::new(), Vec::new(), None);
    }
}

/// Numbers of oscillators with their rates.
fn of_numbers<P, Q>(found: &[ForCount<P, Q>]) -> impl Iterator<Item = (u32, Option<&Rational>)> {
    found.iter().map(ForCount::rate).filter_map(|(oscillators, rate)| Some((oscillators.n_o()?, rate)))
}

/// That the slowest of these rates is not what was asked for; nothing where it is, or where nothing was.
fn missed<'r>(
    limits: &Limits,
    sigma: &Rational,
    rates: impl Iterator<Item = (u32, Option<&'r Rational>)>,
) -> Option<Failing> {
    let asked = limits.rate.as_ref()?;
    let (n_o, slowest) = rates.min_by_key(|(_, rate)| *rate)?;
    let (of, largest) = (sigma.to_f64(), slowest.map(Rational::to_f64));
    slowest.is_none_or(|rate| rate < asked).then(|| Failing::Rate { n_o, asked: asked.to_f64(), largest, sigma: of })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_few_small_and_different() {
        assert_eq!(rate_counts(&[4, 0, 50, 4]), Ok(vec![0, 4, 50]));
        assert_eq!(rate_counts(&[]), Ok(Vec::new()));
        assert_eq!(rate_counts(&[1, 101]), Err(NoRatesOfClaim::Beyond(101)));
        assert_eq!(rate_counts(&[100]), Ok(vec![100]));
        // (n + 1) (2 n + 3) each, and twice as many with noise.
        assert_eq!(rate_counts(&[100, 42]), Err(NoRatesOfClaim::TooLarge(20_503 + 3741)));
        assert_eq!(fitting(&[Oscillators::first(76)], true), Ok(()));
        assert_eq!(fitting(&[Oscillators::first(77)], true), Err(NoRatesOfClaim::TooLarge(2 * 78 * 157)));
        assert_eq!(rate_counts(&[0, 1, 2, 3, 4, 5, 6, 7, 8]), Err(NoRatesOfClaim::TooMany(9)));
        assert!(rate_counts(&[7; 20]).is_ok());
    }

    /// Of a set the number of its oscillators counts for the size of the matrix, and its largest harmonic for the limit.
    #[test]
    fn sets_follow_the_numbers() {
        let set = |harmonics: &[u32]| Oscillators::at(harmonics).unwrap();
        let asked = [set(&[0, 5, 7]), set(&[0, 1, 2]), set(&[0, 2]), Oscillators::first(0), set(&[0, 2])];
        let all = rate_oscillators(&asked).unwrap();
        assert_eq!(all, [Oscillators::first(0), Oscillators::first(2), set(&[0, 2]), set(&[0, 5, 7])]);
        assert_eq!(covered(&asked, false).unwrap(), all[..2]);
        assert_eq!(covered(&asked, true).unwrap(), all);
        assert_eq!(rate_oscillators(&[set(&[0, 101])]), Err(NoRatesOfClaim::Beyond(101)));
        // One that begins at 100 is small.
        assert_eq!(rate_oscillators(&[Oscillators::first(100), set(&[0, 100])]).unwrap().len(), 2);
        let many: Vec<Oscillators> = (2..11).map(|k| set(&[0, k])).collect();
        assert_eq!(rate_oscillators(&many), Err(NoRatesOfClaim::TooMany(9)));
    }
}
