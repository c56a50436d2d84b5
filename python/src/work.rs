// SPDX-License-Identifier: MIT OR Apache-2.0
//! Long computations, which Ctrl-C interrupts.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use foveate_media::{RunHooks, RunProgress};
use pyo3::prelude::*;

/// The interval at which Python is asked for signals.
const PATIENCE: Duration = Duration::from_millis(20);
/// The time for which work that was told to stop is waited for.
const GRACE: Duration = Duration::from_millis(200);

/// Stops a run when the flag is set.
pub(crate) struct CancelFlag(pub(crate) Arc<AtomicBool>);

impl RunHooks for CancelFlag {
    fn progress(&self, _progress: &RunProgress<'_>) {}

    fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Runs `work` without side effects on a thread of its own, without holding the interpreter. If a signal raises an
/// exception, returns it at once; the result of the unfinished work is dropped.
pub(crate) fn at_once<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    at_once_with(py, move |_| work())
}

/// Runs `work` as above, and sets a flag at a signal, for work that should end, such as a tool.
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

/// Runs `work` on a thread of its own, without holding the interpreter. If a signal raises an exception, sets the flag,
/// waits for the end of the work, and returns the exception.
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

/// Waits for the end of the work, or, with a limit, for that time after a signal. Returns the exception of the signal.
fn wait(
    py: Python<'_>,
    is_finished: impl Fn() -> bool,
    cancel: &AtomicBool,
    limit: Option<Duration>,
) -> Option<PyErr> {
    let mut raised: Option<(PyErr, Instant)> = None;
    // Most work is short. It is not waited for if it ends at once.
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
