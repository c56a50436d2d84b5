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
