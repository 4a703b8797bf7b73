//! Long work beside the interpreter: other threads of Python go on, and Ctrl-C is heard.

use crate::dict::{Dict, Value};
use crate::told::answer;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use sigmastar::Error;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// How often signals are looked at.
const POLL: Duration = Duration::from_millis(50);

/// The stack of the main thread of a program, so that what the program can read can be read here.
const STACK: usize = 8 << 20;

/// What the thread of the work sends.
enum Sent {
    /// What it is at.
    Told(String),
    /// What it found.
    Found(Dict),
}

/// Tells what work is at.
pub type Tell<'t> = dyn Fn(&str) + Sync + 't;

/// Runs work in a thread of its own, waits for it without the interpreter's lock, and tells what it found or why it found nothing.
///
/// Where a signal handler raises, as that of Ctrl-C does, the exception is raised at once; the thread is left to itself, and what
/// it finds is dropped.
///
/// # Errors
/// The exception of a signal handler, a thread that cannot be started, and one that panicked.
pub fn outside<T: Value>(py: Python<'_>, work: impl FnOnce() -> Result<T, Error> + Send + 'static) -> PyResult<Dict> {
    outside_telling(py, None, move |_| work())
}

/// [`outside`], with a function of Python that is called, in the thread of the caller, with what the work is at. An exception of it is raised at once.
///
/// # Errors
/// Those of [`outside`], and of the function.
pub fn outside_telling<T: Value>(
    py: Python<'_>,
    told: Option<Py<PyAny>>,
    work: impl FnOnce(&Tell<'_>) -> Result<T, Error> + Send + 'static,
) -> PyResult<Dict> {
    let (sender, mut receiver) = channel();
    // Nobody may be there any more to receive.
    let work = move || {
        let found = answer(work(&|text| drop(sender.send(Sent::Told(text.to_owned())))));
        drop(sender.send(Sent::Found(found)));
    };
    thread::Builder::new().stack_size(STACK).spawn(work)?;
    loop {
        let (received, back) = py.detach(move || (receiver.recv_timeout(POLL), receiver));
        receiver = back;
        match received {
            Ok(Sent::Found(found)) => return Ok(found),
            Ok(Sent::Told(text)) => {
                if let Some(told) = &told {
                    told.call1(py, (text,))?;
                }
            }
            Err(RecvTimeoutError::Timeout) => py.check_signals()?,
            Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err(
                    "an internal error of sigmastar: nothing is claimed; please report it",
                ));
            }
        }
    }
}
