// SPDX-License-Identifier: MIT OR Apache-2.0
//! An array that takes pixels as the sensor reads them, on the timeline of a clip.
//!
//! [`RasterStream`] counts in ticks. Here a tick is a nanosecond divided by the clock in Hz, so
//! that nanoseconds and clocks are whole numbers of ticks. Without a clock the array takes no time,
//! and a tick is a nanosecond.

use foveate_design::{Action, RasterStream, RasterTiming, RowDeparture};

use crate::Timeline;

/// The number of nanoseconds of a second, which is also the number of ticks of a clock.
const NANO: u128 = 1_000_000_000;

/// The array behind the sensor, frame after frame.
pub(crate) struct Streamed<'a> {
    timeline: &'a Timeline,
    stream: RasterStream,
    /// The number of ticks of a nanosecond.
    of_nano: u128,
    frame: u64,
}

/// The times at which the bits of a row of regions leave, in ns, rounded up.
pub(crate) struct Leaving {
    pub(crate) decided: u64,
    /// The time at which the pixels leave; `None` without pixels.
    pub(crate) sent: Option<u64>,
}

impl<'a> Streamed<'a> {
    pub(crate) fn new(timing: RasterTiming, timeline: &'a Timeline, clock_hz: Option<u64>) -> Self {
        let (of_nano, clock) = clock_hz.map_or((1, 0), |hertz| (hertz.into(), NANO));
        Self { timeline, stream: RasterStream::new(timing, clock), of_nano, frame: 0 }
    }

    /// Returns the times of the next frame, one entry per row of regions.
    pub(crate) fn next(&mut self, actions: &[Action]) -> Vec<Leaving> {
        let (timeline, frame, of_nano) = (self.timeline, self.frame, self.of_nano);
        self.frame += 1;
        let read = |row: u32| {
            let begin = match row {
                0 => timeline.start(frame),
                row => timeline.row(frame, row - 1),
            };
            let ticks = |nanos: u64| u128::from(nanos) * of_nano;
            (ticks(begin), ticks(timeline.row(frame, row)))
        };
        let nanos = |ticks: u128| u64::try_from(ticks.div_ceil(of_nano)).unwrap_or(u64::MAX);
        let rows = self.stream.frame(read, actions).into_iter();
        rows.map(|row| Leaving { decided: nanos(row.decided), sent: row.left.map(nanos) }).collect()
    }
}

/// Returns the most clocks that the array adds to a time, at any clock that keeps up. They are
/// needed at the slowest such clock, if frames follow each other at the shortest interval and all
/// regions of all frames are active.
pub(crate) fn own_clocks(timing: RasterTiming, regions: u32) -> u64 {
    // Words come evenly over a frame. A clock has many ticks, so that little is lost when their
    // times are rounded.
    const CLOCK: u128 = 1 << 20;
    // The rest of a frame delays the second frame, and the second frame leaves the same rest as the
    // first one.
    const FRAMES: u128 = 3;
    let interval = u128::from(timing.most_clocks_per_frame()) * CLOCK;
    let active = vec![Action::Forward; regions as usize];
    let (mut with, mut without) = (RasterStream::new(timing, CLOCK), RasterStream::new(timing, 0));
    let mut most = 0;
    for frame in 0..FRAMES {
        let at = |row: u32| {
            frame * interval + interval * u128::from(row) / u128::from(timing.taken_rows)
        };
        let read = |row: u32| (at(row), at(row + 1));
        let rows = with.frame(read, &active).into_iter().zip(without.frame(read, &active));
        for (with, without) in rows {
            let of = |row: RowDeparture| row.left.unwrap_or(row.decided);
            most = most.max(of(with) - of(without));
        }
    }
    u64::try_from(most.div_ceil(CLOCK)).unwrap_or(u64::MAX)
}
