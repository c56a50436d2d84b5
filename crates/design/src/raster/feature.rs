// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a raster core makes the score of a feature of: which sums it keeps per region, and how long the score takes.

use crate::FeatureKind;

/// What is summed over the pixels of a region, while they come or in a pass behind them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SummedUp {
    /// Pixels whose window is a hit.
    Hits,
    /// Pixels, and then their distances from the mean, in a second pass.
    Deviations,
    /// Pixels and their squares.
    Squares,
}

impl SummedUp {
    /// That of a feature.
    pub(super) fn of(kind: FeatureKind) -> Self {
        match kind {
            FeatureKind::Edge | FeatureKind::Corner => Self::Hits,
            FeatureKind::Mad => Self::Deviations,
            FeatureKind::Variance => Self::Squares,
        }
    }

    /// Clocks from the sums of a region to a score that is not one of them.
    pub(super) fn score_latency(self) -> u32 {
        match self {
            // The latency of the second pass is a number of its own.
            Self::Hits | Self::Deviations => 0,
            Self::Squares => 3,
        }
    }
}
