// SPDX-License-Identifier: MIT OR Apache-2.0
//! The serial organization: the numbers behind `docs/serial.md`.
//!
//! K regions share a lane, and L lanes work in step.

mod block_mean;
mod folds;
mod hardware;
mod memory;
mod ports;
mod rules;
mod timing;

pub use block_mean::BlockMeanDivision;
pub use hardware::SerialHardware;
pub use memory::{LaneMemory, LaneWidths, MemoryChoice, SlotArea, SlotAreaKind};
pub use timing::{SerialPhase, SerialTiming};

use crate::{Design, PixelFeed, SerialDesign};
use foveate_camera::index_bits;

/// Returns the bits of a port or register that holds a number in `0..n`. They are at least 1.
fn number_bits(n: u32) -> u32 {
    index_bits(n.into()).max(1)
}

impl Design {
    /// Returns the bits of the number of a region, 0..M. They are at least 1.
    #[must_use]
    pub fn region_bits(&self) -> u32 {
        number_bits(self.regions())
    }
}

impl SerialDesign<'_> {
    /// Returns the number of regions per lane, K.
    #[must_use]
    pub fn fold(&self) -> u32 {
        self.own_hardware().fold
    }

    /// Returns the order in which pixels enter.
    #[must_use]
    pub fn feed(&self) -> PixelFeed {
        self.own_hardware().feed
    }

    /// Returns the number of lanes, L = ceil(M / K).
    #[must_use]
    pub fn lanes(&self) -> u32 {
        self.regions().div_ceil(self.fold())
    }

    /// Returns the region that `lane` (0..L) serves in `slot` (0..K), or `None` if the slot is
    /// empty.
    #[must_use]
    pub fn region_in_slot(&self, lane: u32, slot: u32) -> Option<u32> {
        let region = u64::from(lane) * u64::from(self.fold()) + u64::from(slot);
        u32::try_from(region).ok().filter(|&region| region < self.regions())
    }

    /// Returns the bits of the number of a lane, 0..L. They are at least 1.
    #[must_use]
    pub fn lane_bits(&self) -> u32 {
        number_bits(self.lanes())
    }

    /// Returns the bits of the number of a slot of a lane, 0..K. They are at least 1.
    #[must_use]
    pub fn slot_bits(&self) -> u32 {
        number_bits(self.fold())
    }

    /// Returns the number of scores of a region: the temporal count and those of the features. It
    /// is at least 2.
    #[must_use]
    pub fn score_count(&self) -> u32 {
        self.features().iter().fold(1, |count, _| count + 1)
    }

    /// Returns the bits of the number of a score: 0 for the temporal count, 1.. for the features.
    #[must_use]
    pub fn score_index_bits(&self) -> u32 {
        number_bits(self.score_count())
    }

    /// Returns the bits that hold every score of the design: the temporal count and those of the
    /// features.
    #[must_use]
    pub fn max_score_bits(&self) -> u32 {
        let features = self.features().iter().map(|feature| feature.score_bits());
        features.fold(self.count_bits(), u32::max)
    }

    /// Returns c(x): the number of pairs of a region column and a position in its window that show
    /// column `x` (0..C*N), counting repetitions. A pixel (x, y) of a raster feed is stored at
    /// `column_places(x) * row_places(y)` places.
    #[must_use]
    pub fn column_places(&self, x: u32) -> u32 {
        self.places(x, self.columns())
    }

    /// Returns c(y) for row `y` (0..R*N), the counterpart of [`Self::column_places`].
    #[must_use]
    pub fn row_places(&self, y: u32) -> u32 {
        self.places(y, self.rows())
    }

    /// Counts the positions of windows that show coordinate `at`. Because N >= 2r, a window
    /// overlaps only its neighbors.
    fn places(&self, at: u32, regions: u32) -> u32 {
        let (side, halo) = (self.region_size(), self.halo());
        let (region, position) = (at / side, at % side);
        let before = region > 0 && position < halo;
        let after = region + 1 < regions && position + halo >= side;
        let beyond = u32::from(at == 0) + u32::from(at + 1 == regions * side);
        1 + u32::from(before) + u32::from(after) + halo * beyond
    }

    /// Returns the design of a grid of one lane: K regions in one row of regions, everything else
    /// the same. The array of that grid is the RPU of a serial design. Its frame may be wider than
    /// a configuration allows.
    #[must_use]
    pub fn single_lane_design(&self) -> Design {
        let (width, height) = (self.fold() * self.region_size(), self.region_size());
        let mut config = self.config();
        config.camera.resize_frame(width, height);
        let lane = config.validate_up_to(u32::MAX);
        lane.expect("a valid design stays one with a frame of as many regions as share a lane")
    }
}

#[cfg(test)]
mod tests;
