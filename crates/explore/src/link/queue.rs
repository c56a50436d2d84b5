// SPDX-License-Identifier: MIT OR Apache-2.0
//! A link with one rate, in integers of bits and nanoseconds ([`send_over_link`]). In front of
//! it is a buffer that loses nothing: bits leave in the order in which they came, one after the
//! other. Framing and the length of the link take no time. Without the buffer, the link is the
//! sink of a raster core ([`link_sink`]).

use crate::link::LinkUnit;
use foveate_timed::SinkPattern;

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
