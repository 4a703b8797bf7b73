//! What a run is at, for whoever waits for it. Nothing that is worked out depends on it.

use std::fmt;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A part of the way from a document to a decided claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The periodic orbit of a plant, found and proved, in each cell of a family.
    Orbit,
    /// Coordinates, paths and a gain, proposed from samples of a plant's derivatives.
    Coordinates,
    /// The bounds of a plant's formulas, proved at the arguments of the proposal.
    Bounds,
    /// Metrics that join the states and the error, proposed and proved.
    Metrics,
    /// The triple of a Jacobian, sought and proved.
    Triple,
    /// The free numbers of a claim, searched for, rounded and decided.
    Witness,
    /// Other data and gains, for a claim that is to keep to limits.
    Limits,
    /// What other data would give, beside the claim.
    Comparison,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Stage::Orbit => "finding and proving the periodic orbit",
            Stage::Coordinates => "choosing coordinates and a gain over samples",
            Stage::Bounds => "proving the bounds of the formulas",
            Stage::Metrics => "proposing and proving joint metrics",
            Stage::Triple => "finding and proving the triple of the Jacobian",
            Stage::Witness => "searching the free numbers, deciding the conditions",
            Stage::Limits => "seeking a gain that keeps to what is asked for",
            Stage::Comparison => "working out what else would give",
        })
    }
}

/// Hears of the stages of a run. A stage may come again, where another choice is tried.
pub trait Watch: Sync {
    /// A stage begins.
    fn enter(&self, stage: Stage);

    /// So many parts of it are done, of so many; they are done on several threads, so that a number may be told late.
    fn part(&self, done: usize, of: usize);

    /// So many candidates are tried of a stage that does not know how many there will be; on several threads, as parts.
    fn tried(&self, count: usize);

    /// So many whole searches of so many are done, and so many steps in all of them; on several threads, as parts.
    fn searched(&self, done: usize, of: usize, steps: usize);
}

/// Nobody waits.
#[derive(Clone, Copy, Debug)]
pub struct Unwatched;

impl Watch for Unwatched {
    fn enter(&self, _: Stage) {}

    fn part(&self, _: usize, _: usize) {}

    fn tried(&self, _: usize) {}

    fn searched(&self, _: usize, _: usize, _: usize) {}
}

/// What whole searches within one stage are watched by: it is told of each of their steps, for the first of them may take long.
pub(super) struct Searches<'w> {
    watch: &'w dyn Watch,
    of: usize,
    done: AtomicUsize,
    steps: AtomicUsize,
}

impl Searches<'_> {
    /// So many searches.
    pub(super) fn new(of: usize, watch: &dyn Watch) -> Searches<'_> {
        Searches { watch, of, done: AtomicUsize::new(0), steps: AtomicUsize::new(0) }
    }

    /// One of them is done.
    pub(super) fn one_is_done(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        self.watch.searched(done, self.of, self.steps.load(Ordering::Relaxed));
    }

    fn step(&self) {
        let steps = self.steps.fetch_add(1, Ordering::Relaxed) + 1;
        self.watch.searched(self.done.load(Ordering::Relaxed), self.of, steps);
    }
}

impl Watch for Searches<'_> {
    fn enter(&self, _: Stage) {}

    fn part(&self, _: usize, _: usize) {
        self.step();
    }

    fn tried(&self, _: usize) {
        self.step();
    }

    fn searched(&self, _: usize, _: usize, _: usize) {
        self.step();
    }
}
