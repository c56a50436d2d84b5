// SPDX-License-Identifier: MIT OR Apache-2.0
//! The timing of repeated passes.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crate::error::BenchError;

/// The shortest time of a measurement, and the flag that stops it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Timer<'a> {
    pub(crate) at_least: Duration,
    pub(crate) cancel: &'a AtomicBool,
}

/// The number of passes, and their time in seconds.
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

    /// Fails if the user has stopped the benchmark.
    pub(crate) fn check(self) -> Result<(), BenchError> {
        if self.cancel.load(Ordering::Relaxed) { Err(BenchError::Interrupted) } else { Ok(()) }
    }
}
