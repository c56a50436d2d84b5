// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sums or extremes that a raster core stores per region for the score of a feature, and the
//! latency of the score.

use foveate_camera::{FeatureKind, MeanDivision, SpatialFeature, VarianceWidths};

/// The numbers that a feature needs of all pixels of a region. They are formed while the pixels
/// come, or in a second pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FeatureAccumulation<'a> {
    /// The number of pixels whose window is a hit.
    Hits,
    /// The sum of the pixels, and in a second pass the sum of their distances from the mean, or the
    /// number of pixels that are far from it.
    Deviations(&'a MeanDivision),
    /// The sums of the pixels and of their squares.
    Squares(&'a VarianceWidths),
    /// The smallest and the largest pixel.
    Extremes,
    /// The four sums of differences from the region moved by one pixel.
    Displacements,
}

impl<'a> FeatureAccumulation<'a> {
    /// Returns the numbers that a feature needs.
    pub(super) fn from_feature(feature: &'a SpatialFeature) -> Self {
        match feature.kind() {
            FeatureKind::Edge | FeatureKind::Corner => Self::Hits,
            FeatureKind::Mad => Self::Deviations(feature.mean().expect("mad has a mean")),
            FeatureKind::Variance => {
                Self::Squares(feature.variance().expect("variance has accumulators"))
            }
            FeatureKind::Range => Self::Extremes,
            FeatureKind::Surface => Self::Displacements,
            FeatureKind::Segment => Self::Deviations(feature.mean().expect("segment has a mean")),
            FeatureKind::Flow => unreachable!("raster refuses flow"),
        }
    }

    /// Returns the clocks from these numbers to the score, or 0 if the score is one of them.
    pub(super) fn score_latency(self) -> u32 {
        match self {
            // The latency of the second pass is counted separately.
            Self::Hits | Self::Deviations(_) => 0,
            Self::Squares(_) => 3,
            Self::Extremes => 1,
            Self::Displacements => 2,
        }
    }
}
