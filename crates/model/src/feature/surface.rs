// SPDX-License-Identifier: MIT OR Apache-2.0
//! The feature `surface`: the smallest of four sums, each of the differences between the region and
//! a copy of itself that is moved by one pixel in one of four directions.

use serde::Serialize;

use crate::region::RegionView;
use crate::window::{CENTER, PixelWindow};

/// The differences between the center of a window and its neighbors at the displacements (1, 0),
/// (0, 1), (1, 1) and (-1, 1): right, below, below to the right, below to the left.
pub type WindowDifferences = [u16; 4];

/// The sums over the differences between each pixel and one of its neighbors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct DisplacementSums {
    /// The sum for the neighbors to the right.
    pub right: u64,
    /// The sum for the neighbors below.
    pub below: u64,
    /// The sum for the neighbors below to the right.
    pub below_right: u64,
    /// The sum for the neighbors below to the left.
    pub below_left: u64,
}

impl DisplacementSums {
    /// Returns the sums of these differences and those of one more window.
    #[must_use]
    pub fn with(self, differences: WindowDifferences) -> Self {
        let [right, below, below_right, below_left] = differences.map(u64::from);
        Self {
            right: self.right + right,
            below: self.below + below,
            below_right: self.below_right + below_right,
            below_left: self.below_left + below_left,
        }
    }

    /// Returns the score, which is the smallest sum.
    #[must_use]
    pub fn score(self) -> u64 {
        self.right.min(self.below).min(self.below_right).min(self.below_left)
    }
}

/// Returns the differences of a window.
#[must_use]
pub fn window_differences(window: &PixelWindow) -> WindowDifferences {
    [5, 7, 8, 6].map(|place: usize| window[CENTER].abs_diff(window[place]))
}

/// Returns the sums of all windows of a region.
#[must_use]
pub fn displacement_sums(region: &impl RegionView) -> DisplacementSums {
    let differences = region.windows().map(|window| window_differences(&window));
    differences.fold(DisplacementSums::default(), DisplacementSums::with)
}
