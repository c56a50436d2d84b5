// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a raster core makes the score of a feature of: which sums it keeps per region, and how long the score takes.

use foveate_camera::{FeatureKind, Mean, SpatialFeature, Variance};

/// What is summed over the pixels of a region, while they come or in a pass behind them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SummedUp<'a> {
    /// Pixels whose window is a hit.
    Hits,
    /// Pixels, and then their distances from the mean, in a second pass.
    Deviations(&'a Mean),
    /// Pixels and their squares.
    Squares(&'a Variance),
}

impl<'a> SummedUp<'a> {
    /// That of a feature.
    pub(super) fn of(feature: &'a SpatialFeature) -> Self {
        match feature.kind() {
            FeatureKind::Edge | FeatureKind::Corner => Self::Hits,
            FeatureKind::Mad => Self::Deviations(feature.mean().expect("mad has a mean")),
            FeatureKind::Variance => {
                Self::Squares(feature.variance().expect("variance has accumulators"))
            }
        }
    }

    /// Clocks from the sums of a region to a score that is not one of them.
    pub(super) fn score_latency(self) -> u32 {
        match self {
            // The latency of the second pass is a number of its own.
            Self::Hits | Self::Deviations(_) => 0,
            Self::Squares(_) => 3,
        }
    }
}
