// SPDX-License-Identifier: MIT OR Apache-2.0
//! The numbers of a camera that follow from its configuration.

use crate::ranges::MAX_SIDE;
use crate::width::index_bits;
use crate::{
    Camera, DenoiseFilter, Displacement, FeatureKind, MeanDivision, Neighborhood, Payload,
    SpatialFeature, bits_for,
};

impl Camera {
    /// Returns the largest pixel value, 2^P - 1.
    #[must_use]
    pub fn pixel_max(&self) -> u32 {
        (1 << self.pixel_bits()) - 1
    }

    /// Returns the number of pixels of a region, n = N * N.
    #[inline]
    #[must_use]
    pub fn region_pixels(&self) -> u32 {
        self.region_size() * self.region_size()
    }

    /// Returns the number of regions in a row of regions.
    #[inline]
    #[must_use]
    pub fn columns(&self) -> u32 {
        self.width().div_ceil(self.region_size())
    }

    /// Returns the number of rows of regions.
    #[inline]
    #[must_use]
    pub fn rows(&self) -> u32 {
        self.height().div_ceil(self.region_size())
    }

    /// Returns the number of regions of a frame, M.
    #[inline]
    #[must_use]
    pub fn regions(&self) -> u32 {
        self.columns() * self.rows()
    }

    /// Returns the feature of that kind, or `None` if the camera does not have it.
    #[must_use]
    pub fn feature(&self, kind: FeatureKind) -> Option<&SpatialFeature> {
        self.features().iter().find(|feature| feature.kind() == kind)
    }

    /// Returns the mean with which the second pass begins, which all features of the pass share.
    /// Returns `None` for a camera without a second pass.
    #[must_use]
    pub fn second_pass_mean(&self) -> Option<&MeanDivision> {
        self.features().iter().find(|feature| feature.kind().has_second_pass())?.mean()
    }

    /// Returns the feature that finds the displacement of a region, or `None` if the camera has no
    /// such feature.
    #[must_use]
    pub fn displacement_feature(&self) -> Option<&SpatialFeature> {
        self.features().iter().find(|feature| feature.kind().is_displacement())
    }

    /// Returns the bits of a displacement, dx and dy; 0 for a camera that finds none.
    #[must_use]
    pub fn displacement_bits(&self) -> u32 {
        let radius = self.displacement_feature().and_then(SpatialFeature::radius);
        radius.map_or(0, |radius| 2 * Displacement::coordinate_bits(radius))
    }

    /// Returns true if a feature uses a 3x3 window.
    #[must_use]
    pub fn has_feature_window(&self) -> bool {
        self.features().iter().any(|feature| feature.kind().has_window())
    }

    /// Returns true if a feature reads the pixels of a region a second time.
    #[must_use]
    pub fn has_second_pass(&self) -> bool {
        self.features().iter().any(|feature| feature.kind().has_second_pass())
    }

    /// Returns true if the forwarded pixels differ from the scored ones: raw pixels behind a
    /// filter.
    #[must_use]
    pub fn has_separate_raw_pixels(&self) -> bool {
        self.payload() == Payload::Raw && self.filter() != DenoiseFilter::None
    }

    /// Returns the number of regions in a row or a column of the largest frame that a configuration
    /// may have.
    #[must_use]
    pub fn max_regions_per_line(&self) -> u32 {
        MAX_SIDE.div_ceil(self.region_size())
    }

    /// Returns the halo r: the pixels that the stream of a region has on each side in addition to
    /// its own. It is one for each 3x3 window in sequence, and 0 for isolated regions.
    #[inline]
    #[must_use]
    pub fn halo(&self) -> u32 {
        match self.neighborhood() {
            Neighborhood::Isolated => 0,
            Neighborhood::Shared => {
                u32::from(self.filter() != DenoiseFilter::None)
                    + u32::from(self.has_feature_window())
            }
        }
    }

    /// Returns true if an RPU must know which of its sides are sides of the frame. With two windows
    /// in sequence, the second repeats *denoised* pixels at the border of the frame, which a halo
    /// of repeated raw pixels cannot give.
    #[must_use]
    pub fn needs_border(&self) -> bool {
        self.halo() == 2
    }

    /// Returns the side of the square of pixels that is streamed per region, N + 2r.
    #[inline]
    #[must_use]
    pub fn stream_side(&self) -> u32 {
        self.region_size() + 2 * self.halo()
    }

    /// Returns the side of the square of pixels that enters the feature window: the output of the
    /// filter window, or the stream itself without a filter.
    #[inline]
    #[must_use]
    pub fn denoised_side(&self) -> u32 {
        let consumed = u32::from(self.halo() > 0 && self.filter() != DenoiseFilter::None);
        self.stream_side() - 2 * consumed
    }

    /// Returns the bits of the sum of the pixels of a region.
    #[must_use]
    pub fn pixel_sum_bits(&self) -> u32 {
        bits_for(u64::from(self.region_pixels()) * u64::from(self.pixel_max()))
    }

    /// Returns the number of pixels that are streamed per region and frame.
    #[must_use]
    pub fn stream_pixels(&self) -> u32 {
        self.stream_side() * self.stream_side()
    }

    /// Returns the bits of a count of pixels, 0..=n.
    #[must_use]
    pub fn count_bits(&self) -> u32 {
        bits_for(self.region_pixels().into())
    }

    /// Returns the bits of the number of a pixel in its region, 0..n.
    #[must_use]
    pub fn position_bits(&self) -> u32 {
        index_bits(self.region_pixels().into())
    }
}
