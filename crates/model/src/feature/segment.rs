// SPDX-License-Identifier: MIT OR Apache-2.0
//! The feature `segment`: the smaller one of the numbers of pixels far above and far below the
//! rounded mean. It is large only if the region has two parts of different brightness.

use std::cmp::Ordering;

use super::mean::region_mean;
use crate::region::RegionView;

/// The numbers of pixels that lie more than a level above, and below, the mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SegmentCounts {
    /// Number of pixels above.
    pub above: u64,
    /// Number of pixels below.
    pub below: u64,
}

impl SegmentCounts {
    /// Returns the counts of these pixels and one more, which lies on the given side of the mean.
    #[must_use]
    pub fn with(self, side: Ordering) -> Self {
        match side {
            Ordering::Greater => Self { above: self.above + 1, ..self },
            Ordering::Less => Self { below: self.below + 1, ..self },
            Ordering::Equal => self,
        }
    }

    /// Returns the score.
    #[must_use]
    pub fn score(self) -> u64 {
        self.above.min(self.below)
    }
}

/// Returns the side of the mean on which a pixel lies: `Greater` if `2^f * x > mean + 2^f * level`,
/// `Less` if `2^f * x < mean - 2^f * level`, `Equal` if it is neither.
#[must_use]
pub fn side_of_mean(pixel: u16, mean: u64, level: u32, fraction_bits: u32) -> Ordering {
    let [pixel, level] = [pixel.into(), u64::from(level)].map(|value| value << fraction_bits);
    if pixel > mean + level {
        Ordering::Greater
    } else if pixel + level < mean {
        Ordering::Less
    } else {
        Ordering::Equal
    }
}

/// Returns the side of the mean of every pixel of a region, in row-major order.
pub fn sides_of_mean(
    region: &impl RegionView,
    level: u32,
    fraction_bits: u32,
) -> impl Iterator<Item = Ordering> {
    let mean = region_mean(region, fraction_bits);
    region.pixels().map(move |pixel| side_of_mean(pixel, mean, level, fraction_bits))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_must_lie_farther_away_than_the_level() {
        let sides = |pixels: [u16; 4], mean, f| pixels.map(|x| side_of_mean(x, mean, 2, f));
        let [less, equal, greater] = [Ordering::Less, Ordering::Equal, Ordering::Greater];
        assert_eq!(sides([7, 8, 12, 13], 10, 0), [less, equal, equal, greater]);
        // The mean is 10.5.
        assert_eq!(sides([8, 9, 12, 13], 21, 1), [less, equal, equal, greater]);
        // The level is larger than the mean.
        assert_eq!(sides([0, 1, 3, 4], 1, 0), [equal, equal, equal, greater]);
        assert_eq!(side_of_mean(u16::MAX, 0, u32::from(u16::MAX), 12), equal);
    }

    #[test]
    fn the_smaller_part_counts() {
        let counts = [Ordering::Greater, Ordering::Less, Ordering::Equal, Ordering::Less];
        let counts = counts.into_iter().fold(SegmentCounts::default(), SegmentCounts::with);
        assert_eq!(counts, SegmentCounts { above: 1, below: 2 });
        assert_eq!(counts.score(), 1);
        assert_eq!(SegmentCounts::default().score(), 0);
    }
}
