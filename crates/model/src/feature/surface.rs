// SPDX-License-Identifier: MIT OR Apache-2.0
//! The feature `surface`: the smallest sum of differences between the region and itself, moved by
//! one pixel in four directions.

use crate::region_view::RegionView;
use crate::window::{CENTER, PixelWindow};

/// The places in a window of the pixels at the displacements (1, 0), (0, 1), (1, 1) and (-1, 1):
/// right, below, below to the right, below to the left.
const DISPLACED: [usize; 4] = [5, 7, 8, 6];

/// The sum of differences for each of the four displacements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DisplacementSums([u64; DISPLACED.len()]);

impl DisplacementSums {
    /// Returns the sums of these windows and one more.
    #[must_use]
    pub fn with(self, window: &PixelWindow) -> Self {
        let Self(mut sums) = self;
        for (sum, place) in sums.iter_mut().zip(DISPLACED) {
            *sum += u64::from(window[CENTER].abs_diff(window[place]));
        }
        Self(sums)
    }

    /// Returns the sums in the order of the contract.
    #[must_use]
    pub fn sums(self) -> [u64; DISPLACED.len()] {
        self.0
    }

    /// Returns the score, which is the smallest sum.
    #[must_use]
    pub fn score(self) -> u64 {
        let [right, below, below_right, below_left] = self.0;
        right.min(below).min(below_right).min(below_left)
    }
}

/// Returns the sums of all windows of a region.
#[must_use]
pub fn displacement_sums(region: &impl RegionView) -> DisplacementSums {
    region.windows().fold(DisplacementSums::default(), |seen, window| seen.with(&window))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_displacement_has_its_own_sum_and_the_smallest_counts() {
        let window = [99, 99, 99, 99, 10, 13, 5, 30, 11];
        let one = DisplacementSums::default().with(&window);
        assert_eq!((one.sums(), one.score()), ([3, 20, 1, 5], 1));
        let two = one.with(&[0, 0, 0, 0, 0, 0, 0, 0, u16::MAX]);
        assert_eq!((two.sums(), two.score()), ([3, 20, 65536, 5], 3));
        assert_eq!(DisplacementSums::default().with(&[7; 9]).score(), 0);
    }
}
