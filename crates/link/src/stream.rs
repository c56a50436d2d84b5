// SPDX-License-Identifier: MIT OR Apache-2.0
//! An array that takes pixels as the sensor reads them, on the timeline of a clip.
//!
//! [`RasterStreamTiming`] counts in ticks. Here a tick is a nanosecond divided by the clock in Hz,
//! so that nanoseconds and clocks are whole numbers of ticks. Without a clock the array takes no
//! time, and a tick is a nanosecond.

use foveate_design::{RasterStreamTiming, RasterTiming, RegionAction, RowDeparture};

use crate::Timeline;

/// The number of nanoseconds of a second, which is also the number of ticks of a clock.
const NS_PER_SECOND: u128 = 1_000_000_000;

/// The array behind the sensor, frame after frame.
pub(crate) struct RasterArrayStream<'a> {
    timeline: &'a Timeline,
    stream: RasterStreamTiming,
    /// The number of ticks of a nanosecond.
    ticks_per_ns: u128,
    frame: u64,
}

/// The times at which the bits of a row of regions leave, in ns, rounded up.
pub(crate) struct RowDepartureTimes {
    pub(crate) decided: u64,
    /// The time at which the pixels leave; `None` without pixels.
    pub(crate) sent: Option<u64>,
}

impl<'a> RasterArrayStream<'a> {
    pub(crate) fn new(timing: RasterTiming, timeline: &'a Timeline, clock_hz: Option<u64>) -> Self {
        let (of_nano, clock) = clock_hz.map_or((1, 0), |hertz| (hertz.into(), NS_PER_SECOND));
        Self {
            timeline,
            stream: RasterStreamTiming::new(timing, clock),
            ticks_per_ns: of_nano,
            frame: 0,
        }
    }

    /// Returns the times of the next frame, one entry per row of regions.
    pub(crate) fn next_frame(&mut self, actions: &[RegionAction]) -> Vec<RowDepartureTimes> {
        let (timeline, frame, of_nano) = (self.timeline, self.frame, self.ticks_per_ns);
        self.frame += 1;
        let read = |row: u32| {
            let begin = match row {
                0 => timeline.start_ns(frame),
                row => timeline.row_read_ns(frame, row - 1),
            };
            let ticks = |nanos: u64| u128::from(nanos) * of_nano;
            (ticks(begin), ticks(timeline.row_read_ns(frame, row)))
        };
        let nanos = |ticks: u128| u64::try_from(ticks.div_ceil(of_nano)).unwrap_or(u64::MAX);
        let rows = self.stream.advance_frame(read, actions).into_iter();
        rows.map(|row| RowDepartureTimes {
            decided: nanos(row.last_decision),
            sent: row.last_word.map(nanos),
        })
        .collect()
    }
}

/// Returns the most clocks that the array adds to a time, at any clock that keeps up. They are
/// needed at the slowest such clock, if frames follow each other at the shortest interval and all
/// regions of all frames are active.
pub(crate) fn most_added_clocks(timing: RasterTiming, regions: u32) -> u64 {
    // Words come evenly over a frame. A clock has many ticks, so that little is lost when their
    // times are rounded.
    const CLOCK: u128 = 1 << 20;
    // The rest of a frame delays the second frame, and the second frame leaves the same rest as the
    // first one.
    const FRAMES: u128 = 3;
    let interval = u128::from(timing.max_clocks_per_frame()) * CLOCK;
    let active = vec![RegionAction::Forward; regions as usize];
    let (mut with, mut without) =
        (RasterStreamTiming::new(timing, CLOCK), RasterStreamTiming::new(timing, 0));
    let mut most = 0;
    for frame in 0..FRAMES {
        let at = |row: u32| {
            frame * interval + interval * u128::from(row) / u128::from(timing.taken_rows)
        };
        let read = |row: u32| (at(row), at(row + 1));
        let rows =
            with.advance_frame(read, &active).into_iter().zip(without.advance_frame(read, &active));
        for (with, without) in rows {
            let of = |row: RowDeparture| row.last_word.unwrap_or(row.last_decision);
            most = most.max(of(with) - of(without));
        }
    }
    u64::try_from(most.div_ceil(CLOCK)).unwrap_or(u64::MAX)
}
