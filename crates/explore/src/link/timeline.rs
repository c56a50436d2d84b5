// SPDX-License-Identifier: MIT OR Apache-2.0
//! The times at which the sensor reads pixels: it reads the rows of a frame one after the other,
//! evenly over the time until the next frame begins.

use crate::link::LinkError;

/// The number of nanoseconds of a microsecond.
const NS_PER_US: u64 = 1000;

/// The number of microseconds of a second.
const US_PER_S: u128 = 1_000_000;

/// The longest clip in ns, half of what 64 bits hold: what waits for the link at the end of a clip
/// is sent after it.
const MAX_NS: u64 = u64::MAX / 2;

/// The times of a clip in ns. After the last frame the sensor goes on at the mean interval.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Timeline {
    starts: Vec<u64>,
    end: u64,
    rows: u64,
}

impl Timeline {
    /// Creates the timeline of frames with `rows` rows that begin at the times `times_us`, in
    /// microseconds.
    ///
    /// # Errors
    /// Fails if there are fewer than two frames, if a frame does not begin after the one before, or
    /// if the clip lasts more than 2^63 - 1 ns.
    pub fn new(clip: &str, times_us: &[u64], rows: u32) -> Result<Self, LinkError> {
        let (&[first, ..], &[.., last]) = (times_us, times_us) else {
            return Err(LinkError::TooFewFrames { clip: clip.to_owned(), frames: 0 });
        };
        let frames = times_us.len() as u64;
        if frames < 2 {
            return Err(LinkError::TooFewFrames { clip: clip.to_owned(), frames });
        }
        if let Some(frame) = times_us.windows(2).position(|pair| pair[1] <= pair[0]) {
            let time_us = times_us[frame + 1];
            return Err(LinkError::TimesNotRising {
                clip: clip.to_owned(),
                frame: frame + 1,
                time_us,
            });
        }
        // The last frame lasts as long as the others on average.
        let (span, intervals) = (u128::from(last - first), u128::from(frames - 1));
        let duration = (span * (intervals + 1) + intervals / 2) / intervals;
        let end = u64::try_from(duration * u128::from(NS_PER_US)).ok().filter(|&end| end <= MAX_NS);
        let end = end.ok_or_else(|| LinkError::TooLong {
            clip: clip.to_owned(),
            seconds: u64::try_from(duration / US_PER_S).unwrap_or(u64::MAX),
        })?;
        let starts = times_us.iter().map(|time| (time - first) * NS_PER_US).collect();
        Ok(Self { starts, end, rows: rows.into() })
    }

    /// Returns the number of frames of the clip.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.starts.len() as u64
    }

    /// Returns the end of the clip in ns, which is its duration.
    #[must_use]
    pub fn end_ns(&self) -> u64 {
        self.end
    }

    /// Returns the time in ns at which a frame begins, which is when the frame before it has been
    /// read.
    #[must_use]
    pub fn start_ns(&self, frame: u64) -> u64 {
        match self.starts.get(usize::try_from(frame).unwrap_or(usize::MAX)) {
            Some(&start) => start,
            None => self.end.saturating_add(scaled(self.end, frame - self.frames(), self.frames())),
        }
    }

    /// Returns the time in ns at which a row of a frame has been read.
    #[must_use]
    pub fn row_read_ns(&self, frame: u64, row: u32) -> u64 {
        let (start, next) = (self.start_ns(frame), self.start_ns(frame + 1));
        start + scaled(next - start, u64::from(row) + 1, self.rows)
    }

    /// Returns the shortest time between two frames in ns.
    #[must_use]
    pub fn shortest_interval_ns(&self) -> u64 {
        let intervals =
            (0..self.frames()).map(|frame| self.start_ns(frame + 1) - self.start_ns(frame));
        intervals.min().expect("there are two frames")
    }
}

/// Returns `value * part / whole`, rounded down.
fn scaled(value: u64, part: u64, whole: u64) -> u64 {
    let scaled = u128::from(value) * u128::from(part) / u128::from(whole.max(1));
    u64::try_from(scaled).unwrap_or(u64::MAX)
}
