//! A claim in words: with what it speaks of (period, regulator, data), and what of that is given and not proved.
//!
//! The letters of a sentence are those of the claim: T its period, L the coordinates of the certificate, and so on. Names of the document
//! stand in quotes.

use crate::certify::{apart, claimed_ball};
use rug::Rational;
use sigmastar_exact::number::write_exact;
use sigmastar_lang::expr::{in_words, quoted};
use sigmastar_lang::spec::model::LyapunovSource;
use sigmastar_lang::spec::{Actuator, Bound, Constant, InputGain, Interval, OfPlant, Parameters, Specification};
use sigmastar_theory::derivation::initial_set::ClaimedSet;
use sigmastar_theory::derivation::sampled::{DelayWitness, SampledWitness};

/// The claim of the regulator in continuous time in words; `every_set`: whether it is about every set of harmonics (derivation, 14.7).
#[must_use]
pub fn statement(spec: &Specification, sigma: &Rational, set: &ClaimedSet, every_set: bool) -> String {
    in_continuous_time(spec, sigma, set, (ball(spec, set).as_ref(), every_set))
}

/// The ball that a claimed set of a plant with states contains.
fn ball(spec: &Specification, set: &ClaimedSet) -> Option<Rational> {
    spec.plant().and_then(|plant| claimed_ball(plant, &set.x0))
}

/// The claim of the regulator in continuous time in words, for a set that contains `ball` where one is given.
pub(super) fn in_continuous_time(
    spec: &Specification,
    sigma: &Rational,
    set: &ClaimedSet,
    (ball, every_set): (Option<&Rational>, bool),
) -> String {
    let model = &spec.internal_model;
    let reach = if model.matched { "" } else { " (which need not match the period)" };
    let input_gain = every_input_gain(spec);
    let nominal = spec.period.nominal().words();
    let period = match spec.period.interval() {
        None => format!("period T = {nominal}"),
        Some([low, high]) => {
            format!("every period in [{}, {}] (one constant T; nominal {nominal})", low.words(), high.words())
        }
    };
    let first = "every number of oscillators n_o >= 0";
    let oscillators = match every_set {
        false => first.to_owned(),
        true => format!("oscillators at every finite set of harmonics that contains 0 (so for {first})"),
    };
    format!(
        "For {oscillators} and {} {}{input_gain}{}, with {period}, mu = {} and base frequency {}{reach}, {}",
        if spec.actuator.is_some() { "the gain sigma =" } else { "every gain sigma >=" },
        write_exact(sigma),
        within_actuator(spec),
        model.mu.words(),
        model.base_frequency.words(),
        conclusion(spec, (set, ball), "at any initial time"),
    )
}

/// The claim of the regulator at samples in words.
#[must_use]
pub fn sampled_statement(spec: &Specification, witness: &SampledWitness) -> String {
    at_samples(spec, witness, (ball(spec, &witness.set).as_ref(), spec.internal_model.asks_every_set()))
}

/// The claim of the regulator at samples in words, for a set that contains `ball` where one is given.
pub(super) fn at_samples(
    spec: &Specification,
    witness: &SampledWitness,
    (ball, every_set): (Option<&Rational>, bool),
) -> String {
    let model = &spec.internal_model;
    let samples = witness.sampling.samples;
    let first = format!("every number of oscillators n_o < {samples}/2");
    let oscillators = match every_set {
        false => first,
        true => format!("oscillators at every set of harmonics below {samples}/2 that contains 0 (so for {first})"),
    };
    let start = match &witness.delay {
        None => "at any sampling instant".to_owned(),
        Some(DelayWitness { y_0, .. }) => {
            format!("at any sampling instant, with a prediction of e there within h*{} of it", apart(y_0))
        }
    };
    format!(
        "For the digital regulator {}with the gain sigma = {}, the sampling period h = {} ({samples} samples a period) and \
         K = {}, for {oscillators} and every phase of the sampling grid{}{}, with period T = {}, \
         mu = {} and base frequency {}, {}",
        if witness.sampling.delayed { "whose control is computed in the sample before it acts, " } else { "" },
        write_exact(&witness.sigma),
        in_words(&witness.sampling.text()),
        write_exact(&witness.law.gain),
        every_input_gain(spec),
        within_actuator(spec),
        spec.period.nominal().words(),
        model.mu.words(),
        model.base_frequency.words(),
        conclusion(spec, (&witness.set, ball), &start),
    )
}

/// " and every input gain in [9, 11] (...)", or " and the input gain 5 (...)" where both ends are written alike; nothing where there is none.
fn every_input_gain(spec: &Specification) -> String {
    spec.input_gain.as_ref().map_or_else(String::new, |InputGain { nominal, low, high, .. }| {
        let [nominal, low, high] = [nominal, low, high].map(Constant::words);
        let which = match low == high {
            true => format!("the input gain {low} ("),
            false => format!("every input gain in [{low}, {high}] (one constant; "),
        };
        format!(" and {which}the regulator divides its control by the nominal gain {nominal})")
    })
}

/// ", with an actuator that limits ..."; nothing where there is none.
fn within_actuator(spec: &Specification) -> String {
    let Some(Actuator { max, range, .. }) = &spec.actuator else { return String::new() };
    match range {
        None => format!(", with an actuator that limits what is put out to {} in size", max.words()),
        Some(range) => {
            let [min, max] = [range.min.words(), range.max.words()];
            format!(
                ", with an actuator that limits what is put out to the range from {min} to {max} (u is measured from its middle)"
            )
        }
    }
}

/// What the solutions of the claim do not ask of the actuator; nothing where there is none.
fn never_cut_off(spec: &Specification) -> &'static str {
    if spec.actuator.is_some() { " For these solutions the actuator cuts nothing off." } else { "" }
}

/// What converges to what: of all plants of the data, or of the plant whose formulas are in the certificate; `start` says when
/// a solution may start.
fn conclusion(spec: &Specification, (set, ball): (&ClaimedSet, Option<&Rational>), start: &str) -> String {
    if let Some(plant) = spec.plant() {
        return conclusion_of_plant((spec, plant), (set, ball), start);
    }
    let domain = spec
        .domain
        .as_ref()
        .map_or_else(String::new, |domain| format!(" (for |x| <= {}, |e| <= {})", domain.x.words(), domain.e.words()));
    let triple = match &spec.lyapunov {
        LyapunovSource::Given(triple) => format!(
            "with the Lyapunov triple p_low = {}, p_up = {}, alpha = {} (given, not proved)",
            triple.p_low.words(),
            triple.p_up.words(),
            triple.alpha.words()
        ),
        LyapunovSource::Wanted(_) | LyapunovSource::Proved { .. } | LyapunovSource::Plant(_) => {
            "whose df/dx(t,0,0) is in the family of the Jacobian (its Lyapunov triple is proved)".to_owned()
        }
    };
    let rate =
        if spec.bounds.own(Bound::Rate).is_some() { " and the contraction `rate` (given, not proved)" } else { "" };
    let harmonics = if spec.q_0.is_some() { " and harmonics of q(t,0,0) within `q_0` (given, not proved)" } else { "" };
    format!(
        "the closed loop of every plant within the bounding functions{domain} and {triple}{rate}{harmonics} has a T-periodic \
         solution. Every solution from |x| <= {}, {}, {start}, converges exponentially to it.{}",
        write_exact(&set.x0),
        of_regulator(set),
        never_cut_off(spec),
    )
}

/// What converges to what, of the plant whose formulas are in the certificate; nothing of it is assumed.
fn conclusion_of_plant(
    (spec, plant): (&Specification, &OfPlant),
    (set, ball): (&ClaimedSet, Option<&Rational>),
    start: &str,
) -> String {
    let domain = plant.domain.as_ref().map_or_else(String::new, |domain| {
        let of_x = if plant.states() > 0 { format!("|x - x_0| <= {}, ", domain.x.words()) } else { String::new() };
        format!(" (a model that holds for {of_x}|e| <= {})", domain.e.words())
    });
    let x0 = write_exact(&set.x0);
    let (state, orbit) = match ball {
        None => (String::new(), String::new()),
        Some(ball) => (
            format!("|L^-1 (x - x_0)| <= {x0}, "),
            format!(
                " Here x is the vector of the states, L the matrix `coordinates` of this certificate, and x_0(t) {}, in the norm of L^-1 x. \
                 The set contains |x - x_0| <= {}.",
                solution(plant),
                write_exact(ball)
            ),
        ),
    };
    let which = match members(&plant.parameters) {
        None => "the plant of these formulas".to_owned(),
        Some(members) => format!("every plant of these formulas with {members}"),
    };
    format!(
        "the closed loop of {which}{domain} has a T-periodic solution. Every solution from {state}{}, {start}, converges \
         exponentially to it.{}{orbit}",
        of_regulator(set),
        never_cut_off(spec),
    )
}

/// What x_0(t) is: of a plant in several cells there is one solution for each, and the claim is about any of them.
fn solution(plant: &OfPlant) -> &'static str {
    match plant.undivided() {
        Some(_) => "the T-periodic solution of x' = f(t,x,0) that is proved within `radius` of `orbit`",
        None => {
            "for any of the `cells` that contains the parameters of the plant the T-periodic solution of x' = f(t,x,0) that is proved \
             within `radius` of `orbit` of that cell"
        }
    }
}

/// "a constant 'k' of the file in [0.18, 0.22] and a constant 'c' of the file in [0, 0.2]"; none of a single plant.
#[must_use]
pub fn members(parameters: &Parameters) -> Option<String> {
    let one = |(name, Interval { low, high, .. }): (&str, &Interval)| {
        format!("a constant {} of the file in [{}, {}]", quoted(name), write_exact(low), write_exact(high))
    };
    let all: Vec<String> = parameters.named_intervals().map(one).collect();
    (!all.is_empty()).then(|| all.join(" and "))
}

/// How e and the regulator may start.
fn of_regulator(set: &ClaimedSet) -> String {
    let e0 = write_exact(&set.e0);
    match &set.z0 {
        Some(z0) => format!("|e| <= {e0}, sqrt(z'Nz) <= {}", write_exact(z0)),
        None => format!("|e| <= {e0}, z = M e"),
    }
}
