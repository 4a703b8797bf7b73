//! What a trial is about, and what became of it.

use super::draw::DrawnPlant;

/// How many trials, from which seed.
#[derive(Clone, Copy, Debug)]
pub struct TrialSettings {
    /// The number of trials.
    pub trials: u64,
    /// The seed; trial k uses it and k only.
    pub seed: u64,
}

/// What a trial is about.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Its number, from 1.
    pub number: u64,
    /// The plant.
    pub plant: DrawnPlant,
    /// sigma, a little above sigma*.
    pub sigma: f64,
    /// n_o.
    pub n_o: u32,
    /// x(0), e(0), z(0) on the boundary of the initial set.
    pub start: Vec<f64>,
}

/// A bound that does not hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Violation {
    /// What was bounded.
    pub quantity: &'static str,
    /// By what.
    pub bound: f64,
    /// What it is.
    pub found: f64,
}

/// What became of a trial.
#[derive(Clone, Debug)]
pub enum Finding {
    /// Every bound holds; the largest share of one that was used.
    Holds {
        /// For each quantity the found value over the bound.
        shares: Vec<(&'static str, f64)>,
    },
    /// A bound does not hold.
    Violated(Box<Trial>, Violation),
    /// No plant fits, or the simulation could not be finished for a reason that is no violation.
    Unfinished(String),
}

/// What became of all trials, in their order.
#[derive(Clone, Debug)]
pub struct Falsification {
    /// What was asked for.
    pub settings: TrialSettings,
    /// One finding for each trial.
    pub findings: Vec<Finding>,
}

impl Falsification {
    /// The first violation.
    #[must_use]
    pub fn counterexample(&self) -> Option<(&Trial, &Violation)> {
        self.findings.iter().find_map(|finding| match finding {
            Finding::Violated(trial, violation) => Some((&**trial, violation)),
            _ => None,
        })
    }
}
