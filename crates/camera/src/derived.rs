// SPDX-License-Identifier: MIT OR Apache-2.0
//! The numbers of a camera that follow from its configuration.

use crate::ranges::MAX_SIDE;
use crate::width::index_bits;
use crate::{Camera, FeatureKind, Filter, Neighborhood, Payload, SpatialFeature, bits_for};

impl Camera {
    /// Largest pixel, 2^P - 1.
    #[must_use]
    pub fn pixel_max(&self) -> u32 {
        (1 << self.pixel_bits()) - 1
    }

    /// Pixels of a region, n = N * N.
    #[must_use]
    pub fn region_pixels(&self) -> u32 {
        self.region_size() * self.region_size()
    }

    /// Regions side by side.
    #[must_use]
    pub fn columns(&self) -> u32 {
        self.width().div_ceil(self.region_size())
    }

    /// Regions one below the other.
    #[must_use]
    pub fn rows(&self) -> u32 {
        self.height().div_ceil(self.region_size())
    }

    /// Regions of a frame, M.
    #[must_use]
    pub fn regions(&self) -> u32 {
        self.columns() * self.rows()
    }

    /// The feature of that kind, if the camera has it.
    #[must_use]
    pub fn feature(&self, kind: FeatureKind) -> Option<&SpatialFeature> {
        self.features().iter().find(|feature| feature.kind() == kind)
    }

    /// Whether any feature looks at 3x3 windows.
    #[must_use]
    pub fn has_feature_window(&self) -> bool {
        self.features().iter().any(|feature| feature.kind().has_window())
    }

    /// Whether any feature needs the region a second time.
    #[must_use]
    pub fn has_second_pass(&self) -> bool {
        self.features().iter().any(|feature| feature.kind().has_second_pass())
    }

    /// Whether raw pixels are forwarded that differ from those scored.
    #[must_use]
    pub fn keeps_raw(&self) -> bool {
        self.payload() == Payload::Raw && self.filter() != Filter::None
    }

    /// Regions in a row or a column of the largest frame that a configuration may ask for.
    #[must_use]
    pub fn most_in_line(&self) -> u32 {
        MAX_SIDE.div_ceil(self.region_size())
    }

    /// Pixels of halo r that a region's stream carries on each side: one per 3x3 window in a row,
    /// none for isolated regions.
    #[must_use]
    pub fn halo(&self) -> u32 {
        match self.neighborhood() {
            Neighborhood::Isolated => 0,
            Neighborhood::Shared => {
                u32::from(self.filter() != Filter::None) + u32::from(self.has_feature_window())
            }
        }
    }

    /// Whether an RPU must know its place: with two windows in a row the second repeats *denoised*
    /// pixels at the frame's border, which a halo of repeated raw pixels cannot give.
    #[must_use]
    pub fn needs_border(&self) -> bool {
        self.halo() == 2
    }

    /// Side of the square of pixels that is streamed per region, N + 2r.
    #[must_use]
    pub fn stream_side(&self) -> u32 {
        self.region_size() + 2 * self.halo()
    }

    /// Side of the square of pixels that the median window gives, or the stream itself without one;
    /// the feature window takes it.
    #[must_use]
    pub fn denoised_side(&self) -> u32 {
        let consumed = u32::from(self.halo() > 0 && self.filter() != Filter::None);
        self.stream_side() - 2 * consumed
    }

    /// Bits of the sum of a region's pixels.
    #[must_use]
    pub fn pixel_sum_bits(&self) -> u32 {
        bits_for(u64::from(self.region_pixels()) * u64::from(self.pixel_max()))
    }

    /// Pixels that are streamed per region and frame.
    #[must_use]
    pub fn stream_pixels(&self) -> u32 {
        self.stream_side() * self.stream_side()
    }

    /// Bits of a count of pixels, 0..=n.
    #[must_use]
    pub fn count_bits(&self) -> u32 {
        bits_for(self.region_pixels().into())
    }

    /// Bits of the number of a pixel in its region, 0..n.
    #[must_use]
    pub fn position_bits(&self) -> u32 {
        index_bits(self.region_pixels().into())
    }
}
