//! Bounds for each number of oscillators, of plants that are linear in x and e (derivation, 14.3, 14.5; at samples 14.6).

use super::certification::Certification;
use super::gain_row::{ByCount, CountBounds, CountProof, GainRow, Largest, LoopSizes, RowProof};
use super::sampled::SampledCertification;
use super::trials::{Asked, ClaimProof, ClaimWitness, by_trials};
use rug::Rational;
use sigmastar_decide::conditions::{SampledProof, SharpProof};
use sigmastar_decide::linear::{
    Answers, Clock, Falling, FallingHeld, LinearPlant, Loop, PRECISION, Sizes, Start, sizes,
};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_exact::parallel;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Oscillators, Sampling, Specification};
use sigmastar_matrix::doubles::largest;
use sigmastar_matrix::inverse;
use sigmastar_propose::bounds::{FallingForm, HeldForm, HeldGoal, HeldProgram, PeakOf, PeakProgram, PointSlopes};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::control::Control;
use sigmastar_theory::derivation::initial_set::ClaimedSet;
use sigmastar_theory::derivation::sampled::SampledWitness;
use sigmastar_theory::derivation::sampled_form::LoopNumbers;
use sigmastar_theory::evidence::Part;
use std::collections::BTreeSet;

/// By what share of the diagonal the matrices of a form are to be definite, in turn.
const MARGINS: [f64; 2] = [1e-6, 1e-4];

/// Digits of the numbers of a form.
const DIGITS: u32 = 9;

/// Boxes of parameters and gains for all numbers of oscillators together: at the gain of the claim, and at the others.
const EFFORTS: [usize; 2] = [8192, 512];

/// What bounds are asked about.
struct Loops<'a> {
    sigma: &'a Rational,
    /// The law at samples, where it is that one: its witness.
    at_samples: Option<&'a SampledWitness>,
    set: &'a ClaimedSet,
    besides: &'a [Oscillators],
    effort: usize,
}

/// Bounds for every number of oscillators, at a gain and from a set, for every member of the family and every gain of the actuator.
///
/// Hypotheses: the plant is linear, with this specification; its base frequency is matched; the set is in the coordinates of the specification; at samples
/// h sigma <= 1, and the answers are those at the same samples. Guarantee: there is one periodic solution, which has these bounds, and so have the
/// solutions from the set. `None` where no form is found that falls, or a bound is not found; at samples also where they do not tell the harmonics of the
/// plant apart.
fn by_count((plant, answers): (&Plant, &Answers<'_>), spec: &Specification, loops: &Loops<'_>) -> Option<ByCount> {
    let Loops { sigma, at_samples, set, besides, effort } = *loops;
    let (linear, model) = (answers.plant(), &spec.internal_model);
    let coordinates = &spec.plant()?.coordinates;
    let gain = spec.input_gain.as_ref().and_then(|gain| gain.factors(PRECISION));
    let lines = u32::try_from(linear.lines()).ok()?;
    // With an oscillator for each line nothing changes any more.
    let sets = besides.iter().filter(|set| set.n_o().is_none()).cloned().collect::<BTreeSet<_>>();
    let all: Vec<Oscillators> = (0..=lines).map(Oscillators::first).chain(sets).collect();
    let last = all.iter().map(Oscillators::largest).max()?;
    let mut own = Loop::new(sigma, model, last as usize, gain, inverse(coordinates)?);
    let exact = |value: &Rational| Enclosure::from_rational(value, PRECISION);
    let mut y0 = Enclosure::zero(PRECISION);
    if let Some(SampledWitness { sampling, law, delay, .. }) = at_samples {
        if 2 * u64::from(last) >= u64::from(sampling.samples) {
            return None;
        }
        own = own.at_samples(law, sampling.samples, sampling.delayed);
        y0 = delay.as_ref().map_or(y0, |delay| exact(&delay.y_0));
    }
    let effort = effort / all.len();
    let of_one = |oscillators: &Oscillators| sizes(answers, &own, oscillators, effort);
    let found: Vec<Sizes<Enclosure>> = parallel::map(&all, of_one).into_iter().collect::<Option<_>>()?;
    let start = Start { x0: exact(&set.x0), e0: exact(&set.e0), z0: set.z0.as_ref().map(exact), y0 };
    let forms: Vec<Falling> = [PeakOf::Error, PeakOf::Control]
        .into_iter()
        .filter_map(|of| form((plant, linear), &own, coordinates, (&start, found.first()?), of))
        .collect();
    let nominal = spec.input_gain.as_ref().map(|gain| gain.nominal.enclose(PRECISION));
    let bounds = |(oscillators, sizes): (Oscillators, &Sizes<Enclosure>)| {
        let peaks = forms.iter().map(|form| form.peak(&own, &start, sizes));
        let peak = peaks.reduce(|a, b| sigmastar_decide::linear::Peak {
            error: a.error.min(&b.error),
            control: a.control.min(&b.control),
        })?;
        let Control { steady, transient } =
            Control { steady: sizes.control.clone(), transient: peak.control }.over(nominal.as_ref());
        Some(CountBounds {
            or_more: oscillators.n_o() == Some(lines),
            oscillators,
            steady_error: sizes.error.clone(),
            mean_square: sizes.mean_square.clone(),
            largest: Some(Largest { error: &sizes.error + &peak.error, transient }),
            steady_control: steady,
            sizes: LoopSizes { states: sizes.states.clone(), zeta: sizes.zeta.clone(), mean: sizes.mean.clone() },
        })
    };
    let counts = all.into_iter().zip(&found).map(bounds).collect::<Option<_>>()?;
    Some(ByCount { counts, proof: CountProof::Linear { forms }, checked: false })
}

/// A form that is proved to fall, with a small peak for the start of a loop without oscillators.
fn form(
    (plant, linear): (&Plant, &LinearPlant),
    own: &Loop,
    coordinates: &[Vec<Rational>],
    (start, sizes): (&Start, &Sizes<Enclosure>),
    of: PeakOf,
) -> Option<Falling> {
    let member = |values: Vec<Rational>| {
        let ends: Vec<[Rational; 2]> = values.into_iter().map(|value| [value.clone(), value]).collect();
        let rows = own.in_coordinates(&linear.member(&linear.enclosed(&ends))?.rows, coordinates);
        let rows: Vec<Vec<f64>> = rows.iter().map(|row| row.iter().map(Enclosure::midpoint_f64).collect()).collect();
        let (last, states) = rows.split_last()?;
        let (d, r) = last.split_last()?;
        let (j, g) =
            states.iter().filter_map(|row| row.split_last()).map(|(g, j)| (j, *g)).unzip::<_, _, Vec<_>, Vec<_>>();
        Some(PointSlopes { j: j.concat(), g, r: r.to_vec(), d: *d })
    };
    let program = PeakProgram {
        points: plant
            .parameters
            .looked_at()
            .into_iter()
            .map(|values| Some((Part::All, member(values)?)))
            .collect::<Option<_>>()?,
        gain: own.gain.each_ref().map(Enclosure::midpoint_f64),
        sigma: own.sigma.midpoint_f64(),
        mu: own.mu.midpoint_f64(),
        n_bar_squared: own.n_bar_squared.midpoint_f64(),
        start: start.distances(own, [&sizes.states, &sizes.error, &sizes.zeta]).map(|size| size.upper_f64()),
        joint: false,
        reach: None,
    };
    let propose = |margin: f64| match &own.held {
        None => rounded(&program.propose(of, margin)?),
        Some(held) => {
            let law = [program.mu, program.n_bar_squared];
            let moves = Some(program.gain.map(|b| 1.0 - b));
            let of_law = LoopNumbers::new(program.sigma, held.step.midpoint_f64(), law, &std::f64::consts::PI, moves);
            let past = held.delayed.then(|| (&start.y0 + &sizes.mean).upper_f64());
            rounded_at_samples(&program.propose_at_samples(
                HeldGoal::Peak(of),
                margin,
                &HeldProgram { of: of_law, past },
            )?)
        }
    };
    MARGINS.into_iter().filter_map(propose).find(|form| form.decide(linear, own, coordinates).is_true())
}

/// A number in few digits.
fn short(value: f64) -> Option<Rational> {
    round_f64(value, DIGITS, Direction::Nearest)
}

/// A form in short numbers, of the law at samples.
fn rounded_at_samples(HeldForm { matrix, weight, k_p, lambda, past, .. }: &HeldForm) -> Option<Falling> {
    let held = FallingHeld { lambda: short(*lambda)?, past: past.map_or(Some(None), |past| short(past).map(Some))? };
    Some(Falling { held: Some(held), ..of_numbers(matrix, *weight, *k_p)? })
}

/// A form in short numbers.
fn rounded(FallingForm { matrix, weight, k_p, .. }: &FallingForm) -> Option<Falling> {
    of_numbers(matrix, *weight, *k_p)
}

fn of_numbers(matrix: &[Vec<f64>], weight: f64, k_p: f64) -> Option<Falling> {
    let row = |row: &Vec<f64>| row.iter().map(|entry| short(*entry)).collect::<Option<Vec<Rational>>>();
    let above = if matrix.is_empty() { 1.0 } else { largest(matrix.to_vec()) * (1.0 + 1e-6) };
    Some(Falling {
        matrix: matrix.iter().map(row).collect::<Option<_>>()?,
        p_up: round_f64(above, DIGITS, Direction::Up)?,
        weight: short(weight)?,
        k_p: short(k_p)?,
        held: None,
    })
}

impl GainRow {
    /// The row with the bounds for every number of oscillators where these are smaller.
    fn with(&mut self, found: &ByCount) {
        let at_samples = self.steady_with.is_empty();
        let of_steady = match at_samples {
            true => found.largest(|bounds| Some(&bounds.steady_error)),
            false => found.at(0).map(|own| own.steady_error.clone()),
        };
        if let Some(bound) = of_steady {
            self.steady = self.steady.min(&bound);
        }
        for (n_o, bound) in &mut self.steady_with {
            if let Some(own) = found.at(u64::from(*n_o)) {
                *bound = bound.min(&own.steady_error);
            }
        }
        if let Some(peak) = found.largest(|bounds| Some(&bounds.largest.as_ref()?.error)) {
            self.peak = self.peak.min(&peak);
        }
        let transient = found.largest(|bounds| Some(&bounds.largest.as_ref()?.transient));
        if let Some((steady, transient)) = found.largest(|bounds| Some(&bounds.steady_control)).zip(transient) {
            let Control { steady: known, transient: known_transient } = &self.control;
            self.control = Control { steady: known.min(&steady), transient: known_transient.min(&transient) };
        }
    }
}

impl Certification<'_> {
    /// Bounds of |e| along the periodic solution and at all times, and of the control, for every number of oscillators, at the gain of the claim, if
    /// certified: the least that are proved.
    #[must_use]
    pub fn best_bounds(&self) -> Option<(Enclosure, Enclosure, Control<Enclosure>)> {
        let (steady, peak, control) = self.bounds()?;
        let own = self.gains.first();
        let (peak, control) = own.map_or((peak, control), |row| (&row.peak, &row.control));
        Some(least_of((steady, peak, control), self.by_count.as_ref()))
    }

    /// Bounds by the number of oscillators at the gain of the claim: for every number where the plant is linear in x and e; where nothing of it is an
    /// interval for every number if a few oscillators meet all that counts, and else for some of them; and for those `besides`, sets with gaps where the claim is about
    /// every set; nothing where the base frequency is not matched. They are about the loop without noise and disturbance.
    pub fn set_counts(&mut self, plant: &Plant, besides: &[Oscillators]) {
        let every_set = self.is_for_every_set();
        let besides: Vec<Oscillators> =
            besides.iter().filter(|set| every_set || set.n_o().is_some()).cloned().collect();
        let Some(SharpProof { witness, evaluation, .. }) = self.sharp.proved().filter(|_| self.has_counts()) else {
            return;
        };
        self.by_count = match LinearPlant::of(plant) {
            Some(linear) => {
                let answers = Answers::new(&linear, clock(plant, None));
                let (sigma, set) = (&witness.sigma, &witness.set);
                let loops = Loops { sigma, at_samples: None, set, besides: &besides, effort: EFFORTS[0] };
                by_count((plant, &answers), self.spec, &loops)
            }
            None => {
                let exact = |value: &Rational| Enclosure::from_rational(value, PRECISION);
                let periodic = &evaluation.periodic;
                let data = Data::new(self.spec, PRECISION);
                let kappas = data.kappas(&exact(&witness.k0), &exact(&witness.k1));
                let periodic = [periodic.x_per.clone(), periodic.e_per.clone()];
                let proof = ClaimProof { witness: ClaimWitness::Continuous { witness, kappas }, periodic, data };
                by_trials(&Asked {
                    plant,
                    spec: self.spec,
                    sigma: &witness.sigma,
                    set: &witness.set,
                    proof,
                    besides: &besides,
                })
            }
        };
    }

    fn has_counts(&self) -> bool {
        self.spec.internal_model.matched && self.claim().is_some()
    }

    /// The rows with such bounds: that of the claim with those that are known, and the others where the plant is linear in x and e.
    pub fn set_counts_of_rows(&mut self, plant: &Plant) {
        if self.by_count.is_none() {
            return;
        }
        let linear = LinearPlant::of(plant);
        let answers = linear.as_ref().map(|linear| Answers::new(linear, clock(plant, None)));
        let claim = self.claim();
        let at = |row: &GainRow| {
            let RowProof::Continuous(proof, other) = &row.proof else { return None };
            // What is known is about the set of the claim; a row may have another one.
            let own = claim.as_ref().filter(|claim| *claim.sigma == row.sigma && *claim.set == proof.witness.set);
            if own.is_some() && other.is_none() {
                return self.by_count.clone();
            }
            let spec = other.as_deref().unwrap_or(self.spec);
            let set = &proof.witness.set;
            let loops = Loops { sigma: &row.sigma, at_samples: None, set, besides: &[], effort: EFFORTS[1] };
            by_count((plant, answers.as_ref()?), spec, &loops)
        };
        let found = parallel::map(&self.gains, at);
        with_bounds(&mut self.gains, &found);
    }
}

/// The rows with what is found at their gains.
fn with_bounds(rows: &mut [GainRow], found: &[Option<ByCount>]) {
    for (row, found) in rows.iter_mut().zip(found) {
        if let Some(found) = found {
            row.with(found);
        }
    }
}

/// When the harmonics of a plant with a matched base frequency are looked at.
fn clock(plant: &Plant, sampling: Option<&Sampling>) -> Clock {
    let fundamental = plant.internal_model.base_frequency.enclose(PRECISION);
    Clock { fundamental, samples: sampling.map(|sampling| sampling.samples) }
}

impl SampledCertification<'_> {
    /// Bounds by the number of oscillators at the gain of the claim, of a plant that is linear in x and e, and for those `besides`, sets with gaps where the
    /// claim is about every set. They are about the loop without noise, disturbance and rounding.
    pub fn set_counts(&mut self, plant: &Plant, besides: &[Oscillators]) {
        let every_set = self.spec.internal_model.asks_every_set();
        let besides: Vec<Oscillators> =
            besides.iter().filter(|set| every_set || set.n_o().is_some()).cloned().collect();
        let counts = |proof: &SampledProof| match LinearPlant::of(plant) {
            Some(_) => self.counts_at((plant, &besides), &proof.witness, EFFORTS[0]),
            None => self.trials_at((plant, &besides), proof),
        };
        self.by_count = self.claim().and_then(counts);
    }

    /// By trials, of a law without a delay.
    fn trials_at(
        &self,
        (plant, besides): (&Plant, &[Oscillators]),
        SampledProof { witness, evaluation, .. }: &SampledProof,
    ) -> Option<ByCount> {
        let model = &self.spec.internal_model;
        if !model.matched || witness.delay.is_some() {
            return None;
        }
        // The last oscillator that the samples tell apart has the least weight.
        let last = u64::from((witness.sampling.samples - 1) / 2);
        let weight = model.weights.weight(last, PRECISION);
        let proof = ClaimProof {
            witness: ClaimWitness::AtSamples { witness, law: witness.about(), weight },
            periodic: [evaluation.size.x_per.clone(), evaluation.size.e_per.clone()],
            data: Data::new(self.spec, PRECISION),
        };
        let (sigma, set) = (&witness.sigma, &witness.set);
        by_trials(&Asked { plant, spec: self.spec, sigma, set, proof, besides })
    }

    /// The rows with such bounds.
    pub fn set_counts_of_rows(&mut self, plant: &Plant) {
        if self.by_count.is_none() {
            return;
        }
        let at = |row: &GainRow| {
            let RowProof::Sampled(proof) = &row.proof else { return None };
            if self.claim().is_some_and(|claim| claim.witness.sigma == row.sigma) {
                return self.by_count.clone();
            }
            self.counts_at((plant, &[]), &proof.witness, EFFORTS[1])
        };
        let found = parallel::map(&self.gains, at);
        with_bounds(&mut self.gains, &found);
    }

    fn counts_at(
        &self,
        (plant, besides): (&Plant, &[Oscillators]),
        witness: &SampledWitness,
        effort: usize,
    ) -> Option<ByCount> {
        let linear = LinearPlant::of(plant)?;
        let answers = Answers::new(&linear, clock(plant, Some(&witness.sampling)));
        let (sigma, set) = (&witness.sigma, &witness.set);
        by_count((plant, &answers), self.spec, &Loops { sigma, at_samples: Some(witness), set, besides, effort })
    }

    /// Bounds of |e| along the periodic solution and at all times, and of the control, for every number of oscillators, if certified: the least that are
    /// proved.
    #[must_use]
    pub fn best_bounds(&self) -> Option<(Enclosure, Enclosure, Control<Enclosure>)> {
        let evaluation = &self.claim()?.evaluation;
        Some(least_of((&evaluation.size.e_per, &evaluation.peak, &evaluation.control), self.by_count.as_ref()))
    }
}

/// Bounds of the steady error, the peak and the control, or what is proved of these for every number of oscillators where that is smaller.
fn least_of(
    (steady, peak, Control { steady: of_u, transient }): (&Enclosure, &Enclosure, &Control<Enclosure>),
    by_count: Option<&ByCount>,
) -> (Enclosure, Enclosure, Control<Enclosure>) {
    let least = |known: &Enclosure, of: &dyn Fn(&CountBounds) -> Option<&Enclosure>| {
        by_count.and_then(|found| found.largest(of)).map_or_else(|| known.clone(), |own| known.min(&own))
    };
    let control = Control {
        steady: least(of_u, &|bounds| Some(&bounds.steady_control)),
        transient: least(transient, &|bounds| Some(&bounds.largest.as_ref()?.transient)),
    };
    let peak = least(peak, &|bounds| Some(&bounds.largest.as_ref()?.error));
    (least(steady, &|bounds| Some(&bounds.steady_error)), peak, control)
}
