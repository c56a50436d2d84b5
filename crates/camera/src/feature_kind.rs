// SPDX-License-Identifier: MIT OR Apache-2.0
//! The differences between kinds of features. Every match in this file must be extended for a new
//! kind.

use crate::feature::{MeanDivision, VarianceWidths};
use crate::width::{edge_magnitude_max, variance_score_max};
use crate::{FeatureKind, mad_score_max};

/// The unit of a score, which says how the score scales with the pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ScoreUnit {
    /// Pixels of the region that are hits.
    Pixels,
    /// Differences of pixels in grey levels.
    Levels,
    /// Squares of differences of pixels.
    SquaredLevels,
}

impl ScoreUnit {
    /// Returns the exponent e of the scaling: when every difference of pixels doubles, the score is
    /// multiplied by 2^e.
    #[must_use]
    pub fn scaling_exponent(self) -> u32 {
        match self {
            Self::Pixels => 0,
            Self::Levels => 1,
            Self::SquaredLevels => 2,
        }
    }

    /// Returns true if the score is a count of pixels: a whole number that does not depend on the
    /// scale of pixels.
    #[must_use]
    pub fn is_count(self) -> bool {
        match self {
            Self::Pixels => true,
            Self::Levels | Self::SquaredLevels => false,
        }
    }

    /// Returns the name of the unit of `min_score`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pixels => "pixels of a region",
            Self::Levels => "grey levels",
            Self::SquaredLevels => "squared grey levels",
        }
    }
}

/// The values of keys that a configuration leaves out, for pixels of 8 bits. A key that does not
/// apply to the feature is `None`.
pub(crate) struct FeatureDefaults {
    pub(crate) level: Option<u32>,
    pub(crate) min_score: u64,
    pub(crate) mean_fraction_bits: Option<u32>,
}

impl FeatureKind {
    /// Number of kinds, which is the length of arrays with one element per kind.
    pub const COUNT: usize = Self::ALL.len();

    /// Returns true if the feature uses a 3x3 window and counts the pixels whose window is a hit.
    #[must_use]
    pub fn has_window(self) -> bool {
        match self {
            Self::Edge | Self::Corner => true,
            Self::Mad | Self::Variance | Self::Range => false,
        }
    }

    /// Returns true if the score needs the pixels of the region a second time, once their mean is
    /// known.
    #[must_use]
    pub fn has_second_pass(self) -> bool {
        match self {
            Self::Mad => true,
            Self::Edge | Self::Corner | Self::Variance | Self::Range => false,
        }
    }

    /// Returns the unit of the score.
    #[must_use]
    pub fn score_unit(self) -> ScoreUnit {
        match self {
            Self::Edge | Self::Corner => ScoreUnit::Pixels,
            Self::Mad | Self::Range => ScoreUnit::Levels,
            Self::Variance => ScoreUnit::SquaredLevels,
        }
    }

    /// Returns per-pixel thresholds, for pixels of 8 bits, that a search tries, from the lowest to
    /// the highest. The list is empty for a feature without such a threshold.
    #[must_use]
    pub fn trial_levels(self) -> &'static [u32] {
        match self {
            Self::Edge => &[50, 75, 100, 150],
            Self::Corner => &[8, 12, 20, 30],
            Self::Mad | Self::Variance | Self::Range => &[],
        }
    }

    pub(crate) fn defaults(self) -> FeatureDefaults {
        let (level, min_score, mean_fraction_bits) = match self {
            Self::Edge => (Some(100), 5, None),
            Self::Corner => (Some(20), 5, None),
            Self::Mad => (None, 5, Some(0)),
            Self::Variance => (None, 50, None),
            Self::Range => (None, 20, None),
        };
        FeatureDefaults { level, min_score, mean_fraction_bits }
    }

    /// Returns the largest value that the per-pixel threshold is compared with, or `None` if the
    /// feature has no such threshold.
    pub(crate) fn level_max(self, pixel_max: u32) -> Option<u32> {
        match self {
            Self::Edge => Some(edge_magnitude_max(pixel_max)),
            Self::Corner => Some(pixel_max),
            Self::Mad | Self::Variance | Self::Range => None,
        }
    }

    /// Returns the number of score units in one unit of `min_score`, for regions of `n` pixels.
    pub(crate) fn unit(self, n: u64, fraction_bits: u32) -> u64 {
        match self {
            Self::Edge | Self::Corner | Self::Range => 1,
            Self::Mad => n << fraction_bits,
            Self::Variance => n * n,
        }
    }

    /// Returns the largest score that a region of `n` pixels can have.
    pub(crate) fn score_max(self, n: u64, pixel_max: u64, fraction_bits: u32) -> u64 {
        match self {
            Self::Edge | Self::Corner => n,
            Self::Mad => mad_score_max(n, pixel_max, fraction_bits),
            Self::Variance => variance_score_max(n, pixel_max),
            Self::Range => pixel_max,
        }
    }

    /// Returns the arithmetic of the mean of `mad` and the accumulators of `variance`, each for
    /// that feature only.
    pub(crate) fn mean_and_variance(
        self,
        n: u64,
        pixel_max: u64,
        fraction_bits: u32,
    ) -> (Option<MeanDivision>, Option<VarianceWidths>) {
        match self {
            Self::Edge | Self::Corner | Self::Range => (None, None),
            Self::Mad => (Some(MeanDivision::new(n, pixel_max, fraction_bits)), None),
            Self::Variance => (None, Some(VarianceWidths::new(n, pixel_max))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Code that tests only one of these properties would miss a feature in which they differ.
    #[test]
    fn levels_belong_to_features_that_count_hits() {
        for kind in FeatureKind::ALL {
            let counts = kind.has_window();
            assert_eq!(kind.level_max(255).is_some(), counts, "{kind}");
            assert_eq!(kind.defaults().level.is_some(), counts, "{kind}");
            assert_eq!(kind.trial_levels().is_empty(), !counts, "{kind}");
            assert_eq!(kind.score_unit().is_count(), counts, "{kind}");
        }
    }
}
