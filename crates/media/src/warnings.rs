// SPDX-License-Identifier: MIT OR Apache-2.0
//! Warnings about inputs that are found only while their frames are read.

use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// Warnings for the user. Clones share them.
#[derive(Clone, Debug, Default)]
pub struct InputWarnings(Arc<Mutex<Vec<String>>>);

impl InputWarnings {
    /// Returns the warnings of this process, for a program that prints them at the end of its work.
    #[must_use]
    pub fn of_process() -> Self {
        static WARNINGS: LazyLock<InputWarnings> = LazyLock::new(InputWarnings::default);
        WARNINGS.clone()
    }

    /// Adds a warning, unless it is there already: an input may be opened several times.
    pub fn add(&self, warning: String) {
        let mut warnings = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !warnings.contains(&warning) {
            warnings.push(warning);
        }
    }

    /// Removes and returns all warnings so far.
    #[must_use]
    pub fn take(&self) -> Vec<String> {
        std::mem::take(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}
