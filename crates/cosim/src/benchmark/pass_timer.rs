// SPDX-License-Identifier: MIT OR Apache-2.0
//! The timing of repeated passes.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use foveate_tools::ToolError;

use crate::error::CosimError;

/// The shortest time of a measurement, and the flag that stops it.
#[derive(Clone, Copy, Debug)]
pub(super) struct PassTimer<'a> {
    pub(super) min_time: Duration,
    pub(super) cancel: &'a AtomicBool,
}

/// The number of passes, and their time in seconds.
#[derive(Clone, Copy, Debug)]
pub(super) struct PassTimes {
    pub(super) passes: u64,
    pub(super) seconds: f64,
}

impl PassTimer<'_> {
    /// Times whole passes, at least one.
    pub(super) fn time_passes(
        self,
        mut pass: impl FnMut() -> Result<(), CosimError>,
    ) -> Result<PassTimes, CosimError> {
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
    pub(super) fn check_cancelled(self) -> Result<(), CosimError> {
        if self.cancel.load(Ordering::Relaxed) {
            return Err(ToolError::Interrupted.into());
        }
        Ok(())
    }
}
