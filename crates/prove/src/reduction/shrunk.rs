//! How much smaller the initial set of a plant may have to be, where no gain is found for the one that is asked for.

use super::watch::{Stage, Unwatched, Watch};
use super::{Ask, Prepared, RestsOn, Subject};
use crate::certify::{Limits, Options};
use rug::Rational;
use sigmastar_lang::spec::{Constant, Document, InitialSet, SIZES};

/// Where documents have their initial set.
pub const INITIAL_SET: &str = "/initial_set";

/// How often the sizes may be halved: three tries decide between these, closer where a set is more likely to be wanted.
const HALVINGS: [u32; 7] = [1, 2, 3, 4, 6, 8, 15];

/// The initial set with all of its sizes divided by the same number.
#[derive(Clone, Debug)]
pub struct Shrunk {
    /// By what: a power of two.
    pub divisor: u64,
    /// The next smaller number, with which no gain was found; 1 is the set that is asked for.
    pub fails: u64,
    /// The fields of the file, and what they are then.
    pub sizes: Vec<(&'static str, Constant)>,
    /// A gain that is certified of the file with these sizes, which may have a smaller one; without one the divisor is the largest that was
    /// tried.
    pub sigma: Option<Rational>,
}

/// The smallest of a few divisors with which the plant is found to be certified, in three searches, each as a file with these sizes is
/// certified, but without joint metrics where nothing is asked for; where the largest does not do, that one. `None` of a document that is no
/// plant or states no sizes. Hypothesis: with its own sizes no gain is found.
///
/// Guarantee: what has a gain is certified with it.
#[must_use]
pub fn shrunk(
    document: &Document,
    gain: Option<&Rational>,
    asked: (&Limits, &[u32]),
    options: Options,
    watch: &dyn Watch,
) -> Option<Shrunk> {
    watch.enter(Stage::Comparison);
    let options = Options { compare: false, ..options };
    let (mut below, mut rungs, mut tries) = (0, &HALVINGS[..], 0);
    let mut best = None;
    while !rungs.is_empty() {
        let (smaller, rest) = rungs.split_at((rungs.len() - 1) / 2);
        let (halvings, larger) = rest.split_first()?;
        tries += 1;
        watch.tried(tries);
        let (subject, sizes) = divided(document, 1 << halvings)?;
        let sigma = certified(subject, gain, asked, options);
        // Where nothing has a gain this is the last one.
        let serves = sigma.is_some();
        if serves || best.as_ref().is_none_or(|best: &Shrunk| best.sigma.is_none()) {
            best = Some(Shrunk { divisor: 1 << halvings, fails: 1, sizes, sigma });
        }
        if serves {
            rungs = smaller;
        } else {
            (below, rungs) = (*halvings, larger);
        }
    }
    best.map(|best| Shrunk { fails: 1 << below, ..best })
}

/// A gain that is certified of a plant.
fn certified(
    subject: Subject,
    gain: Option<&Rational>,
    (limits, counts): (&Limits, &[u32]),
    options: Options,
) -> Option<Rational> {
    let plain = gain.is_none() && limits.is_empty() && counts.is_empty() && subject.actuator().is_none();
    let prepared = match plain {
        true => {
            let ask = Ask { gain: None, on: RestsOn::WithoutJoint, rows: false };
            Prepared::resting(subject, ask, &Unwatched)
        }
        false => Prepared::seeking(&subject, gain.cloned(), (limits, counts), options, &Unwatched),
    };
    let prepared = prepared.ok()?;
    let run = prepared.judged(options, &Unwatched)?;
    Some(run.certified()?.sigma.clone())
}

/// The plant of the document with its sizes divided, and these.
fn divided(document: &Document, divisor: u64) -> Option<(Subject, Vec<(&'static str, Constant)>)> {
    let mut changed = document.clone();
    for name in ["ball"].into_iter().chain(SIZES) {
        let value = document.at(&format!("{INITIAL_SET}/{name}"));
        if let Some(text) = value.as_ref().and_then(|value| value.numeral().or_else(|| value.text())) {
            changed = changed.with_field(INITIAL_SET, name, &format!("({text})/{divisor}")).ok()?;
        }
    }
    let subject = Subject::read(&changed).ok()?;
    let Subject::Plant(plant) = &subject else { return None };
    let mut sizes = Vec::new();
    let _: InitialSet<()> = plant.initial_set.map_each(|place, size: &Constant| {
        let name = if place == 0 && plant.ball.is_some() { "ball" } else { SIZES[place] };
        sizes.push((name, size.clone()));
    });
    (!sizes.is_empty()).then_some((subject, sizes))
}
