//! What a run is at, for whoever waits for it. Nothing that is worked out depends on it.

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
    /// What other data would give, beside the claim.
    Comparison,
}

/// Hears of the stages of a run. A stage may come again, where another choice is tried.
pub trait Watch: Sync {
    /// A stage begins.
    fn enter(&self, stage: Stage);

    /// So many parts of it are done, of so many; they are done on several threads, so that a number may be told late.
    fn part(&self, done: usize, of: usize);

    /// So many candidates are tried of a stage that does not know how many there will be; on several threads, as parts.
    fn tried(&self, count: usize);
}

/// Nobody waits.
#[derive(Clone, Copy, Debug)]
pub struct Unwatched;

impl Watch for Unwatched {
    fn enter(&self, _: Stage) {}

    fn part(&self, _: usize, _: usize) {}

    fn tried(&self, _: usize) {}
}
