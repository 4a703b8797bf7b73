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
const TICK: Duration = Duration::from_millis(120);

/// Says after a second what is worked on, until it is dropped: with a running clock on a terminal, else in one line, where
/// that is wanted. For work of which nobody knows how much is left.
pub struct Working {
    stop: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

/// Where [`Working`] speaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Audience {
    /// Nowhere: `--quiet`.
    Nobody,
    /// On a terminal, and where standard error is a file or a pipe.
    Everywhere,
}

impl Working {
    /// Starts to wait; `what` completes "sigmastar: ...", and of work that may take long `more` says how to hear of its parts.
    pub fn new(what: &'static str, more: &'static str, audience: Audience) -> Working {
        let terminal = stderr().is_terminal();
        if audience == Audience::Nobody {
            return Working { stop: None, thread: None };
        }
        let (stop, stopped) = channel();
        let speak = move || {
            if !is_late(&stopped, PATIENCE) {
                return;
            }
            if !terminal {
                output::remark(&format!("{what}; this may take minutes{more}"));
                return;
            }
            let spinner = ProgressBar::new_spinner().with_message(what).with_elapsed(PATIENCE);
            // The template is a constant, and one that is read.
            if let Ok(style) = ProgressStyle::with_template("sigmastar: {msg} {spinner} {elapsed}") {
                spinner.set_style(style);
            }
            spinner.enable_steady_tick(TICK);
            // Nothing is ever sent: this returns when the sender is dropped.
            let _ = stopped.recv();
            spinner.finish_and_clear();
        };
        // Without a thread the work goes on, in silence.
        let thread = std::thread::Builder::new().spawn(speak).ok();
        Working { stop: Some(stop), thread }
    }
}

impl Drop for Working {
    fn drop(&mut self) {
        drop(self.stop.take());
        if let Some(thread) = self.thread.take() {
            // It has only written to standard error; there is nothing to be done about a panic of a library in it.
            let _ = thread.join();
        }
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
        assert!(Working::new("testing", "", Audience::Nobody).thread.is_none());
        assert!(Working::new("testing", "", Audience::Everywhere).thread.is_some());
    }
}
