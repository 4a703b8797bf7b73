//! A progress bar on standard error, for work above a second.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use sigmastar::progress::Progress;
use std::io::{IsTerminal, stderr};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How long work takes before it is shown.
const PATIENCE: Duration = Duration::from_secs(1);

/// A bar that appears after a second, on a terminal only.
pub struct Bar {
    bar: ProgressBar,
    start: Instant,
    wanted: AtomicBool,
}

impl Bar {
    /// A bar for some units of work.
    pub fn new(units: u64, quiet: bool) -> Bar {
        let bar = ProgressBar::with_draw_target(Some(units), ProgressDrawTarget::hidden());
        // The template is a constant, and one that is read.
        if let Ok(style) = ProgressStyle::with_template("sigmastar: [{wide_bar}] {percent} % {eta} left") {
            bar.set_style(style.progress_chars("=> "));
        }
        Bar { bar, start: Instant::now(), wanted: AtomicBool::new(!quiet && stderr().is_terminal()) }
    }

    /// Removes the bar.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Progress for Bar {
    fn advance(&self) {
        if self.start.elapsed() > PATIENCE && self.wanted.swap(false, Ordering::Relaxed) {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.inc(1);
    }
}
