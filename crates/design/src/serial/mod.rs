// SPDX-License-Identifier: MIT OR Apache-2.0
//! The serial organization: the numbers behind `docs/serial.md`.
//!
//! K regions share a lane; L lanes work in step.

mod feature;
mod folds;
mod hardware;
mod means;
mod memory;
mod ports;
mod rules;
mod timing;
mod widths;

pub use hardware::Serial;
pub use means::BlockSums;
pub use memory::{Area, AreaKind, LaneMemory, MemoryChoice};
pub use timing::{Phase, SerialTiming};
pub use widths::LaneWidths;

use crate::{Design, Feed, SerialDesign, index_bits};

/// Bits of a port or register that numbers `n` things from 0; at least one.
fn number_bits(n: u32) -> u32 {
    index_bits(n.into()).max(1)
}

impl Design {
    /// Bits of the number of a region, 0..M; at least one.
    #[must_use]
    pub fn region_bits(&self) -> u32 {
        number_bits(self.regions())
    }
}

impl SerialDesign<'_> {
    /// Regions per lane K.
    #[must_use]
    pub fn fold(&self) -> u32 {
        self.own().fold
    }

    /// How pixels enter.
    #[must_use]
    pub fn feed(&self) -> Feed {
        self.own().feed
    }

    /// Lanes L = ceil(M / K).
    #[must_use]
    pub fn lanes(&self) -> u32 {
        self.regions().div_ceil(self.fold())
    }

    /// The region that `lane` (0..L) serves in `slot` (0..K), `None` where the slot is empty.
    #[must_use]
    pub fn region_of(&self, lane: u32, slot: u32) -> Option<u32> {
        let region = u64::from(lane) * u64::from(self.fold()) + u64::from(slot);
        u32::try_from(region).ok().filter(|&region| region < self.regions())
    }

    /// Bits of the number of a lane, 0..L; at least one.
    #[must_use]
    pub fn lane_bits(&self) -> u32 {
        number_bits(self.lanes())
    }

    /// Bits of the number of a slot of a lane, 0..K; at least one.
    #[must_use]
    pub fn slot_bits(&self) -> u32 {
        number_bits(self.fold())
    }

    /// Scores of a region: the temporal count and those of the features, 2..=5.
    #[must_use]
    pub fn score_count(&self) -> u32 {
        self.features().iter().fold(1, |count, _| count + 1)
    }

    /// Bits of the number of a score: 0 the temporal count, 1.. the features.
    #[must_use]
    pub fn score_index_bits(&self) -> u32 {
        number_bits(self.score_count())
    }

    /// Bits that hold every score of the design: the count of pixels, and those of the features.
    #[must_use]
    pub fn any_score_bits(&self) -> u32 {
        let features = self.features().iter().map(|feature| feature.score_bits());
        features.fold(self.count_bits(), u32::max)
    }

    /// Region columns' windows that want a pixel of column `x` (0..C*N), with repetitions: c(x). A
    /// pixel (x, y) of a raster feed goes to `column_places(x) * row_places(y)` places.
    #[must_use]
    pub fn column_places(&self, x: u32) -> u32 {
        self.places(x, self.columns())
    }

    /// As [`Self::column_places`] for rows, `y` = 0..R*N: c(y).
    #[must_use]
    pub fn row_places(&self, y: u32) -> u32 {
        self.places(y, self.rows())
    }

    /// With N >= 2r a window reaches no farther than its neighbors.
    fn places(&self, at: u32, regions: u32) -> u32 {
        let (side, halo) = (self.region_size(), self.halo());
        let (region, position) = (at / side, at % side);
        let before = region > 0 && position < halo;
        let after = region + 1 < regions && position + halo >= side;
        let beyond = u32::from(at == 0) + u32::from(at + 1 == regions * side);
        1 + u32::from(before) + u32::from(after) + halo * beyond
    }

    /// The design of a grid of one lane: K regions side by side in one row, everything else the same.
    /// The array of that grid is the RPU of a serial design. Its frame may be wider than what a
    /// configuration may ask for.
    #[must_use]
    pub fn one_lane(&self) -> Design {
        let (width, height) = (self.fold() * self.region_size(), self.region_size());
        let mut config = self.config();
        (config.camera.frame.width, config.camera.frame.height) = (Some(width), Some(height));
        let lane = config.validate_up_to(u32::MAX);
        lane.expect("a valid design stays one with a frame of as many regions as share a lane")
    }
}

#[cfg(test)]
mod tests;
