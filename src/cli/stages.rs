//! The stages of a run on standard error, for whoever waits: where it is, and how far.
//!
//! How long a stage takes is not known beforehand, so no time is foretold; parts are counted where there are some.

use super::output;
use super::progress::{Later, TICK, give_clock};
use indicatif::{ProgressBar, ProgressDrawTarget};
use sigmastar::program::Afterwards;
use sigmastar_prove::reduction::{Stage, Watch};
use std::fmt;
use std::io::{IsTerminal, stderr};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How long a run takes before it is shown on a terminal.
const PATIENCE: Duration = Duration::from_secs(2);

/// How long a log is silent within a stage.
const PAUSE: Duration = Duration::from_secs(5);

/// A stage of a call of `certify`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// One of the library's.
    Of(Stage),
    /// The conditions, decided from the numbers of a certificate.
    Decision,
    /// What follows the claim.
    After(Afterwards),
    /// The simulation of figures.
    Figures,
}

impl Step {
    /// The stages that share a number: those behind the first are entered where they are wanted.
    fn number_of(self) -> Step {
        match self {
            Step::Of(Stage::Metrics) => Step::Of(Stage::Bounds),
            Step::Of(Stage::Limits | Stage::Comparison) => Step::Of(Stage::Witness),
            step => step,
        }
    }
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Step::Of(stage @ Stage::Comparison) => write!(f, "{stage} (`--no-alternatives` leaves it out)"),
            Step::Of(stage) => stage.fmt(f),
            Step::Decision => f.write_str("deciding the conditions"),
            Step::After(next) => next.fmt(f),
            Step::Figures => f.write_str("simulating for the figures"),
        }
    }
}

/// Who is told of the stages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Audience {
    Nobody,
    /// A line that changes, after a while.
    Terminal,
    /// A line for each stage, at once.
    Log,
}

/// The stages of a run, told until it is dropped.
pub struct Stages {
    steps: Vec<Step>,
    audience: Audience,
    bar: ProgressBar,
    start: Instant,
    at: Mutex<String>,
    /// When the log was last told of parts.
    told: Mutex<Instant>,
    shown: Option<Later>,
}

impl Stages {
    /// Those that a call will have, in their order; on a terminal, or wherever it is `asked` for.
    pub fn new(steps: Vec<Step>, asked: bool, quiet: bool) -> Stages {
        let audience = match (quiet, stderr().is_terminal()) {
            (true, _) => Audience::Nobody,
            (false, true) => Audience::Terminal,
            (false, false) if asked => Audience::Log,
            (false, false) => Audience::Nobody,
        };
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        let shown = (audience == Audience::Terminal).then(|| show_later(&bar));
        let (start, at) = (Instant::now(), Mutex::default());
        Stages { steps, audience, bar, start, at, told: Mutex::new(start), shown }
    }

    /// Whether somebody is told.
    pub fn are_told(&self) -> bool {
        self.audience != Audience::Nobody
    }

    /// A stage begins.
    pub fn begin(&self, step: Step) {
        let Some(number) = self.steps.iter().position(|known| *known == step.number_of()) else { return };
        let text = format!("stage {} of {}: {step}", number + 1, self.steps.len());
        let mut at = self.at.lock().unwrap_or_else(PoisonError::into_inner);
        if *at == text {
            return;
        }
        match self.audience {
            Audience::Nobody => {}
            Audience::Terminal => self.bar.set_message(text.clone()),
            Audience::Log => self.log(&text),
        }
        *at = text;
    }

    fn log(&self, text: &str) {
        output::remark(&format!("{text} (after {:.1} s)", self.start.elapsed().as_secs_f64()));
        *self.told.lock().unwrap_or_else(PoisonError::into_inner) = Instant::now();
    }

    /// How far the stage is: at once in the line of a terminal, now and then in a log.
    fn within(&self, count: &str) {
        match self.audience {
            Audience::Nobody => {}
            Audience::Terminal => {
                let at = self.at.lock().unwrap_or_else(PoisonError::into_inner);
                self.bar.set_message(format!("{at}, {count}"));
            }
            Audience::Log => {
                let at = self.at.lock().unwrap_or_else(PoisonError::into_inner);
                let told = self.told.lock().unwrap_or_else(PoisonError::into_inner).elapsed();
                if told >= PAUSE {
                    self.log(&format!("{at}, {count}"));
                }
            }
        }
    }
}

/// Shows a line after a while, with a clock.
fn show_later(bar: &ProgressBar) -> Later {
    give_clock(bar);
    let bar = bar.clone();
    Later::new(PATIENCE, move |_| {
        bar.set_draw_target(ProgressDrawTarget::stderr());
        bar.enable_steady_tick(TICK);
    })
}

impl Watch for Stages {
    fn enter(&self, stage: Stage) {
        self.begin(Step::Of(stage));
    }

    fn part(&self, done: usize, of: usize) {
        self.within(&format!("{done} of {of}"));
    }

    fn tried(&self, count: usize) {
        self.within(&format!("{count} candidates tried"));
    }

    fn searched(&self, done: usize, of: usize, steps: usize) {
        self.within(&format!("{done} of {of}, {steps} steps"));
    }
}

impl Drop for Stages {
    fn drop(&mut self) {
        // The line is shown before it is cleared, or never.
        drop(self.shown.take());
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(stages: &Stages) -> String {
        stages.at.lock().unwrap().clone()
    }

    #[test]
    fn a_stage_is_told_by_its_place_in_the_call() {
        let steps = vec![
            Step::Of(Stage::Orbit),
            Step::Of(Stage::Bounds),
            Step::Of(Stage::Witness),
            Step::After(Afterwards::Rates),
        ];
        let stages = Stages::new(steps, false, true);
        assert!(!stages.are_told());
        stages.enter(Stage::Orbit);
        assert_eq!(told(&stages), "stage 1 of 4: finding and proving the periodic orbit");
        stages.enter(Stage::Metrics);
        assert_eq!(told(&stages), "stage 2 of 4: proposing and proving joint metrics");
        stages.part(1, 2);
        stages.tried(3);
        stages.searched(1, 2, 3);
        // What this call does not have is not told.
        stages.enter(Stage::Triple);
        stages.begin(Step::Figures);
        assert_eq!(told(&stages), "stage 2 of 4: proposing and proving joint metrics");
        // A choice that fails is followed by another.
        stages.enter(Stage::Bounds);
        assert!(told(&stages).starts_with("stage 2 of 4: proving the bounds"));
        stages.begin(Step::After(Afterwards::Rates));
        assert_eq!(told(&stages), "stage 4 of 4: proving rates");
    }
}
