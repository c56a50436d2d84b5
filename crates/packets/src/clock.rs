// SPDX-License-Identifier: MIT OR Apache-2.0
//! Times of frames in microseconds since the first one, from times in ticks that may be wrong.

use crate::FrameInfo;

/// Longest time from one frame to the next, in seconds. A time further away is taken for damage.
pub const LONGEST_GAP_SECONDS: u64 = 86_400;
const MICROSECONDS: u128 = 1_000_000;

/// The times of a stream, which never go back. A frame whose time cannot be right has that of the frame before it, and times go on
/// from there; so have the first frames of cameras that count anew.
#[derive(Clone, Debug, Default)]
pub struct FrameClock {
    last: Option<ClockReference>,
}

/// The time of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameTime {
    /// Microseconds since the first frame.
    pub time_us: u64,
    /// Whether what the frame says cannot be right.
    pub is_wrong: bool,
}

#[derive(Clone, Copy, Debug)]
struct ClockReference {
    /// Ticks and microseconds from which times are counted.
    start: (u64, u64),
    /// The frame before.
    ticks: u64,
    time_us: u64,
}

impl FrameClock {
    /// The time of the next frame.
    pub fn take(&mut self, info: &FrameInfo) -> FrameTime {
        let per_second = u64::from(info.ticks_per_second.max(1));
        let ticks = info.time;
        let last = self.last.unwrap_or(ClockReference { start: (ticks, 0), ticks, time_us: 0 });
        let step = ticks.checked_sub(last.ticks);
        let is_right = step.is_some_and(|step| step / per_second < LONGEST_GAP_SECONDS);
        let start = if is_right { last.start } else { (ticks, last.time_us) };
        let since =
            u128::from(ticks.saturating_sub(start.0)) * MICROSECONDS / u128::from(per_second);
        let since = u64::try_from(since).unwrap_or(u64::MAX);
        let time_us = start.1.saturating_add(since);
        self.last = Some(ClockReference { start, ticks, time_us });
        FrameTime { time_us, is_wrong: !is_right && !info.first }
    }
}
