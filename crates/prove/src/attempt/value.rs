//! From a sampled supremum to a decided bound a little above it.

use rug::Rational;
use sigmastar_decide::bounds::Engine;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::spec::Bound;
use sigmastar_propose::bounds::FloatSuprema;
use sigmastar_theory::evidence::Entry;

/// What a sampled supremum is enlarged by, until a bound is proved, and the boxes that each attempt may take. The first is for what does
/// not vary.
const ATTEMPTS: [(f64, usize); 7] =
    [(1e-5, 8), (0.001, 1500), (0.003, 3000), (0.01, 4000), (0.03, 6000), (0.1, 6000), (LAST_SLACK, 20_000)];

/// The enlargements and boxes of the attempts from three states on: another program, which may need some ten times as many boxes, is to
/// decide the value again.
const MODEST_ATTEMPTS: [(f64, usize); 7] =
    [(1e-5, 8), (0.001, 100), (0.003, 200), (0.01, 400), (0.03, 800), (0.1, 2000), (LAST_SLACK, 20_000)];

/// The enlargements and boxes of the attempts from five states on, where that program may need a hundred times as many boxes.
const FEWER_ATTEMPTS: [(f64, usize); 7] =
    [(1e-5, 8), (0.001, 10), (0.003, 20), (0.01, 50), (0.03, 150), (0.1, 500), (LAST_SLACK, 20_000)];

/// The slack of the last attempt of each of these.
const LAST_SLACK: f64 = 0.3;

/// An attempt with this slack that is refuted sends the search to where it was: the samples have missed something.
const MISSED: f64 = 0.01;

/// How often samples are corrected by what is met on boxes, and the boxes that are looked at for it, from three states on fewer.
const LESSONS: usize = 4;
const EXPLORED: [usize; 2] = [2000, 500];

/// A correction by a smaller share is none, and the room above the largest value in which nothing is looked for.
const NEWS: f64 = 1e-3;

/// Where none of the attempts succeeds, multiples of the largest value; then what lies between the last that was not proved and
/// the first that was is halved until they are that close, with so many boxes in all.
const MULTIPLES: [f64; 8] = [1.6, 2.5, 4.0, 10.0, 30.0, 1e2, 1e4, 1e6];
const CLOSE: f64 = 1.05;
const LAST_EFFORT: usize = 40_000;

/// Digits of a value, beyond those that its slack takes.
const DIGITS: u32 = 6;

/// So many of the attempts take the value alone for its size first, where what follows would take much of it.
const OWN: usize = 4;

/// What an attempt adds at least otherwise, relative to the spread of the local rates over the region: a rate may be near 0.
const PART_OF_SPREAD: f64 = 0.1;

/// A bound with its proof done.
#[derive(Clone, Debug, PartialEq)]
pub struct ProvedValue {
    /// The value, which [`Engine::decide`] has found true.
    pub value: Rational,
    /// The largest sample (of a rate the least) that it was sought from.
    pub sampled: f64,
    /// The boxes of the proof.
    pub boxes: usize,
}

/// A bound for `G(X,E)` that is proved and little larger than the supremum (little less for a rate): by 0.001 %, 0.1 %, 0.3 %, 1 %,
/// 3 %, 10 % or 30 %. The supremum is sampled; where an attempt is refuted, what is met on boxes corrects it. Where all of
/// these fail, a norm is bounded by the least value above that is proved, to 5 %. `None` if none is. `samples` must be of the
/// same plant and region.
#[must_use]
pub fn prove_value(
    engine: &Engine,
    samples: &FloatSuprema,
    kind: Bound,
    x: &Rational,
    e: &Rational,
) -> Option<ProvedValue> {
    let reach = engine.reach(x);
    let with_tube = matches!(kind, Bound::Qtx | Bound::Qte).then(|| samples.with_tube(engine.radius()));
    let samples = with_tube.as_ref().unwrap_or(samples);
    let sampled = samples.refined(kind, reach, e.to_f64());
    if !sampled.value.is_finite() {
        return None;
    }
    let spread = if kind.is_rate() { PART_OF_SPREAD * sampled.spread } else { 0.0 };
    let size = |value: f64| value.abs().max(spread);
    let ladder = match engine.states() {
        0..=2 => ATTEMPTS,
        3 | 4 => MODEST_ATTEMPTS,
        _ => FEWER_ATTEMPTS,
    };
    // Beside a spread that is larger than the value, the value's own digits come first.
    let own = |value: f64| ladder.iter().take(OWN).map(move |(slack, effort)| (slack * value.abs(), *effort));
    let sign = if kind.is_rate() { -1.0 } else { 1.0 };
    let explored = EXPLORED[usize::from(engine.states() > 2)];
    let mut known = sampled.value;
    'lessons: for _ in 0..LESSONS {
        let own = own(known).filter(|_| spread > known.abs()).map(|(room, effort)| (0.0, room, effort));
        let steps = own.chain(ladder.iter().map(|(slack, effort)| (*slack, slack * size(known), *effort)));
        for (slack, room, effort) in steps {
            let (proved, boxes) = attempt(engine, kind, [x, e], (known, known + sign * room), effort);
            if proved.is_some() {
                return proved;
            }
            // It ends before its effort where the middle of a box refutes it.
            if slack >= MISSED && boxes < effort {
                let room = NEWS * size(known);
                let met = engine.explore(kind, [x, e], (known, room), explored).largest;
                if sign * (met - known) > room {
                    known = met;
                    continue 'lessons;
                }
            }
        }
        break;
    }
    if kind.is_rate() || known <= 0.0 {
        return None;
    }
    least_above(engine, kind, [x, e], known, explored)
}

/// The least value above that is proved, to 5 %.
fn least_above(engine: &Engine, kind: Bound, at: [&Rational; 2], known: f64, explored: usize) -> Option<ProvedValue> {
    let above = engine.explore(kind, at, (known, NEWS * known), explored).above;
    let mut values: Vec<f64> = MULTIPLES.iter().map(|multiple| multiple * known).chain([above]).collect();
    values.retain(|value| value.is_finite() && *value > known * (1.0 + LAST_SLACK));
    values.sort_by(f64::total_cmp);
    let mut left = LAST_EFFORT;
    let mut failed = known * (1.0 + LAST_SLACK);
    let mut proved = None;
    for value in values {
        let (found, boxes) = attempt(engine, kind, at, (known, value), left / 2);
        left = left.saturating_sub(boxes);
        if found.is_some() {
            proved = found;
            break;
        }
        failed = value;
    }
    let mut best = proved?;
    while best.value.to_f64() > CLOSE * failed && left > 1 {
        let middle = (failed * best.value.to_f64()).sqrt();
        let (found, boxes) = attempt(engine, kind, at, (known, middle), left / 2);
        left = left.saturating_sub(boxes);
        match found {
            Some(found) => best = found,
            None => failed = middle,
        }
    }
    Some(best)
}

/// A value, rounded and decided, and the boxes that were examined.
fn attempt(
    engine: &Engine,
    kind: Bound,
    [x, e]: [&Rational; 2],
    (known, value): (f64, f64),
    effort: usize,
) -> (Option<ProvedValue>, usize) {
    let direction = if kind.is_rate() { Direction::Down } else { Direction::Up };
    let Some(value) = round_f64(value, DIGITS, direction) else { return (None, effort) };
    let decision = engine.decide(&Entry { bound: kind, x: x.clone(), e: e.clone(), value: value.clone() }, effort);
    let boxes = decision.boxes;
    (decision.truth.is_true().then_some(ProvedValue { value, sampled: known, boxes }), boxes)
}
