//! Progress on standard error, for work above a second.

use super::output;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use sigmastar_document::progress::Progress;
use std::io::{IsTerminal, stderr};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
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

/// How often the sign of life of a terminal moves.
pub const TICK: Duration = Duration::from_millis(120);

/// Does something after a while, unless it is dropped before. What it does is given a channel on which nothing is ever sent, and which
/// ends when this is dropped.
pub struct Later {
    stop: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Later {
    /// Starts to wait.
    pub fn new(patience: Duration, act: impl FnOnce(&Receiver<()>) + Send + 'static) -> Later {
        let (stop, stopped) = channel();
        let wait = move || {
            if is_late(&stopped, patience) {
                act(&stopped);
            }
        };
        // Without a thread the work goes on, in silence.
        Later { stop: Some(stop), thread: std::thread::Builder::new().spawn(wait).ok() }
    }
}

impl Drop for Later {
    fn drop(&mut self) {
        drop(self.stop.take());
        if let Some(thread) = self.thread.take() {
            // It has only written to standard error; there is nothing to be done about a panic of a library in it.
            let _ = thread.join();
        }
    }
}

/// Says after a second what is worked on, until it is dropped: with a running clock on a terminal, else in one line. For work of which
/// nobody knows how much is left: `what` completes "sigmastar: ...", and of work that may take long `more` says how to hear of its parts.
pub fn working(what: &'static str, more: &'static str, quiet: bool) -> Option<Later> {
    let speak = move |stopped: &Receiver<()>| {
        if !stderr().is_terminal() {
            output::remark(&format!("{what}; this may take minutes{more}"));
            return;
        }
        let spinner = ProgressBar::new_spinner().with_message(what).with_elapsed(PATIENCE);
        give_clock(&spinner);
        spinner.enable_steady_tick(TICK);
        let _ = stopped.recv();
        spinner.finish_and_clear();
    };
    (!quiet).then(|| Later::new(PATIENCE, speak))
}

/// What a line with a running clock looks like.
pub fn give_clock(bar: &ProgressBar) {
    // The template is a constant, and one that is read.
    if let Ok(style) = ProgressStyle::with_template("sigmastar: {msg} {spinner} {elapsed}") {
        bar.set_style(style);
    }
}

/// Whether the work still goes on after so much time.
fn is_late(stopped: &Receiver<()>, patience: Duration) -> bool {
    stopped.recv_timeout(patience) == Err(RecvTimeoutError::Timeout)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finished_work_is_not_spoken_of() {
        let (stop, stopped) = channel();
        assert!(is_late(&stopped, Duration::ZERO));
        drop(stop);
        assert!(!is_late(&stopped, Duration::from_secs(3600)));
    }

    #[test]
    fn quiet_work_starts_no_thread() {
        assert!(working("testing", "", true).is_none());
        assert!(working("testing", "", false).is_some_and(|later| later.thread.is_some()));
    }
}
