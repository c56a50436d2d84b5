// SPDX-License-Identifier: MIT OR Apache-2.0
//! Long work, which Ctrl-C ends.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;

/// How often Python is asked whether a signal has come.
const PATIENCE: Duration = Duration::from_millis(20);

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
        let mut raised = None;
        // Mostly short: what is done at once is not waited for.
        let mut pause = Duration::from_micros(100);
        while !worker.is_finished() {
            py.detach(|| thread::sleep(pause));
            pause = (2 * pause).min(PATIENCE);
            if raised.is_none() {
                raised = py.check_signals().err();
                cancel.store(raised.is_some(), Ordering::Relaxed);
            }
        }
        let done = worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        raised.map_or(Ok(done), Err)
    })
}
