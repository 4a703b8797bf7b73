//! How much smaller the initial set of a plant may have to be, where no gain is found for the one that is asked for.

use super::watch::{Stage, Unwatched, Watch};
use super::{Prepared, Subject};
use crate::certify::{Limits, Options};
use rug::Rational;
use sigmastar_lang::spec::{Constant, Document, InitialSet, SIZES};

/// Where documents have their initial set.
pub const INITIAL_SET: &str = "/initial_set";

/// How often the sizes are halved at most.
const HALVINGS: u32 = 15;

/// The initial set with all of its sizes divided by the same number.
#[derive(Clone, Debug)]
pub struct Shrunk {
    /// By what: a power of two.
    pub divisor: u64,
    /// The fields of the file, and what they are then.
    pub sizes: Vec<(&'static str, Constant)>,
    /// The gain that is certified of the file with these sizes; without one the divisor is the largest that was tried.
    pub sigma: Option<Rational>,
}

/// The smallest divisor that is found with which the plant is certified, each tried as a file with these sizes is certified; where the
/// largest does not do, that one. `None` of a document that is no plant or states no sizes.
///
/// Guarantee: what has a gain is certified with it.
#[must_use]
pub fn shrunk(
    document: &Document,
    gain: Option<&Rational>,
    (limits, counts): (&Limits, &[u32]),
    options: Options,
    watch: &dyn Watch,
) -> Option<Shrunk> {
    watch.enter(Stage::Comparison);
    let mut tries = 0;
    let mut with = |halvings: u32| {
        tries += 1;
        watch.tried(tries);
        let divisor = 1_u64 << halvings;
        let (subject, sizes) = divided(document, divisor)?;
        let options = Options { compare: false, ..options };
        let prepared = Prepared::seeking(&subject, gain.cloned(), (limits, counts), options, &Unwatched).ok();
        let sigma = prepared.and_then(|prepared| Some(prepared.certify(options).ok()?.certified()?.sigma.clone()));
        Some(Shrunk { divisor, sizes, sigma })
    };
    let mut best = with(HALVINGS)?;
    let (mut fails, mut serves) = (0, HALVINGS);
    while best.sigma.is_some() && serves - fails > 1 {
        let middle = (fails + serves) / 2;
        match with(middle).filter(|found| found.sigma.is_some()) {
            Some(found) => (best, serves) = (found, middle),
            None => fails = middle,
        }
    }
    Some(best)
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
