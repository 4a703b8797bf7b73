//! The search for better values: points spread over the ranges, then descents from the best of them. Every point is certified.
//!
//! Which points are tried depends on the document, the ranges and the settings alone: points of one stage do not know of each
//! other, and each descent has tries of its own, so the number of threads changes nothing.

use super::figures::{Figures, Goal};
use super::parameter::{Parameter, with_values};
use rayon::prelude::*;
use rug::Rational;
use sigmastar_document::progress::Progress;
use sigmastar_exact::number::{Direction, Portable, round_f64, write_exact};
use sigmastar_lang::spec::{Document, SpecErrors};
use sigmastar_propose::search::{Descent, minimise};
use sigmastar_prove::certify::Verdict;
use std::cell::RefCell;
use std::collections::BTreeMap;

/// The most proposals that are certified.
pub const MAX_TRIES: u32 = 10_000;

/// Significant digits of a value that is proposed.
const DIGITS: u32 = 3;

/// One of so many tries is spread over the ranges, before any descent.
const SPREAD_SHARE: usize = 4;

/// Descents, from the best points of those: a function may have more than one valley.
const DESCENTS: usize = 3;

/// The first step of a descent in a logarithm: a factor of 1.6, or a quarter of the range if that is less.
const STEP: f64 = 0.47;

/// How far a descent goes on. Its tolerance is beneath what three digits of a value can show; the limit on tries ends it
/// earlier.
const DESCENT: Descent = Descent { restarts: 6, iterations: 200, tolerance: 1e-7 };

/// What is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// What is to be small.
    pub goal: Goal,
    /// The number of oscillators for which the error is told.
    pub n_o: u64,
    /// How many proposals are certified at most, the values of the document among them.
    pub tries: u32,
}

/// A proposal and what it came to.
#[derive(Clone, Debug)]
pub struct Tried {
    /// The values as they are written, in the order of the parameters.
    pub values: Vec<String>,
    /// The certified figures, or the verdict.
    pub outcome: Result<Figures, Verdict>,
}

impl Tried {
    /// An upper bound of what is to be small; `None` where nothing is certified.
    fn value(&self, goal: Goal) -> Option<Rational> {
        self.outcome.as_ref().ok()?.value(goal)
    }
}

/// What became of it all.
#[derive(Clone, Debug)]
pub struct Tuning {
    /// What was asked for.
    pub settings: Settings,
    /// What was tuned.
    pub parameters: Vec<Parameter>,
    /// The document as it was.
    pub before: Tried,
    /// The best proposal, where it is certified and better than the document as it was.
    pub after: Option<(Tried, Document)>,
    /// How many proposals were certified, without the document as it was.
    pub certified: usize,
    /// How many came to no claim, by verdict.
    pub without_claim: BTreeMap<String, usize>,
}

impl Tuning {
    /// Whether there is anything certified at all.
    #[must_use]
    pub fn has_claim(&self) -> bool {
        self.figures().next().is_some()
    }

    /// What is certified, of before and of after.
    pub(super) fn figures(&self) -> impl Iterator<Item = &Figures> {
        let after = self.after.as_ref().map(|(after, _)| after);
        std::iter::once(&self.before).chain(after).filter_map(|tried| tried.outcome.as_ref().ok())
    }
}

/// Tunes the parameters of a specification or plant.
///
/// Guarantee: the figures of `before` and `after` are certified for their documents; nothing is claimed of other values.
///
/// # Errors
/// A document that is too large with other values.
pub fn tune(
    document: &Document,
    parameters: Vec<Parameter>,
    settings: Settings,
    progress: &impl Progress,
) -> Result<Tuning, SpecErrors> {
    let subject = Subject { document, parameters: &parameters, settings };
    let written: Vec<String> = parameters.iter().map(|parameter| parameter.written.clone()).collect();
    let before = Tried { values: written, outcome: Figures::of(document, settings.n_o) };
    progress.advance();
    let certified = |values: &[String]| {
        if before.values == values {
            return before.clone();
        }
        let tried = subject.certify(values);
        progress.advance();
        tried
    };

    let tries = settings.tries.saturating_sub(1) as usize;
    let spread = spread(&parameters, tries.div_ceil(SPREAD_SHARE));
    let mut points = vec![parameters.iter().map(|parameter| parameter.start).collect::<Vec<f64>>()];
    points.extend(spread);
    points.truncate(tries);
    let all: Vec<Tried> = points.par_iter().with_max_len(1).map(|point| certified(&subject.values(point))).collect();
    let starts = best_of(&all, settings.goal, DESCENTS);
    let each = (tries - all.len()) / starts.len().max(1);
    let known: BTreeMap<Vec<String>, Option<f64>> =
        all.iter().map(|tried| (tried.values.clone(), cost(tried, settings.goal))).collect();
    let descents: Vec<Vec<Tried>> = starts
        .par_iter()
        .with_max_len(1)
        .map(|start| descend(&subject, &points[*start], &known, each, &certified))
        .collect();
    let all: Vec<Tried> = all.into_iter().chain(descents.into_iter().flatten()).collect();

    let best = best_of(&all, settings.goal, 1).first().map(|index| all[*index].clone());
    let better = best.filter(|best| match (best.value(settings.goal), before.value(settings.goal)) {
        (Some(now), Some(then)) => now < then,
        (now, None) => now.is_some(),
        (None, Some(_)) => false,
    });
    let after = better
        .map(|best| with_values(document, &parameters, &best.values).map(|document| (best, document)))
        .transpose()?;
    let proposed = || all.iter().filter(|tried| tried.values != before.values);
    let mut without_claim = BTreeMap::new();
    for verdict in proposed().filter_map(|tried| tried.outcome.as_ref().err()) {
        *without_claim.entry(verdict.to_string()).or_default() += 1;
    }
    let certified = proposed().filter(|tried| tried.outcome.is_ok()).count();
    Ok(Tuning { settings, parameters, before, after, certified, without_claim })
}

/// What is tuned.
#[derive(Clone, Copy)]
struct Subject<'t> {
    document: &'t Document,
    parameters: &'t [Parameter],
    settings: Settings,
}

impl Subject<'_> {
    /// The values at a point of logarithms: decimals of few digits, or an end of the range exactly.
    fn values(&self, point: &[f64]) -> Vec<String> {
        let value = |(parameter, logarithm): (&Parameter, &f64)| {
            let [low, high] = &parameter.range;
            let rounded = round_f64(logarithm.portable_exp(), DIGITS, Direction::Nearest);
            let inside = rounded.unwrap_or_else(|| high.clone()).clamp(low, high);
            write_exact(&inside)
        };
        self.parameters.iter().zip(point).map(value).collect()
    }

    fn certify(&self, values: &[String]) -> Tried {
        let outcome = with_values(self.document, self.parameters, values)
            .map_err(|_| Verdict::BadInput)
            .and_then(|document| Figures::of(&document, self.settings.n_o));
        Tried { values: values.to_vec(), outcome }
    }
}

/// Points that are spread evenly over the ranges: an additive recurrence in the powers of the root of x^(d+1) = x + 1.
fn spread(parameters: &[Parameter], count: usize) -> Vec<Vec<f64>> {
    let exponent = 1.0 / (parameters.len() as f64 + 1.0);
    let root = (0..60).fold(1.5_f64, |root, _| (1.0 + root).portable_pow(exponent));
    let point = |index: usize| {
        let coordinate = |(axis, parameter): (usize, &Parameter)| {
            let power = (0..=axis).fold(1.0, |power, _| power * root);
            let share = (0.5 + (index as f64 + 1.0) / power).fract();
            let [low, high] = parameter.logarithms();
            low + share * (high - low)
        };
        parameters.iter().enumerate().map(coordinate).collect()
    };
    (0..count).map(point).collect()
}

/// The logarithm of what is to be small, for the method.
fn cost(tried: &Tried, goal: Goal) -> Option<f64> {
    tried.value(goal).map(|value| value.to_f64().portable_ln()).filter(|cost| cost.is_finite())
}

/// The indices of the best, best first; of equals the first.
fn best_of(all: &[Tried], goal: Goal, count: usize) -> Vec<usize> {
    let mut certified: Vec<(Rational, usize)> =
        all.iter().enumerate().filter_map(|(index, tried)| Some((tried.value(goal)?, index))).collect();
    certified.sort();
    certified.into_iter().map(|(_, index)| index).take(count).collect()
}

/// The proposals of a descent from a point, in their order.
fn descend(
    subject: &Subject<'_>,
    start: &[f64],
    known: &BTreeMap<Vec<String>, Option<f64>>,
    tries: usize,
    certified: &impl Fn(&[String]) -> Tried,
) -> Vec<Tried> {
    let goal = subject.settings.goal;
    // Values are of few digits: the method asks about many points twice.
    let seen = RefCell::new((known.clone(), Vec::new()));
    let value = |point: &[f64]| {
        let values = subject.values(point);
        let mut seen = seen.borrow_mut();
        let (costs, tried): &mut (_, Vec<Tried>) = &mut seen;
        if let Some(cost) = costs.get(&values) {
            return *cost;
        }
        if tried.len() >= tries {
            return None;
        }
        let new = certified(&values);
        let cost = cost(&new, goal);
        costs.insert(values, cost);
        tried.push(new);
        cost
    };
    let step = |(parameter, at): (&Parameter, &f64)| {
        let [low, high] = parameter.logarithms();
        let step = STEP.min(0.25 * (high - low));
        // A step across the end would try the end itself.
        if at + step <= high { step } else { -step }
    };
    let steps: Vec<f64> = subject.parameters.iter().zip(start).map(step).collect();
    // What it returns is among what was tried.
    let _ = minimise(&value, start, &steps, DESCENT);
    seen.into_inner().1
}
