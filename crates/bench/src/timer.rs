// SPDX-License-Identifier: MIT OR Apache-2.0
//! The timing of repeated passes.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crate::error::BenchmarkError;

/// The shortest time of a measurement, and the flag that stops it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PassTimer<'a> {
    pub(crate) min_time: Duration,
    pub(crate) cancel: &'a AtomicBool,
}

/// The number of passes, and their time in seconds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PassTimes {
    pub(crate) passes: u64,
    pub(crate) seconds: f64,
}

impl PassTimer<'_> {
    /// Times whole passes, at least one.
    pub(crate) fn time_passes(
        self,
        mut pass: impl FnMut() -> Result<(), BenchmarkError>,
    ) -> Result<PassTimes, BenchmarkError> {
        let start = Instant::now();
        let mut passes = 0;
        loop {
            pass()?;
            passes += 1;
            let elapsed = start.elapsed();
            self.check_cancelled()?;
            if elapsed >= self.min_time {
                return Ok(PassTimes { passes, seconds: elapsed.as_secs_f64() });
            }
        }
    }

    /// Fails if the user has stopped the benchmark.
    pub(crate) fn check_cancelled(self) -> Result<(), BenchmarkError> {
        if self.cancel.load(Ordering::Relaxed) { Err(BenchmarkError::Interrupted) } else { Ok(()) }
    }
}
