// SPDX-License-Identifier: MIT OR Apache-2.0
//! Hooks for tests of runs.

use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::playback::{RunHooks, RunProgress};

/// Hooks that record the reports, and cancel after some of them.
#[derive(Debug)]
pub struct RecordingHooks {
    reports: Mutex<Vec<RunProgress<'static>>>,
    most: usize,
}

impl RecordingHooks {
    /// Makes hooks that never cancel.
    #[must_use]
    pub fn new() -> Self {
        Self::cancelling_after(usize::MAX)
    }

    /// Makes hooks that cancel once there are `most` reports.
    #[must_use]
    pub fn cancelling_after(most: usize) -> Self {
        Self { reports: Mutex::default(), most }
    }

    /// Returns the reports so far.
    pub fn reports(&self) -> MutexGuard<'_, Vec<RunProgress<'static>>> {
        self.reports.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Default for RecordingHooks {
    fn default() -> Self {
        Self::new()
    }
}

impl RunHooks for RecordingHooks {
    fn progress(&self, progress: &RunProgress<'_>) {
        let label = progress.label.to_string().into();
        self.reports().push(RunProgress { label, ..*progress });
    }

    fn is_cancelled(&self) -> bool {
        self.reports().len() >= self.most
    }
}
