// SPDX-License-Identifier: MIT OR Apache-2.0
//! Does the same again and again for some time.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crate::error::BenchError;

/// How long, and what stops it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Timer<'a> {
    pub(crate) at_least: Duration,
    pub(crate) cancel: &'a AtomicBool,
}

/// How often something was done, and how long it took altogether.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Time {
    pub(crate) passes: u64,
    pub(crate) seconds: f64,
}

impl Timer<'_> {
    /// Times whole passes, at least one.
    pub(crate) fn time(
        self,
        mut pass: impl FnMut() -> Result<(), BenchError>,
    ) -> Result<Time, BenchError> {
        let start = Instant::now();
        let mut passes = 0;
        loop {
            pass()?;
            passes += 1;
            let elapsed = start.elapsed();
            self.check()?;
            if elapsed >= self.at_least {
                return Ok(Time { passes, seconds: elapsed.as_secs_f64() });
            }
        }
    }

    /// An error once the user has stopped it.
    pub(crate) fn check(self) -> Result<(), BenchError> {
        if self.cancel.load(Ordering::Relaxed) { Err(BenchError::Interrupted) } else { Ok(()) }
    }
}
