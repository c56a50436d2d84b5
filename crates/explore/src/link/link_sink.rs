// SPDX-License-Identifier: MIT OR Apache-2.0
//! The link as the sink of a raster core, without a buffer between them.

use foveate_timed::SinkPattern;

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
