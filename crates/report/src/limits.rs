//! What a claim keeps to at its gain: limits that were asked for, and what the actuator takes.

use super::words;
use rug::Rational;
use serde_json::{Map, Value, json};
use sigmastar_document::number::{exact, full, upper};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_lang::spec::Specification;
use sigmastar_prove::certify::{Certification, Limits, SampledCertification};
use sigmastar_theory::derivation::control::Control;
use sigmastar_theory::derivation::sampled::SampledEvaluation;

/// What is bounded at the gain of a claim.
struct Bounds<'r> {
    /// The rates for the numbers of oscillators that were asked about.
    rates: Vec<(u32, Option<&'r Rational>)>,
    /// |e| along the periodic solution and in the transient, and what is put out at all times: with the numbers of oscillators that are asked about, or with
    /// every one.
    all: [Enclosure; 3],
}

impl<'r> Bounds<'r> {
    /// Those of a claim in continuous time.
    fn of_run(run: &'r Certification<'_>) -> Option<Bounds<'r>> {
        let all = match &run.limits.by_count {
            Some(counts) => run.bounds_with(counts)?,
            None => of_conditions(run.bounds()?),
        };
        Some(Bounds { rates: run.rates().collect(), all })
    }

    /// Those of a claim at samples.
    fn of_samples(run: &'r SampledCertification<'_>) -> Option<Bounds<'r>> {
        let SampledEvaluation { size, peak, control, .. } = &run.claim()?.evaluation;
        let all = match &run.limits.by_count {
            Some(counts) => run.bounds_with(counts)?,
            None => of_conditions((&size.e_per, peak, control)),
        };
        Some(Bounds { rates: run.rates().collect(), all })
    }
}

fn of_conditions((steady, peak, control): (&Enclosure, &Enclosure, &Control<Enclosure>)) -> [Enclosure; 3] {
    [steady.clone(), peak.clone(), &control.steady + &control.transient]
}

/// " At sigma = 39.8018, |e| <= 0.1 (proved: 0.0997) in the transient, ...": what a claim keeps to, which a larger gain need not; empty where nothing was
/// asked for.
pub(super) fn sentence(run: &Certification<'_>) -> String {
    in_words(run.sigma_star(), Bounds::of_run(run).and_then(|bounds| kept(&run.limits, &bounds)))
}

/// What a claim at samples keeps to, as a sentence; empty where nothing was asked for.
pub(super) fn sampled_sentence(run: &SampledCertification<'_>) -> String {
    let sigma = run.claim().map(|proof| &proof.witness.sigma);
    in_words(sigma, Bounds::of_samples(run).and_then(|bounds| kept(&run.limits, &bounds)))
}

fn in_words(sigma: Option<&Rational>, kept: Option<String>) -> String {
    sigma.zip(kept).map_or_else(String::new, |(sigma, kept)| format!(" At $`sigma = {}`$, {kept}.", write_exact(sigma)))
}

/// "|e| <= 0.1 (proved: 0.0997) in the transient, ..."; nothing where nothing was asked for.
fn kept(limits: &Limits, bounds: &Bounds<'_>) -> Option<String> {
    let named = named(limits, bounds).into_iter().filter_map(|(_, [size, place], limit, bound)| {
        limit.map(|limit| format!("$`{size} <= {limit}`$ (proved: {}) {place}{}", upper(&bound), with_counts(limits)))
    });
    let all: Vec<String> = named.chain(rate_kept(limits, bounds)).collect();
    (!all.is_empty()).then(|| all.join(", "))
}

/// " with n_o = 4, 10", where a bound is one with these, or " with every n_o": of other sets of harmonics bounds by their number say nothing. Empty where the
/// conditions of the claim prove it, for all that the claim is about.
fn with_counts(limits: &Limits) -> String {
    match limits.by_count.as_deref() {
        None => String::new(),
        Some([]) => " with every $`n_o`$".to_owned(),
        Some(counts) => {
            let counts: Vec<String> = counts.iter().map(u32::to_string).collect();
            format!(" with $`n_o = {}`$", counts.join(", "))
        }
    }
}

/// "a rate of at least 2 for n_o = 0, 4 (proved: 2.3)"
fn rate_kept(limits: &Limits, bounds: &Bounds<'_>) -> Option<String> {
    let (asked, slowest) = (limits.rate.as_ref()?, slowest(bounds)?);
    let counts: Vec<String> = bounds.rates.iter().map(|(n_o, _)| n_o.to_string()).collect();
    let proved = exact(slowest, Direction::Down);
    Some(format!("a rate of at least {} for $`n_o = {}`$ (proved: {proved})", write_exact(asked), counts.join(", ")))
}

/// The slowest rate, where all are proved.
fn slowest<'r>(bounds: &Bounds<'r>) -> Option<&'r Rational> {
    bounds.rates.iter().map(|(_, rate)| *rate).min()?
}

/// What may be limited: its field, what is bounded and where, the limit that was asked for, and what is proved.
type Named = (&'static str, [&'static str; 2], Option<String>, Enclosure);

fn named(limits: &Limits, bounds: &Bounds<'_>) -> [Named; 3] {
    let text = |limit: &Option<Rational>| limit.as_ref().map(write_exact);
    let [steady, peak, control] = bounds.all.clone();
    [
        ("steady_error", ["|e|", "along the periodic solution"], text(&limits.steady_error), steady),
        ("peak_error", ["|e|", "in the transient"], text(&limits.peak_error), peak),
        ("control", ["|u|", "in the transient"], text(&limits.control), control),
    ]
}

/// The limits of a claim in continuous time as JSON: what was asked for, and what is proved; nothing where nothing was asked for.
pub(super) fn json(run: &Certification<'_>) -> Option<Value> {
    kept_json(&run.limits, &Bounds::of_run(run)?)
}

/// The limits of a claim at samples as JSON: what was asked for, and what is proved; nothing where nothing was asked for.
pub(super) fn sampled_json(run: &SampledCertification<'_>) -> Option<Value> {
    kept_json(&run.limits, &Bounds::of_samples(run)?)
}

fn kept_json(limits: &Limits, bounds: &Bounds<'_>) -> Option<Value> {
    let rate = limits.rate.as_ref().zip(slowest(bounds)).map(|(asked, proved)| {
        ("rate".to_owned(), json!({ "asked": write_exact(asked), "proved": write_exact(proved) }))
    });
    let named = named(limits, bounds).into_iter();
    let fields: Map<String, Value> = named
        .filter_map(|(name, _, limit, bound)| {
            let mut kept = json!({ "asked": limit?, "proved": full(&bound) });
            if let Some(counts) = limits.by_count.as_ref().filter(|counts| !counts.is_empty()) {
                kept["n_o"] = json!(counts);
            }
            Some((name.to_owned(), kept))
        })
        .chain(rate)
        .collect();
    (!fields.is_empty()).then(|| fields.into())
}

/// " and an actuator that takes |u| <= 50 (u stays within it)"; nothing where there is none.
pub(super) fn of_actuator(spec: &Specification) -> String {
    spec.actuator.as_ref().map_or_else(String::new, |actuator| {
        format!(
            " and an actuator that takes {} (solutions from the set below stay within this limit)",
            words::taken(actuator)
        )
    })
}
