// SPDX-License-Identifier: MIT OR Apache-2.0
//! Converts the times of frames from ticks, which may be wrong, to microseconds since the first
//! frame.

use crate::FrameInfo;

/// The longest time from one frame to the next, in seconds. A longer step is treated as damage.
pub const LONGEST_GAP_SECONDS: u64 = 86_400;

const MICROSECONDS: u128 = 1_000_000;

/// Computes the times of a stream, which never go back. A frame with an impossible time gets the
/// time of the frame before it, and later times are counted from there. The same holds for the
/// first frame after a camera has restarted its count.
#[derive(Clone, Debug, Default)]
pub struct FrameClock {
    last: Option<TimeReference>,
}

/// The time of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameTime {
    /// The time since the first frame, in microseconds.
    pub time_us: u64,
    /// True if the time in the FRAME is impossible.
    pub is_impossible: bool,
}

#[derive(Clone, Copy, Debug)]
struct TimeReference {
    /// The ticks and the microseconds from which times are counted.
    start: (u64, u64),
    /// The ticks of the previous frame.
    ticks: u64,
    time_us: u64,
}

impl FrameClock {
    /// Returns the time of the next frame.
    pub fn next_time(&mut self, info: &FrameInfo) -> FrameTime {
        let per_second = u64::from(info.ticks_per_second.max(1));
        let ticks = info.time;
        let last = self.last.unwrap_or(TimeReference { start: (ticks, 0), ticks, time_us: 0 });
        let step = ticks.checked_sub(last.ticks);
        let is_possible = step.is_some_and(|step| step / per_second < LONGEST_GAP_SECONDS);
        let start = if is_possible { last.start } else { (ticks, last.time_us) };
        let elapsed =
            u128::from(ticks.saturating_sub(start.0)) * MICROSECONDS / u128::from(per_second);
        let elapsed = u64::try_from(elapsed).unwrap_or(u64::MAX);
        let time_us = start.1.saturating_add(elapsed);
        self.last = Some(TimeReference { start, ticks, time_us });
        FrameTime { time_us, is_impossible: !is_possible && !info.first }
    }
}
