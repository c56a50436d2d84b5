// SPDX-License-Identifier: MIT OR Apache-2.0
//! The time and the memory of a level that runs in this process.
//!
//! A level runs again and again until the time is long enough ([`PassTimer`]). Its memory is
//! the amount by which the largest resident size of the process exceeds the size before the
//! level is made ([`InitialResidentSize`]); Linux records the largest size and can reset it.
//! Memory that was freed before and is used again is not counted, so the figure is a lower
//! bound.

use crate::error::CosimError;
use foveate_tools::ToolError;
use std::fs;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

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

/// The resident size of this process before a level is made, in kilobytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct InitialResidentSize(Option<u64>);

impl InitialResidentSize {
    pub(super) fn measure() -> Self {
        // A system that cannot reset the peak gives no figure.
        let is_forgotten = fs::write("/proc/self/clear_refs", "5").is_ok();
        Self(if is_forgotten { status_kilobytes("VmRSS:") } else { None })
    }

    /// Returns the largest number of bytes that were taken since then.
    pub(super) fn peak_bytes(self) -> Option<u64> {
        let before = self.0?;
        Some(status_kilobytes("VmHWM:")?.saturating_sub(before).saturating_mul(1024))
    }
}

fn status_kilobytes(name: &str) -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(name))?;
    line.split_whitespace().next()?.parse().ok()
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn what_is_touched_is_seen() {
        let before = InitialResidentSize::measure();
        let touched = vec![1u8; 64 << 20];
        assert_eq!(touched.iter().map(|&byte| usize::from(byte)).sum::<usize>(), 64 << 20);
        let Some(peak) = before.peak_bytes() else { return };
        assert!(peak >= 60 << 20, "{peak}");
    }
}
