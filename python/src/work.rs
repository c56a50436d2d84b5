// SPDX-License-Identifier: MIT OR Apache-2.0
//! Long work, which Ctrl-C ends.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use pyo3::prelude::*;

/// How often Python is asked whether a signal has come.
const PATIENCE: Duration = Duration::from_millis(20);
/// How long work that was told to stop is waited for.
const GRACE: Duration = Duration::from_millis(200);

/// Does `work` that leaves nothing behind on a thread of its own, without the interpreter. When a signal raises an
/// exception, that is what is left, at once; what is still computed is for nobody.
pub(crate) fn at_once<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    at_once_with(py, move |_| work())
}

/// The same with a flag that is set then, for what should end, such as a tool.
pub(crate) fn at_once_with<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(Arc<AtomicBool>) -> T + Send + 'static,
) -> PyResult<T> {
    let cancel = Arc::<AtomicBool>::default();
    let own = Arc::clone(&cancel);
    let worker = thread::spawn(move || work(own));
    let raised = wait(py, || worker.is_finished(), &cancel, Some(GRACE));
    match raised {
        Some(raised) => Err(raised),
        None => Ok(worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))),
    }
}

/// Does `work` on a thread of its own, without the interpreter. When a signal raises an exception, the flag is
/// set, the work comes to its end, and the exception is what is left.
pub(crate) fn interruptible<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(Arc<AtomicBool>) -> T + Send,
) -> PyResult<T> {
    let cancel = Arc::<AtomicBool>::default();
    thread::scope(|scope| {
        let own = Arc::clone(&cancel);
        let worker = scope.spawn(move || work(own));
        let raised = wait(py, || worker.is_finished(), &cancel, None);
        let done = worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        raised.map_or(Ok(done), Err)
    })
}

/// Waits until it is finished, or, with a limit, so long after a signal has raised an exception. Returns the exception.
fn wait(
    py: Python<'_>,
    is_finished: impl Fn() -> bool,
    cancel: &AtomicBool,
    limit: Option<Duration>,
) -> Option<PyErr> {
    let mut raised: Option<(PyErr, Instant)> = None;
    // Mostly short: what is done at once is not waited for.
    let mut pause = Duration::from_micros(100);
    let is_over =
        |(_, since): &(PyErr, Instant)| limit.is_some_and(|limit| since.elapsed() > limit);
    while !is_finished() && !raised.as_ref().is_some_and(is_over) {
        py.detach(|| thread::sleep(pause));
        pause = (2 * pause).min(PATIENCE);
        if raised.is_none() {
            raised = py.check_signals().err().map(|raised| (raised, Instant::now()));
            cancel.store(raised.is_some(), Ordering::Relaxed);
        }
    }
    raised.map(|(raised, _)| raised)
}
