//! The table: the smallest certified gain for sampling periods, the longest certified sampling period for gains.

use super::certifier::{Certifier, Pair};
use super::round::{RoundForm, round_samplings};
use rug::Rational;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::spec::{Constant, MAX_SAMPLES, Sampling};
use sigmastar_propose::search::{Closest, Failing, Obstacle};

/// Shares of 1/sigma* that are listed where no sampling periods are asked for.
const PRODUCTS: [f64; 6] = [0.5, 0.2, 0.1, 0.05, 0.02, 0.01];

/// Multiples of sigma* that are listed where no gains are asked for.
const MULTIPLES: [f64; 5] = [1.1, 1.5, 2.0, 3.0, 5.0];

/// Digits of those gains.
const DIGITS: u32 = 4;

/// How often a little more samples are tried where the pair that was found does not certify.
const AGAIN: u32 = 4;

/// How many round sampling periods are tried for a gain.
const ROUND: usize = 4;

/// How far beyond the samples that h sigma <= 1 and theta <= 1 ask for they are doubled.
const FAR: f64 = 256.0;

/// The samples that are tried where norms promise nothing, over those that h sigma <= 1 asks for.
const BEYOND: [f64; 3] = [4.0, 16.0, 64.0];

/// More samples than are taken.
const MANY: Obstacle = Obstacle { failing: Failing::Samples, at: None };

/// What a row is about.
#[derive(Clone, Debug)]
pub enum Asked {
    /// The smallest gain for this sampling period.
    Step(Sampling),
    /// The longest sampling period for this gain.
    Gain(Rational),
    /// The longest round one.
    Round(Rational, RoundForm),
}

/// One row.
#[derive(Clone, Debug)]
pub struct Row {
    /// What was asked.
    pub asked: Asked,
    /// The pair, or what stands in its way.
    pub found: Result<Pair, Obstacle>,
}

/// The rows.
#[derive(Clone, Debug)]
pub struct SamplingStudy {
    /// About the smallest gain of the regulator in continuous time, in floating point, where one was found.
    pub continuous: Option<f64>,
    /// One for each sampling period.
    pub by_step: Vec<Row>,
    /// One for each gain.
    pub by_gain: Vec<Row>,
    /// One for each gain that has a sampling period: a round one that is no longer.
    pub round: Vec<Row>,
}

impl SamplingStudy {
    /// Certifies the pairs of the lists; without either list, of some that fit the continuous-time gain.
    ///
    /// Guarantee: every pair that is found is certified by itself. The gain, or the sampling period, is the best that was found,
    /// not the best there is. It is about the law with a delay where the document asks for that.
    #[must_use]
    pub fn new(
        certifier: &impl Certifier,
        period: &Constant,
        steps: Option<Vec<Sampling>>,
        gains: Option<Vec<Rational>>,
    ) -> SamplingStudy {
        let continuous = certifier.continuous().ok();
        let (steps, gains) = match (steps, gains) {
            (None, None) => (default_steps(certifier, period, continuous), default_gains(continuous)),
            (steps, gains) => (steps.unwrap_or_default(), gains.unwrap_or_default()),
        };
        let of_step = |sampling: Sampling| {
            let sampling = sampling.with_delay(delayed(certifier));
            let found = certifier.pair(&sampling, None);
            Row { asked: Asked::Step(sampling), found }
        };
        let by_step: Vec<Row> = steps.into_iter().map(of_step).collect();
        let of_gain = |gain: Rational| {
            let known = by_step.iter().filter_map(|row| row.found.as_ref().ok()).filter(|pair| pair.sigma == gain);
            let fewer = |a: &Pair, b: &Pair| a.sampling.samples.cmp(&b.sampling.samples);
            let longest = longest(certifier, period, &gain);
            let found = match known.chain(longest.as_ref().ok()).min_by(|a, b| fewer(a, b)) {
                Some(pair) => Ok(pair.clone()),
                None => longest,
            };
            Row { asked: Asked::Gain(gain), found }
        };
        let by_gain: Vec<Row> = gains.into_iter().map(of_gain).collect();
        let pairs = by_gain.iter().filter_map(|row| row.found.as_ref().ok());
        let round = pairs.map(|pair| rounded(certifier, period, pair)).collect();
        SamplingStudy { continuous, by_step, by_gain, round }
    }

    /// Whether some pair is certified.
    #[must_use]
    pub fn has_pair(&self) -> bool {
        self.by_step.iter().chain(&self.by_gain).any(|row| row.found.is_ok())
    }
}

/// Whether it is about the law with a delay.
fn delayed(certifier: &impl Certifier) -> bool {
    certifier.model().sampling.as_ref().is_some_and(|sampling| sampling.delayed)
}

/// The samples T/n apart.
fn samples(certifier: &impl Certifier, period: &Constant, n: u32) -> Option<Sampling> {
    Some(Sampling::new(period, period.divided_by(n)?)?.with_delay(delayed(certifier)))
}

fn default_steps(certifier: &impl Certifier, period: &Constant, continuous: Option<f64>) -> Vec<Sampling> {
    let Some(sigma) = continuous else { return Vec::new() };
    let mut counts: Vec<u32> = PRODUCTS
        .iter()
        .map(|product| (period.to_f64() * sigma / product).ceil().clamp(2.0, f64::from(MAX_SAMPLES)) as u32)
        .collect();
    counts.dedup();
    counts.into_iter().filter_map(|n| samples(certifier, period, n)).collect()
}

fn default_gains(continuous: Option<f64>) -> Vec<Rational> {
    let Some(sigma) = continuous else { return Vec::new() };
    MULTIPLES.iter().filter_map(|multiple| round_f64(multiple * sigma, DIGITS, Direction::Up)).collect()
}

/// The pair of a gain with the fewest samples: doubled until a search finds a witness, then bisected.
fn longest(certifier: &impl Certifier, period: &Constant, gain: &Rational) -> Result<Pair, Obstacle> {
    let sigma = gain.to_f64();
    let promise =
        |n: u32| samples(certifier, period, n).ok_or(MANY).and_then(|sampling| certifier.promise(&sampling, sigma));
    // h sigma <= 1.
    let least = (period.to_f64() * sigma * (1.0 - 1e-12)).ceil().max(2.0);
    if least > f64::from(MAX_SAMPLES) {
        return Err(MANY);
    }
    let most = most(certifier, period, least);
    let mut high = least as u32;
    let mut low = high - 1;
    while let Err(obstacle) = promise(high) {
        if high >= most {
            // Where the search that is cheap promises nothing, a matrix inequality may still serve.
            let others = BEYOND.into_iter().filter_map(|times| samples(certifier, period, (times * least) as u32));
            return others.filter_map(|at| certifier.pair(&at, Some(gain)).ok()).next().ok_or(obstacle);
        }
        low = high;
        high = high.saturating_mul(2).min(most);
    }
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if promise(middle).is_ok() { high = middle } else { low = middle }
    }
    let mut closest = Closest::default();
    for _ in 0..=AGAIN {
        match samples(certifier, period, high).ok_or(MANY).and_then(|at| certifier.pair(&at, Some(gain))) {
            Ok(pair) => return Ok(pair),
            Err(obstacle) => closest.record(obstacle),
        }
        high = (high + 1 + high / 32).min(MAX_SAMPLES);
    }
    closest.or(None)
}

/// The longest of the round sampling periods that are tried, no longer than that of a pair, with the same gain.
fn rounded(certifier: &impl Certifier, period: &Constant, longest: &Pair) -> Row {
    let (form, samplings) = round_samplings(period, longest.sampling.samples);
    let mut closest = Closest::default();
    let mut found = Err(MANY);
    for sampling in samplings.into_iter().take(ROUND) {
        let sampling = sampling.with_delay(delayed(certifier));
        // A pair that is round itself is certified already.
        let same = sampling.samples == longest.sampling.samples;
        match if same { Ok(longest.clone()) } else { certifier.pair(&sampling, Some(&longest.sigma)) } {
            Ok(pair) => {
                found = Ok(Pair { sampling, ..pair });
                break;
            }
            Err(obstacle) => {
                closest.record(obstacle);
                found = closest.or(None);
            }
        }
    }
    Row { asked: Asked::Round(longest.sigma.clone(), form), found }
}

/// The most samples that are tried: far beyond h sigma = 1 and theta = 1, where sampling hardly matters any more.
fn most(certifier: &impl Certifier, period: &Constant, least: f64) -> u32 {
    let model = certifier.model();
    let load = period.to_f64() * model.mu.to_f64() * model.weights.total(64).upper_f64();
    let most = FAR * if load > least { load } else { least };
    if most < f64::from(MAX_SAMPLES) { most as u32 } else { MAX_SAMPLES }
}
