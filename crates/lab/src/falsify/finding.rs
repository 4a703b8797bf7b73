//! What a trial is about, and what became of it.

use super::family::Family;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Constant, Oscillators};

/// Which trials, from which seed.
#[derive(Clone, Copy, Debug)]
pub struct TrialSettings {
    /// The number of trials.
    pub trials: u64,
    /// The seed; trial k uses it and k only.
    pub seed: u64,
    /// The only trial that is run, where it is not all of them.
    pub only: Option<u64>,
}

impl TrialSettings {
    /// The numbers of the trials that are run, from 1.
    pub(super) fn numbers(self) -> Vec<u64> {
        self.only.map_or_else(|| (1..=self.trials).collect(), |only| vec![only])
    }
}

/// The plant of a trial.
#[derive(Clone, Debug)]
pub enum TriedPlant {
    /// Drawn within the families of a claim.
    Drawn(Box<Family>),
    /// The plant that the claim is about.
    Own(Box<Plant>),
}

impl TriedPlant {
    /// The names of the states.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        match self {
            TriedPlant::Drawn(plant) => (1..=plant.states()).map(|i| format!("x{i}")).collect(),
            TriedPlant::Own(plant) => plant.names.states().to_vec(),
        }
    }

    /// f and q as expressions.
    #[must_use]
    pub fn texts(&self) -> (Vec<String>, String) {
        match self {
            TriedPlant::Drawn(plant) => plant.texts(),
            TriedPlant::Own(plant) => (plant.f.iter().map(ToString::to_string).collect(), plant.q.to_string()),
        }
    }
}

/// What a trial is about.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Its number, from 1.
    pub number: u64,
    /// The plant.
    pub plant: TriedPlant,
    /// sigma, a little above sigma*; of the law at samples exactly the claimed one.
    pub sigma: f64,
    /// The oscillators.
    pub oscillators: Oscillators,
    /// x, e, z at the start, on the boundary of the initial set.
    pub start: Vec<f64>,
    /// The gain of the actuator, of a claim for an interval of them.
    pub input_gain: Option<f64>,
    /// The period, of a claim for an interval of them.
    pub period: Option<Constant>,
    /// The parameters of which the claim has intervals, with their exact values.
    pub parameters: Vec<(String, String)>,
    /// With the law at samples the time of the first sample, where the trial starts: the phase of the sampling grid.
    pub phase: Option<f64>,
}

/// A bound that does not hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Violation {
    /// What was bounded, with its formulas marked.
    pub quantity: &'static str,
    /// By what.
    pub bound: f64,
    /// What it is.
    pub found: f64,
}

/// What became of a trial.
#[derive(Clone, Debug)]
pub enum Finding {
    /// Every bound holds.
    Holds {
        /// What was tried.
        trial: Box<Trial>,
        /// For each quantity the found value over the bound.
        shares: Vec<(&'static str, f64)>,
    },
    /// A bound does not hold.
    Violated(Box<Trial>, Violation),
    /// No plant fits, or the simulation could not be finished for a reason that is no violation.
    Unfinished(String),
}

/// The quantity that is below 1 where the periodic solution is stable.
pub(super) const MULTIPLIER: &str = "largest Floquet multiplier";

/// The quantity that is 1 at the start where P_low = P_up.
pub(super) const LYAPUNOV: &str = "Lyapunov function in the transient, against its start";

/// The control along the periodic solution, and what it differs by in the transient.
pub(super) const STEADY_CONTROL: &str = "$`sup|u|`$ of the periodic solution";
pub(super) const CONTROL: &str = "$`|u - u_p|`$ in the transient, against its bound";
/// What is put out, where the actuator saturates.
pub(super) const SATURATION: &str = "$`|u|`$ in the transient, against what the actuator takes";

/// What a claim says by the number of oscillators, or for a set of harmonics: of the periodic solution and of all times.
pub(super) const STEADY_BY_COUNT: [&str; 3] = [
    "$`sup|e|`$ of the periodic solution, with these oscillators",
    "$`rms(e)`$ of the periodic solution, with these oscillators",
    "$`sup|u|`$ of the periodic solution, with these oscillators",
];
pub(super) const LARGEST_BY_COUNT: [&str; 2] =
    ["$`|e|`$ at all times, with these oscillators", "$`|u|`$ at all times, with these oscillators"];

/// The error with noise and a disturbance, near the periodic solution and from the initial set.
pub(super) const DISTURBED: [&str; 2] = [
    "$`|e - e_p|`$ with noise and disturbance, in the limit",
    "$`|e - e_p|`$ with noise and disturbance, in the transient",
];

/// The trial that came closest to a bound, of those in which every bound holds.
#[derive(Clone, Copy, Debug)]
pub struct Closest<'f> {
    /// What is bounded, with its formulas marked.
    pub quantity: &'static str,
    /// The found value over the bound.
    pub share: f64,
    /// The first trial with this share.
    pub trial: &'f Trial,
    /// All shares of that trial.
    pub shares: &'f [(&'static str, f64)],
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
    /// For each quantity the trial that came closest to its bound, in the order in which quantities are checked.
    #[must_use]
    pub fn closest(&self) -> Vec<Closest<'_>> {
        let mut all: Vec<Closest<'_>> = Vec::new();
        for finding in &self.findings {
            let Finding::Holds { trial, shares } = finding else { continue };
            for &(quantity, share) in shares {
                let here = Closest { quantity, share, trial, shares };
                match all.iter_mut().find(|closest| closest.quantity == quantity) {
                    Some(closest) if closest.share < share => *closest = here,
                    Some(_) => {}
                    None => all.push(here),
                }
            }
        }
        all
    }

    /// The trial that came closest to a bound of a size: the worst plant that was found. The multiplier, which tends to 1
    /// with n_o, and the Lyapunov function, which starts at its bound, are close to theirs with any plant.
    #[must_use]
    pub fn worst(&self) -> Option<Closest<'_>> {
        let sizes = self.closest().into_iter().filter(|closest| ![MULTIPLIER, LYAPUNOV].contains(&closest.quantity));
        sizes.reduce(|a, b| if a.share < b.share { b } else { a })
    }

    /// Whether in some trial every bound held.
    #[must_use]
    pub fn has_held(&self) -> bool {
        self.findings.iter().any(|finding| matches!(finding, Finding::Holds { .. }))
    }

    /// The first violation.
    #[must_use]
    pub fn counterexample(&self) -> Option<(&Trial, &Violation)> {
        self.findings.iter().find_map(|finding| match finding {
            Finding::Violated(trial, violation) => Some((&**trial, violation)),
            _ => None,
        })
    }
}
