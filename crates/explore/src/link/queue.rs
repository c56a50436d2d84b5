// SPDX-License-Identifier: MIT OR Apache-2.0
//! A link with one rate, in integers of bits and nanoseconds ([`send_over_link`]). In front of
//! it is a buffer that loses nothing: bits leave in the order in which they came, one after the
//! other. Framing and the length of the link take no time. Without the buffer, the link is the
//! sink of a raster core ([`link_sink`]).
//!
//! Bits come at times that follow from the sensor, which reads the rows of a frame one after
//! the other, evenly over the time until the next frame begins ([`Timeline`]). The variation of
//! their rate is seen in windows of one length, one after the other from the first frame on
//! ([`WindowRates`]).

use crate::link::{LinkError, LinkUnit};
use foveate_timed::SinkPattern;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The number of nanoseconds of a second.
const NS_PER_SECOND: u128 = 1_000_000_000;

/// The result of sending some units over a link.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct QueueResult {
    /// The time at which the last bit of every unit has left, in ns, rounded up; in the order of
    /// the units.
    pub finished_ns: Vec<u64>,
    /// The most bits that wait or are on the link at a time, rounded up.
    pub backlog_bits: u64,
}

/// Sends units over a link of `rate` bits per second.
///
/// # Panics
/// Panics if the units are not sorted by the time at which they are sent, or if the rate is 0.
#[must_use]
pub fn send_over_link(units: &[LinkUnit], rate: u64) -> QueueResult {
    assert!(units.is_sorted_by_key(|unit| unit.sent_ns), "a queue is served in the order of time");
    assert!(rate > 0, "a link has a rate");
    // In steps of a nanosecond divided by the rate, a bit takes a whole number of steps.
    let (mut free, mut backlog) = (0, 0);
    let finished = units.iter().map(|unit| {
        let sent = u128::from(unit.sent_ns) * u128::from(rate);
        free = free.max(sent) + u128::from(unit.bits) * NS_PER_SECOND;
        backlog = backlog.max(free - sent);
        narrow(free.div_ceil(u128::from(rate)))
    });
    let finished = finished.collect();
    QueueResult { finished_ns: finished, backlog_bits: narrow(backlog.div_ceil(NS_PER_SECOND)) }
}

fn narrow(value: u128) -> u64 {
    u64::try_from(value).unwrap_or(u64::MAX)
}

/// Returns a sink that takes words of `word_bits` bits at the rate of the link, in a core with a
/// clock of `clock_hz`. A rate that does not fit the sink is rounded down, but is never 0.
pub(crate) fn link_sink(link_bits_per_second: u64, word_bits: u32, clock_hz: u64) -> SinkPattern {
    let words = u128::from(link_bits_per_second);
    let clocks = u128::from(word_bits) * u128::from(clock_hz);
    if words >= clocks {
        return SinkPattern::Always;
    }
    let divisor = greatest_common_divisor(words, clocks);
    let (words, clocks) = (words / divisor, clocks / divisor);
    let most = u128::from(u32::MAX);
    let (words, clocks) = match clocks <= most {
        true => (words, clocks),
        false => ((words * most / clocks).max(1), most),
    };
    let narrow = |value| u32::try_from(value).expect("both numbers are limited");
    SinkPattern::Rate { words: narrow(words), clocks: narrow(clocks) }
}

fn greatest_common_divisor(one: u128, other: u128) -> u128 {
    match other {
        0 => one,
        _ => greatest_common_divisor(other, one % other),
    }
}

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

/// The rates in windows of one length, in bytes per second, rounded to the nearest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WindowRates {
    /// The length of a window in ms.
    pub window_ms: u64,
    /// The rate that 99 of 100 windows do not exceed (nearest rank).
    pub p99: u64,
    /// The highest rate.
    pub peak: u64,
}

impl WindowRates {
    /// Computes the rates between `start` and `end`, in ns, and after `end` as long as bits are
    /// sent. The last window counts as a whole window.
    #[must_use]
    pub fn from_units(units: &[LinkUnit], (start, end): (u64, u64), window_ms: u64) -> Self {
        let length = window_ms * 1_000_000;
        // Only windows with bits are stored, because a clip may last for days.
        let mut windows: BTreeMap<u64, u64> = BTreeMap::new();
        for unit in units {
            *windows.entry(unit.sent_ns.saturating_sub(start) / length).or_default() += unit.bits;
        }
        let during = end.saturating_sub(start).div_ceil(length);
        let count = windows.last_key_value().map_or(0, |(last, _)| last + 1).max(during);
        let empty = count - windows.len() as u64;
        let mut bits: Vec<u64> = windows.into_values().collect();
        bits.sort_unstable();
        let rate = |percent: u64| {
            let rank = (count * percent).div_ceil(100);
            let bits = rank.checked_sub(empty + 1).map_or(0, |at| {
                bits[usize::try_from(at).expect("there are as many windows in memory")]
            });
            (bits * 125 + window_ms / 2) / window_ms
        };
        Self { window_ms, p99: rate(99), peak: rate(100) }
    }
}

/// Returns the smallest of some sorted values that at least `percent` % of them do not exceed; 0
/// without values.
pub(crate) fn nearest_rank(sorted: &[u64], percent: usize) -> u64 {
    let rank = (sorted.len() * percent).div_ceil(100);
    rank.checked_sub(1).map_or(0, |at| sorted[at])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rate(words: u32, clocks: u32) -> SinkPattern {
        SinkPattern::Rate { words, clocks }
    }

    #[test]
    fn a_sink_takes_the_words_that_fit_the_link() {
        // Words of 8 bits at 68 MHz are 544 Mbit/s.
        assert_eq!(link_sink(100_000_000, 8, 68_000_000), rate(25, 136));
        assert_eq!(link_sink(543_999_999, 8, 68_000_000), rate(543_999_999, 544_000_000));
        assert_eq!(link_sink(544_000_000, 8, 68_000_000), SinkPattern::Always);
        assert_eq!(link_sink(1_000_000_000_000, 32, 1), SinkPattern::Always);
    }

    #[test]
    fn a_rate_of_large_numbers_is_rounded_down_and_is_never_0() {
        // The numbers have no common divisor. Their quotient times the largest number of clocks is
        // 3,221,225,470.58.
        assert_eq!(link_sink(6_000_000_001, 1, 8_000_000_003), rate(3_221_225_470, u32::MAX));
        assert_eq!(link_sink(1, 32, 10_000_000_000), rate(1, u32::MAX));
    }
}
